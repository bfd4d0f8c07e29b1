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
    static const double terms[] = {-1.0 / 2,
                                   1.0 / 24,
                                   -1.0 / 720,
                                   1.0 / 40320,
                                   -1.0 / 3628800,
                                   1.0 / 479001600,
                                   -1.0 / 87178291200,
                                   1.0 / 20922789888000,
                                   -1.0 / 6402373705728000};
    double sum = terms[8];
    for (int i = 7; i >= 0; i--) sum = terms[i] + square * sum;
    return sign * (1 + square * sum);
}

#endif
