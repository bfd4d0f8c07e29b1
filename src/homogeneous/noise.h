// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// When is a computed zero a zero? Homogeneous things have no scale, so "small" means nothing; a sum of
// products is zero where it is not larger than its own rounding error, which is proportional to the sum of
// the products' magnitudes. Every formula of the room that can degenerate is therefore written once with a
// sign s for its subtractions: s = -1 gives the value, s = +1 on absolute arguments gives the magnitude.
#ifndef EWA_SRC_HOMOGENEOUS_NOISE_H
#define EWA_SRC_HOMOGENEOUS_NOISE_H

#include <float.h>

#include "homogeneous/vec.h"

/// Largest rounding error of the room's products of up to four factors, relative to their magnitude: they
/// take at most eight roundings of half a DBL_EPSILON, inputs that carry one each at most four more.
#define NOISE (8 * DBL_EPSILON)

/// Representatives whose largest number is beyond 2^+-BALANCED are scaled first, so that products of four
/// stay finite.
enum { BALANCED = 250 };

static inline bool is_noise(double value, double magnitude) { return fabs(value) <= NOISE * magnitude; }

static inline bool vec3_is_noise(ewa_vec3 value, ewa_vec3 magnitude) {
    return is_noise(value.x, magnitude.x) && is_noise(value.y, magnitude.y) && is_noise(value.z, magnitude.z);
}

static inline bool vec4_is_noise(ewa_vec4 value, ewa_vec4 magnitude) {
    return vec3_is_noise(vec3_from_vec4(value), vec3_from_vec4(magnitude)) && is_noise(value.w, magnitude.w);
}

static inline ewa_vec3 vec3_abs(ewa_vec3 v) { return vec3_make(fabs(v.x), fabs(v.y), fabs(v.z)); }
static inline ewa_vec4 vec4_abs(ewa_vec4 v) { return vec4_make(fabs(v.x), fabs(v.y), fabs(v.z), fabs(v.w)); }

/// The binary exponent that the numbers have to be divided by to become balanced; 0 for most.
static inline int balance_exponent(double largest) {
    int exponent = 0;
    if (largest > 0) frexp(largest, &exponent);
    return exponent > BALANCED || exponent < -BALANCED ? exponent : 0;
}

/// Another representative of the same thing, an exact power of two away, with numbers of moderate size.
static inline ewa_vec3 vec3_balance(ewa_vec3 v) {
    int exponent = balance_exponent(fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z)));
    if (!exponent) return v;
    return vec3_make(ldexp(v.x, -exponent), ldexp(v.y, -exponent), ldexp(v.z, -exponent));
}

static inline ewa_vec4 vec4_balance(ewa_vec4 v) {
    int exponent = balance_exponent(fmax(fmax(fabs(v.x), fabs(v.y)), fmax(fabs(v.z), fabs(v.w))));
    if (!exponent) return v;
    return vec4_make(ldexp(v.x, -exponent), ldexp(v.y, -exponent), ldexp(v.z, -exponent),
                     ldexp(v.w, -exponent));
}

/// a x b (s = -1) or its magnitude (s = +1, absolute arguments).
static inline ewa_vec3 cross_signed(ewa_vec3 a, ewa_vec3 b, double s) {
    return vec3_make(a.y * b.z + s * (a.z * b.y), a.z * b.x + s * (a.x * b.z), a.x * b.y + s * (a.y * b.x));
}

#endif
