// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: from a tile's pixels to those of the frame (docs/math.md section 12; over what is
// behind: section 7).
#ifndef EWA_SRC_VOLUME_KERNELS_RESOLVE_H
#define EWA_SRC_VOLUME_KERNELS_RESOLVE_H

#include "kernels/srgb_codes.h"
#include "volume/kernels.h"

#include <string.h>

static void clear(ewa_volume_tile *tile) {
    const wf zero = wf_set(0), one = wf_set(1), nowhere = wf_set(__builtin_inff());
    for (size_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++) {
        float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
        for (int c = 0; c < 3; c++) wf_store(pixels + 16 * c, zero);
        wf_store(pixels + 48, one);
        wf_store(pixels + 64, nowhere);
    }
}

/// 8-bit sRGB and straight alpha.
static ALWAYS_INLINE wi color_codes(const wf out[4]) {
    const wf one = wf_set(1), alpha = wf_clamp01(out[3]);
    const wm visible = wf_lt(wf_set(0), alpha);
    const wf inverse = wf_keep(visible, wf_div(one, wf_select(visible, alpha, one)));
    wi codes = wi_shl(wi_from_f(wf_fma(alpha, wf_set(255), wf_set(0.5f))), 24);
    for (int c = 0; c < 3; c++)
        codes = wi_or(codes, wi_shl(srgb_codes(wf_clamp01(wf_mul(out[c], inverse))), 8 * c));
    return codes;
}

/// Where the pixels of a block go: their rows' first numbers.
typedef struct place {
    size_t first;
    uint32_t width, height;
} place;

/// `unit` multiplies the numbers in double precision: theirs may be any.
static void store_plane(float *plane, uint32_t width_px, const place *at, wf values, double unit) {
    float lanes[16];
    wf_store(lanes, values);
    for (int i = 0; i < 16 && unit != 1; i++)
        if (lanes[i] < __builtin_inff()) lanes[i] = (float)((double)lanes[i] * unit);
    for (uint32_t row = 0; row < at->height; row++)
        memcpy(plane + at->first + (size_t)row * width_px, lanes + 4 * row, at->width * sizeof(float));
}

static void resolve_block(const ewa_volume_target *to, const float *pixels, const place *at,
                          double unit_camera) {
    const wf through = wf_load(pixels + 48), opacity = wf_sub(wf_set(1), through);
    wf behind[4];
    for (int c = 0; c < 4; c++) behind[c] = wf_set(to->background[c]);
    if (to->surface_rgba) {
        float rgba[64] = {0};
        for (uint32_t row = 0; row < at->height; row++)
            memcpy(rgba + 16 * row, to->surface_rgba + 4 * (at->first + (size_t)row * to->width_px),
                   at->width * 4 * sizeof(float));
        w_load4(rgba, 16, behind);
    }
    wf out[4];
    for (int c = 0; c < 4; c++)
        out[c] = wf_fma(through, behind[c], c < 3 ? wf_load(pixels + 16 * c) : opacity);
    if (to->rgba8) {
        int32_t codes[16];
        wi_store(codes, color_codes(out));
        for (uint32_t row = 0; row < at->height; row++)
            memcpy(to->rgba8 + 4 * (at->first + (size_t)row * to->width_px), codes + 4 * row, at->width * 4);
    }
    if (to->rgba) {
        float lanes[64];
        w_store4(lanes, out[0], out[1], out[2], out[3]);
        for (uint32_t row = 0; row < at->height; row++)
            memcpy(to->rgba + 4 * (at->first + (size_t)row * to->width_px), lanes + 16 * row,
                   at->width * 4 * sizeof(float));
    }
    if (to->coverage) store_plane(to->coverage, to->width_px, at, opacity, 1);
    if (to->depth) store_plane(to->depth, to->width_px, at, wf_load(pixels + 64), unit_camera);
}

static void resolve(const ewa_volume_view *view, const ewa_volume_tile *tile, const ewa_volume_target *to) {
    for (int32_t y = 0; y < tile->height_px; y += 4)
        for (int32_t x = 0; x < tile->width_px; x += 4) {
            const size_t block = (size_t)(y / 4 * EWA_VOLUME_ROW_BLOCKS + x / 4);
            const place at = {
                .first = (size_t)(tile->y_px + y) * to->width_px + (size_t)(tile->x_px + x),
                .width = tile->width_px - x < 4 ? (uint32_t)(tile->width_px - x) : 4,
                .height = tile->height_px - y < 4 ? (uint32_t)(tile->height_px - y) : 4,
            };
            resolve_block(to, tile->pixels + block * EWA_VOLUME_CHANNELS * 16, &at, view->unit_camera);
        }
}

#endif
