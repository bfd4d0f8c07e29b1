// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What section planes leave of a pixel's ray (docs/math.md section 12).
#ifndef EWA_SRC_VOLUME_SECTION_H
#define EWA_SRC_VOLUME_SECTION_H

#include "ewa/camera.h"
#include "ewa/render.h"

/// Section planes for rays.
typedef struct ewa_ray_sections {
    uint32_t count;
    bool orthographic;
    double fx_px, fy_px, cx_px, cy_px;
    double planes[EWA_MAX_SECTION_PLANES][4]; ///< camera space
} ewa_ray_sections;

/// Planes and camera are checked ones.
void ewa_ray_sections_make(ewa_ray_sections *sections, const ewa_camera *camera, const double planes[][4],
                           uint32_t count);

/// From which to which camera-space depth the ray through a place in the picture is within all planes; `*enter` is
/// -infinity and `*leave` +infinity where none cuts it, and `*enter` > `*leave` where nothing is left.
void ewa_ray_sections_range(const ewa_ray_sections *sections, double x_px, double y_px, double *enter,
                            double *leave);

#endif
