// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Products and inverses of maps, and what maps do to points, lines and planes.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, sections Transformations and Sequences.
#include "homogeneous/noise.h"

ewa_mat3 ewa_mat3_concatenate(const ewa_mat3 *first, const ewa_mat3 *second) {
    return mat3_multiply(first, second);
}

ewa_mat4 ewa_mat4_concatenate(const ewa_mat4 *first, const ewa_mat4 *second) {
    return mat4_from_rows(
        vec4_mul_mat4(mat4_row(first, 0), second), vec4_mul_mat4(mat4_row(first, 1), second),
        vec4_mul_mat4(mat4_row(first, 2), second), vec4_mul_mat4(mat4_row(first, 3), second));
}

/// The six 2x2 minors of two rows, in the order of columns 01 02 03 12 13 23 (s: see noise.h).
static void minors(const double a[4], const double b[4], double s, double result[6]) {
    int count = 0;
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 4; j++) result[count++] = a[i] * b[j] + s * (a[j] * b[i]);
}

/// Laplace expansion over the minors of the upper and the lower two rows.
static double determinant(const double upper[6], const double lower[6], double s) {
    return upper[0] * lower[5] + s * (upper[1] * lower[4]) + upper[2] * lower[3] + upper[3] * lower[2] +
           s * (upper[4] * lower[1]) + upper[5] * lower[0];
}

/// Divides each row (or each column) by the power of two of its largest number; false when one is zero.
static bool equilibrate(double m[4][4], bool rows, int exponent[4]) {
    for (int i = 0; i < 4; i++) {
        double largest = 0;
        for (int j = 0; j < 4; j++) largest = fmax(largest, fabs(rows ? m[i][j] : m[j][i]));
        if (largest == 0) return false;
        frexp(largest, &exponent[i]);
        for (int j = 0; j < 4; j++) {
            double *number = rows ? &m[i][j] : &m[j][i];
            *number = ldexp(*number, -exponent[i]);
        }
    }
    return true;
}

ewa_status ewa_mat4_invert(const ewa_mat4 *map, ewa_mat4 *inverse) {
    if (!map || !inverse) return EWA_ERROR_ARGUMENT;
    for (int i = 0; i < 4; i++)
        if (!vec4_is_finite(mat4_row(map, i))) return EWA_ERROR_NUMERIC;
    ewa_mat4 scaled = *map, magnitude;
    int row_exponent[4], column_exponent[4];
    if (!equilibrate(scaled.m, true, row_exponent) || !equilibrate(scaled.m, false, column_exponent))
        return EWA_ERROR_NUMERIC;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) magnitude.m[i][j] = fabs(scaled.m[i][j]);

    double u[6], l[6], u_magnitude[6], l_magnitude[6];
    const double(*m)[4] = (const double(*)[4])scaled.m;
    minors(m[0], m[1], -1, u);
    minors(m[2], m[3], -1, l);
    minors(magnitude.m[0], magnitude.m[1], 1, u_magnitude);
    minors(magnitude.m[2], magnitude.m[3], 1, l_magnitude);
    double det = determinant(u, l, -1);
    if (is_noise(det, determinant(u_magnitude, l_magnitude, 1))) return EWA_ERROR_NUMERIC;

    double adjugate[4][4] = {
        {m[1][1] * l[5] - m[1][2] * l[4] + m[1][3] * l[3], -m[0][1] * l[5] + m[0][2] * l[4] - m[0][3] * l[3],
         m[3][1] * u[5] - m[3][2] * u[4] + m[3][3] * u[3], -m[2][1] * u[5] + m[2][2] * u[4] - m[2][3] * u[3]},
        {-m[1][0] * l[5] + m[1][2] * l[2] - m[1][3] * l[1], m[0][0] * l[5] - m[0][2] * l[2] + m[0][3] * l[1],
         -m[3][0] * u[5] + m[3][2] * u[2] - m[3][3] * u[1], m[2][0] * u[5] - m[2][2] * u[2] + m[2][3] * u[1]},
        {m[1][0] * l[4] - m[1][1] * l[2] + m[1][3] * l[0], -m[0][0] * l[4] + m[0][1] * l[2] - m[0][3] * l[0],
         m[3][0] * u[4] - m[3][1] * u[2] + m[3][3] * u[0], -m[2][0] * u[4] + m[2][1] * u[2] - m[2][3] * u[0]},
        {-m[1][0] * l[3] + m[1][1] * l[1] - m[1][2] * l[0], m[0][0] * l[3] - m[0][1] * l[1] + m[0][2] * l[0],
         -m[3][0] * u[3] + m[3][1] * u[1] - m[3][2] * u[0],
         m[2][0] * u[3] - m[2][1] * u[1] + m[2][2] * u[0]}};
    ewa_mat4 result;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            result.m[i][j] = ldexp(adjugate[i][j] / det, -row_exponent[j] - column_exponent[i]);
            if (!isfinite(result.m[i][j])) return EWA_ERROR_NUMERIC;
        }
    *inverse = result;
    return EWA_OK;
}

ewa_status ewa_mat3_invert(const ewa_mat3 *map, ewa_mat3 *inverse) {
    if (!map || !inverse) return EWA_ERROR_ARGUMENT;
    ewa_mat4 wide = mat4_from_rows(vec4_from_vec3(mat3_row(map, 0), 0), vec4_from_vec3(mat3_row(map, 1), 0),
                                   vec4_from_vec3(mat3_row(map, 2), 0), vec4_make(0, 0, 0, 1));
    ewa_status status = ewa_mat4_invert(&wide, &wide);
    if (!status)
        *inverse = mat3_from_rows(vec3_from_vec4(mat4_row(&wide, 0)), vec3_from_vec4(mat4_row(&wide, 1)),
                                  vec3_from_vec4(mat4_row(&wide, 2)));
    return status;
}

ewa_vec3 ewa_point2_transform(ewa_vec3 point, const ewa_mat3 *map) { return vec3_mul_mat3(point, map); }

ewa_vec4 ewa_point3_transform(ewa_vec4 point, const ewa_mat4 *map) { return vec4_mul_mat4(point, map); }

ewa_vec3 ewa_line2_pull(ewa_vec3 image_line, const ewa_mat3 *map) { return mat3_mul_vec3(map, image_line); }

ewa_vec4 ewa_plane_pull(ewa_vec4 image_plane, const ewa_mat4 *map) { return mat4_mul_vec4(map, image_plane); }

ewa_status ewa_line2_transform(ewa_vec3 line, const ewa_mat3 *map, ewa_vec3 *image_line) {
    if (!map || !image_line) return EWA_ERROR_ARGUMENT;
    ewa_mat3 inverse;
    ewa_status status = vec3_is_finite(line) ? ewa_mat3_invert(map, &inverse) : EWA_ERROR_NUMERIC;
    if (!status) *image_line = ewa_line2_pull(line, &inverse);
    return status;
}

ewa_status ewa_plane_transform(ewa_vec4 plane, const ewa_mat4 *map, ewa_vec4 *image_plane) {
    if (!map || !image_plane) return EWA_ERROR_ARGUMENT;
    ewa_mat4 inverse;
    ewa_status status = vec4_is_finite(plane) ? ewa_mat4_invert(map, &inverse) : EWA_ERROR_NUMERIC;
    if (!status) *image_plane = ewa_plane_pull(plane, &inverse);
    return status;
}
