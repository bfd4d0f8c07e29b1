// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/colormap.c.
#include "check.h"

#include <math.h>
#include <stdlib.h>

static const ewa_colormap maps[] = {EWA_COLORMAP_VIRIDIS, EWA_COLORMAP_TURBO, EWA_COLORMAP_GRAY};

/// Known colours of the published tables, to within what lines between 33 samples leave.
static void test_known(void **state) {
    (void)state;
    static const struct {
        ewa_colormap map;
        double number;
        int rgb[3];
    } cases[] = {
        {EWA_COLORMAP_VIRIDIS, 0, {68, 1, 84}},      {EWA_COLORMAP_VIRIDIS, 1, {253, 231, 37}},
        {EWA_COLORMAP_VIRIDIS, 0.5, {33, 145, 140}}, {EWA_COLORMAP_TURBO, 0, {48, 18, 59}},
        {EWA_COLORMAP_TURBO, 1, {122, 4, 3}},        {EWA_COLORMAP_TURBO, 0.5, {164, 252, 60}},
        {EWA_COLORMAP_GRAY, 0.5, {128, 128, 128}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint8_t srgb[3];
        ewa_colormap_color(cases[i].map, cases[i].number, srgb);
        for (int c = 0; c < 3; c++) assert_true(abs(srgb[c] - cases[i].rgb[c]) <= 2);
    }
}

/// No jumps, and clamped outside of [0, 1].
static void test_smooth(void **state) {
    (void)state;
    for (int map = 0; map < 3; map++) {
        uint8_t last[3], next[3], end[3];
        ewa_colormap_color(maps[map], 0, last);
        ewa_colormap_color(maps[map], -INFINITY, next);
        assert_memory_equal(last, next, 3);
        ewa_colormap_color(maps[map], NAN, next);
        assert_memory_equal(last, next, 3);
        for (int i = 1; i <= 1000; i++) {
            ewa_colormap_color(maps[map], i / 1000.0, next);
            for (int c = 0; c < 3; c++) assert_true(abs(next[c] - last[c]) <= 2);
            for (int c = 0; c < 3; c++) last[c] = next[c];
        }
        ewa_colormap_color(maps[map], 7, end);
        assert_memory_equal(end, last, 3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_known), cmocka_unit_test(test_smooth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
