// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What section planes leave of a pixel's ray, for the references of Gaussians and volumes (docs/math.md section 12).
#ifndef EWA_SRC_REFERENCE_SECTION_H
#define EWA_SRC_REFERENCE_SECTION_H

#include "ewa/camera.h"

/// From which to which camera-space depth the ray through a place in the picture is within all of `count` planes,
/// which are in world space; `*enter` > `*leave` where nothing is left.
void ewa_reference_cut_ray(const ewa_camera *camera, const double planes[][4], uint32_t count, double x_px,
                           double y_px, double *enter, double *leave);

#endif
