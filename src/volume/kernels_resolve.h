// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: from a tile's pixels to those of the frame (docs/math.md section 12; over what is
// behind: section 7).
#ifndef EWA_SRC_VOLUME_KERNELS_RESOLVE_H
#define EWA_SRC_VOLUME_KERNELS_RESOLVE_H

#include "volume/kernels.h"
#include "wide/pixels.h"

static void clear(ewa_volume_tile *tile) {
    const wf zero = wf_set(0), one = wf_set(1), nowhere = wf_set(__builtin_inff());
    for (size_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++) {
        float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
        for (int c = 0; c < 3; c++) wf_store(pixels + 16 * c, zero);
        wf_store(pixels + 48, one);
        wf_store(pixels + 64, nowhere);
    }
}

/// `unit` multiplies the numbers in double precision: theirs may be any.
static void store_plane(float *plane, uint32_t width_px, const block_place *at, wf values, double unit) {
    float lanes[16];
    wf_store(lanes, values);
    for (int i = 0; i < 16 && unit != 1; i++)
        if (lanes[i] < __builtin_inff()) lanes[i] = (float)((double)lanes[i] * unit);
    store_block(plane, 1, width_px, at, lanes);
}

static void resolve_block(const ewa_volume_target *to, const float *pixels, const block_place *at,
                          double unit_camera) {
    const wf through = wf_load(pixels + 48), opacity = wf_sub(wf_set(1), through);
    wf behind[4];
    for (int c = 0; c < 4; c++) behind[c] = wf_set(to->background[c]);
    if (to->surface_rgba) {
        float rgba[64] = {0};
        for (uint32_t row = 0; row < at->height; row++)
            memcpy(rgba + 16 * row, to->surface_rgba + 4 * ((size_t)(at->y + row) * to->width_px + at->x),
                   at->width * 4 * sizeof(float));
        w_load4(rgba, 16, behind);
    }
    wf out[4];
    for (int c = 0; c < 4; c++)
        out[c] = wf_fma(through, behind[c], c < 3 ? wf_load(pixels + 16 * c) : opacity);
    if (to->rgba8) store_codes(to->rgba8, to->width_px, at, color_codes(out));
    if (to->rgba) store_colors(to->rgba, to->width_px, at, out);
    if (to->coverage) store_plane(to->coverage, to->width_px, at, opacity, 1);
    if (to->depth) store_plane(to->depth, to->width_px, at, wf_load(pixels + 64), unit_camera);
}

static void resolve(const ewa_volume_view *view, const ewa_volume_tile *tile, const ewa_volume_target *to) {
    for (uint32_t row = 0; 4 * row < (uint32_t)tile->height_px; row++)
        for (uint32_t column = 0; 4 * column < (uint32_t)tile->width_px; column++) {
            const size_t block = (size_t)row * EWA_VOLUME_ROW_BLOCKS + column;
            const block_place at =
                place_block(tile->x_px, tile->y_px, tile->width_px, tile->height_px, row, column);
            resolve_block(to, tile->pixels + block * EWA_VOLUME_CHANNELS * 16, &at, view->unit_camera);
        }
}

#endif
