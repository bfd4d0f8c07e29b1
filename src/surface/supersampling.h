// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures at a multiple of their resolution, averaged: what is far, where a pixel holds many surfels (docs/math.md
// section 7).
#ifndef EWA_SRC_SURFACE_SUPERSAMPLING_H
#define EWA_SRC_SURFACE_SUPERSAMPLING_H

#include "base/base.h"
#include "surface/backend.h"

/// Draws a frame by as many parts as the job says, band by band, and the average of them. `room` and `mixing` are memory that survives
/// frames. Errors: those of the back end; EWA_ERROR_LIMIT (more pixels than a picture may have); EWA_ERROR_MEMORY.
ewa_status ewa_supersampling_draw(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                                  ewa_buffer *room, ewa_buffer *mixing, ewa_render_stats *stats);

/// Draws every pixel as `finer` squared and the averages of them, by the back end's draw(), band by band. Sets `stats`. Errors: those of
/// the back end; EWA_ERROR_MEMORY.
ewa_status ewa_parts_draw(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                          uint32_t finer, ewa_buffer *room, ewa_render_stats *stats);

/// ewa_parts_draw() by a back end whose draw() averages the parts itself while `*averaged`, else 1, is `finer`, where fields hold
/// whole pixels.
ewa_status ewa_parts_draw_averaged(ewa_context *context, const ewa_backend *backend, void *state, const ewa_render_job *job,
                                   uint32_t finer, ewa_buffer *room, uint32_t *averaged, ewa_render_stats *stats);

/// Two pictures of a frame that become one.
typedef struct ewa_frame_pair {
    ewa_frame coarse, fine;
} ewa_frame_pair;

/// Makes room for the planes that a frame has, twice, and for linear colours where it has codes. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_frame_pair_reserve(ewa_context *context, ewa_buffer *room, const ewa_camera *camera, const ewa_frame *frame,
                                  ewa_frame_pair *pair);

/// Puts the mean of both into the frame's rows [first_px, end_px): colours and coverages by `finer_share`, the nearer depth.
void ewa_frame_pair_mix(ewa_context *context, const ewa_frame_pair *pair, double finer_share, const ewa_camera *camera,
                        uint32_t first_px, uint32_t end_px, const ewa_frame *frame);

#endif
