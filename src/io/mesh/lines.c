// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines of files that have no faces, as points along them.
#include "base/base.h"
#include "io/mesh/build.h"

#include <math.h>

// Points along the diagonal of the box of all lines: a picture is about as many pixels wide. No more of all than so many.
static const double POINTS_ACROSS = 1000, MAX_POINTS = 2e6;

ewa_status ewa_mesh_add_line(ewa_mesh_build *build, const uint32_t *places, uint64_t count) {
    ewa_status status = EWA_OK;
    build->line_count++;
    for (uint64_t i = 1; i < count && status == EWA_OK; i++) {
        if (places[i - 1] >= build->positions.count || places[i] >= build->positions.count) continue;
        uint32_t *to = ewa_mesh_list_add(build, &build->segments, &status);
        if (to) to[0] = places[i - 1], to[1] = places[i];
    }
    return status;
}

/// The length of a segment; 0 where it is not finite.
static double length_of(const ewa_mesh_build *build, const uint32_t ends[2]) {
    const double *a = (const double *)build->positions.items + 3 * (size_t)ends[0],
                 *b = (const double *)build->positions.items + 3 * (size_t)ends[1];
    const double length = hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
    return isfinite(length) ? length : 0;
}

/// The diagonal of the box around the ends of all segments that are finite.
static double measure_diagonal(const ewa_mesh_build *build) {
    const uint32_t(*ends)[2] = build->segments.items;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint64_t i = 0; i < 2 * build->segments.count; i++) {
        const double *p = (const double *)build->positions.items + 3 * (size_t)ends[i / 2][i % 2];
        for (int c = 0; c < 3 && length_of(build, ends[i / 2]) > 0; c++)
            low[c] = fmin(low[c], p[c]), high[c] = fmax(high[c], p[c]);
    }
    return hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

ewa_status ewa_mesh_fill_lines(ewa_mesh_build *build) {
    static const float white[4] = {1, 1, 1, 1};
    double sum = 0;
    for (uint64_t i = 0; i < build->segments.count; i++) sum += length_of(build, (const uint32_t *)build->segments.items + 2 * i);
    const double step = fmax(measure_diagonal(build) / POINTS_ACROSS, sum / MAX_POINTS);
    const uint64_t colored = build->colors.count;
    if (!(sum > 0) || !isfinite(step)) return EWA_OK;
    for (uint64_t i = 0; i < build->segments.count; i++) {
        const uint32_t *ends = (const uint32_t *)build->segments.items + 2 * i;
        const double length = length_of(build, ends);
        const uint64_t parts = (uint64_t)ceil(length / step);
        for (uint64_t k = 1; k < parts; k++) {
            const double share = (double)k / (double)parts;
            double place[3];
            float color[4];
            for (int c = 0; c < 3; c++) {
                const double *at = (const double *)build->positions.items + c, from = at[3 * (size_t)ends[0]];
                place[c] = from + share * (at[3 * (size_t)ends[1]] - from);
            }
            EWA_TRY(ewa_mesh_add_position(build, place));
            if (ends[0] >= colored || ends[1] >= colored) continue;
            for (int c = 0; c < 4; c++) {
                const float *of = (const float *)build->colors.items + c;
                color[c] = (float)((1 - share) * (double)of[4 * (size_t)ends[0]] + share * (double)of[4 * (size_t)ends[1]]);
            }
            EWA_TRY(ewa_mesh_add_color(build, white, color));
        }
    }
    build->line_count = 0; // they are there
    build->line_step = step;
    return EWA_OK;
}
