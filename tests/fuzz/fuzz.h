// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The entry point of every fuzz target, as libFuzzer calls it, and what the targets share.
#ifndef EWA_TESTS_FUZZ_H
#define EWA_TESTS_FUZZ_H

#include "ewa/ewa.h"
#include "tests/defaults.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/// Tries one input; returns 0, or aborts when something does not hold that must.
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes);

static inline void fuzz_require(int holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "does not hold: %s\n", what);
    abort();
}

static inline void fuzz_message(void *user, ewa_severity severity, const char *text) {
    for (const char *c = text; *c; c++)
        fuzz_require((unsigned char)*c >= ' ', "messages are one line of text");
    if (user && severity == EWA_SEVERITY_ERROR) ++*(int *)user;
}

/// A context of `thread_count` workers with 64 MiB that counts errors (NULL: it does not); `max_points` 0: the default.
static inline ewa_context_options fuzz_context_options(uint32_t thread_count, uint64_t max_points, int *errors) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = thread_count;
    options.message = fuzz_message;
    options.message_user = errors;
    options.limits.max_memory_bytes = 1 << 26;
    if (max_points) options.limits.max_points = max_points;
    return options;
}

static inline ewa_context *fuzz_context_of(const ewa_context_options *options) {
    ewa_context *context = NULL;
    fuzz_require(ewa_context_create(options, &context) == EWA_OK, "a context");
    return context;
}

static inline ewa_context *fuzz_context(uint32_t thread_count, uint64_t max_points, int *errors) {
    const ewa_context_options options = fuzz_context_options(thread_count, max_points, errors);
    return fuzz_context_of(&options);
}

#endif
