// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What one surfel is on the screen, in the order of semantics.h.
#include "tests/independent/independent.h"

#include <math.h>

// The numbers of semantics.h, written down again: a change there must be meant.
static const real NEAR_RATIO = 1.05L;
static const real EDGE_ON = 1e-5L;
static const real GRAZING = 16;
static const real FREE_RADII = 2, FREE_DEPTH = 0.25L;
static const real FLAT = 1e-14L;
static const real MIN_KEY = 1 / 16.0L;
static const real MIN_AREA = 1e-15L;
// What single precision and the packets' numbers may leave undecided: relative errors of sizes, the angle in
// radians by which normals are off, and relative errors of depths.
static const real SIZE_ERROR = 1e-4L, ANGLE_ERROR = 5e-5L, DEPTH_ERROR = 1e-5L, AXIS_ERROR = 1e-5L;
static const real TWO_PI = 6.283185307179586476925L;

real3 real3_of(const double v[3]) { return (real3){(real)v[0], (real)v[1], (real)v[2]}; }
real3 real3_add(real3 a, real3 b) { return (real3){a.x + b.x, a.y + b.y, a.z + b.z}; }
real3 real3_times(real3 a, real factor) { return (real3){a.x * factor, a.y * factor, a.z * factor}; }
real real3_dot(real3 a, real3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
real3 real3_cross(real3 a, real3 b) {
    return (real3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
real real3_length(real3 a) { return sqrtl(real3_dot(a, a)); }
real3 real3_unit(real3 a) {
    const real length = real3_length(a);
    return length > 0 ? real3_times(a, 1 / length) : (real3){0, 0, 0};
}

/// [v w] through world_to_camera: a point for w = 1, a direction for 0.
static real3 through_camera(const ewa_camera *camera, real3 v, real w) {
    const double *m = camera->world_to_camera;
    return (real3){(real)m[0] * v.x + (real)m[1] * v.y + (real)m[2] * v.z + (real)m[3] * w,
                   (real)m[4] * v.x + (real)m[5] * v.y + (real)m[6] * v.z + (real)m[7] * w,
                   (real)m[8] * v.x + (real)m[9] * v.y + (real)m[10] * v.z + (real)m[11] * w};
}

static real clamped(real value, real low, real high) {
    return value < low ? low : value > high ? high : value;
}
static real smaller(real a, real b) { return a < b ? a : b; }
static real larger(real a, real b) { return a > b ? a : b; }

/// Length of the longer principal axis: root of the larger eigenvalue of the axes' Gram matrix.
static real longer_axis(real3 u, real3 v) {
    const real uu = real3_dot(u, u), vv = real3_dot(v, v), uv = real3_dot(u, v);
    return sqrtl((uu + vv + hypotl(uu - vv, 2 * uv)) / 2);
}

/// The longer axis over the shorter one, whose product is the area of the axes' parallelogram.
static real aspect_of(real3 u, real3 v) {
    const real longest = longer_axis(u, v);
    return longest * longest / real3_length(real3_cross(u, v));
}

// ---- Ellipses

/// D = N' diag(F^2, F^2, -1) N in pixels, N = [u; v; p] K' taking (a, b, 1) of the surfel's plane to the
/// picture.
static void perspective_ellipse(independent_splat *s) {
    const real3 rows[3] = {s->u, s->v, s->p};
    const real F2 = s->cutoff * s->cutoff, signs[3] = {F2, F2, -1};
    real N[3][3], D[3][3] = {{0}};
    for (int i = 0; i < 3; i++) {
        N[i][0] = s->fx * rows[i].x + s->cx * rows[i].z;
        N[i][1] = s->fy * rows[i].y + s->cy * rows[i].z;
        N[i][2] = rows[i].z;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int i = 0; i < 3; i++) D[a][b] += signs[i] * N[i][a] * N[i][b];
    const real w = D[2][2], c[2] = {D[0][2] / w, D[1][2] / w};
    s->center[0] = c[0], s->center[1] = c[1];
    s->variance[0] = (c[0] * c[0] - D[0][0] / w) / F2;
    s->variance[1] = (c[0] * c[1] - D[0][1] / w) / F2;
    s->variance[2] = (c[1] * c[1] - D[1][1] / w) / F2;
    // |D| = D33^3 |S| for every dual conic, and |D| = -F^4 |N|^2 for this one.
    const real whole = s->fx * s->fy * real3_dot(real3_cross(s->u, s->v), s->p);
    s->determinant = -whole * whole / (w * w * w);
}

/// V = J'J; J by the quotient rule on fx x/z + cx, orthographic: on fx x + cx.
static void affine_ellipse(independent_splat *s) {
    const real3 axes[2] = {s->u, s->v};
    const real z = s->p.z, z2 = z * z;
    for (int i = 0; i < 2; i++) {
        const real3 t = axes[i];
        s->jacobian[i][0] = s->orthographic ? s->fx * t.x : s->fx * (t.x * z - s->p.x * t.z) / z2;
        s->jacobian[i][1] = s->orthographic ? s->fy * t.y : s->fy * (t.y * z - s->p.y * t.z) / z2;
    }
    real(*J)[2] = s->jacobian;
    s->center[0] = s->fx * s->p.x / (s->orthographic ? 1 : z) + s->cx;
    s->center[1] = s->fy * s->p.y / (s->orthographic ? 1 : z) + s->cy;
    s->variance[0] = J[0][0] * J[0][0] + J[1][0] * J[1][0];
    s->variance[1] = J[0][0] * J[0][1] + J[1][0] * J[1][1];
    s->variance[2] = J[0][1] * J[0][1] + J[1][1] * J[1][1];
    const real d = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    s->determinant = d * d;
}

/// V' = w^2 V + h^2 I, circular: its larger eigenvalue times I; `d` is |V'|.
static void filtered(const independent_splat *s, real w, real V[3], real *d) {
    const real h2 = s->prefilter * s->prefilter, w2 = w * w;
    V[0] = w2 * s->variance[0] + h2, V[1] = w2 * s->variance[1], V[2] = w2 * s->variance[2] + h2;
    *d = w2 * w2 * s->determinant + h2 * w2 * (s->variance[0] + s->variance[2]) + h2 * h2;
    if (s->kernel != EWA_KERNEL_CIRCULAR) return;
    const real l = (V[0] + V[2] + hypotl(V[0] - V[2], 2 * V[1])) / 2;
    V[0] = V[2] = l, V[1] = 0, *d = l * l;
}

/// Sets the ellipse and its box; false: the splat is dropped.
static bool make_ellipse(independent_splat *s, real longest) {
    const bool perspective = !s->orthographic && s->kernel == EWA_KERNEL_PERSPECTIVE;
    const bool raycast = !s->orthographic && s->kernel == EWA_KERNEL_RAYCAST;
    if (perspective)
        perspective_ellipse(s);
    else
        affine_ellipse(s);
    const real *V = s->variance, h2 = s->prefilter * s->prefilter;
    const real plain = s->determinant + h2 * (V[0] + V[2]) + h2 * h2;
    if (!(plain > FLAT * (V[0] + h2) * (V[2] + h2))) return false;
    if (s->kernel == EWA_KERNEL_SOURCE &&
        !(s->determinant >= FLAT * V[0] * V[2] && sqrtl(s->determinant) >= MIN_AREA))
        return false;
    if (raycast && fabsl(real3_dot(s->n, s->p)) < EDGE_ON * real3_length(s->p)) return false;
    real Vf[3], d;
    filtered(s, raycast ? s->p.z / (s->p.z - s->half_range) : 1, Vf, &d);
    if (s->kernel == EWA_KERNEL_CIRCULAR) {
        const real z2 = s->orthographic ? 1 : s->p.z * s->p.z;
        const real g = hypotl(s->key[0], s->key[1]) * z2;
        const real m = smaller(s->cutoff * sqrtl(Vf[0]) * g, GRAZING * s->cutoff * longest) / z2;
        s->key_low -= m, s->key_high += m;
        if (!s->orthographic) s->key_low = larger(s->key_low, MIN_KEY / s->p.z);
    }
    for (int i = 0; i < 2; i++) {
        const real reach = s->cutoff * sqrtl(Vf[2 * i]) + 0.01L;
        s->box[2 * i] = s->center[i] - reach, s->box[2 * i + 1] = s->center[i] + reach;
    }
    return true;
}

// ---- Depth

/// The plane's key, its range, the tolerance.
static void make_depth(independent_splat *s, real longest, real tolerance) {
    const real3 p = s->p, n = s->n;
    const bool flat = s->orthographic;
    const real facing = flat ? n.z : real3_dot(n, p), minimum = EDGE_ON * (flat ? 1 : real3_length(p));
    const real raised = fabsl(facing) < minimum ? (facing < 0 ? -minimum : minimum) : facing;
    // 1/z = 1/pz + n.(d - p/pz) / n.p with d = ((x - cx)/fx, (y - cy)/fy, 1); -z = -pz + ...: gathered by x
    // and y.
    const real unit = flat ? 1 : 1 / p.z;
    s->key[0] = n.x / s->fx / raised;
    s->key[1] = n.y / s->fy / raised;
    s->key[2] = (flat ? -p.z : 1 / p.z) - s->key[0] * (s->cx + s->fx * p.x * unit) -
                s->key[1] * (s->cy + s->fy * p.y * unit);
    const real z2 = flat ? 1 : p.z * p.z, g = hypotl(s->key[0], s->key[1]) * z2;
    const real F = s->cutoff, reach = F * s->prefilter * g;
    s->epsilon = tolerance * F * longest + smaller(reach, GRAZING * F * longest);
    const real m = s->near ? 0 : larger(0, smaller(FREE_RADII * F * longest, FREE_DEPTH * p.z) - reach);
    const real low = p.z - s->half_range, high = p.z + s->half_range;
    s->key_low = flat ? -high - m : 1 / high - m / z2;
    s->key_high = flat ? -low + m : 1 / low + m / z2;
}

// ---- Clip lines

/// The line a u + b v + c = 0 of the plane is the plane of space through it and the eye (orthographic: along
/// the view), whose normal is the cross product of one of its points and its direction. The file's line is
/// for axes that are not yet times `scale`.
static void make_clip(independent_splat *s, const double line[3], real scale, real out[3]) {
    const real a = (real)line[0] * scale, b = (real)line[1] * scale, c = (real)line[2];
    // The foot of the origin, and where the line goes.
    const real foot_u = -c * a / (a * a + b * b), foot_v = -c * b / (a * a + b * b);
    const real3 offset = real3_add(real3_times(s->u, foot_u), real3_times(s->v, foot_v));
    const real3 foot = real3_add(s->p, offset);
    const real3 along = real3_add(real3_times(s->u, -b), real3_times(s->v, a));
    const real3 inward = real3_add(real3_times(s->u, a), real3_times(s->v, b));
    const real3 wall = real3_cross(s->orthographic ? (real3){0, 0, 1} : foot, along);
    const real side = real3_dot(wall, inward) < 0 ? -1 : 1;
    const real x = side * wall.x / s->fx, y = side * wall.y / s->fy, length = hypotl(x, y);
    const real at_origin = s->orthographic ? -side * real3_dot(wall, foot) : side * wall.z;
    const real rest = at_origin - x * s->cx - y * s->cy;
    out[0] = length > 0 ? x / length : 0;
    out[1] = length > 0 ? y / length : 0;
    out[2] = length > 0 ? rest / length : rest < 0 ? -1 : 1;
}

/// The area of the pixel's square around (x, y) where a line's distance is not negative: the square is cut to
/// a polygon, side by side.
static real area_inside(const real line[3], real x, real y) {
    static const real corners[4][2] = {{-0.5L, -0.5L}, {0.5L, -0.5L}, {0.5L, 0.5L}, {-0.5L, 0.5L}};
    real kept[8][2], area = 0;
    int count = 0;
    for (int i = 0; i < 4; i++) {
        const real *a = corners[i], *b = corners[(i + 1) % 4];
        const real at_a = line[0] * (x + a[0]) + line[1] * (y + a[1]) + line[2];
        const real at_b = line[0] * (x + b[0]) + line[1] * (y + b[1]) + line[2];
        if (at_a >= 0) kept[count][0] = a[0], kept[count++][1] = a[1];
        if ((at_a < 0) == (at_b < 0)) continue;
        const real t = at_a / (at_a - at_b);
        kept[count][0] = a[0] + t * (b[0] - a[0]), kept[count++][1] = a[1] + t * (b[1] - a[1]);
    }
    for (int i = 0; i < count; i++) {
        const real *a = kept[i], *b = kept[(i + 1) % count];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return area;
}

/// What clip lines keep of the pixel's square, and where.
static void clip_square(const independent_splat *s, real x, real y, independent_fragment *out) {
    real share[2] = {1, 1}, sum = 0;
    for (uint32_t k = 0; k < s->clip_count; k++) share[k] = area_inside(s->clip[k], x, y);
    const bool either = s->clip_either && s->clip_count == 2;
    out->share = either ? larger(share[0], share[1]) : smaller(share[0], share[1]);
    for (uint32_t k = 0; k < s->clip_count; k++) {
        const real decides = either ? share[k] : 1 - share[k];
        sum += decides;
        for (int c = 0; c < 2; c++) out->inward[c] += decides * s->clip[k][c];
    }
    for (int c = 0; c < 2 && sum > 0; c++) out->inward[c] /= sum;
}

// ---- A surfel

void independent_project(const independent_scene *scene, const independent_surfel *surfel,
                         independent_splat *s) {
    const ewa_camera *camera = &scene->camera;
    const ewa_render_options *options = &scene->options;
    *s = (independent_splat){.orthographic = camera->projection == EWA_ORTHOGRAPHIC,
                             .kernel = options->kernel,
                             .cutoff = (real)scene->cutoff,
                             .prefilter = (real)options->prefilter_px,
                             .fx = (real)camera->fx_px,
                             .fy = (real)camera->fy_px,
                             .cx = (real)camera->cx_px,
                             .cy = (real)camera->cy_px,
                             .dropped = true};
    real3 u = real3_of(surfel->axis_u), v = real3_of(surfel->axis_v), n = real3_of(surfel->normal);
    const real scale = (real)scene->radius_scale;
    if (surfel->disc) {
        n = real3_unit(n);
        const real3 other = fabsl(n.x) < 0.5L ? (real3){1, 0, 0} : (real3){0, 1, 0};
        const real sigma = (real)surfel->radius * scale / s->cutoff;
        u = real3_times(real3_unit(real3_cross(n, other)), sigma);
        v = real3_cross(n, u);
    } else {
        u = real3_times(u, scale), v = real3_times(v, scale);
        const real3 across = real3_unit(real3_cross(u, v));
        n = real3_dot(across, n) < 0 ? real3_times(across, -1) : across;
    }
    s->p = through_camera(camera, real3_of(surfel->position), 1);
    s->u = through_camera(camera, u, 0), s->v = through_camera(camera, v, 0);
    s->n = real3_unit(through_camera(camera, n, 0));
    s->normal_world = n;
    s->half_range = s->cutoff * sqrtl(s->u.z * s->u.z + s->v.z * s->v.z);
    const real facing = s->orthographic ? s->n.z : real3_dot(s->n, s->p);
    if (s->orthographic ? s->p.z <= 0 : s->p.z + s->half_range <= 0) return;
    if (options->cull == EWA_CULL_BACK && facing >= 0) return;
    // A plane that is seen at a small angle makes much of errors of its normal.
    const real sine = larger(fabsl(facing) / (s->orthographic ? 1 : real3_length(s->p)), 1e-9L);
    const real longest = longer_axis(s->u, s->v);
    s->doubtful = sine < ANGLE_ERROR || (!s->orthographic && fabsl(s->p.z - NEAR_RATIO * s->half_range) <
                                                                 SIZE_ERROR * s->half_range);
    s->cutoff_band = SIZE_ERROR + 2 * ANGLE_ERROR / sine + 2 * AXIS_ERROR * aspect_of(s->u, s->v);
    s->depth_band = DEPTH_ERROR * fabsl(s->p.z) + ANGLE_ERROR / sine * s->cutoff * longest;
    s->back_facing = facing > 0;
    if (s->back_facing) s->n = real3_times(s->n, -1), s->normal_world = real3_times(n, -1);
    s->near = !s->orthographic && s->p.z <= NEAR_RATIO * s->half_range;
    if (s->near && fabsl(facing) < EDGE_ON * real3_length(s->p)) return;
    s->clip_count = surfel->clip_count, s->clip_either = surfel->clip_either;
    for (uint32_t k = 0; k < surfel->clip_count; k++)
        make_clip(s, surfel->clip[k], surfel->disc ? 1 : scale, s->clip[k]);
    make_depth(s, longest, options->passes == 1 ? 0 : (real)options->tolerance);
    s->box[0] = s->box[2] = -INFINITY, s->box[1] = s->box[3] = INFINITY;
    s->dropped = !s->near && !make_ellipse(s, longest);
}

/// A number with its derivatives by x and y.
typedef struct dual {
    real value, dx, dy;
} dual;

static dual dual_plus(dual a, dual b, real factor) {
    return (dual){a.value + factor * b.value, a.dx + factor * b.dx, a.dy + factor * b.dy};
}
static dual dual_times(dual a, dual b) {
    return (dual){a.value * b.value, a.dx * b.value + a.value * b.dx, a.dy * b.value + a.value * b.dy};
}
static dual dual_over(real a, dual b) {
    const real q = a / b.value;
    return (dual){q, -q * b.dx / b.value, -q * b.dy / b.value};
}
static dual dual_dot(const dual a[3], real3 b) {
    const dual zero = {0, 0, 0};
    return dual_plus(dual_plus(dual_plus(zero, a[0], b.x), a[1], b.y), a[2], b.z);
}

/// A near surfel: the pixel's ray meets its plane.
static bool evaluate_ray(const independent_splat *s, real x, real y, real *r2, independent_fragment *out) {
    const dual ray[3] = {{(x - s->cx) / s->fx, 1 / s->fx, 0}, {(y - s->cy) / s->fy, 0, 1 / s->fy}, {1, 0, 0}};
    const dual z = dual_over(real3_dot(s->n, s->p), dual_dot(ray, s->n));
    if (!(z.value > 0) || !isfinite(z.value)) return false;
    const real uu = real3_dot(s->u, s->u), uv = real3_dot(s->u, s->v), vv = real3_dot(s->v, s->v);
    dual along_u = dual_times(z, dual_dot(ray, s->u)), along_v = dual_times(z, dual_dot(ray, s->v));
    along_u.value -= real3_dot(s->p, s->u), along_v.value -= real3_dot(s->p, s->v);
    // q = a u + b v by the Gram matrix.
    const dual zero = {0, 0, 0};
    const real gram = uu * vv - uv * uv;
    const dual a = dual_plus(dual_plus(zero, along_u, vv / gram), along_v, -uv / gram);
    const dual b = dual_plus(dual_plus(zero, along_v, uu / gram), along_u, -uv / gram);
    const real distance2 = a.value * a.value + b.value * b.value, maximum = 4 * s->cutoff * s->cutoff;
    out->doubtful = fabsl(distance2 - maximum) < s->cutoff_band * maximum;
    if (!(distance2 < maximum)) return false;
    const real h2 = s->prefilter * s->prefilter;
    const real W11 = 1 + h2 * (a.dx * a.dx + a.dy * a.dy), W22 = 1 + h2 * (b.dx * b.dx + b.dy * b.dy);
    const real W12 = h2 * (a.dx * b.dx + a.dy * b.dy), W = W11 * W22 - W12 * W12;
    *r2 = (a.value * a.value * W22 - 2 * a.value * b.value * W12 + b.value * b.value * W11) / W;
    out->weight = expl(-*r2 / 2) / (TWO_PI * sqrtl(W));
    out->z = clamped(z.value, s->p.z - s->half_range, s->p.z + s->half_range);
    return true;
}

/// The source kernel: the pixel goes back to the plane by J^-1.
static void evaluate_source(const independent_splat *s, real dx, real dy, real *r2,
                            independent_fragment *out) {
    const real(*J)[2] = s->jacobian, d = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    const real inverse[2][2] = {{J[1][1] / d, -J[0][1] / d}, {-J[1][0] / d, J[0][0] / d}};
    const real a = dx * inverse[0][0] + dy * inverse[1][0], b = dx * inverse[0][1] + dy * inverse[1][1];
    const real h2 = s->prefilter * s->prefilter;
    const real W11 = 1 + h2 * (inverse[0][0] * inverse[0][0] + inverse[1][0] * inverse[1][0]);
    const real W12 = h2 * (inverse[0][0] * inverse[0][1] + inverse[1][0] * inverse[1][1]);
    const real W22 = 1 + h2 * (inverse[0][1] * inverse[0][1] + inverse[1][1] * inverse[1][1]);
    // |W| = |V'| / |V|, which does not cancel.
    const real W = 1 + h2 * (s->variance[0] + s->variance[2]) / s->determinant + h2 * h2 / s->determinant;
    *r2 = (a * a * W22 - 2 * a * b * W12 + b * b * W11) / W;
    out->weight = expl(-*r2 / 2) / (TWO_PI * sqrtl(W));
}

void independent_evaluate(const independent_splat *s, real x, real y, independent_fragment *out) {
    *out = (independent_fragment){.counts = false, .share = 1};
    if (s->clip_count) clip_square(s, x, y, out);
    if (!(out->share > 0)) return;
    const real F2 = s->cutoff * s->cutoff;
    const bool raycast = s->kernel == EWA_KERNEL_RAYCAST && !s->orthographic;
    real r2;
    if (s->near) {
        if (!evaluate_ray(s, x, y, &r2, out)) return;
    } else {
        const real dx = x - s->center[0], dy = y - s->center[1];
        const real plane = s->key[0] * x + s->key[1] * y + s->key[2];
        if (s->kernel == EWA_KERNEL_SOURCE) {
            evaluate_source(s, dx, dy, &r2, out);
        } else {
            real w = 1, V[3], d;
            if (raycast)
                w = clamped(s->p.z * plane, s->p.z / (s->p.z + s->half_range),
                            s->p.z / (s->p.z - s->half_range));
            filtered(s, w, V, &d);
            r2 = (dx * dx * V[2] - 2 * dx * dy * V[1] + dy * dy * V[0]) / d;
            if (r2 < F2) out->weight = w * w * sqrtl(s->determinant / d) * expl(-r2 / 2) / TWO_PI;
        }
        const real key = clamped(plane, s->key_low, s->key_high);
        out->z = s->orthographic ? -key : 1 / key;
    }
    out->weight *= out->share;
    out->epsilon = s->epsilon;
    out->counts = r2 < F2;
    out->depth_band = s->depth_band;
    out->doubtful = out->doubtful || fabsl(r2 - F2) < s->cutoff_band * F2 || (s->doubtful && out->counts);
}
