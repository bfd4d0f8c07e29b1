// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ray-traced truth of the cube and the part of ewa_cloud_generate(), from their closed form.
#ifndef EWA_TESTS_QUALITY_SOLID_SCENE_H
#define EWA_TESTS_QUALITY_SOLID_SCENE_H

#include "check.h"

#include <stdbool.h>

#include "generate/solid.h"

/// Where a ray first meets the solid of edge (length) 2.
typedef struct solid_hit {
    bool any;
    double place_world[3], normal[3];
    int surface; ///< equal for places of one plane or one wall
} solid_hit;

solid_hit solid_trace(const ewa_solid_shape *shape, const double eye_world[3], const double ray[3]);

/// The hit behind a place of the picture.
solid_hit solid_trace_px(const ewa_solid_shape *shape, const ewa_camera *camera, double x_px, double y_px);

/// What surfaces are coloured by: linear, from the normal.
void solid_color(const double normal[3], float color[3]);

/// Replaces the colours of a cloud by those of solid_color().
void solid_color_cloud(ewa_cloud *cloud);

/// Marks pixels within `reach_px` of a change of surface, or of the solid's silhouette.
void solid_mark_edges(const ewa_solid_shape *shape, const ewa_camera *camera, int reach_px, uint8_t *mask);

/// Renders the solid with `side` x `side` rays per pixel: premultiplied linear RGBA.
void solid_picture(const ewa_solid_shape *shape, const ewa_camera *camera, int side, float *rgba);

#endif
