// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The paper's own transparency, to measure the library's against: nothing that ewa_render() does depends on
// it.
#ifndef EWA_TESTS_SPLAT_ABUFFER_H
#define EWA_TESTS_SPLAT_ABUFFER_H

#include "homogeneous/vec.h"

#include "ewa/render.h"

/// Shades a fragment: the light that a surface of a straight colour and a unit normal (zero: undefined) sends
/// to the eye through a point of the picture.
typedef ewa_vec3 abuffer_shader(const void *data, ewa_vec3 color, ewa_vec3 normal_world, double x_px,
                                double y_px);

/// Draws a cloud with `fragment_limit` >= 1 fragments per pixel, each point as it comes (SS section 6): the
/// picture depends on the order of the points. Of `options` (not NULL), kernel, prefilter, tolerance, edge
/// antialiasing, opacity and culling count. `unit_coverage` is q0, as for ewa_render_reference(). `shader`
/// NULL: colours as they are. `rgba`: 4 numbers for each of the camera's pixels, linear, premultiplied.
/// Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
ewa_status abuffer_render(const ewa_cloud *cloud, double unit_coverage, const ewa_camera *camera,
                          const ewa_render_options *options, uint32_t fragment_limit, abuffer_shader *shader,
                          const void *shader_data, float *rgba);

#endif
