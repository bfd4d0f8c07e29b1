// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small scenes that tests, benchmarks and pictures share: a cloud, a camera, and what full coverage is.
#ifndef EWA_SCENES_SCENE_H
#define EWA_SCENES_SCENE_H

#include "ewa/ewa.h"

typedef enum scene_kind {
    SCENE_PLANE, ///< checkerboard plane to the horizon, from just above it
    SCENE_SPHERE,
    SCENE_TORUS,
    SCENE_CUBE,     ///< from near one corner: edges and strong perspective
    SCENE_ELLIPSES, ///< ellipses of all shapes and directions in a box, a tenth of them seen from the edge
    SCENE_NEAR,     ///< a floor and a wall of large discs through the eye plane, and ellipses around the eye
    SCENE_COUNT
} scene_kind;

typedef struct scene {
    ewa_cloud *cloud;
    ewa_camera camera;
    double unit_coverage; ///< q0 for the default cutoff: kernels' area per point of the surface
} scene;

/// Returns a word such as "plane".
const char *scene_name(scene_kind kind);

/// Makes a scene of about `point_count` >= 1 points for a picture of the given size, the same bytes on every
/// machine; the caller frees it with scene_free(). Everything is stored in single precision.
ewa_status scene_make(ewa_context *context, scene_kind kind, uint64_t point_count, uint32_t width_px,
                      uint32_t height_px, scene *made);

void scene_free(scene *made);

#endif
