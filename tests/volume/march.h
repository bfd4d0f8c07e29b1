// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The truth about a volume: rays marched in fine steps through the sum of all voxels' kernels, in double
// precision.
#ifndef EWA_TESTS_VOLUME_MARCH_H
#define EWA_TESTS_VOLUME_MARCH_H

#include "ewa/ewa.h"

/// A float volume with cubic voxels along the world's axes, under scene_linear()-like transfer functions.
typedef struct march_scene {
    const ewa_volume *volume;
    double extinction; ///< per unit of value and world unit
    double sigma;      ///< of the kernels, in voxels
    double step;       ///< in voxels
} march_scene;

/// The optical depth along the ray of a place on the screen.
double march_depth(const march_scene *scene, const ewa_camera *camera, double x_px, double y_px);

#endif
