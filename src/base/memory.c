// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Memory of a context, all of it counted against one limit: blocks, buffers that grow, and what libraries take by themselves.
#include "base/context.h"
#include "base/format.h"
#include "base/unpacking.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { WHAT_BYTES = 512 };

const ewa_limits *ewa_context_limits(const ewa_context *context) { return &context->options.limits; }

ewa_named_files ewa_context_named_files(const ewa_context *context) { return context->options.named_files; }

uint64_t ewa_memory_left(const ewa_context *context) {
    const uint64_t limit = context->options.limits.max_memory_bytes,
                   held = atomic_load_explicit(&context->held_bytes, memory_order_relaxed);
    return held < limit ? limit - held : 0;
}

/// Counts bytes as held; false, with nothing counted, where they would be too many.
static bool hold(ewa_context *context, uint64_t bytes) {
    const uint64_t limit = context->options.limits.max_memory_bytes;
    uint_fast64_t held = atomic_load_explicit(&context->held_bytes, memory_order_relaxed);
    do {
        if (bytes > limit || held > limit - bytes) return false;
    } while (!atomic_compare_exchange_weak_explicit(&context->held_bytes, &held, held + bytes, memory_order_relaxed,
                                                    memory_order_relaxed));
    return true;
}

void ewa_memory_give(ewa_context *context, uint64_t bytes) {
    atomic_fetch_sub_explicit(&context->held_bytes, bytes, memory_order_relaxed);
}

static ewa_status refuse(ewa_context *context, uint64_t bytes, const char *format, va_list arguments) {
    char what[WHAT_BYTES];
    ewa_format_list(what, sizeof what, format, arguments);
    return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %llu bytes are needed, %llu of max_memory_bytes %llu are left", what,
                    (unsigned long long)bytes, (unsigned long long)ewa_memory_left(context),
                    (unsigned long long)context->options.limits.max_memory_bytes);
}

ewa_status ewa_memory_check(ewa_context *context, uint64_t bytes, const char *format, ...) {
    if (bytes <= ewa_memory_left(context)) return EWA_OK;
    va_list arguments;
    va_start(arguments, format);
    const ewa_status status = refuse(context, bytes, format, arguments);
    va_end(arguments);
    return status;
}

/// What any input may unpack to by default, however small it is: a picture of 8192 x 8192 pixels with alpha.
static const uint64_t UNPACKED_BYTES = (uint64_t)1 << 30;

void ewa_memory_unpacked_before(ewa_context *context, uint64_t packed_bytes, uint64_t bytes) {
    context->packed_before_bytes = packed_bytes;
    context->unpacked_before_bytes = bytes;
}

ewa_status ewa_memory_check_unpacked(ewa_context *context, uint64_t packed_bytes, uint32_t ratio, uint64_t bytes,
                                     const char *format, ...) {
    const uint64_t before = context->unpacked_before_bytes, all = bytes < UINT64_MAX - before ? bytes + before : UINT64_MAX;
    packed_bytes += context->packed_before_bytes;
    const bool explained = context->memory_is_set || all <= UNPACKED_BYTES || all / ratio <= packed_bytes;
    const bool fits = bytes <= ewa_memory_left(context);
    if (explained && fits) return EWA_OK;
    va_list arguments;
    va_start(arguments, format);
    char what[WHAT_BYTES];
    ewa_format_list(what, sizeof what, format, arguments);
    va_end(arguments);
    if (!fits) return ewa_memory_check(context, bytes, "%s", what);
    return ewa_fail(context, EWA_ERROR_LIMIT,
                    "%s: %llu bytes are needed, which %llu bytes of input do not explain; setting max_memory_bytes allows it", what,
                    (unsigned long long)all, (unsigned long long)packed_bytes);
}

ewa_status ewa_memory_take(ewa_context *context, uint64_t bytes, const char *format, ...) {
    if (hold(context, bytes)) return EWA_OK;
    va_list arguments;
    va_start(arguments, format);
    const ewa_status status = refuse(context, bytes, format, arguments);
    va_end(arguments);
    return status;
}

void *ewa_allocate(ewa_context *context, size_t count, size_t size_bytes) {
    size_t total;
    if (__builtin_mul_overflow(count, size_bytes, &total)) {
        ewa_fail(context, EWA_ERROR_MEMORY, "%zu items of %zu bytes do not fit the address space", count,
                 size_bytes);
        return NULL;
    }
    if (total == 0) total = 1;
    if (!hold(context, total)) {
        ewa_fail(context, EWA_ERROR_MEMORY, "out of memory: %zu bytes are needed, %llu of max_memory_bytes %llu are left",
                 total, (unsigned long long)ewa_memory_left(context),
                 (unsigned long long)context->options.limits.max_memory_bytes);
        return NULL;
    }
    const ewa_allocator *allocator = &context->options.allocator;
    void *memory = allocator->allocate(allocator->user, total);
    if (memory) return memory;
    ewa_memory_give(context, total);
    ewa_fail(context, EWA_ERROR_MEMORY, "out of memory: %zu bytes wanted", total);
    return NULL;
}

void *ewa_allocate_zeroed(ewa_context *context, size_t count, size_t size_bytes) {
    void *memory = ewa_allocate(context, count, size_bytes);
    if (memory) memset(memory, 0, count * size_bytes);
    return memory;
}

void ewa_release(ewa_context *context, void *memory, size_t count, size_t size_bytes) {
    if (!memory) return;
    const size_t product = count * size_bytes, total = product ? product : 1;
    const ewa_allocator *allocator = &context->options.allocator;
    allocator->release(allocator->user, memory, total);
    ewa_memory_give(context, total);
}

ewa_status ewa_buffer_reserve(ewa_context *context, ewa_buffer *buffer, size_t count, size_t size_bytes) {
    size_t wanted;
    if (__builtin_mul_overflow(count, size_bytes, &wanted))
        return ewa_fail(context, EWA_ERROR_MEMORY, "%zu items of %zu bytes do not fit the address space",
                        count, size_bytes);
    if (wanted <= buffer->capacity_bytes) return EWA_OK;
    ewa_buffer_free(context, buffer);
    buffer->data = ewa_allocate(context, wanted, 1);
    if (!buffer->data) return EWA_ERROR_MEMORY;
    buffer->capacity_bytes = wanted;
    return EWA_OK;
}

ewa_status ewa_buffer_grow(ewa_context *context, ewa_buffer *buffer, size_t kept, size_t count,
                           size_t size_bytes) {
    size_t wanted;
    if (!__builtin_mul_overflow(count, size_bytes, &wanted) && wanted <= buffer->capacity_bytes)
        return EWA_OK;
    ewa_buffer larger = {0};
    EWA_TRY(ewa_buffer_reserve(context, &larger, count < SIZE_MAX / 2 ? count + count / 2 : count, size_bytes));
    if (kept) memcpy(larger.data, buffer->data, kept * size_bytes);
    ewa_buffer_free(context, buffer);
    *buffer = larger;
    return EWA_OK;
}

void ewa_buffer_free(ewa_context *context, ewa_buffer *buffer) {
    ewa_release(context, buffer->data, buffer->capacity_bytes, 1);
    *buffer = (ewa_buffer){0};
}
