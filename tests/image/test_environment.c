// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/environment.c: levels keep constants and the mean over the sphere, round texels at the
// poles, clean numbers.
#include "image/environment.h"
#include "tests/check.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static ewa_environment *make(ewa_context *context, uint32_t width, uint32_t height, uint32_t channels,
                             float (*value)(uint32_t x, uint32_t y, uint32_t channel)) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, width, height, channels, &image), EWA_OK);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channels; c++)
                image.pixels[((size_t)y * width + x) * channels + c] = value(x, y, c);
    ewa_environment *made = NULL;
    assert_int_equal(ewa_environment_create(&image, &made), EWA_OK);
    ewa_image_free(&image);
    return made;
}

static float constant(uint32_t x, uint32_t y, uint32_t channel) {
    (void)x, (void)y;
    return 0.1f + (float)channel;
}

TEST_ON(test_constants_stay, 1) {
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {64, 32}, {37, 21}, {5, 40}, {100, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (uint32_t channels = 1; channels <= 4; channels++) {
            if (channels == 2) continue;
            OWNED(ewa_environment_destroy)
            ewa_environment *made = make(context, sizes[i][0], sizes[i][1], channels, constant);
            const ewa_environment_level *last = &made->levels[made->level_count - 1];
            assert_true(last->width == 1 && last->height == 1);
            for (uint32_t k = 0; k < made->level_count; k++) {
                const ewa_environment_level *level = &made->levels[k];
                for (size_t t = 0; t < 3 * (size_t)level->width * level->height; t++) {
                    const float wanted = 0.1f + (channels == 1 ? 0 : (float)(t % 3));
                    assert_true(fabsf(level->texels[t] - wanted) <= 1e-6f * wanted);
                }
            }
        }
}

static float noise(uint32_t x, uint32_t y, uint32_t channel) {
    check_random random = {x * 7919u + y * 104729u + channel};
    const double u = check_uniform(&random, 0, 1);
    return (float)(u * u * u * 50);
}

/// The mean light over the sphere, by the rows' areas.
static double mean_of(const ewa_environment_level *level) {
    double sum = 0, area = 0;
    for (uint32_t y = 0; y < level->height; y++) {
        const double share = cos(PI * y / level->height) - cos(PI * (y + 1) / level->height);
        for (uint32_t x = 0; x < level->width; x++) {
            sum += share * (double)level->texels[3 * ((size_t)y * level->width + x)];
            area += share;
        }
    }
    return sum / area;
}

TEST_ON(test_levels_keep_the_mean, 1) {
    OWNED(ewa_environment_destroy) ewa_environment *made = make(context, 96, 48, 3, noise);
    const double mean = mean_of(&made->levels[0]);
    for (uint32_t k = 1; k < made->level_count; k++)
        assert_true(fabs(mean_of(&made->levels[k]) / mean - 1) < 1e-3);
}

/// A single bright texel in the uppermost row covers as much of the sphere as one texel on the equator: a
/// third of the row, as the row's texels are about pi / 2 H times as wide as high.
static float lone_texel(uint32_t x, uint32_t y, uint32_t channel) {
    (void)channel;
    return (x == 10 && y == 0) || (x == 40 && y == 16);
}

TEST_ON(test_texels_are_round, 1) {
    enum { WIDTH = 64, HEIGHT = 32 };
    OWNED(ewa_environment_destroy) ewa_environment *made = make(context, WIDTH, HEIGHT, 1, lone_texel);
    const float *row = made->levels[0].texels;
    uint32_t bright = 0;
    double sum = 0;
    for (uint32_t x = 0; x < WIDTH; x++) {
        bright += row[3 * x] > 0;
        sum += (double)row[3 * x];
    }
    assert_true(fabs(sum - 1) < 1e-5);
    assert_int_equal(bright, 21); // WIDTH / pi, rounded to whole texels about the middle one
    const float *equator = row + 3 * 16 * WIDTH;
    // sin of half a texel from the equator: texels there are wider than high by a thousandth.
    assert_true(fabsf(equator[3 * 40] - 1) < 2e-3f && fabsf(equator[3 * 39]) < 2e-3f);
}

static float wild(uint32_t x, uint32_t y, uint32_t channel) {
    static const float values[] = {-1, NAN, INFINITY, 1e30f, 0, 2};
    return values[(x + y + channel) % 6];
}

TEST_LOGGED(test_wild_numbers, 1) {
    ewa_environment *made = make(context, 12, 6, 3, wild);
    for (uint32_t k = 0; k < made->level_count; k++)
        for (size_t t = 0; t < 3 * (size_t)made->levels[k].width * made->levels[k].height; t++)
            assert_true(made->levels[k].texels[t] >= 0 && made->levels[k].texels[t] <= 1e8f);
    ewa_environment_destroy(&made);
    ewa_environment_destroy(&made);
    ewa_image image;
    assert_int_equal(ewa_image_create(context, 2, 2, 2, &image), EWA_OK);
    assert_int_equal(ewa_environment_create(&image, &made), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "2 channels"));
    assert_null(made);
    image.width_px = 0; // pixels without a size
    assert_int_equal(ewa_environment_create(&image, &made), EWA_ERROR_ARGUMENT);
    image.width_px = 2;
    ewa_image_free(&image);
    assert_int_equal(ewa_environment_create(&image, &made), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
