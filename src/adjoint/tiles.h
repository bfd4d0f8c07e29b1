// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The derivative of a frame, tile by tile.
#ifndef EWA_SRC_ADJOINT_TILES_H
#define EWA_SRC_ADJOINT_TILES_H

#include "adjoint/exact.h"
#include "ewa/adjoint.h"
#include "reference/adjoint_rows.h"
#include "tiling/bin.h"
#include "tiling/tiles.h"

enum {
    EWA_ADJOINT_TILE_PX = 16, ///< side of a tile: few of its splats lie in no row at hand
};

/// What is added up in whole numbers: powers of two that terms are multiplied by before they are rounded.
typedef struct ewa_adjoint_units {
    double color, other, depth;
} ewa_adjoint_units;

/// What one worker needs.
typedef struct ewa_adjoint_scratch {
    ewa_reference_rows rows;
    int64_t (*moments)[EWA_MOMENT_COUNT]; ///< [of a tile], in units
    double (*scales)[EWA_MOMENT_COUNT];   ///< [of a tile]: units of each
    double largest_color;    ///< of the splats that it has projected
    double largest_depth;
    ewa_exact_sum *camera;   ///< [EWA_CAMERA_NUMBERS]; NULL: not wanted
} ewa_adjoint_scratch;

/// A frame on its way back.
typedef struct ewa_adjoint_job {
    ewa_reference_frame frame;
    ewa_frame_cotangent cotangent;
    ewa_gradient gradient;
    ewa_tiles tiles;
    ewa_bin_lists lists;
    ewa_reference_tiles *ranges; ///< [point]
    uint64_t *first_slots;     ///< [point + 1]
    int64_t *slots;            ///< [slot][width]: sums of a splat in one tile
    uint32_t width;            ///< of the sums that are wanted: the first so many
    ewa_adjoint_units units;
    ewa_adjoint_scratch *scratch; ///< [worker]
    uint32_t worker_count;
} ewa_adjoint_job;

/// Makes room, lists the splats of each tile, goes through all tiles, and from their sums to `gradient`. `frame`,
/// `cotangent` and `gradient` have been set. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_adjoint_run(ewa_adjoint_job *job);

/// Warns that a picture shows no surfel.
void ewa_adjoint_warn_unseen(ewa_context *context, uint64_t point_count, uint32_t width_px, uint32_t height_px);

/// ewa_render_backward() in double precision, whatever is wanted, by tiles of a side of at most EWA_REFERENCE_MAX_TILE_PX; none changes a byte.
ewa_status ewa_adjoint_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                const ewa_frame_cotangent *cotangent, const ewa_gradient *gradient, uint32_t tile_px);

/// Sets the units of a splat's sums. Powers of two.
void ewa_adjoint_scales(const ewa_adjoint_job *job, const ewa_reference_splat *splat, double scales[EWA_MOMENT_COUNT]);

/// Goes through tile `index`; an ewa_task.
void ewa_adjoint_tile(void *job, uint32_t index, uint32_t worker);

#endif
