// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From the cotangents of a pixel's surface to those of a splat, and from a splat's sums to its surfel (docs/math.md
// section 15). What is held fixed: which splats count where, on which surface, which way they face, what clip lines
// leave of pixels, and q0.
#include "reference/adjoint_splat.h"
#include "surface/semantics.h"

#include <string.h>

bool ewa_reference_is_on_plane(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                               double y_px) {
    const double plane = splat->plane[0] * x_px + splat->plane[1] * y_px + splat->plane[2];
    const double key = view->orthographic ? -plane : plane;
    return key > splat->key_low && key < splat->key_high;
}

void ewa_reference_moments_at(const ewa_reference_view *view, const ewa_reference_splat *splat,
                              const ewa_reference_sample *sample, double x_px, double y_px, bool transparent,
                              const ewa_reference_gathered *cotangent, double terms[EWA_MOMENT_COUNT]) {
    memset(terms, 0, EWA_MOMENT_COUNT * sizeof *terms);
    const ewa_reference_sums *of = splat->is_back ? &cotangent->is_back : &cotangent->facing;
    const ewa_reference_cut *by_cut = &cotangent->cut;
    const double weight = sample->weight, opacity = transparent ? splat->opacity : 1;
    vec3_store(vec3_scale(of->color, weight * opacity), terms + EWA_MOMENT_COLOR);
    const double shown = vec3_dot(splat->color, of->color) + of->opacity;
    if (transparent) terms[EWA_MOMENT_OPACITY] = weight * shown;
    vec3_store(vec3_scale(of->normal_world, weight), terms + EWA_MOMENT_NORMAL);
    if (splat->by_rays) return;
    const double cut = fmin(1, (1 - sample->share) / EWA_CUT);
    const double whole = by_cut->whole + by_cut->inward[0] * sample->inward[0] + by_cut->inward[1] * sample->inward[1];
    const double by_weight = of->weight + opacity * shown + vec3_dot(splat->normal_world, of->normal_world) +
                             sample->z * of->z + cut * (by_cut->kept + whole / sample->share);
    const double g = weight * by_weight, plane_dx = x_px - splat->center_px[0], plane_dy = y_px - splat->center_px[1];
    const double dx = plane_dx - splat->moved_px[0], dy = plane_dy - splat->moved_px[1];
    terms[EWA_MOMENT_WEIGHT] = g;
    terms[EWA_MOMENT_FIRST] = g * dx;
    terms[EWA_MOMENT_FIRST + 1] = g * dy;
    terms[EWA_MOMENT_SECOND] = g * dx * dx;
    terms[EWA_MOMENT_SECOND + 1] = g * dx * dy;
    terms[EWA_MOMENT_SECOND + 2] = g * dy * dy;
    if (of->z == 0 || !ewa_reference_is_on_plane(view, splat, x_px, y_px)) return;
    const double by_plane = weight * of->z * (view->orthographic ? 1 : -sample->z * sample->z);
    terms[EWA_MOMENT_DEPTH] = by_plane * plane_dx; // the plane stays where it is
    terms[EWA_MOMENT_DEPTH + 1] = by_plane * plane_dy;
    terms[EWA_MOMENT_DEPTH + 2] = by_plane;
}

/// Cotangents in camera space.
typedef struct camera_cotangent {
    ewa_vec3 center, axes[2], normal;
    double focal[2], principal[2];
} camera_cotangent;

/// What the moments of an ellipse's pixels, of conic q, say of its centre, Q S1, and of V, (Q S2 Q - S0 Q) / 2: 11, 12 and 22.
static void conic_pull_back(const double q[3], const double moments[EWA_MOMENT_COUNT], double center[2], double v[3]) {
    const double s0 = moments[EWA_MOMENT_WEIGHT], *s1 = moments + EWA_MOMENT_FIRST, *s2 = moments + EWA_MOMENT_SECOND;
    center[0] = q[0] * s1[0] + q[1] * s1[1];
    center[1] = q[1] * s1[0] + q[2] * s1[1];
    const double a[2][2] = {{q[0] * s2[0] + q[1] * s2[1], q[0] * s2[1] + q[1] * s2[2]},
                            {q[1] * s2[0] + q[2] * s2[1], q[1] * s2[1] + q[2] * s2[2]}};
    v[0] = (a[0][0] * q[0] + a[0][1] * q[1] - s0 * q[0]) / 2;
    v[1] = (a[0][0] * q[1] + a[0][1] * q[2] - s0 * q[1]) / 2;
    v[2] = (a[1][0] * q[1] + a[1][1] * q[2] - s0 * q[2]) / 2;
}

/// The ellipse: centre, V and |V| of docs/math.md sections 3 and 4.
static void ellipse_pull_back(const ewa_reference_view *view, const ewa_reference_splat *splat,
                              const double moments[EWA_MOMENT_COUNT], camera_cotangent *to) {
    const ewa_vec3 p = splat->center, axes[2] = {splat->axis_u, splat->axis_v};
    double center[2], v[3];
    conic_pull_back(splat->inverse, moments, center, v);
    const double s0 = moments[EWA_MOMENT_WEIGHT], v11 = v[0], v12 = v[1], v22 = v[2];
    const bool flat = view->orthographic;
    const double fx = view->fx_px, fy = view->fy_px, x0 = flat ? 0 : p.x / p.z, y0 = flat ? 0 : p.y / p.z;
    const double F2 = flat || view->kernel != EWA_KERNEL_PERSPECTIVE ? 0 : view->cutoff * view->cutoff;
    double e[2] = {0, 0}, s33 = 0, sheared[2][2], s11 = 0, s12 = 0, s22 = 0;
    for (int i = 0; i < 2; i++) {
        const double x = sheared[i][0] = fx * (axes[i].x - x0 * axes[i].z),
                     y = sheared[i][1] = fy * (axes[i].y - y0 * axes[i].z);
        s11 += x * x, s12 += x * y, s22 += y * y;
        e[0] += x * axes[i].z, e[1] += y * axes[i].z, s33 += axes[i].z * axes[i].z;
    }
    const double k = flat ? 1 : 1 / (p.z * p.z - F2 * s33);
    const double along[2] = {v11 * e[0] + v12 * e[1], v12 * e[0] + v22 * e[1]}; // e V
    double by_k = -F2 * (center[0] * e[0] + center[1] * e[1]) + 2 * F2 * k * (along[0] * e[0] + along[1] * e[1]) +
                  v11 * s11 + 2 * v12 * s12 + v22 * s22 + 1.5 * s0 / k;
    if (flat) by_k = 0;
    const double by_e[2] = {F2 * k * (2 * k * along[0] - center[0]), F2 * k * (2 * k * along[1] - center[1])};
    const double by_s33 = k * k * F2 * by_k;
    double by_x0 = 0, by_y0 = 0;
    for (int i = 0; i < 2; i++) {
        const ewa_vec3 t = axes[i];
        const double x = sheared[i][0], y = sheared[i][1];
        const double by_x = 2 * k * (v11 * x + v12 * y) + t.z * by_e[0];
        const double by_y = 2 * k * (v12 * x + v22 * y) + t.z * by_e[1];
        to->axes[i].x += fx * by_x;
        to->axes[i].y += fy * by_y;
        to->axes[i].z += by_e[0] * x + by_e[1] * y + 2 * by_s33 * t.z - fx * x0 * by_x - fy * y0 * by_y;
        to->focal[0] += by_x * x / fx;
        to->focal[1] += by_y * y / fy;
        if (!flat) by_x0 -= fx * t.z * by_x, by_y0 -= fy * t.z * by_y;
    }
    // |V| by way of |M|.
    const ewa_vec3 across = vec3_cross(axes[0], axes[1]), way = flat ? vec3_make(0, 0, 1) : p;
    const double share = s0 / vec3_dot(across, way);
    to->axes[0] = vec3_add(to->axes[0], vec3_scale(vec3_cross(axes[1], way), share));
    to->axes[1] = vec3_add(to->axes[1], vec3_scale(vec3_cross(way, axes[0]), share));
    to->focal[0] += s0 / fx;
    to->focal[1] += s0 / fy;
    to->principal[0] += center[0];
    to->principal[1] += center[1];
    if (flat) {
        to->center.x += fx * center[0];
        to->center.y += fy * center[1];
        to->focal[0] += center[0] * p.x;
        to->focal[1] += center[1] * p.y;
        return;
    }
    to->center = vec3_add(to->center, vec3_scale(across, share));
    to->focal[0] += center[0] * x0;
    to->focal[1] += center[1] * y0;
    by_x0 += fx * center[0], by_y0 += fy * center[1];
    to->center.x += by_x0 / p.z;
    to->center.y += by_y0 / p.z;
    to->center.z -= (by_x0 * x0 + by_y0 * y0) / p.z + 2 * k * k * p.z * by_k;
}

/// The way of a splat at its contour (section 5, contours), which by the centre of its ellipse is `by_way`. The surfel's
/// curvature is a number like its colour that stays.
static void way_pull_back(const ewa_reference_view *view, const ewa_reference_splat *splat, const ewa_surfel *surfel,
                          const double by_way[2], camera_cotangent *to) {
    if (splat->moved_px[0] == 0 && splat->moved_px[1] == 0) return;
    const bool flat = view->orthographic;
    const ewa_vec3 p = splat->center, n = splat->normal;
    const double fx = view->fx_px, fy = view->fy_px, depth = flat ? 1 : p.z;
    const double scale = vec3_length(mat3_row(&view->placement.linear, 2));
    const double sine = flat ? n.z : vec3_dot(n, p) / p.z;
    const double bend = 2 * fabs(surfel->curvature_world) / scale * depth / fx;
    const double lengths[2] = {vec3_length(splat->axis_u), vec3_length(splat->axis_v)};
    const int longer = lengths[1] > lengths[0];
    const double sigma_px = fx * lengths[longer] / depth;
    const double across = hypot(view->prefilter_px, EWA_CONTOUR_WIDTH * sigma_px * sine);
    const double reach = fmin(EWA_CONTOUR_REACH * across * bend, view->contour_sine2);
    const double x = -n.x / fx, y = -n.y / fy, length = hypot(x, y), inward = 1 - sine * sine / reach;
    // m = way (x, y) / length, way = +- c across inward.
    const double along = (splat->moved_px[0] * x + splat->moved_px[1] * y) / length;
    const double signed_shift = (along < 0 ? -1 : 1) * view->contour_shift;
    const double by_along = (by_way[0] * x + by_way[1] * y) / length;
    const double by_x = along * (by_way[0] - by_along * x / length) / length,
                 by_y = along * (by_way[1] - by_along * y / length) / length;
    const double by_inward = signed_shift * across * by_along;
    double by_across = signed_shift * inward * by_along, by_bend = 0, by_sine = -2 * sine / reach * by_inward;
    if (reach < view->contour_sine2) {
        const double by_reach = sine * sine / (reach * reach) * by_inward;
        by_across += EWA_CONTOUR_REACH * bend * by_reach;
        by_bend = EWA_CONTOUR_REACH * across * by_reach;
    }
    const double width2 = EWA_CONTOUR_WIDTH * EWA_CONTOUR_WIDTH / across * by_across;
    const double by_sigma = width2 * sigma_px * sine * sine;
    by_sine += width2 * sigma_px * sigma_px * sine;
    const ewa_vec3 axis = longer ? splat->axis_v : splat->axis_u;
    to->axes[longer] = vec3_add(to->axes[longer], vec3_scale(axis, by_sigma * fx / depth / lengths[longer]));
    to->normal.x -= by_x / fx;
    to->normal.y -= by_y / fy;
    to->focal[0] += (by_sigma * sigma_px - by_bend * bend - by_x * x) / fx;
    to->focal[1] -= by_y * y / fy;
    if (flat) {
        to->normal.z += by_sine;
        return;
    }
    to->normal = vec3_add(to->normal, vec3_scale(p, by_sine / p.z));
    to->center = vec3_add(to->center, vec3_scale(n, by_sine / p.z));
    to->center.z += (by_bend * bend - by_sigma * sigma_px - by_sine * sine) / p.z;
}

/// The plane of depths (docs/math.md section 5), its slope as it is where the surfel is seen from its very edge.
static void depth_pull_back(const ewa_reference_view *view, const ewa_reference_splat *splat,
                            const double moments[EWA_MOMENT_COUNT], camera_cotangent *to) {
    const bool flat = view->orthographic;
    const ewa_vec3 p = splat->center, n = splat->normal;
    const double fx = view->fx_px, fy = view->fy_px, s = flat ? 1 : 1 / p.z;
    const double x_px = fx * p.x * s + view->cx_px, y_px = fy * p.y * s + view->cy_px; // the projected centre
    const double sum = moments[EWA_MOMENT_DEPTH + 2];
    const double by_a = moments[EWA_MOMENT_DEPTH] + sum * (splat->center_px[0] - x_px),
                 by_b = moments[EWA_MOMENT_DEPTH + 1] + sum * (splat->center_px[1] - y_px);
    const double facing = flat ? n.z : vec3_dot(n, p), minimum = EWA_EDGE_ON * (flat ? 1 : vec3_length(p));
    const double a = splat->plane[0], b = splat->plane[1];
    const bool raised = fabs(facing) < minimum;
    const double signed_minimum = facing < 0 ? -minimum : minimum;
    const double divisor = (raised ? signed_minimum : facing) * (flat ? -1 : 1);
    to->normal.x += by_a / (divisor * fx);
    to->normal.y += by_b / (divisor * fy);
    to->focal[0] -= by_a * a / fx + sum * a * p.x * s;
    to->focal[1] -= by_b * b / fy + sum * b * p.y * s;
    to->principal[0] -= sum * a;
    to->principal[1] -= sum * b;
    to->center.x -= sum * a * fx * s;
    to->center.y -= sum * b * fy * s;
    to->center.z += flat ? sum : sum * s * s * (a * fx * p.x + b * fy * p.y - 1);
    if (raised) return;
    const double by_divisor = -(by_a * a + by_b * b) / divisor;
    if (flat) {
        to->normal.z -= by_divisor;
        return;
    }
    to->normal = vec3_add(to->normal, vec3_scale(p, by_divisor));
    to->center = vec3_add(to->center, vec3_scale(n, by_divisor));
}

static void add_turn(ewa_vec3 of, ewa_vec3 cotangent, double camera[EWA_CAMERA_NUMBERS]) {
    const ewa_vec3 turn = vec3_cross(of, cotangent);
    camera[EWA_CAMERA_ROTATION] += turn.x;
    camera[EWA_CAMERA_ROTATION + 1] += turn.y;
    camera[EWA_CAMERA_ROTATION + 2] += turn.z;
}

void ewa_reference_moments_pull_back(const ewa_reference_view *view, const ewa_reference_splat *splat,
                                     const ewa_surfel *surfel, const double moments[EWA_MOMENT_COUNT],
                                     ewa_reference_surfel_cotangent *to, double camera[EWA_CAMERA_NUMBERS]) {
    const ewa_mat3 *linear = &view->placement.linear;
    const double unit = view->placement.unit, scale = vec3_length(mat3_row(linear, 2));
    *to = (ewa_reference_surfel_cotangent){.color = vec3_load(moments + EWA_MOMENT_COLOR),
                                           .opacity = moments[EWA_MOMENT_OPACITY]};
    const ewa_vec3 shown = vec3_load(moments + EWA_MOMENT_NORMAL);
    camera_cotangent in_camera = {.focal = {0, 0}};
    if (!splat->by_rays) {
        const double *q = splat->inverse, *s1 = moments + EWA_MOMENT_FIRST;
        const double by_way[2] = {q[0] * s1[0] + q[1] * s1[1], q[1] * s1[0] + q[2] * s1[1]};
        ellipse_pull_back(view, splat, moments, &in_camera);
        way_pull_back(view, splat, surfel, by_way, &in_camera);
        depth_pull_back(view, splat, moments, &in_camera);
    }
    const ewa_vec3 p = in_camera.center;
    add_turn(splat->center, p, camera);
    camera[EWA_CAMERA_TRANSLATION] += p.x / unit;
    camera[EWA_CAMERA_TRANSLATION + 1] += p.y / unit;
    camera[EWA_CAMERA_TRANSLATION + 2] += p.z / unit;
    for (int i = 0; i < 2; i++) {
        camera[EWA_CAMERA_FOCAL + i] += in_camera.focal[i] * (view->orthographic ? unit : 1);
        camera[EWA_CAMERA_PRINCIPAL + i] += in_camera.principal[i];
    }
    to->center = vec3_mul_mat3(p, linear);
    if (surfel->billboard) { // its axes and its normal stay with the camera
        to->circle = scale * (in_camera.axes[0].x + in_camera.axes[1].y);
        add_turn(vec3_scale(mat3_mul_vec3(linear, shown), 1 / scale), splat->normal, camera);
        return;
    }
    add_turn(splat->axis_u, in_camera.axes[0], camera);
    add_turn(splat->axis_v, in_camera.axes[1], camera);
    add_turn(splat->normal, in_camera.normal, camera);
    to->axis_u = vec3_mul_mat3(in_camera.axes[0], linear);
    to->axis_v = vec3_mul_mat3(in_camera.axes[1], linear);
    const ewa_vec3 by_depth = vec3_scale(vec3_mul_mat3(in_camera.normal, linear), 1 / scale);
    to->normal = vec3_scale(vec3_add(shown, by_depth), splat->is_back ? -1 : 1);
}

/// Discs: normal and radius make both axes.
static void disc_pull_back(const ewa_surfel_reader *reader, uint64_t point, const ewa_surfel *surfel,
                           const ewa_reference_surfel_cotangent *from, ewa_reference_point_cotangent *to) {
    const ewa_vec3 u = vec3_load(surfel->axis_u_world), v = vec3_load(surfel->axis_v_world),
                   n = vec3_load(surfel->normal_world);
    const double sigma = vec3_length(u);
    if (surfel->billboard) {
        to->radius = from->circle * EWA_BILLBOARD_SCALE * reader->sigma_per_radius;
        return;
    }
    to->radius = (vec3_dot(from->axis_u, u) + vec3_dot(from->axis_v, v)) / sigma * reader->sigma_per_radius;
    // Axes turn with the normal: u changes by -(u . dn) n.
    ewa_vec3 normal = vec3_sub(from->normal, vec3_scale(u, vec3_dot(from->axis_u, n)));
    normal = vec3_sub(normal, vec3_scale(v, vec3_dot(from->axis_v, n)));
    double given[3];
    ewa_attribute_read_f64(reader->normal, point, 1, given);
    const ewa_vec3 across = vec3_sub(normal, vec3_scale(n, vec3_dot(normal, n)));
    vec3_store(vec3_scale(across, 1 / vec3_length_scaled(vec3_load(given))), to->normal);
}

/// Ellipses: the normal goes with the axes, which were turned into principal ones.
static void axes_pull_back(const ewa_surfel_reader *reader, uint64_t point, const ewa_surfel *surfel,
                           const ewa_reference_surfel_cotangent *from, ewa_reference_point_cotangent *to) {
    double given[2][3];
    ewa_attribute_read_f64(reader->tangent_u, point, 1, given[0]);
    ewa_attribute_read_f64(reader->tangent_v, point, 1, given[1]);
    const double scale = reader->axis_scale;
    const ewa_vec3 tu = vec3_scale(vec3_load(given[0]), scale), tv = vec3_scale(vec3_load(given[1]), scale);
    const ewa_vec3 across = vec3_cross(tu, tv), unit = vec3_scale(across, 1 / vec3_length(across));
    const double area = vec3_length(across);
    ewa_vec3 by_u = {0, 0, 0}, by_v = {0, 0, 0}, by_across;
    if (surfel->billboard) { // of the same area as the ellipse
        by_across = vec3_scale(unit, from->circle * vec3_length(vec3_load(surfel->axis_u_world)) / (2 * area));
    } else {
        const ewa_vec3 u = vec3_load(surfel->axis_u_world), v = vec3_load(surfel->axis_v_world);
        const double cosine = vec3_dot(tu, u) / vec3_dot(u, u), sine = -vec3_dot(tu, v) / vec3_dot(v, v);
        by_u = vec3_sub(vec3_scale(from->axis_u, cosine), vec3_scale(from->axis_v, sine));
        by_v = vec3_add(vec3_scale(from->axis_u, sine), vec3_scale(from->axis_v, cosine));
        const double side = vec3_dot(unit, vec3_load(surfel->normal_world)) < 0 ? -1 : 1;
        const ewa_vec3 of_unit = vec3_scale(from->normal, side);
        by_across = vec3_scale(vec3_sub(of_unit, vec3_scale(unit, vec3_dot(unit, of_unit))), 1 / area);
    }
    by_u = vec3_add(by_u, vec3_cross(tv, by_across));
    by_v = vec3_add(by_v, vec3_cross(by_across, tu));
    vec3_store(vec3_scale(by_u, scale), to->tangent_u);
    vec3_store(vec3_scale(by_v, scale), to->tangent_v);
}

void ewa_reference_surfel_pull_back(const ewa_surfel_reader *reader, uint64_t point, const ewa_surfel *surfel,
                                    const ewa_reference_surfel_cotangent *from, ewa_reference_point_cotangent *to) {
    memset(to, 0, sizeof *to);
    vec3_store(from->center, to->position);
    vec3_store(from->color, to->color);
    to->opacity = from->opacity;
    if (reader->tangent_u)
        axes_pull_back(reader, point, surfel, from, to);
    else
        disc_pull_back(reader, point, surfel, from, to);
}
