// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What section planes leave of a pixel's ray.
#include "volume/section.h"

#include <math.h>

void ewa_ray_sections_make(ewa_ray_sections *sections, const ewa_camera *camera, const double planes[][4],
                           uint32_t count) {
    *sections = (ewa_ray_sections){.count = count,
                                   .orthographic = camera->projection == EWA_ORTHOGRAPHIC,
                                   .fx_px = camera->fx_px,
                                   .fy_px = camera->fy_px,
                                   .cx_px = camera->cx_px,
                                   .cy_px = camera->cy_px};
    const double *m = camera->world_to_camera;
    double squares = 0; // of the rows, which are a rotation's but for their length
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) squares += m[4 * row + column] * m[4 * row + column] / 3;
    for (uint32_t i = 0; i < count; i++) {
        double *to = sections->planes[i];
        const double length = hypot(hypot(planes[i][0], planes[i][1]), planes[i][2]);
        to[3] = planes[i][3] / length;
        for (int row = 0; row < 3; row++) {
            to[row] = 0;
            for (int column = 0; column < 3; column++)
                to[row] += m[4 * row + column] * (planes[i][column] / length) / squares;
            to[3] -= to[row] * m[4 * row + 3];
        }
    }
}

void ewa_ray_sections_range(const ewa_ray_sections *sections, double x_px, double y_px, double *enter,
                            double *leave) {
    const double x = (x_px - sections->cx_px) / sections->fx_px,
                 y = (y_px - sections->cy_px) / sections->fy_px;
    *enter = -INFINITY, *leave = INFINITY;
    for (uint32_t i = 0; i < sections->count; i++) {
        // How far within the plane the ray is, at + by * z.
        const double *p = sections->planes[i];
        const double lateral = p[0] * x + p[1] * y;
        const double at = sections->orthographic ? lateral + p[3] : p[3];
        const double by = sections->orthographic ? p[2] : lateral + p[2];
        const double z = -at / by;
        if (by > 0)
            *enter = fmax(*enter, z);
        else if (by < 0)
            *leave = fmin(*leave, z);
        else if (at < 0)
            *enter = INFINITY, *leave = -INFINITY;
    }
}
