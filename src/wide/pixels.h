// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of all kernels: from colours to pixels over the wide type, the sRGB curve, 8-bit codes, blocks of 4x4
// pixels into a picture (docs/math.md section 7, last step).
#ifndef EWA_SRC_WIDE_PIXELS_H
#define EWA_SRC_WIDE_PIXELS_H

#include "wide/wide.h"

#include <string.h>

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

/// Pixels of 8-bit sRGB and straight alpha, from premultiplied colours; the lowest byte is red.
static ALWAYS_INLINE wi color_codes(const wf color[4]) {
    const wf one = wf_set(1);
    const wm visible = wf_lt(wf_set(0), color[3]);
    wf straight[3] = {color[0], color[1], color[2]};
    wi codes = wi_set((int32_t)0xff000000u);
    if (wm_bits(wf_lt(color[3], one))) {
        const wf alpha = wf_clamp01(color[3]);
        const wf inverse = wf_keep(visible, wf_div(one, wf_select(visible, alpha, one)));
        for (int i = 0; i < 3; i++) straight[i] = wf_mul(straight[i], inverse);
        codes = wi_shl(wi_from_f(wf_fma(alpha, wf_set(255), wf_set(0.5f))), 24);
    }
    for (int i = 0; i < 3; i++) codes = wi_or(codes, wi_shl(srgb_codes(wf_clamp01(straight[i])), 8 * i));
    return codes;
}

/// The pixels of a block that lie within the picture.
typedef struct block_place {
    uint32_t x, y, width, height;
} block_place;

/// Block (column, row) of a tile at (x_px, y_px).
static ALWAYS_INLINE block_place place_block(int32_t x_px, int32_t y_px, int32_t width_px, int32_t height_px,
                                             uint32_t row, uint32_t column) {
    enum { SIDE = 4 };
    const uint32_t x = column * SIDE, y = row * SIDE;
    const uint32_t width = (uint32_t)width_px - x, height = (uint32_t)height_px - y;
    return (block_place){(uint32_t)x_px + x, (uint32_t)y_px + y, width < SIDE ? width : SIDE,
                         height < SIDE ? height : SIDE};
}

/// Writes `values` (per lane `stride` floats) to the block's pixels of a plane.
static void store_block(float *plane, uint32_t stride, uint32_t width_px, const block_place *at,
                        const float *values) {
    for (uint32_t row = 0; row < at->height; row++) {
        float *out = plane + ((size_t)(at->y + row) * width_px + at->x) * stride;
        memcpy(out, values + (size_t)row * 4 * stride, at->width * stride * sizeof(float));
    }
}

static ALWAYS_INLINE void store_colors(float *rgba, uint32_t width_px, const block_place *at,
                                       const wf color[4]) {
    float lanes[64];
    w_store4(lanes, color[0], color[1], color[2], color[3]);
    store_block(rgba, 4, width_px, at, lanes);
}

static ALWAYS_INLINE void store_codes(uint8_t *rgba8, uint32_t width_px, const block_place *at, wi codes) {
    const size_t stride_bytes = (size_t)width_px * 4;
    uint8_t *out = rgba8 + at->y * stride_bytes + (size_t)at->x * 4;
    if (at->width == 4 && at->height == 4) {
        wi_store_rows(out, stride_bytes, codes);
        return;
    }
    int32_t pixels[16];
    wi_store(pixels, codes);
    for (uint32_t row = 0; row < at->height; row++)
        memcpy(out + row * stride_bytes, &pixels[row * 4], at->width * sizeof *pixels);
}

#endif
