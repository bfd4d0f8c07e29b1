// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resolve kernels by themselves: 8-bit codes of all linear values in steps of 1 / 65535, alpha, the
// background where nothing is, and pictures that end inside a block.
#include "tests/check.h"

#include "base/base.h"
#include "image/srgb.h"
#include "surface/pipeline.h"

#include <math.h>
#include <string.h>

enum { SIDE_PX = 64, PIXELS = SIDE_PX * SIDE_PX, CHANNELS = 4, VALUES = 65536 };

static const uint32_t FEATURES[] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
enum { FEATURE_SETS = sizeof FEATURES / sizeof FEATURES[0] };

/// The kernels of one of FEATURES as far as the processor has them.
static const ewa_pipeline_kernels *kernels_of(size_t set) {
    return EWA_CHOOSE(FEATURES[set] & ewa_cpu_detect(), ewa_pipeline_kernels);
}

static ewa_resolve plain_resolve(uint8_t *rgba8, uint32_t width_px) {
    return (ewa_resolve){.unit_coverage_inverse = 1,
                         .alpha_scale = 1,
                         .edge_antialiasing = true,
                         .color_unit = 1,
                         .material = {1},
                         .width_px = width_px,
                         .rgba8 = rgba8};
}

/// Sets a pixel of a tile of SIDE_PX.
static void set_sums(float *sums, uint32_t pixel, const float values[CHANNELS]) {
    const uint32_t x = pixel % SIDE_PX, y = pixel / SIDE_PX;
    const uint32_t block = y / EWA_BLOCK_PX * (SIDE_PX / EWA_BLOCK_PX) + x / EWA_BLOCK_PX;
    const uint32_t lane = y % EWA_BLOCK_PX * EWA_BLOCK_PX + x % EWA_BLOCK_PX;
    for (uint32_t c = 0; c < CHANNELS; c++) sums[(block * CHANNELS + c) * EWA_BLOCK_LANES + lane] = values[c];
}

static ewa_tile whole_tile(float *sums) {
    static uint32_t finalized_rows[SIDE_PX / EWA_BLOCK_PX];
    memset(finalized_rows, 0xff, sizeof finalized_rows);
    return (ewa_tile){.width_px = SIDE_PX,
                      .height_px = SIDE_PX,
                      .blocks_per_row = SIDE_PX / EWA_BLOCK_PX,
                      .block_rows = SIDE_PX / EWA_BLOCK_PX,
                      .sums = {.planes = sums},
                      .channel_count = CHANNELS,
                      .finalized_rows = finalized_rows};
}

static void assert_code(uint32_t value, uint8_t code) {
    const double exact = 255 * ewa_srgb_encode(value / 65535.0);
    // Half a code, and a thousandth.
    if (fabs(code - exact) > 0.501) fail_msg("%u / 65535: code %u, exactly %.6f", value, code, exact);
}

TEST(test_codes_are_those_of_the_curve) {
    OWNED(check_free) float *sums = calloc(PIXELS * CHANNELS, sizeof *sums);
    OWNED(check_free) uint8_t *rgba8 = calloc(PIXELS, 4);
    const ewa_tile tile = whole_tile(sums);
    const ewa_resolve to = plain_resolve(rgba8, SIDE_PX);
    for (size_t set = 0; set < FEATURE_SETS; set++) {
        for (uint32_t first = 0; first < VALUES; first += PIXELS) {
            for (uint32_t i = 0; i < PIXELS; i++) {
                const float v = (float)((first + i) / 65535.0);
                set_sums(sums, i, (float[CHANNELS]){2, 2 * v, 2 - 2 * v, v}); // weighted by 2: v, 1 - v, v/2
            }
            kernels_of(set)->resolve(&tile, &to, NULL, NULL);
            for (uint32_t i = 0; i < PIXELS; i++) {
                assert_code(first + i, rgba8[4 * i]);
                assert_code(VALUES - 1 - first - i, rgba8[4 * i + 1]);
                if ((first + i) % 2 == 0) assert_code((first + i) / 2, rgba8[4 * i + 2]);
                assert_int_equal(rgba8[4 * i + 3], 255);
            }
        }
    }
}

/// Values that no picture should hold stay within the codes.
TEST(test_codes_are_clamped) {
    OWNED(check_free) float *sums = calloc(PIXELS * CHANNELS, sizeof *sums);
    OWNED(check_free) uint8_t *rgba8 = calloc(PIXELS, 4);
    const ewa_tile tile = whole_tile(sums);
    const ewa_resolve to = plain_resolve(rgba8, SIDE_PX);
    set_sums(sums, 0, (float[CHANNELS]){1, 7, -3, 1e30f});
    set_sums(sums, 1, (float[CHANNELS]){1, INFINITY, -INFINITY, NAN});
    set_sums(sums, 2, (float[CHANNELS]){1e-30f, 1e-30f, 1e-31f, 0});
    for (size_t set = 0; set < FEATURE_SETS; set++) {
        memset(rgba8, 99, PIXELS * 4);
        kernels_of(set)->resolve(&tile, &to, NULL, NULL);
        assert_memory_equal(rgba8, ((uint8_t[]){255, 0, 255, 255, 255, 0, 0, 255}), 8);
        assert_int_equal(rgba8[11], 0); // hardly there
        assert_memory_equal(rgba8 + 12, ((uint8_t[4]){0}), 4);
    }
}

/// A tile of which the picture holds 37x30 pixels, with covered, half covered and empty ones: alpha, colour
/// over the background, nothing beyond the picture's edge, the same in 8 bits as in floats.
TEST(test_partial_tile_over_background) {
    enum { WIDTH_PX = 37, HEIGHT_PX = 30, GUARD = 64 };
    OWNED(check_free) float *sums = calloc(PIXELS * CHANNELS, sizeof *sums);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float q = (float)(i % 5) / 4, v = (float)(i % 97) / 96;
        // The right half is empty, blocks and all.
        if (i % SIDE_PX < 20) set_sums(sums, i, (float[CHANNELS]){q, q * v, q * 0.25f, q * (1 - v)});
    }
    const ewa_tile tile = whole_tile(sums);
    ewa_tile narrow = tile;
    narrow.width_px = WIDTH_PX, narrow.height_px = HEIGHT_PX;
    narrow.blocks_per_row = (WIDTH_PX + 3) / 4, narrow.block_rows = (HEIGHT_PX + 3) / 4;
    float packed[(WIDTH_PX + 3) / 4 * ((HEIGHT_PX + 3) / 4) * CHANNELS * EWA_BLOCK_LANES];
    narrow.sums.planes = packed;
    const size_t row_floats = (size_t)narrow.blocks_per_row * CHANNELS * EWA_BLOCK_LANES;
    for (uint32_t row = 0; row < narrow.block_rows; row++)
        memcpy(packed + row * row_floats,
               sums + (size_t)row * tile.blocks_per_row * CHANNELS * EWA_BLOCK_LANES,
               row_floats * sizeof *packed);
    uint8_t first[WIDTH_PX * HEIGHT_PX * 4];
    for (size_t set = 0; set < FEATURE_SETS; set++) {
        for (int with_floats = 0; with_floats < 2; with_floats++) {
            OWNED(check_free) uint8_t *rgba8 = malloc(WIDTH_PX * HEIGHT_PX * 4 + GUARD);
            OWNED(check_free) float *rgba = malloc(WIDTH_PX * HEIGHT_PX * 4 * sizeof *rgba);
            memset(rgba8, 99, WIDTH_PX * HEIGHT_PX * 4 + GUARD);
            ewa_resolve to = plain_resolve(rgba8, WIDTH_PX);
            if (with_floats) to.rgba = rgba;
            to.background[1] = 0.25f, to.background[3] = 0.5f;
            kernels_of(set)->resolve(&narrow, &to, NULL, NULL);
            for (uint32_t i = 0; i < WIDTH_PX * HEIGHT_PX; i++) {
                const uint32_t x = i % WIDTH_PX, pixel = i / WIDTH_PX * SIDE_PX + x;
                const double q = x < 20 ? pixel % 5 / 4.0 : 0, v = pixel % 97 / 96.0;
                const double alpha = q + 0.5 * (1 - q);
                const double color[3] = {q * v, q * 0.25 + (1 - q) * 0.25, q * (1 - v)};
                assert_true(fabs(rgba8[4 * i + 3] - 255 * alpha) < 0.501);
                for (int c = 0; c < 3; c++) {
                    const double exact = 255 * ewa_srgb_encode(fmin(1, color[c] / alpha));
                    assert_true(fabs(rgba8[4 * i + (uint32_t)c] - exact) < 0.501);
                    if (with_floats) assert_true(fabs((double)rgba[4 * i + (uint32_t)c] - color[c]) < 1e-6);
                }
            }
            for (int i = 0; i < GUARD; i++) assert_int_equal(rgba8[WIDTH_PX * HEIGHT_PX * 4 + i], 99);
            if (set + (size_t)with_floats == 0) memcpy(first, rgba8, sizeof first);
            assert_memory_equal(first, rgba8, sizeof first);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
