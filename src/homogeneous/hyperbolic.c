// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Interpolation of attributes over projected polygons and segments.
//
// A point of the polygon is a sum of its corners, p = b V with V the rows [x y w] of three of them; on the
// screen p ~ [sx sy 1], so b ~ [sx sy 1] V^-1. An attribute u is b u' / b 1': a quotient of two linear
// functions, with the coefficients V^-1 u' and V^-1 1'. The scale of the inverse cancels, the adjugate
// serves: no w is divided by.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, section Associated Vertex Transformations;
// Heckbert, Fundamentals of Texture Mapping and Image Warping, 1989 (rational linear); Blinn, Hyperbolic
// Interpolation, 1992.
#include "homogeneous/noise.h"

ewa_status ewa_hyperbolic_fit(const ewa_vec4 corners[3], const double *values, uint32_t count,
                              ewa_vec3 *numerators, ewa_vec3 *denominator) {
    if (!corners || !values || !numerators || !denominator) return EWA_ERROR_ARGUMENT;
    ewa_vec3 v[3];
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        v[i] = vec3_make(corners[i].x, corners[i].y, corners[i].w);
        if (!vec3_is_finite(v[i])) return EWA_ERROR_NUMERIC;
        largest = fmax(largest, fmax(fabs(v[i].x), fmax(fabs(v[i].y), fabs(v[i].z))));
    }
    for (size_t i = 0; i < 3 * (size_t)count; i++)
        if (!isfinite(values[i])) return EWA_ERROR_NUMERIC;
    int exponent = balance_exponent(largest);
    for (int i = 0; i < 3; i++)
        v[i] = vec3_make(ldexp(v[i].x, -exponent), ldexp(v[i].y, -exponent), ldexp(v[i].z, -exponent));
    ewa_vec3 magnitude = cross_signed(vec3_abs(v[1]), vec3_abs(v[2]), 1);
    if (is_noise(vec3_dot(v[0], vec3_cross(v[1], v[2])), vec3_dot(vec3_abs(v[0]), magnitude)))
        return EWA_ERROR_NUMERIC;
    ewa_mat3 rows = mat3_from_rows(v[0], v[1], v[2]), adjugate = mat3_adjugate(&rows);
    for (uint32_t i = 0; i < count; i++)
        numerators[i] =
            mat3_mul_vec3(&adjugate, vec3_make(values[i], values[count + i], values[2 * (size_t)count + i]));
    *denominator = mat3_mul_vec3(&adjugate, vec3_make(1, 1, 1));
    return EWA_OK;
}

ewa_status ewa_hyperbolic_at(ewa_vec3 numerator, ewa_vec3 denominator, double screen_x, double screen_y,
                             double *value) {
    if (!value) return EWA_ERROR_ARGUMENT;
    ewa_vec3 place = vec3_make(screen_x, screen_y, 1);
    double divisor = vec3_dot(denominator, place);
    if (is_noise(divisor, vec3_dot(vec3_abs(denominator), vec3_abs(place)))) return EWA_ERROR_NUMERIC;
    double result = vec3_dot(numerator, place) / divisor;
    if (!isfinite(result)) return EWA_ERROR_NUMERIC;
    *value = result;
    return EWA_OK;
}

ewa_status ewa_hyperbolic_alpha(double w1, double w2, double t, double *alpha) {
    if (!alpha) return EWA_ERROR_ARGUMENT;
    double a = (1 - t) * w2, b = t * w1;
    if (is_noise(a + b, fabs(a) + fabs(b))) return EWA_ERROR_NUMERIC;
    double result = b / (a + b);
    if (!isfinite(result)) return EWA_ERROR_NUMERIC;
    *alpha = result;
    return EWA_OK;
}
