// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A Gaussian whose thresholded alpha is a disc with an antialiased rim (docs/math.md section 9).
//
// With edge antialiasing alpha(r) = min(1, exp((a^2 - r^2) / (2 s^2))): 1 up to the radius a, then falling.
// Its integral over the plane is pi a^2 + 2 pi s^2, which is the disc's area pi R^2 for a^2 = R^2 - 2 s^2.
// About the rim alpha falls by R / (2 s^2) per pixel: by one for s^2 = R / 2.
#include "surface/points.h"
#include "surface/options.h"

#include <math.h>

static const double TWO_PI = 6.283185307179586;
// Standard deviations in the radius at most: beyond, single precision would not hold the threshold.
static const double MAX_SIGMAS = 4;
// Alpha with which a rim ends: a quarter of a step of 8 bits.
static const double MIN_ALPHA = 1.0 / 1024;

ewa_point_profile ewa_point_profile_make(const ewa_render_options *options) {
    const double radius = options->point_size_px / 2, radius2 = radius * radius;
    // A disc below two pixels has no plateau.
    const double variance = fmax(fmin(radius / 2, radius2 / 2), radius2 / (MAX_SIGMAS * MAX_SIGMAS));
    const double plateau = (radius2 - 2 * variance) / variance; // a^2 / s^2
    const bool soft = options->edge_antialiasing && options->passes == 3;
    return (ewa_point_profile){
        .sigma_px = sqrt(variance),
        .cutoff = sqrt(soft ? plateau - 2 * log(MIN_ALPHA) : radius2 / variance),
        .unit_coverage = exp(-0.5 * plateau) / (TWO_PI * options->edge_threshold),
    };
}
