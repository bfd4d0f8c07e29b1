// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures at a multiple of their resolution, averaged: what is far, where a pixel holds many surfels (docs/math.md
// section 7).
#ifndef EWA_SRC_SURFACE_SUPERSAMPLING_H
#define EWA_SRC_SURFACE_SUPERSAMPLING_H

#include "base/base.h"
#include "surface/backend.h"

/// Returns into how many parts, 1, 2, 4 or EWA_MAX_SUPERSAMPLING, the sides of a frame's pixels are to be divided so that
/// half of what it shows is made of surfels that are about as large as a part, EWA_PART_RADIUS_PX in radius; no more than
/// a picture may have pixels. The same for every order of the points and of the sources.
uint32_t ewa_supersampling_choose(const ewa_render_job *job);

/// Draws a frame whose options' `supersampling` is 2 or more: every pixel as so many squared, band by band, and their
/// average. `room` is memory that survives frames. Errors: those of the back end; EWA_ERROR_LIMIT (more pixels than a
/// picture may have); EWA_ERROR_MEMORY.
ewa_status ewa_supersampling_draw(ewa_context *context, const ewa_backend *backend, void *state,
                                  const ewa_render_job *job, ewa_buffer *room, ewa_render_stats *stats);

#endif
