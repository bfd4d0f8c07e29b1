// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians for tests, and pictures of them.
#ifndef EWA_TESTS_GAUSSIAN_SCENE_H
#define EWA_TESTS_GAUSSIAN_SCENE_H

#include "check.h"

#include "ewa/gaussian_render.h"
#include "reference/gaussian.h"

/// `count` Gaussians in a ball of radius 1, of many shapes, sizes and opacities, with harmonics.
ewa_gaussians gaussians_random(ewa_context *context, uint32_t count, uint32_t sh_degree, uint64_t seed);

/// One at `center` of one colour, which is a display value.
ewa_gaussians gaussians_one(ewa_context *context, const double center[3], const double scales[3],
                            const double rotation[4], double opacity, const double color[3]);

/// A perspective camera at `distance` along a direction that looks at the origin.
ewa_camera gaussians_camera(uint32_t width_px, uint32_t height_px, double fov_deg, const double direction[3],
                            double distance);

/// The picture's rgba; the caller frees it. `stats` may be NULL.
ewa_image gaussians_draw(const ewa_gaussians *set, const ewa_camera *camera,
                         const ewa_gaussian_options *options, ewa_gaussian_stats *stats);
ewa_image gaussians_draw_reference(const ewa_gaussians *set, const ewa_camera *camera,
                                   const ewa_gaussian_options *options);

/// Decibels between two pictures: of display values, over what they have behind them.
double gaussians_decibels(const ewa_image *a, const ewa_image *b);

#endif
