// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: eye-dome lighting of a finished picture by its depths (docs/math.md section 7;
// semantics.h).
//
// Based on: C. Boucheny, "Interactive Scientific Visualization of Large Datasets: Towards a Perceptive-Based
// Approach", 2009; by pairs of opposite pixels of 1/z, which is linear on planes.
#ifndef EWA_SRC_SURFACE_PIPELINE_EYE_DOME_H
#define EWA_SRC_SURFACE_PIPELINE_EYE_DOME_H

#include "surface/pipeline_resolve.h"

static void eye_dome_keys(const ewa_eye_dome *eye_dome, uint32_t row) {
    float *keys = eye_dome->keys + row * eye_dome->key_stride;
    const wf nothing = wf_set(__builtin_nanf("")), infinite = wf_set(__builtin_inff()), one = wf_set(1);
    for (size_t x = 0; x < eye_dome->key_stride; x += EWA_BLOCK_LANES) wf_store(keys + x, nothing);
    if (row < EWA_EYE_DOME_REACH || row >= eye_dome->height_px + EWA_EYE_DOME_REACH) return;
    const float *depth = eye_dome->depth + (size_t)(row - EWA_EYE_DOME_REACH) * eye_dome->width_px;
    keys += EWA_EYE_DOME_REACH;
    for (uint32_t x = 0; x < eye_dome->width_px; x += EWA_BLOCK_LANES) {
        const uint32_t left = eye_dome->width_px - x, count = left < EWA_BLOCK_LANES ? left : EWA_BLOCK_LANES;
        float lanes[EWA_BLOCK_LANES];
        for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) lanes[i] = i < count ? depth[x + i] : __builtin_inff();
        const wf z = wf_load(lanes), key = eye_dome->orthographic ? wf_negate(z) : wf_div(one, z);
        wf_store(lanes, wf_select(wf_lt(z, infinite), key, nothing));
        memcpy(keys + x, lanes, count * sizeof *lanes);
    }
}

/// The share of light that is left to sixteen pixels; `keys` is the first one's.
static ALWAYS_INLINE wf eye_dome_light(const ewa_eye_dome *eye_dome, const float *keys) {
    const wf half = wf_set(0.5f), zero = wf_set(0), key = wf_load(keys);
    const wf unit = eye_dome->orthographic ? wf_set(eye_dome->inverse_height) : wf_div(wf_set(1), key);
    const ptrdiff_t stride = (ptrdiff_t)eye_dome->key_stride;
    wf sum = zero;
    for (ptrdiff_t r = 1; r <= EWA_EYE_DOME_REACH; r *= 2) {
        const ptrdiff_t steps[4] = {r, r * stride, r * stride + r, r * stride - r};
        for (int i = 0; i < 4; i++) {
            const wf pair = wf_mul(wf_add(wf_load(keys + steps[i]), wf_load(keys - steps[i])), half);
            sum = wf_add(sum, wf_max(wf_mul(wf_sub(pair, key), unit), zero)); // 0 for NaN
        }
    }
    return wf_exp2(wf_mul(sum, wf_set(eye_dome->exponent)));
}

static void eye_dome_shade(const ewa_eye_dome *eye_dome, uint32_t row) {
    const float *keys =
        eye_dome->keys + (row + EWA_EYE_DOME_REACH) * eye_dome->key_stride + EWA_EYE_DOME_REACH;
    const size_t first_pixel = (size_t)row * eye_dome->width_px;
    for (uint32_t x = 0; x < eye_dome->width_px; x += EWA_BLOCK_LANES) {
        const uint32_t left = eye_dome->width_px - x, count = left < EWA_BLOCK_LANES ? left : EWA_BLOCK_LANES;
        const float *from = eye_dome->surfaces + 4 * (first_pixel + x);
        float planes[4][EWA_BLOCK_LANES] = {{0}}, packed[4 * EWA_BLOCK_LANES];
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t c = 0; c < 4; c++) planes[c][i] = from[4 * i + c];
        const wf light = eye_dome_light(eye_dome, keys + x), alpha = wf_load(planes[3]);
        const wf through = wf_sub(wf_set(1), alpha);
        wf color[4];
        for (int c = 0; c < 4; c++) {
            const wf front = c < 3 ? wf_mul(wf_load(planes[c]), light) : alpha;
            color[c] = wf_fma(wf_set(eye_dome->background[c]), through, front);
        }
        if (eye_dome->rgba) {
            w_store4(packed, color[0], color[1], color[2], color[3]);
            memcpy(eye_dome->rgba + 4 * (first_pixel + x), packed, 4 * count * sizeof *packed);
        }
        if (eye_dome->rgba8) {
            int32_t codes[EWA_BLOCK_LANES];
            wi_store(codes, color_codes(color));
            memcpy(eye_dome->rgba8 + 4 * (first_pixel + x), codes, 4 * count);
        }
    }
}

#endif
