// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The session of a program that says nothing, for tests of what it is made of.
#ifndef EWA_TESTS_CHECK_SESSION_H
#define EWA_TESTS_CHECK_SESSION_H

#include "check.h"
#include "cli/base/session.h"

static cli_session session;

static inline int session_begin(void **state) {
    static const common_arguments common = {.threads = 1, .progress = 0};
    assert_true(session_start(&session, &common));
    return 0;
}

static inline int session_finish(void **state) {
    session_end(&session, 0);
    return 0;
}

#endif
