// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of discs_body.h: one disc on its way to the screen. Reference: src/surface/surfel.c, src/reference/splat.c and
// contour.c, whose very numbers these are; docs/math.md sections 2 to 6.
#ifndef EWA_SRC_ADJOINT_DISC_PROJECT_BODY_H
#define EWA_SRC_ADJOINT_DISC_PROJECT_BODY_H

#include "adjoint/discs.h"
#include "homogeneous/frame.h"
#include "surface/semantics.h"

#define LANE static inline __attribute__((always_inline))

/// Not those of the library, which are calls.
LANE double larger(double a, double b) { return a > b ? a : b; }
LANE double smaller(double a, double b) { return a < b ? a : b; }
LANE double size_of(double a) { return __builtin_fabs(a); }
LANE double length_of(ewa_vec3 v) { return __builtin_sqrt(vec3_dot(v, v)); }

/// A disc in world space.
typedef struct disc_surfel {
    ewa_vec3 center, axis_u, axis_v, normal;
    double curvature;
    double given_length; ///< of the normal that the cloud has
    bool drawable;
} disc_surfel;

/// The same on the screen, as ewa_reference_splat.
typedef struct disc_splat {
    ewa_vec3 center, u, v, normal, normal_world, plane;
    double half_range, key_low, key_high, epsilon, x_begin, x_end, y_begin, y_end;
    double center_x, center_y, moved_x, moved_y, v11, v12, v22, q11, q12, q22, peak;
    bool drawn, near, is_back, moves, concave;
} disc_splat;

LANE disc_surfel load_disc(const ewa_disc_view *view, const ewa_disc_points *at, int i) {
    const ewa_vec3 given = {at->normal[0][i], at->normal[1][i], at->normal[2][i]};
    const ewa_vec3 center = {at->position[0][i], at->position[1][i], at->position[2][i]};
    const double sigma = at->radius[i] * view->sigma_per_radius, limit = EWA_SURFEL_LIMIT;
    const double largest = larger(size_of(given.x), larger(size_of(given.y), size_of(given.z)));
    const ewa_vec3 part = {given.x / largest, given.y / largest, given.z / largest};
    const double length = length_of(part);
    const ewa_vec3 n = vec3_scale(part, 1 / length);
    ewa_vec3 axes[2];
    ewa_frame_of(n, axes);
    const ewa_vec3 size = {size_of(center.x), size_of(center.y), size_of(center.z)};
    return (disc_surfel){
        .center = center, .axis_u = vec3_scale(axes[0], sigma), .axis_v = vec3_scale(axes[1], sigma), .normal = n,
        .curvature = at->curvature[i], .given_length = largest * length,
        .drawable = (sigma >= 1 / limit) & (sigma <= limit) & (largest > 0) & (given.x - given.x == 0) & (given.y - given.y == 0) &
                    (given.z - given.z == 0) & (size.x <= limit) & (size.y <= limit) & (size.z <= limit)};
}

/// Pixels whose centres lie in [low, high], within [0, size).
LANE void pixel_range(double low, double high, double size, double *begin, double *end) {
    const double first = __builtin_ceil(low - 0.5), last = __builtin_floor(high - 0.5);
    *begin = first > 0 ? smaller(first, size) : 0;
    *end = last < size - 1 ? (last < 0 ? 0 : last + 1) : size;
}

LANE void make_depth(const ewa_disc_view *view, disc_splat *to) {
    const ewa_vec3 p = to->center, n = to->normal;
    const bool flat = view->flat;
    const double fx = view->fx_px, fy = view->fy_px, facing = flat ? n.z : vec3_dot(n, p);
    const double minimum = EWA_EDGE_ON * (flat ? 1 : length_of(p)), raised_size = larger(size_of(facing), minimum);
    const double raised = (facing < 0 ? -raised_size : raised_size) * (flat ? -1 : 1), s = flat ? 1 : 1 / p.z;
    const double a = n.x / (raised * fx), b = n.y / (raised * fy);
    to->plane = vec3_make(a, b, (flat ? p.z : s) - a * (fx * p.x * s + view->cx_px) - b * (fy * p.y * s + view->cy_px));
    const double slope = __builtin_sqrt(a * a + b * b) * (flat ? 1 : p.z * p.z);
    const double radius = view->cutoff * larger(length_of(to->u), length_of(to->v));
    const double reach = view->cutoff * view->prefilter_px * slope;
    to->epsilon = view->tolerance * radius + smaller(reach, EWA_GRAZING_TOLERANCE * radius);
    const double margin = larger(smaller(EWA_FREE_RADII * radius, EWA_FREE_DEPTH * p.z) - reach, 0);
    const double far = p.z + to->half_range, near = p.z - to->half_range;
    to->key_low = flat ? -far - margin : 1 / far - margin * s * s;
    to->key_high = flat ? -near + margin : 1 / near + margin * s * s;
}

/// The kernel and its box; clears `drawn` where there is none.
LANE void make_ellipse(const ewa_disc_view *view, disc_splat *to) {
    const ewa_vec3 p = to->center, u = to->u, v = to->v;
    const bool flat = view->flat;
    const double fx = view->fx_px, fy = view->fy_px, x0 = flat ? 0 : p.x / p.z, y0 = flat ? 0 : p.y / p.z;
    const double ux = fx * (u.x - x0 * u.z), uy = fy * (u.y - y0 * u.z), vx = fx * (v.x - x0 * v.z), vy = fy * (v.y - y0 * v.z);
    const double s11 = ux * ux + vx * vx, s12 = ux * uy + vx * vy, s22 = uy * uy + vy * vy;
    const double s13 = ux * u.z + vx * v.z, s23 = uy * u.z + vy * v.z, s33 = u.z * u.z + v.z * v.z;
    const ewa_vec3 across = vec3_cross(u, v);
    const double F = view->cutoff, F2 = view->cutoff2, k = 1 / (p.z * p.z - F2 * s33), x = k * F2 * s13, y = k * F2 * s23;
    to->center_x = flat ? fx * p.x + view->cx_px : fx * x0 + view->cx_px - x;
    to->center_y = flat ? fy * p.y + view->cy_px : fy * y0 + view->cy_px - y;
    to->v11 = flat ? s11 : k * (s11 + x * s13);
    to->v12 = flat ? s12 : k * (s12 + x * s23);
    to->v22 = flat ? s22 : k * (s22 + y * s23);
    const double root = flat ? fx * fy * size_of(across.z) : fx * fy * size_of(vec3_dot(across, p)) * k * __builtin_sqrt(k);
    const double h2 = view->prefilter_px * view->prefilter_px, f11 = to->v11 + h2, f22 = to->v22 + h2;
    const double determinant = root * root + h2 * (to->v11 + to->v22) + h2 * h2;
    to->drawn = to->drawn & (determinant > EWA_FLAT * f11 * f22) & (root >= EWA_MIN_SPLAT);
    to->q11 = f22 / determinant, to->q12 = -to->v12 / determinant, to->q22 = f11 / determinant;
    to->peak = root / __builtin_sqrt(determinant) / 6.283185307179586;
    const double half_x = F * __builtin_sqrt(f11), half_y = F * __builtin_sqrt(f22);
    pixel_range(to->center_x - half_x, to->center_x + half_x, view->width_px, &to->x_begin, &to->x_end);
    pixel_range(to->center_y - half_y, to->center_y + half_y, view->height_px, &to->y_begin, &to->y_end);
}

/// Away from its contour.
LANE void move(const ewa_disc_view *view, double curvature, disc_splat *to) {
    const ewa_vec3 p = to->center, n = to->normal;
    const double depth = view->flat ? 1 : p.z, sine = view->flat ? n.z : vec3_dot(n, p) / p.z;
    const double bend = 2 * larger(curvature, 0) / view->scale * depth / view->fx_px;
    const double sigma_px = view->fx_px * larger(length_of(to->u), length_of(to->v)) / depth;
    const double wide_px = EWA_CONTOUR_WIDTH * sigma_px * sine;
    const double across = __builtin_sqrt(view->prefilter_px * view->prefilter_px + wide_px * wide_px);
    const double reach = smaller(EWA_CONTOUR_REACH * across * bend, view->contour_sine2);
    const double x = -n.x / view->fx_px, y = -n.y / view->fy_px, length = __builtin_sqrt(x * x + y * y);
    const bool moves = (curvature > 0) & (sine * sine < reach) & (length > 0);
    const double inward = 1 - sine * sine / reach, signed_shift = to->is_back ? -view->contour_shift : view->contour_shift;
    const double way = signed_shift * across * inward / length;
    to->concave = moves & to->is_back & (inward > view->concave_from);
    to->moves = moves;
    to->moved_x = moves ? way * x : 0, to->moved_y = moves ? way * y : 0;
    const double wider_x = __builtin_ceil(size_of(to->moved_x)), wider_y = __builtin_ceil(size_of(to->moved_y));
    to->x_begin = larger(to->x_begin - wider_x, 0), to->x_end = smaller(to->x_end + wider_x, view->width_px);
    to->y_begin = larger(to->y_begin - wider_y, 0), to->y_end = smaller(to->y_end + wider_y, view->height_px);
}

LANE disc_splat project_disc(const ewa_disc_view *view, disc_surfel from) {
    const ewa_mat3 *linear = &view->linear;
    const ewa_vec3 p = vec3_add(mat3_mul_vec3(linear, vec3_sub(from.center, view->anchor)), view->offset);
    const ewa_vec3 u = mat3_mul_vec3(linear, from.axis_u), v = mat3_mul_vec3(linear, from.axis_v);
    const ewa_vec3 turned = mat3_mul_vec3(linear, from.normal), n = vec3_scale(turned, 1 / length_of(turned));
    const bool flat = view->flat;
    const double half_range = view->cutoff * __builtin_sqrt(u.z * u.z + v.z * v.z), facing = flat ? n.z : vec3_dot(n, p);
    const double broad = larger(length_of(u), length_of(v)) * larger(view->fx_px, view->fy_px) / EWA_BROAD_PX;
    const bool is_seen = from.drawable & (flat ? p.z > 0 : p.z + half_range > 0) & (facing < view->back_from);
    const bool by_rays = flat ? broad > 1 : p.z <= larger(EWA_NEAR_RATIO * half_range, broad);
    const bool is_back = facing > 0;
    disc_splat to = {.center = p, .u = u, .v = v, .normal = vec3_scale(n, is_back ? -1 : 1),
                     .normal_world = vec3_scale(from.normal, is_back ? -1 : 1), .half_range = half_range,
                     .drawn = is_seen & !by_rays, .near = is_seen & by_rays, .is_back = is_back};
    make_depth(view, &to);
    make_ellipse(view, &to);
    move(view, from.curvature, &to);
    return to;
}

#endif
