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

static ALWAYS_INLINE void store_colors_of(const ewa_volume_target *to, const block_place *at,
                                          const wf color[4]) {
    if (to->rgba8) store_codes(to->rgba8, to->width_px, at, color_codes(color));
    if (to->rgba) store_colors(to->rgba, to->width_px, at, color);
}

/// A depth in camera space, in double precision: the unit may be any.
static inline float to_camera_depth(float z, double unit_camera) {
    return z < __builtin_inff() ? (float)((double)z * unit_camera) : z;
}

/// Writes depth, normal and coverage: the surface's, to the byte, where nothing that lets light through counts.
/// `opacity` is what that takes of the light, `ahead` the depth at which it takes the last of half of it before the
/// surface, `past` that behind the surface, where this leaves so much; both +infinity where that never happens.
static void store_geometry(const ewa_volume_target *to, const block_place *at, wf opacity, wf ahead, wf past,
                           double unit_camera) {
    if (!to->depth && !to->normal && !to->coverage) return;
    const ewa_surface_planes *surface = &to->surface;
    float alphas[16], near[16], far[16];
    wf_store(alphas, opacity), wf_store(near, ahead), wf_store(far, past);
    for (uint32_t row = 0; row < at->height; row++)
        for (uint32_t column = 0; column < at->width; column++) {
            const size_t pixel = (size_t)(at->y + row) * to->width_px + at->x + column;
            const uint32_t lane = 4 * row + column;
            float depth = to_camera_depth(near[lane], unit_camera), normal[3] = {0, 0, 0};
            float coverage = 0;
            if (surface->depth) {
                const float own = surface->depth[pixel], behind = to_camera_depth(far[lane], unit_camera);
                coverage = surface->coverage ? surface->coverage[pixel] : surface->rgba[4 * pixel + 3];
                if (!(depth < own)) {
                    const bool shows = !(own < behind && behind < __builtin_inff());
                    depth = shows ? own : behind;
                    if (shows && surface->normal) memcpy(normal, surface->normal + 3 * pixel, sizeof normal);
                }
            }
            if (coverage < 1) coverage += alphas[lane] * (1 - coverage);
            if (to->depth) to->depth[pixel] = depth;
            if (to->normal) memcpy(to->normal + 3 * pixel, normal, sizeof normal);
            if (to->coverage) to->coverage[pixel] = coverage;
        }
}

#endif
