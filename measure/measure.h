// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the programs of this folder share: they end with a message when something fails, and look at the clock.
#ifndef EWA_MEASURE_MEASURE_H
#define EWA_MEASURE_MEASURE_H

#include "defaults.h"
#include "ewa/ewa.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/// Ends the program when a call fails.
#define check(call) check_status(call, #call)

static inline void check_status(ewa_status status, const char *call) {
    if (status == EWA_OK) return;
    fprintf(stderr, "%s: %s\n", call, ewa_status_name(status));
    exit(1);
}

static inline void tell_of_failure(void *user, ewa_severity severity, const char *text) {
    (void)user;
    if (severity <= EWA_SEVERITY_WARNING) fprintf(stderr, "%s\n", text);
}

/// A context of so many workers (0: of all processors) that tells what fails.
static inline ewa_context *make_context(uint32_t thread_count) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = thread_count;
    options.message = tell_of_failure;
    ewa_context *context = NULL;
    check(ewa_context_create(&options, &context));
    return context;
}

/// Whether this is the run of a test (EWA_QUICK), which sees that the program works and wants few of everything.
static inline bool is_quick(void) { return getenv("EWA_QUICK") != NULL; }

static inline double now_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// For qsort().
static inline int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

#endif
