// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points of which some number is none: how many, and what to say of them.
#include "faults.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK_POINTS = 256, MAX_COMPONENTS = 4 };

/// Marks the points of a block that have a component which is not finite or, where zero is a fault, no
/// length. Returns how many were not marked before.
static uint64_t mark_bad(const ewa_attribute *attribute, uint64_t first, uint64_t count, bool zero_is_bad,
                         bool marked[BLOCK_POINTS]) {
    const uint32_t components = attribute->component_count;
    double block[MAX_COMPONENTS * BLOCK_POINTS];
    uint64_t bad_count = 0;
    if (components > MAX_COMPONENTS) return 0;
    ewa_attribute_read_f64(attribute, first, count, block);
    for (uint64_t i = 0; i < count; i++) {
        bool finite = true, positive = false;
        for (uint32_t c = 0; c < components; c++) {
            const double number = block[i * components + c];
            finite = finite && isfinite(number);
            positive = positive || (components == 1 ? number > 0 : number != 0);
        }
        const bool bad = !finite || (zero_is_bad && !positive);
        bad_count += bad && !marked[i];
        marked[i] = marked[i] || bad;
    }
    return bad_count;
}

void faults_count(const ewa_cloud *cloud, cloud_faults *faults) {
    *faults = (cloud_faults){.position_count = 0};
    // In this order: a point counts under the first head only.
    const struct {
        const char *name;
        uint32_t component_count;
        bool zero_is_bad;
        uint64_t *count;
    } heads[] = {{EWA_POSITION, 3, false, &faults->position_count},
                 {EWA_NORMAL, 3, true, &faults->normal_count},
                 {EWA_RADIUS, 1, true, &faults->radius_count},
                 {EWA_TANGENT_U, 3, true, &faults->axis_count},
                 {EWA_TANGENT_V, 3, true, &faults->axis_count}};
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    const bool color_is_float = color && (color->type == EWA_F32 || color->type == EWA_F64);
    for (uint64_t first = 0; first < point_count; first += BLOCK_POINTS) {
        const uint64_t count = point_count - first < BLOCK_POINTS ? point_count - first : BLOCK_POINTS;
        bool marked[BLOCK_POINTS] = {false}, colorless[BLOCK_POINTS] = {false};
        for (size_t h = 0; h < sizeof heads / sizeof heads[0]; h++) {
            const ewa_attribute *attribute = ewa_cloud_find(cloud, heads[h].name);
            if (attribute && attribute->component_count == heads[h].component_count)
                *heads[h].count += mark_bad(attribute, first, count, heads[h].zero_is_bad, marked);
        }
        if (color_is_float) faults->color_count += mark_bad(color, first, count, false, colorless);
    }
}

/// Writes why points cannot be drawn: "3 with coordinates that are not finite, ...".
static void explain(const cloud_faults *faults, size_t text_bytes, char *text) {
    const struct {
        uint64_t count;
        const char *what;
    } kinds[] = {{faults->position_count, "coordinates that are not finite"},
                 {faults->normal_count, "normals that are zero or not finite"},
                 {faults->radius_count, "radii that are zero, negative or not finite"},
                 {faults->axis_count, "axes that are zero or not finite"}};
    snprintf(text, text_bytes, "their numbers are too large or too small");
    for (size_t i = 0, used = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (kinds[i].count && used < text_bytes)
            used += (size_t)snprintf(text + used, text_bytes - used, "%s%" PRIu64 " with %s",
                                     used ? ", " : "", kinds[i].count, kinds[i].what);
}

/// Whether all points lie at one place, which is written to `place_world`.
static bool at_one_place(const ewa_cloud *cloud, double place_world[3]) {
    ewa_bounds box;
    if (ewa_cloud_measure(cloud, &box) != EWA_OK || box.finite_count == 0) return false;
    memcpy(place_world, box.low_world, sizeof box.low_world);
    return memcmp(box.low_world, box.high_world, sizeof box.low_world) == 0;
}

bool faults_report(cli_session *session, const ewa_cloud *cloud, const ewa_surfels_info *surfels) {
    const unsigned long long all = ewa_cloud_point_count(cloud), left_out = surfels->left_out_count;
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    if (!left_out && !(color && (color->type == EWA_F32 || color->type == EWA_F64))) return true;
    cloud_faults faults;
    faults_count(cloud, &faults);
    char why[400];
    explain(&faults, sizeof why, why);
    double place_world[3];
    if (surfels->point_count == 0 && at_one_place(cloud, place_world)) {
        session_fail(
            session,
            "%s %g,%g,%g: without neighbours elsewhere or a property radius nothing says how large %s",
            all == 1 ? "there is one point only, at" : "all points lie at one place,", place_world[0],
            place_world[1], place_world[2], all == 1 ? "it is" : "they are");
        return false;
    }
    if (surfels->point_count == 0) {
        session_fail(
            session,
            "none of the %llu points can be drawn: %s; 'ewa surfels --keep-normals off --keep-radii off' "
            "makes new normals and radii",
            all, why);
        return false;
    }
    if (left_out) session_warn(session, "%llu of %llu points are left out: %s", left_out, all, why);
    if (faults.color_count)
        session_warn(session, "%llu of %llu points have a colour that is not finite; they are drawn in grey",
                     (unsigned long long)faults.color_count, all);
    return true;
}
