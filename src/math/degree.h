// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lengths of a degree on the ellipsoid WGS 84.
// Based on: J. P. Snyder, "Map projections: a working manual", USGS Professional Paper 1395 (1987), equations 4-19 and
// 4-20.
#ifndef EWA_SRC_MATH_DEGREE_H
#define EWA_SRC_MATH_DEGREE_H

#include "math/angle.h"

/// Lengths of a degree to the east and to the north at a latitude in [-90, 90], metres.
static inline void ewa_degree_lengths(double latitude_deg, double length_m[2]) {
    static const double A_M = 6378137, E2 = 0.00669437999014, RAD_PER_DEG = EWA_PI / 180;
    double sine, cosine;
    ewa_sin_cos(fabs(latitude_deg) * RAD_PER_DEG, &sine, &cosine);
    const double w2 = 1 - E2 * sine * sine;
    length_m[0] = A_M / sqrt(w2) * cosine * RAD_PER_DEG;
    length_m[1] = A_M * (1 - E2) / (w2 * sqrt(w2)) * RAD_PER_DEG;
}

#endif
