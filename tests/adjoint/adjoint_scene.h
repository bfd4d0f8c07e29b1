// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes for tests of gradients: a few surfels of random numbers in several surfaces, before a camera that is not
// centred.
#ifndef EWA_TESTS_ADJOINT_SCENE_H
#define EWA_TESTS_ADJOINT_SCENE_H

#include "check.h"

enum { ADJOINT_MAX_POINTS = 4096 };

/// What a scene has beside discs under a headlight.
typedef enum adjoint_kind {
    ADJOINT_PLAIN = 0,
    ADJOINT_ELLIPSES = 1, ///< axes that are not orthogonal
    ADJOINT_TRANSPARENT = 2,
    ADJOINT_ORTHOGRAPHIC = 4,
    ADJOINT_AFFINE = 8,
    ADJOINT_CLIPPED = 16,    ///< some with clip lines, with ADJOINT_ELLIPSES
    ADJOINT_BILLBOARDS = 32, ///< a third are of no surface
    ADJOINT_LIGHTS = 64,     ///< two coloured lights, one of them at the eye
    ADJOINT_HARD = 128,      ///< no antialiasing
    ADJOINT_SECTION = 256,   ///< cut by a plane
    ADJOINT_UNLIT = 512,
    ADJOINT_NEAR = 1024, ///< the eye is amid them
    ADJOINT_EDGES = 2048, ///< small surfels: most of the picture is edges
    ADJOINT_MERGED = 4096, ///< all behind the first surface is one layer
    ADJOINT_CURVED = 8192, ///< of known curvature, many of them at contours
} adjoint_kind;

/// The numbers of a scene, in attributes of a cloud that borrows them.
typedef struct adjoint_scene {
    uint32_t count, kind;
    double position[3 * ADJOINT_MAX_POINTS], normal[3 * ADJOINT_MAX_POINTS], radius[ADJOINT_MAX_POINTS];
    double tangent_u[3 * ADJOINT_MAX_POINTS], tangent_v[3 * ADJOINT_MAX_POINTS], color[4 * ADJOINT_MAX_POINTS];
    double clip[3 * ADJOINT_MAX_POINTS], surfaceness[ADJOINT_MAX_POINTS], curvature[ADJOINT_MAX_POINTS];
    ewa_cloud *cloud;
    ewa_camera camera;
    ewa_render_options options;
    double unit_coverage;
} adjoint_scene;

/// Makes a scene of `count` surfels of about `radius_px` pixels in a picture of so many pixels a side. Its cloud is to
/// be destroyed.
adjoint_scene *adjoint_scene_make(ewa_context *context, uint32_t kind, uint32_t count, uint32_t side_px,
                                  double radius_px, uint64_t seed);
void adjoint_scene_free(adjoint_scene **scene);

#endif
