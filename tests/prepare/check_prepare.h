// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds for the tests of estimation.
#ifndef EWA_TESTS_CHECK_PREPARE_H
#define EWA_TESTS_CHECK_PREPARE_H

#include "check.h"

#include <math.h>
#include <string.h>

/// A cloud of `count` positions with memory to fill; uninitialised.
static inline ewa_cloud *check_cloud(ewa_context *context, uint64_t count, float **xyz) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    return cloud;
}

static inline const float *check_stream(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    assert_int_equal(attribute->type, EWA_F32);
    return attribute->data;
}

static inline ewa_estimate_options check_estimate_options(void) {
    WITH_DEFAULTS(ewa_estimate_options, options);
    return options;
}

/// A random direction; returns it scaled to unit length.
static inline void check_direction(check_random *random, double d[3]) {
    double length2;
    do {
        length2 = 0;
        for (int c = 0; c < 3; c++) {
            d[c] = check_uniform(random, -1, 1);
            length2 += d[c] * d[c];
        }
    } while (length2 > 1 || length2 < 1e-4);
    for (int c = 0; c < 3; c++) d[c] /= sqrt(length2);
}

/// Says how far a call got and stops it after some reports.
typedef struct check_progress {
    const char *stage;
    int calls_left;
    double last;
} check_progress;

static inline bool check_progress_take(void *user, const char *stage, double fraction) {
    check_progress *progress = user;
    // Points are put in order and estimated within many stages: stages of their own, as often as that is needed.
    const bool orders =
        strcmp(stage, "order") == 0 || (strcmp(stage, "estimate") == 0 && strcmp(stage, progress->stage) != 0);
    if (!orders) assert_string_equal(stage, progress->stage);
    assert_true(fraction >= (orders ? 0 : progress->last) && fraction <= 1);
    if (!orders) progress->last = fraction;
    return progress->calls_left-- > 0;
}

/// Runs `work` with its first, second, ... report of progress cancelling it, until it succeeds: reports are
/// of `stage`, never go back and end with 1. Returns how many there are.
static inline int check_cancel_each(const char *stage, ewa_status (*work)(ewa_context *context, void *user),
                                    void *user) {
    for (int calls = 0;; calls++) {
        check_progress progress = {.stage = stage, .calls_left = calls};
        ewa_context *context = check_context_telling(0, check_progress_take, &progress);
        const ewa_status status = work(context, user);
        ewa_context_destroy(&context);
        if (status == EWA_OK) {
            assert_true(progress.last == 1);
            return calls;
        }
        assert_int_equal(status, EWA_CANCELLED);
    }
}

#endif
