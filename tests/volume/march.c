// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rays marched in fine steps through the sum of all voxels' kernels.
#include "volume/march.h"

#include <math.h>
#include <stdint.h>

/// The sum of the kernels at an index, values times Gaussians of unit integral.
static double density(const march_scene *scene, const double at[3]) {
    const ewa_volume *volume = scene->volume;
    const double s2 = scene->sigma * scene->sigma, reach = 6 * scene->sigma;
    int64_t low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = (int64_t)fmax(0, ceil(at[axis] - reach));
        high[axis] = (int64_t)fmin(volume->dims[axis] - 1.0, floor(at[axis] + reach));
    }
    double sum = 0;
    for (int64_t k = low[2]; k <= high[2]; k++)
        for (int64_t j = low[1]; j <= high[1]; j++)
            for (int64_t i = low[0]; i <= high[0]; i++) {
                const double x = (double)i - at[0], y = (double)j - at[1], z = (double)k - at[2];
                const size_t index = ((size_t)k * volume->dims[1] + (size_t)j) * volume->dims[0] + (size_t)i;
                sum +=
                    (double)((const float *)volume->voxels)[index] * exp(-(x * x + y * y + z * z) / (2 * s2));
            }
    return sum * pow(2 * 3.14159265358979323846 * s2, -1.5);
}

double march_depth(const march_scene *scene, const ewa_camera *camera, double x_px, double y_px) {
    const double *m = camera->world_to_camera, *to_world = scene->volume->index_to_world;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    const bool ortho = camera->projection == EWA_ORTHOGRAPHIC;
    // Camera-space start and direction, back to the world: A is a rotation.
    const double start[3] = {(ortho ? x : 0) - m[3], (ortho ? y : 0) - m[7], -m[11]};
    const double length = ortho ? 1 : sqrt(x * x + y * y + 1);
    const double ray[3] = {(ortho ? 0 : x) / length, (ortho ? 0 : y) / length, 1 / length};
    const double spacing = to_world[0];
    double from[3], along[3], first = 0, last = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const double origin = m[axis] * start[0] + m[4 + axis] * start[1] + m[8 + axis] * start[2];
        from[axis] = (origin - to_world[4 * axis + 3]) / spacing;
        along[axis] = m[axis] * ray[0] + m[4 + axis] * ray[1] + m[8 + axis] * ray[2]; // voxels per step of 1
        const double reach = 6 * scene->sigma, high = scene->volume->dims[axis] - 1 + reach;
        if (fabs(along[axis]) < 1e-12) {
            if (from[axis] < -reach || from[axis] > high) return 0;
            continue;
        }
        const double a = (-reach - from[axis]) / along[axis], b = (high - from[axis]) / along[axis];
        first = fmax(first, fmin(a, b));
        last = fmin(last, fmax(a, b));
    }
    double sum = 0;
    for (double t = first + scene->step / 2; t < last; t += scene->step) {
        const double at[3] = {from[0] + t * along[0], from[1] + t * along[1], from[2] + t * along[2]};
        sum += density(scene, at);
    }
    return sum * scene->step * spacing * scene->extinction;
}
