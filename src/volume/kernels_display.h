// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h and gaussian_body.h: premultiplied linear colours to premultiplied display values,
// and back: the sRGB curve of the straight colours, which goes on above 1 (docs/math.md section 12).
#ifndef EWA_SRC_VOLUME_KERNELS_DISPLAY_H
#define EWA_SRC_VOLUME_KERNELS_DISPLAY_H

#include "wide/wide_functions.h"

/// x^exponent for x in [2^-100, 2^100].
static ALWAYS_INLINE wf curve_power(wf x, float exponent) {
    return wf_exp2(wf_mul(wf_set(exponent), wf_log2(wf_min(wf_max(x, wf_set(0x1p-100f)), wf_set(0x1p100f)))));
}

static ALWAYS_INLINE wf display_of_linear(wf x) {
    const wf curve = wf_fma(wf_set(1.055f), curve_power(x, 1 / 2.4f), wf_set(-0.055f));
    return wf_select(wf_le(x, wf_set(0.0031308f)), wf_mul(x, wf_set(12.92f)), curve);
}

static ALWAYS_INLINE wf linear_of_display(wf x) {
    const wf curve = curve_power(wf_fma(x, wf_set(1 / 1.055f), wf_set(0.055f / 1.055f)), 2.4f);
    return wf_select(wf_le(x, wf_set(0.04045f)), wf_mul(x, wf_set(1 / 12.92f)), curve);
}

/// 1 / alpha, 0 where there is nothing.
static ALWAYS_INLINE wf straighten(wf alpha) {
    const wm visible = wf_lt(wf_set(0), alpha);
    return wf_keep(visible, wf_div(wf_set(1), wf_select(visible, alpha, wf_set(1))));
}

static ALWAYS_INLINE void premultiplied_to_display(wf color[4]) {
    const wf inverse = straighten(color[3]);
    for (int c = 0; c < 3; c++) color[c] = wf_mul(display_of_linear(wf_mul(color[c], inverse)), color[3]);
}

static ALWAYS_INLINE void premultiplied_to_linear(wf color[4]) {
    const wf inverse = straighten(color[3]);
    for (int c = 0; c < 3; c++) color[c] = wf_mul(linear_of_display(wf_mul(color[c], inverse)), color[3]);
}

#endif
