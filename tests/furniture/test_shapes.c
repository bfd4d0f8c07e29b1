// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/furniture/shapes.c: lines and rectangles.
#include <math.h>

#include "painting.h"

static const uint8_t white[4] = {255, 255, 255, 255}, orange[4] = {250, 120, 20, 255};
static const double pi = 3.14159265358979323846;

/// A level line three pixels wide covers three rows, and nothing of those beside them.
TEST(test_rows) {
    ewa_canvas canvas = painting_empty(100, 40);
    ewa_draw_line(&canvas, 10, 20.5, 90, 20.5, 3, white);
    for (uint32_t x = 12; x < 88; x++)
        for (uint32_t y = 0; y < 40; y++)
            assert_int_equal(painting_at(&canvas, x, y)[3], y >= 19 && y <= 21 ? 255 : 0);
    // Half a pixel down: half of the first row and half of one more.
    painting_clear(&canvas);
    ewa_draw_line(&canvas, 10, 21, 90, 21, 3, white);
    static const int rows[] = {0, 128, 255, 255, 128, 0};
    for (uint32_t x = 12; x < 88; x++)
        for (uint32_t y = 18; y < 24; y++) assert_int_equal(painting_at(&canvas, x, y)[3], rows[y - 18]);
    // A quarter of a pixel wide, within one row, and across two.
    painting_clear(&canvas);
    ewa_draw_line(&canvas, 10, 20.5, 90, 20.5, 0.25, white);
    ewa_draw_line(&canvas, 10, 30, 90, 30, 0.25, white);
    assert_int_equal(painting_at(&canvas, 50, 20)[3], 64);
    assert_int_equal(painting_at(&canvas, 50, 29)[3], 32);
    assert_int_equal(painting_at(&canvas, 50, 30)[3], 32);
    free(canvas.rgba8);
}

/// In every direction a line covers its area: a rectangle and two halves of a disc.
TEST(test_area) {
    check_random random = {1};
    ewa_canvas canvas = painting_empty(300, 300);
    for (int k = 0; k < 200; k++) {
        const double angle = check_uniform(&random, 0, 2 * pi), length = check_uniform(&random, 60, 130);
        const double width = check_uniform(&random, 2, 12);
        const double x = check_uniform(&random, 149, 151), y = check_uniform(&random, 149, 151);
        painting_clear(&canvas);
        ewa_draw_line(&canvas, x, y, x + length * cos(angle), y + length * sin(angle), width, white);
        const double area = length * width + pi * width * width / 4;
        assert_true(fabs(painting_area(&canvas) - area) <= 0.01 * area);
        painting_clear(&canvas);
        ewa_draw_line(&canvas, x, y, x, y, 5 * width, white);
        const double disc = pi * 25 * width * width / 4;
        assert_true(fabs(painting_area(&canvas) - disc) <= 0.01 * disc);
    }
    free(canvas.rgba8);
}

/// A rectangle covers its exact part of each pixel, whichever corners it is given by.
TEST(test_rectangle) {
    ewa_canvas canvas = painting_empty(20, 20), other = painting_empty(20, 20);
    ewa_draw_rectangle(&canvas, 3.25, 4.5, 9.75, 12, white);
    ewa_draw_rectangle(&other, 9.75, 4.5, 3.25, 12, white);
    assert_true(painting_same(&canvas, &other));
    assert_int_equal(painting_at(&canvas, 3, 8)[3], 191);
    assert_int_equal(painting_at(&canvas, 9, 8)[3], 191);
    assert_int_equal(painting_at(&canvas, 3, 4)[3], 96);
    assert_int_equal(painting_at(&canvas, 6, 4)[3], 128);
    assert_int_equal(painting_at(&canvas, 6, 11)[3], 255);
    assert_int_equal(painting_at(&canvas, 6, 12)[3], 0);
    assert_int_equal(painting_at(&canvas, 2, 8)[3], 0);
    assert_true(fabs(painting_area(&canvas) - 6.5 * 7.5) < 0.1);
    // Within one pixel, and without any extent.
    painting_clear(&canvas);
    ewa_draw_rectangle(&canvas, 5.25, 5.25, 5.75, 5.75, white);
    assert_int_equal(painting_at(&canvas, 5, 5)[3], 64);
    painting_clear(&canvas);
    ewa_draw_rectangle(&canvas, 5, 5, 5, 15, white);
    assert_true(painting_area(&canvas) == 0);
    free(canvas.rgba8), free(other.rgba8);
}

/// Colours are mixed in linear light, alpha stays straight, and what is covered whole has the very colour.
TEST(test_blending) {
    ewa_canvas canvas = painting_make(10, 1, (const uint8_t[4]){0, 0, 0, 255});
    ewa_draw_rectangle(&canvas, 0, 0, 1.5, 1, white);
    assert_memory_equal(painting_at(&canvas, 0, 0), white, 4);
    assert_memory_equal(painting_at(&canvas, 1, 0), ((const uint8_t[4]){188, 188, 188, 255}), 4);
    assert_memory_equal(painting_at(&canvas, 2, 0), ((const uint8_t[4]){0, 0, 0, 255}), 4);
    painting_clear(&canvas);
    ewa_draw_rectangle(&canvas, 0, 0, 1.5, 1, orange);
    assert_memory_equal(painting_at(&canvas, 0, 0), orange, 4);
    assert_memory_equal(painting_at(&canvas, 1, 0), ((const uint8_t[4]){250, 120, 20, 128}), 4);
    const uint8_t glass[4] = {255, 0, 0, 51};
    ewa_draw_rectangle(&canvas, 5, 0, 6, 1, glass);
    assert_memory_equal(painting_at(&canvas, 5, 0), glass, 4);
    ewa_draw_rectangle(&canvas, 7, 0, 8, 1, (const uint8_t[4]){0, 0, 0, 255});
    ewa_draw_rectangle(&canvas, 7, 0, 8, 1, glass);
    assert_memory_equal(painting_at(&canvas, 7, 0), ((const uint8_t[4]){124, 0, 0, 255}), 4);
    ewa_draw_rectangle(&canvas, 0, 0, 1, 1, (const uint8_t[4]){1, 2, 3, 0});
    assert_memory_equal(painting_at(&canvas, 0, 0), orange, 4);
    free(canvas.rgba8);
}

/// What is not finite, too far, or no width leaves the canvas alone; what is near is clipped.
TEST(test_hostile) {
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1.1e6};
    static const double bad_widths[] = {NAN, INFINITY, 0, -1, 1e9, 10001};
    ewa_canvas canvas = painting_empty(17, 5);
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        for (int place = 0; place < 4; place++) {
            double at[4] = {1, 1, 12, 4};
            at[place] = bad[k];
            ewa_draw_line(&canvas, at[0], at[1], at[2], at[3], 2, white);
            ewa_draw_rectangle(&canvas, at[0], at[1], at[2], at[3], white);
        }
        ewa_draw_line(&canvas, 1, 1, 12, 4, bad_widths[k], white);
    }
    assert_true(painting_area(&canvas) == 0);
    ewa_draw_line(&canvas, -9e5, 2.5, 9e5, 2.5, 1, white);
    assert_true(painting_area(&canvas) == 17);
    ewa_draw_line(&canvas, -9e5, -8e5, 9e5, 9.9e5, 10000, orange);
    ewa_draw_rectangle(&canvas, -9e5, -9e5, 9e5, 9e5, white);
    assert_true(painting_area(&canvas) == 17 * 5);
    check_random random = {2};
    for (int k = 0; k < 3000; k++) {
        double at[4];
        for (int i = 0; i < 4; i++) at[i] = check_uniform(&random, -30, 40);
        ewa_draw_line(&canvas, at[0], at[1], at[2], at[3], check_uniform(&random, 0, 30), orange);
        ewa_draw_rectangle(&canvas, at[0], at[1], at[2], at[3], white);
    }
    free(canvas.rgba8);
}

/// Rows are clipped to what the line can reach: the same as looking at every pixel.
TEST(test_reach) {
    check_random random = {3};
    ewa_canvas canvas = painting_empty(50, 50);
    for (int k = 0; k < 500; k++) {
        double at[4];
        for (int i = 0; i < 4; i++) at[i] = check_uniform(&random, -10, 60);
        if (k % 3 == 0) at[3] = at[1];
        if (k % 3 == 1) at[2] = at[0];
        const double width = check_uniform(&random, 0.2, 9), dx = at[2] - at[0], dy = at[3] - at[1];
        painting_clear(&canvas);
        ewa_draw_line(&canvas, at[0], at[1], at[2], at[3], width, white);
        for (uint32_t y = 0; y < 50; y++) {
            for (uint32_t x = 0; x < 50; x++) {
                const double px = x + 0.5 - at[0], py = y + 0.5 - at[1];
                const double part = fmin(fmax((px * dx + py * dy) / (dx * dx + dy * dy), 0), 1);
                const double off = hypot(px - part * dx, py - part * dy);
                const double cover = fmax(fmin(off + 0.5, width / 2) - fmax(off - 0.5, -width / 2), 0);
                assert_true(fabs(painting_at(&canvas, x, y)[3] - 255 * cover) <= 0.51);
            }
        }
    }
    free(canvas.rgba8);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
