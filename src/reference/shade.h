// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shading in double precision, one pixel after another: the definition of what src/surface/pipeline_shade.h
// and pipeline_eye_dome.h compute (docs/math.md section 7; semantics.h, shading and eye-dome lighting).
#ifndef EWA_SRC_REFERENCE_SHADE_H
#define EWA_SRC_REFERENCE_SHADE_H

#include "reference/sums.h"
#include "surface/shading.h"

/// What a pixel shows of one surface.
typedef struct ewa_reference_surface {
    bool there;            ///< else nothing below is set
    ewa_vec3 color;        ///< straight
    ewa_vec3 normal_world; ///< unit, or shorter where the normals of the pixel cancel
    ewa_vec3 view_world;   ///< unit, towards the eye
    double ambient, diffuse, specular, shininess, reflection;
} ewa_reference_surface;

/// Returns what a pixel with its centre at x_px, y_px shows of the sums of a surface.
ewa_reference_surface ewa_reference_surface_of(const ewa_reference_view *view, const ewa_reference_sums *sums,
                                               double x_px, double y_px);

/// Returns the straight colour that is seen. `beside` and `below` are the surfaces in the other column and
/// the other row of the pixel's aligned 2x2 pixels.
ewa_vec3 ewa_reference_shade(const ewa_shading_setup *setup, const ewa_environment *environment,
                             const ewa_reference_surface *at, const ewa_reference_surface *beside,
                             const ewa_reference_surface *below);

/// Returns the environment's light from a direction of the environment, filtered over a footprint.
ewa_vec3 ewa_reference_environment(const ewa_environment *environment, ewa_vec3 direction, double footprint);

/// A depth plane for eye-dome lighting.
typedef struct ewa_reference_depths {
    uint32_t width_px, height_px;
    bool orthographic;
    double view_height_world;                        ///< orthographic only
    double (*depth)(const void *data, size_t index); ///< +infinity: nothing
    const void *data;
} ewa_reference_depths;

/// Returns the share of light that eye-dome lighting of a strength leaves to a pixel.
double ewa_reference_eye_dome(const ewa_reference_depths *depths, double strength, uint32_t x, uint32_t y);

#endif
