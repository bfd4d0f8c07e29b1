// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h and of the kernels of volumes: the sRGB curve over the wide type (docs/math.md section
// 7, last step).
#ifndef EWA_SRC_KERNELS_SRGB_CODES_H
#define EWA_SRC_KERNELS_SRGB_CODES_H

#include "math/wide.h"

/// The sRGB curve times 255, rounded to nearest, for values in [0, 1]: 255 (1.055 x^(1/2.4) - 0.055) with
/// x^(1/2.4) from the octave and a polynomial in the mantissa, within 0.0003 of a code.
static ALWAYS_INLINE wi srgb_codes(wf linear) {
    static const float octaves[16] = {
        // 255 * 1.055 * 2^((i - 15) / 2.4); i is the exponent, whose bits are 127 for [1, 2), modulo 16
        3.53472114f, 4.71828699f, 6.29815722f, 8.40703106f, 11.2220402f, 14.9796267f,
        19.9954033f, 26.6906605f, 35.627758f,  47.5573502f, 63.4814453f, 84.7375641f,
        113.111076f, 150.985184f, 201.541031f, 269.024994f,
    };
    const wi bits = wi_of_bits(linear);
    const wf m = wf_of_bits(wi_or(wi_and(bits, wi_set(0x7fffff)), wi_set(0x3f800000)));
    const wf m2 = wf_mul(m, m);
    const wf root = wf_fma(m2,
                           wf_fma(m2, wf_fma(m, wf_set(0.0054353733f), wf_set(-0.0514170193f)),
                                  wf_fma(m, wf_set(0.2085678072f), wf_set(-0.4917302076f))),
                           wf_fma(m, wf_set(0.9528149418f), wf_set(0.3763302953f)));
    const wf curve = wf_fma(wf_lookup(octaves, wi_sar(bits, 23)), root, wf_set(0.5f - 255 * 0.055f));
    const wf line = wf_fma(linear, wf_set(255 * 12.92f), wf_set(0.5f));
    return wi_from_f(wf_select(wf_le(linear, wf_set(0.0031308f)), line, curve));
}

static inline wf wf_clamp01(wf a) { return wf_min(wf_max(a, wf_set(0)), wf_set(1)); }

#endif
