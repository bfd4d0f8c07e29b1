// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests of mesh files begin and end with: a context of one worker, and all that it said.
#ifndef EWA_TESTS_MESH_FIXTURE_H
#define EWA_TESTS_MESH_FIXTURE_H

#include "io/mesh_check.h"

static mesh_messages messages;
static ewa_context *context;

static inline int begin(void **state) {
    context = mesh_context(&messages);
    return 0;
}

static inline int end(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// A case with a context of its own.
#define CASE(name) TEST_WITHIN(name, begin, end)

#endif
