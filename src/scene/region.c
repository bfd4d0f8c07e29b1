// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points regions hide, and sections cut away.
//
// Based on M. Shimrat, "Algorithm 112: Position of point relative to polygon", 1962 (even and odd crossings), and M.
// Visvalingam and J. D. Whyatt, "Line generalisation by repeated elimination of points", 1993 (corners that are left out).
#include "scene/region.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/marks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char CLASSES[] = "classification";

/// Whether an odd number of the outline's edges is to the right of a place of the picture.
static bool is_in_outline(const ewa_region *region, double x, double y) {
    bool inside = false;
    for (uint32_t i = 0, k = region->corner_count - 1; i < region->corner_count; k = i++) {
        const double *a = region->outline_px + 2 * i, *b = region->outline_px + 2 * k;
        if ((a[1] > y) == (b[1] > y)) continue;
        if (x < a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]))) inside = !inside;
    }
    return inside;
}

bool ewa_region_is_turned(const ewa_region *region) {
    bool turned = false;
    for (int i = 0; i < 9; i++) turned = turned || region->box_axes_world[i] != 0;
    return turned;
}

static bool is_inside(const ewa_region *region, const double p[3], double code) {
    if (!region->has_box && !region->has_classes && !region->corner_count) return false;
    const bool turned = region->has_box && ewa_region_is_turned(region);
    for (int c = 0; c < 3 && region->has_box; c++) {
        const double *axis = region->box_axes_world + 3 * c;
        const double at = turned ? axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2] : p[c];
        if (!(at >= region->box_world[c] && at <= region->box_world[3 + c])) return false;
    }
    if (region->has_classes) {
        if (!(code >= 0 && code < EWA_REGION_CLASSES)) return false;
        const uint32_t bit = (uint32_t)code;
        if (!(region->classes[bit / 32] >> bit % 32 & 1)) return false;
    }
    if (!region->corner_count) return true;
    const double *m = region->world_to_picture;
    const double w = m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11];
    if (!(w > 0)) return false;
    return is_in_outline(region, (m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3]) / w,
                         (m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7]) / w);
}

bool ewa_regions_keep_place(const ewa_region *regions, uint32_t count, const double place_world[3], double code) {
    for (uint32_t i = 0; i < count; i++)
        if (is_inside(&regions[i], place_world, code) != regions[i].kept) return false;
    return true;
}

bool ewa_sections_keep(const ewa_render_options *render, const double place_world[3]) {
    const double *p = place_world;
    for (uint32_t i = 0; i < render->section_count; i++) {
        const double *plane = render->section_planes[i];
        if (!(plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] >= 0)) return false;
    }
    return true;
}

/// The codes of a cloud's classes; NULL: it has none.
static const ewa_attribute *find_classes(const ewa_cloud *cloud) {
    const ewa_attribute *found = ewa_cloud_find(cloud, CLASSES);
    return found && found->component_count == 1 ? found : NULL;
}

bool ewa_regions_keep(const ewa_region *regions, uint32_t count, const ewa_cloud *cloud, uint64_t index,
                      const double place_world[3]) {
    const ewa_attribute *classes = count ? find_classes(cloud) : NULL;
    double code = -1;
    if (classes) ewa_attribute_read_f64(classes, index, 1, &code);
    return ewa_regions_keep_place(regions, count, place_world, code);
}

bool ewa_regions_have_classes(const ewa_region *regions, uint32_t count) {
    bool have = false;
    for (uint32_t i = 0; i < count; i++) have = have || regions[i].has_classes;
    return have;
}

/// What the points of a cloud are held against.
typedef struct region_view {
    const ewa_region *regions;
    uint32_t count;
    const ewa_attribute *position, *classes;
    double origin_world[3];
} region_view;

static void mark_block(const void *data, uint64_t first, uint32_t count, uint8_t *marks) {
    const region_view *view = data;
    double places[EWA_MARK_BLOCK][3], codes[EWA_MARK_BLOCK];
    ewa_attribute_read_f64(view->position, first, count, &places[0][0]);
    if (view->classes) ewa_attribute_read_f64(view->classes, first, count, codes);
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) places[i][c] += view->origin_world[c];
        if (!ewa_regions_keep_place(view->regions, view->count, places[i], view->classes ? codes[i] : -1)) marks[i] = 0;
    }
}

ewa_status ewa_regions_mark(const ewa_region *regions, uint32_t count, const ewa_cloud *cloud, uint8_t *marks) {
    if (!cloud || !marks || (count && !regions)) return EWA_ERROR_ARGUMENT;
    region_view view = {.regions = regions, .count = count, .position = ewa_marks_position(cloud)};
    if (!view.position) return EWA_ERROR_ARGUMENT;
    view.classes = find_classes(cloud);
    ewa_cloud_origin(cloud, view.origin_world);
    ewa_mark_blocks(cloud, mark_block, &view, marks);
    return EWA_OK;
}

ewa_status ewa_cloud_hide(ewa_context *context, const ewa_region *regions, uint32_t count, ewa_cloud **cloud) {
    const uint64_t point_count = ewa_cloud_point_count(*cloud);
    if (!count || !point_count) return EWA_OK;
    uint8_t *marks = ewa_allocate(context, point_count, 1);
    if (!marks) return EWA_ERROR_MEMORY;
    memset(marks, 1, point_count);
    ewa_cloud *left = NULL;
    ewa_status status = ewa_regions_mark(regions, count, *cloud, marks);
    if (status == EWA_OK && memchr(marks, 0, point_count)) status = ewa_cloud_keep(*cloud, marks, &left);
    ewa_release(context, marks, point_count, 1);
    if (left) {
        ewa_cloud_destroy(cloud);
        *cloud = left;
    }
    return status;
}

bool ewa_region_is_box(const double box_world[6]) {
    bool fine = true;
    for (int c = 0; c < 3; c++)
        fine = fine && isfinite(box_world[c]) && isfinite(box_world[3 + c]) && box_world[c] <= box_world[3 + c];
    return fine;
}

ewa_status ewa_regions_check(ewa_context *context, const ewa_region *regions, uint32_t count) {
    if (count > EWA_MAX_REGIONS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%u regions; there may be %d", count, EWA_MAX_REGIONS);
    for (uint32_t i = 0; i < count; i++) {
        const ewa_region *region = &regions[i];
        bool fine = region->corner_count == 0 || (region->corner_count >= 3 && region->corner_count <= EWA_REGION_CORNERS);
        fine = fine && (!region->has_box || ewa_region_is_box(region->box_world));
        for (int c = 0; c < 9 && region->has_box; c++) fine = fine && isfinite(region->box_axes_world[c]);
        for (uint32_t k = 0; fine && k < 2 * region->corner_count; k++) fine = isfinite(region->outline_px[k]);
        for (int k = 0; k < 12 && region->corner_count; k++) fine = fine && isfinite(region->world_to_picture[k]);
        if (!fine)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "region %u: numbers that are not finite, a box that ends before it begins, or an outline of %u corners, which "
                            "may be 3 to %d", i,
                            region->corner_count, EWA_REGION_CORNERS);
    }
    return EWA_OK;
}

/// Twice the area by which an outline changes without one of its corners.
static double change_of(const double *a, const double *b, const double *c) {
    return fabs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
}

/// Leaves out corners until there are few enough.
static uint32_t simplify(double *corners, uint32_t count) {
    while (count > EWA_REGION_CORNERS) {
        uint32_t smallest = 0;
        double change = INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            const double own = change_of(corners + 2 * ((i + count - 1) % count), corners + 2 * i, corners + 2 * ((i + 1) % count));
            if (own < change) change = own, smallest = i;
        }
        memmove(corners + 2 * smallest, corners + 2 * (smallest + 1), 2 * (count - smallest - 1) * sizeof *corners);
        count--;
    }
    return count;
}

ewa_status ewa_region_set_outline(ewa_region *region, const ewa_camera *camera, const double *outline_px,
                                  uint32_t corner_count) {
    if (!region || !camera || !outline_px || corner_count < 3 || corner_count > 1 << 16) return EWA_ERROR_ARGUMENT;
    for (uint32_t i = 0; i < 2 * corner_count; i++)
        if (!isfinite(outline_px[i])) return EWA_ERROR_ARGUMENT;
    double *corners = malloc(2 * corner_count * sizeof *corners);
    if (!corners) return EWA_ERROR_MEMORY;
    memcpy(corners, outline_px, 2 * corner_count * sizeof *corners);
    region->corner_count = simplify(corners, corner_count);
    memset(region->outline_px, 0, sizeof region->outline_px);
    memcpy(region->outline_px, corners, 2 * region->corner_count * sizeof *corners);
    free(corners);
    const double *m = camera->world_to_camera;
    const bool flat = camera->projection == EWA_ORTHOGRAPHIC;
    for (int c = 0; c < 4; c++) {
        const double w = flat ? c == 3 : m[8 + c];
        region->world_to_picture[c] = camera->fx_px * m[c] + camera->cx_px * w;
        region->world_to_picture[4 + c] = camera->fy_px * m[4 + c] + camera->cy_px * w;
        region->world_to_picture[8 + c] = w;
    }
    return EWA_OK;
}
