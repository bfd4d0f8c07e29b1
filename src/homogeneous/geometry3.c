// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points, planes and lines of projective space. A line through points p, q has direction pw q - qw p and
// moment p x q; the line on planes a, b is the same formula with direction and moment exchanged. Likewise
// "line and plane meet in a point" is "line and point join in a plane" on the exchanged line. So there are
// two formulas for six operations.
//
// Based on: Blinn, A Homogeneous Formulation for Lines in 3 Space, SIGGRAPH 1977; Bloomenthal and Rokne,
// Homogeneous Coordinates, section Homogeneous Lines (duality).
#include "homogeneous/noise.h"

static ewa_line3 exchange(ewa_line3 line) { return (ewa_line3){line.moment, line.direction}; }

static ewa_line3 line_abs(ewa_line3 line) {
    return (ewa_line3){vec3_abs(line.direction), vec3_abs(line.moment)};
}

static bool line_is_finite(ewa_line3 line) {
    return vec3_is_finite(line.direction) && vec3_is_finite(line.moment);
}

/// Two points to their line; two planes to the exchange of theirs (s: see noise.h).
static ewa_line3 combine_two(ewa_vec4 p, ewa_vec4 q, double s) {
    ewa_vec3 p3 = vec3_from_vec4(p), q3 = vec3_from_vec4(q);
    return (ewa_line3){vec3_add(vec3_scale(q3, p.w), vec3_scale(p3, s * q.w)), cross_signed(p3, q3, s)};
}

/// A line and a plane to their point; the exchange of a line and a point to their plane, of opposite sign.
static ewa_vec4 combine_line(ewa_line3 line, ewa_vec4 plane, double s) {
    ewa_vec3 n = vec3_from_vec4(plane);
    ewa_vec3 point = vec3_add(cross_signed(n, line.moment, s), vec3_scale(line.direction, s * plane.w));
    return vec4_from_vec3(point, vec3_dot(n, line.direction));
}

static ewa_line3 line_balance(ewa_line3 line) {
    ewa_vec3 a = vec3_abs(line.direction), b = vec3_abs(line.moment);
    int exponent = balance_exponent(fmax(fmax(fmax(a.x, a.y), a.z), fmax(fmax(b.x, b.y), b.z)));
    if (!exponent) return line;
    ewa_vec3 d = line.direction, m = line.moment;
    return (ewa_line3){vec3_make(ldexp(d.x, -exponent), ldexp(d.y, -exponent), ldexp(d.z, -exponent)),
                       vec3_make(ldexp(m.x, -exponent), ldexp(m.y, -exponent), ldexp(m.z, -exponent))};
}

static ewa_status two(ewa_vec4 p, ewa_vec4 q, ewa_line3 *line) {
    if (!vec4_is_finite(p) || !vec4_is_finite(q)) return EWA_ERROR_NUMERIC;
    p = vec4_balance(p);
    q = vec4_balance(q);
    ewa_line3 value = combine_two(p, q, -1), magnitude = combine_two(vec4_abs(p), vec4_abs(q), 1);
    if (vec3_is_noise(value.direction, magnitude.direction) && vec3_is_noise(value.moment, magnitude.moment))
        return EWA_ERROR_NUMERIC;
    *line = value;
    return EWA_OK;
}

static ewa_status line_and(ewa_line3 line, ewa_vec4 plane, ewa_vec4 *point) {
    if (!line_is_finite(line) || !vec4_is_finite(plane)) return EWA_ERROR_NUMERIC;
    line = line_balance(line);
    plane = vec4_balance(plane);
    ewa_vec4 value = combine_line(line, plane, -1);
    if (vec4_is_noise(value, combine_line(line_abs(line), vec4_abs(plane), 1))) return EWA_ERROR_NUMERIC;
    *point = value;
    return EWA_OK;
}

/// Three planes to their point; three points to their plane. The line between is not tested on its own: its
/// rounding error counts, so its magnitude is carried through.
static ewa_status three(ewa_vec4 a, ewa_vec4 b, ewa_vec4 c, ewa_vec4 *result) {
    if (!vec4_is_finite(a) || !vec4_is_finite(b) || !vec4_is_finite(c)) return EWA_ERROR_NUMERIC;
    a = vec4_balance(a);
    b = vec4_balance(b);
    c = vec4_balance(c);
    ewa_vec4 value = combine_line(exchange(combine_two(a, b, -1)), c, -1);
    ewa_line3 magnitude = exchange(combine_two(vec4_abs(a), vec4_abs(b), 1));
    if (vec4_is_noise(value, combine_line(magnitude, vec4_abs(c), 1))) return EWA_ERROR_NUMERIC;
    *result = value;
    return EWA_OK;
}

ewa_status ewa_point3_divide(ewa_vec4 point, double xyz[3]) {
    if (!xyz) return EWA_ERROR_ARGUMENT;
    if (!vec4_is_finite(point) || point.w == 0) return EWA_ERROR_NUMERIC;
    ewa_vec3 result = vec3_make(point.x / point.w, point.y / point.w, point.z / point.w);
    if (!vec3_is_finite(result)) return EWA_ERROR_NUMERIC;
    xyz[0] = result.x;
    xyz[1] = result.y;
    xyz[2] = result.z;
    return EWA_OK;
}

double ewa_incidence3(ewa_vec4 point, ewa_vec4 plane) { return vec4_dot(point, plane); }

ewa_status ewa_plane_join(ewa_vec4 p, ewa_vec4 q, ewa_vec4 r, ewa_vec4 *plane) {
    if (!plane) return EWA_ERROR_ARGUMENT;
    ewa_vec4 result;
    ewa_status status = three(p, q, r, &result);
    if (!status) *plane = vec4_scale(result, -1);
    return status;
}

ewa_status ewa_plane_meet(ewa_vec4 a, ewa_vec4 b, ewa_vec4 c, ewa_vec4 *point) {
    if (!point) return EWA_ERROR_ARGUMENT;
    return three(a, b, c, point);
}

ewa_status ewa_plane_distance(ewa_vec4 plane, ewa_vec4 point, double *distance) {
    if (!distance) return EWA_ERROR_ARGUMENT;
    if (!vec4_is_finite(plane) || !vec4_is_finite(point)) return EWA_ERROR_NUMERIC;
    plane = vec4_balance(plane);
    point = vec4_balance(point);
    double scale = hypot(hypot(plane.x, plane.y), plane.z) * point.w;
    if (scale == 0) return EWA_ERROR_NUMERIC;
    double value = vec4_dot(plane, point) / scale;
    if (!isfinite(value)) return EWA_ERROR_NUMERIC;
    *distance = value;
    return EWA_OK;
}

ewa_status ewa_line3_join(ewa_vec4 p, ewa_vec4 q, ewa_line3 *line) {
    if (!line) return EWA_ERROR_ARGUMENT;
    return two(p, q, line);
}

ewa_status ewa_line3_meet(ewa_vec4 a, ewa_vec4 b, ewa_line3 *line) {
    if (!line) return EWA_ERROR_ARGUMENT;
    ewa_line3 result;
    ewa_status status = two(a, b, &result);
    if (!status) *line = exchange(result);
    return status;
}

ewa_status ewa_line3_meet_plane(ewa_line3 line, ewa_vec4 plane, ewa_vec4 *point) {
    if (!point) return EWA_ERROR_ARGUMENT;
    return line_and(line, plane, point);
}

ewa_status ewa_line3_join_point(ewa_line3 line, ewa_vec4 point, ewa_vec4 *plane) {
    if (!plane) return EWA_ERROR_ARGUMENT;
    ewa_vec4 result;
    ewa_status status = line_and(exchange(line), point, &result);
    if (!status) *plane = vec4_scale(result, -1);
    return status;
}

double ewa_line3_incidence(ewa_line3 k, ewa_line3 l) {
    return vec3_dot(k.direction, l.moment) + vec3_dot(l.direction, k.moment);
}

ewa_line3 ewa_line3_transform(ewa_line3 line, const ewa_mat4 *map) {
    // A = p'q - q'p has the moment in its upper left 3x3 and the direction in its last row.
    ewa_vec3 d = line.direction, m = line.moment;
    ewa_vec4 rows[4] = {{0, m.z, -m.y, -d.x}, {-m.z, 0, m.x, -d.y}, {m.y, -m.x, 0, -d.z}, {d.x, d.y, d.z, 0}};
    double am[4][4]; // A M, then one entry of M' (A M) for each of the six numbers
    for (int i = 0; i < 4; i++) {
        ewa_vec4 row = vec4_mul_mat4(rows[i], map);
        am[i][0] = row.x;
        am[i][1] = row.y;
        am[i][2] = row.z;
        am[i][3] = row.w;
    }
    static const int entry[6][2] = {{3, 0}, {3, 1}, {3, 2}, {1, 2}, {2, 0}, {0, 1}};
    double result[6];
    for (int e = 0; e < 6; e++) {
        int row = entry[e][0], column = entry[e][1];
        result[e] = vec4_dot(mat4_column(map, row),
                             vec4_make(am[0][column], am[1][column], am[2][column], am[3][column]));
    }
    return (ewa_line3){vec3_load(result), vec3_load(result + 3)};
}
