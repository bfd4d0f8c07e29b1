// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h and gaussian_body.h: from a composited block of 4x4 pixels to those of the frame,
// over what is behind (docs/math.md sections 7 and 12).
#ifndef EWA_SRC_VOLUME_KERNELS_PLANES_H
#define EWA_SRC_VOLUME_KERNELS_PLANES_H

#include "volume/kernels.h"
#include "volume/kernels_display.h"
#include "wide/pixels.h"

static ALWAYS_INLINE void clear_block(float *pixels) {
    for (int c = 0; c < 3; c++) wf_store(pixels + 16 * c, wf_set(0));
    wf_store(pixels + 48, wf_set(1));
    wf_store(pixels + 64, wf_set(__builtin_inff()));
}

/// `unit` multiplies the numbers in double precision: theirs may be any.
static void store_plane(float *plane, uint32_t width_px, const block_place *at, wf values, double unit) {
    float lanes[16];
    wf_store(lanes, values);
    for (int i = 0; i < 16 && unit != 1; i++)
        if (lanes[i] < __builtin_inff()) lanes[i] = (float)((double)lanes[i] * unit);
    store_block(plane, 1, width_px, at, lanes);
}

/// What is behind a block, linear and premultiplied: the background, or a picture.
static ALWAYS_INLINE void load_behind(const ewa_volume_target *to, const float *picture,
                                      const block_place *at, wf behind[4]) {
    for (int c = 0; c < 4; c++) behind[c] = wf_set(to->background[c]);
    if (!picture) return;
    float rgba[64] = {0};
    for (uint32_t row = 0; row < at->height; row++)
        memcpy(rgba + 16 * row, picture + 4 * ((size_t)(at->y + row) * to->width_px + at->x),
               at->width * 4 * sizeof(float));
    w_load4(rgba, 16, behind);
}

/// Pixels over what is behind them. `display`: their colours are display values; what comes out is linear.
static ALWAYS_INLINE void lay_over(const float *pixels, const wf behind[4], bool display, wf out[4]) {
    const wf through = wf_load(pixels + 48), opacity = wf_sub(wf_set(1), through);
    wf under[4] = {behind[0], behind[1], behind[2], behind[3]};
    if (display) premultiplied_to_display(under);
    for (int c = 0; c < 4; c++)
        out[c] = wf_fma(through, under[c], c < 3 ? wf_load(pixels + 16 * c) : opacity);
    if (display) premultiplied_to_linear(out);
}

static ALWAYS_INLINE void store_pixels(const ewa_volume_target *to, const block_place *at, const wf color[4],
                                       wf opacity, wf depth, double unit_camera) {
    if (to->rgba8) store_codes(to->rgba8, to->width_px, at, color_codes(color));
    if (to->rgba) store_colors(to->rgba, to->width_px, at, color);
    if (to->coverage) store_plane(to->coverage, to->width_px, at, opacity, 1);
    if (to->depth) store_plane(to->depth, to->width_px, at, depth, unit_camera);
}

#endif
