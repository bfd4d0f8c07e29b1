// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile of a picture of voxels: blocks in, buckets by depth, pixels out.
#ifndef EWA_SRC_VOLUME_TILE_H
#define EWA_SRC_VOLUME_TILE_H

#include "volume/layers.h"
#include "volume/near.h"
#include "volume/section.h"

/// What a worker needs; survives from frame to frame. Zero-initialise.
typedef struct ewa_volume_scratch {
    ewa_buffer sums, pixels, surface, enter, ring, colors, windows, splats, next, free, order, keys, near,
        queue;
    ewa_buffer layers[2], lists; ///< of ewa_volume_tile_layers()
    uint64_t hidden_count, splat_count, point_count;
    double setup_s, points_s, splats_s, resolve_s;
} ewa_volume_scratch;

/// A frame; nothing of it changes while its tiles are drawn, but the workers' scratches.
typedef struct ewa_volume_job {
    const ewa_volume_kernels *kernels;
    const ewa_voxel_level *level;
    const ewa_volume_bins *bins;
    const ewa_near_list *near;
    const ewa_grid_view *grid;
    const ewa_volume_slices *slices;
    const ewa_point_filter *filters;
    const float *surface_depth; ///< NULL: none
    ewa_ray_sections sections;
    ewa_volume_view view;
    ewa_volume_target target;
    bool with_times;
    ewa_volume_scratch *scratch; ///< [worker]
} ewa_volume_job;

/// Makes room for any tile of a frame and forgets the counts. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_scratch_reserve(ewa_context *context, ewa_volume_scratch *scratch,
                                      const ewa_volume_job *job);

void ewa_volume_scratch_free(ewa_context *context, ewa_volume_scratch *scratch);

/// Tile `index` as layers: of what lies in front of the surfaces, or of everything. `layers` stay as they are until the
/// next call with the same `everything`. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_tile_layers(ewa_context *context, const ewa_volume_job *job, uint32_t index,
                                  uint32_t worker, bool everything, const ewa_volume_layers **layers);

/// Sets where the rays of a tile's pixels end, at the surfaces unless everything counts or where section planes leave nothing, and
/// where these let them begin: [block][16] depths, +infinity outside of the picture. `begins` only with section planes.
void ewa_volume_tile_bounds(const ewa_volume_job *job, int32_t x_px, int32_t y_px, bool everything, float *ends, float *begins);

/// Draws tile `index` of an ewa_volume_job (an ewa_task).
void ewa_volume_tile_draw(void *job, uint32_t index, uint32_t worker);

#endif
