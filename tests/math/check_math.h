// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Comparisons of homogeneous things, and random ones, for the tests of this room.
#ifndef EWA_TESTS_CHECK_MATH_H
#define EWA_TESTS_CHECK_MATH_H

#include "check.h"
#include "homogeneous/vec.h"

/// Fails unless |a - b| <= tolerance, with both values.
#define check_near(a, b, tolerance) check_near_at(a, b, tolerance, __FILE__, __LINE__)

static inline void check_near_at(double a, double b, double tolerance, const char *file, int line) {
    if (fabs(a - b) <= tolerance) return;
    print_error("%.17g and %.17g differ by more than %g\n", a, b, tolerance);
    _fail(file, line);
}

/// Fails unless two vectors of `count` numbers are multiples of each other: the same point, line or plane.
#define check_same(a, b, count, tolerance)                                                                   \
    check_same_at((const double *)(a), (const double *)(b), count, tolerance, __FILE__, __LINE__)

static inline void check_same_at(const double *a, const double *b, int count, double tolerance,
                                 const char *file, int line) {
    double aa = 0, bb = 0;
    for (int i = 0; i < count; i++) {
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    double worst = aa > 0 && bb > 0 ? 0 : INFINITY;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < i; j++) worst = fmax(worst, fabs(a[i] * b[j] - a[j] * b[i]) / sqrt(aa * bb));
    if (worst <= tolerance) return;
    print_error("not the same: ");
    for (int i = 0; i < count; i++) print_error("%.17g/%.17g ", a[i], b[i]);
    print_error("off by %g\n", worst);
    _fail(file, line);
}

static inline void check_vec3(ewa_vec3 a, double x, double y, double z, double tolerance) {
    check_near(a.x, x, tolerance);
    check_near(a.y, y, tolerance);
    check_near(a.z, z, tolerance);
}

static inline void check_vec4(ewa_vec4 a, double x, double y, double z, double w, double tolerance) {
    check_vec3(vec3_from_vec4(a), x, y, z, tolerance);
    check_near(a.w, w, tolerance);
}

/// Fails unless two tables of numbers (matrices) agree.
#define check_numbers(a, b, count, tolerance)                                                                \
    do {                                                                                                     \
        for (int check_i = 0; check_i < (count); check_i++)                                                  \
            check_near(((const double *)(a))[check_i], ((const double *)(b))[check_i], tolerance);           \
    } while (0)

/// The map of a camera at the origin that looks along z and sees `window` (x low, x high, y low, y high) on the
/// plane z = near_z, or in a box, of any range of depths.
static inline ewa_status check_window_map(const double window[4], double near_z, double far_z, bool box,
                                          ewa_mat4 *map) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    const double reach = box ? 1 : near_z;
    camera.projection = box ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
    camera.width_px = camera.height_px = 1024;
    camera.fx_px = 1024 / (window[1] - window[0]) * reach, camera.cx_px = -window[0] / reach * camera.fx_px;
    camera.fy_px = 1024 / (window[3] - window[2]) * reach, camera.cy_px = -window[2] / reach * camera.fy_px;
    for (int i = 0; i < 16; i++) camera.world_to_camera[i] = i % 5 == 0;
    return ewa_camera_clip_map(&camera, near_z, far_z, map);
}

static inline ewa_mat3 check_turn(double angle_rad) {
    const double c = cos(angle_rad), s = sin(angle_rad);
    return (ewa_mat3){{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
}

static inline ewa_vec3 check_random_vec3(check_random *random) {
    double v[3];
    check_uniform3(random, -1, 1, v);
    return vec3_load(v);
}

static inline ewa_vec4 check_random_vec4(check_random *random) {
    return vec4_from_vec3(check_random_vec3(random), check_uniform(random, -1, 1));
}

static inline ewa_mat3 check_random_mat3(check_random *random) {
    return mat3_from_rows(check_random_vec3(random), check_random_vec3(random), check_random_vec3(random));
}

static inline ewa_mat4 check_random_mat4(check_random *random) {
    return mat4_from_rows(check_random_vec4(random), check_random_vec4(random), check_random_vec4(random),
                          check_random_vec4(random));
}

#endif
