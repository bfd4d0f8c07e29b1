// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Conics, their duals, and the ellipse of a dual conic.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, section Homogeneous Coordinates for the
// Projective Plane (a conic is a form of degree two in x, y, w); docs/math.md sections 1 and 3 (PAS section
// 4).
#include "homogeneous/noise.h"

/// M S M' of a symmetric S, symmetric by construction.
static ewa_conic congruence(const ewa_mat3 *map, const ewa_conic *conic) {
    ewa_mat3 s = mat3_from_conic(conic), transpose = mat3_transpose(map);
    ewa_mat3 left = mat3_multiply(map, &s), product = mat3_multiply(&left, &transpose);
    return conic_from_mat3(&product);
}

double ewa_conic_value(const ewa_conic *conic, ewa_vec3 point) {
    return vec3_dot(ewa_conic_polar(conic, point), point);
}

ewa_vec3 ewa_conic_polar(const ewa_conic *conic, ewa_vec3 point) {
    ewa_mat3 q = mat3_from_conic(conic);
    return vec3_mul_mat3(point, &q);
}

ewa_conic ewa_conic_dual(const ewa_conic *conic) {
    ewa_mat3 q = mat3_from_conic(conic), adjugate = mat3_adjugate(&q);
    return conic_from_mat3(&adjugate);
}

ewa_conic ewa_conic_pull(const ewa_conic *image_conic, const ewa_mat3 *map) {
    return congruence(map, image_conic);
}

ewa_conic ewa_dual_conic_transform(const ewa_conic *dual, const ewa_mat3 *map) {
    ewa_mat3 transpose = mat3_transpose(map);
    return congruence(&transpose, dual);
}

ewa_status ewa_conic_transform(const ewa_conic *conic, const ewa_mat3 *map, ewa_conic *image_conic) {
    if (!conic || !map || !image_conic) return EWA_ERROR_ARGUMENT;
    ewa_mat3 inverse;
    ewa_status status = ewa_mat3_invert(map, &inverse);
    if (status) return status;
    ewa_conic result = congruence(&inverse, conic);
    ewa_mat3 numbers = mat3_from_conic(&result);
    for (int i = 0; i < 3; i++)
        if (!vec3_is_finite(mat3_row(&numbers, i))) return EWA_ERROR_NUMERIC;
    *image_conic = result;
    return EWA_OK;
}

ewa_status ewa_dual_conic_ellipse(const ewa_conic *dual, double center[2], double shape[3]) {
    if (!dual || !center || !shape) return EWA_ERROR_ARGUMENT;
    if (!(fabs(dual->ww) > 0)) return EWA_ERROR_NUMERIC;
    double cx = dual->xw / dual->ww, cy = dual->yw / dual->ww;
    double dxx = dual->xx / dual->ww, dxy = dual->xy / dual->ww, dyy = dual->yy / dual->ww;
    double xx = cx * cx - dxx, xy = cx * cy - dxy, yy = cy * cy - dyy;
    double xx_error = NOISE * (cx * cx + fabs(dxx)), yy_error = NOISE * (cy * cy + fabs(dyy));
    double xy_error = NOISE * (fabs(cx * cy) + fabs(dxy));
    double det = xx * yy - xy * xy;
    double det_error =
        xx_error * (fabs(yy) + yy_error) + yy_error * fabs(xx) + xy_error * (2 * fabs(xy) + xy_error);
    // A disc seen edge-on is a segment: its shape is singular, and rounding may make it slightly indefinite.
    if (!isfinite(det) || xx < -xx_error || yy < -yy_error || det < -det_error) return EWA_ERROR_NUMERIC;
    center[0] = cx;
    center[1] = cy;
    shape[0] = fmax(xx, 0);
    shape[1] = xy;
    shape[2] = fmax(yy, 0);
    return EWA_OK;
}
