// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A camera's view of the voxels of one grid (docs/math.md sections 2 and 12).
#include "volume/geometry.h"
#include "volume/classify.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/// Turns a world direction into the camera's.
static ewa_vec3 turn(const double *m, ewa_vec3 v) {
    return vec3_make(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                     m[8] * v.x + m[9] * v.y + m[10] * v.z);
}

static ewa_vec3 divide(double x, double y, double z, double by) { return vec3_make(x / by, y / by, z / by); }

/// Steps and origin in units of the grid. What is divided is divided first: products might leave the range of
/// doubles.
static void place_grid(ewa_grid_view *v, const double m[12], double spacing_world, const double *to_camera) {
    double squares = 0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            squares += to_camera[4 * row + column] * to_camera[4 * row + column];
    v->scale = sqrt(squares / 3);
    v->unit_camera = spacing_world * v->scale;
    for (int axis = 0; axis < 3; axis++) {
        const ewa_vec3 step_units = divide(m[axis], m[4 + axis], m[8 + axis], spacing_world);
        const ewa_vec3 step = vec3_scale(turn(to_camera, step_units), 1 / v->scale);
        vec3_store(step, v->axes.m[axis]);
        v->longest_step = fmax(v->longest_step, vec3_length(step));
    }
    const ewa_vec3 first_units = divide(m[3], m[7], m[11], spacing_world);
    const ewa_vec3 moved = divide(to_camera[3], to_camera[7], to_camera[11], spacing_world);
    v->origin = vec3_scale(vec3_add(turn(to_camera, first_units), moved), 1 / v->scale);
}

void ewa_grid_view_make(ewa_grid_view *view, const double index_to_world[12], double spacing_world,
                        const ewa_camera *camera, const ewa_volume_options *options) {
    const double sigma = options->sigma;
    ewa_grid_view v = {.orthographic = camera->projection == EWA_ORTHOGRAPHIC,
                       .fx_px = camera->fx_px,
                       .fy_px = camera->fy_px,
                       .cx_px = camera->cx_px,
                       .cy_px = camera->cy_px,
                       .kernel_steps = sigma,
                       .cutoff = options->cutoff,
                       .cutoff2 = options->cutoff * options->cutoff,
                       .prefilter2_px2 = options->prefilter_px * options->prefilter_px};
    place_grid(&v, index_to_world, spacing_world, camera->world_to_camera);
    if (v.orthographic) v.fx_px *= v.unit_camera, v.fy_px *= v.unit_camera;
    const ewa_mat3 transposed = mat3_transpose(&v.axes), product = mat3_multiply(&transposed, &v.axes);
    v.covariance = mat3_scale(&product, sigma * sigma);
    const double determinant = mat3_determinant(&v.axes), cell = fabs(determinant);
    const double spread = sigma * sigma * sigma * cell;
    const ewa_mat3 adjugate = mat3_adjugate(&v.covariance), across = mat3_adjugate(&v.axes);
    v.inverse = mat3_scale(&adjugate, 1 / (spread * spread));
    v.to_steps = mat3_scale(&across, 1 / determinant);
    v.eye_steps = vec3_scale(vec3_mul_mat3(v.origin, &v.to_steps), -1);
    // Half of 1 / D, for an eye at D = height / (2 tan 20 degrees).
    v.bend = v.orthographic ? 0.36397023426620234 * v.fy_px / camera->height_px : 0;
    v.depth_sigma = sqrt(v.covariance.m[2][2]);
    v.mean_variance = (v.covariance.m[0][0] + v.covariance.m[1][1] + v.covariance.m[2][2]) / 3;
    v.near = v.orthographic ? 0 : v.cutoff * v.depth_sigma;
    v.whole = 1 / (1 - exp(-v.cutoff2 / 2));
    v.point_mass = cell * v.fx_px * v.fy_px;
    v.splat_peak = cell / (2 * PI * spread) * v.whole;
    *view = v;
}
