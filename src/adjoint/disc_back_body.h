// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of discs_body.h: from the sums of one disc back to its point and the camera. Reference: src/reference/adjoint_splat.c;
// docs/math.md section 15, surfel, contours, world and camera.
#ifndef EWA_SRC_ADJOINT_DISC_BACK_BODY_H
#define EWA_SRC_ADJOINT_DISC_BACK_BODY_H

#include "adjoint/disc_project_body.h"

/// The sums of a disc.
typedef struct disc_moments {
    ewa_vec3 normal;
    double s0, s1[2], s2[3], depth[3];
} disc_moments;

/// Cotangents in camera space.
typedef struct disc_cotangent {
    ewa_vec3 center, u, v, normal;
    double focal_x, focal_y, principal_x, principal_y;
} disc_cotangent;

/// As ewa_adjoint_power_of(), of what is not as small as the smallest numbers.
LANE double power_of(double size) {
    uint64_t bits;
    __builtin_memcpy(&bits, &size, sizeof bits);
    bits &= UINT64_C(0x7ff) << 52;
    double power;
    __builtin_memcpy(&power, &bits, sizeof power);
    return ((size > 0) & (size < __builtin_inf())) ? power : 1;
}

/// Whole numbers of units to sums: ewa_adjoint_scales().
LANE disc_moments load_moments(const ewa_disc_view *view, const disc_splat *s, const ewa_disc_cotangents *from, int i, double unit,
                               double depth_unit) {
    const double determinant = s->q11 * s->q22 - s->q12 * s->q12;
    const double x = 1 / power_of(__builtin_sqrt(s->q22 / determinant)), y = 1 / power_of(__builtin_sqrt(s->q11 / determinant));
    const double depth = depth_unit / (view->flat ? 1 : power_of(s->center.z));
    const double(*sums)[EWA_DISC_LANES] = from->sums;
    return (disc_moments){
        .normal = {sums[EWA_MOMENT_NORMAL][i] / unit, sums[EWA_MOMENT_NORMAL + 1][i] / unit, sums[EWA_MOMENT_NORMAL + 2][i] / unit},
        .s0 = sums[EWA_MOMENT_WEIGHT][i] / unit,
        .s1 = {sums[EWA_MOMENT_FIRST][i] / (unit * x), sums[EWA_MOMENT_FIRST + 1][i] / (unit * y)},
        .s2 = {sums[EWA_MOMENT_SECOND][i] / (unit * (x * x)), sums[EWA_MOMENT_SECOND + 1][i] / (unit * (x * y)),
               sums[EWA_MOMENT_SECOND + 2][i] / (unit * (y * y))},
        .depth = {sums[EWA_MOMENT_DEPTH][i] / (depth * x), sums[EWA_MOMENT_DEPTH + 1][i] / (depth * y),
                  sums[EWA_MOMENT_DEPTH + 2][i] / depth}};
}

LANE void axis_pull_back(const ewa_disc_view *view, ewa_vec3 t, double x, double y, double x0, double y0, double by_x, double by_y,
                         const double by_e[2], double by_s33, ewa_vec3 *to) {
    to->x += view->fx_px * by_x;
    to->y += view->fy_px * by_y;
    to->z += by_e[0] * x + by_e[1] * y + 2 * by_s33 * t.z - view->fx_px * x0 * by_x - view->fy_px * y0 * by_y;
}

LANE void ellipse_pull_back(const ewa_disc_view *view, const disc_splat *s, const disc_moments *m, disc_cotangent *to) {
    const ewa_vec3 p = s->center, u = s->u, v = s->v;
    const double q0 = s->q11, q1 = s->q12, q2 = s->q22, s0 = m->s0, *s1 = m->s1, *s2 = m->s2;
    const double center[2] = {q0 * s1[0] + q1 * s1[1], q1 * s1[0] + q2 * s1[1]};
    const double a00 = q0 * s2[0] + q1 * s2[1], a01 = q0 * s2[1] + q1 * s2[2], a10 = q1 * s2[0] + q2 * s2[1],
                 a11 = q1 * s2[1] + q2 * s2[2];
    const double v11 = (a00 * q0 + a01 * q1 - s0 * q0) / 2, v12 = (a00 * q1 + a01 * q2 - s0 * q1) / 2,
                 v22 = (a10 * q1 + a11 * q2 - s0 * q2) / 2;
    const bool flat = view->flat;
    const double fx = view->fx_px, fy = view->fy_px, x0 = flat ? 0 : p.x / p.z, y0 = flat ? 0 : p.y / p.z, F2 = view->cutoff2;
    const double ux = fx * (u.x - x0 * u.z), uy = fy * (u.y - y0 * u.z), vx = fx * (v.x - x0 * v.z), vy = fy * (v.y - y0 * v.z);
    const double s11 = ux * ux + vx * vx, s12 = ux * uy + vx * vy, s22 = uy * uy + vy * vy;
    const double e0 = ux * u.z + vx * v.z, e1 = uy * u.z + vy * v.z, s33 = u.z * u.z + v.z * v.z;
    const double k = flat ? 1 : 1 / (p.z * p.z - F2 * s33);
    const double along[2] = {v11 * e0 + v12 * e1, v12 * e0 + v22 * e1};
    const double of_k = -F2 * (center[0] * e0 + center[1] * e1) + 2 * F2 * k * (along[0] * e0 + along[1] * e1) + v11 * s11 +
                        2 * v12 * s12 + v22 * s22 + 1.5 * s0 / k;
    const double by_k = flat ? 0 : of_k, by_s33 = k * k * F2 * by_k;
    const double by_e[2] = {F2 * k * (2 * k * along[0] - center[0]), F2 * k * (2 * k * along[1] - center[1])};
    const double by_ux = 2 * k * (v11 * ux + v12 * uy) + u.z * by_e[0], by_uy = 2 * k * (v12 * ux + v22 * uy) + u.z * by_e[1];
    const double by_vx = 2 * k * (v11 * vx + v12 * vy) + v.z * by_e[0], by_vy = 2 * k * (v12 * vx + v22 * vy) + v.z * by_e[1];
    axis_pull_back(view, u, ux, uy, x0, y0, by_ux, by_uy, by_e, by_s33, &to->u);
    axis_pull_back(view, v, vx, vy, x0, y0, by_vx, by_vy, by_e, by_s33, &to->v);
    to->focal_x += by_ux * ux / fx + by_vx * vx / fx;
    to->focal_y += by_uy * uy / fy + by_vy * vy / fy;
    // |V| by way of |M|.
    const ewa_vec3 across = vec3_cross(u, v), way = {flat ? 0 : p.x, flat ? 0 : p.y, flat ? 1 : p.z};
    const double share = s0 / vec3_dot(across, way);
    to->u = vec3_add(to->u, vec3_scale(vec3_cross(v, way), share));
    to->v = vec3_add(to->v, vec3_scale(vec3_cross(way, u), share));
    to->focal_x += s0 / fx + center[0] * (flat ? p.x : x0);
    to->focal_y += s0 / fy + center[1] * (flat ? p.y : y0);
    to->principal_x += center[0], to->principal_y += center[1];
    const double by_x0 = fx * center[0] - fx * (u.z * by_ux + v.z * by_vx), by_y0 = fy * center[1] - fy * (u.z * by_uy + v.z * by_vy);
    const double inverse = flat ? 1 : 1 / p.z;
    to->center.x += flat ? fx * center[0] : across.x * share + by_x0 * inverse;
    to->center.y += flat ? fy * center[1] : across.y * share + by_y0 * inverse;
    to->center.z += flat ? 0 : across.z * share - (by_x0 * x0 + by_y0 * y0) * inverse - 2 * k * k * p.z * by_k;
}

LANE void way_pull_back(const ewa_disc_view *view, const disc_splat *s, const disc_moments *m, double curvature, disc_cotangent *to) {
    const bool flat = view->flat, moves = s->moves;
    const ewa_vec3 p = s->center, n = s->normal;
    const double fx = view->fx_px, fy = view->fy_px, depth = flat ? 1 : p.z, sine = flat ? n.z : vec3_dot(n, p) / p.z;
    const double by_way[2] = {s->q11 * m->s1[0] + s->q12 * m->s1[1], s->q12 * m->s1[0] + s->q22 * m->s1[1]};
    const double bend = 2 * size_of(curvature) / view->scale * depth / fx, length_u = length_of(s->u), length_v = length_of(s->v);
    const bool v_is_longer = length_v > length_u;
    const double longer = v_is_longer ? length_v : length_u, sigma_px = fx * longer / depth, wide_px = EWA_CONTOUR_WIDTH * sigma_px * sine;
    const double across = __builtin_sqrt(view->prefilter_px * view->prefilter_px + wide_px * wide_px);
    const double free_reach = EWA_CONTOUR_REACH * across * bend, reach = smaller(free_reach, view->contour_sine2);
    const double x = -n.x / fx, y = -n.y / fy, length = __builtin_sqrt(x * x + y * y), inward = 1 - sine * sine / reach;
    const double along = (s->moved_x * x + s->moved_y * y) / length;
    const double shift = along < 0 ? -view->contour_shift : view->contour_shift;
    const double by_along = (by_way[0] * x + by_way[1] * y) / length;
    const double by_x = along * (by_way[0] - by_along * x / length) / length, by_y = along * (by_way[1] - by_along * y / length) / length;
    const double by_inward = shift * across * by_along, by_reach = reach < view->contour_sine2 ? sine * sine / (reach * reach) * by_inward : 0;
    const double by_across = shift * inward * by_along + EWA_CONTOUR_REACH * bend * by_reach;
    const double by_bend = EWA_CONTOUR_REACH * across * by_reach, width2 = EWA_CONTOUR_WIDTH * EWA_CONTOUR_WIDTH / across * by_across;
    const double by_sigma = width2 * sigma_px * sine * sine;
    const double by_sine = -2 * sine / reach * by_inward + width2 * sigma_px * sigma_px * sine;
    const double by_axis = moves ? by_sigma * fx / depth / longer : 0, by_lean = moves ? by_sine * (flat ? 1 : 1 / p.z) : 0;
    to->u = vec3_add(to->u, vec3_scale(s->u, v_is_longer ? 0 : by_axis));
    to->v = vec3_add(to->v, vec3_scale(s->v, v_is_longer ? by_axis : 0));
    to->normal.x += (moves ? -by_x / fx : 0) + (flat ? 0 : p.x * by_lean);
    to->normal.y += (moves ? -by_y / fy : 0) + (flat ? 0 : p.y * by_lean);
    to->normal.z += flat ? by_lean : p.z * by_lean;
    to->focal_x += moves ? (by_sigma * sigma_px - by_bend * bend - by_x * x) / fx : 0;
    to->focal_y -= moves ? by_y * y / fy : 0;
    const double perspective = flat ? 0 : by_lean;
    to->center = vec3_add(to->center, vec3_scale(n, perspective));
    to->center.z += (moves & !flat) ? (by_bend * bend - by_sigma * sigma_px - by_sine * sine) / p.z : 0;
}

LANE void depth_pull_back(const ewa_disc_view *view, const disc_splat *s, const disc_moments *m, disc_cotangent *to) {
    const bool flat = view->flat;
    const ewa_vec3 p = s->center, n = s->normal;
    const double fx = view->fx_px, fy = view->fy_px, inverse = flat ? 1 : 1 / p.z, sum = m->depth[2];
    const double x_px = fx * p.x * inverse + view->cx_px, y_px = fy * p.y * inverse + view->cy_px;
    const double by_a = m->depth[0] + sum * (s->center_x - x_px), by_b = m->depth[1] + sum * (s->center_y - y_px);
    const double facing = flat ? n.z : vec3_dot(n, p), minimum = EWA_EDGE_ON * (flat ? 1 : length_of(p));
    const double a = s->plane.x, b = s->plane.y;
    const bool raised = size_of(facing) < minimum;
    const double divisor = (raised ? (facing < 0 ? -minimum : minimum) : facing) * (flat ? -1 : 1);
    to->normal.x += by_a / (divisor * fx);
    to->normal.y += by_b / (divisor * fy);
    to->focal_x -= by_a * a / fx + sum * a * p.x * inverse;
    to->focal_y -= by_b * b / fy + sum * b * p.y * inverse;
    to->principal_x -= sum * a, to->principal_y -= sum * b;
    to->center.x -= sum * a * fx * inverse;
    to->center.y -= sum * b * fy * inverse;
    to->center.z += flat ? sum : sum * inverse * inverse * (a * fx * p.x + b * fy * p.y - 1);
    const double by_divisor = raised ? 0 : -(by_a * a + by_b * b) / divisor, perspective = flat ? 0 : by_divisor;
    to->normal = vec3_add(to->normal, vec3_scale(p, perspective));
    to->normal.z -= flat ? by_divisor : 0;
    to->center = vec3_add(to->center, vec3_scale(n, perspective));
}

LANE void store_lane(double to[3][EWA_DISC_LANES], int i, ewa_vec3 v) { to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z; }

/// To world space, where a disc's axes turn with its normal, and to the camera.
LANE void store_point(const ewa_disc_view *view, const disc_surfel *from, const disc_splat *s, const disc_moments *m,
                      const disc_cotangent *by, ewa_disc_cotangents *to, int i) {
    const ewa_mat3 *linear = &view->linear;
    const double unit = view->flat ? view->unit : 1;
    const ewa_vec3 turn = vec3_add(vec3_add(vec3_cross(s->center, by->center), vec3_cross(s->u, by->u)),
                                   vec3_add(vec3_cross(s->v, by->v), vec3_cross(s->normal, by->normal)));
    const double camera[EWA_CAMERA_NUMBERS] = {turn.x, turn.y, turn.z, by->center.x / view->unit, by->center.y / view->unit,
                                               by->center.z / view->unit, by->focal_x * unit, by->focal_y * unit,
                                               by->principal_x, by->principal_y};
    for (int c = 0; c < EWA_CAMERA_NUMBERS; c++) to->camera[c][i] = camera[c];
    store_lane(to->position, i, vec3_mul_mat3(by->center, linear));
    const ewa_vec3 by_u = vec3_mul_mat3(by->u, linear), by_v = vec3_mul_mat3(by->v, linear), n = from->normal;
    to->radius[i] = (vec3_dot(by_u, from->axis_u) + vec3_dot(by_v, from->axis_v)) / length_of(from->axis_u) * view->sigma_per_radius;
    const ewa_vec3 by_depth = vec3_scale(vec3_mul_mat3(by->normal, linear), 1 / view->scale);
    ewa_vec3 normal = vec3_scale(vec3_add(m->normal, by_depth), s->is_back ? -1 : 1);
    normal = vec3_sub(normal, vec3_scale(from->axis_u, vec3_dot(by_u, n)));
    normal = vec3_sub(normal, vec3_scale(from->axis_v, vec3_dot(by_v, n)));
    const ewa_vec3 across = vec3_sub(normal, vec3_scale(n, vec3_dot(normal, n)));
    store_lane(to->normal, i, vec3_scale(across, 1 / from->given_length));
}

#endif
