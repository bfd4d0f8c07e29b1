// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a context does for the library: messages, progress, work for its threads.
#include "base/context.h"
#include "base/format.h"
#include "base/platform.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE_BYTES = 1024 };

uint32_t ewa_context_worker_count(const ewa_context *context) {
    return context->pool ? ewa_pool_worker_count(context->pool) : context->options.executor.worker_count;
}

uint32_t ewa_context_cpu_features(const ewa_context *context) { return context->cpu_features; }

static void report(ewa_context *context, ewa_severity severity, const char *format, va_list arguments) {
    const ewa_context_options *options = &context->options;
    if (!options->message || severity > options->message_level) return;
    char text[MESSAGE_BYTES];
    ewa_format_list(text, sizeof text, format, arguments);
    // Names of files and words in them may be anything; a message is one line.
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
    const char *subject = context->subject;
    if (!subject || strncmp(text, subject, strlen(subject)) == 0) {
        options->message(options->message_user, severity, text);
        return;
    }
    char about[2 * MESSAGE_BYTES];
    snprintf(about, sizeof about, "%s: %s", subject, text);
    options->message(options->message_user, severity, about);
}

const char *ewa_context_about(ewa_context *context, const char *subject) {
    const char *before = context->subject;
    context->subject = subject;
    return before;
}

ewa_status ewa_fail(ewa_context *context, ewa_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (context)
        report(context,
               context->hushed_failures ? EWA_SEVERITY_DEBUG
               : context->soft_failures ? EWA_SEVERITY_WARNING
                                        : EWA_SEVERITY_ERROR,
               format, arguments);
    va_end(arguments);
    return status;
}

void ewa_failures_soften(ewa_context *context, bool soft) { context->soft_failures += soft ? 1 : -1; }

void ewa_failures_hush(ewa_context *context, bool hushed) { context->hushed_failures += hushed ? 1 : -1; }

void ewa_reports_hush(ewa_context *context, bool hushed) { context->hushed_reports += hushed ? 1 : -1; }

void ewa_report(ewa_context *context, ewa_severity severity, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    report(context, context->hushed_reports ? EWA_SEVERITY_DEBUG : severity, format, arguments);
    va_end(arguments);
}

ewa_status ewa_progress(ewa_context *context, const char *stage, double fraction) {
    const ewa_context_options *options = &context->options;
    const double limit_s = options->limits.max_seconds;
    if (limit_s > 0 && ewa_now_s() - context->started_s > limit_s) {
        if (!context->time_is_over) ewa_fail(context, EWA_CANCELLED, "%g s are over (max_seconds)", limit_s);
        context->time_is_over = true;
        return EWA_CANCELLED;
    }
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

/// Between questions from within a task, which may come often.
static const double ASKING_STEP_S = 0.02;

/// A run that the progress callback may stop.
typedef struct ewa_stoppable_run {
    ewa_context *context;
    const char *stage;
    double begin, end; ///< of the stage
    ewa_task *task;
    void *data;
    uint32_t first, count;
    atomic_uint_fast32_t done;
    atomic_bool stopped;
    double asked_s; // of the thread that called the library
} stoppable_run;

/// Asks the progress callback, on the thread that called the library.
static ewa_status tell(const stoppable_run *run) {
    const double done = (double)atomic_load_explicit(&run->done, memory_order_relaxed);
    return ewa_progress(run->context, run->stage, run->begin + (run->end - run->begin) * (done / run->count));
}

/// The same within a run; not again once it has said stop.
static void ask(stoppable_run *run) {
    if (atomic_load_explicit(&run->stopped, memory_order_relaxed)) return;
    if (tell(run) != EWA_OK) atomic_store_explicit(&run->stopped, true, memory_order_relaxed);
}

static void run_one(void *data, uint32_t index, uint32_t worker) {
    stoppable_run *run = data;
    if (atomic_load_explicit(&run->stopped, memory_order_relaxed)) return;
    run->task(run->data, run->first + index, worker);
    atomic_fetch_add_explicit(&run->done, 1, memory_order_relaxed);
    // Worker 0 of the built-in pool is the thread that called the library, on which the callback comes.
    if (run->context->pool && worker == 0) ask(run);
}

bool ewa_goes_on(ewa_context *context, uint32_t worker) {
    stoppable_run *run = context->run;
    if (!run) return true;
    if (context->pool && worker == 0) {
        const double now_s = ewa_now_s();
        if (now_s - run->asked_s >= ASKING_STEP_S) {
            run->asked_s = now_s;
            ask(run);
        }
    }
    return !atomic_load_explicit(&run->stopped, memory_order_relaxed);
}

ewa_status ewa_parallel_stoppable(ewa_context *context, const char *stage, ewa_task *task, void *data,
                                  uint32_t count) {
    return ewa_parallel_within(context, stage, 0, 1, task, data, count);
}

ewa_status ewa_parallel_within(ewa_context *context, const char *stage, double begin, double end, ewa_task *task, void *data,
                               uint32_t count) {
    enum { PARTS = 16 };
    stoppable_run run = {context, stage, begin, end, task, data, .count = count, .asked_s = ewa_now_s()};
    // Threads of others' executors may all be other ones: their runs are stopped between parts.
    const bool watched = context->options.progress || context->options.limits.max_seconds > 0;
    const uint32_t step = context->pool || !watched ? count : count / PARTS + 1;
    ewa_status status = ewa_progress(context, stage, begin);
    context->run = &run;
    for (; run.first < count && status == EWA_OK; run.first += step) {
        const uint32_t left = count - run.first;
        ewa_parallel(context, run_one, &run, left < step ? left : step);
        status = atomic_load(&run.stopped) ? EWA_CANCELLED : tell(&run);
    }
    context->run = NULL;
    return status;
}

uint64_t ewa_serial_next(ewa_context *context) {
    return (uint64_t)atomic_fetch_add_explicit(&context->serial, 1, memory_order_relaxed) + 1;
}

double ewa_now_s(void) { return ewa_platform_seconds(); }
