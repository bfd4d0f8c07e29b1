// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The derivative of a frame, tile by tile.
#ifndef EWA_SRC_ADJOINT_TILES_H
#define EWA_SRC_ADJOINT_TILES_H

#include "adjoint/discs.h"
#include "adjoint/exact.h"
#include "adjoint/kernels.h"
#include "ewa/adjoint.h"
#include "reference/adjoint_frame.h"
#include "tiling/bin.h"
#include "tiling/tiles.h"

enum {
    EWA_ADJOINT_TILE_PX = 16, ///< side of a tile: the sums of its pixels stay in cache
    EWA_ADJOINT_MAX_TILE_PX = 64,
};

/// What is added up in whole numbers: powers of two that terms are multiplied by before they are rounded.
typedef struct ewa_adjoint_units {
    double color, other, depth;
} ewa_adjoint_units;

/// Tiles [first, end) that a splat may reach, as ewa_bin_items has them; none: both are 0.
typedef struct ewa_adjoint_range {
    uint32_t first, end; ///< column | row << 16
} ewa_adjoint_range;

/// A pixel of a tile on its way from surface to surface.
typedef struct ewa_adjoint_pixel {
    double through;            ///< what the surfaces that have been found leave open
    ewa_reference_cover first; ///< of the nearest
} ewa_adjoint_pixel;

/// What one worker needs.
typedef struct ewa_adjoint_scratch {
    uint64_t *near_first;              ///< [of a tile]: its points, by where they begin
    uint64_t *near_room;               ///< as many
    ewa_reference_splat *splats;       ///< [of a tile], of the nearest points, as many as were asked for
    const ewa_reference_splat **order; ///< those by where they begin, the same whatever the points' order
    uint32_t splat_capacity, splat_count;
    double *planes;                    ///< [surface][block][EWA_PLANES][EWA_EIGHT_LANES]
    size_t plane_capacity;
    uint32_t *reached;                 ///< [surface]: splats that may count, the first of `order`
    ewa_adjoint_visit *visits;         ///< [surface][of `order`]: where each does
    ewa_adjoint_samples samples;       ///< of the tile's surfaces
    ewa_reference_layer *layers;       ///< [surface] of one pixel
    ewa_adjoint_pixel *pixels;         ///< [of a tile]
    uint8_t *done;                     ///< [block]: lanes that are ended
    double largest_color;              ///< of the splats that it has projected
    double largest_depth;
    ewa_exact_sum *camera;             ///< [EWA_CAMERA_NUMBERS]; NULL: not wanted
} ewa_adjoint_scratch;

/// A frame on its way back.
typedef struct ewa_adjoint_job {
    ewa_reference_frame frame;
    const ewa_adjoint_kernels *kernels;
    ewa_frame_cotangent cotangent;
    ewa_gradient gradient;
    ewa_tiles tiles;
    ewa_bin_lists lists;
    ewa_adjoint_range *ranges; ///< [point]
    float *begins;             ///< [point]: no depth of its splat is smaller
    int64_t *sums;             ///< [point][width], in units; added to by all tiles
    uint32_t width;            ///< of the sums that are wanted: the first so many
    uint32_t surface_count;    ///< of a pixel at most
    ewa_adjoint_units units;
    bool fills;                  ///< pixels that one surface fills end by `filling`
    ewa_adjoint_filling filling; ///< of the whole picture
    bool discs;            ///< all points are discs without clip lines: those that are not near go eight at a time
    ewa_disc_view disc_view;
    const ewa_disc_kernels *disc_kernels;
    ewa_adjoint_scratch *scratch; ///< [worker]
    uint32_t worker_count;
} ewa_adjoint_job;

/// Makes room, lists the splats of each tile, goes through all tiles, and from their sums to `gradient`. `frame`,
/// `cotangent` and `gradient` have been set. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_adjoint_run(ewa_adjoint_job *job);

/// Warns that a picture shows no surfel.
void ewa_adjoint_warn_unseen(ewa_context *context, uint64_t point_count, uint32_t width_px, uint32_t height_px);

/// ewa_render_backward() in double precision, whatever is wanted, by tiles of a side of at most EWA_ADJOINT_MAX_TILE_PX;
/// none changes a byte.
ewa_status ewa_adjoint_backward(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                const ewa_frame_cotangent *cotangent, const ewa_gradient *gradient, uint32_t tile_px);

/// Whether a frame has plain discs alone, and what they need of it.
bool ewa_adjoint_discs_make(const ewa_reference_frame *frame, ewa_disc_view *view);

/// Reads up to eight points; the last fills lanes without one.
void ewa_adjoint_discs_read(const ewa_surfel_reader *reader, const uint32_t *points, uint32_t count, ewa_disc_points *to);

/// Reads the linear colour of a point, and its opacity.
void ewa_adjoint_read_color(const ewa_surfel_reader *reader, uint64_t point, double color[3], double *opacity);

/// Projects points; one that is not drawn is in no pixel.
void ewa_adjoint_project(const ewa_adjoint_job *job, const uint32_t *points, uint32_t count, ewa_reference_splat *splats);

/// The power of two that is at most `size`, which is positive; 1 for what is not finite.
double ewa_adjoint_power_of(double size);

/// Sets the units of a splat's sums. Powers of two.
void ewa_adjoint_scales(const ewa_adjoint_job *job, const ewa_reference_splat *splat, double scales[EWA_MOMENT_COUNT]);

/// How many blocks a full tile has.
uint32_t ewa_adjoint_block_count(const ewa_adjoint_job *job);

/// Goes through tile `index`; an ewa_task.
void ewa_adjoint_tile(void *job, uint32_t index, uint32_t worker);

#endif
