// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper, written once over vectors of LANES floats. Both cones in one go: alpha of each plane is
// computed where the segment crosses it and serves both. Formulas: docs/math.md section 1,
// docs/homogeneous.md.
#include <stdbool.h>
#include <string.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "homogeneous/clip_batch.h"

#if defined(WIDE_AVX512)
#define LANES 16
#elif defined(WIDE_AVX2)
#define LANES 8
#else
#define LANES 4
#endif

typedef float wide __attribute__((vector_size(4 * LANES)));
typedef int32_t mask __attribute__((vector_size(4 * LANES))); // -1 true, 0 false
typedef uint8_t bytes __attribute__((vector_size(LANES)));

/// The pieces of the loop: left to itself the compiler calls them, and passes vectors through memory.
#define INLINE static inline __attribute__((always_inline))

/// Largest coordinate: sums and differences of four of them stay finite.
#define LARGEST 0x1p124f

/// As in noise.h, in single precision: eight times FLT_EPSILON.
#define WIDE_NOISE 0x1p-20f

static inline wide splat(float value) { return (wide){0} + value; }
static inline wide choose(mask m, wide yes, wide no) { return (wide)((m & (mask)yes) | (~m & (mask)no)); }

// a < b ? a : b, a > b ? a : b (the x86 instructions are defined that way), and whether any lane is true.
#if LANES == 16
static inline wide lesser(wide a, wide b) { return (wide)_mm512_min_ps((__m512)a, (__m512)b); }
static inline wide greater(wide a, wide b) { return (wide)_mm512_max_ps((__m512)a, (__m512)b); }
static inline bool any(mask m) { return _mm512_test_epi32_mask((__m512i)m, (__m512i)m) != 0; }
#elif LANES == 8
static inline wide lesser(wide a, wide b) { return (wide)_mm256_min_ps((__m256)a, (__m256)b); }
static inline wide greater(wide a, wide b) { return (wide)_mm256_max_ps((__m256)a, (__m256)b); }
static inline bool any(mask m) { return _mm256_movemask_ps((__m256)m) != 0; }
#elif defined(__SSE2__)
static inline wide lesser(wide a, wide b) { return (wide)_mm_min_ps((__m128)a, (__m128)b); }
static inline wide greater(wide a, wide b) { return (wide)_mm_max_ps((__m128)a, (__m128)b); }
static inline bool any(mask m) { return _mm_movemask_ps((__m128)m) != 0; }
#else
static inline wide lesser(wide a, wide b) { return choose(a < b, a, b); }
static inline wide greater(wide a, wide b) { return choose(a > b, a, b); }
static inline bool any(mask m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }
#endif

static inline wide magnitude(wide a) { return (wide)((mask)a & 0x7fffffff); }

static inline wide load(const float *from) {
    wide value;
    memcpy(&value, from, sizeof value);
    return value;
}

static inline void store(float *to, wide value) { memcpy(to, &value, sizeof value); }

/// One part of LANES segments.
typedef struct part {
    mask exists;
    wide alpha[2];
    wide end[2][4];
} part;

static inline void boundary_coordinates(const wide p[4], wide b[6]) {
    b[EWA_CLIP_LEFT] = p[3] + p[0];
    b[EWA_CLIP_RIGHT] = p[3] - p[0];
    b[EWA_CLIP_BOTTOM] = p[3] + p[1];
    b[EWA_CLIP_TOP] = p[3] - p[1];
    b[EWA_CLIP_NEAR] = p[2];
    b[EWA_CLIP_FAR] = p[3] - p[2];
}

/// True where an end is a point: coordinates within bounds (which NaN is not), not all zero.
static inline mask is_point(const wide p[4]) {
    mask within = (mask){0} == 0, any = (mask){0};
    for (int c = 0; c < 4; c++) {
        within &= magnitude(p[c]) <= splat(LARGEST);
        any |= p[c] != splat(0);
    }
    return within & any;
}

/// Ends of an interval, without those that are no points, settled into the cone (clip.c: clip_to_cone,
/// settle).
INLINE void finish(const wide p[2][4], bool positive, bool wants_ends, part *result) {
    const wide zero = splat(0), one = splat(1);
    wide alpha[2] = {result->alpha[0], result->alpha[1]}, w[2];
    mask is_there[2];
    for (int e = 0; e < 2; e++) {
        wide a = alpha[e];
        w[e] = (one - a) * p[0][3] + a * p[1][3];
        wide noise = splat(WIDE_NOISE) * (magnitude(p[0][3]) + a * magnitude(p[1][3]));
        is_there[e] = (positive ? w[e] > zero : w[e] < zero) & ((magnitude(w[e]) > noise) | (a == one));
    }
    mask exists = result->exists & (is_there[0] | is_there[1]);
    result->exists = exists;
    for (int e = 0; e < 2; e++) {
        wide a = choose(is_there[e], alpha[e], alpha[1 - e]);
        result->alpha[e] = choose(exists, a, splat(e ? 0.0f : 1.0f));
        if (!wants_ends) continue;
        wide q[4] = {zero, zero, zero, choose(is_there[e], w[e], w[1 - e])}, reach = magnitude(q[3]);
        for (int c = 0; c < 3; c++) q[c] = (one - a) * p[0][c] + a * p[1][c];
        for (int c = 0; c < 2; c++) q[c] = greater(-reach, lesser(reach, q[c]));
        q[2] = positive ? greater(zero, lesser(q[3], q[2])) : greater(q[3], lesser(zero, q[2]));
        for (int c = 0; c < 4; c++) result->end[e][c] = (wide)((mask)q[c] & exists);
    }
}

/// Clips LANES segments into their two parts; returns what to write to `visible`.
INLINE mask clip_lanes(const float *const from[2][4], uint64_t i, bool wants_ends, part parts[2]) {
    const wide zero = splat(0), one = splat(1);
    wide p[2][4], b1[6], b2[6];
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) p[e][c] = load(from[e][c] + i);
    mask valid = is_point(p[0]) & is_point(p[1]);
    if (any(~valid))
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 4; c++) p[e][c] = choose(valid, p[e][c], zero);
    boundary_coordinates(p[0], b1);
    boundary_coordinates(p[1], b2);
    mask exists[2] = {valid, valid};
    wide begin[2] = {zero, zero}, end[2] = {one, one};
    for (int n = 0; n < 6; n++) {
        wide difference = b1[n] - b2[n];
        wide alpha = b1[n] / choose(difference != zero, difference, one);
        mask out1[2], out2[2];
        out1[0] = b1[n] < zero;
        out1[1] = b1[n] > zero;
        out2[0] = b2[n] < zero;
        out2[1] = b2[n] > zero;
        for (int k = 0; k < 2; k++) {
            exists[k] &= ~(out1[k] & out2[k]);
            begin[k] = greater(begin[k], (wide)((mask)alpha & out1[k]));
            end[k] = lesser(end[k], choose(out2[k], alpha, one));
        }
    }
    for (int k = 0; k < 2; k++) {
        exists[k] &= begin[k] <= end[k];
        parts[k].exists = exists[k];
        parts[k].alpha[0] = choose(exists[k], begin[k], one);
        parts[k].alpha[1] = (wide)((mask)end[k] & exists[k]);
        if (any(exists[k])) {
            finish((const wide(*)[4])p, k == 0, wants_ends, &parts[k]);
        } else if (wants_ends) {
            for (int c = 0; c < 4; c++) parts[k].end[0][c] = parts[k].end[1][c] = zero;
        }
    }
    return (parts[0].exists & EWA_VISIBLE_POSITIVE) | (parts[1].exists & EWA_VISIBLE_NEGATIVE) |
           (~valid & EWA_VISIBLE_INVALID);
}

/// Clips LANES segments from number i on.
INLINE void clip_block(const ewa_segment_batch *segments, const ewa_segment_clips *clips, uint64_t i,
                       bool wants_ends) {
    part parts[2];
    bytes visible = __builtin_convertvector(clip_lanes(segments->end, i, wants_ends, parts), bytes);
    memcpy(clips->visible + i, &visible, sizeof visible);
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) {
            store(clips->alpha[k][e] + i, parts[k].alpha[e]);
            for (int c = 0; c < 4 && wants_ends; c++) store(clips->end[k][e][c] + i, parts[k].end[e][c]);
        }
}

/// Clips the last segments, from number i on, fewer than LANES: through memory of their own.
static void clip_rest(const ewa_segment_batch *segments, const ewa_segment_clips *clips, uint64_t i,
                      size_t count, bool wants_ends) {
    float memory[2 * 4 + 2 * 2 + 2 * 2 * 4][LANES] = {{0}};
    uint8_t visible[LANES];
    ewa_segment_batch in = {.count = count};
    ewa_segment_clips out = {.visible = visible};
    size_t row = 0, bytes_used = count * sizeof(float);
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) {
            memcpy(memory[row], segments->end[e][c] + i, bytes_used);
            in.end[e][c] = memory[row++];
        }
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) {
            out.alpha[k][e] = memory[row++];
            for (int c = 0; c < 4; c++) out.end[k][e][c] = memory[row++];
        }
    clip_block(&in, &out, 0, wants_ends);
    memcpy(clips->visible + i, visible, count);
    for (int k = 0; k < 2; k++)
        for (int e = 0; e < 2; e++) {
            memcpy(clips->alpha[k][e] + i, out.alpha[k][e], bytes_used);
            for (int c = 0; c < 4 && wants_ends; c++)
                memcpy(clips->end[k][e][c] + i, out.end[k][e][c], bytes_used);
        }
}

void EWA_VERSION(ewa_clip_segments)(const ewa_segment_batch *segments, const ewa_segment_clips *clips,
                                    uint64_t first, uint64_t count) {
    bool wants_ends = clips->end[0][0][0] != NULL;
    uint64_t end = first + count, i = first;
    if (wants_ends)
        for (; i + LANES <= end; i += LANES) clip_block(segments, clips, i, true);
    else
        for (; i + LANES <= end; i += LANES) clip_block(segments, clips, i, false);
    if (i < end) clip_rest(segments, clips, i, (size_t)(end - i), wants_ends);
}
