// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels of warping by themselves, every instruction set: known answers on planes, creases,
// rims, gaps and what hangs between two surfaces; random rows against a plain definition; surfels against
// finite differences.
#include "tests/check.h"

#include "base/base.h"
#include "warp/warp_sample.h"

#include <math.h>

enum {
    WIDTH = 67,
    HEIGHT = 5 + 2 * EWA_WARP_REACH,
    STRIDE = EWA_WARP_FRONT + WIDTH + EWA_WARP_BACK,
    SETS = 3
};

static void kernel_sets(const ewa_warp_kernels *sets[SETS]) {
    static const uint32_t masks[SETS] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    for (int i = 0; i < SETS; i++) sets[i] = EWA_CHOOSE(masks[i] & ewa_cpu_detect(), ewa_warp_kernels);
}

static ewa_warp_lens make_lens(void) {
    return (ewa_warp_lens){.ray_x = {1 / 70.0f, -0.4f},
                           .ray_y = {1 / 55.0f, -0.3f},
                           .from_camera = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                           .sigma = 0.38f,
                           .jump = 0.02f,
                           .steep = 0.5f,
                           .bend = 0.005f,
                           .crease_x = 0.001f,
                           .crease_y = 0.0012f,
                           .noise = 0,
                           .drop_flying = 1};
}

/// Rows of keys with NaN around them, and what is measured there.
typedef struct sheet {
    float keys[HEIGHT * STRIDE];
    float kept[STRIDE], slope_x[STRIDE], slope_y[STRIDE], distance_x[STRIDE], distance_y[STRIDE];
    uint32_t dropped;
} sheet;

static float *key_at(sheet *of, int x, int y) {
    return of->keys + (y + EWA_WARP_REACH) * STRIDE + EWA_WARP_FRONT + x;
}

static void clear(sheet *of) {
    for (int i = 0; i < HEIGHT * STRIDE; i++) of->keys[i] = NAN;
}

/// Measures row 2 by one set of kernels.
static void measure(const ewa_warp_kernels *kernels, const ewa_warp_lens *lens, sheet *of) {
    const ewa_warp_rows rows = {of->kept, of->slope_x, of->slope_y, of->distance_x, of->distance_y, STRIDE};
    of->dropped = kernels->slopes(lens, key_at(of, 0, 2), STRIDE, WIDTH, &rows, 0);
}

static void expect_slope(const sheet *of, int x, double slope, double distance) {
    if (!(fabs((double)of->slope_x[x] - slope) < 1e-6) || of->distance_x[x] != (float)distance)
        fail_msg("column %d: slope %g, distance %g, not %g, %g", x, (double)of->slope_x[x],
                 (double)of->distance_x[x], slope, distance);
}

/// A plane: the key's own differences; at the ends those of the one side there is.
TEST(test_planes) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    const ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++) {
        clear(&made);
        for (int y = -2; y < 7; y++)
            for (int x = 0; x < WIDTH; x++)
                *key_at(&made, x, y) = 0.5f + 0.001f * (float)x - 0.002f * (float)y;
        measure(sets[k], &lens, &made);
        assert_int_equal(made.dropped, 0);
        for (int x = 0; x < WIDTH; x++) {
            expect_slope(&made, x, 0.001, 1);
            assert_true(fabs((double)made.slope_y[x] + 0.002) < 1e-6 && made.distance_y[x] == 1);
            assert_memory_equal(&made.kept[x], key_at(&made, x, 2), sizeof(float));
        }
    }
}

/// A roof: each side keeps its own slope up to the ridge, which the straighter side has; a valley likewise.
/// Across a crease of less than the limit the two sides are averaged.
TEST(test_creases) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++)
        for (int turn = -1; turn <= 1; turn += 2) {
            clear(&made);
            // The ridge lies between columns 30 and 31, nearer to 30.
            for (int y = -2; y < 7; y++)
                for (int x = 0; x < WIDTH; x++)
                    *key_at(&made, x, y) = 0.6f - (float)turn * 0.002f * fabsf((float)x - 30.2f);
            lens.crease_x = 0.001f;
            measure(sets[k], &lens, &made);
            for (int x = 0; x < WIDTH; x++)
                if (x != 30) expect_slope(&made, x, x <= 30 ? turn * 0.002 : -turn * 0.002, 1);
            expect_slope(&made, 30, turn * 0.002, 1);
            lens.crease_x = 0.02f; // no crease: the mean of both sides
            measure(sets[k], &lens, &made);
            expect_slope(&made, 30, turn * (0.002 + 0.002 * (0.2 - 0.8)) / 2, 1);
            expect_slope(&made, 29, turn * 0.002, 1);
            // As bent on both sides as at the crease: none is straighter.
            for (int x = 0; x < WIDTH; x++)
                for (int y = -2; y < 7; y++)
                    *key_at(&made, x, y) = 0.6f + 1e-3f * (float)((x - 30) * (x - 30));
            lens.crease_x = 0.001f, lens.jump = 1;
            measure(sets[k], &lens, &made);
            expect_slope(&made, 31, 0.002, 1);
            lens.jump = 0.02f;
        }
}

/// A step: the rims look at their own side only; the nearer one is 0.7 pixels long, the farther one a whole.
TEST(test_rims) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    const ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++)
        for (int nearer = 0; nearer < 2; nearer++) {
            clear(&made);
            for (int y = -2; y < 7; y++)
                for (int x = 0; x < WIDTH; x++)
                    *key_at(&made, x, y) =
                        (nearer == 0) == (x < 20) ? 0.8f + 0.0011f * (float)x : 0.3f - 0.0007f * (float)x;
            measure(sets[k], &lens, &made);
            assert_int_equal(made.dropped, 0);
            for (int x = 0; x < WIDTH; x++) {
                const bool near_side = (nearer == 0) == (x < 20), rim = x == 19 || x == 20;
                expect_slope(&made, x, near_side ? 0.0011 : -0.0007, rim && near_side ? (double)0.7f : 1);
            }
        }
}

/// A steep plane goes on where its second difference says so, and not beyond the steepest.
TEST(test_steep_planes) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    const ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++) {
        clear(&made);
        for (int y = -2; y < 7; y++)
            for (int x = 0; x < 12; x++) *key_at(&made, x, y) = 0.5f + 0.05f * (float)x;
        measure(sets[k], &lens, &made);
        for (int x = 0; x < 12; x++) expect_slope(&made, x, 0.05, 1);
        // A difference of more than half of the larger key is no plane's.
        clear(&made);
        for (int y = -2; y < 7; y++)
            for (int x = 0; x < 4; x++) *key_at(&made, x, y) = 0.1f + 0.3f * (float)x;
        measure(sets[k], &lens, &made);
        expect_slope(&made, 0, 0, 1);
        expect_slope(&made, 3, 0.3, 1);
    }
}

/// Single pixels without a depth are looked across; two are an end.
TEST(test_gaps) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    const ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++) {
        clear(&made);
        for (int y = -2; y < 7; y++)
            for (int x = 0; x < WIDTH; x++)
                if (x != 10 && x != 20 && x != 21) *key_at(&made, x, y) = 0.5f + 0.001f * (float)x;
        measure(sets[k], &lens, &made);
        for (int x = 0; x < WIDTH; x++) {
            if (x == 10 || x == 20 || x == 21) continue;
            expect_slope(&made, x, 0.001, x == 9 || x == 11 ? 2 : 1);
        }
        assert_true(isnan(made.kept[10]) && !isnan(made.kept[9]));
        // A pixel alone: no slope, its own size.
        clear(&made);
        *key_at(&made, 5, 2) = 0.7f;
        measure(sets[k], &lens, &made);
        expect_slope(&made, 5, 0, 1);
        assert_true(made.slope_y[5] == 0 && made.distance_y[5] == 1 && made.kept[5] == 0.7f);
    }
}

/// What hangs between a near and a far surface is dropped, what stands before both is not.
TEST(test_flying) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    ewa_warp_lens lens = make_lens();
    static sheet made;
    for (uint32_t k = 0; k < SETS; k++)
        for (int drop = 0; drop < 2; drop++) {
            clear(&made);
            for (int y = -2; y < 7; y++)
                for (int x = 0; x < WIDTH; x++)
                    *key_at(&made, x, y) = x < 20 ? 0.9f : x == 20 ? 0.5f : x == 40 ? 0.8f : 0.3f;
            lens.drop_flying = (float)drop;
            measure(sets[k], &lens, &made);
            // Of column 20 neighbours above and below are like it: only the row says that it hangs.
            assert_int_equal(made.dropped, drop);
            assert_true((bool)isnan(made.kept[20]) == (bool)drop && !isnan(made.kept[40]));
        }
}

/// What semantics there are, once more in doubles and one pixel at a time.
typedef struct plain_side {
    double rate, distance, bend, neighbour;
} plain_side;

static plain_side look(double key, double next, double beyond) {
    const bool there = next >= 0;
    plain_side s = {.neighbour = there ? next : beyond, .distance = there ? 1 : 2};
    s.rate = (s.neighbour - key) / s.distance;
    s.bend = fabs((beyond - next) - s.rate);
    if (isnan(s.bend)) s.bend = 1e30;
    return s;
}

static bool belongs(const ewa_warp_lens *lens, double key, const plain_side *s, double inner_bend) {
    const double larger = s->neighbour > key ? s->neighbour : key, size = fabs(s->neighbour - key);
    const bool straight = inner_bend <= (double)lens->bend * larger || s->bend <= (double)lens->bend * larger;
    return size <= (double)lens->jump * larger || (straight && size <= (double)lens->steep * larger);
}

static double slope_plainly(const ewa_warp_lens *lens, double crease, const double key[5], double *distance,
                            bool *flying) {
    const plain_side left = look(key[2], key[1], key[0]), right = look(key[2], key[3], key[4]);
    const double bend = fabs(left.rate + right.rate);
    const bool has_left = belongs(lens, key[2], &left, bend), has_right = belongs(lens, key[2], &right, bend);
    *distance = 1;
    if (!has_left && !has_right) {
        *flying = *flying || left.rate * right.rate < 0;
        return 0;
    }
    if (has_left && has_right) {
        *distance = fmax(left.distance, right.distance);
        if (bend > crease * key[2] && bend > 4 * fmin(left.bend, right.bend))
            return left.bend < right.bend ? -left.rate : right.rate;
        return (right.rate - left.rate) / 2;
    }
    const plain_side *side = has_left ? &left : &right, *other = has_left ? &right : &left;
    *distance = side->distance * (other->neighbour < key[2] ? (double)0.7f : 1);
    return has_left ? -left.rate : right.rate;
}

/// Steps, creases, gaps and single pixels at random, on a scale of which all differences are exact in floats.
TEST(test_random_rows) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    const ewa_warp_lens lens = make_lens();
    static sheet made[SETS];
    check_random random = {7};
    for (int turn = 0; turn < 400; turn++) {
        clear(&made[0]);
        for (int y = -2; y < 7; y++) {
            double key = 0.5, slope = 0;
            for (int x = 0; x < WIDTH; x++) {
                const uint64_t what = check_random_u64(&random) % 12;
                if (what == 0) key = check_uniform(&random, 0.2, 0.9);
                if (what <= 2) slope = check_uniform(&random, -0.02, 0.02) * (what == 1 ? 4 : 0.3);
                key += slope + (what == 3 ? check_uniform(&random, -0.002, 0.002) : 0);
                if (key < 0.05 || key > 1) key = 0.4;
                if (what != 4) *key_at(&made[0], x, y) = (float)(ldexp(floor(ldexp(key, 20)), -20));
            }
        }
        for (uint32_t k = 0; k < SETS; k++) {
            if (k) memcpy(made[k].keys, made[0].keys, sizeof made[0].keys);
            measure(sets[k], &lens, &made[k]);
            assert_int_equal(made[k].dropped, made[0].dropped);
            assert_memory_equal(made[k].kept, made[0].kept, WIDTH * sizeof(float));
            assert_memory_equal(made[k].slope_x, made[0].slope_x, WIDTH * sizeof(float));
            assert_memory_equal(made[k].slope_y, made[0].slope_y, WIDTH * sizeof(float));
            assert_memory_equal(made[k].distance_x, made[0].distance_x, WIDTH * sizeof(float));
            assert_memory_equal(made[k].distance_y, made[0].distance_y, WIDTH * sizeof(float));
        }
        uint32_t dropped = 0;
        for (int x = 0; x < WIDTH; x++) {
            double along[5], down[5], distance[2];
            for (int i = 0; i < 5; i++)
                along[i] = (double)*key_at(&made[0], x + i - 2, 2), down[i] = (double)*key_at(&made[0], x, i);
            if (isnan(along[2])) continue;
            bool flying = false;
            const double slope_x = slope_plainly(&lens, (double)lens.crease_x, along, &distance[0], &flying);
            const double slope_y = slope_plainly(&lens, (double)lens.crease_y, down, &distance[1], &flying);
            dropped += flying;
            if (!(fabs((double)made[0].slope_x[x] - slope_x) < 1e-6) ||
                !(fabs((double)made[0].slope_y[x] - slope_y) < 1e-6) ||
                !(fabs((double)made[0].distance_x[x] - distance[0]) < 1e-6) ||
                !(fabs((double)made[0].distance_y[x] - distance[1]) < 1e-6) ||
                (bool)isnan(made[0].kept[x]) != flying)
                fail_msg("turn %d, column %d: slopes %g %g, not %g %g; distances %g %g, not %g %g; flying %d",
                         turn, x, (double)made[0].slope_x[x], (double)made[0].slope_y[x], slope_x, slope_y,
                         (double)made[0].distance_x[x], (double)made[0].distance_y[x], distance[0],
                         distance[1], flying);
        }
        assert_int_equal(made[0].dropped, dropped);
    }
}

/// The mean of what differs by at most 2.5 times the noise, 5 x 5; alone where nothing does.
TEST(test_smoothing) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    static sheet made;
    static float smoothed[SETS][STRIDE];
    check_random random = {17};
    const float noise = 0.01f;
    clear(&made);
    for (int y = -2; y < 7; y++)
        for (int x = 0; x < WIDTH; x++)
            if (check_random_u64(&random) % 9)
                *key_at(&made, x, y) = (x < 30 ? 0.5f : 0.56f) + (float)check_uniform(&random, -0.02, 0.02);
    for (uint32_t k = 0; k < SETS; k++) {
        sets[k]->smooth(noise, key_at(&made, 0, 2), STRIDE, WIDTH, smoothed[k]);
        for (int x = 0; x < WIDTH; x++) // a NaN may have any bits
            assert_true(smoothed[k][x] == smoothed[0][x] || (isnan(smoothed[k][x]) && isnan(smoothed[0][x])));
    }
    for (int x = 0; x < WIDTH; x++) {
        const double key = (double)*key_at(&made, x, 2);
        if (isnan(key)) {
            assert_true(isnan(smoothed[0][x]));
            continue;
        }
        double sum = 0, weight = 0;
        for (int i = 0; i < 25; i++) {
            const double other = (double)*key_at(&made, x + i % 5 - 2, i / 5);
            if (fabs(other - key) <= 2.5 * (double)noise) sum += other, weight++;
        }
        assert_true(fabs((double)smoothed[0][x] - sum / weight) < 1e-6);
    }
}

/// Place of a pixel whose key goes on linearly from the middle of its own: world axes, from the eye.
static void place(const ewa_warp_lens *lens, double x, double y, double key, double out[3]) {
    const double ray[3] = {(double)lens->ray_x[0] * x + (double)lens->ray_x[1],
                           (double)lens->ray_y[0] * y + (double)lens->ray_y[1], 1};
    for (int r = 0; r < 3; r++) {
        out[r] = 0;
        for (int c = 0; c < 3; c++) out[r] += (double)lens->from_camera[3 * r + c] * ray[c] / key;
    }
}

/// Axes are what the place changes per pixel times sigma and the distances; normals look at the eye.
TEST(test_surfels) {
    const ewa_warp_kernels *sets[SETS];
    kernel_sets(sets);
    enum { SIDE = 8, ROW = 64 };
    static float keys[SIDE * ROW], slope_x[SIDE * ROW], slope_y[SIDE * ROW], distance_x[SIDE * ROW],
        distance_y[SIDE * ROW];
    ewa_warp_lens lens = make_lens();
    const float turned[9] = {1.2f, 1.6f, 0, -1.6f, 1.2f, 0, 0, 0, 2};
    memcpy(lens.from_camera, turned, sizeof turned);
    check_random random = {27};
    for (int i = 0; i < SIDE * ROW; i++) {
        keys[i] = i % 7 == 3 ? NAN : (float)check_uniform(&random, 0.2, 0.8);
        slope_x[i] = (float)check_uniform(&random, -0.02, 0.02),
        slope_y[i] = (float)check_uniform(&random, -0.02, 0.02);
        distance_x[i] = 1 + (float)(i % 2), distance_y[i] = i % 3 ? 1 : 0.7f;
    }
    const ewa_warp_rows rows = {keys, slope_x, slope_y, distance_x, distance_y, ROW};
    for (uint32_t k = 0; k < SETS; k++)
        for (uint32_t from = 0; from < 20; from += 4) {
            static ewa_packet packet;
            float normal[3][16], axis_u[3][16], axis_v[3][16];
            const uint32_t mask =
                sets[k]->block(&lens, from, 8, &rows, from, &packet, normal, axis_u, axis_v);
            for (uint32_t i = 0; i < 16; i++) {
                const size_t at = i / 4 * ROW + i % 4 + from;
                assert_int_equal(mask >> i & 1, !isnan(keys[at]));
                if (isnan(keys[at])) continue;
                const double x = from + i % 4, y = 8 + i / 4, step = 1e-5, key = (double)keys[at];
                const double gx = (double)slope_x[at], gy = (double)slope_y[at];
                double p[3], px[3], py[3], n[3] = {0, 0, 0}, toward = 0, length = 0;
                place(&lens, x, y, key, p);
                place(&lens, x + step, y, key + gx * step, px);
                place(&lens, x, y + step, key + gy * step, py);
                const float place_made[3] = {packet.x[i], packet.y[i], packet.z[i]};
                for (int c = 0; c < 3; c++) {
                    const double u = (px[c] - p[c]) / step * 0.38 * (double)distance_x[at],
                                 v = (py[c] - p[c]) / step * 0.38 * (double)distance_y[at];
                    assert_true(fabs((double)place_made[c] - p[c]) < 2e-5);
                    assert_true(fabs((double)axis_u[c][i] - u) < 1e-4 &&
                                fabs((double)axis_v[c][i] - v) < 1e-4);
                    n[c] = (double)normal[c][i];
                    toward -= n[c] * p[c];
                }
                // Across both axes, and turned to the eye.
                for (int c = 0; c < 3; c++) length += n[c] * n[c];
                double along_u = 0, along_v = 0;
                for (int c = 0; c < 3; c++)
                    along_u += n[c] * (double)axis_u[c][i], along_v += n[c] * (double)axis_v[c][i];
                assert_true(length > 0 && toward > 0);
                assert_true(fabs(along_u) < 1e-5 * sqrt(length) && fabs(along_v) < 1e-5 * sqrt(length));
            }
        }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
