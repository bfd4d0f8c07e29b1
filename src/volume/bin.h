// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which blocks of voxels touch which tiles, front to back.
#ifndef EWA_SRC_VOLUME_BIN_H
#define EWA_SRC_VOLUME_BIN_H

#include "tiling/bin.h"
#include "tiling/tiles.h"
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
    ewa_tiles tiles;
    ewa_bin_lists by_slice, by_tile;
    uint64_t culled_voxel_count;
    uint32_t longest_span;       ///< slices of a block, at most
    uint64_t max_in_flight;      ///< voxels that a tile holds at a time, at most
    const ewa_block_view *views; ///< [block]
    ewa_buffer found, workers;
} ewa_volume_bins;

/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_bins_fill(ewa_context *context, ewa_volume_bins *bins, const ewa_voxel_level *level,
                                const ewa_grid_view *grid, const ewa_volume_slices *slices,
                                const ewa_camera *camera);

void ewa_volume_bins_free(ewa_context *context, ewa_volume_bins *bins);

#endif
