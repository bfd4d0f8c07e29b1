// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What points turn out to be that nothing says: the columns of Gaussians, normals that are none, floats too coarse for
// their coordinates, degrees, numbers that are none.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/diagnosis.h"
#include "io/crs.h"
#include "math/degree.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK_POINTS = 256, MAX_COMPONENTS = 4 };

/// Distances of points in steps of their coordinates from which surfaces look as they are.
static const double STEPS_PER_SPACING = 4;

/// Extent in height beside that on the map from which coordinates of a small extent are degrees: 1 km of land
/// is 0.01 degrees wide and 10 m high.
static const double DEGREES_HEIGHT_RATIO = 200;

ewa_gaussian_columns ewa_cloud_find_gaussians(const ewa_cloud *cloud) {
    static const char *const needed[] = {"f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0",
                                         "scale_1", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
    // Coefficients of one colour beside the first, by degree.
    static const uint32_t harmonics[] = {0, 3, 8, 15};
    ewa_gaussian_columns facts = {.dimensions = ewa_cloud_find(cloud, "scale_2") ? 3 : 2,
                                  .filtered = ewa_cloud_find(cloud, "filter_3D") != NULL};
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++)
        if (!ewa_cloud_find(cloud, needed[i])) return (ewa_gaussian_columns){.dimensions = 0};
    uint32_t rest_count = 0;
    char name[EWA_NAME_BYTES];
    while (snprintf(name, sizeof name, "f_rest_%u", rest_count) > 0 && ewa_cloud_find(cloud, name))
        rest_count++;
    while (facts.sh_degree < 3 && rest_count >= 3 * harmonics[facts.sh_degree + 1]) facts.sh_degree++;
    return facts;
}

void ewa_gaussian_columns_describe(const ewa_gaussian_columns *facts, char text[EWA_DIAGNOSIS_TEXT_BYTES]) {
    snprintf(text, EWA_DIAGNOSIS_TEXT_BYTES, "%uD Gaussians%s, spherical harmonics of degree %u",
             facts->dimensions, facts->filtered ? " with 3D filters (Mip-Splatting)" : "", facts->sh_degree);
}

ewa_status ewa_cloud_refuse_gaussians(const ewa_cloud *cloud) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    const ewa_gaussian_columns columns = ewa_cloud_find_gaussians(cloud);
    if (!columns.dimensions) return EWA_OK;
    char text[EWA_DIAGNOSIS_TEXT_BYTES];
    ewa_gaussian_columns_describe(&columns, text);
    return ewa_fail(
        ewa_cloud_context(cloud), EWA_ERROR_UNSUPPORTED,
        "%llu %s: a scene of Gaussian splatting, which cannot be drawn; ewa_cloud_estimate() of the "
        "centres makes surfels",
        (unsigned long long)ewa_cloud_point_count(cloud), text);
}

void ewa_cloud_check_steps(const ewa_cloud *cloud) {
    ewa_bounds box;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (!position || position->type != EWA_F32 || ewa_cloud_measure(cloud, &box) != EWA_OK ||
        box.finite_count < 2)
        return;
    double largest = 0, sides[2] = {0}; // the two longest
    for (int c = 0; c < 3; c++) {
        largest = fmax(largest, fmax(fabs(box.low_world[c]), fabs(box.high_world[c])));
        const double extent = box.high_world[c] - box.low_world[c];
        sides[1] = fmax(sides[1], fmin(sides[0], extent));
        sides[0] = fmax(sides[0], extent);
    }
    int exponent;
    frexp(largest, &exponent);
    const double step = ldexp(1, exponent - FLT_MANT_DIG);
    // As far apart as on a sheet of that size, or on a line.
    const double spacing =
        fmax(sqrt(sides[0] * sides[1] / (double)box.finite_count), sides[0] / (double)box.finite_count);
    if (!(spacing > 0) || step * STEPS_PER_SPACING <= spacing) return;
    ewa_report(
        ewa_cloud_context(cloud), EWA_SEVERITY_WARNING,
        "coordinates up to %.10g are floats with steps of %.2g there, but the points are about %.2g apart: "
        "shapes are lost; doubles, or points moved to the origin before they become floats, keep them",
        largest, step, spacing);
}

bool ewa_cloud_find_degrees(const ewa_cloud *cloud, char text[EWA_DIAGNOSIS_TEXT_BYTES]) {
    if (!cloud) return false;
    ewa_bounds box;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (!position || position->component_count != 3 || ewa_cloud_measure(cloud, &box) != EWA_OK ||
        box.finite_count == 0)
        return false;
    const double *low = box.low_world, *high = box.high_world;
    if (low[0] < -180 || high[0] > 180 || low[1] < -90 || high[1] > 90) return false;
    const double extent = fmax(high[0] - low[0], high[1] - low[1]),
                 away = fmin(fabs(low[0] + high[0]), fabs(low[1] + high[1]));
    const char *crs = ewa_cloud_note(cloud, "crs", NULL);
    const bool geographic = ewa_cloud_crs_unit(cloud) == EWA_CRS_DEGREES;
    const bool small =
        extent > 0 && extent < 1 && away > 10 * extent && high[2] - low[2] > DEGREES_HEIGHT_RATIO * extent;
    if (!geographic && (crs || !small)) return false;
    double length_m[2];
    ewa_degree_lengths(0.5 * (low[1] + high[1]), length_m);
    snprintf(
        text, EWA_DIAGNOSIS_TEXT_BYTES,
        "coordinates %s degrees of longitude and latitude, so that shapes are flat and heights stand out; "
        "times %.0f,%.0f,1 they are about metres, exact ones a projection such as UTM zone %d makes",
        geographic ? "are" : "look like", length_m[0], length_m[1],
        (int)fmin(60, floor((0.5 * (low[0] + high[0]) + 180) / 6) + 1));
    return true;
}

void ewa_cloud_check_degrees(const ewa_cloud *cloud) {
    char text[EWA_DIAGNOSIS_TEXT_BYTES];
    if (ewa_cloud_find_degrees(cloud, text))
        ewa_report(ewa_cloud_context(cloud), EWA_SEVERITY_WARNING, "%s", text);
}

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

void ewa_cloud_count_invalid_points(const ewa_cloud *cloud, ewa_cloud_invalid_points *invalid) {
    *invalid = (ewa_cloud_invalid_points){.position_count = 0};
    // In this order: a point counts under the first head only.
    const struct {
        const char *name;
        uint32_t component_count;
        bool zero_is_bad;
        uint64_t *count;
    } heads[] = {{EWA_POSITION, 3, false, &invalid->position_count},
                 {EWA_NORMAL, 3, true, &invalid->normal_count},
                 {EWA_RADIUS, 1, true, &invalid->radius_count},
                 {EWA_TANGENT_U, 3, true, &invalid->axis_count},
                 {EWA_TANGENT_V, 3, true, &invalid->axis_count}};
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
        if (color_is_float) invalid->color_count += mark_bad(color, first, count, false, colorless);
    }
}

/// Writes why points cannot be drawn: "3 with coordinates that are not finite, ...".
static void explain(const ewa_cloud_invalid_points *invalid, size_t text_bytes, char *text) {
    const struct {
        uint64_t count;
        const char *what;
    } kinds[] = {{invalid->position_count, "coordinates that are not finite"},
                 {invalid->normal_count, "normals that are zero or not finite"},
                 {invalid->radius_count, "radii that are zero, negative or not finite"},
                 {invalid->axis_count, "axes that are zero or not finite"}};
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

/// Warns of float colours that are more than white in the mean: surfaces reflect no more than falls on them, so that they count otherwise.
static void check_bright(const ewa_cloud *cloud, const ewa_attribute *color) {
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    const uint32_t components = color->component_count;
    double sum = 0, number_count = 0, largest = 0, block[MAX_COMPONENTS * BLOCK_POINTS];
    if (components > MAX_COMPONENTS) return;
    for (uint64_t first = 0; first < point_count; first += BLOCK_POINTS) {
        const uint64_t count = point_count - first < BLOCK_POINTS ? point_count - first : BLOCK_POINTS;
        ewa_attribute_read_f64(color, first, count, block);
        for (uint64_t i = 0; i < components * count; i++) {
            if (!isfinite(block[i]) || i % components == 3) continue; // alpha
            sum += block[i], number_count++;
            largest = fmax(largest, block[i]);
        }
    }
    if (sum > number_count)
        ewa_report(ewa_cloud_context(cloud), EWA_SEVERITY_WARNING,
                   "colours are floats of up to %.6g and count as linear light, of which 1 is white; those that go to 255 belong into unsigned bytes",
                   largest);
}

ewa_status ewa_cloud_report_invalid_points(const ewa_cloud *cloud, const ewa_surfels_info *surfels) {
    if (!cloud || !surfels) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    const unsigned long long all = ewa_cloud_point_count(cloud), left_out = surfels->left_out_count;
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    const bool color_is_float = color && (color->type == EWA_F32 || color->type == EWA_F64);
    if (!left_out && !color_is_float) return EWA_OK;
    if (color_is_float) check_bright(cloud, color);
    ewa_cloud_invalid_points invalid;
    ewa_cloud_count_invalid_points(cloud, &invalid);
    char why[400];
    explain(&invalid, sizeof why, why);
    double place_world[3];
    if (surfels->point_count == 0 && at_one_place(cloud, place_world))
        return ewa_fail(
            context, EWA_ERROR_FORMAT,
            "%s %g,%g,%g: without neighbours elsewhere or a property radius nothing says how large %s",
            all == 1 ? "there is one point only, at" : "all points lie at one place,", place_world[0],
            place_world[1], place_world[2], all == 1 ? "it is" : "they are");
    if (surfels->point_count == 0)
        return ewa_fail(
            context, EWA_ERROR_FORMAT,
            "none of the %llu points can be drawn: %s; ewa_cloud_estimate() makes new normals "
            "and radii",
            all, why);
    if (left_out)
        ewa_report(context, EWA_SEVERITY_WARNING, "%llu of %llu points are left out: %s", left_out, all, why);
    if (invalid.color_count)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%llu of %llu points have a colour that is not finite; they are drawn in grey",
                   (unsigned long long)invalid.color_count, all);
    return EWA_OK;
}

void ewa_cloud_drop_zero_normals(ewa_cloud *cloud) {
    if (!ewa_cloud_find(cloud, EWA_NORMAL)) return;
    ewa_cloud_invalid_points invalid;
    ewa_cloud_count_invalid_points(cloud, &invalid);
    if (!invalid.normal_count || invalid.position_count + invalid.normal_count < ewa_cloud_point_count(cloud))
        return;
    ewa_cloud_remove(cloud, EWA_NORMAL);
    ewa_report(ewa_cloud_context(cloud), EWA_SEVERITY_NOTE,
               "all normals are zero or not finite, and count as missing");
}
