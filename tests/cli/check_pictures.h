// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures that the program has written, for tests that look at their pixels.
#ifndef EWA_TESTS_CHECK_PICTURES_H
#define EWA_TESTS_CHECK_PICTURES_H

#include "run_ewa.h"

static ewa_context *context;

/// For cmocka's teardown.
static inline int leave(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// Loads a picture of the scratch folder; the caller frees it.
static inline ewa_image load(const char *name) {
    ewa_image image = {0};
    assert_int_equal(ewa_image_load(context, scratch_path(name), &image), EWA_OK);
    return image;
}

#endif
