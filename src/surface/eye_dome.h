// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting as a pass over the finished picture: where it comes from, and its memory.
#ifndef EWA_SRC_SURFACE_EYE_DOME_H
#define EWA_SRC_SURFACE_EYE_DOME_H

#include "base/base.h"
#include "ewa/render.h"
#include "surface/road.h"

/// The pass over one frame, and what it keeps from frame to frame. Zero-initialise.
typedef struct ewa_dome_pass {
    const ewa_road_kernels *kernels;
    ewa_eye_dome dome;
    ewa_buffer keys, depth, surfaces;
} ewa_dome_pass;

/// Prepares the pass for a frame with options->eye_dome > 0. The tiles are then to be drawn with `*options`,
/// which loses its background, into `*drawn`.
ewa_status ewa_dome_pass_start(ewa_context *context, ewa_dome_pass *pass, const ewa_camera *camera,
                               const ewa_frame *frame, ewa_render_options *options, ewa_frame *drawn);

/// Writes the colours of the frame.
void ewa_dome_pass_finish(ewa_context *context, ewa_dome_pass *pass);

void ewa_dome_pass_free(ewa_context *context, ewa_dome_pass *pass);

#endif
