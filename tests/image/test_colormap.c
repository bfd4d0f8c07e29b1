// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/colormap.c.
#include "check.h"

#include <math.h>
#include <stdlib.h>

static const ewa_colormap maps[] = {
    EWA_COLORMAP_VIRIDIS, EWA_COLORMAP_TURBO, EWA_COLORMAP_GRAY,    EWA_COLORMAP_PLASMA,
    EWA_COLORMAP_INFERNO, EWA_COLORMAP_MAGMA, EWA_COLORMAP_CIVIDIS, EWA_COLORMAP_COOLWARM,
};

enum { MAPS = sizeof maps / sizeof maps[0] };

/// Colours of the published tables, exact at their places: first, entry 128, last.
TEST(test_known) {
    static const struct {
        ewa_colormap map;
        uint8_t rgb[3][3];
    } cases[] = {
        {EWA_COLORMAP_VIRIDIS, {{68, 1, 84}, {33, 145, 140}, {253, 231, 37}}},
        {EWA_COLORMAP_TURBO, {{48, 18, 59}, {164, 252, 60}, {122, 4, 3}}},
        {EWA_COLORMAP_GRAY, {{0, 0, 0}, {128, 128, 128}, {255, 255, 255}}},
        {EWA_COLORMAP_PLASMA, {{13, 8, 135}, {204, 71, 120}, {240, 249, 33}}},
        {EWA_COLORMAP_INFERNO, {{0, 0, 4}, {188, 55, 84}, {252, 255, 164}}},
        {EWA_COLORMAP_MAGMA, {{0, 0, 4}, {183, 55, 121}, {252, 253, 191}}},
        {EWA_COLORMAP_CIVIDIS, {{0, 34, 78}, {125, 124, 120}, {254, 232, 56}}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        static const double places[] = {0, 128.0 / 255, 1};
        for (int k = 0; k < 3; k++) {
            uint8_t srgb[3];
            ewa_colormap_color(cases[i].map, places[k], srgb);
            assert_memory_equal(srgb, cases[i].rgb[k], 3);
        }
    }
}

/// Moreland's own table of "cool to warm" (33 places) at its ends, quarters and middle. Published rounded,
/// from another conversion to XYZ: within 4.
TEST(test_coolwarm) {
    static const int anchors[5][3] = {
        {59, 76, 192}, {141, 176, 254}, {221, 221, 221}, {244, 154, 123}, {180, 4, 38}};
    for (int k = 0; k < 5; k++) {
        uint8_t srgb[3];
        ewa_colormap_color(EWA_COLORMAP_COOLWARM, 0.25 * k, srgb);
        for (int c = 0; c < 3; c++) assert_true(abs(srgb[c] - anchors[k][c]) <= 4);
    }
}

/// CIE lightness of a colour.
static double lightness(ewa_colormap map, double number) {
    uint8_t srgb[3];
    ewa_colormap_color(map, number, srgb);
    const double y = 0.2126 * (double)ewa_linear_from_srgb((float)srgb[0] / 255) +
                     0.7152 * (double)ewa_linear_from_srgb((float)srgb[1] / 255) +
                     0.0722 * (double)ewa_linear_from_srgb((float)srgb[2] / 255);
    return y > 216.0 / 24389 ? 116 * cbrt(y) - 16 : y * 24389 / 27;
}

/// Sequential maps get lighter all the way, evenly; coolwarm rises to its middle and falls from there.
TEST(test_lightness) {
    for (int k = 0; k < MAPS; k++) {
        if (maps[k] == EWA_COLORMAP_TURBO) continue;
        const double low = lightness(maps[k], 0), high = lightness(maps[k], 1);
        for (int i = 1; i <= 64; i++) {
            const double rise = lightness(maps[k], i / 64.0) - lightness(maps[k], (i - 1) / 64.0);
            if (maps[k] == EWA_COLORMAP_COOLWARM)
                assert_true(i <= 32 ? rise > 0 : rise < 0);
            else
                assert_true(rise > 0 && rise < 3 * (high - low) / 64);
        }
    }
}

/// No jumps, and clamped outside of [0, 1].
TEST(test_smooth) {
    for (int map = 0; map < MAPS; map++) {
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

int main(void) { return RUN_TESTS(NULL, NULL); }
