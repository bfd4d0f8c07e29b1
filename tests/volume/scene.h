// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes with known contents, cameras around them, pictures of them.
#ifndef EWA_TESTS_VOLUME_SCENE_H
#define EWA_TESTS_VOLUME_SCENE_H

#include "ewa/ewa.h"

/// A number for every place, in voxels from the volume's middle.
typedef double scene_field(const void *data, double x, double y, double z);

/// A float volume of a field, voxel by voxel; x, y, z are `spacing` times the distance from the middle in
/// voxels. index_to_world has that spacing. Ends the program where memory ends.
ewa_volume scene_volume(ewa_context *context, const uint32_t dims[3], const double spacing[3],
                        scene_field *field, const void *data);

/// Everywhere 1.
double scene_ones(const void *data, double x, double y, double z);

/// exp(-r^2 / (2 s^2)); data: s, a double.
double scene_blob(const void *data, double x, double y, double z);

/// 1 within a radius, 0 outside, one unit of transition; data: the radius, a double.
double scene_ball(const void *data, double x, double y, double z);

/// Branching tubes 0.6 units thick and more: 1 inside, 0 outside, with a transition of one unit; data: half
/// the side of the box that they fill, a double.
double scene_vessels(const void *data, double x, double y, double z);

/// Cells of `*data` units, alternately 1 and 2, within a box; data: side of a cell and of half the box,
/// doubles.
double scene_checker(const void *data, double x, double y, double z);

/// extinction = value * `extinction` per world unit for values in [0, 2], one colour.
ewa_transfer scene_linear(float red, float green, float blue, float extinction);

/// A perspective camera of 40 degrees that looks at the origin from `distance` along a direction.
ewa_camera scene_camera(uint32_t width_px, uint32_t height_px, const double direction[3], double distance);

/// An image that holds what a frame's rgba shows. Ends the program on failure, with the message's status.
ewa_image scene_draw(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                     const ewa_volume_options *options);
ewa_image scene_draw_reference(const ewa_volume *volume, const ewa_transfer *transfer,
                               const ewa_camera *camera, const ewa_volume_options *options);

/// The share of points in what a picture draws. Ends the program on failure.
double scene_point_share(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                         const ewa_volume_options *options);

/// Voxels with the default options. Ends the program on failure.
ewa_voxels *scene_voxels(const ewa_volume *volume, const ewa_transfer *transfer);

#endif
