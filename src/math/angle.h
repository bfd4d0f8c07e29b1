// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The tangent without the C library, so that a field of view gives the same focal length on every machine.
// Based on: J. H. Lambert, Vorlaeufige Kenntnisse (1761), continued fraction of the tangent.
#ifndef EWA_SRC_MATH_ANGLE_H
#define EWA_SRC_MATH_ANGLE_H

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

#endif
