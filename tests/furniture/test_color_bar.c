// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/furniture/color_bar.c: scales and legends.
#include <math.h>

#include "furniture/decimal.h"
#include "furniture/layout.h"
#include "drawing.h"

/// The colour bar has the colormap's colours, the last one at the top; a legend has those of its categories.
TEST(test_colors) {
    ewa_canvas canvas = painting_make(1280, 720, white);
    const ewa_camera camera = map_camera(&canvas, 10);
    ewa_furniture_options options = no_furniture();
    options.color_bar = true;
    options.color_label = "height";
    options.color_unit = "m";
    static const double ranges[][2] = {{0, 1}, {1, 0}, {4200000.5, 4200001}, {-1e300, 1e300}};
    for (int k = 0; k < 4; k++) {
        memset(canvas.rgba8, 255, 1280 * 720 * 4);
        memcpy(options.range, ranges[k], sizeof options.range);
        draw(&canvas, &camera, &options);
        uint8_t low[3], high[3];
        ewa_colormap_color(EWA_COLORMAP_VIRIDIS, 0.001, low);
        ewa_colormap_color(EWA_COLORMAP_VIRIDIS, 0.999, high);
        uint32_t low_y = 0, high_y = 0;
        for (uint32_t y = 0; y < 720; y++) {
            for (uint32_t x = 800; x < 1280; x++) {
                const uint8_t *pixel = painting_at(&canvas, x, y);
                if (memcmp(pixel, low, 3) == 0) low_y = y;
                if (memcmp(pixel, high, 3) == 0 && !high_y) high_y = y;
            }
        }
        assert_true(high_y > 100 && low_y < 700 && low_y - high_y >= 295 && low_y - high_y <= 300);
    }
    memset(canvas.rgba8, 255, 1280 * 720 * 4);
    ewa_category categories[60];
    for (uint32_t k = 0; k < 60; k++)
        categories[k] = (ewa_category){.value = k, .name = NULL, .srgb = {255, (uint8_t)(4 * k), 0}};
    options.categories = categories;
    options.category_count = 60;
    draw(&canvas, &camera, &options);
    uint32_t shown = 0, last = 720;
    for (uint32_t k = 0; k < 60; k++) {
        uint32_t found = 0;
        for (uint32_t y = 0; y < 720 && !found; y++)
            for (uint32_t x = 1000; x < 1280 && !found; x++)
                if (memcmp(painting_at(&canvas, x, y), categories[k].srgb, 3) == 0) found = y;
        if (!found) break;
        assert_true(k == 0 || found == last + 18);
        last = found;
        shown++;
    }
    assert_in_range(shown, 33, 37);
    free(canvas.rgba8);
}

/// A colour bar as it was drawn: the pixels of its colours, and rows of the marks of its ticks.
typedef struct found_bar {
    uint32_t left, right, top, bottom; ///< first, and one behind the last
    uint32_t tick_count, ticks[64];    ///< first rows, from the top
} found_bar;

/// Whether a pixel has one of a colormap's colours.
static bool is_mapped(const uint8_t *pixel) {
    for (int k = 0; k <= 1024; k++) {
        uint8_t srgb[3];
        ewa_colormap_color(EWA_COLORMAP_VIRIDIS, k / 1024.0, srgb);
        if (abs(srgb[0] - pixel[0]) <= 1 && abs(srgb[1] - pixel[1]) <= 1 && abs(srgb[2] - pixel[2]) <= 1) return true;
    }
    return false;
}

static found_bar find_bar(const ewa_canvas *canvas) {
    found_bar bar = {.left = canvas->width_px};
    uint32_t x = canvas->width_px, y = canvas->height_px / 2 + 40; // beside no text of a tick that is as bright
    while (x-- > 0 && !is_mapped(painting_at(canvas, x, y))) {}
    if (x == UINT32_MAX) return bar;
    bar.right = x + 1;
    while (is_mapped(painting_at(canvas, x - 1, y))) x--;
    bar.left = x;
    for (bar.top = y; is_mapped(painting_at(canvas, x, bar.top - 1)); bar.top--) {}
    for (bar.bottom = y; is_mapped(painting_at(canvas, x, bar.bottom)); bar.bottom++) {}
    for (y = 0; y < canvas->height_px; y++) { // behind the frame, before the texts
        const bool mark = is_dark(painting_at(canvas, bar.right + 3, y));
        if (mark && !is_dark(painting_at(canvas, bar.right + 3, y - 1)) && bar.tick_count < 64)
            bar.ticks[bar.tick_count++] = y;
    }
    return bar;
}

/// The colour bar stands on whole pixels at the right end of the room that its widest number leaves, and its ticks are
/// where their numbers are, no nearer to each other than 30 points.
TEST(test_color_bar_places) {
    static const double scales[] = {1, 1.3, 1.9}, ranges[][2] = {{0, 1}, {-3, 12}, {-1.7e308, 1.7e308}};
    for (uint32_t height = 250; height < 560; height += 31)
        for (int k = 0; k < 9; k++) {
            const double point = scales[k % 3], *range = ranges[k / 3];
            ewa_canvas canvas = painting_make(1000, height, white);
            const ewa_camera camera = map_camera(&canvas, 1);
            ewa_furniture_options options = no_furniture();
            options.color_bar = true;
            options.pixel_scale = point;
            memcpy(options.range, range, sizeof options.range);
            draw(&canvas, &camera, &options);
            const found_bar bar = find_bar(&canvas);
            free(canvas.rgba8);
            assert_true(bar.right > bar.left && bar.tick_count >= 1);
            const double tall = bar.bottom - bar.top, room = height - 2 * floor(14 * point) - 12 * point;
            assert_int_equal(bar.right - bar.left, floor(14 * point));
            assert_true(tall == floor(fmin(fmin(room, 0.6 * height), 300 * point)));
            const double above = floor(14 * point) + 6 * point + (room - tall) / 2; // half a text over the middle
            assert_true(bar.top <= above && bar.top > above - 1);
            double widest_px = 0;
            ewa_ticks ticks;
            assert_true(ewa_ticks_find(range[0], range[1], (uint32_t)floor(tall / point / 30), &ticks));
            for (int64_t i = ticks.first; i <= ticks.last; i++) {
                char text[EWA_DECIMAL_BYTES];
                ewa_decimal_write(ewa_ticks_at(&ticks, i), text);
                widest_px = fmax(widest_px, ewa_text_width_px(text, 12 * point));
            }
            const double end = 1000 - floor(14 * point) - 10 * point - widest_px;
            assert_true(bar.right <= end && bar.right > end - 1);
            assert_int_equal(bar.tick_count, ticks.last - ticks.first + 1);
            for (uint32_t i = 0; i < bar.tick_count; i++) {
                const double value = ewa_decimal_value(ewa_ticks_at(&ticks, ticks.last - (int64_t)i));
                const double share = (value / 2 - range[0] / 2) / (range[1] / 2 - range[0] / 2);
                const double middle = bar.bottom - share * tall, thick = fmax(1, floor(point));
                assert_true(fabs(bar.ticks[i] + thick / 2 - middle) <= 0.5 + thick);
                if (i) assert_true(bar.ticks[i] - bar.ticks[i - 1] >= 30 * point - 1);
            }
        }
}

/// In a picture as of a phone the colour bar lies below the middle, from the first colour at the left to the last at the right, and beside
/// nothing else; in one that is no quarter higher than wide it stands.
TEST(test_color_bar_lies) {
    static const uint32_t heights[] = {844, 487};
    for (int k = 0; k < 2; k++)
        for (int all = 0; all < 2; all++) {
            ewa_canvas canvas = painting_make(390, heights[k], white);
            const ewa_camera camera = map_camera(&canvas, 10);
            ewa_furniture_options options = no_furniture();
            options.color_bar = true;
            options.axes = options.scale_bar = all;
            options.pixel_scale = 1;
            options.range[0] = 1e6, options.range[1] = 1000250.5;
            draw(&canvas, &camera, &options);
            uint8_t low[3], high[3];
            ewa_colormap_color(EWA_COLORMAP_VIRIDIS, 0.001, low);
            ewa_colormap_color(EWA_COLORMAP_VIRIDIS, 0.999, high);
            uint32_t low_at[2] = {0}, high_at[2] = {0}, lowest = 0;
            for (uint32_t y = 0; y < heights[k]; y++)
                for (uint32_t x = 0; x < 390; x++) {
                    const uint8_t *pixel = painting_at(&canvas, x, y);
                    if (memcmp(pixel, low, 3) == 0) low_at[0] = x, low_at[1] = y;
                    if (memcmp(pixel, high, 3) == 0) high_at[0] = x, high_at[1] = y;
                    if (memcmp(pixel, white, 3) != 0) lowest = y;
                }
            const bool lies = heights[k] == 844;
            assert_true(low_at[0] > 0 && high_at[0] > 0);
            assert_int_equal(high_at[0] - low_at[0] > 250, lies);
            assert_int_equal(high_at[1] == low_at[1], lies);
            // Above what stands in the corners, 103 points high; else at the edge.
            if (lies) assert_true(low_at[1] > 600 && low_at[1] < (all ? 740u : 830u) && lowest < 844);
            free(canvas.rgba8);
        }
}

/// One number as range, and one that is too narrow to be told apart: no ticks that lie, no crash.
TEST(test_degenerate_ranges) {
    static const double ranges[][2] = {{5, 5},          {0, 0},           {1e16, 1e16 + 2},
                                       {-1e308, 1e308}, {5e-324, 1e-323}, {1e-310, 1}};
    for (size_t k = 0; k < sizeof ranges / sizeof ranges[0]; k++) {
        ewa_canvas canvas = painting_make(640, 480, white);
        const ewa_camera camera = map_camera(&canvas, 1);
        ewa_furniture_options options = no_furniture();
        options.color_bar = true;
        memcpy(options.range, ranges[k], sizeof options.range);
        draw(&canvas, &camera, &options);
        ewa_canvas bare = painting_make(640, 480, white);
        const bool bar = k < 2 || k == 3 || k == 5;
        assert_int_equal(painting_same(&canvas, &bare), !bar);
        free(canvas.rgba8), free(bare.rgba8);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
