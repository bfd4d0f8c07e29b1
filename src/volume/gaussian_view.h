// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of Gaussians: options that came from outside, and camera and options in double precision.
#ifndef EWA_SRC_VOLUME_GAUSSIAN_VIEW_H
#define EWA_SRC_VOLUME_GAUSSIAN_VIEW_H

#include "ewa/gaussian_render.h"
#include "homogeneous/vec.h"
#include "volume/kernels.h"

/// Perspective: Gaussians whose centres are nearer than that many of their depth half ranges are drawn ray by
/// ray.
#define EWA_GAUSSIAN_NEAR 1.05

/// No Gaussian takes more of the light (3DGS).
#define EWA_GAUSSIAN_MAX_ALPHA 0.99

/// The variance of the dot that a trained 2D Gaussian covers at least, over that of the filter: 0.5 px^2 by 0.3 (2DGS).
#define EWA_GAUSSIAN_DOT (5.0 / 3)

/// How many standard deviations of it the middle of a trained 2D Gaussian's dot is the middle of (2DGS).
#define EWA_GAUSSIAN_DOT_CUTOFF 3

/// What the filter leaves of a Gaussian's height is at least the root of that (Mip-Splatting).
#define EWA_GAUSSIAN_MIN_KEPT 2.5e-5

/// Camera space in units of the splats, and what else a frame's Gaussians share.
typedef struct ewa_gaussian_camera {
    bool orthographic, trained, by_center, keep;
    double fx_px, fy_px, cx_px, cy_px; ///< orthographic: pixels per unit
    double unit_camera;                ///< a unit in camera space, as depth planes have it
    ewa_mat3 turn;                     ///< column vectors of the world to camera space, a rotation
    ewa_vec3 origin;                   ///< that of the splats in camera space
    ewa_vec3 eye;                      ///< perspective: from the splats' origin, units, world axes
    ewa_vec3 forward;                  ///< world axes
    double slopes[4];                  ///< where the affine map's Jacobian is held: left, right, top, bottom
    double near;                       ///< of centres, 0: none; orthographic: -infinity
} ewa_gaussian_camera;

/// Copies `given` (NULL: the defaults) to `chosen` after checking every member. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_gaussian_options_choose(ewa_context *context, const ewa_gaussian_options *given,
                                       ewa_gaussian_options *chosen);

/// All arguments are checked ones.
void ewa_gaussian_camera_make(ewa_gaussian_camera *made, const ewa_camera *camera,
                              const ewa_gaussian_options *options, bool antialiased, double unit_world,
                              const double origin_world[3]);

#endif
