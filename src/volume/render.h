// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of a volume before its tiles are drawn.
#ifndef EWA_SRC_VOLUME_RENDER_H
#define EWA_SRC_VOLUME_RENDER_H

#include "volume/tile.h"

/// A frame; points into itself: it stays where it is.
typedef struct ewa_volume_frame {
    ewa_grid_view grid;
    ewa_volume_slices slices;
    ewa_shading_setup shading;
    ewa_volume_job job;
    double start_s, binned_s;
} ewa_volume_frame;

/// The context that a renderer is of.
const ewa_context *ewa_volume_renderer_context(const ewa_volume_renderer *renderer);

/// Fails for a level that the voxels do not have. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_volume_level_check(ewa_context *context, const ewa_voxels *voxels,
                                  const ewa_volume_options *options);

/// Sets up a frame of checked arguments, but for its target; memory is the renderer's. Errors: EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
ewa_status ewa_volume_frame_make(ewa_volume_renderer *renderer, const ewa_voxels *voxels,
                                 const ewa_camera *camera, const ewa_volume_options *options, bool with_times,
                                 ewa_volume_frame *frame);

/// Makes room for the processor to draw a frame that is set up. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_frame_reserve(ewa_volume_renderer *renderer, const ewa_volume_frame *frame);

/// What a frame that was drawn took, up to now.
void ewa_volume_frame_measure(const ewa_volume_renderer *renderer, const ewa_volume_frame *frame,
                              ewa_volume_stats *stats);

#endif
