// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a file of points turns out to be that its suffix does not say: Gaussians, normals that are none,
// floats too coarse for their coordinates, degrees.
#include "screening.h"
#include "faults.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// Distances of points in steps of their coordinates from which surfaces look as they are.
static const double STEPS_PER_SPACING = 4;

/// Metres of a degree of latitude, and of longitude at the equator.
static const double DEGREE_M = 111320;

/// Extent in height beside that on the map from which coordinates of a small extent are degrees: 1 km of land
/// is 0.01 degrees wide and 10 m high.
static const double DEGREES_HEIGHT_RATIO = 200;

/// The harmonic that is the same in all directions.
static const double SH_CONSTANT = 0.28209479177387814;

gaussian_facts screening_find_gaussians(const ewa_cloud *cloud) {
    static const char *const needed[] = {"f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0",
                                         "scale_1", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
    // Coefficients of one colour beside the first, by degree.
    static const uint32_t harmonics[] = {0, 3, 8, 15};
    gaussian_facts facts = {.dimensions = ewa_cloud_find(cloud, "scale_2") ? 3 : 2,
                            .filtered = ewa_cloud_find(cloud, "filter_3D") != NULL};
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++)
        if (!ewa_cloud_find(cloud, needed[i])) return (gaussian_facts){.dimensions = 0};
    uint32_t rest_count = 0;
    char name[EWA_NAME_BYTES];
    while (snprintf(name, sizeof name, "f_rest_%u", rest_count) > 0 && ewa_cloud_find(cloud, name))
        rest_count++;
    while (facts.sh_degree < 3 && rest_count >= 3 * harmonics[facts.sh_degree + 1]) facts.sh_degree++;
    return facts;
}

void screening_describe_gaussians(const gaussian_facts *facts, size_t text_bytes, char *text) {
    snprintf(text, text_bytes, "%uD Gaussians%s, spherical harmonics of degree %u", facts->dimensions,
             facts->filtered ? " with 3D filters (Mip-Splatting)" : "", facts->sh_degree);
}

bool screening_color_gaussians(cli_session *session, ewa_cloud *cloud) {
    static const char *const names[] = {"f_dc_0", "f_dc_1", "f_dc_2"};
    uint8_t *colors = NULL;
    if (ewa_cloud_find(cloud, EWA_COLOR) || !screening_find_gaussians(cloud).dimensions) return true;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&colors);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    for (int c = 0; c < 3; c++) {
        const ewa_attribute *attribute = ewa_cloud_find(cloud, names[c]);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
            float coefficient;
            ewa_attribute_read_f32(attribute, i, 1, &coefficient);
            const double color = 255 * (0.5 + SH_CONSTANT * (double)coefficient);
            colors[3 * i + (uint64_t)c] = (uint8_t)(color > 0 ? fmin(color, 255) + 0.5 : 0);
        }
    }
    return true;
}

bool screening_admit(cli_session *session, const char *path, const ewa_cloud *cloud) {
    const gaussian_facts facts = screening_find_gaussians(cloud);
    if (!facts.dimensions) return true;
    char text[128];
    screening_describe_gaussians(&facts, sizeof text, text);
    session->subject = path;
    session_fail(session,
                 "%llu %s: a scene of Gaussian splatting, which cannot be drawn; 'ewa surfels --keep-normals "
                 "off' makes surfels of the centres",
                 (unsigned long long)ewa_cloud_point_count(cloud), text);
    return false;
}

void screening_drop_zero_normals(cli_session *session, const char *path, ewa_cloud *cloud) {
    if (!ewa_cloud_find(cloud, EWA_NORMAL)) return;
    cloud_faults faults;
    faults_count(cloud, &faults);
    if (!faults.normal_count || faults.position_count + faults.normal_count < ewa_cloud_point_count(cloud))
        return;
    ewa_cloud_remove(cloud, EWA_NORMAL);
    session->subject = path;
    session_note(session, "all normals are zero or not finite, and count as missing");
}

void screening_check_steps(cli_session *session, const char *path, const ewa_cloud *cloud) {
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
    session->subject = path;
    session_warn(
        session,
        "coordinates up to %.10g are floats with steps of %.2g there, but the points are about %.2g apart: "
        "shapes are lost; doubles, or points moved to the origin before they become floats, keep them",
        largest, step, spacing);
}

/// Whether the text of a coordinate reference system is one of longitude and latitude; false for none.
static bool is_geographic(const char *crs) {
    static const char *const codes[] = {"EPSG:4326", "EPSG:4979", "EPSG:4258", "EPSG:4269"};
    if (!crs || strstr(crs, "PROJC")) return false;
    bool found = strstr(crs, "GEOGC") || strstr(crs, "GEODCRS");
    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) found = found || strcmp(crs, codes[i]) == 0;
    return found;
}

bool screening_find_degrees(const ewa_cloud *cloud, size_t text_bytes, char *text) {
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
    const bool small =
        extent > 0 && extent < 1 && away > 10 * extent && high[2] - low[2] > DEGREES_HEIGHT_RATIO * extent;
    if (!is_geographic(crs) && (crs || !small)) return false;
    const double latitude_deg = 0.5 * (low[1] + high[1]),
                 radians = latitude_deg * (3.14159265358979323846 / 180);
    snprintf(
        text, text_bytes,
        "coordinates %s degrees of longitude and latitude, so that shapes are flat and heights stand out; "
        "'ewa convert --scale %.0f,%.0f,1' makes about metres of them, exact ones a projection such as UTM "
        "zone %d",
        is_geographic(crs) ? "are" : "look like", DEGREE_M * cos(radians), DEGREE_M,
        (int)fmin(60, floor((0.5 * (low[0] + high[0]) + 180) / 6) + 1));
    return true;
}

void screening_check_degrees(cli_session *session, const char *path, const ewa_cloud *cloud) {
    char text[400];
    if (!screening_find_degrees(cloud, sizeof text, text)) return;
    session->subject = path;
    session_warn(session, "%s", text);
}
