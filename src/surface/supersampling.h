// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures at a multiple of their resolution, averaged: what is far, where a pixel holds many surfels (docs/math.md
// section 7).
#ifndef EWA_SRC_SURFACE_SUPERSAMPLING_H
#define EWA_SRC_SURFACE_SUPERSAMPLING_H

#include "base/base.h"
#include "surface/backend.h"

/// Areas on the screen of what a frame shows: of all, and of surfels of less than EWA_PART_RADIUS_PX / 2^k in radius.
/// Zero-initialise.
typedef struct ewa_part_areas {
    double all, smaller[3];
} ewa_part_areas;

void ewa_part_areas_add(ewa_part_areas *areas, double radius_px, double area);

/// Returns into how many parts, 1, 2, 4 or EWA_MAX_SUPERSAMPLING, the sides of pixels are to be divided so that at least
/// half of the area is of surfels that are about as large as a part, EWA_PART_RADIUS_PX in radius; no more than a picture
/// of the camera's size may have pixels.
uint32_t ewa_part_areas_choose(const ewa_part_areas *areas, const ewa_camera *camera);

/// The same for the surfels of a frame, at the level that its options ask for, whatever the order of the points.
uint32_t ewa_supersampling_choose(const ewa_render_job *job);

/// Draws a frame whose options' `supersampling` is 2 or more: every pixel as so many squared, band by band, and the
/// average of them. `room` is memory that survives frames. Errors: those of the back end; EWA_ERROR_LIMIT (more pixels than a
/// picture may have); EWA_ERROR_MEMORY.
ewa_status ewa_supersampling_draw(ewa_context *context, const ewa_backend *backend, void *state,
                                  const ewa_render_job *job, ewa_buffer *room, ewa_render_stats *stats);

#endif
