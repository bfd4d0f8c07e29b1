// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points and lines of the projective plane, and coordinates in a triangle.
//
// Based on: Bloomenthal and Rokne, Homogeneous Coordinates, sections Introduction (figure 1) and Homogeneous
// Lines.
#include "homogeneous/noise.h"

/// Join and meet are one operation: duality.
static ewa_status cross(ewa_vec3 a, ewa_vec3 b, ewa_vec3 *result) {
    if (!vec3_is_finite(a) || !vec3_is_finite(b)) return EWA_ERROR_NUMERIC;
    a = vec3_balance(a);
    b = vec3_balance(b);
    ewa_vec3 value = cross_signed(a, b, -1);
    if (vec3_is_noise(value, cross_signed(vec3_abs(a), vec3_abs(b), 1))) return EWA_ERROR_NUMERIC;
    *result = value;
    return EWA_OK;
}

ewa_status ewa_point2_divide(ewa_vec3 point, double xy[2]) {
    if (!xy) return EWA_ERROR_ARGUMENT;
    if (!vec3_is_finite(point) || point.z == 0) return EWA_ERROR_NUMERIC;
    double x = point.x / point.z, y = point.y / point.z;
    if (!isfinite(x) || !isfinite(y)) return EWA_ERROR_NUMERIC;
    xy[0] = x;
    xy[1] = y;
    return EWA_OK;
}

ewa_status ewa_line2_join(ewa_vec3 p, ewa_vec3 q, ewa_vec3 *line) {
    if (!line) return EWA_ERROR_ARGUMENT;
    return cross(p, q, line);
}

ewa_status ewa_line2_meet(ewa_vec3 k, ewa_vec3 l, ewa_vec3 *point) {
    if (!point) return EWA_ERROR_ARGUMENT;
    return cross(k, l, point);
}

double ewa_incidence2(ewa_vec3 point, ewa_vec3 line) { return vec3_dot(point, line); }

ewa_status ewa_line2_distance(ewa_vec3 line, ewa_vec3 point, double *distance) {
    if (!distance) return EWA_ERROR_ARGUMENT;
    if (!vec3_is_finite(line) || !vec3_is_finite(point)) return EWA_ERROR_NUMERIC;
    line = vec3_balance(line);
    point = vec3_balance(point);
    double scale = hypot(line.x, line.y) * point.z;
    if (scale == 0) return EWA_ERROR_NUMERIC;
    double value = vec3_dot(line, point) / scale;
    if (!isfinite(value)) return EWA_ERROR_NUMERIC;
    *distance = value;
    return EWA_OK;
}

/// A triangle made ready: corners with w = 1 relative to the first, which keeps small triangles far from the
/// origin exact, and the lines opposite to them, scaled so that their incidence product with their own corner
/// is 1.
typedef struct frame {
    ewa_vec3 origin;
    ewa_vec3 corner[3];
    ewa_vec3 edge[3];
} frame;

static ewa_status make_frame(const ewa_vec3 triangle[3], frame *f) {
    for (int i = 0; i < 3; i++) {
        double xy[2];
        ewa_status status = ewa_point2_divide(triangle[i], xy);
        if (status) return status;
        if (i == 0) f->origin = vec3_make(xy[0], xy[1], 0);
        f->corner[i] = vec3_sub(vec3_make(xy[0], xy[1], 1), f->origin);
    }
    ewa_vec3 a = f->corner[1], b = f->corner[2];
    double area = a.x * b.y - a.y * b.x;
    if (!isfinite(area) || is_noise(area, fabs(a.x * b.y) + fabs(a.y * b.x))) return EWA_ERROR_NUMERIC;
    for (int i = 0; i < 3; i++) {
        f->edge[i] = vec3_scale(vec3_cross(f->corner[(i + 1) % 3], f->corner[(i + 2) % 3]), 1 / area);
        if (!vec3_is_finite(f->edge[i])) return EWA_ERROR_NUMERIC;
    }
    return EWA_OK;
}

static ewa_status weigh(const frame *f, ewa_vec3 point, double weights[3]) {
    ewa_vec3 local = vec3_sub(point, vec3_scale(f->origin, point.z));
    ewa_vec3 result =
        vec3_make(vec3_dot(f->edge[0], local), vec3_dot(f->edge[1], local), vec3_dot(f->edge[2], local));
    if (!vec3_is_finite(result)) return EWA_ERROR_NUMERIC;
    weights[0] = result.x;
    weights[1] = result.y;
    weights[2] = result.z;
    return EWA_OK;
}

static ewa_status balance_weights(const frame *f, const double weights[3], ewa_vec3 *point) {
    ewa_vec3 sum = vec3_make(0, 0, 0);
    for (int i = 0; i < 3; i++) sum = vec3_add(sum, vec3_scale(f->corner[i], weights[i]));
    sum = vec3_add(sum, vec3_scale(f->origin, sum.z));
    if (!vec3_is_finite(sum)) return EWA_ERROR_NUMERIC;
    *point = sum;
    return EWA_OK;
}

/// One over the height of corner i over its opposite edge: what turns a distance into a weight.
static double inverse_height(const frame *f, int i) { return hypot(f->edge[i].x, f->edge[i].y); }

ewa_status ewa_triangle_barycentric(const ewa_vec3 triangle[3], ewa_vec3 point, double weights[3]) {
    if (!triangle || !weights) return EWA_ERROR_ARGUMENT;
    frame f;
    ewa_status status = make_frame(triangle, &f);
    return status ? status : weigh(&f, point, weights);
}

ewa_status ewa_triangle_point(const ewa_vec3 triangle[3], const double weights[3], ewa_vec3 *point) {
    if (!triangle || !weights || !point) return EWA_ERROR_ARGUMENT;
    frame f;
    ewa_status status = make_frame(triangle, &f);
    return status ? status : balance_weights(&f, weights, point);
}

ewa_status ewa_triangle_distances(const ewa_vec3 triangle[3], ewa_vec3 point, double distances[3]) {
    if (!triangle || !distances) return EWA_ERROR_ARGUMENT;
    frame f;
    double weights[3];
    ewa_status status = make_frame(triangle, &f);
    if (!status) status = weigh(&f, point, weights);
    if (status) return status;
    for (int i = 0; i < 3; i++) distances[i] = weights[i] / inverse_height(&f, i);
    return EWA_OK;
}

ewa_status ewa_triangle_point_from_distances(const ewa_vec3 triangle[3], const double distances[3],
                                             ewa_vec3 *point) {
    if (!triangle || !distances || !point) return EWA_ERROR_ARGUMENT;
    frame f;
    ewa_status status = make_frame(triangle, &f);
    if (status) return status;
    double weights[3];
    for (int i = 0; i < 3; i++) weights[i] = distances[i] * inverse_height(&f, i);
    return balance_weights(&f, weights, point);
}
