// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The pixels of a tile, each with the splats that count at it, in an order that does not depend on that of the points.
#ifndef EWA_SRC_REFERENCE_ADJOINT_ROWS_H
#define EWA_SRC_REFERENCE_ADJOINT_ROWS_H

#include "reference/adjoint_frame.h"

enum { EWA_REFERENCE_MAX_TILE_PX = 64 };

/// Tiles [first, end) that a splat may reach, as ewa_bin_items has them; none: both are 0.
typedef struct ewa_reference_tiles {
    uint32_t first, end; ///< column | row << 16
} ewa_reference_tiles;

ewa_reference_tiles ewa_reference_tiles_of(const ewa_reference_splat *splat, uint32_t side_px);

/// Room for the splats of a tile and the fragments of one of its rows. Zero-initialise.
typedef struct ewa_reference_rows {
    ewa_reference_splat *splats;           ///< [of a tile]
    const ewa_reference_splat **order;     ///< [of a tile]: those that are drawn, the same whatever the points' order
    ewa_reference_fragment *fragments, *sorted;
    uint8_t *columns;              ///< the pixel in the row of each
    ewa_reference_layer *layers;   ///< [layer_capacity]
    uint32_t capacity, layer_capacity, side_px;
} ewa_reference_rows;

/// Makes room for so many splats in tiles of a side of at most EWA_REFERENCE_MAX_TILE_PX, and at most `layers` surfaces of a
/// pixel. What there is after a failure
/// is freed like the rest. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_reference_rows_reserve(ewa_context *context, ewa_reference_rows *rows, uint32_t splats, uint32_t layers,
                                      uint32_t side_px);
void ewa_reference_rows_free(ewa_context *context, ewa_reference_rows *rows);

/// Projects the splats of a tile, whose points are given, and puts them in order. Any thread.
void ewa_reference_rows_fill(const ewa_reference_frame *frame, ewa_reference_rows *rows, const uint32_t *points,
                             uint32_t count);

/// Looks at a pixel, whose fragments are given; they may be changed. Their index is that of the splat in the tile.
typedef void ewa_reference_pixel(void *user, uint32_t x, uint32_t y, ewa_reference_fragment *fragments, uint32_t count);

/// Goes through the pixels [x, x + width) of row y. Any thread.
void ewa_reference_rows_walk(const ewa_reference_frame *frame, ewa_reference_rows *rows, uint32_t count, uint32_t x,
                             uint32_t width, uint32_t y, ewa_reference_pixel *pixel, void *user);

#endif
