// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Measurements between places.
//
// Areas are those of vectors of triangles about the first place, half the sum of their cross products (M. E. Newell's
// normal of a polygon), which is exact of plane ones and does not lose digits far from the origin.
#include "ewa/measure.h"

#include <math.h>
#include <string.h>

static const double DEGREES = 180 / 3.14159265358979323846;

static const struct {
    const char *name;
    uint32_t low, high; ///< places
} kinds[] = {{"distance", 2, UINT32_MAX}, {"height", 2, 2}, {"angle", 3, 3}, {"area", 3, UINT32_MAX}};

enum { KIND_COUNT = sizeof kinds / sizeof kinds[0] };

const char *ewa_measure_kind_name(uint32_t kind) { return kind < KIND_COUNT ? kinds[kind].name : NULL; }

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void difference(const double *from, const double *to, double by[3]) {
    for (int c = 0; c < 3; c++) by[c] = to[c] - from[c];
}

static void cross(const double a[3], const double b[3], double product[3]) {
    for (int c = 0; c < 3; c++) {
        const int n = (c + 1) % 3, l = (c + 2) % 3;
        product[c] = a[n] * b[l] - a[l] * b[n];
    }
}

/// Adds a step of the line.
static void add_step(const double *from, const double *to, const double up[3], ewa_measurement *m) {
    double by[3];
    difference(from, to, by);
    const double length2 = dot(by, by), rise = dot(by, up);
    m->length_world += sqrt(length2);
    m->horizontal_world += sqrt(fmax(length2 - rise * rise, 0));
}

ewa_status ewa_places_measure(ewa_measure_kind kind, const double *places_world, uint32_t count,
                              const double up_world[3], ewa_measurement *measured) {
    if (!measured) return EWA_ERROR_ARGUMENT;
    *measured = (ewa_measurement){0};
    if ((unsigned)kind >= KIND_COUNT || !places_world || !up_world) return EWA_ERROR_ARGUMENT;
    const double up_length = sqrt(dot(up_world, up_world));
    if (count < kinds[kind].low || count > kinds[kind].high || !(up_length > 0 && isfinite(up_length)))
        return EWA_ERROR_ARGUMENT;
    for (uint64_t i = 0; i < 3 * (uint64_t)count; i++)
        if (!isfinite(places_world[i])) return EWA_ERROR_ARGUMENT;
    double up[3], first_to_last[3], area[3] = {0};
    for (int c = 0; c < 3; c++) up[c] = up_world[c] / up_length;
    for (uint32_t i = 1; i < count; i++)
        add_step(places_world + 3 * (size_t)(i - 1), places_world + 3 * (size_t)i, up, measured);
    const double *last = places_world + 3 * (size_t)(count - 1);
    if (kind == EWA_MEASURE_AREA) add_step(last, places_world, up, measured);
    difference(places_world, last, first_to_last);
    measured->rise_world = dot(first_to_last, up);
    const double away2 = dot(first_to_last, first_to_last);
    const double across = sqrt(fmax(away2 - measured->rise_world * measured->rise_world, 0));
    measured->slope_deg = away2 > 0 ? atan2(measured->rise_world, across) * DEGREES : 0;
    for (uint32_t i = 2; i < count; i++) {
        double a[3], b[3], product[3];
        difference(places_world, places_world + 3 * (size_t)(i - 1), a);
        difference(places_world, places_world + 3 * (size_t)i, b);
        cross(a, b, product);
        for (int c = 0; c < 3; c++) area[c] += 0.5 * product[c];
    }
    measured->area = sqrt(dot(area, area));
    measured->horizontal_area = fabs(dot(area, up));
    if (count == 3) {
        double a[3], b[3], product[3];
        difference(places_world + 3, places_world, a);
        difference(places_world + 3, places_world + 6, b);
        cross(a, b, product);
        measured->angle_deg = atan2(sqrt(dot(product, product)), dot(a, b)) * DEGREES;
    }
    return EWA_OK;
}
