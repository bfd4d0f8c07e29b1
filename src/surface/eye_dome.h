// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Eye-dome lighting as a pass over the finished picture: where it comes from, and its memory. Part of a frame of
// surfels, or by itself over a picture of other things.
#ifndef EWA_SRC_SURFACE_EYE_DOME_H
#define EWA_SRC_SURFACE_EYE_DOME_H

#include "base/base.h"
#include "ewa/render.h"
#include "surface/pipeline.h"

/// The pass over one frame, and what it keeps from frame to frame. Zero-initialise.
typedef struct ewa_eye_dome_pass {
    const ewa_pipeline_kernels *kernels;
    ewa_eye_dome eye_dome;
    ewa_buffer keys, depth, surfaces;
} ewa_eye_dome_pass;

/// Prepares the pass for a frame with options->eye_dome > 0. The tiles are then to be drawn with `*options`,
/// which loses its background, into `*drawn`.
ewa_status ewa_eye_dome_pass_start(ewa_context *context, ewa_eye_dome_pass *pass, const ewa_camera *camera,
                                   const ewa_frame *frame, ewa_render_options *options, ewa_frame *drawn);

/// Writes the colours of the frame.
void ewa_eye_dome_pass_finish(ewa_context *context, ewa_eye_dome_pass *pass);

void ewa_eye_dome_pass_free(ewa_context *context, ewa_eye_dome_pass *pass);

/// The whole pass over a picture of anything that has depths: a frame's depth and rgba, which is over nothing.
/// `strength` is as ewa_render_options.eye_dome, above 0; `background` is straight. Writes rgba and, unless NULL, rgba8
/// of the frame, over the background: of a picture by ewa_render() the bytes that it gives with that lighting.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_eye_dome_apply(ewa_context *context, const ewa_camera *camera, double strength,
                              const float background[4], const ewa_frame *frame);

#endif
