// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/image.c: creation, limits, comparison.
#include "check.h"
#include "image_difference.h"

#include <math.h>
#include <string.h>

TEST_LOGGED(test_create_and_free, 1) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, 3, 2, 4, &image), EWA_OK);
    for (int i = 0; i < 24; i++) assert_true(image.pixels[i] == 0);
    ewa_image_free(&image);
    assert_null(image.pixels);
    ewa_image_free(&image);
    ewa_image_free(NULL);
    assert_int_equal(ewa_image_create(context, 0, 2, 4, &image), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_image_create(context, 1, 2, 17, &image), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_image_create(context, 65537, 1, 1, &image), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log->text, "65537 x 1"));
}

/// What many tests measure with.
TEST_ON(test_difference, 1) {
    OWNED(ewa_image_free) ewa_image a, b, c;
    assert_int_equal(ewa_image_create(context, 2, 2, 3, &a), EWA_OK);
    assert_int_equal(ewa_image_create(context, 2, 2, 3, &b), EWA_OK);
    assert_int_equal(ewa_image_create(context, 2, 2, 4, &c), EWA_OK);
    image_difference d = image_compare(&a, &b, 0);
    assert_true(d.rms == 0 && d.maximum == 0 && isinf(d.psnr_db) && d.over_threshold_count == 0);

    a.pixels[4] = 0.5f;  // pixel 1
    b.pixels[9] = 0.25f; // pixel 3
    d = image_compare(&a, &b, 0.25);
    assert_true(d.maximum == 0.5 && d.over_threshold_count == 1);
    assert_true(fabs(d.rms - sqrt(0.3125 / 12)) < 1e-15);
    assert_true(fabs(d.psnr_db - 15.843311) < 1e-5);

    a.pixels[0] = b.pixels[0] = NAN;
    a.pixels[2] = b.pixels[2] = INFINITY;
    assert_true(image_compare(&a, &b, 0).maximum == 0.5);
    b.pixels[0] = 0;
    d = image_compare(&a, &b, 0);
    assert_true(isinf(d.maximum) && isinf(d.rms) && d.psnr_db < 0);
    d = image_compare(&a, &c, 0);
    assert_true(isinf(d.maximum) && d.psnr_db < 0 && d.over_threshold_count == 4);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
