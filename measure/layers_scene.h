// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transparent surfaces that cross, and what others do with them, for measuring layers.
#ifndef EWA_TESTS_QUALITY_LAYERS_SCENE_H
#define EWA_TESTS_QUALITY_LAYERS_SCENE_H

#include "ewa/ewa.h"

/// Like figure 7 of "Surface Splatting": three tori through each other and a sphere through all of them, with
/// a colour each and light in the colours, so that no rule shades differently. Rays meet up to fourteen
/// surfaces. One object after the other; the caller owns `*cloud`.
ewa_status layers_crossing_make(ewa_context *context, uint64_t points_per_object, ewa_cloud **cloud);

/// A sphere in one colour. The caller owns `*cloud`.
ewa_status layers_sphere_make(ewa_context *context, uint64_t point_count, ewa_cloud **cloud);

/// A camera that shows a cloud whole.
ewa_status layers_camera_make(const ewa_cloud *cloud, uint32_t side_px, ewa_camera *camera);

/// The same points in a seeded random order. The caller owns `*shuffled`.
ewa_status layers_shuffle(const ewa_cloud *cloud, ewa_cloud **shuffled);

/// What renderers of splats do that know no surfaces: splats in the order of their centres, far ones first,
/// each blended over what is there with alpha = opacity exp(-r^2 / 2). `rgba` as for abuffer_render().
ewa_status layers_blend_splats(const ewa_cloud *cloud, const ewa_camera *camera, double opacity, float *rgba);

/// Alpha in the middle of a square picture of a sphere, out to a fifth of its side.
typedef struct layers_alpha {
    double mean, variance, minimum, maximum;
} layers_alpha;

layers_alpha layers_measure_alpha(const float *rgba, uint32_t side_px);

#endif
