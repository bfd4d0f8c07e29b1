// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame whose derivative is wanted: its checked arguments, and its surfels as splats.
#ifndef EWA_SRC_REFERENCE_ADJOINT_FRAME_H
#define EWA_SRC_REFERENCE_ADJOINT_FRAME_H

#include "reference/adjoint_splat.h"

/// The frame. `resolve` points into it.
typedef struct ewa_reference_frame {
    ewa_context *context;
    ewa_surfel_reader reader;
    ewa_reference_view view;
    ewa_render_options options;
    ewa_shading_setup shading;
    ewa_reference_resolve resolve;
    uint64_t point_count;
} ewa_reference_frame;

/// Makes a frame of ewa_render()'s arguments and q0. Errors: EWA_ERROR_ARGUMENT; EWA_ERROR_UNSUPPORTED, with a message
/// that names the option, where there is no derivative: one pass, kernels but for the perspective and the affine one,
/// points of a size in pixels, highlights, eye-dome lighting, levels of detail.
ewa_status ewa_reference_frame_make(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                    double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                    ewa_reference_frame *frame);

/// Reads points [first, first + count) and projects them; what is not drawable is not drawn. `surfels` has room for as
/// many. Any thread.
void ewa_reference_frame_project(const ewa_reference_frame *frame, uint64_t first, uint64_t count, ewa_surfel *surfels,
                                 ewa_reference_splat *splats);

/// Sets the splat's fragment at a pixel's centre; returns whether it counts there. Any thread.
bool ewa_reference_fragment_make(const ewa_reference_frame *frame, const ewa_reference_splat *splat, uint64_t index,
                                 double x_px, double y_px, ewa_reference_fragment *fragment);

#endif
