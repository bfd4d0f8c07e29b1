// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame before it is drawn: what its sources, options and camera are to tiles, for every back end.
#ifndef EWA_SRC_SURFACE_JOB_H
#define EWA_SRC_SURFACE_JOB_H

#include "surface/eye_dome.h"
#include "surface/tile.h"

/// The memory of a back end's frames, which survives them. Zero-initialise, then set eye_dome.kernels.
typedef struct ewa_job_room {
    ewa_eye_dome_pass eye_dome;
    bool with_eye_dome;
    ewa_buffer sources;               ///< ewa_tile_source, whose bins keep their memory
    ewa_buffer order, requests, bins; ///< of sources and their bins
    uint32_t source_count;
} ewa_job_room;

/// Sets what the tiles of `side_px` of a frame share, all but bins, `scratch` and `first_tile`: views, packets, channels,
/// resolve. What of eye-dome lighting is to be drawn first is in job->resolve. `job` is not to be moved. Errors:
/// EWA_ERROR_MEMORY, EWA_ERROR_NUMERIC (a camera without a view volume), EWA_CANCELLED.
ewa_status ewa_tile_job_make(ewa_context *context, ewa_job_room *room, const ewa_render_job *frame,
                             uint32_t side_px, ewa_tile_job *job);

/// Sets which tiles see which packets, and where these are. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_tile_job_bin(ewa_context *context, ewa_job_room *room, ewa_tile_job *job);

/// What comes after the tiles: eye-dome lighting, where the frame's band is its last, and a warning of pixels without a
/// colour.
void ewa_job_finish(ewa_context *context, ewa_job_room *room, const ewa_render_job *frame,
                    uint64_t broken_pixel_count);

/// Adds the splats of the sources, and those of packets in no tile, to the counts, and what `worker_count` of
/// job->scratch have counted.
void ewa_job_count(const ewa_tile_job *job, uint32_t worker_count, ewa_render_stats *stats);

void ewa_job_room_free(ewa_context *context, ewa_job_room *room);

#endif
