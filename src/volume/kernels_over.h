// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h and gaussian_body.h: the compositor `over` of a block of 4x4 pixels, front to back:
// the voxels' and the trained Gaussians' (docs/math.md section 12). A block's channels are premultiplied red,
// green, blue, what shows of all behind, and depth.
#ifndef EWA_SRC_VOLUME_KERNELS_OVER_H
#define EWA_SRC_VOLUME_KERNELS_OVER_H

#include "wide/wide.h"

/// The share of a Gaussian in depth around z that lies in front of a surface: nearly its own, for a `width`
/// of 3/4 sqrt(8 pi) standard deviations.
static ALWAYS_INLINE wf share_ahead(wf surface, wf z, wf width) {
    const wf one = wf_set(1);
    const wf u = wf_fma(wf_sub(surface, z), wf_div(one, width), wf_set(0.5f));
    const wf t = wf_min(wf_max(u, wf_set(0)), one);
    return wf_mul(wf_mul(t, t), wf_fma(wf_set(-2), t, wf_set(3)));
}

/// Adds a colour to a block's pixels; `weight` is what of it shows.
static ALWAYS_INLINE void add_light(float *pixels, wf weight, const wf color[3]) {
    for (int c = 0; c < 3; c++) wf_store(pixels + 16 * c, wf_fma(weight, color[c], wf_load(pixels + 16 * c)));
}

/// The depth of a pixel after something at z: z where what shows of all behind it falls from `through` to
/// `rest`, past `half` of the light.
static ALWAYS_INLINE wf note_depth(wf depth, wf half, wf through, wf rest, wf z) {
    return wf_select(wm_and(wf_lt(half, through), wf_le(rest, half)), z, depth);
}

#endif
