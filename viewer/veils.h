// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What of a picture lets light through: volumes and Gaussians, in one order of depth, over the surfaces.
#ifndef EWA_VIEWER_VEILS_H
#define EWA_VIEWER_VEILS_H

#include "painter.h"

/// Whether a scene has any.
static inline bool veils_some(const paint_scene *scene) {
    return scene->splats_count + scene->voxels_count > 0;
}

/// Draws them over the background, or over surfaces of a scene, drawn over nothing; both planes NULL: none. Adds to
/// `*took_s`.
ewa_status veils_draw(paint_tools *tools, const paint_scene *scene, const float *surface_depth,
                      const float *surface_rgba, const ewa_frame *frame, double *took_s);

void veils_free(paint_tools *tools);

#endif
