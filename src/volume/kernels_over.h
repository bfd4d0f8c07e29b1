// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h and gaussian_body.h: the compositor `over` of a block of 4x4 pixels, front to back:
// the voxels' and the trained Gaussians' (docs/math.md section 12). A block's channels are premultiplied red,
// green, blue, what shows of all behind, and depth.
//
// Phi based on: M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 1964, 7.1.26.
#ifndef EWA_SRC_VOLUME_KERNELS_OVER_H
#define EWA_SRC_VOLUME_KERNELS_OVER_H

#include "wide/wide_functions.h"

/// Phi(t), the share of a normal distribution below t, within 1.5e-7; 0 below -6.
static ALWAYS_INLINE wf share_below(wf t) {
    const wf one = wf_set(1), x = wf_mul(wf_abs(t), wf_set(0.707106781f));
    const wf bell = wf_exp2(wf_mul(wf_set(-0.721347520f), wf_mul(t, t))); // log2(e) / 2
    const wf u = wf_div(one, wf_fma(x, wf_set(0.3275911f), one));
    wf series = wf_fma(u, wf_set(1.061405429f), wf_set(-1.453152027f));
    series = wf_fma(u, series, wf_set(1.421413741f));
    series = wf_fma(u, series, wf_set(-0.284496736f));
    series = wf_fma(u, series, wf_set(0.254829592f));
    const wf beyond = wf_mul(wf_set(0.5f), wf_mul(wf_mul(u, series), bell));
    return wf_select(wf_lt(t, wf_set(0)), wf_keep(wf_lt(wf_set(-6), t), beyond), wf_sub(one, beyond));
}

/// The share of a Gaussian of a standard deviation in depth around z that lies in front of a surface.
static ALWAYS_INLINE wf share_ahead(wf surface, wf z, wf deviation) {
    return share_below(wf_div(wf_sub(surface, z), deviation));
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
