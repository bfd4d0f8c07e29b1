// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The reference renderer of trained Gaussians: every pixel's list in double precision, sorted, composited. It
// is the definition of what ewa_gaussian_render() draws; docs/math.md section 12 is its specification.
//
// Based on: B. Kerbl, G. Kopanas, T. Leimkuehler, G. Drettakis, "3D Gaussian Splatting for Real-Time Radiance
// Field Rendering", 2023, section 4 and its program (the trained projection); L. Radl et al., "StopThePop",
// 2024 (order by the depth of greatest density along a ray).
//
// Nothing of src/volume is used here, which this judges: the camera and the limits are its own.
#include "reference/gaussian.h"
#include "base/base.h"
#include "base/options.h"
#include "homogeneous/vec.h"
#include "image/srgb.h"
#include "math/ellipse.h"
#include "reference/section.h"
#include "surface/options.h"

#include <stdlib.h>
#include <string.h>

/// A Gaussian whose centre is within so many of its depth half ranges of the eye's plane is met ray by ray.
static const double NEAR_REACHES = 1.05;

/// No Gaussian takes more of the light.
static const double MAX_ALPHA = 0.99;

/// What the filter leaves of a Gaussian's height is at least the root of that.
static const double MIN_KEPT = 2.5e-5;

/// A shorter scale counts as at least that much of the longest one.
static const double MIN_ASPECT = 1e-4;

/// Camera space in world units: turned and moved as the camera says, but not scaled.
typedef struct view {
    bool orthographic, trained, by_center, keep;
    bool flat;                         ///< as 2DGS trains
    double fx_px, fy_px, cx_px, cy_px; ///< orthographic: pixels per world unit
    double scale;                      ///< of camera space over world units
    ewa_mat3 turn;                     ///< column vectors of the world to camera space
    ewa_vec3 origin;                   ///< that of the set in camera space
    ewa_vec3 eye;                      ///< perspective: from the set's origin, world axes
    ewa_vec3 forward;                  ///< world axes
    double slopes[4];                  ///< where the affine map's Jacobian is held: left, right, top, bottom
    double near;                       ///< of centres
} view;

/// A Gaussian on the screen.
typedef struct splat {
    uint32_t number;
    ewa_vec3 place;   ///< camera space, world units
    ewa_mat3 inverse; ///< of its covariance
    double depth_reach, cutoff2, alpha;
    double color[3]; ///< display values
    double facing[3]; ///< the shortest axis, turned to the eye, world axes
    bool near;       ///< ray by ray
    double center_px[2], conic[3], reach_px[2];
    double unfilter[2][2]; ///< from offsets in the filtered ellipse to those in the true one
    ewa_vec3 tangents[2], normal; ///< of a trained 2D Gaussian: in standard deviations; unit
    double dot_px[2];             ///< the middle of its dot, NaN: it has none
} splat;

/// A Gaussian in a pixel.
typedef struct hit {
    uint32_t x, splat;
    double z, key, alpha;
    double ahead;     ///< of alpha: in front of the surface
    double deviation; ///< in depth, along the ray
} hit;

typedef struct reference {
    const ewa_gaussians *set;
    ewa_gaussian_options options;
    ewa_camera given;
    view camera;
    uint32_t width_px, height_px;
    ewa_frame frame;
    splat *splats;
    uint32_t splat_count;
    ewa_buffer hits;
} reference;

static view make_view(const ewa_camera *camera, const ewa_gaussian_options *options,
                      const ewa_gaussians *set) {
    const double *m = camera->world_to_camera;
    view made = {.orthographic = camera->projection == EWA_ORTHOGRAPHIC,
                 .keep = options->filter == EWA_FILTER_KEEP ||
                         (options->filter == EWA_FILTER_OF_SET && set->antialiased),
                 .scale = sqrt((m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[4] * m[4] + m[5] * m[5] +
                                m[6] * m[6] + m[8] * m[8] + m[9] * m[9] + m[10] * m[10]) /
                               3),
                 .fx_px = camera->fx_px,
                 .fy_px = camera->fy_px,
                 .cx_px = camera->cx_px,
                 .cy_px = camera->cy_px};
    made.trained = made.orthographic || options->projection == EWA_PROJECTION_TRAINED;
    made.flat = set->flat && options->projection == EWA_PROJECTION_TRAINED && options->filter == EWA_FILTER_OF_SET;
    made.by_center = options->order == EWA_ORDER_CENTER;
    if (options->order == EWA_ORDER_OF_PROJECTION) made.by_center = options->projection == EWA_PROJECTION_TRAINED;
    double origin[3];
    for (int row = 0; row < 3; row++) {
        const double *at = m + 4 * row, *o = set->origin;
        for (int column = 0; column < 3; column++) made.turn.m[row][column] = at[column] / made.scale;
        origin[row] = (at[0] * o[0] + at[1] * o[1] + at[2] * o[2] + at[3]) / made.scale;
    }
    made.origin = vec3_load(origin);
    made.forward = vec3_load(made.turn.m[2]);
    made.eye = vec3_scale(vec3_mul_mat3(made.origin, &made.turn), -1);
    if (made.orthographic) made.fx_px *= made.scale, made.fy_px *= made.scale;
    made.near = made.orthographic ? -INFINITY : made.trained ? options->near_world : 0;
    // 0.15 of the picture beyond each of its edges.
    const double width = camera->width_px, height = camera->height_px;
    made.slopes[0] = (-0.15 * width - camera->cx_px) / camera->fx_px;
    made.slopes[1] = (1.15 * width - camera->cx_px) / camera->fx_px;
    made.slopes[2] = (-0.15 * height - camera->cy_px) / camera->fy_px;
    made.slopes[3] = (1.15 * height - camera->cy_px) / camera->fy_px;
    return made;
}

/// Real spherical harmonics along a unit direction, in the order and with the signs of 3DGS.
static void harmonics_of(ewa_vec3 d, double y[25]) {
    const double x = d.x, v = d.y, z = d.z, xx = x * x, yy = v * v, zz = z * z;
    const double values[25] = {
        0.28209479177387814,
        -0.4886025119029199 * v,
        0.4886025119029199 * z,
        -0.4886025119029199 * x,
        1.0925484305920792 * x * v,
        -1.0925484305920792 * v * z,
        0.31539156525252005 * (2 * zz - xx - yy),
        -1.0925484305920792 * x * z,
        0.5462742152960396 * (xx - yy),
        -0.5900435899266435 * v * (3 * xx - yy),
        2.890611442640554 * x * v * z,
        -0.4570457994644658 * v * (4 * zz - xx - yy),
        0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
        -0.4570457994644658 * x * (4 * zz - xx - yy),
        1.445305721320277 * z * (xx - yy),
        -0.5900435899266435 * x * (xx - 3 * yy),
        2.5033429417967046 * x * v * (xx - yy),
        -1.7701307697799304 * v * z * (3 * xx - yy),
        0.9461746957575601 * x * v * (7 * zz - 1),
        -0.6690465435572892 * v * z * (7 * zz - 3),
        0.10578554691520431 * (zz * (35 * zz - 30) + 3),
        -0.6690465435572892 * x * z * (7 * zz - 3),
        0.47308734787878004 * (xx - yy) * (7 * zz - 1),
        -1.7701307697799304 * x * z * (xx - 3 * yy),
        0.6258357354491761 * (xx * (xx - 3 * yy) - yy * (3 * xx - yy)),
    };
    memcpy(y, values, sizeof values);
}

static ewa_vec3 load(const float v[3]) { return vec3_make((double)v[0], (double)v[1], (double)v[2]); }

static void set_color(const reference *work, const float *center, splat *made) {
    const view *camera = &work->camera;
    ewa_vec3 direction = camera->orthographic ? camera->forward : vec3_sub(load(center), camera->eye);
    vec3_normalize(&direction);
    double y[25];
    harmonics_of(direction, y);
    const uint32_t degree = work->set->sh_degree, side = degree + 1;
    const uint32_t used = work->options.sh_degree < degree ? work->options.sh_degree + 1 : side;
    const float *from = work->set->harmonics + 3 * (size_t)(side * side) * made->number;
    for (uint32_t c = 0; c < 3; c++) {
        double sum = 0.5;
        for (uint32_t k = 0; k < used * used; k++) sum += y[k] * (double)from[3 * k + c];
        made->color[c] = fmax(sum, 0);
    }
}

/// Axes in camera space, unit, and standard deviations along them.
static void axes_of(const reference *work, uint32_t number, ewa_vec3 axes[3], double scales[3]) {
    const float *s = work->set->scales + 3 * (size_t)number, *q = work->set->rotations + 4 * (size_t)number;
    const double w = (double)q[0], x = (double)q[1], y = (double)q[2], z = (double)q[3];
    const ewa_vec3 world[3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
    };
    const double longest = fmax(fmax((double)s[0], (double)s[1]), (double)s[2]);
    const ewa_mat3 turn = mat3_transpose(&work->camera.turn);
    for (int i = 0; i < 3; i++) {
        axes[i] = vec3_mul_mat3(world[i], &turn);
        scales[i] = fmax((double)s[i], MIN_ASPECT * longest);
    }
}

/// Sum of a'a weight over three vectors.
static ewa_mat3 gram(const ewa_vec3 v[3], const double weights[3]) {
    ewa_mat3 sum = {{{0}}};
    for (int i = 0; i < 3; i++) {
        double a[3];
        vec3_store(v[i], a);
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 3; column++) sum.m[row][column] += weights[i] * a[row] * a[column];
    }
    return sum;
}

/// V in pixels and the ellipse's centre (docs/math.md section 3, sheared); `cutoff2` 0: the affine map.
static void project(const reference *work, const ewa_mat3 *s, ewa_vec3 p, double cutoff2, double v[3],
                    double center_px[2]) {
    const view *c = &work->camera;
    double shift[2] = {0, 0}, x = p.x, y = p.y;
    if (c->orthographic) {
        v[0] = s->m[0][0], v[1] = s->m[0][1], v[2] = s->m[1][1];
    } else {
        x /= p.z, y /= p.z;
        const double cx = c->trained ? fmin(fmax(x, c->slopes[0]), c->slopes[1]) : x;
        const double cy = c->trained ? fmin(fmax(y, c->slopes[2]), c->slopes[3]) : y;
        const double s13 = s->m[0][2] - cx * s->m[2][2], s23 = s->m[1][2] - cy * s->m[2][2];
        const double s11 = s->m[0][0] - 2 * cx * s->m[0][2] + cx * cx * s->m[2][2];
        const double s12 = s->m[0][1] - cx * s->m[1][2] - cy * s->m[0][2] + cx * cy * s->m[2][2];
        const double s22 = s->m[1][1] - 2 * cy * s->m[1][2] + cy * cy * s->m[2][2];
        const double k = 1 / (p.z * p.z - cutoff2 * s->m[2][2]);
        ewa_ellipse_project((const double[5]){s11, s12, s22, s13, s23}, k, cutoff2, v, shift);
    }
    v[0] *= c->fx_px * c->fx_px, v[1] *= c->fx_px * c->fy_px, v[2] *= c->fy_px * c->fy_px;
    center_px[0] = c->fx_px * (x + shift[0]) + c->cx_px, center_px[1] = c->fy_px * (y + shift[1]) + c->cy_px;
}

/// Lower triangle L with L L' = V.
static void cholesky(const double v[3], double l[3]) {
    l[0] = sqrt(fmax(v[0], 1e-24));
    l[1] = v[1] / l[0];
    l[2] = sqrt(fmax(v[2] - l[1] * l[1], 0));
}

static void set_ellipse(const reference *work, const ewa_mat3 *covariance, splat *made) {
    double v[3], l[3], m[3];
    project(work, covariance, made->place, work->camera.trained ? 0 : made->cutoff2, v, made->center_px);
    const double h2 = work->options.prefilter_px2;
    const double w[3] = {fmax(v[0] + h2, 1e-12), v[1], fmax(v[2] + h2, 1e-12)};
    const double area = fmax(v[0] * v[2] - v[1] * v[1], 0);
    const double filtered = fmax(area + h2 * (v[0] + v[2] + h2), 1e-24);
    made->conic[0] = w[2] / filtered, made->conic[1] = -w[1] / filtered, made->conic[2] = w[0] / filtered;
    made->reach_px[0] = sqrt(made->cutoff2 * w[0]), made->reach_px[1] = sqrt(made->cutoff2 * w[2]);
    if (work->camera.keep) made->alpha *= sqrt(fmax(area / filtered, MIN_KEPT));
    if (work->camera.trained) { // V V'^-1: the mean place of what the filter gathers there
        made->unfilter[0][0] = 1 - h2 * w[2] / filtered, made->unfilter[0][1] = h2 * w[1] / filtered;
        made->unfilter[1][0] = made->unfilter[0][1], made->unfilter[1][1] = 1 - h2 * w[0] / filtered;
        return;
    }
    cholesky(v, l);
    cholesky(w, m);
    made->unfilter[0][0] = l[0] / m[0], made->unfilter[0][1] = 0;
    made->unfilter[1][1] = l[2] / m[2];
    made->unfilter[1][0] = (l[1] - made->unfilter[1][1] * m[1]) / m[0];
}

/// Trained 2D Gaussians: in homogeneous pixels the point (s, t) of one is s a + t b + c. Sets what a dot of one has, and the
/// box of its outline and its dot (2DGS, equations 8 to 11, and the boxes of its program).
static void set_flat(const reference *work, const ewa_vec3 axes[3], const double scales[3], splat *made) {
    const view *camera = &work->camera;
    const double deviation = sqrt(work->options.prefilter_px2 * 0.5 / 0.3), reach = deviation * sqrt(made->cutoff2);
    double columns[3][3]; // of a, b, c
    for (int k = 0; k < 3; k++) {
        const ewa_vec3 at = k < 2 ? vec3_scale(axes[k], scales[k]) : made->place;
        const double depth = camera->orthographic ? k == 2 : at.z;
        columns[k][0] = camera->fx_px * at.x + camera->cx_px * depth;
        columns[k][1] = camera->fy_px * at.y + camera->cy_px * depth;
        columns[k][2] = depth;
        if (k < 2) made->tangents[k] = vec3_scale(axes[k], 1 / scales[k]);
    }
    made->normal = axes[2];
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int round = 0; round < 2; round++) { // where the dot is: 3 standard deviations; how far it shows
        const double weights[3] = {round ? made->cutoff2 : 9, round ? made->cutoff2 : 9, -1};
        double sums[2] = {0, 0}, squares[2] = {0, 0}, scale = 0;
        for (int k = 0; k < 3; k++) scale += weights[k] * columns[k][2] * columns[k][2];
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 2; axis++) {
                sums[axis] += weights[k] * columns[k][axis] * columns[k][2] / scale;
                squares[axis] += weights[k] * columns[k][axis] * columns[k][axis] / scale;
            }
        for (int axis = 0; axis < 2; axis++) {
            const double side = round ? sqrt(fmax(sums[axis] * sums[axis] - squares[axis], 0)) : reach;
            if (!round) made->dot_px[axis] = scale < 0 && deviation > 0 ? sums[axis] : NAN;
            if (scale < 0) low[axis] = fmin(low[axis], sums[axis] - side), high[axis] = fmax(high[axis], sums[axis] + side);
            if (round && !(scale < 0)) low[axis] = -INFINITY, high[axis] = INFINITY;
        }
    }
    for (int axis = 0; axis < 2; axis++) {
        const bool ends = isfinite(low[axis]);
        made->center_px[axis] = ends ? (low[axis] + high[axis]) / 2 : 0;
        made->reach_px[axis] = ends ? (high[axis] - low[axis]) / 2 : INFINITY;
    }
}

/// Sets the normal, of scales that are the same that of the third axis.
static void set_facing(const reference *work, const ewa_vec3 axes[3], const double scales[3], splat *made) {
    const view *camera = &work->camera;
    int shortest = 2;
    for (int k = 1; k >= 0; k--)
        if (scales[k] < scales[shortest]) shortest = k;
    const ewa_vec3 ray = camera->orthographic ? vec3_make(0, 0, 1) : made->place, axis = axes[shortest];
    vec3_store(vec3_scale(vec3_mul_mat3(axis, &camera->turn), vec3_dot(axis, ray) > 0 ? -1 : 1), made->facing);
}

static bool make_splat(const reference *work, uint32_t number, splat *made) {
    const view *camera = &work->camera;
    const float *center = work->set->centers + 3 * (size_t)number;
    const double opacity = fmin((double)work->set->opacities[number], 1);
    *made = (splat){.number = number, .alpha = opacity};
    made->cutoff2 = 2 * log(opacity / work->options.minimum_alpha);
    if (!(made->cutoff2 > 0)) return false;
    made->cutoff2 = fmin(made->cutoff2, work->options.cutoff * work->options.cutoff);
    const ewa_mat3 turn = mat3_transpose(&camera->turn);
    made->place = vec3_add(vec3_mul_mat3(load(center), &turn), camera->origin);
    ewa_vec3 axes[3];
    double scales[3], variances[3], inverses[3];
    axes_of(work, number, axes, scales);
    for (int i = 0; i < 3; i++) variances[i] = scales[i] * scales[i], inverses[i] = 1 / variances[i];
    const ewa_mat3 covariance = gram(axes, variances);
    made->inverse = gram(axes, inverses);
    made->depth_reach = sqrt(made->cutoff2 * covariance.m[2][2]);
    if (!(made->place.z + (camera->trained ? 0 : made->depth_reach) > camera->near)) return false;
    made->near = !camera->trained && made->place.z <= NEAR_REACHES * made->depth_reach;
    if (camera->flat)
        set_flat(work, axes, scales, made);
    else if (made->near)
        made->reach_px[0] = made->reach_px[1] = INFINITY;
    else
        set_ellipse(work, &covariance, made);
    if (made->alpha < work->options.minimum_alpha) return false;
    set_facing(work, axes, scales, made);
    set_color(work, center, made);
    return true;
}

/// How a ray passes a Gaussian.
typedef struct closest_point {
    double distance2; ///< Mahalanobis distance squared
    double z;         ///< where the density is greatest
    double deviation; ///< standard deviation along the ray, in depth
} closest_point;

/// The ray through a place on the screen.
static closest_point closest_to(const reference *work, const splat *at, double x_px, double y_px) {
    const view *c = &work->camera;
    const double x = (x_px - c->cx_px) / c->fx_px, y = (y_px - c->cy_px) / c->fy_px;
    const ewa_vec3 ray = c->orthographic ? vec3_make(0, 0, 1) : vec3_make(x, y, 1);
    // From the Gaussian to the ray, at its own depth.
    const ewa_vec3 from = c->orthographic ? vec3_make(x - at->place.x, y - at->place.y, 0)
                                          : vec3_sub(vec3_scale(ray, at->place.z), at->place);
    const double a = vec3_dot(ray, mat3_mul_vec3(&at->inverse, ray));
    const double b = vec3_dot(ray, mat3_mul_vec3(&at->inverse, from));
    const double d = vec3_dot(from, mat3_mul_vec3(&at->inverse, from));
    return (closest_point){fmax(d - b * b / a, 0), at->place.z - b / a, 1 / sqrt(a)};
}

/// The share of a Gaussian of a standard deviation around z that lies between two camera-space depths.
static double share_between(const reference *work, double z, double deviation, double enter, double leave) {
    const double scale = work->camera.scale, root = deviation * sqrt(2);
    return fmax(0.5 * erfc((z - leave / scale) / root) - 0.5 * erfc((z - enter / scale) / root), 0);
}

/// How the ray through a place on the screen crosses a trained 2D Gaussian, or meets its dot.
static closest_point cross(const reference *work, const splat *at, double x_px, double y_px) {
    const view *c = &work->camera;
    const double x = (x_px - c->cx_px) / c->fx_px, y = (y_px - c->cy_px) / c->fy_px;
    const ewa_vec3 ray = c->orthographic ? vec3_make(0, 0, 1) : vec3_make(x, y, 1);
    const ewa_vec3 from = c->orthographic ? vec3_make(x, y, 0) : vec3_make(0, 0, 0);
    closest_point by = closest_to(work, at, x_px, y_px); // for its deviation
    const double t = vec3_dot(vec3_sub(at->place, from), at->normal) / vec3_dot(ray, at->normal);
    const ewa_vec3 off = vec3_sub(vec3_add(from, vec3_scale(ray, t)), at->place);
    const double u = vec3_dot(off, at->tangents[0]), v = vec3_dot(off, at->tangents[1]);
    const double dx = x_px - at->dot_px[0], dy = y_px - at->dot_px[1];
    const double dot2 = (dx * dx + dy * dy) / (work->options.prefilter_px2 * 0.5 / 0.3);
    by.z = t, by.distance2 = t >= c->near ? u * u + v * v : INFINITY;
    if (!(by.distance2 <= dot2) && isfinite(dot2)) by.z = at->place.z, by.distance2 = dot2;
    return by;
}

/// Alpha and depth of a Gaussian at a pixel's centre; false outside of it.
static bool meet(const reference *work, const splat *at, uint32_t x, uint32_t y, hit *made) {
    const double x_px = x + 0.5, y_px = y + 0.5, dx = x_px - at->center_px[0], dy = y_px - at->center_px[1];
    const double true_x = at->center_px[0] + at->unfilter[0][0] * dx + at->unfilter[0][1] * dy;
    const double true_y = at->center_px[1] + at->unfilter[1][0] * dx + at->unfilter[1][1] * dy;
    const closest_point by = work->camera.flat ? cross(work, at, x_px, y_px)
                             : at->near        ? closest_to(work, at, x_px, y_px) : closest_to(work, at, true_x, true_y);
    double m2 = by.distance2;
    if (work->camera.trained && !work->camera.flat)
        m2 = at->conic[0] * dx * dx + 2 * at->conic[1] * dx * dy + at->conic[2] * dy * dy;
    if (m2 >= at->cutoff2 || (!work->camera.trained && by.z <= 0)) return false;
    double alpha = at->alpha * exp(-m2 / 2);
    if (work->camera.keep && !work->camera.flat && alpha < work->options.minimum_alpha) return false;
    alpha = fmin(alpha, MAX_ALPHA);
    const double z = fmin(fmax(by.z, at->place.z - at->depth_reach), at->place.z + at->depth_reach);
    double enter, leave, surface = INFINITY;
    ewa_reference_cut_ray(&work->given, (const double(*)[4])work->options.section_planes,
                          work->options.section_count, x_px, y_px, &enter, &leave);
    if (work->options.surface_depth)
        surface = (double)work->options.surface_depth[(size_t)y * work->width_px + x];
    const double all = share_between(work, z, by.deviation, enter, leave);
    const double ahead = share_between(work, z, by.deviation, enter, fmin(leave, surface));
    *made = (hit){
        .x = x, .splat = (uint32_t)(at - work->splats), .z = z, .alpha = alpha * all, .ahead = alpha * ahead, .deviation = by.deviation};
    made->key = work->camera.by_center ? at->place.z : z;
    return true;
}

static int by_depth(const void *a, const void *b) {
    const hit *s = a, *t = b;
    if (s->x != t->x) return s->x < t->x ? -1 : 1;
    if (s->key != t->key) return s->key < t->key ? -1 : 1;
    return s->splat < t->splat ? -1 : s->splat > t->splat;
}

/// All that the pixels of a row see, pixel by pixel, front to back.
static ewa_status gather_row(reference *work, uint32_t y, size_t *count) {
    *count = 0;
    const double middle = y + 0.5;
    for (const splat *at = work->splats; at < work->splats + work->splat_count; at++) {
        if (fabs(middle - at->center_px[1]) > at->reach_px[1]) continue;
        const double left = fmax(0, ceil(at->center_px[0] - at->reach_px[0] - 0.5));
        const double right = fmin(work->width_px, floor(at->center_px[0] + at->reach_px[0] - 0.5) + 1);
        if (!(left < right)) continue;
        EWA_TRY(ewa_buffer_grow(work->set->context, &work->hits, *count, *count + (size_t)(right - left),
                                sizeof(hit)));
        hit *hits = work->hits.data;
        for (double x = left; x < right; x++) *count += meet(work, at, (uint32_t)x, y, &hits[*count]);
    }
    if (*count) qsort(work->hits.data, *count, sizeof(hit), by_depth);
    return EWA_OK;
}

/// The sRGB curve and its inverse, going on above 1.
static double display_of_linear(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}
static double linear_of_display(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/// What a pixel, or a part of one, shows: premultiplied linear colour, and how much the Gaussians take of the light.
typedef struct shown {
    double color[4], opacity;
    double depth, normal[3]; ///< sums over the Gaussians, by how much each shows; world units
} shown;

/// The share of number i + 1 of a list that is in front of number i: up to half where they are nearer to each other than
/// either is to the next one, and one standard deviation of one meets one of the other.
static double share_in_front(const reference *work, const hit *hits, size_t count, size_t i) {
    if (work->camera.by_center || i + 1 >= count) return 0;
    double limit = hits[i].deviation + hits[i + 1].deviation;
    if (i > 0) limit = fmin(limit, hits[i].z - hits[i - 1].z);
    if (i + 2 < count) limit = fmin(limit, hits[i + 2].z - hits[i + 1].z);
    const double gap = hits[i + 1].z - hits[i].z;
    return limit > 0 ? 0.5 * fmax(1 - gap / limit, 0) : 0;
}

/// Composites a pixel's list over a straight linear colour; `ahead`: what lies in front of the surface.
static shown composite(const reference *work, const hit *hits, size_t count, bool ahead,
                       const double back[4]) {
    double color[3] = {0}, through = 1, before = 0; // the share of the last one that this one was in front of
    shown made = {.depth = 0};
    for (size_t i = 0; i < count; i++) {
        const double alpha = ahead ? hits[i].ahead : hits[i].alpha;
        const double last = i > 0 ? (ahead ? hits[i - 1].ahead : hits[i - 1].alpha) : 0;
        const double next = i + 1 < count ? (ahead ? hits[i + 1].ahead : hits[i + 1].alpha) : 0;
        const double behind = share_in_front(work, hits, count, i);
        const double weight = alpha * (1 - behind * next) * (through + before * last * through / (1 - last));
        const splat *at = &work->splats[hits[i].splat];
        for (int c = 0; c < 3; c++) color[c] += weight * at->color[c], made.normal[c] += weight * at->facing[c];
        made.depth += weight * hits[i].z;
        through *= 1 - alpha;
        before = behind;
    }
    made.opacity = 1 - through;
    made.color[3] = 1 - through + through * back[3];
    for (int c = 0; c < 3 && made.color[3] > 0; c++) {
        const double behind = display_of_linear(back[c]) * back[3];
        made.color[c] = linear_of_display((color[c] + through * behind) / made.color[3]) * made.color[3];
    }
    return made;
}

/// The depth at which half of the light is gone, in camera space: a Gaussian's in front of the surface, a Gaussian's
/// behind it, of the light that it leaves, else the surface's own.
static double find_depth(const reference *work, const hit *hits, size_t count, double own, double cover) {
    double ahead = 1, all = 1, before = INFINITY, behind = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const double z = hits[i].z * work->camera.scale;
        const double ahead_rest = ahead * (1 - hits[i].ahead), rest = all * (1 - hits[i].alpha);
        if (ahead > 0.5 && ahead_rest <= 0.5) before = z;
        if ((1 - cover) * all > 0.5 && (1 - cover) * rest <= 0.5) behind = z;
        ahead = ahead_rest, all = rest;
    }
    if (before < own) return before;
    return own < behind && behind < INFINITY ? behind : own;
}

/// Depth and normal of a pixel, of which a surface that lets `before` of the light through covers `cover`; `past`: what shows beside it.
static void write_geometry(const reference *work, size_t index, const hit *hits, size_t count, double cover, const shown *before,
                           const shown *past) {
    const ewa_gaussian_options *o = &work->options;
    const ewa_frame *frame = &work->frame;
    const double own = o->surface_depth ? (double)o->surface_depth[index] : INFINITY;
    const double covered = o->surface_coverage ? (double)o->surface_coverage[index] : cover;
    const double opacity = past->opacity + cover * (before->opacity - past->opacity);
    const double through = cover * (1 - before->opacity), shows = through + opacity;
    double depth = find_depth(work, hits, count, own, cover), normal[3], squares = 0;
    if (o->depth == EWA_DEPTH_EXPECTED) {
        const double sum = work->camera.scale * (cover * before->depth + (1 - cover) * past->depth);
        depth = opacity > 0 ? (sum + (cover > 0 ? through * own : 0)) / shows : own;
    }
    const bool kept = opacity == 0 || (o->depth == EWA_DEPTH_MEDIAN && depth == own && own < INFINITY);
    for (size_t c = 0; c < 3; c++) {
        const double surface = o->surface_normal ? (double)o->surface_normal[3 * index + c] : 0;
        normal[c] = cover * before->normal[c] + (1 - cover) * past->normal[c];
        if (o->depth == EWA_DEPTH_EXPECTED) normal[c] += through * surface;
        if (kept) normal[c] = surface;
        squares += normal[c] * normal[c];
    }
    if (frame->depth) frame->depth[index] = (float)depth;
    if (frame->coverage) frame->coverage[index] = (float)(covered + opacity * fmax(0, 1 - covered));
    for (size_t c = 0; c < 3 && frame->normal; c++)
        frame->normal[3 * index + c] = (float)(kept || squares == 0 ? normal[c] : normal[c] / sqrt(squares));
}

static void write_pixel(const reference *work, size_t index, const hit *hits, size_t count) {
    const float *background = work->options.background;
    const double behind[4] = {(double)background[0], (double)background[1], (double)background[2],
                              (double)background[3]};
    shown out = composite(work, hits, count, false, behind), covered = out;
    const shown past = out;
    double cover = 0;
    if (work->options.surface_rgba) {
        // The part that the surface covers, and the rest.
        const float *surface = work->options.surface_rgba + 4 * index;
        cover = (double)surface[3];
        const double own[4] = {cover > 0 ? (double)surface[0] / cover : 0,
                               cover > 0 ? (double)surface[1] / cover : 0,
                               cover > 0 ? (double)surface[2] / cover : 0, 1};
        covered = composite(work, hits, count, true, own);
        for (int c = 0; c < 4; c++) out.color[c] += cover * (covered.color[c] - out.color[c]);
    }
    const ewa_frame *frame = &work->frame;
    const double alpha = out.color[3];
    write_geometry(work, index, hits, count, cover, &covered, &past);
    for (size_t c = 0; c < 4 && frame->rgba; c++) frame->rgba[4 * index + c] = (float)out.color[c];
    for (size_t c = 0; c < 3 && frame->rgba8; c++)
        frame->rgba8[4 * index + c] = alpha > 0 ? ewa_srgb8_from_linear((float)(out.color[c] / alpha)) : 0;
    if (frame->rgba8) frame->rgba8[4 * index + 3] = (uint8_t)(255 * fmin(alpha, 1) + 0.5);
}

/// With `work` complete but for the memory.
static ewa_status render(reference *work) {
    ewa_context *context = work->set->context;
    work->splats = ewa_allocate(context, work->set->count, sizeof *work->splats);
    if (!work->splats) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < work->set->count; i++)
        work->splat_count += make_splat(work, i, &work->splats[work->splat_count]);
    ewa_status status = EWA_OK;
    for (uint32_t y = 0; y < work->height_px && status == EWA_OK; y++) {
        size_t count = 0, first = 0;
        status = ewa_progress(context, "reference", (double)y / work->height_px);
        if (status == EWA_OK) status = gather_row(work, y, &count);
        const hit *hits = work->hits.data;
        for (uint32_t x = 0; x < work->width_px && status == EWA_OK; x++) {
            size_t end = first;
            while (end < count && hits[end].x == x) end++;
            write_pixel(work, (size_t)y * work->width_px + x, hits + first, end - first);
            first = end;
        }
    }
    ewa_buffer_free(context, &work->hits);
    ewa_release(context, work->splats, work->set->count, sizeof *work->splats);
    return status;
}

ewa_status ewa_gaussian_render_reference(const ewa_gaussians *gaussians, const ewa_camera *camera,
                                         const ewa_gaussian_options *options, const ewa_frame *frame) {
    if (!gaussians || !gaussians->context || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = gaussians->context;
    reference work = {.set = gaussians, .frame = *frame, .given = *camera};
    ewa_gaussian_options_init(&work.options, sizeof work.options);
    EWA_TRY(ewa_options_take(context, &ewa_gaussian_options_table, options, &work.options));
    EWA_TRY(ewa_option_check_background(context, work.options.background));
    EWA_TRY(ewa_option_check_sections(context, (const double(*)[4])work.options.section_planes,
                                      work.options.section_count));
    EWA_TRY(ewa_camera_check(context, camera));
    work.width_px = camera->width_px, work.height_px = camera->height_px;
    work.camera = make_view(camera, &work.options, gaussians);
    return render(&work);
}
