// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The batch clipper, written once over vectors of LANES floats; the file that includes it defines LANES and
// KERNEL. Both cones in one go: alpha of each plane is computed where the segment crosses it and serves both.
#include <stdbool.h>
#include <string.h>

#include "math/clip_batch.h"

typedef float wide __attribute__((vector_size(4 * LANES)));
typedef int32_t mask __attribute__((vector_size(4 * LANES))); // -1 true, 0 false
typedef uint8_t bytes __attribute__((vector_size(LANES)));

/// Largest coordinate: sums and differences of four of them stay finite.
#define LARGEST 0x1p124f

/// As in noise.h, in single precision: eight times FLT_EPSILON.
#define WIDE_NOISE 0x1p-20f

static inline wide splat(float value) { return (wide){0} + value; }
static inline wide choose(mask m, wide yes, wide no) { return (wide)((m & (mask)yes) | (~m & (mask)no)); }
static inline wide lesser(wide a, wide b) { return choose(a < b, a, b); }
static inline wide greater(wide a, wide b) { return choose(a > b, a, b); }
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
static inline void finish(const wide p[2][4], wide begin, wide end, mask exists, bool positive,
                          part *result) {
    const wide zero = splat(0), one = splat(1);
    wide alpha[2] = {begin, end}, point[2][4];
    mask is_there[2];
    for (int e = 0; e < 2; e++) {
        wide a = alpha[e], w;
        for (int c = 0; c < 4; c++) point[e][c] = (one - a) * p[0][c] + a * p[1][c];
        w = point[e][3];
        wide noise = splat(WIDE_NOISE) * (magnitude(p[0][3]) + a * magnitude(p[1][3]));
        is_there[e] = (positive ? w > zero : w < zero) & ((magnitude(w) > noise) | (a == one));
    }
    exists &= is_there[0] | is_there[1];
    result->exists = exists;
    for (int e = 0; e < 2; e++) {
        wide own = choose(is_there[e], alpha[e], alpha[1 - e]), q[4];
        result->alpha[e] = choose(exists, own, splat(e ? 0.0f : 1.0f));
        for (int c = 0; c < 4; c++) q[c] = choose(is_there[e], point[e][c], point[1 - e][c]);
        wide reach = magnitude(q[3]);
        for (int c = 0; c < 2; c++) q[c] = greater(-reach, lesser(reach, q[c]));
        q[2] = positive ? greater(zero, lesser(q[3], q[2])) : greater(q[3], lesser(zero, q[2]));
        for (int c = 0; c < 4; c++) result->end[e][c] = choose(exists, q[c], zero);
    }
}

/// Clips LANES segments into their two parts; returns what to write to `visible`.
static inline mask clip_lanes(const float *const from[2][4], part parts[2]) {
    const wide zero = splat(0), one = splat(1);
    wide p[2][4], b1[6], b2[6];
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) p[e][c] = load(from[e][c]);
    mask valid = is_point(p[0]) & is_point(p[1]);
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 4; c++) p[e][c] = choose(valid, p[e][c], zero);
    boundary_coordinates(p[0], b1);
    boundary_coordinates(p[1], b2);
    mask exists[2] = {valid, valid};
    wide begin[2] = {zero, zero}, end[2] = {one, one};
    for (int i = 0; i < 6; i++) {
        mask negative1 = b1[i]<zero, negative2 = b2[i]<zero, positive1 = b1[i]> zero, positive2 = b2[i]> zero;
        mask crosses = (negative1 ^ negative2) | (positive1 ^ positive2);
        wide alpha = b1[i] / choose(crosses, b1[i] - b2[i], one);
        exists[0] &= ~(negative1 & negative2);
        exists[1] &= ~(positive1 & positive2);
        begin[0] = choose(negative1 & ~negative2, greater(begin[0], alpha), begin[0]);
        begin[1] = choose(positive1 & ~positive2, greater(begin[1], alpha), begin[1]);
        end[0] = choose(negative2 & ~negative1, lesser(end[0], alpha), end[0]);
        end[1] = choose(positive2 & ~positive1, lesser(end[1], alpha), end[1]);
    }
    for (int k = 0; k < 2; k++)
        finish((const wide(*)[4])p, begin[k], end[k], exists[k] & (begin[k] <= end[k]), k == 0, &parts[k]);
    return (parts[0].exists & EWA_VISIBLE_POSITIVE) | (parts[1].exists & EWA_VISIBLE_NEGATIVE) |
           (~valid & EWA_VISIBLE_INVALID);
}

/// Writes the first `count` lanes of a vector.
static inline void store_some(float *to, wide value, size_t count) { memcpy(to, &value, count * sizeof *to); }

uint64_t KERNEL(const ewa_segment_batch *segments, const ewa_segment_clips *clips, uint64_t first,
                uint64_t count) {
    uint64_t invalid_count = 0;
    bool wants_ends = clips->end[0][0][0] != NULL;
    for (uint64_t i = first; i < first + count; i += LANES) {
        size_t lanes = first + count - i < LANES ? (size_t)(first + count - i) : LANES;
        float padded[2][4][LANES];
        const float *from[2][4];
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 4; c++) {
                from[e][c] = segments->end[e][c] + i;
                if (lanes == LANES) continue;
                memset(padded[e][c], 0, sizeof padded[e][c]);
                memcpy(padded[e][c], from[e][c], lanes * sizeof(float));
                from[e][c] = padded[e][c];
            }
        part parts[2];
        bytes visible = __builtin_convertvector(clip_lanes(from, parts), bytes);
        memcpy(clips->visible + i, &visible, lanes);
        for (size_t lane = 0; lane < lanes; lane++) invalid_count += visible[lane] == EWA_VISIBLE_INVALID;
        for (int k = 0; k < 2; k++)
            for (int e = 0; e < 2; e++) {
                if (lanes == LANES)
                    store(clips->alpha[k][e] + i, parts[k].alpha[e]);
                else
                    store_some(clips->alpha[k][e] + i, parts[k].alpha[e], lanes);
                for (int c = 0; c < 4 && wants_ends; c++) {
                    if (lanes == LANES)
                        store(clips->end[k][e][c] + i, parts[k].end[e][c]);
                    else
                        store_some(clips->end[k][e][c] + i, parts[k].end[e][c], lanes);
                }
            }
    }
    return invalid_count;
}
