// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a cloud that can be drawn to the surfels that are.
#include "resident.h"
#include "faults.h"

#include <math.h>

enum { GAP_POINTS = 1000 };

/// Support radius in units of the spacing under which irregular points leave gaps.
static const double GAP_RADIUS = 1;

static bool make_surfels(cli_session *session, const resident_options *options, const ewa_cloud *cloud,
                         ewa_surfels **surfels, render_report *report) {
    const double started_s = clock_now_s();
    const ewa_status status = ewa_surfels_create(cloud, &options->surfels, surfels);
    report->surfels_s += clock_now_s() - started_s;
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    ewa_surfels_describe(*surfels, &report->surfels);
    return true;
}

/// The discs' median support radius in units of the spacing 1 / sqrt(d) (d: density): from the unit coverage
/// q = s^2 d (1 - exp(-F^2 / 2)) with s = radius / F. Before --radius-scale where that shrinks discs: whoever
/// does so wants gaps.
static double radius_in_spacings(const resident_options *options, const ewa_surfels_info *surfels) {
    const double f = options->surfels.cutoff, kernel = 1 - exp(-0.5 * f * f);
    return f * sqrt(surfels->unit_coverage / kernel) / fmin(options->surfels.radius_scale, 1);
}

/// Measures the radii anew where the file's are so small that there are gaps between the discs; says so.
static bool close_gaps(cli_session *session, const resident_options *wanted, ewa_cloud **cloud,
                       ewa_surfels **surfels, render_report *report) {
    const double radius = radius_in_spacings(wanted, &report->surfels);
    const bool gaps = report->surfels.point_count >= GAP_POINTS && radius < GAP_RADIUS;
    if (!gaps || !ewa_cloud_find(*cloud, EWA_RADIUS) || ewa_cloud_find(*cloud, EWA_TANGENT_U)) return true;
    if (!wanted->close_gaps) {
        session_note(session, "the radii are %.2f of the points' spacing, which leaves gaps", radius);
        return true;
    }
    session_note(session,
                 "the radii are %.2f of the points' spacing, which leaves gaps: larger ones are used "
                 "(--close-gaps off keeps the file's)",
                 radius);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    options.cutoff = wanted->surfels.cutoff;
    options.keep_radii = false;
    const double started_s = clock_now_s();
    ewa_surfels_destroy(surfels);
    const ewa_status status = ewa_cloud_estimate(cloud, &options);
    report->estimate_s += clock_now_s() - started_s;
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    return make_surfels(session, wanted, *cloud, surfels, report);
}

bool resident_make(cli_session *session, const resident_options *options, ewa_cloud **cloud,
                   ewa_surfels **surfels, render_report *report) {
    return make_surfels(session, options, *cloud, surfels, report) &&
           (options->as_points || close_gaps(session, options, cloud, surfels, report)) &&
           faults_report(session, *cloud, &report->surfels);
}
