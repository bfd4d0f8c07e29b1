// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Waves without the C library, in turns, so that every machine gives the same bytes and large arguments keep
// their phase.
#ifndef EWA_SRC_MATH_WAVE_H
#define EWA_SRC_MATH_WAVE_H

#include <math.h>

/// cos(2 pi turns), within 1e-13 of the value for the fraction that the argument has.
static inline double ewa_wave(double turns) {
    // cos(x) by Taylor's series on [-pi/2, pi/2], where 9 terms are enough; the other half by symmetry.
    double t = fabs(turns - floor(turns + 0.5));
    const double sign = t > 0.25 ? -1 : 1;
    if (t > 0.25) t = 0.5 - t;
    const double x = 6.283185307179586 * t, square = x * x;
    double sum = 1;
    for (int even = 20; even > 0; even -= 2) sum = 1 - square / ((even - 1) * even) * sum;
    return sign * sum;
}

#endif
