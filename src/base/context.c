// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A context from its options to its end.
#include "base/context.h"
#include "base/options.h"
#include "base/platform.h"
#include "base/relaxed.h"

#include <math.h>

enum { MAX_WORKERS = 256 };

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

void *ewa_allocate_default(void *user, size_t size_bytes) {
    (void)user;
    return ewa_platform_allocate(size_bytes);
}

static void release_default(void *user, void *memory, size_t size_bytes) {
    (void)user;
    (void)size_bytes;
    ewa_platform_release(memory);
}

#define AT(member) offsetof(ewa_context_options, member)

static const ewa_option option_rows[] = {
    {"thread_count", EWA_OPTION_U32, AT(thread_count), 0, MAX_WORKERS,
     .help = "workers of the built-in pool; 0: one per processor"},
    {"cpu_mask", EWA_OPTION_U32, AT(cpu_mask), 0, UINT32_MAX, .initial = EWA_CPU_ALL,
     .help = "bits of instruction sets that may be used"},
    {"message_level", EWA_OPTION_CHOICE, AT(message_level), .words = "error|warning|note|info|debug",
     .initial = EWA_SEVERITY_WARNING, .help = "most detailed messages to report"},
    {"named_files", EWA_OPTION_CHOICE, AT(named_files), .words = "below|anywhere|none",
     .help = "which files are opened that a file or folder names: regular ones below its own folder, anywhere, or none"},
    {"untrusted", EWA_OPTION_BOOL, AT(untrusted),
     .help = "for inputs from anyone: small limits where none are set, and no file opened that another names"},
};

const ewa_option_table ewa_context_options_table = EWA_OPTION_TABLE(ewa_context_options, option_rows);

#define LIMIT_AT(member) offsetof(ewa_limits, member)

static const ewa_option limit_rows[] = {
    {"max_points", EWA_OPTION_U64, LIMIT_AT(max_points), 1, 0x1p53, EWA_OPTION_OR_ZERO,
     .help = "points in one cloud; 0: 4294967279, of untrusted inputs 67108864"},
    {"max_memory_bytes", EWA_OPTION_U64, LIMIT_AT(max_memory_bytes), 1, 0x1p62, EWA_OPTION_OR_ZERO, .unit = "bytes",
     .help = "memory held at a time, 512M or 8G; 0: three quarters of the machine's, of untrusted inputs 1G at most"},
    {"max_image_side", EWA_OPTION_U32, LIMIT_AT(max_image_side), 1, UINT32_MAX, EWA_OPTION_OR_ZERO, .unit = "px",
     .help = "width and height of a picture; 0: 65536, of untrusted inputs 16384"},
    {"max_seconds", EWA_OPTION_F64, LIMIT_AT(max_seconds), 0, INFINITY, EWA_OPTION_BELOW, .unit = "s",
     .help = "time after which work is given up, from the start on; 0: none"},
};

const ewa_option_table ewa_limits_table = EWA_OPTION_TABLE(ewa_limits, limit_rows);

/// Puts numbers in the place of zeros.
static void settle_limits(ewa_context_options *options) {
    static const uint64_t UNTRUSTED_BYTES = (uint64_t)1 << 30;
    ewa_limits *limits = &options->limits;
    const bool small = options->untrusted;
    const uint64_t share = ewa_platform_memory_bytes() / 4 * 3;
    if (!limits->max_points) limits->max_points = small ? (uint64_t)1 << 26 : ((uint64_t)1 << 32) - 17;
    if (!limits->max_memory_bytes)
        limits->max_memory_bytes = small && share > UNTRUSTED_BYTES ? UNTRUSTED_BYTES : share;
    if (!limits->max_image_side) limits->max_image_side = small ? 16384 : 65536;
    if (small) options->named_files = EWA_NAMED_NONE;
}

void ewa_context_options_init(ewa_context_options *options, size_t struct_size) {
    ewa_options_init(&ewa_context_options_table, options, struct_size);
    if (!options || struct_size < AT(executor)) return;
    options->allocator.allocate = ewa_allocate_default;
    options->allocator.release = release_default;
}

ewa_status ewa_context_create(const ewa_context_options *options, ewa_context **context) {
    if (!context) return EWA_ERROR_ARGUMENT;
    *context = NULL;
    ewa_context_options chosen;
    ewa_context_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(NULL, &ewa_context_options_table, options, &chosen));
    // Counts beyond the ranges of the table are no limits.
    if (!(chosen.limits.max_seconds >= 0 && isfinite(chosen.limits.max_seconds))) return EWA_ERROR_ARGUMENT;
    if (!ewa_relaxed_rounds_once()) return EWA_ERROR_UNSUPPORTED;
    const bool memory_is_set = chosen.limits.max_memory_bytes > 0;
    settle_limits(&chosen);
    if (!chosen.allocator.allocate || !chosen.allocator.release ||
        chosen.executor.worker_count > MAX_WORKERS ||
        (chosen.executor.run && chosen.executor.worker_count == 0))
        return EWA_ERROR_ARGUMENT;
    ewa_context *made = chosen.allocator.allocate(chosen.allocator.user, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    *made = (ewa_context){.options = chosen,
                          .cpu_features = ewa_cpu_detect() & chosen.cpu_mask,
                          .memory_is_set = memory_is_set,
                          .started_s = ewa_now_s()};
    if (!chosen.executor.run) {
        uint32_t workers = chosen.thread_count;
        if (workers == 0) {
            const uint32_t processors = ewa_platform_processor_count();
            workers = processors > MAX_WORKERS ? MAX_WORKERS : processors;
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
    if (old->remote) old->end_remote(&old->remote);
    ewa_pool_destroy(&allocator, old->pool);
    allocator.release(allocator.user, old, sizeof *old);
    *context = NULL;
}
