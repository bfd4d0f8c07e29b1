// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cells of grids of heights in the world.
#include "io/cloud/height_grid.h"

#include "base/base.h"
#include "base/format.h"
#include "io/cloud/text_table.h"
#include "math/degree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Where a file names no number for no height; and what is beyond all heights: -3.4e38, rounded.
static const double USUAL_NO_DATA[] = {-9999, -32768}, LARGEST = 1e30;

/// A slope that ground does not have on the average.
static const double ABSURD_SLOPE = 8;

bool ewa_height_is(const ewa_height_grid *grid, double number) {
    if (!(fabs(number) <= LARGEST)) return false;
    if (grid->has_no_data) return number != grid->no_data;
    return number != USUAL_NO_DATA[0] && number != USUAL_NO_DATA[1];
}

/// The middle of the cell at a column and a row, which may be fractions.
static void middle(const ewa_height_grid *grid, double column, double row, double place[2]) {
    const double *m = grid->to_world;
    place[0] = m[0] * column + m[1] * row + m[2];
    place[1] = m[3] * column + m[4] * row + m[5];
}

bool ewa_height_grid_fits_degrees(const ewa_height_grid *grid) {
    const double last[2] = {(double)grid->columns - 1, (double)grid->rows - 1};
    for (int corner = 0; corner < 4; corner++) {
        double place[2];
        middle(grid, corner & 1 ? last[0] : 0, corner & 2 ? last[1] : 0, place);
        if (!(fabs(place[0]) <= 360 && fabs(place[1]) <= 90)) return false;
    }
    return true;
}

bool ewa_height_grid_is_too_steep(const ewa_height_grid *grid, double mean_step) {
    const double *m = grid->to_world;
    return mean_step > ABSURD_SLOPE * sqrt(m[0] * m[0] + m[3] * m[3]);
}

/// Makes metres of degrees, counted from the middle of the grid.
static ewa_status make_metres(const ewa_cloud_source *source, ewa_height_grid *grid, ewa_cloud *prototype) {
    double place[2], length_m[2];
    middle(grid, ((double)grid->columns - 1) / 2, ((double)grid->rows - 1) / 2, place);
    if (!(fabs(place[1]) < 90)) return EWA_OK;
    ewa_degree_lengths(place[1], length_m);
    double *m = grid->to_world;
    m[2] -= place[0];
    m[5] -= place[1];
    for (int i = 0; i < 6; i++) m[i] *= length_m[i / 3];
    char text[96];
    ewa_format(text, sizeof text, "longitude %.9g, latitude %.9g", place[0], place[1]);
    ewa_report(source->context, EWA_SEVERITY_NOTE,
               "%s: degrees with heights in metres: x and y are metres east and north of %s", source->name, text);
    return ewa_cloud_set_note(prototype, "file.degrees", text, strlen(text));
}

ewa_status ewa_height_grid_settle(const ewa_cloud_source *source, ewa_height_grid *grid, ewa_cloud *prototype) {
    if (grid->is_degrees) EWA_TRY(make_metres(source, grid, prototype));
    const double last[2] = {(double)grid->columns - 1, (double)grid->rows - 1};
    double low_world[2] = {INFINITY, INFINITY};
    for (int corner = 0; corner < 4; corner++) {
        double place[2];
        middle(grid, corner & 1 ? last[0] : 0, corner & 2 ? last[1] : 0, place);
        for (int axis = 0; axis < 2; axis++) {
            if (!isfinite(place[axis]))
                return ewa_fail(source->context, EWA_ERROR_FORMAT,
                                "%s: the grid's cells are at places that are not finite", source->name);
            low_world[axis] = fmin(low_world[axis], place[axis]);
        }
    }
    for (int axis = 0; axis < 2; axis++) grid->origin_world[axis] = (double)ewa_text_origin(low_world[axis]);
    char text[64];
    snprintf(text, sizeof text, "%llu x %llu", (unsigned long long)grid->columns, (unsigned long long)grid->rows);
    EWA_TRY(ewa_cloud_set_note(prototype, "file.heights", text, strlen(text)));
    EWA_TRY(ewa_cloud_add(prototype, EWA_POSITION, EWA_F64, 3, NULL));
    ewa_cloud_set_origin(prototype, grid->origin_world);
    return EWA_OK;
}

void ewa_height_grid_place(const ewa_height_grid *grid, uint64_t column, uint64_t row, double height, uint8_t *to) {
    double position[3];
    middle(grid, (double)column, (double)row, position);
    for (int axis = 0; axis < 2; axis++) position[axis] -= grid->origin_world[axis];
    position[2] = height;
    memcpy(to, position, sizeof position);
}
