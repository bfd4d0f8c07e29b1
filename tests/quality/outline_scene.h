// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shapes whose coverage of every pixel is known from their closed form, and how far a picture's alpha is off
// along their outlines.
#ifndef EWA_TESTS_QUALITY_OUTLINE_SCENE_H
#define EWA_TESTS_QUALITY_OUTLINE_SCENE_H

#include "check.h"

#include <stdbool.h>

enum { OUTLINE_SIDE_PX = 256 };

typedef enum outline_shape {
    OUTLINE_SPHERE, ///< of radius 1
    OUTLINE_TORUS,  ///< around z: tubes of radius 0.3 around a circle of radius 0.7
    OUTLINE_DISC,   ///< z = 0, of radius 1
    OUTLINE_SQUARE, ///< z = 0, from -1 to 1
    OUTLINE_HILLS,  ///< z = sin(4x) cos(3y) / 4, from -1 to 1
} outline_shape;

/// Share of each pixel that the shape covers.
typedef struct outline_truth {
    float coverage[OUTLINE_SIDE_PX][OUTLINE_SIDE_PX];
    double length_px; ///< of the outlines
} outline_truth;

/// What a picture's alpha is, beside the truth.
typedef struct outline_errors {
    double fat_px;   ///< what alpha covers too much, per pixel of outline
    double rms;      ///< of alpha - truth where the truth is neither 0 nor 1
    double open;     ///< share of the pixels at least 2 px inside whose alpha is below 0.999
    double deepest;  ///< the largest 1 - alpha there
    double strewn;   ///< share of the pixels at least 3 px outside whose alpha is above 0.001
} outline_errors;

/// A camera that looks at the origin from `eye`, so that the shape fills most of the picture.
void outline_camera(const double eye_world[3], double fov_deg, ewa_camera *camera);

void outline_trace(ewa_context *context, outline_shape shape, const ewa_camera *camera, outline_truth *truth);

/// `alpha` has `stride` floats from pixel to pixel.
outline_errors outline_compare(const outline_truth *truth, const float *alpha, int stride);

/// Random points on the shape, evenly strewn, those of hills without voids, with nothing but their places. The caller owns the cloud.
ewa_cloud *outline_points(ewa_context *context, outline_shape shape, uint64_t point_count);

#endif
