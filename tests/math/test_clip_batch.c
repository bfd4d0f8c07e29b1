// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper against ewa_clip_segment() in double precision, and against itself on every instruction
// set and number of threads.
#include <fenv.h>
#include <float.h>
#include <string.h>

#include "math/check_math.h"

/// More than two tasks of the clipper, and no multiple of any vector.
enum { COUNT = 8192 * 2 + 1237, OUTPUTS = 2 * 2 + 2 * 2 * 4 };

/// Memory of one batch: inputs and outputs, with a guard after each.
typedef struct batch {
    float (*in)[COUNT + 16];
    float (*out)[COUNT + 16];
    uint8_t visible[COUNT + 16];
    ewa_segment_batch segments;
    ewa_segment_clips clips, clips_without_ends;
} batch;

static batch *make_batch(void) {
    batch *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->in = calloc(8, sizeof *b->in);
    b->out = calloc(OUTPUTS, sizeof *b->out);
    assert_true(b->in && b->out);
    size_t row = 0;
    b->segments.count = COUNT;
    b->clips.visible = b->visible;
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) b->segments.end[e][c] = b->in[4 * e + c];
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) b->clips.alpha[k][e] = b->out[row++];
    b->clips_without_ends = b->clips;
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 4; c++) b->clips.end[k][e][c] = b->out[row++];
    return b;
}

static void free_batch(batch *b) {
    free(b->in);
    free(b->out);
    free(b);
}

/// Every kind of segment: general, on whole numbers (which touch planes and corners), with w = 0,
/// antiparallel, huge, denormal; none that is invalid.
static void fill(batch *b, uint64_t seed) {
    check_random random = {seed};
    for (int i = 0; i < COUNT; i++) {
        float p[8];
        for (int c = 0; c < 8; c++) {
            double shift = c % 4 == 3 ? 0.5 : 0;
            p[c] = (float)(check_uniform(&random, -1.5, 1.5) + shift);
            if (i % 5 == 0) p[c] = (float)rint(2 * p[c]) / 2;
        }
        if (i % 7 == 1) p[3] = 0;
        if (i % 7 == 2) p[7] = -0.0f;
        if (p[0] == 0 && p[1] == 0 && p[2] == 0) p[2] = 0.5f;
        if (p[4] == 0 && p[5] == 0 && p[6] == 0) p[6] = -0.5f;
        float k = ldexpf(1, i % 5 - 2); // exact: -k p is the same point in every precision
        for (int c = 0; c < 4 && i % 11 == 3 && i % 13 != 2; c++) p[4 + c] = -k * p[c];
        float scale = i % 13 == 1 ? 0x1p120f : i % 13 == 2 ? 0x1p-140f : 1;
        for (int c = 0; c < 8; c++) p[c] *= scale;
        for (int c = 0; c < 8; c++) b->in[c][i] = p[c];
    }
}

static ewa_vec4 end_of(const batch *b, int e, int i) {
    return vec4_make(b->in[4 * e][i], b->in[4 * e + 1][i], b->in[4 * e + 2][i], b->in[4 * e + 3][i]);
}

/// What the rounding of w +- x and z in single precision can move alpha by, for the plane where it is worst.
static double alpha_bound(ewa_vec4 p1, ewa_vec4 p2) {
    const double a[4] = {p1.x, p1.y, p1.z, p1.w}, d[4] = {p2.x - p1.x, p2.y - p1.y, p2.z - p1.z, p2.w - p1.w};
    double worst = 0, size = 0;
    for (int c = 0; c < 4; c++) size = fmax(size, fmax(fabs(a[c]), fabs(a[c] + d[c])));
    const double slopes[6] = {d[3] + d[0], d[3] - d[0], d[3] + d[1], d[3] - d[1], d[2], d[3] - d[2]};
    for (int k = 0; k < 6; k++)
        if (slopes[k] != 0) worst = fmax(worst, 1 / fabs(slopes[k]));
    return 4 * FLT_EPSILON * size * worst + 4 * FLT_EPSILON;
}

static void check_against_double(const batch *b, int i, int seen[4]) {
    ewa_segment_part parts[2];
    uint32_t visible;
    ewa_vec4 p1 = end_of(b, 0, i), p2 = end_of(b, 1, i);
    assert_int_equal(ewa_clip_segment(p1, p2, parts, &visible), EWA_OK);
    seen[b->visible[i]]++;
    double bound = alpha_bound(p1, p2);
    if (!(bound < 1e-3)) return;
    for (int k = 0; k < 2; k++) {
        double begin = b->out[2 * k][i], end = b->out[2 * k + 1][i];
        bool exists = b->visible[i] & 1u << k;
        if (!exists) assert_true(begin == 1 && end == 0);
        if (exists && visible & 1u << k) {
            check_near(begin, parts[k].alpha[0], bound);
            check_near(end, parts[k].alpha[1], bound);
        } else if (exists) { // seen in one precision only: it is within rounding of nothing
            assert_true(end - begin <= 2 * bound);
        } else if (visible & 1u << k) {
            assert_true(parts[k].alpha[1] - parts[k].alpha[0] <= 2 * bound);
        }
    }
}

static void check_ends(const batch *b, int i) {
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) {
            float p[4], s = k ? -1 : 1;
            for (int c = 0; c < 4; c++) p[c] = b->clips.end[k][e][c][i];
            if (!(b->visible[i] & 1u << k)) {
                assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0 && p[3] == 0);
                continue;
            }
            float w = s * p[3];
            assert_true(w > 0 && fabsf(p[0]) <= w && fabsf(p[1]) <= w && s * p[2] >= 0 && s * p[2] <= w);
            double alpha = b->out[2 * k + e][i];
            for (int c = 0; c < 4; c++) {
                double size = fabs((double)b->in[c][i]) + fabs((double)b->in[4 + c][i]) + w;
                check_near(p[c], (1 - alpha) * b->in[c][i] + alpha * b->in[4 + c][i],
                           8 * FLT_EPSILON * size + 2e-45);
            }
        }
}

TEST(test_against_double) {
    batch *b = make_batch();
    ewa_context *context = check_context_of(1, EWA_CPU_ALL);
    int seen[4] = {0};
    for (uint64_t seed = 1; seed < 4; seed++) {
        fill(b, seed);
        feclearexcept(FE_ALL_EXCEPT);
        assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_OK);
        assert_int_equal(fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
        for (int i = 0; i < COUNT; i++) {
            check_against_double(b, i, seen);
            check_ends(b, i);
        }
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] > COUNT / 100);
    ewa_context_destroy(&context);
    free_batch(b);
}

/// Touching counts: a corner of the frustum, an edge from inside, a point on a face.
TEST(test_touching) {
    static const float segments[3][8] = {
        {2, 0, 1, 1, 0, 2, 1, 1}, {0, 0, 0, 1, 0, 0, -1, 1}, {1, 0, 0.5f, 1, 1, 0, 0.5f, 1}};
    static const float alpha[3][2] = {{0.5f, 0.5f}, {0, 0}, {0, 1}};
    static const uint32_t masks[] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    batch *b = make_batch();
    b->segments.count = 3;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 8; c++) b->in[c][i] = segments[i][c];
    for (int m = 0; m < 3; m++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(1, masks[m]);
        assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_OK);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(b->visible[i], EWA_VISIBLE_POSITIVE);
            assert_true(b->out[0][i] == alpha[i][0] && b->out[1][i] == alpha[i][1]);
        }
    }
    free_batch(b);
}

TEST(test_same_bytes) {
    static const uint32_t masks[] = {0, EWA_CPU_AVX2, EWA_CPU_ALL}, threads[] = {1, 2, 7};
    batch *reference = make_batch(), *b = make_batch();
    fill(reference, 9);
    memcpy(b->in, reference->in, 8 * sizeof *b->in);
    ewa_context *plain = check_context_of(1, 0);
    assert_int_equal(ewa_clip_segments(plain, &reference->segments, &reference->clips), EWA_OK);
    for (size_t m = 0; m < 3; m++)
        for (size_t t = 0; t < 3; t++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads[t], masks[m]);
            feclearexcept(FE_ALL_EXCEPT);
            memset(b->out, 0, OUTPUTS * sizeof *b->out);
            assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_OK);
            assert_int_equal(fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
            assert_memory_equal(b->visible, reference->visible, sizeof b->visible);
            assert_memory_equal(b->out, reference->out, OUTPUTS * sizeof *b->out);
            // Without ends: the same alpha, and nothing written beyond.
            memset(b->out, 0, OUTPUTS * sizeof *b->out);
            assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips_without_ends), EWA_OK);
            assert_memory_equal(b->visible, reference->visible, sizeof b->visible);
            assert_memory_equal(b->out, reference->out, 4 * sizeof *b->out);
        }
    // Any number of segments, from any address: the same as the beginning of all.
    for (uint64_t count = 0; count < 40; count++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(1, EWA_CPU_ALL);
        batch *few = make_batch();
        few->segments.count = count;
        for (int c = 0; c < 8; c++) few->segments.end[c / 4][c % 4] = reference->in[c] + 3;
        assert_int_equal(ewa_clip_segments(context, &few->segments, &few->clips), EWA_OK);
        for (int r = 0; r < OUTPUTS; r++) {
            assert_memory_equal(few->out[r], reference->out[r] + 3, count * sizeof(float));
            for (size_t i = count; i < count + 16; i++) assert_true(few->out[r][i] == 0);
        }
        assert_memory_equal(few->visible, reference->visible + 3, count);
        free_batch(few);
    }
    ewa_context_destroy(&plain);
    free_batch(reference);
    free_batch(b);
}

TEST(test_invalid) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, 0x1.1p124f, -FLT_MAX};
    batch *b = make_batch(), *good = make_batch();
    fill(b, 5);
    memcpy(good->in, b->in, 8 * sizeof *b->in);
    check_log log = {{0}, 0};
    ewa_context *context = check_context(2, &log);
    assert_int_equal(ewa_clip_segments(context, &good->segments, &good->clips), EWA_OK);
    for (int i = 0; i < 40; i++) b->in[i % 8][100 + 211 * i] = bad[i / 8];
    for (int c = 0; c < 4; c++) b->in[c][COUNT - 1] = 0; // [0 0 0 0]
    feclearexcept(FE_ALL_EXCEPT);
    assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_ERROR_NUMERIC);
    assert_int_equal(fetestexcept(FE_DIVBYZERO), 0);
    assert_string_equal(log.text,
                        "ewa_clip_segments: 41 of 17621 segments have an end that is no point, the first is "
                        "number 100");
    for (int i = 0; i < COUNT; i++) {
        bool invalid = i == COUNT - 1 || (i >= 100 && (i - 100) % 211 == 0 && (i - 100) / 211 < 40);
        assert_int_equal(b->visible[i], invalid ? EWA_VISIBLE_INVALID : good->visible[i]);
        for (int r = 0; r < OUTPUTS; r++)
            assert_true(b->out[r][i] == (invalid ? (r == 0 || r == 2) : good->out[r][i]));
    }
    b->clips.alpha[1][0] = NULL;
    assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_ERROR_ARGUMENT);
    b->clips.alpha[1][0] = b->out[2];
    b->clips.end[1][1][3] = NULL; // some ends but not all
    assert_int_equal(ewa_clip_segments(context, &b->segments, &b->clips), EWA_ERROR_ARGUMENT);
    ewa_context_destroy(&context);
    free_batch(b);
    free_batch(good);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
