// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A picture in square tiles, which workers draw one at a time; those at the right and lower edge may be
// smaller.
#ifndef EWA_SRC_TILING_TILES_H
#define EWA_SRC_TILING_TILES_H

#include <stdint.h>

typedef struct ewa_tiles {
    uint32_t width_px, height_px; ///< of the picture
    uint32_t side_px, columns, rows;
} ewa_tiles;

/// The pixels of a tile, all within the picture.
typedef struct ewa_tile_rect {
    uint32_t x_px, y_px, width_px, height_px;
} ewa_tile_rect;

static inline ewa_tiles ewa_tiles_make(uint32_t width_px, uint32_t height_px, uint32_t side_px) {
    return (ewa_tiles){width_px, height_px, side_px, (width_px + side_px - 1) / side_px,
                       (height_px + side_px - 1) / side_px};
}

static inline uint32_t ewa_tiles_count(const ewa_tiles *tiles) { return tiles->columns * tiles->rows; }

/// Tiles are numbered row by row.
static inline ewa_tile_rect ewa_tiles_rect(const ewa_tiles *tiles, uint32_t index) {
    const uint32_t side = tiles->side_px, x = index % tiles->columns * side,
                   y = index / tiles->columns * side;
    const uint32_t right = tiles->width_px - x, below = tiles->height_px - y;
    return (ewa_tile_rect){x, y, right < side ? right : side, below < side ? below : side};
}

#endif
