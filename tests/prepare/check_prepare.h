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
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_create(context, count, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)xyz), EWA_OK);
    return cloud;
}

static inline const float *check_stream(const ewa_cloud *cloud, const char *name) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    assert_non_null(attribute);
    assert_int_equal(attribute->type, EWA_F32);
    return attribute->data;
}

static inline ewa_estimate_options check_estimate_options(void) {
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
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

#endif
