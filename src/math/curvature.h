// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How much a surface bends, as one number.
//
// Based on: J. J. Koenderink, A. J. van Doorn, "Surface Shape and Curvature Scales", 1992 (curvedness).
#ifndef EWA_SRC_MATH_CURVATURE_H
#define EWA_SRC_MATH_CURVATURE_H

#include <math.h>

/// The curvedness of two principal curvatures with the sign of their sum, not beyond that: 0 where a saddle bends to
/// both sides alike.
static inline double ewa_signed_curvature(double k, double m) {
    return copysign(fmin(sqrt((k * k + m * m) / 2), fabs(k + m)), k + m);
}

#endif
