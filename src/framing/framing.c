// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Getting the whole of a cloud into a picture, as large as it goes.
#include "framing/framing.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/render.h"
#include "ewa/select.h"
#include "framing/sampling.h"
#include "framing/upright.h"

#include <math.h>
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

double ewa_framing_diagonal(const ewa_bounds *box) {
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
        const double low = ewa_rank_select(numbers, count, skipped);
        for (size_t i = 0; i < count; i++) numbers[i] = points[i][c];
        const double high = ewa_rank_select(numbers, count, count - 1 - skipped);
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
    const double maximum = count ? RIM_RATIO * ewa_rank_select(numbers, count, count / 2) : 0;
    for (size_t i = 0; i < sample->count; i++)
        if (rims_world[i] > maximum) rims_world[i] = maximum;
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

/// Reads the normals of the sampled points, in their order, where the cloud has some.
static ewa_status read_normals(const ewa_cloud *cloud, const point_sample *sample, ewa_framing *framing) {
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL);
    if (!normal || normal->component_count != 3) return EWA_OK;
    framing->normals = ewa_allocate(framing->context, framing->room, sizeof *framing->normals);
    if (!framing->normals) return EWA_ERROR_MEMORY;
    for (size_t i = 0; i < sample->count; i++) {
        double own[3];
        ewa_attribute_read_f64(normal, sample->indices[i], 1, own);
        for (int c = 0; c < 3; c++) framing->normals[i][c] = (float)own[c];
    }
    return EWA_OK;
}

/// Fills a framing from a sample; `numbers` has room for as many.
static void frame_sample(const ewa_cloud *cloud, const point_sample *sample, double radius_scale,
                         double *numbers, ewa_framing *framing) {
    double(*points)[3] = framing->offsets;
    const size_t count = sample->count;
    read_points(cloud, sample, points);
    ewa_bounds inner;
    if (count) trim_box(points, count, numbers, &inner);
    if (count && ewa_framing_diagonal(&inner) > 0 &&
        ewa_framing_diagonal(&framing->box) > FAR_RATIO * ewa_framing_diagonal(&inner)) {
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
        if (framing->normals) memmove(framing->normals[framing->count], framing->normals[i], sizeof *framing->normals);
        framing->count += inside;
    }
}

ewa_status ewa_framing_make(ewa_context *context, size_t room, ewa_framing **framing) {
    *framing = ewa_allocate_zeroed(context, 1, sizeof **framing);
    if (!*framing) return EWA_ERROR_MEMORY;
    **framing = (ewa_framing){
        .context = context,
        .offsets = ewa_allocate(context, room, sizeof *(*framing)->offsets),
        .rims_world = ewa_allocate(context, room, sizeof *(*framing)->rims_world),
        .room = room,
    };
    if ((*framing)->offsets && (*framing)->rims_world) return EWA_OK;
    ewa_framing_destroy(framing);
    return EWA_ERROR_MEMORY;
}

void ewa_framing_destroy(ewa_framing **framing) {
    if (!framing || !*framing) return;
    ewa_framing *own = *framing;
    ewa_release(own->context, own->offsets, own->room, sizeof *own->offsets);
    ewa_release(own->context, own->rims_world, own->room, sizeof *own->rims_world);
    ewa_release(own->context, own->normals, own->room, sizeof *own->normals);
    ewa_release(own->context, own, 1, sizeof *own);
    *framing = NULL;
}

ewa_status ewa_framing_create(const ewa_cloud *cloud, double radius_scale, ewa_framing **framing) {
    if (framing) *framing = NULL;
    if (!cloud || !framing) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    if (!(radius_scale >= 0) || !isfinite(radius_scale))
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "framing: radius_scale is %g, allowed is [0, inf)",
                        radius_scale);
    ewa_bounds box;
    EWA_TRY(ewa_cloud_measure(cloud, &box));
    if (box.finite_count == 0) return ewa_fail(context, EWA_ERROR_NUMERIC, "no point has finite coordinates");
    point_sample sample;
    ewa_status status = ewa_sample_choose(cloud, SAMPLES, &sample);
    double *numbers = NULL;
    if (status == EWA_OK) status = ewa_framing_make(context, sample.count, framing);
    if (status == EWA_OK) status = read_normals(cloud, &sample, *framing);
    if (status == EWA_OK) numbers = ewa_allocate(context, sample.count, sizeof *numbers);
    if (numbers) {
        (*framing)->box = box;
        frame_sample(cloud, &sample, radius_scale, numbers, *framing);
    } else {
        ewa_framing_destroy(framing);
        status = EWA_ERROR_MEMORY;
    }
    ewa_release(context, numbers, sample.count, sizeof *numbers);
    ewa_sample_free(cloud, &sample);
    return status;
}

void ewa_framing_describe(const ewa_framing *framing, ewa_framing_info *info) {
    *info =
        (ewa_framing_info){.box = framing->box, .sample_count = framing->count, .trimmed = framing->trimmed};
    memcpy(info->middle_world, framing->middle_world, sizeof info->middle_world);
}

void ewa_framing_choose(const ewa_framing *framing, ewa_up_convention convention, ewa_upright *upright) {
    const double(*offsets)[3] = (const double(*)[3])framing->offsets;
    *upright = ewa_upright_choose(framing->count, offsets, framing->middle_world, convention);
    if (framing->normals)
        ewa_upright_turn_to_outside(framing->count, offsets, (const float(*)[3])framing->normals, upright);
}

/// Says that nothing can be placed along `direction_world`.
static ewa_status fail_to_place(const ewa_framing *framing, ewa_status status,
                                const double direction_world[3]) {
    const double *low = framing->box.low_world, *high = framing->box.high_world, *d = direction_world;
    return ewa_fail(
        framing->context, status,
        "no camera can be placed: the coordinates, from %g,%g,%g to %g,%g,%g, are too large, or the "
        "direction %g,%g,%g is none",
        low[0], low[1], low[2], high[0], high[1], high[2], d[0], d[1], d[2]);
}

/// For one direction of the picture, `axis` (0: across, 1: down): where the camera has to stand, sideways and
/// in depth, so that every point is between two planes of slope `slope` through it. The nearest such place in
/// `*depth`.
static double fit_axis(const ewa_framing *framing, const double *rotation, int axis, double slope,
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

ewa_status ewa_framing_fit(const ewa_framing *framing, const double direction_world[3],
                           const double up_world[3], ewa_camera *camera) {
    if (!framing || !direction_world || !up_world || !camera) return EWA_ERROR_ARGUMENT;
    const ewa_status status = ewa_camera_frame(camera, &framing->box, direction_world, up_world, MARGIN);
    // Without extent there is nothing to fit; the library's framing of a box of size 1 stays.
    bool flat = ewa_framing_diagonal(&framing->box) == 0;
    for (size_t i = 0; flat && i < framing->count; i++) flat = framing->rims_world[i] == 0;
    if (status != EWA_OK) return fail_to_place(framing, status, direction_world);
    if (framing->count == 0 || flat || camera->projection != EWA_PERSPECTIVE) return EWA_OK;
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

ewa_status ewa_framing_zoom(const ewa_framing *framing, const double eye_world[3], const double up_world[3],
                            ewa_camera *camera) {
    if (!framing || !eye_world || !up_world || !camera || camera->projection != EWA_PERSPECTIVE)
        return EWA_ERROR_ARGUMENT;
    ewa_camera placed = *camera;
    // Where the points are seen from the eye: their picture's middle becomes the direction of the view.
    double target_world[3], low[2], high[2];
    memcpy(target_world, framing->middle_world, sizeof target_world);
    ewa_status status = ewa_camera_look_at(&placed, eye_world, target_world, up_world);
    for (int round = 0; status == EWA_OK && round < 2; round++) {
        low[0] = low[1] = INFINITY;
        high[0] = high[1] = -INFINITY;
        const double *m = placed.world_to_camera;
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
        status = ewa_camera_look_at(&placed, eye_world, target_world, up_world);
    }
    if (status != EWA_OK) return fail_to_place(framing, status, target_world);
    const double inside = 1 - 2 * MARGIN, across = fmax(-low[0], high[0]), down = fmax(-low[1], high[1]);
    const double focal_px = 0.5 * inside * fmin(camera->width_px / across, camera->height_px / down);
    if (!(focal_px > 0) || !isfinite(focal_px))
        return ewa_fail(framing->context, EWA_ERROR_NUMERIC,
                        "no lens at %g,%g,%g shows what is from %g,%g,%g to %g,%g,%g", eye_world[0],
                        eye_world[1], eye_world[2], framing->box.low_world[0], framing->box.low_world[1],
                        framing->box.low_world[2], framing->box.high_world[0], framing->box.high_world[1],
                        framing->box.high_world[2]);
    placed.fx_px = placed.fy_px = focal_px;
    *camera = placed;
    return EWA_OK;
}
