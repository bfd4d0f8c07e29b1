// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Random bits, sine and cosine for test objects.
//
// Everything here is plain IEEE arithmetic, so that the bytes are the same on every machine.
#ifndef EWA_SRC_MATH_GENERATE_NUMBER_H
#define EWA_SRC_MATH_GENERATE_NUMBER_H

#include <math.h>
#include <stdint.h>

/// 64 random bits from a counter (finaliser of SplitMix64: Steele, Lea, Flood, "Fast Splittable Pseudorandom
/// Number Generators", 2014, figure 16).
static inline uint64_t ewa_generate_random(uint64_t key, uint64_t counter) {
    uint64_t z = key + (counter + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// Largest integer <= value, for |value| < 2^31; unlike floor() without SSE4.1, no call.
static inline int32_t ewa_generate_floor(double value) {
    const int32_t whole = (int32_t)value;
    return whole - (value < whole);
}

/// Sine and cosine of `turns` full turns, |turns| < 2^50, to 1e-14: exact reduction to half a turn, the
/// Taylor polynomials of half the angle, then the double angle. Without branches, so that loops over it
/// become vectors.
static inline void ewa_generate_sincos(double turns, double *sine, double *cosine) {
    const double round_bias = 0x1.8p52; // adding and taking it away rounds to the nearest integer
    const double x = 3.141592653589793 * (turns - ((turns + round_bias) - round_bias)), xx = x * x;
    const double s =
        x * (1 + xx * (-1.0 / 6 +
                       xx * (1.0 / 120 +
                             xx * (-1.0 / 5040 +
                                   xx * (1.0 / 362880 +
                                         xx * (-1.0 / 39916800 +
                                               xx * (1.0 / 6227020800 +
                                                     xx * (-1.0 / 1307674368000 +
                                                           xx * (1.0 / 355687428096000 +
                                                                 xx * (-1.0 / 121645100408832000))))))))));
    const double c =
        1 + xx * (-0.5 +
                  xx * (1.0 / 24 +
                        xx * (-1.0 / 720 +
                              xx * (1.0 / 40320 +
                                    xx * (-1.0 / 3628800 +
                                          xx * (1.0 / 479001600 +
                                                xx * (-1.0 / 87178291200 +
                                                      xx * (1.0 / 20922789888000 +
                                                            xx * (-1.0 / 6402373705728000 +
                                                                  xx * (1.0 / 2432902008176640000))))))))));
    *sine = 2 * s * c;
    *cosine = (c - s) * (c + s);
}

/// Sine of `turns` full turns, for colours: |turns| < 2^20, error below 1.2e-3: the parabola through the
/// sine's zeros and extremes, blended with its own square.
static inline float ewa_generate_sin(float turns) {
    const float round_bias = 0x1.8p23f;
    const float x = turns - ((turns + round_bias) - round_bias);
    const float parabola = 8 * x - 16 * x * fabsf(x);
    return parabola * (0.775f + 0.225f * fabsf(parabola));
}

#endif
