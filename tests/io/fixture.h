// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests of files begin and end with: a context of FIXTURE_THREADS workers, and the last that it said. Comes last of all
// headers, whose functions have arguments of these names.
#ifndef EWA_TESTS_FIXTURE_H
#define EWA_TESTS_FIXTURE_H

#include "check.h"

#ifndef FIXTURE_THREADS
#define FIXTURE_THREADS 2
#endif

static check_log messages;
static ewa_context *context;

static inline int begin(void **state) {
    messages = (check_log){0};
    context = check_context(FIXTURE_THREADS, &messages);
    return 0;
}

static inline int end(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// A case with a context of its own.
#define CASE(name) TEST_WITHIN(name, begin, end)

#endif
