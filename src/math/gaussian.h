// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The exponential and the normal distribution without the C library, so that every machine gives the same
// bytes.
// Based on: J. F. Hart et al., "Computer Approximations", 1968 (reduction of the exponential); W. Marsaglia,
// "Evaluating the Normal Distribution", 2004 (the series).
#ifndef EWA_SRC_MATH_GAUSSIAN_H
#define EWA_SRC_MATH_GAUSSIAN_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/// exp(x) within 1e-15 relative for |x| <= 700; 0 below.
static inline double ewa_exp(double x) {
    if (!(x > -700)) return 0;
    const double whole = floor(x * 1.4426950408889634 + 0.5);
    const double rest = (x - whole * 0x1.62e42feep-1) - whole * 0x1.a39ef35793c76p-33;
    double series = 1.0 / 479001600;
    static const double factorials[12] = {
        1,         1,          1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,
        1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800};
    for (int k = 11; k >= 0; k--) series = factorials[k] + rest * series;
    const uint64_t bits = (uint64_t)(1023 + (int64_t)whole) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return series * power;
}

/// Density of the standard normal distribution.
static inline double ewa_normal_density(double z) { return 0.3989422804014327 * ewa_exp(-0.5 * z * z); }

/// Share of the standard normal distribution below z, within 1e-12 for |z| <= 6, 0 and 1 beyond.
static inline double ewa_normal_below(double z) {
    if (z < -6) return 0;
    if (z > 6) return 1;
    double term = z, sum = z;
    for (int odd = 3; odd < 120 && fabs(term) > 1e-17; odd += 2) {
        term *= z * z / odd;
        sum += term;
    }
    return 0.5 + sum * ewa_normal_density(z);
}

#endif
