// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of Gaussians, and of volumes among them: the renderer's memory, and what is drawn. One mixture may take several
// frames (mixture.c).
#ifndef EWA_SRC_VOLUME_GAUSSIAN_FRAME_H
#define EWA_SRC_VOLUME_GAUSSIAN_FRAME_H

#include "base/base.h"
#include "tiling/bin.h"
#include "tiling/tiles.h"
#include "volume/gaussian_kernels.h"
#include "volume/gaussian_solid.h"
#include "volume/render.h"
#include "volume/splat_colors.h"

/// What a worker needs; survives from frame to frame.
typedef struct ewa_gaussian_scratch {
    ewa_buffer marks, row_ids, row_marks, block_ids, hit, waiting, free, sort_buffer, solid;
    ewa_status status; ///< of its last tile
    uint64_t block_count, sorted_count;
    double project_s, draw_s;
} ewa_gaussian_scratch;

typedef struct ewa_gaussian_backend ewa_gaussian_backend; ///< gaussian_backend.h

struct ewa_gaussian_renderer {
    ewa_context *context;
    const ewa_gaussian_backend *backend; ///< NULL: the processor draws
    void *backend_state;
    bool used_backend; ///< for the last frame
    char remark[160];  ///< why not
    const ewa_gaussian_kernels *kernels;
    uint32_t worker_count;
    ewa_buffer records, keys, corners, views, parts, order, volumes;
    ewa_buffer planes; ///< of surfaces that Gaussians are a part of, or of their normals
    ewa_bin_lists by_tile;
    ewa_gaussian_scratch *scratch; ///< one per worker
};

/// Some packets of a set, and which of their splats are visible.
typedef struct ewa_gaussian_part {
    const ewa_splats *splats;
    const ewa_splat_colors *colors; ///< in place of the set's own; NULL: these
    const ewa_gaussian_view *view;
    size_t first_packet;
    uint32_t packet_count, first_slot; ///< of the room for records, of which it has one for each lane
    ewa_gaussian_found found;
} ewa_gaussian_part;

/// A frame; nothing of it changes while its tiles are drawn, but the workers' scratches.
typedef struct ewa_gaussian_job {
    ewa_gaussian_renderer *renderer;
    const ewa_mixture *mixture;
    const ewa_splat_colors *const *colors; ///< of each set, NULL: its own; or NULL: of all
    ewa_gaussian_view view;                ///< what those of the sets share
    ewa_volume_target target;
    ewa_tiles tiles, areas; ///< `areas`: the tiles of the volumes, or the same
    ewa_ray_sections sections;
    bool with_times;
    const ewa_gaussian_solids *solids; ///< draws these, and no volumes; NULL: what blends
    uint32_t part_count, visible_count;
    size_t room; ///< for records
    ewa_gaussian_part *parts;
    uint32_t *ids; ///< [visible_count] front to back
    ewa_volume_frame *volumes;
} ewa_gaussian_job;

/// Sets what the views of all sets share, and each one's, by checked options; `job` has its mixture, colours and tiles.
ewa_status ewa_gaussian_job_set_views(ewa_gaussian_job *job, const ewa_camera *camera, const ewa_gaussian_options *options,
                                      bool with_depth);

/// Draws a frame of checked arguments; `stats` may be NULL. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_gaussian_job_draw(ewa_gaussian_job *job, double merge_px, ewa_gaussian_stats *stats);

#endif
