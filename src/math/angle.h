// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Trigonometry without the C library, so that fields of view, orbits and paths give the same camera on every
// machine.
// Based on: J. H. Lambert, Vorlaeufige Kenntnisse (1761), continued fraction of the tangent.
#ifndef EWA_SRC_MATH_ANGLE_H
#define EWA_SRC_MATH_ANGLE_H

#include <math.h>

#define EWA_PI 3.14159265358979323846

/// tan(angle) for an angle in [0, pi/4]: z / (1 - z^2 / (3 - z^2 / (5 - ...))), 11 levels, within 2 units in
/// the last place.
static inline double ewa_tan_octant(double angle_rad) {
    const double square = angle_rad * angle_rad;
    double denominator = 21;
    for (int odd = 19; odd > 0; odd -= 2) denominator = odd - square / denominator;
    return angle_rad / denominator;
}

/// tan(angle) for an angle in [0, pi/2).
static inline double ewa_tan(double angle_rad) {
    return angle_rad <= EWA_PI / 4 ? ewa_tan_octant(angle_rad) : 1 / ewa_tan_octant(EWA_PI / 2 - angle_rad);
}

/// Sine and cosine of an angle in [0, pi], by the tangent of its half.
static inline void ewa_sin_cos(double angle_rad, double *sine, double *cosine) {
    const double acute = angle_rad <= EWA_PI / 2 ? angle_rad : EWA_PI - angle_rad;
    const double t = ewa_tan_octant(0.5 * acute), scale = 1 / (1 + t * t);
    *sine = 2 * t * scale;
    *cosine = (angle_rad <= EWA_PI / 2 ? 1 - t * t : t * t - 1) * scale;
}

/// atan(slope) for a slope >= 0, infinity included: four halvings of the angle, then Taylor's series. Within
/// 4 units in the last place.
static inline double ewa_atan(double slope) {
    if (slope > 1) return EWA_PI / 2 - ewa_atan(1 / slope);
    for (int i = 0; i < 4; i++) slope /= 1 + sqrt(1 + slope * slope);
    const double square = slope * slope;
    double sum = 0;
    for (int odd = 15; odd > 0; odd -= 2) sum = 1.0 / odd - square * sum;
    return 16 * slope * sum;
}

#endif
