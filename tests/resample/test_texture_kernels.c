// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of texture mapping by themselves, every instruction set against a plain definition in doubles:
// points and splats of blocks of odd sizes, seen from the front, slanted, beside the tile and behind the eye;
// pixels of every format.
#include "tests/check.h"

#include "base/base.h"
#include "texture/texture.h"

#include <math.h>

enum { ROWS = EWA_TEXTURE_TILE + 8, NUMBERS = EWA_TEXTURE_PITCH * ROWS, BLOCKS = 60, SETS = 3 };

/// The kernels of each instruction set that the processor has; plain C in place of others.
static void kernel_sets(const ewa_texture_kernels *sets[SETS]) {
    static const uint32_t masks[SETS] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    for (int i = 0; i < SETS; i++) sets[i] = EWA_CHOOSE(masks[i] & ewa_cpu_detect(), ewa_texture_kernels);
}

/// A block of texels under a map of the plane, and the filter.
typedef struct task {
    double map[3][3]; ///< [u v 1] map; (u, v) of the block's first texel is (0, 0)
    double cutoff, prefilter_px, sigma;
    ewa_texture_block block;
    ewa_texel_filter filter;
} task;

static double determinant(double m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static void make_task(check_random *random, bool as_points, task *made) {
    static const uint32_t sizes[][2] = {{1, 1}, {32, 8}, {17, 3}, {31, 7}, {16, 1}, {5, 8}};
    const uint32_t *size = sizes[check_random_u64(random) % 6];
    *made = (task){.cutoff = check_uniform(random, 1, 4), .sigma = check_uniform(random, 0.3, 2)};
    // Points: filters of one pixel, and wider ones.
    made->prefilter_px = check_random_u64(random) % 2 ? check_uniform(random, 0.1, 0.9 / made->cutoff)
                                                      : check_uniform(random, 0.3, 2);
    const double step = as_points ? 0.4 : 3;
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 2; c++) made->map[i][c] = check_uniform(random, -step, step);
    for (int c = 0; c < 2; c++) {
        // w runs from 1 to a little less or more; points may lie behind the eye.
        made->map[c][2] = check_uniform(random, -1, 1) * (as_points ? 0.06 : 0.012);
        made->map[2][c] = check_uniform(random, -12, 76);
    }
    made->map[2][2] = 1;
    made->block.width = size[0], made->block.height = size[1];
    for (int c = 0; c < 3; c++) {
        made->block.step_u[c] = (float)made->map[0][c], made->block.step_v[c] = (float)made->map[1][c];
        for (uint32_t row = 0; row < size[1]; row++)
            made->block.row_start[row][c] = (float)(made->map[2][c] + row * made->map[1][c]);
    }
    for (uint32_t row = 0; row < EWA_TEXTURE_NODE_V; row++)
        for (uint32_t i = 0; i < EWA_TEXTURE_NODE_U; i++)
            for (int c = 0; c < 4; c++) made->block.colors[row][i][c] = (float)check_uniform(random, 0, 1);
    const double area = fabs(determinant(made->map)) * made->sigma * made->sigma;
    made->block.area_scale = (float)area;
    made->filter = (ewa_texel_filter){.cutoff2 = (float)(made->cutoff * made->cutoff),
                                      .prefilter2 = (float)(made->prefilter_px * made->prefilter_px),
                                      .reach_px = (float)(made->cutoff * made->prefilter_px),
                                      .sigma = (float)made->sigma,
                                      .determinant = (float)area};
}

/// A kernel on the screen: weight = amplitude exp(-r^2 / 2) where r^2 < F^2.
typedef struct ellipse {
    double center[2], inverse[3], amplitude;
} ellipse;

/// A texel as a disc of `sigma`, by its dual conic D = M' diag(F^2 s^2, F^2 s^2, 0) M - p' p, or as a point.
static bool see(const task *of, uint32_t column, uint32_t row, bool as_point, ellipse *seen) {
    double p[3], D[3][3];
    for (int c = 0; c < 3; c++) p[c] = column * of->map[0][c] + row * of->map[1][c] + of->map[2][c];
    if (!(p[2] > 0)) return false;
    const double h2 = of->prefilter_px * of->prefilter_px, F2 = of->cutoff * of->cutoff;
    double map[3][3];
    for (int i = 0; i < 9; i++) map[i / 3][i % 3] = of->map[i / 3][i % 3];
    const double area = fabs(determinant(map)) * of->sigma * of->sigma;
    if (as_point) {
        *seen = (ellipse){{p[0] / p[2], p[1] / p[2]}, {1 / h2, 0, 1 / h2}, area / (p[2] * p[2] * p[2] * h2)};
        return true;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            D[a][b] =
                F2 * of->sigma * of->sigma * (of->map[0][a] * of->map[0][b] + of->map[1][a] * of->map[1][b]) -
                p[a] * p[b];
    if (!(D[2][2] < 0)) return false;
    const double c[2] = {D[0][2] / D[2][2], D[1][2] / D[2][2]};
    const double xx = (c[0] * c[0] - D[0][0] / D[2][2]) / F2, xy = (c[0] * c[1] - D[0][1] / D[2][2]) / F2,
                 yy = (c[1] * c[1] - D[1][1] / D[2][2]) / F2;
    const double filtered = (xx + h2) * (yy + h2) - xy * xy;
    *seen = (ellipse){{c[0], c[1]},
                      {(yy + h2) / filtered, -xy / filtered, (xx + h2) / filtered},
                      sqrt((xx * yy - xy * xy) / filtered)};
    return true;
}

/// Sums of a block: colours and weights, and how much a surfel at its cutoff may make of rounding.
static void sum_plainly(const task *of, bool as_points, double *color, double *weight, double *doubt) {
    const double F2 = of->cutoff * of->cutoff;
    for (uint32_t row = 0; row < of->block.height; row++)
        for (uint32_t column = 0; column < of->block.width; column++) {
            ellipse e;
            if (!see(of, column, row, as_points, &e)) continue;
            for (int y = 0; y < EWA_TEXTURE_TILE; y++)
                for (int x = 0; x < EWA_TEXTURE_TILE; x++) {
                    const double dx = x + 0.5 - e.center[0], dy = y + 0.5 - e.center[1];
                    const double r2 =
                        e.inverse[0] * dx * dx + 2 * e.inverse[1] * dx * dy + e.inverse[2] * dy * dy;
                    const double w = e.amplitude * exp(-r2 / 2);
                    const int at = y * EWA_TEXTURE_TILE + x;
                    if (fabs(r2 - F2) < 1e-3 * F2) doubt[at] += w;
                    if (!(r2 < F2)) continue;
                    weight[at] += w;
                    for (int c = 0; c < 4; c++)
                        color[4 * at + c] += w * (double)of->block.colors[row][column][c];
                }
        }
}

/// Draws one task by every set; the first one is held to the definition, the others to the first one's bytes.
static void hold(const ewa_texture_kernels **sets, const task *of, bool as_points, bool with_weight) {
    static float color[SETS][4 * NUMBERS], weight[SETS][NUMBERS];
    static double plain_color[4 * 64 * 64], plain_weight[64 * 64], doubt[64 * 64];
    uint32_t drawn[SETS] = {0};
    for (uint32_t k = 0; k < SETS; k++) {
        memset(color[k], 0, sizeof color[k]), memset(weight[k], 0, sizeof weight[k]);
        const ewa_texture_sums sums = {color[k], with_weight ? weight[k] : NULL};
        drawn[k] = (as_points ? sets[k]->points : sets[k]->splats)(&of->filter, &of->block, &sums);
        assert_int_equal(drawn[k], drawn[0]);
        assert_memory_equal(color[k], color[0], sizeof color[k]);
        assert_memory_equal(weight[k], weight[0], sizeof weight[k]);
    }
    memset(plain_color, 0, sizeof plain_color), memset(plain_weight, 0, sizeof plain_weight);
    memset(doubt, 0, sizeof doubt);
    sum_plainly(of, as_points, plain_color, plain_weight, doubt);
    bool some = false;
    for (int i = 0; i < 64 * 64; i++) {
        const size_t at = (size_t)(i / 64 + 1) * EWA_TEXTURE_PITCH + (size_t)(i % 64) + 1;
        const double allowed = 2e-4 * (plain_weight[i] + 1e-4) + doubt[i];
        some = some || plain_weight[i] > 0;
        if (with_weight && !(fabs((double)weight[0][at] - plain_weight[i]) <= allowed))
            fail_msg("weight %g at %d, %d: not %g", (double)weight[0][at], i % 64, i / 64, plain_weight[i]);
        for (size_t c = 0; c < 4; c++)
            if (!(fabs((double)color[0][4 * at + c] - plain_color[4 * i + (int)c]) <= allowed))
                fail_msg("colour %g at %d, %d: not %g", (double)color[0][4 * at + c], i % 64, i / 64,
                         plain_color[4 * i + (int)c]);
    }
    assert_true(drawn[0] <= of->block.width * of->block.height);
    assert_true(!some || drawn[0] > 0);
}

TEST(test_points) {
    const ewa_texture_kernels *sets[SETS];
    kernel_sets(sets);
    check_random random = {91};
    for (int i = 0; i < BLOCKS; i++) {
        task made;
        make_task(&random, true, &made);
        hold(sets, &made, true, i % 2);
    }
}

TEST(test_splats) {
    const ewa_texture_kernels *sets[SETS];
    kernel_sets(sets);
    check_random random = {92};
    for (int i = 0; i < BLOCKS; i++) {
        task made;
        make_task(&random, false, &made);
        hold(sets, &made, false, i % 2);
    }
}

static double curve(double linear) {
    const double x = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/// A pixel over the background: premultiplied.
static void resolve_plainly(const float sums[4], double weight, bool with_weight, double coverage,
                            const float background[4], double out[4]) {
    const double share = weight > 0 ? coverage / weight : 0;
    for (int c = 0; c < 3; c++) out[c] = (double)sums[c] * share;
    out[3] = with_weight ? (double)sums[3] * share : weight > 0 ? coverage : 0;
    const double behind = (1 - out[3]) * (double)background[3];
    for (int c = 0; c < 3; c++) out[c] += behind * (double)background[c];
    out[3] += behind;
}

TEST(test_pixels) {
    static const uint32_t channel_counts[] = {1, 3, 4};
    enum { WIDTH = 90, HEIGHT = 70 };
    static float color[4 * NUMBERS], weight[NUMBERS], coverage[64 * 64], made[4 * WIDTH * HEIGHT];
    const ewa_texture_kernels *sets[SETS];
    kernel_sets(sets);
    check_random random = {93};
    for (int i = 0; i < NUMBERS; i++) {
        weight[i] = check_random_u64(&random) % 5 ? (float)check_uniform(&random, 0.01, 3) : 0;
        const double alpha = check_random_u64(&random) % 2 ? 1 : check_uniform(&random, 0, 1);
        for (int c = 0; c < 4; c++)
            color[4 * i + c] = weight[i] * (float)(alpha * (c < 3 ? check_uniform(&random, 0, 1.2) : 1));
    }
    for (int i = 0; i < 64 * 64; i++) coverage[i] = i % 3 ? 1 : (float)check_uniform(&random, 0, 1);
    for (uint32_t k = 0; k < SETS; k++)
        for (int variant = 0; variant < 24; variant++) {
            const uint32_t channels = channel_counts[variant % 3];
            const bool linear = variant / 3 % 2, with_weight = variant / 6 % 2, with_coverage = variant / 12;
            const float background[4] = {0.2f, 0.5f, 0.9f, channels < 4 ? 1 : variant % 2 ? 0.4f : 0};
            const ewa_tile_rect tile = {7, 3, variant % 4 ? 64 : 37, 61};
            const size_t bytes = linear ? sizeof(float) : 1;
            const ewa_texture_target target = {made,     linear ? EWA_PIXEL_LINEAR : EWA_PIXEL_SRGB8,
                                               channels, WIDTH,
                                               HEIGHT,   WIDTH * channels * bytes};
            const ewa_texture_sums sums = {color, with_weight ? weight : NULL};
            memset(made, 0x55, sizeof made);
            sets[k]->resolve(&target, background, &tile, &sums, with_coverage ? coverage : NULL);
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++) {
                    const bool inside = x >= tile.x_px && x < tile.x_px + tile.width_px && y >= tile.y_px &&
                                        y < tile.y_px + tile.height_px;
                    const size_t to = (size_t)(y * WIDTH + x) * channels;
                    if (!inside) {
                        for (uint32_t c = 0; c < channels * bytes; c++)
                            assert_int_equal(((uint8_t *)made)[to * bytes + c], 0x55);
                        continue;
                    }
                    const uint32_t row = y - tile.y_px, column = x - tile.x_px;
                    const size_t at = (size_t)(row + 1) * EWA_TEXTURE_PITCH + column + 1;
                    double wanted[4];
                    const double sum = with_weight ? (double)weight[at] : (double)color[4 * at + 3];
                    resolve_plainly(color + 4 * at, sum, with_weight,
                                    with_coverage ? (double)coverage[row * 64 + column] : 1, background,
                                    wanted);
                    for (uint32_t c = 0; c < channels; c++) {
                        const double straight = wanted[3] > 0 ? wanted[c] / wanted[3] : 0;
                        const double code =
                            c == 3 ? 255 * wanted[3] : 255 * curve(channels == 4 ? straight : wanted[c]);
                        if (linear && !(fabs((double)made[to + c] - wanted[c]) < 1e-5))
                            fail_msg("version %u: %g at %u, %u: not %g", k, (double)made[to + c], x, y,
                                     wanted[c]);
                        // Where alpha rounds to no code at all the colour is black.
                        const bool shown = channels < 4 || c == 3 || 255 * wanted[3] >= 0.5;
                        if (!linear && !(fabs(((uint8_t *)made)[to + c] - (shown ? code : 0)) < 0.51))
                            fail_msg("version %u: code %u at %u, %u: not %g", k, ((uint8_t *)made)[to + c], x,
                                     y, code);
                    }
                }
        }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
