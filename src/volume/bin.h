// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which blocks of voxels touch which tiles, front to back.
#ifndef EWA_SRC_VOLUME_BIN_H
#define EWA_SRC_VOLUME_BIN_H

#include "base/base.h"
#include "volume/view.h"

/// Where a block is on the screen.
typedef struct ewa_block_view {
    uint32_t block;
    int32_t slice_first, slice_last;
    int32_t left, top, right, bottom; ///< pixels that it may touch, within the picture; right, bottom: beyond
    bool near;                        ///< some of its voxels may lie at the eye, in front of slice 0
} ewa_block_view;

/// The blocks of every tile, by their first slices, ties by their numbers.
typedef struct ewa_volume_bins {
    uint32_t tiles_x, tiles_y;
    uint64_t visible_count, culled_voxel_count;
    uint32_t longest_span;       ///< slices of a block, at most
    uint64_t most_in_flight;     ///< voxels that a tile holds at a time, at most
    const ewa_block_view *views; ///< [visible_count] front to back
    const ewa_block_view *all;   ///< [block]
    const uint64_t *tile_first;  ///< [tile] of `list`, and one more
    const uint32_t *list;        ///< of `views`
    ewa_buffer found, sorted, slice_counts, tiles, lists, expiries;
} ewa_volume_bins;

/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_bins_fill(ewa_context *context, ewa_volume_bins *bins, const ewa_voxel_level *level,
                                const ewa_grid_view *grid, const ewa_volume_slices *slices,
                                const ewa_camera *camera);

void ewa_volume_bins_free(ewa_context *context, ewa_volume_bins *bins);

#endif
