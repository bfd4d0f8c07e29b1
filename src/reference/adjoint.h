// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The derivative of a picture of surfels, in double precision, with the forward side that differences of pictures hold
// it by (docs/math.md section 15).
#ifndef EWA_SRC_REFERENCE_ADJOINT_H
#define EWA_SRC_REFERENCE_ADJOINT_H

#include "reference/adjoint_splat.h"

/// Which surfels count at which pixels, on which surface, and what clip lines leave of them: what derivatives hold
/// fixed.
typedef struct ewa_reference_sets ewa_reference_sets;

/// Finds the sets of a picture as ewa_render_reference() draws it. Errors: those of
/// ewa_reference_frame_make(), EWA_ERROR_MEMORY.
ewa_status ewa_reference_sets_create(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                     double unit_coverage, const ewa_camera *camera, const ewa_render_options *options,
                                     ewa_reference_sets **sets);
void ewa_reference_sets_destroy(ewa_reference_sets **sets);

/// Draws at these sets another cloud, with as many points and attributes of the same shape, before another camera.
/// values: [pixel]; depths in units of the camera. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
ewa_status ewa_reference_sets_draw(const ewa_reference_sets *sets, const ewa_cloud *cloud, const ewa_camera *camera,
                                   ewa_reference_values *values);

/// Takes the cotangents of such a picture to those of the cloud and the camera. cotangent: [pixel], of depths in units
/// of the camera; points: [point]; of what is not drawn 0. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_MEMORY.
ewa_status ewa_reference_sets_pull_back(const ewa_reference_sets *sets, const ewa_cloud *cloud,
                                        const ewa_camera *camera, const ewa_reference_values *cotangent,
                                        ewa_reference_point_cotangent *points, double numbers[EWA_CAMERA_NUMBERS]);

#endif
