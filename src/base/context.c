// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The context: options with their defaults, allocation, messages, progress.
#define _DEFAULT_SOURCE // madvise
#include "base/base.h"
#include "base/options.h"
#include "base/pool.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

struct ewa_context {
    ewa_context_options options;
    ewa_pool *pool;
    uint32_t cpu_features;
    bool soft_failures;
};

enum {
    MESSAGE_BYTES = 1024,
    MAX_WORKERS = 256,
    HUGE_PAGE_BYTES = 1 << 21,
};

const char *ewa_status_name(ewa_status status) {
    switch (status) {
    case EWA_OK:
        return "EWA_OK";
    case EWA_ERROR_ARGUMENT:
        return "EWA_ERROR_ARGUMENT";
    case EWA_ERROR_MEMORY:
        return "EWA_ERROR_MEMORY";
    case EWA_ERROR_IO:
        return "EWA_ERROR_IO";
    case EWA_ERROR_FORMAT:
        return "EWA_ERROR_FORMAT";
    case EWA_ERROR_UNSUPPORTED:
        return "EWA_ERROR_UNSUPPORTED";
    case EWA_ERROR_LIMIT:
        return "EWA_ERROR_LIMIT";
    case EWA_ERROR_NUMERIC:
        return "EWA_ERROR_NUMERIC";
    case EWA_CANCELLED:
        return "EWA_CANCELLED";
    }
    return "unknown status";
}

#define TEXT(number)                      #number
#define VERSION_TEXT(major, minor, patch) TEXT(major) "." TEXT(minor) "." TEXT(patch)

const char *ewa_version(void) {
    return VERSION_TEXT(EWA_VERSION_MAJOR, EWA_VERSION_MINOR, EWA_VERSION_PATCH);
}

static void *allocate_default(void *user, size_t size_bytes) {
    (void)user;
    // Large blocks start on huge pages: filling fresh memory by pages of 4 KiB costs more than any copy into
    // it. Rounding up wastes at most half.
    const size_t alignment = size_bytes >= HUGE_PAGE_BYTES ? HUGE_PAGE_BYTES : 64;
    const size_t rounded = (size_bytes + alignment - 1) & ~(alignment - 1);
    void *memory = rounded < size_bytes ? NULL : aligned_alloc(alignment, rounded);
#if defined(MADV_HUGEPAGE)
    if (memory && alignment == HUGE_PAGE_BYTES) madvise(memory, rounded, MADV_HUGEPAGE);
#endif
    return memory;
}

static void release_default(void *user, void *memory, size_t size_bytes) {
    (void)user;
    (void)size_bytes;
    free(memory);
}

static uint64_t physical_memory_bytes(void) {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : (uint64_t)1 << 34;
}

#define AT(member) offsetof(ewa_context_options, member)

static const ewa_option option_rows[] = {
    {"thread_count", EWA_OPTION_U32, AT(thread_count), 0, MAX_WORKERS,
     .help = "workers of the built-in pool; 0: one per processor"},
    {"cpu_mask", EWA_OPTION_U32, AT(cpu_mask), 0, UINT32_MAX, .initial = EWA_CPU_ALL,
     .help = "bits of instruction sets that may be used"},
    {"message_level", EWA_OPTION_CHOICE, AT(message_level), .words = "error|warning|info|debug",
     .initial = EWA_SEVERITY_WARNING, .help = "most detailed messages to report"},
};

const ewa_option_table ewa_context_options_table = EWA_OPTION_TABLE(ewa_context_options, option_rows);

void ewa_context_options_init(ewa_context_options *options, size_t struct_size) {
    ewa_options_init(&ewa_context_options_table, options, struct_size);
    if (!options || struct_size < AT(limits) + sizeof options->limits) return;
    options->allocator.allocate = allocate_default;
    options->allocator.release = release_default;
    options->limits.max_points = ((uint64_t)1 << 32) - 17;
    options->limits.max_memory_bytes = physical_memory_bytes();
    options->limits.max_image_side = 65536;
}

ewa_status ewa_context_create(const ewa_context_options *options, ewa_context **context) {
    if (!context) return EWA_ERROR_ARGUMENT;
    *context = NULL;
    ewa_context_options chosen;
    ewa_context_options_init(&chosen, sizeof chosen);
    const ewa_status taken = ewa_options_take(NULL, &ewa_context_options_table, options, &chosen);
    if (taken != EWA_OK) return taken;
    if (!chosen.allocator.allocate || !chosen.allocator.release ||
        chosen.executor.worker_count > MAX_WORKERS ||
        (chosen.executor.run && chosen.executor.worker_count == 0))
        return EWA_ERROR_ARGUMENT;
    ewa_context *made = chosen.allocator.allocate(chosen.allocator.user, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    *made = (ewa_context){.options = chosen, .cpu_features = ewa_cpu_detect() & chosen.cpu_mask};
    if (!chosen.executor.run) {
        uint32_t workers = chosen.thread_count;
        if (workers == 0) {
            const long processors = sysconf(_SC_NPROCESSORS_ONLN);
            workers = processors < 1 ? 1 : processors > MAX_WORKERS ? MAX_WORKERS : (uint32_t)processors;
        }
        const ewa_status status = ewa_pool_create(&chosen.allocator, workers, &made->pool);
        if (status != EWA_OK) {
            chosen.allocator.release(chosen.allocator.user, made, sizeof *made);
            return status;
        }
    }
    *context = made;
    return EWA_OK;
}

void ewa_context_destroy(ewa_context **context) {
    if (!context || !*context) return;
    ewa_context *old = *context;
    const ewa_allocator allocator = old->options.allocator;
    ewa_pool_destroy(&allocator, old->pool);
    allocator.release(allocator.user, old, sizeof *old);
    *context = NULL;
}

uint32_t ewa_context_worker_count(const ewa_context *context) {
    return context->pool ? ewa_pool_worker_count(context->pool) : context->options.executor.worker_count;
}

uint32_t ewa_context_cpu_features(const ewa_context *context) { return context->cpu_features; }

const ewa_limits *ewa_context_limits(const ewa_context *context) { return &context->options.limits; }

void *ewa_allocate(ewa_context *context, size_t count, size_t size_bytes) {
    size_t total;
    if (__builtin_mul_overflow(count, size_bytes, &total)) {
        ewa_fail(context, EWA_ERROR_MEMORY, "%zu items of %zu bytes do not fit the address space", count,
                 size_bytes);
        return NULL;
    }
    const ewa_allocator *allocator = &context->options.allocator;
    void *memory = allocator->allocate(allocator->user, total ? total : 1);
    if (!memory) ewa_fail(context, EWA_ERROR_MEMORY, "out of memory: %zu bytes wanted", total);
    return memory;
}

void *ewa_allocate_zeroed(ewa_context *context, size_t count, size_t size_bytes) {
    void *memory = ewa_allocate(context, count, size_bytes);
    if (memory) memset(memory, 0, count * size_bytes);
    return memory;
}

void ewa_release(ewa_context *context, void *memory, size_t count, size_t size_bytes) {
    if (!memory) return;
    const size_t total = count * size_bytes;
    const ewa_allocator *allocator = &context->options.allocator;
    allocator->release(allocator->user, memory, total ? total : 1);
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
    const ewa_status status =
        ewa_buffer_reserve(context, &larger, count < SIZE_MAX / 2 ? count + count / 2 : count, size_bytes);
    if (status != EWA_OK) return status;
    if (kept) memcpy(larger.data, buffer->data, kept * size_bytes);
    ewa_buffer_free(context, buffer);
    *buffer = larger;
    return EWA_OK;
}

void ewa_buffer_free(ewa_context *context, ewa_buffer *buffer) {
    ewa_release(context, buffer->data, buffer->capacity_bytes, 1);
    *buffer = (ewa_buffer){0};
}

static void report(ewa_context *context, ewa_severity severity, const char *format, va_list arguments) {
    const ewa_context_options *options = &context->options;
    if (!options->message || severity > options->message_level) return;
    char text[MESSAGE_BYTES];
    vsnprintf(text, sizeof text, format, arguments);
    options->message(options->message_user, severity, text);
}

ewa_status ewa_fail(ewa_context *context, ewa_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (context)
        report(context, context->soft_failures ? EWA_SEVERITY_WARNING : EWA_SEVERITY_ERROR, format,
               arguments);
    va_end(arguments);
    return status;
}

void ewa_failures_soften(ewa_context *context, bool soft) { context->soft_failures = soft; }

void ewa_report(ewa_context *context, ewa_severity severity, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    report(context, severity, format, arguments);
    va_end(arguments);
}

ewa_status ewa_progress(ewa_context *context, const char *stage, double fraction) {
    const ewa_context_options *options = &context->options;
    return !options->progress || options->progress(options->progress_user, stage, fraction) ? EWA_OK
                                                                                            : EWA_CANCELLED;
}

void ewa_parallel(ewa_context *context, ewa_task *task, void *data, uint32_t count) {
    if (context->pool) {
        ewa_pool_run(context->pool, task, data, count);
    } else {
        const ewa_executor *executor = &context->options.executor;
        executor->run(executor->user, task, data, count);
    }
}

/// A run that the progress callback may stop.
typedef struct stoppable_run {
    ewa_context *context;
    const char *stage;
    ewa_task *task;
    void *data;
    uint32_t first, count;
    atomic_uint_fast32_t done;
    atomic_bool stopped;
} stoppable_run;

static void run_one(void *data, uint32_t index, uint32_t worker) {
    stoppable_run *run = data;
    if (atomic_load_explicit(&run->stopped, memory_order_relaxed)) return;
    run->task(run->data, run->first + index, worker);
    const uint32_t done = (uint32_t)atomic_fetch_add_explicit(&run->done, 1, memory_order_relaxed) + 1;
    // Worker 0 of the built-in pool is the thread that called the library, on which the callback comes.
    if (run->context->pool && worker == 0 &&
        ewa_progress(run->context, run->stage, (double)done / run->count) != EWA_OK)
        atomic_store_explicit(&run->stopped, true, memory_order_relaxed);
}

ewa_status ewa_parallel_stoppable(ewa_context *context, const char *stage, ewa_task *task, void *data,
                                  uint32_t count) {
    enum { PARTS = 16 };
    stoppable_run run = {context, stage, task, data, .count = count};
    // Threads of others' executors may all be other ones: their runs are stopped between parts.
    const uint32_t step = context->pool || !context->options.progress ? count : count / PARTS + 1;
    ewa_status status = ewa_progress(context, stage, 0);
    for (; run.first < count && status == EWA_OK; run.first += step) {
        const uint32_t left = count - run.first;
        ewa_parallel(context, run_one, &run, left < step ? left : step);
        status = atomic_load(&run.stopped)
                     ? EWA_CANCELLED
                     : ewa_progress(context, stage, (double)atomic_load(&run.done) / count);
    }
    return status;
}

double ewa_now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
