// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every room stands on: checked allocation, failure with a message, parallel loops, time, CPU features.
#ifndef EWA_SRC_BASE_H
#define EWA_SRC_BASE_H

#include "ewa/base.h"

/// Stable facts of a context that other rooms read; the limits have no member that stands for a default.
const ewa_limits *ewa_context_limits(const ewa_context *context);
ewa_named_files ewa_context_named_files(const ewa_context *context);

/// Returns the bytes that may still be held. Any thread.
uint64_t ewa_memory_left(const ewa_context *context);

/// Fails unless `bytes` more may be held, which a reader asks as soon as it knows sizes: "<formatted text>: N bytes are
/// needed, M of max_memory_bytes L are left". Errors: EWA_ERROR_LIMIT.
ewa_status ewa_memory_check(ewa_context *context, uint64_t bytes, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// The same, and counts what a library is about to take by itself as held, until ewa_memory_give() of as many bytes.
ewa_status ewa_memory_take(ewa_context *context, uint64_t bytes, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void ewa_memory_give(ewa_context *context, uint64_t bytes);

/// Returns count * size bytes aligned to 64, uninitialised, or NULL after reporting; a product of zero gives
/// one byte. They count as held until ewa_release() of the same count and size, and are not given where more than
/// max_memory_bytes would be held.
void *ewa_allocate(ewa_context *context, size_t count, size_t size_bytes);

/// Like ewa_allocate(), set to zero.
void *ewa_allocate_zeroed(ewa_context *context, size_t count, size_t size_bytes);

/// Frees what ewa_allocate() returned; accepts NULL.
void ewa_release(ewa_context *context, void *memory, size_t count, size_t size_bytes);

/// A buffer that only grows, so that a warm frame allocates nothing. Zero-initialise.
typedef struct ewa_buffer {
    void *data;
    size_t capacity_bytes;
} ewa_buffer;

/// Makes room for count * size bytes; what was in the buffer is lost when it has to grow.
ewa_status ewa_buffer_reserve(ewa_context *context, ewa_buffer *buffer, size_t count, size_t size_bytes);
/// The same, with the first `kept` of `count` items kept; more room than wanted, so that growing by ones is
/// cheap.
ewa_status ewa_buffer_grow(ewa_context *context, ewa_buffer *buffer, size_t kept, size_t count,
                           size_t size_bytes);
void ewa_buffer_free(ewa_context *context, ewa_buffer *buffer);

/// Reports "<formatted text>" at EWA_SEVERITY_ERROR and returns `status`, so that `return ewa_fail(...)`
/// reads well. Without a context nobody is told.
ewa_status ewa_fail(ewa_context *context, ewa_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// While `soft`, ewa_fail() reports warnings: what fails is left out, and the call goes on. In pairs, which nest.
void ewa_failures_soften(ewa_context *context, bool soft);

/// Sets what messages are about, such as a file, which they then begin with unless they do already; borrowed; NULL: none.
/// Returns what it was before, to be set again.
const char *ewa_context_about(ewa_context *context, const char *subject);

/// Reports a message of another severity; formats nothing when nobody listens at that level.
void ewa_report(ewa_context *context, ewa_severity severity, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// While `hushed`, ewa_report() reports at EWA_SEVERITY_DEBUG: what is done a second time has been told. In pairs, which
/// nest.
void ewa_reports_hush(ewa_context *context, bool hushed);

/// Calls `task(data, i, worker)` for every i in [0, count) and waits. Not from inside a task.
void ewa_parallel(ewa_context *context, ewa_task *task, void *data, uint32_t count);

/// The same, told to the progress callback, which may stop it between two tasks: then EWA_CANCELLED, and only
/// some have run.
ewa_status ewa_parallel_stoppable(ewa_context *context, const char *stage, ewa_task *task, void *data,
                                  uint32_t count);

/// The same for a part of a stage, whose progress goes from `begin` to `end`, in [0, 1].
ewa_status ewa_parallel_within(ewa_context *context, const char *stage, double begin, double end, ewa_task *task, void *data,
                               uint32_t count);

/// For tasks of ewa_parallel_stoppable() that take long: whether to go on. `worker` is the task's; on the thread that called
/// the library the progress callback is asked now and then, on others whether it has stopped the run. A task that is told
/// not to go on returns soon and may leave its work undone, for the run is EWA_CANCELLED.
bool ewa_goes_on(ewa_context *context, uint32_t worker);

/// Tells the progress callback; returns EWA_CANCELLED when it wants to stop or max_seconds are over, which is reported
/// once; else EWA_OK.
ewa_status ewa_progress(ewa_context *context, const char *stage, double fraction);

/// Monotonic time in seconds.
double ewa_now_s(void);

/// Returns a number that nothing else of the context has got, at least 1: for what may be freed and made again at the same
/// address. Any thread.
uint64_t ewa_serial_next(ewa_context *context);

/// EWA_CPU_* bits of this machine.
uint32_t ewa_cpu_detect(void);

/// Splits `count` items into `parts` contiguous ranges; returns the first item of part `part` (part = parts:
/// count).
static inline uint64_t ewa_split(uint64_t count, uint32_t parts, uint32_t part) {
    return count / parts * part + count % parts * part / parts;
}

/// Returns from the function with the status of `call` unless that is EWA_OK: for functions, or the inner part of one, that
/// have nothing to give back on their way out.
#define EWA_TRY(call)                                                                                        \
    do {                                                                                                     \
        const ewa_status tried_ = (call);                                                                    \
        if (tried_ != EWA_OK) return tried_;                                                                 \
    } while (0)

#endif
