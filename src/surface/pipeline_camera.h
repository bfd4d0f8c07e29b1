// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: the root, and what steps of the pipeline do to vectors (docs/math.md section 0).
#ifndef EWA_SRC_SURFACE_PIPELINE_CAMERA_H
#define EWA_SRC_SURFACE_PIPELINE_CAMERA_H

#include "surface/pipeline.h"
#include "surface/semantics.h"
#include "wide/wide_functions.h"

/// sqrt(x) for x >= 0 within 2e-7 relative.
static ALWAYS_INLINE wf wf_root(wf x) { return wf_mul(x, wf_inverse_root(x)); }

static inline wf wf_clamp(wf a, float low, float high) {
    return wf_min(wf_max(a, wf_set(low)), wf_set(high));
}
static inline wf wf_negate(wf a) { return wf_sub(wf_set(-0.0f), a); }

static inline float largest_lane(wf v) {
    float lanes[EWA_BLOCK_LANES];
    wf_store(lanes, v);
    float largest = lanes[0];
    for (int i = 1; i < EWA_BLOCK_LANES; i++) largest = lanes[i] > largest ? lanes[i] : largest;
    return largest;
}

/// Where a block's pixel centres are in it.
static ALWAYS_INLINE wf lanes_x(void) {
    static const float x[16] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    return wf_load(x);
}

static ALWAYS_INLINE wf lanes_y(void) {
    static const float y[16] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};
    return wf_load(y);
}

/// Where a column of a tile's blocks begins in the field; likewise a row.
static ALWAYS_INLINE float column_px(const ewa_tile *tile, uint32_t column) {
    return tile->field_x_px + (float)(EWA_BLOCK_PX * column);
}
static ALWAYS_INLINE float row_px(const ewa_tile *tile, uint32_t row) {
    return tile->field_y_px + (float)(EWA_BLOCK_PX * row);
}

/// Rows of a rotation times a vector.
static inline void rotate(const float m[9], wf x, wf y, wf z, wf out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] =
            wf_fma(wf_set(m[3 * i]), x, wf_fma(wf_set(m[3 * i + 1]), y, wf_mul(wf_set(m[3 * i + 2]), z)));
}

/// Vectors of octahedral coordinates, on the octahedron.
static ALWAYS_INLINE void unfold_flat(wf u, wf v, wf n[3]) {
    n[2] = wf_sub(wf_sub(wf_set(1), wf_abs(u)), wf_abs(v));
    const wf fold = wf_max(wf_negate(n[2]), wf_set(0));
    n[0] = wf_sub(u, wf_select(wf_lt(u, wf_set(0)), wf_negate(fold), fold));
    n[1] = wf_sub(v, wf_select(wf_lt(v, wf_set(0)), wf_negate(fold), fold));
}

/// Makes vectors unit vectors.
static ALWAYS_INLINE void make_unit(wf n[3]) {
    const wf inverse = wf_inverse_root(wf_fma(n[0], n[0], wf_fma(n[1], n[1], wf_mul(n[2], n[2]))));
    for (int i = 0; i < 3; i++) n[i] = wf_mul(n[i], inverse);
}

/// Unit vectors of octahedral coordinates.
static inline void unfold(wf u, wf v, wf n[3]) {
    unfold_flat(u, v, n);
    make_unit(n);
}

#endif
