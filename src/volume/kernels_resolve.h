// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: from a tile's pixels to those of the frame (docs/math.md section 12; over what is
// behind: section 7).
#ifndef EWA_SRC_VOLUME_KERNELS_RESOLVE_H
#define EWA_SRC_VOLUME_KERNELS_RESOLVE_H

#include "volume/kernels.h"
#include "volume/kernels_planes.h"

static void clear(ewa_volume_tile *tile) {
    for (size_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++)
        clear_block(tile->pixels + block * EWA_VOLUME_CHANNELS * 16);
}

static void resolve(const ewa_volume_view *view, const ewa_volume_tile *tile, const ewa_volume_target *to) {
    for (uint32_t row = 0; 4 * row < (uint32_t)tile->height_px; row++)
        for (uint32_t column = 0; 4 * column < (uint32_t)tile->width_px; column++) {
            const size_t block = (size_t)row * EWA_VOLUME_ROW_BLOCKS + column;
            const block_place at =
                place_block(tile->x_px, tile->y_px, tile->width_px, tile->height_px, row, column);
            const float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
            wf behind[4], out[4];
            load_behind(to, to->surface.rgba, &at, behind);
            lay_over(pixels, behind, false, out);
            store_colors_of(to, &at, out);
            store_geometry(to, &at, wf_sub(wf_set(1), wf_load(pixels + 48)), wf_load(pixels + 64),
                           wf_set(__builtin_inff()), view->unit_camera);
        }
}

#endif
