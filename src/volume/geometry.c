// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A camera's view of the voxels of one grid.
#include "volume/geometry.h"
#include "volume/classify.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/// Camera space of a world direction.
static ewa_vec3 turn(const double *m, ewa_vec3 v) {
    return vec3_make(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                     m[8] * v.x + m[9] * v.y + m[10] * v.z);
}

void ewa_grid_view_make(ewa_grid_view *view, const double index_to_world[12], const ewa_camera *camera,
                        const ewa_volume_options *options) {
    const double *to_camera = camera->world_to_camera, sigma = options->sigma;
    ewa_grid_view v = {.orthographic = camera->projection == EWA_ORTHOGRAPHIC,
                       .fx_px = camera->fx_px,
                       .fy_px = camera->fy_px,
                       .cx_px = camera->cx_px,
                       .cy_px = camera->cy_px,
                       .kernel_steps = sigma,
                       .cutoff = options->cutoff,
                       .cutoff2 = options->cutoff * options->cutoff,
                       .prefilter2_px2 = options->prefilter_px * options->prefilter_px};
    double squares = 0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            squares += to_camera[4 * row + column] * to_camera[4 * row + column];
    v.scale = sqrt(squares / 3);
    for (int axis = 0; axis < 3; axis++) {
        const ewa_vec3 step = turn(
            to_camera, vec3_make(index_to_world[axis], index_to_world[4 + axis], index_to_world[8 + axis]));
        vec3_store(step, v.axes.m[axis]);
        v.longest_step = fmax(v.longest_step, vec3_length(step));
    }
    v.origin = vec3_add(turn(to_camera, ewa_volume_place(index_to_world, 0, 0, 0)),
                        vec3_make(to_camera[3], to_camera[7], to_camera[11]));
    const ewa_mat3 transposed = mat3_transpose(&v.axes), product = mat3_multiply(&transposed, &v.axes);
    v.covariance = mat3_scale(&product, sigma * sigma);
    const double cell = fabs(mat3_determinant(&v.axes)), spread = sigma * sigma * sigma * cell;
    const ewa_mat3 adjugate = mat3_adjugate(&v.covariance);
    v.inverse = mat3_scale(&adjugate, 1 / (spread * spread));
    v.depth_sigma = sqrt(v.covariance.m[2][2]);
    v.mean_variance = (v.covariance.m[0][0] + v.covariance.m[1][1] + v.covariance.m[2][2]) / 3;
    v.near = v.orthographic ? 0 : v.cutoff * v.depth_sigma;
    v.whole = 1 / (1 - exp(-v.cutoff2 / 2));
    // Extinctions are per world unit: divided by the scale they are per camera unit.
    v.point_mass = cell * v.fx_px * v.fy_px / v.scale;
    v.splat_peak = cell / (2 * PI * spread) / v.scale * v.whole;
    *view = v;
}
