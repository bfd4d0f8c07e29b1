// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Closed surfaces, sampled evenly and unevenly, for tests and measurements of levels of detail.
#ifndef EWA_TESTS_SPLAT_LEVEL_SCENE_H
#define EWA_TESTS_SPLAT_LEVEL_SCENE_H

#include "check.h"

typedef enum level_kind {
    LEVEL_GRID,     ///< a plane of rows and columns
    LEVEL_JITTERED, ///< one point anywhere in each cell of a grid
    LEVEL_EVEN,     ///< no two points close to each other, and no room for one more
    LEVEL_WHITE,    ///< points anywhere, with estimated radii
    LEVEL_SLANTED,  ///< rows farther from each other than points within them
    LEVEL_SPHERE,   ///< points anywhere on a sphere, with estimated radii
    LEVEL_KINDS
} level_kind;

extern const char *const level_names[LEVEL_KINDS];

/// About `count` points on [-1, 1] x [-1, 1] x 0, or on the unit sphere, with normals, radii and colours.
ewa_cloud *level_cloud(ewa_context *context, level_kind kind, uint32_t count);

/// A camera that sees the surface from `distance`, along -z for a `tilt` of 0 degrees, towards the horizon for
/// 90.
ewa_camera level_camera(uint32_t width_px, uint32_t height_px, double distance, double tilt_deg);

/// Whether a pixel lies inside of the surface, `margin` world units away from its edge or silhouette.
bool level_inside(level_kind kind, const ewa_camera *camera, uint32_t x_px, uint32_t y_px, double margin);

#endif
