// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sRGB curve in floating point, without pow(), whose last bits differ between C libraries.
// Based on: IEC 61966-2-1:1999, section 5.2 (piecewise curve).
#include "image/srgb.h"

#include <math.h>

/// The n-th root (n = 3 or 5) of x in [1e-9, 1]. The exponent divided by n is within 7 % of it; each Newton
/// step squares the relative error times (n - 1) / 2, so that five steps exceed double precision.
static double root(double x, uint32_t n) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t one = 0x3ff0000000000000u;
    bits = bits / n + one / n * (n - 1);
    double y;
    memcpy(&y, &bits, sizeof y);
    for (int step = 0; step < 6; step++) {
        const double power = n == 3 ? y * y : y * y * (y * y);
        y += (x / power - y) / n;
    }
    return y;
}

double ewa_srgb_encode(double linear) {
    if (linear <= 0.0031308) return 12.92 * linear;
    return 1.055 * root(linear * sqrt(sqrt(linear)), 3) - 0.055; // x^(1/2.4) = (x^(5/4))^(1/3)
}

double ewa_srgb_decode(double srgb) {
    if (srgb <= 0.04045) return srgb / 12.92;
    const double base = (srgb + 0.055) / 1.055;
    return base * base * root(base * base, 5); // x^2.4 = x^2 (x^2)^(1/5)
}

float ewa_srgb_from_linear(float linear) {
    return linear > 0.0f ? (float)ewa_srgb_encode(linear < 1.0f ? linear : 1.0f) : 0.0f;
}

float ewa_linear_from_srgb(float srgb) {
    return srgb > 0.0f ? (float)ewa_srgb_decode(srgb < 1.0f ? srgb : 1.0f) : 0.0f;
}
