// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: the exact projective kernel at a block's pixels (docs/math.md section 9;
// semantics.h, raycast).
//
// A ray meets the surfel's plane at u = (x - c) J^-1 / w, with the Jacobian J at the projected centre c and w
// = pz / z(x), pz times the key: the kernel at a pixel is the affine one with w^2 V for V. So records serve:
// xx, xy and yy hold V, the offset is from the projected centre, the load's peak is sqrt|V| / 2 pi, in units.
#ifndef EWA_SRC_SURFACE_PIPELINE_RAYCAST_H
#define EWA_SRC_SURFACE_PIPELINE_RAYCAST_H

#include "surface/pipeline_camera.h"

#include <math.h>

/// What the blocks of a splat share.
typedef struct ray_splat {
    float depth, min_w, max_w; ///< pz; range of w on the disc
    float area2;               ///< |V|
} ray_splat;

/// A splat in a block.
typedef struct ray_sample {
    wf exponent; ///< s
    wf gain;     ///< the kernel's peak over sqrt|V| / 2 pi
    wf key;      ///< clamped
} ray_sample;

static ALWAYS_INLINE ray_splat ray_start(const ewa_view *view, const ewa_record *r, float peak) {
    const float depth = 1 / r->key, x = r->key_x * depth, y = r->key_y * depth;
    // w = 1 + (x, y).(x - c) is linear; on the disc's picture it reaches 1 / (1 +- R / pz), with (R / pz)^2 =
    // F^2 (x, y) V (x, y)'.
    const float variance = x * x * r->xx + 2 * x * y * r->xy + y * y * r->yy;
    const float slope2 = view->cutoff2 * (variance > 0 ? variance : 0), limit = 1 / (float)EWA_NEAR_RATIO;
    const float slope = sqrtf(slope2 < limit * limit ? slope2 : limit * limit);
    const float area = peak * (float)(1 / EWA_INVERSE_TWO_PI) / view->sum_scale;
    return (ray_splat){depth, 1 / (1 + slope), 1 / (1 - slope), area * area};
}

/// The splat at the sixteen pixels that are (dx, dy) away from its projected centre.
static ALWAYS_INLINE ray_sample ray_evaluate(const ewa_view *view, const ewa_record *r, const ray_splat *ray,
                                             wf dx, wf dy) {
    const wf h2 = wf_set(view->prefilter2_px2);
    const wf plane = wf_fma(wf_set(r->key_x), dx, wf_fma(wf_set(r->key_y), dy, wf_set(r->key)));
    const wf w = wf_clamp(wf_mul(plane, wf_set(ray->depth)), ray->min_w, ray->max_w), w2 = wf_mul(w, w);
    const wf v11 = wf_fma(w2, wf_set(r->xx), h2), v22 = wf_fma(w2, wf_set(r->yy), h2);
    const wf v12 = wf_mul(w2, wf_set(r->xy));
    // |w^2 V + h^2 I| by a sum of positive terms.
    const wf unfiltered = wf_mul(wf_mul(w2, w2), wf_set(ray->area2));
    const wf determinant = wf_fma(h2, wf_fma(w2, wf_set(r->xx + r->yy), h2), unfiltered);
    const wf inverse_root = wf_inverse_root(determinant);
    const wf across = wf_fma(wf_mul(v22, dx), dx, wf_mul(wf_mul(v11, dy), dy));
    const wf form = wf_fnma(wf_mul(wf_set(2), v12), wf_mul(dx, dy), across);
    const wf distance2 = wf_max(wf_mul(wf_mul(form, inverse_root), inverse_root), wf_set(0));
    return (ray_sample){wf_mul(distance2, wf_set(view->exponent_scale)), wf_mul(w2, inverse_root),
                        wf_clamp(plane, r->key_low, r->key_high)};
}

#endif
