// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Small vectors and matrices in double precision, inline, for every room above. Row vectors: x' = x M,
// docs/math.md section 0. Total functions: infinities and NaN pass through but for vec3_normalize().
#ifndef EWA_SRC_HOMOGENEOUS_VEC_H
#define EWA_SRC_HOMOGENEOUS_VEC_H

#include <math.h>

#include "ewa/homogeneous.h"

static inline ewa_vec3 vec3_make(double x, double y, double z) { return (ewa_vec3){x, y, z}; }
static inline ewa_vec3 vec3_load(const double v[3]) { return (ewa_vec3){v[0], v[1], v[2]}; }
static inline ewa_vec3 vec3_add(ewa_vec3 a, ewa_vec3 b) { return vec3_make(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline ewa_vec3 vec3_sub(ewa_vec3 a, ewa_vec3 b) { return vec3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline ewa_vec3 vec3_scale(ewa_vec3 a, double s) { return vec3_make(a.x * s, a.y * s, a.z * s); }
static inline double vec3_dot(ewa_vec3 a, ewa_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline double vec3_length(ewa_vec3 a) { return sqrt(vec3_dot(a, a)); }

/// The same where squares might leave the range of doubles.
static inline double vec3_length_scaled(ewa_vec3 a) {
    const double largest = fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
    if (!(largest > 0) || isinf(largest)) return largest;
    return largest * vec3_length(vec3_make(a.x / largest, a.y / largest, a.z / largest));
}

static inline ewa_vec3 vec3_cross(ewa_vec3 a, ewa_vec3 b) {
    return vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline bool vec3_is_finite(ewa_vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }

static inline void vec3_store(ewa_vec3 a, double v[3]) { v[0] = a.x, v[1] = a.y, v[2] = a.z; }

/// Scales to length 1 by way of the largest component, so that tiny and huge vectors keep their direction;
/// false for zero and for what is not finite.
static inline bool vec3_normalize(ewa_vec3 *v) {
    const double largest = fmax(fabs(v->x), fmax(fabs(v->y), fabs(v->z)));
    if (!(largest > 0) || !vec3_is_finite(*v)) return false;
    // A division, because 1 / largest may overflow.
    *v = vec3_make(v->x / largest, v->y / largest, v->z / largest);
    *v = vec3_scale(*v, 1 / vec3_length(*v));
    return true;
}

static inline ewa_vec4 vec4_make(double x, double y, double z, double w) { return (ewa_vec4){x, y, z, w}; }
static inline ewa_vec4 vec4_from_vec3(ewa_vec3 v, double w) { return vec4_make(v.x, v.y, v.z, w); }
static inline ewa_vec3 vec3_from_vec4(ewa_vec4 v) { return vec3_make(v.x, v.y, v.z); }
static inline ewa_vec4 vec4_scale(ewa_vec4 a, double s) {
    return vec4_make(a.x * s, a.y * s, a.z * s, a.w * s);
}

static inline ewa_vec4 vec4_add(ewa_vec4 a, ewa_vec4 b) {
    return vec4_make(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w);
}

static inline double vec4_dot(ewa_vec4 a, ewa_vec4 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
static inline bool vec4_is_finite(ewa_vec4 a) { return vec3_is_finite(vec3_from_vec4(a)) && isfinite(a.w); }

static inline ewa_mat3 mat3_from_rows(ewa_vec3 a, ewa_vec3 b, ewa_vec3 c) {
    return (ewa_mat3){{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
}

static inline ewa_vec3 mat3_row(const ewa_mat3 *a, int row) { return vec3_load(a->m[row]); }

static inline ewa_vec3 mat3_column(const ewa_mat3 *a, int column) {
    return vec3_make(a->m[0][column], a->m[1][column], a->m[2][column]);
}

static inline ewa_mat3 mat3_identity(void) { return (ewa_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }

/// v M, a row vector through a map.
static inline ewa_vec3 vec3_mul_mat3(ewa_vec3 v, const ewa_mat3 *a) {
    return vec3_make(v.x * a->m[0][0] + v.y * a->m[1][0] + v.z * a->m[2][0],
                     v.x * a->m[0][1] + v.y * a->m[1][1] + v.z * a->m[2][1],
                     v.x * a->m[0][2] + v.y * a->m[1][2] + v.z * a->m[2][2]);
}

/// M v', a column vector; for lines this goes from the image back to the source.
static inline ewa_vec3 mat3_mul_vec3(const ewa_mat3 *a, ewa_vec3 v) {
    return vec3_make(vec3_dot(mat3_row(a, 0), v), vec3_dot(mat3_row(a, 1), v), vec3_dot(mat3_row(a, 2), v));
}

/// A B: first A, then B.
static inline ewa_mat3 mat3_multiply(const ewa_mat3 *a, const ewa_mat3 *b) {
    return mat3_from_rows(vec3_mul_mat3(mat3_row(a, 0), b), vec3_mul_mat3(mat3_row(a, 1), b),
                          vec3_mul_mat3(mat3_row(a, 2), b));
}

static inline ewa_mat3 mat3_transpose(const ewa_mat3 *a) {
    return mat3_from_rows(mat3_column(a, 0), mat3_column(a, 1), mat3_column(a, 2));
}

static inline ewa_mat3 mat3_add(const ewa_mat3 *a, const ewa_mat3 *b) {
    return mat3_from_rows(vec3_add(mat3_row(a, 0), mat3_row(b, 0)), vec3_add(mat3_row(a, 1), mat3_row(b, 1)),
                          vec3_add(mat3_row(a, 2), mat3_row(b, 2)));
}

static inline ewa_mat3 mat3_scale(const ewa_mat3 *a, double s) {
    return mat3_from_rows(vec3_scale(mat3_row(a, 0), s), vec3_scale(mat3_row(a, 1), s),
                          vec3_scale(mat3_row(a, 2), s));
}

/// a'b, the outer product of two row vectors.
static inline ewa_mat3 mat3_outer(ewa_vec3 a, ewa_vec3 b) {
    return mat3_from_rows(vec3_scale(b, a.x), vec3_scale(b, a.y), vec3_scale(b, a.z));
}

static inline double mat3_determinant(const ewa_mat3 *a) {
    return vec3_dot(mat3_row(a, 0), vec3_cross(mat3_row(a, 1), mat3_row(a, 2)));
}

/// adj(M) = det(M) M^-1, without dividing; serves in place of the inverse where scale and sign do not matter.
static inline ewa_mat3 mat3_adjugate(const ewa_mat3 *a) {
    ewa_mat3 rows =
        mat3_from_rows(vec3_cross(mat3_row(a, 1), mat3_row(a, 2)), vec3_cross(mat3_row(a, 2), mat3_row(a, 0)),
                       vec3_cross(mat3_row(a, 0), mat3_row(a, 1)));
    return mat3_transpose(&rows);
}

static inline ewa_vec4 mat4_row(const ewa_mat4 *a, int row) {
    return vec4_make(a->m[row][0], a->m[row][1], a->m[row][2], a->m[row][3]);
}

static inline ewa_vec4 mat4_column(const ewa_mat4 *a, int column) {
    return vec4_make(a->m[0][column], a->m[1][column], a->m[2][column], a->m[3][column]);
}

static inline ewa_mat4 mat4_from_rows(ewa_vec4 a, ewa_vec4 b, ewa_vec4 c, ewa_vec4 d) {
    return (ewa_mat4){
        {{a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}, {c.x, c.y, c.z, c.w}, {d.x, d.y, d.z, d.w}}};
}

/// v M, a row vector through a map.
static inline ewa_vec4 vec4_mul_mat4(ewa_vec4 v, const ewa_mat4 *a) {
    return vec4_make(vec4_dot(v, mat4_column(a, 0)), vec4_dot(v, mat4_column(a, 1)),
                     vec4_dot(v, mat4_column(a, 2)), vec4_dot(v, mat4_column(a, 3)));
}

/// M v', a column vector; for planes this goes from the image back to the source.
static inline ewa_vec4 mat4_mul_vec4(const ewa_mat4 *a, ewa_vec4 v) {
    return vec4_make(vec4_dot(mat4_row(a, 0), v), vec4_dot(mat4_row(a, 1), v), vec4_dot(mat4_row(a, 2), v),
                     vec4_dot(mat4_row(a, 3), v));
}

static inline ewa_mat3 mat3_from_conic(const ewa_conic *q) {
    return (ewa_mat3){{{q->xx, q->xy, q->xw}, {q->xy, q->yy, q->yw}, {q->xw, q->yw, q->ww}}};
}

/// The upper triangle of a matrix that is symmetric but for rounding.
static inline ewa_conic conic_from_mat3(const ewa_mat3 *a) {
    return (ewa_conic){a->m[0][0], a->m[0][1], a->m[0][2], a->m[1][1], a->m[1][2], a->m[2][2]};
}

#endif
