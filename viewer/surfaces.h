// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The surfaces of a picture: surfels as they are, and octrees, each drawn from its levels.
#ifndef EWA_VIEWER_SURFACES_H
#define EWA_VIEWER_SURFACES_H

#include "painter.h"

/// Draws all surfaces of a scene. Surfels alone, or one octree alone, are the picture that the library makes; what
/// else is there together is drawn apart, and put together by the depths of the pixels. `stats` may be NULL.
ewa_status surfaces_draw(paint_tools *tools, const paint_scene *scene, const ewa_frame *frame,
                         paint_stats *stats);

void surfaces_free(paint_tools *tools);

#endif
