// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras: checks, placement, intrinsics, framing of a box. Doubles throughout; + - * / and sqrt only, so
// that every machine computes the same camera.
#include "homogeneous/camera.h"
#include "base/base.h"
#include "base/format.h"
#include "homogeneous/vec.h"
#include "math/angle.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Relative deviation from a scaled rotation that ewa_camera_check() accepts: files carry rounded matrices.
static const double ROTATION_TOLERANCE = 1e-4;
/// An up direction within this sine of the view is taken as parallel to it.
static const double PARALLEL_SINE = 1e-9;
/// The nearest corner of a framed box stays this part of the box's diagonal in front of the eye.
static const double NEAREST_PART = 0.01;
/// A box seen along a thin side is framed, orthographically, as if it were this part of its diagonal wide.
static const double THINNEST_PART = 1e-3;
/// Relative slack of a framed camera, so that rounding leaves no corner beyond the margin.
static const double ROUNDING_SLACK = 1e-12;

static double dot(const double a[3], const double b[3]) { return vec3_dot(vec3_load(a), vec3_load(b)); }

static void cross(const double a[3], const double b[3], double out[3]) {
    vec3_store(vec3_cross(vec3_load(a), vec3_load(b)), out);
}

static bool finite3(const double v[3]) { return vec3_is_finite(vec3_load(v)); }

/// Scales to length 1; false, and unchanged, for zero and for what is not finite.
static bool normalise(double v[3]) {
    ewa_vec3 unit = vec3_load(v);
    const bool done = vec3_normalize(&unit);
    vec3_store(unit, v);
    return done;
}

/// Rows right, down, forward of the rotation that looks along `forward` (length 1).
static bool orient(const double forward[3], const double up_world[3], double rows[3][3]) {
    double up[3] = {up_world[0], up_world[1], up_world[2]}, right[3];
    if (!finite3(up)) return false;
    const bool has_up = normalise(up);
    if (has_up) cross(forward, up, right);
    if (!has_up || dot(right, right) < PARALLEL_SINE * PARALLEL_SINE) {
        // The axis that is farthest from the view; y before z before x, so that a map seen from above has
        // north up.
        int axis = 1;
        if (fabs(forward[2]) < fabs(forward[axis])) axis = 2;
        if (fabs(forward[0]) < fabs(forward[axis])) axis = 0;
        const double replacement[3] = {axis == 0, axis == 1, axis == 2};
        cross(forward, replacement, right);
    }
    normalise(right);
    memcpy(rows[0], right, sizeof right);
    cross(forward, right, rows[1]);
    memcpy(rows[2], forward, 3 * sizeof *forward);
    return true;
}

/// Sets world_to_camera from rotation rows and the translation -R eye.
static bool place(ewa_camera *camera, double rows[3][3], const double eye_world[3]) {
    double matrix[16] = {0};
    for (int r = 0; r < 3; r++) {
        memcpy(&matrix[4 * r], rows[r], 3 * sizeof(double));
        matrix[4 * r + 3] = -dot(rows[r], eye_world);
        if (!isfinite(matrix[4 * r + 3])) return false;
    }
    matrix[15] = 1;
    memcpy(camera->world_to_camera, matrix, sizeof matrix);
    return true;
}

static void centre_principal_point(ewa_camera *camera) {
    camera->cx_px = 0.5 * camera->width_px;
    camera->cy_px = 0.5 * camera->height_px;
}

/// One axis of the picture inside the margin, in camera units at distance 1 (perspective) or at any
/// (orthographic): the middle is where the middle of the box goes, `reach` is how far from there the side is.
typedef struct window {
    double middle, reach;
} window;

static window inner_window(double size_px, double principal_px, double focal_px, double margin) {
    return (window){(0.5 * size_px - principal_px) / focal_px, (0.5 - margin) * size_px / focal_px};
}

/// The smallest distance of the box's middle at which a corner at (x, z) from the middle is between both
/// sides: the sides are the planes x + middle d = (middle +- reach) (z + d).
static double min_distance(window side, double x, double z) {
    const double over_high = x - (side.middle + side.reach) * z,
                 over_low = (side.middle - side.reach) * z - x;
    return fmax(over_high, over_low) / side.reach;
}

/// Half the box's extents with what a corner may lose by rounding on its way to the picture; false for an
/// empty box.
static bool measure_box(const ewa_bounds *bounds, double middle_world[3], double half_world[3]) {
    double largest_half = 0, largest_coordinate = 0;
    for (int i = 0; i < 3; i++) {
        const double low = bounds->low_world[i], high = bounds->high_world[i];
        if (!(low <= high)) return false;
        middle_world[i] = 0.5 * low + 0.5 * high;
        half_world[i] = 0.5 * high - 0.5 * low;
        largest_half = fmax(largest_half, half_world[i]);
        largest_coordinate = fmax(largest_coordinate, fmax(fabs(low), fabs(high)));
    }
    for (int i = 0; i < 3; i++) {
        if (largest_half == 0) half_world[i] = 0.5;
        half_world[i] += 8 * DBL_EPSILON * largest_coordinate;
    }
    return finite3(middle_world) && finite3(half_world);
}

void ewa_camera_init(ewa_camera *camera) {
    if (!camera) return;
    memset(camera, 0, sizeof *camera);
    camera->width_px = 1280;
    camera->height_px = 720;
    for (int i = 0; i < 4; i++) camera->world_to_camera[5 * i] = 1;
    ewa_camera_set_fov(camera, 50);
}

static bool complain(char text[EWA_CAMERA_PROBLEM_BYTES], const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool complain(char text[EWA_CAMERA_PROBLEM_BYTES], const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    ewa_format_list(text, EWA_CAMERA_PROBLEM_BYTES, format, arguments);
    va_end(arguments);
    return true;
}

static bool find_matrix_problem(const double m[16], char text[EWA_CAMERA_PROBLEM_BYTES]) {
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i])) return complain(text, "world_to_camera[%d] is %g", i, m[i]);
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
        return complain(text, "world_to_camera's last row is %g %g %g %g, not 0 0 0 1", m[12], m[13], m[14],
                        m[15]);
    const double square = (dot(&m[0], &m[0]) + dot(&m[4], &m[4]) + dot(&m[8], &m[8])) / 3;
    double deviation = 0, normal[3];
    for (int r = 0; r < 3; r++)
        for (int c = r; c < 3; c++)
            deviation = fmax(deviation, fabs(dot(&m[4 * r], &m[4 * c]) - (r == c ? square : 0)));
    if (!(square >= DBL_MIN) || !isfinite(square) || !(deviation <= ROTATION_TOLERANCE * square))
        return complain(text,
                        "world_to_camera's upper left 3x3 is not a rotation times a scale (off by %g of %g)",
                        deviation, square);
    cross(&m[0], &m[4], normal);
    if (!(dot(normal, &m[8]) > 0))
        return complain(text, "world_to_camera mirrors (determinant %g)", dot(normal, &m[8]));
    return false;
}

bool ewa_camera_find_problem(const ewa_camera *camera, char text[EWA_CAMERA_PROBLEM_BYTES]) {
    if (camera->projection != EWA_PERSPECTIVE && camera->projection != EWA_ORTHOGRAPHIC)
        return complain(text, "projection is %d", (int)camera->projection);
    if (camera->width_px < 1 || camera->height_px < 1 || camera->width_px > EWA_CAMERA_MAX_SIDE_PX ||
        camera->height_px > EWA_CAMERA_MAX_SIDE_PX)
        return complain(text, "width_px x height_px is %u x %u (1 to %d allowed)", camera->width_px,
                        camera->height_px, EWA_CAMERA_MAX_SIDE_PX);
    if (!(camera->fx_px > 0) || !(camera->fy_px > 0) || !isfinite(camera->fx_px) || !isfinite(camera->fy_px))
        return complain(text, "fx_px, fy_px is %g, %g (positive and finite wanted)", camera->fx_px,
                        camera->fy_px);
    if (!isfinite(camera->cx_px) || !isfinite(camera->cy_px))
        return complain(text, "cx_px, cy_px is %g, %g (finite wanted)", camera->cx_px, camera->cy_px);
    return find_matrix_problem(camera->world_to_camera, text);
}

ewa_status ewa_camera_check(ewa_context *context, const ewa_camera *camera) {
    if (!context || !camera) return EWA_ERROR_ARGUMENT;
    char text[EWA_CAMERA_PROBLEM_BYTES];
    if (!ewa_camera_find_problem(camera, text)) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "camera: %s", text);
}

ewa_status ewa_camera_look_at(ewa_camera *camera, const double eye_world[3], const double target_world[3],
                              const double up_world[3]) {
    if (!camera || !eye_world || !target_world || !up_world) return EWA_ERROR_ARGUMENT;
    double forward[3], rows[3][3];
    for (int i = 0; i < 3; i++) forward[i] = target_world[i] - eye_world[i];
    if (!finite3(eye_world) || !normalise(forward) || !orient(forward, up_world, rows) ||
        !place(camera, rows, eye_world))
        return EWA_ERROR_NUMERIC;
    return EWA_OK;
}

ewa_status ewa_camera_set_fov(ewa_camera *camera, double vertical_fov_deg) {
    if (!camera || !(vertical_fov_deg > 0 && vertical_fov_deg < 180)) return EWA_ERROR_ARGUMENT;
    const double focal_px = 0.5 * camera->height_px / ewa_tan(vertical_fov_deg * (EWA_PI / 360));
    if (!(focal_px > 0) || !isfinite(focal_px)) return EWA_ERROR_NUMERIC;
    camera->projection = EWA_PERSPECTIVE;
    camera->fx_px = camera->fy_px = focal_px;
    centre_principal_point(camera);
    return EWA_OK;
}

ewa_status ewa_camera_set_ortho(ewa_camera *camera, double height_world) {
    if (!camera || !(height_world > 0) || !isfinite(height_world)) return EWA_ERROR_ARGUMENT;
    const double scale = camera->height_px / height_world;
    if (!(scale > 0) || !isfinite(scale)) return EWA_ERROR_NUMERIC;
    camera->projection = EWA_ORTHOGRAPHIC;
    camera->fx_px = camera->fy_px = scale;
    centre_principal_point(camera);
    return EWA_OK;
}

void ewa_camera_resize(ewa_camera *camera, ewa_resize keeps, uint32_t width_px, uint32_t height_px) {
    if (!camera) return;
    const double down = (double)height_px / camera->height_px,
                 across = keeps == EWA_RESIZE_HEIGHT ? down : (double)width_px / camera->width_px;
    camera->fx_px *= across;
    camera->fy_px *= down;
    // From the middle, so that a principal point that is there stays there to the last bit.
    camera->cx_px = 0.5 * width_px + (camera->cx_px - 0.5 * camera->width_px) * across;
    camera->cy_px = 0.5 * height_px + (camera->cy_px - 0.5 * camera->height_px) * down;
    camera->width_px = width_px;
    camera->height_px = height_px;
}

void ewa_camera_eye(const ewa_camera *camera, double eye_world[3]) {
    const double *m = camera->world_to_camera;
    const double square = (dot(&m[0], &m[0]) + dot(&m[4], &m[4]) + dot(&m[8], &m[8])) / 3;
    for (int i = 0; i < 3; i++) eye_world[i] = -(m[i] * m[3] + m[4 + i] * m[7] + m[8 + i] * m[11]) / square;
}

ewa_status ewa_camera_frame(ewa_camera *camera, const ewa_bounds *bounds, const double direction_world[3],
                            const double up_world[3], double margin) {
    if (!camera || !bounds || !direction_world || !up_world || !(margin >= 0 && margin < 0.5) ||
        camera->width_px == 0 || camera->height_px == 0 || !(camera->fx_px > 0) || !(camera->fy_px > 0))
        return EWA_ERROR_ARGUMENT;
    double middle[3], half[3], forward[3], rows[3][3];
    memcpy(forward, direction_world, sizeof forward);
    if (!measure_box(bounds, middle, half) || !normalise(forward) || !orient(forward, up_world, rows))
        return EWA_ERROR_NUMERIC;
    const window x_side = inner_window(camera->width_px, camera->cx_px, camera->fx_px, margin);
    const window y_side = inner_window(camera->height_px, camera->cy_px, camera->fy_px, margin);
    const double diagonal = 2 * sqrt(dot(half, half));
    double distance = 0, nearest = 0, x_reach = 0, y_reach = 0;
    for (int corner = 0; corner < 8; corner++) {
        double offset[3], q[3]; // from the middle of the box, in the world and in camera axes
        for (int i = 0; i < 3; i++) offset[i] = corner >> i & 1 ? half[i] : -half[i];
        for (int i = 0; i < 3; i++) q[i] = dot(rows[i], offset);
        distance = fmax(distance, fmax(min_distance(x_side, q[0], q[2]), min_distance(y_side, q[1], q[2])));
        nearest = fmax(nearest, -q[2]);
        x_reach = fmax(x_reach, q[0]);
        y_reach = fmax(y_reach, q[1]);
    }
    ewa_camera framed = *camera;
    double scale = 1; // of the picture, orthographic
    if (camera->projection == EWA_PERSPECTIVE) {
        distance = fmax(distance, nearest + NEAREST_PART * diagonal) * (1 + ROUNDING_SLACK);
    } else {
        const double min_reach = THINNEST_PART * diagonal;
        scale = fmin(x_side.reach / fmax(x_reach, min_reach), y_side.reach / fmax(y_reach, min_reach));
        scale *= 1 - ROUNDING_SLACK;
        distance = diagonal;
        framed.fx_px *= scale;
        framed.fy_px *= scale;
    }
    const double per_slope = camera->projection == EWA_PERSPECTIVE ? distance : 1 / scale;
    double eye[3];
    for (int i = 0; i < 3; i++)
        eye[i] = middle[i] - per_slope * (x_side.middle * rows[0][i] + y_side.middle * rows[1][i]) -
                 distance * rows[2][i];
    if (!finite3(eye) || !(framed.fx_px > 0) || !(framed.fy_px > 0) || !place(&framed, rows, eye))
        return EWA_ERROR_NUMERIC;
    *camera = framed;
    return EWA_OK;
}
