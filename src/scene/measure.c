// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Measurements between places.
//
// Areas are those of vectors of triangles about the first place, half the sum of their cross products (M. E. Newell's
// normal of a polygon), which is exact of plane ones and does not lose digits far from the origin.
#include "ewa/measure.h"
#include "homogeneous/vec.h"
#include "math/angle.h"

static const double DEGREES = 180 / EWA_PI;

static const struct {
    const char *name;
    uint32_t low, high; ///< places
} kinds[] = {{"distance", 2, UINT32_MAX}, {"height", 2, 2}, {"angle", 3, 3}, {"area", 3, UINT32_MAX}, {"note", 1, 1}};

enum { KIND_COUNT = sizeof kinds / sizeof kinds[0] };

const char *ewa_measure_kind_name(uint32_t kind) { return kind < KIND_COUNT ? kinds[kind].name : NULL; }

static ewa_vec3 step(const double *from, const double *to) { return vec3_sub(vec3_load(to), vec3_load(from)); }

/// What of a step is across the up axis, without a difference of squares, which would lose the digits of steep ones.
static double length_across(ewa_vec3 by, ewa_vec3 up) { return vec3_length(vec3_sub(by, vec3_scale(up, vec3_dot(by, up)))); }

/// Adds a step of the line.
static void add_step(ewa_vec3 by, ewa_vec3 up, ewa_measurement *m) {
    m->length_world += vec3_length(by);
    m->horizontal_world += length_across(by, up);
}

ewa_status ewa_places_measure(ewa_measure_kind kind, const double *places_world, uint32_t count,
                              const double up_world[3], ewa_measurement *measured) {
    if (!measured) return EWA_ERROR_ARGUMENT;
    *measured = (ewa_measurement){0};
    if ((unsigned)kind >= KIND_COUNT || !places_world || !up_world) return EWA_ERROR_ARGUMENT;
    ewa_vec3 up = vec3_load(up_world), area = {0};
    if (count < kinds[kind].low || count > kinds[kind].high || !vec3_normalize(&up)) return EWA_ERROR_ARGUMENT;
    for (uint64_t i = 0; i < 3 * (uint64_t)count; i++)
        if (!isfinite(places_world[i])) return EWA_ERROR_ARGUMENT;
    const double *first = places_world, *last = places_world + 3 * (size_t)(count - 1);
    for (const double *at = first; at != last; at += 3) add_step(step(at, at + 3), up, measured);
    if (kind == EWA_MEASURE_AREA) add_step(step(last, first), up, measured);
    const ewa_vec3 whole = step(first, last);
    measured->rise_world = vec3_dot(whole, up);
    measured->slope_deg = vec3_length(whole) > 0 ? atan2(measured->rise_world, length_across(whole, up)) * DEGREES : 0;
    for (uint32_t i = 2; i < count; i++) {
        const double *at = places_world + 3 * (size_t)i;
        area = vec3_add(area, vec3_scale(vec3_cross(step(first, at - 3), step(first, at)), 0.5));
    }
    measured->area = vec3_length(area);
    measured->horizontal_area = fabs(vec3_dot(area, up));
    if (count == 3) {
        const ewa_vec3 a = step(first + 3, first), b = step(first + 3, last);
        measured->angle_deg = atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * DEGREES;
    }
    return EWA_OK;
}
