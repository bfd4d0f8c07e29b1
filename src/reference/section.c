// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What section planes leave of a pixel's ray, for the references of Gaussians and volumes.
#include "reference/section.h"

#include <math.h>

void ewa_reference_cut_ray(const ewa_camera *camera, const double planes[][4], uint32_t count, double x_px,
                           double y_px, double *enter, double *leave) {
    const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
    const double *m = camera->world_to_camera;
    const double x = (x_px - camera->cx_px) / camera->fx_px, y = (y_px - camera->cy_px) / camera->fy_px;
    // The ray at depth z is start + z step in camera space. In the world that is less the last column, times the
    // transposed rows over their square.
    const double start[3] = {flat ? x : 0, flat ? y : 0, 0}, step[3] = {flat ? 0 : x, flat ? 0 : y, 1};
    *enter = -INFINITY, *leave = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const double *p = planes[i], length = hypot(hypot(p[0], p[1]), p[2]);
        double at = p[3] / length, by = 0;
        for (int row = 0; row < 3; row++) {
            const double *r = m + 4 * row, square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
            const double along = (p[0] / length * r[0] + p[1] / length * r[1] + p[2] / length * r[2]) / square;
            at += along * (start[row] - r[3]), by += along * step[row];
        }
        if (by > 0) *enter = fmax(*enter, -at / by);
        if (by < 0) *leave = fmin(*leave, -at / by);
        if (by == 0 && at < 0) *enter = INFINITY;
    }
}
