// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The scanners of a cloud, from its note.
#include "estimate/sight.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/scanners.h"

#include <math.h>

/// A sample's half of a cell, in cells, and the least cosine between normal and way to the eye for which it is reckoned.
static const double HALF_CELL = 0.5, STEEPEST = 0.25;

static ewa_status add_places(const ewa_cloud *cloud, const double (*world)[3], uint32_t count, sight *made) {
    made->place = ewa_allocate(ewa_cloud_context(cloud), count, sizeof *made->place);
    if (!made->place) return EWA_ERROR_MEMORY;
    made->place_count = count;
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) made->place[i][c] = world[i][c] - origin[c];
    return EWA_OK;
}

static ewa_status add_scanners(const ewa_cloud *cloud, sight *made) {
    ewa_context *context = ewa_cloud_context(cloud);
    const ewa_attribute *scan = ewa_cloud_find(cloud, "scan");
    if (!ewa_cloud_note(cloud, "scanners", NULL)) return EWA_OK;
    const size_t count = ewa_cloud_read_scanners(cloud, 0, NULL);
    if (!count || count > UINT32_MAX || (scan && scan->component_count != 1)) {
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "estimate: the note \"scanners\" is not three numbers per scan; it is not used");
        return EWA_OK;
    }
    if (count > 1 && !scan) return EWA_OK;
    double(*world)[3] = ewa_allocate(context, count, sizeof *world);
    if (!world) return EWA_ERROR_MEMORY;
    ewa_cloud_read_scanners(cloud, count, world);
    const ewa_status status = add_places(cloud, (const double(*)[3])world, (uint32_t)count, made);
    ewa_release(context, world, count, sizeof *world);
    if (scan && status == EWA_OK) made->scan = *scan;
    made->kind = SIGHT_SCANNERS;
    return status;
}

ewa_status ewa_sight_make(const ewa_cloud *cloud, const ewa_estimate_options *options, sight *made) {
    *made = (sight){SIGHT_NONE, NULL, 0, {.data = NULL}};
    if (options->orientation == EWA_ORIENT_VIEWPOINT) {
        made->kind = SIGHT_PLACE;
        return add_places(cloud, &options->viewpoint_world, 1, made);
    }
    if (options->orientation != EWA_ORIENT_AUTO) return EWA_OK;
    EWA_TRY(add_scanners(cloud, made));
    if (made->kind == SIGHT_NONE && ewa_cloud_find(cloud, "return_number")) made->kind = SIGHT_UPWARD;
    return EWA_OK;
}

void ewa_sight_free(ewa_context *context, sight *made) {
    ewa_release(context, made->place, made->place_count, sizeof *made->place);
    made->place = NULL;
}

bool ewa_sight_is_behind(const sight *from, uint32_t point, const double p[3], const float normal[3]) {
    if (from->kind == SIGHT_UPWARD) return normal[2] < 0;
    uint32_t index = 0;
    if (from->scan.data) {
        double scan;
        ewa_attribute_read_f64(&from->scan, point, 1, &scan);
        if (!(scan >= 0 && scan < from->place_count)) return false;
        index = (uint32_t)scan;
    }
    double towards = 0;
    for (int c = 0; c < 3; c++) towards += (from->place[index][c] - p[c]) * (double)normal[c];
    return towards < 0;
}

sight_grid ewa_sight_grid(const ewa_cloud *cloud, const sight *from) {
    sight_grid grid = {.given = false};
    if (from->kind == SIGHT_SCANNERS && from->place_count == 1) {
        grid.given = true;
        for (int c = 0; c < 3; c++) grid.eye[c] = from->place[0][c];
    } else if (ewa_cloud_note(cloud, "file.organised", NULL)) {
        grid.given = true;
        ewa_cloud_origin(cloud, grid.eye);
        for (int c = 0; c < 3; c++) grid.eye[c] = 0 - grid.eye[c];
    }
    return grid;
}

float ewa_sight_beyond(const sight_grid *grid, const double p[3], const double normal[3]) {
    double along = 0, length2 = 0;
    for (int c = 0; c < 3 && grid->given; c++) {
        const double d = grid->eye[c] - p[c];
        along += d * normal[c];
        length2 += d * d;
    }
    if (!(length2 > 0)) return 0;
    // A cell is 1 / sqrt(cosine) spacings long across the border, half of it belongs to the outermost sample.
    const double cosine = fabs(along) / sqrt(length2);
    return (float)(HALF_CELL / sqrt(cosine > STEEPEST ? cosine : STEEPEST));
}
