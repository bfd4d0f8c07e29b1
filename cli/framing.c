// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Getting the whole of a cloud into a picture, as large as it goes.
#include "framing.h"
#include "rank.h"
#include "sampling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 1 << 16 };

/// Share of the points beyond each side of the box that is framed when a few points lie far off, and how many
/// times larger the box of all points is then.
static const double FAR_SHARE = 0.005, FAR_RATIO = 3;

/// Discs count as far as so many times the median radius: a giant one may leave the picture, and does not
/// shrink all else.
static const double RIM_RATIO = 3;

/// Room around the object, as a share of the picture. It also holds the outermost points that the sample
/// misses.
static const double MARGIN = 0.04;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double diagonal(const ewa_bounds *box) {
    double squared = 0;
    for (int c = 0; c < 3; c++) {
        const double extent = box->high_world[c] - box->low_world[c];
        squared += extent * extent;
    }
    return sqrt(squared);
}

/// The box of the sampled points without the outermost ones of each side. `numbers` has room for `count`
/// numbers.
static void trim_box(double (*points)[3], size_t count, double *numbers, ewa_bounds *box) {
    const size_t skipped = (size_t)(FAR_SHARE * (double)count);
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < count; i++) numbers[i] = points[i][c];
        const double low = rank_select(numbers, count, skipped);
        for (size_t i = 0; i < count; i++) numbers[i] = points[i][c];
        const double high = rank_select(numbers, count, count - 1 - skipped);
        // The rim that is cut off belongs to the object too: give some back.
        const double rim = 0.05 * (high - low);
        box->low_world[c] = low - rim;
        box->high_world[c] = high + rim;
    }
}

/// Support radius of a point as drawn; 0 when nothing is drawn of it.
static double support_radius(const ewa_attribute *radius, const ewa_attribute *u, const ewa_attribute *v,
                             double cutoff, uint64_t point) {
    double r[3], s[3], reach;
    ewa_attribute_read_f64(u ? u : radius, point, 1, r);
    if (u) {
        // The longer axis of the ellipse: the root of the larger eigenvalue of tu'tu + tv'tv.
        ewa_attribute_read_f64(v, point, 1, s);
        const double uu = dot(r, r), vv = dot(s, s), half = 0.5 * (uu - vv), uv = dot(r, s);
        reach = cutoff * sqrt(0.5 * (uu + vv) + sqrt(half * half + uv * uv));
    } else {
        reach = r[0];
    }
    return reach > 0 && isfinite(reach) ? reach : 0;
}

/// Sets the rims of the sampled points, none over RIM_RATIO times the median. `numbers` has room for as many.
static void read_rims(const ewa_cloud *cloud, const point_sample *sample, double radius_scale,
                      double *numbers, double *rims_world) {
    const ewa_attribute *radius = ewa_cloud_find(cloud, EWA_RADIUS),
                        *u = ewa_cloud_find(cloud, EWA_TANGENT_U), *v = ewa_cloud_find(cloud, EWA_TANGENT_V);
    const bool axes = u && v && u->component_count == 3 && v->component_count == 3;
    const bool sized = axes || (radius && radius->component_count == 1);
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    size_t count = 0;
    for (size_t i = 0; i < sample->count; i++) {
        rims_world[i] = sized ? radius_scale * support_radius(radius, axes ? u : NULL, v, surfels.cutoff,
                                                              sample->indices[i])
                              : 0;
        if (rims_world[i] > 0) numbers[count++] = rims_world[i];
    }
    const double most = count ? RIM_RATIO * rank_select(numbers, count, count / 2) : 0;
    for (size_t i = 0; i < sample->count; i++)
        if (rims_world[i] > most) rims_world[i] = most;
}

/// Reads the sampled points, in the world.
static void read_points(const ewa_cloud *cloud, const point_sample *sample, double (*points)[3]) {
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    for (size_t i = 0; i < sample->count; i++) {
        ewa_attribute_read_f64(position, sample->indices[i], 1, points[i]);
        for (int c = 0; c < 3; c++) points[i][c] += origin_world[c];
    }
}

/// Fills a framing from a sample; `numbers` has room for as many.
static void frame_sample(const ewa_cloud *cloud, const point_sample *sample, double radius_scale,
                         double *numbers, cloud_framing *framing) {
    double(*points)[3] = framing->offsets;
    const size_t count = sample->count;
    read_points(cloud, sample, points);
    ewa_bounds inner;
    if (count) trim_box(points, count, numbers, &inner);
    if (count && diagonal(&inner) > 0 && diagonal(&framing->box) > FAR_RATIO * diagonal(&inner)) {
        framing->trimmed = true;
        for (int c = 0; c < 3; c++) {
            framing->box.low_world[c] = fmax(framing->box.low_world[c], inner.low_world[c]);
            framing->box.high_world[c] = fmin(framing->box.high_world[c], inner.high_world[c]);
        }
    }
    const double *low = framing->box.low_world, *high = framing->box.high_world;
    for (int c = 0; c < 3; c++) framing->middle_world[c] = 0.5 * low[c] + 0.5 * high[c];
    read_rims(cloud, sample, radius_scale, numbers, framing->rims_world);
    for (size_t i = 0; i < count; i++) {
        bool inside = true;
        for (int c = 0; c < 3; c++) inside &= points[i][c] >= low[c] && points[i][c] <= high[c];
        for (int c = 0; c < 3; c++) points[framing->count][c] = points[i][c] - framing->middle_world[c];
        framing->rims_world[framing->count] = framing->rims_world[i];
        framing->count += inside;
    }
}

bool framing_make(cli_session *session, const ewa_cloud *cloud, double radius_scale, cloud_framing *framing) {
    *framing = (cloud_framing){.count = 0};
    const ewa_status status = ewa_cloud_measure(cloud, &framing->box);
    if (status != EWA_OK) {
        session_failed(session, status);
        return false;
    }
    if (framing->box.finite_count == 0) {
        session_fail(session, "no point has finite coordinates");
        return false;
    }
    point_sample sample;
    double *numbers = NULL;
    bool done = sampling_choose(cloud, SAMPLES, &sample);
    if (done) {
        framing->offsets = malloc((sample.count + 1) * sizeof *framing->offsets);
        framing->rims_world = malloc((sample.count + 1) * sizeof *framing->rims_world);
        numbers = malloc((sample.count + 1) * sizeof *numbers);
        done = framing->offsets && framing->rims_world && numbers;
    }
    if (done)
        frame_sample(cloud, &sample, radius_scale, numbers, framing);
    else
        session_fail(session, "out of memory");
    free(numbers);
    free(sample.indices);
    return done;
}

void framing_free(cloud_framing *framing) {
    free(framing->offsets);
    free(framing->rims_world);
    *framing = (cloud_framing){.count = 0};
}

/// For one direction of the picture, `axis` (0: across, 1: down): where the camera has to stand, sideways and
/// in depth, so that every point is between two planes of slope `slope` through it. The nearest such place in
/// `*depth`.
static double fit_axis(const cloud_framing *framing, const double *rotation, int axis, double slope,
                       double *depth) {
    const double slanted = sqrt(1 + slope * slope);
    double above = -INFINITY, below = -INFINITY;
    for (size_t i = 0; i < framing->count; i++) {
        const double *p = framing->offsets[i], *side = rotation + 4 * axis, *ahead = rotation + 8;
        const double x = side[0] * p[0] + side[1] * p[1] + side[2] * p[2];
        const double z = ahead[0] * p[0] + ahead[1] * p[1] + ahead[2] * p[2];
        const double rim = slanted * framing->rims_world[i];
        if (x - slope * z + rim > above) above = x - slope * z + rim;
        if (-x - slope * z + rim > below) below = -x - slope * z + rim;
    }
    // Between the planes: x - c <= slope (z - d) and c - x <= slope (z - d) for a camera at side c and depth
    // d.
    if (slope > 0) *depth = fmin(*depth, -(above + below) / (2 * slope));
    return 0.5 * (above - below);
}

ewa_status framing_fit(const cloud_framing *framing, const double direction_world[3],
                       const double up_world[3], ewa_camera *camera) {
    const ewa_status status = ewa_camera_frame(camera, &framing->box, direction_world, up_world, MARGIN);
    // Without extent there is nothing to fit; the library's framing of a box of size 1 stays.
    bool flat = diagonal(&framing->box) == 0;
    for (size_t i = 0; flat && i < framing->count; i++) flat = framing->rims_world[i] == 0;
    if (status != EWA_OK || framing->count == 0 || flat || camera->projection != EWA_PERSPECTIVE)
        return status;
    double *m = camera->world_to_camera;
    const double inside = 1 - 2 * MARGIN;
    double depth = INFINITY, place[3];
    place[0] = fit_axis(framing, m, 0, inside * camera->width_px / (2 * camera->fx_px), &depth);
    place[1] = fit_axis(framing, m, 1, inside * camera->height_px / (2 * camera->fy_px), &depth);
    place[2] = depth;
    const double *middle = framing->middle_world;
    for (int r = 0; r < 3; r++)
        m[4 * r + 3] =
            -place[r] - (m[4 * r] * middle[0] + m[4 * r + 1] * middle[1] + m[4 * r + 2] * middle[2]);
    return EWA_OK;
}

ewa_status framing_zoom(const cloud_framing *framing, const double eye_world[3], const double up_world[3],
                        ewa_camera *camera) {
    // Where the points are seen from the eye: their picture's middle becomes the direction of the view.
    double target_world[3], low[2], high[2];
    memcpy(target_world, framing->middle_world, sizeof target_world);
    ewa_status status = ewa_camera_look_at(camera, eye_world, target_world, up_world);
    for (int round = 0; status == EWA_OK && round < 2; round++) {
        low[0] = low[1] = INFINITY;
        high[0] = high[1] = -INFINITY;
        const double *m = camera->world_to_camera;
        for (size_t i = 0; i < framing->count; i++) {
            double p[3];
            for (int r = 0; r < 3; r++) {
                p[r] = m[4 * r + 3];
                for (int c = 0; c < 3; c++)
                    p[r] += m[4 * r + c] * (framing->offsets[i][c] + framing->middle_world[c]);
            }
            const double rim = framing->rims_world[i] / p[2];
            for (int c = 0; c < 2 && p[2] > 0; c++) {
                low[c] = fmin(low[c], p[c] / p[2] - rim);
                high[c] = fmax(high[c], p[c] / p[2] + rim);
            }
        }
        if (round == 1) break;
        for (int c = 0; c < 3; c++)
            target_world[c] = eye_world[c] + m[8 + c] + 0.5 * (low[0] + high[0]) * m[c] +
                              0.5 * (low[1] + high[1]) * m[4 + c];
        status = ewa_camera_look_at(camera, eye_world, target_world, up_world);
    }
    if (status != EWA_OK) return status;
    const double inside = 1 - 2 * MARGIN, across = fmax(-low[0], high[0]), down = fmax(-low[1], high[1]);
    const double focal_px = 0.5 * inside * fmin(camera->width_px / across, camera->height_px / down);
    if (!(focal_px > 0) || !isfinite(focal_px)) return EWA_ERROR_NUMERIC;
    camera->fx_px = camera->fy_px = focal_px;
    return EWA_OK;
}

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
static void measure_slices(const cloud_framing *framing, const double shift[3], const double axis[3],
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

bool framing_revolve(cli_session *session, const cloud_framing *framing, const double pivot_world[3],
                     const double axis_world[3], const double direction_world[3], cloud_framing *solid) {
    *solid = (cloud_framing){.count = 0};
    double axis[3], shift[3], ahead[3], low = INFINITY, high = -INFINITY;
    const double length = sqrt(dot(axis_world, axis_world));
    for (int c = 0; c < 3; c++) {
        axis[c] = axis_world[c] / length;
        solid->middle_world[c] = pivot_world[c];
        shift[c] = framing->middle_world[c] - pivot_world[c];
        ahead[c] = direction_world[c];
    }
    // The corners lie evenly about the camera's direction, so that it is aimed at the axis. Seen along the
    // axis any direction will do.
    for (int k = 0; !make_perpendicular(axis, ahead) && k < 3; k++)
        for (int c = 0; c < 3; c++) ahead[c] = c == k;
    const double side[3] = {axis[1] * ahead[2] - axis[2] * ahead[1], axis[2] * ahead[0] - axis[0] * ahead[2],
                            axis[0] * ahead[1] - axis[1] * ahead[0]};
    if (framing->count == 0) { // no sample is finite: the ball around the box
        const double reach = 0.5 * diagonal(&framing->box) + sqrt(dot(shift, shift));
        for (int c = 0; c < 3; c++) {
            solid->box.low_world[c] = pivot_world[c] - reach;
            solid->box.high_world[c] = pivot_world[c] + reach;
        }
        return true;
    }
    for (size_t i = 0; i < framing->count; i++) {
        const double height = dot(axis, framing->offsets[i]) + dot(axis, shift);
        rank_widen(&low, &high, height);
    }
    solid->offsets = malloc(2 * SLICES * CORNERS * sizeof *solid->offsets);
    solid->rims_world = malloc(2 * SLICES * CORNERS * sizeof *solid->rims_world);
    if (!solid->offsets || !solid->rims_world) {
        session_fail(session, "out of memory");
        return false;
    }
    double reach[SLICES], rims_world[SLICES];
    measure_slices(framing, shift, axis, low, high, reach, rims_world);
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
                rank_widen(&box->low_world[c], &box->high_world[c], pivot_world[c] + p[c]);
            }
            const double turned = STEP_COSINE * x - STEP_SINE * y;
            y = STEP_SINE * x + STEP_COSINE * y;
            x = turned;
        }
    }
    box->finite_count = framing->box.finite_count;
    return true;
}
