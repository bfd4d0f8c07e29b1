// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes for tests of shading: a grey sphere, cameras that look at it, environments of known light.
#ifndef EWA_TESTS_SPLAT_SHADE_SCENE_H
#define EWA_TESTS_SPLAT_SHADE_SCENE_H

#include "homogeneous/vec.h"
#include "tests/splat/picture.h"

/// A sphere of radius 1 about the origin with one linear colour.
ewa_cloud *shade_sphere(ewa_context *context, uint64_t point_count, const float color[3]);

/// Gives every point of a cloud material `of(data, position)`.
void shade_set_material(ewa_cloud *cloud, int (*of)(const float position[3]));

/// A camera of `side_px` squared pixels at `eye_world`, looking at the origin with y up (z when y is along
/// the view); orthographic of a height, or perspective of a vertical angle when `ortho_height` is 0.
ewa_camera shade_camera(uint32_t side_px, const double eye_world[3], double fov_deg, double ortho_height);

/// The ray through the middle of a pixel: where it starts, and its unit direction.
void shade_ray(const ewa_camera *camera, uint32_t x, uint32_t y, ewa_vec3 *origin, ewa_vec3 *direction);

/// Where a ray first meets the unit sphere; false when it does not. The point is the normal.
bool shade_hit_sphere(ewa_vec3 origin, ewa_vec3 direction, ewa_vec3 *normal);

/// An environment of 2 height x height pixels whose light is `light(direction)`.
ewa_environment *shade_environment(ewa_context *context, uint32_t height,
                                   void (*light)(ewa_vec3 direction, float rgb[3]));

/// Light that is a linear function of the direction: (1 + x) / 2, (1 + y) / 2, (1 + z) / 2.
void shade_linear_light(ewa_vec3 direction, float rgb[3]);

/// Draws by the fast pipeline, twice, with a renderer of its own.
picture shade_draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                   const ewa_render_options *options);

/// Draws by the reference with the unit coverage that the surfels measure.
picture shade_reference(const ewa_cloud *cloud, const ewa_camera *camera, const ewa_render_options *options);

#endif
