// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a cloud covers while it turns about an axis: slices of a body of revolution, whose circles are polygons.
#include "base/base.h"
#include "framing/framing.h"
#include "framing/widen.h"

#include <math.h>

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Slices of a body of revolution along its axis, and corners of the polygon that stands for a circle.
enum { SLICES = 256, CORNERS = 64 };

/// Cosine and sine of a step from corner to corner; how far out a corner must be for its polygon to hold the
/// circle.
static const double STEP_COSINE = 0.99518472667219693, STEP_SINE = 0.098017140329560604,
                    OUTSIDE = 1.0012059964150579;

/// Makes `v` perpendicular to the unit vector `axis` and scales it to length 1; false when nothing is left.
static bool make_perpendicular(const double axis[3], double v[3]) {
    const double along = dot(axis, v), length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++) v[c] -= along * axis[c];
    const double left = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++) v[c] /= left;
    return left > 1e-6 * length;
}

/// Largest distance from the axis and largest rim of the points in each slice of [low, high] along it; -1: no
/// point.
static void measure_slices(const ewa_framing *framing, const double shift[3], const double axis[3],
                           double low, double high, double reach[SLICES], double rims_world[SLICES]) {
    for (int k = 0; k < SLICES; k++) reach[k] = rims_world[k] = -1;
    for (size_t i = 0; i < framing->count; i++) {
        double p[3];
        for (int c = 0; c < 3; c++) p[c] = framing->offsets[i][c] + shift[c];
        const double height = dot(axis, p);
        // Rounded otherwise than the ends: where these are next to each other it may be far beyond them.
        const double place = high > low ? (height - low) / (high - low) * (SLICES - 1) : 0;
        const int slice = place > 0 ? (place < SLICES - 1 ? (int)place : SLICES - 1) : 0;
        for (int c = 0; c < 3; c++) p[c] -= height * axis[c];
        reach[slice] = fmax(reach[slice], sqrt(dot(p, p)));
        rims_world[slice] = fmax(rims_world[slice], framing->rims_world[i]);
    }
}

/// The framing of nothing but a ball around the box.
static void fill_ball(const ewa_framing *framing, const double shift[3], ewa_framing *solid) {
    const double reach = 0.5 * ewa_framing_diagonal(&framing->box) + sqrt(dot(shift, shift));
    for (int c = 0; c < 3; c++) {
        solid->box.low_world[c] = solid->middle_world[c] - reach;
        solid->box.high_world[c] = solid->middle_world[c] + reach;
    }
}

/// Fills a framing, whose middle is set, with the corners of slices that are met.
static void fill_slices(const double axis[3], const double ahead[3], double low, double high,
                        const double reach[SLICES], const double rims_world[SLICES], ewa_framing *solid) {
    const double side[3] = {axis[1] * ahead[2] - axis[2] * ahead[1], axis[2] * ahead[0] - axis[0] * ahead[2],
                            axis[0] * ahead[1] - axis[1] * ahead[0]};
    ewa_bounds *box = &solid->box;
    *box = (ewa_bounds){.low_world = {INFINITY, INFINITY, INFINITY},
                        .high_world = {-INFINITY, -INFINITY, -INFINITY}};
    for (int k = 0; k < 2 * SLICES; k++) {
        if (reach[k / 2] < 0) continue;
        // Both faces of the slice.
        const double height = low + (high - low) * fmin(1, (double)(k / 2 + k % 2) / (SLICES - 1));
        double x = OUTSIDE * reach[k / 2], y = 0;
        for (int corner = 0; corner < CORNERS; corner++) {
            solid->rims_world[solid->count] = rims_world[k / 2];
            double *p = solid->offsets[solid->count++];
            for (int c = 0; c < 3; c++) {
                p[c] = height * axis[c] + x * ahead[c] + y * side[c];
                widen(&box->low_world[c], &box->high_world[c], solid->middle_world[c] + p[c]);
            }
            const double turned = STEP_COSINE * x - STEP_SINE * y;
            y = STEP_SINE * x + STEP_COSINE * y;
            x = turned;
        }
    }
}

ewa_status ewa_framing_revolve(const ewa_framing *framing, const double pivot_world[3],
                               const double axis_world[3], const double direction_world[3],
                               ewa_framing **solid) {
    if (solid) *solid = NULL;
    if (!framing || !pivot_world || !axis_world || !direction_world || !solid) return EWA_ERROR_ARGUMENT;
    const double length = sqrt(dot(axis_world, axis_world));
    if (!(length > 0) || !isfinite(length))
        return ewa_fail(framing->context, EWA_ERROR_ARGUMENT, "framing: the axis %g,%g,%g has no direction",
                        axis_world[0], axis_world[1], axis_world[2]);
    EWA_TRY(ewa_framing_make(framing->context, framing->count ? 2 * SLICES * CORNERS : 0, solid));
    double axis[3], shift[3], ahead[3], low = INFINITY, high = -INFINITY;
    for (int c = 0; c < 3; c++) {
        axis[c] = axis_world[c] / length;
        (*solid)->middle_world[c] = pivot_world[c];
        shift[c] = framing->middle_world[c] - pivot_world[c];
        ahead[c] = direction_world[c];
    }
    if (framing->count == 0) { // no sample is finite
        fill_ball(framing, shift, *solid);
        return EWA_OK;
    }
    // The corners lie evenly about the camera's direction, so that it is aimed at the axis. Seen along the
    // axis any direction will do.
    for (int k = 0; !make_perpendicular(axis, ahead) && k < 3; k++)
        for (int c = 0; c < 3; c++) ahead[c] = c == k;
    for (size_t i = 0; i < framing->count; i++) {
        const double height = dot(axis, framing->offsets[i]) + dot(axis, shift);
        widen(&low, &high, height);
    }
    double reach[SLICES], rims_world[SLICES];
    measure_slices(framing, shift, axis, low, high, reach, rims_world);
    fill_slices(axis, ahead, low, high, reach, rims_world, *solid);
    (*solid)->box.finite_count = framing->box.finite_count;
    return EWA_OK;
}
