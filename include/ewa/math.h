// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Homogeneous coordinates (math.md section 1).
#ifndef EWA_MATH_H
#define EWA_MATH_H

#include "ewa/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Three numbers: a vector (x, y, z), a point of the plane [x y w] with z as its w, or a line of the plane
/// (a, b, c) with a x + b y + c w = 0.
typedef struct ewa_vec3 {
    double x, y, z;
} ewa_vec3;

/// Four numbers: a point of space [x y z w], or a plane (a, b, c, d) with a x + b y + c z + d w = 0.
typedef struct ewa_vec4 {
    double x, y, z, w;
} ewa_vec4;

/// A map of the plane, x' = x M for a row vector x: m[row][column].
typedef struct ewa_mat3 {
    double m[3][3];
} ewa_mat3;

/// A map of space, x' = x M for a row vector x: m[row][column].
typedef struct ewa_mat4 {
    double m[4][4];
} ewa_mat4;

#ifdef __cplusplus
}
#endif
#endif
