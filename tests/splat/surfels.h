// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels and views for tests of single splats.
#ifndef EWA_TESTS_SPLAT_SURFELS_H
#define EWA_TESTS_SPLAT_SURFELS_H

#include "check.h"
#include "reference/splat.h"

static const double PI = 3.14159265358979323846;

/// A camera of 400x300 pixels that is not centred, with pixels that are not square.
static inline ewa_camera odd_camera(void) {
    ewa_camera camera = check_camera(400, 300);
    camera.fx_px = 310;
    camera.fy_px = 270;
    camera.cx_px = 190.3;
    camera.cy_px = 170.8;
    return camera;
}

static inline ewa_reference_view make_view(const ewa_camera *camera, double cutoff, double prefilter_px,
                                           ewa_kernel kernel) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.prefilter_px = prefilter_px;
    options.kernel = kernel;
    ewa_reference_view view;
    ewa_reference_view_make(camera, cutoff, &options, &view);
    return view;
}

static inline ewa_vec3 random_direction(check_random *random) {
    for (;;) {
        double numbers[3];
        check_uniform3(random, -1, 1, numbers);
        const ewa_vec3 v = vec3_load(numbers);
        const double length = vec3_length(v);
        if (length > 0.1 && length < 1) return vec3_scale(v, 1 / length);
    }
}

static inline void store(ewa_vec3 v, double to[3]) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static inline ewa_surfel make_surfel(ewa_vec3 center, ewa_vec3 u, ewa_vec3 v) {
    ewa_surfel surfel = {.color_linear = {1, 1, 1}, .alpha = 1};
    const ewa_vec3 n = vec3_cross(u, v);
    store(center, surfel.center);
    store(u, surfel.axis_u_world);
    store(v, surfel.axis_v_world);
    store(vec3_scale(n, 1 / vec3_length(n)), surfel.normal_world);
    return surfel;
}

/// An ellipse of random direction with axes of `sigma` and a part of it, somewhere within the picture at 2
/// to 20.
static inline ewa_surfel random_surfel(check_random *random, const ewa_camera *camera, double sigma) {
    const double z = check_uniform(random, 2, 20);
    const double y_px = check_uniform(random, 0, camera->height_px),
                 x_px = check_uniform(random, 0, camera->width_px);
    const ewa_vec3 center =
        vec3_make((x_px - camera->cx_px) / camera->fx_px * z, (y_px - camera->cy_px) / camera->fy_px * z, z);
    const ewa_vec3 n = random_direction(random);
    ewa_vec3 u = vec3_cross(n, random_direction(random));
    u = vec3_scale(u, sigma / vec3_length(u));
    return make_surfel(center, u, vec3_scale(vec3_cross(n, u), check_uniform(random, 0.1, 1)));
}

static inline ewa_vec3 on_disc(const ewa_reference_splat *splat, double u, double v) {
    return vec3_add(splat->center, vec3_add(vec3_scale(splat->axis_u, u), vec3_scale(splat->axis_v, v)));
}

static inline void to_pixel(const ewa_reference_view *view, ewa_vec3 p, double pixel[2]) {
    const double z = view->orthographic ? 1 : p.z;
    pixel[0] = view->fx_px * p.x / z + view->cx_px;
    pixel[1] = view->fy_px * p.y / z + view->cy_px;
}

static inline void assert_near(double a, double b, double tolerance) {
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is %.3g from %.17g, allowed %.3g", a, fabs(a - b), b, tolerance);
}

#endif
