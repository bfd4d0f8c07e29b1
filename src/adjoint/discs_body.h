// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The kernels of discs.h (docs/math.md sections 3 to 6 and 15). Loops over lanes are written as for one disc, without branches; compilers make vectors of them.
// Each function is that of the same name in src/reference, for discs without clip lines that are not near.
#include "adjoint/disc_back_body.h"

/// `flat` is a constant, or choices by it would keep compilers from making vectors.
LANE void project_lanes(const ewa_disc_view *from, const ewa_disc_points *points, bool flat, ewa_disc_splats *to) {
    ewa_disc_view view = *from; // to which nothing else points
    view.flat = flat;
    const ewa_disc_points at = *points;
    for (int i = 0; i < EWA_DISC_LANES; i++) {
        const disc_splat s = project_disc(&view, load_disc(&view, &at, i));
        to->drawn[i] = s.near ? -1 : s.drawn ? 1 : 0;
        to->is_back[i] = s.is_back ? 1 : 0, to->concave[i] = s.concave ? 1 : 0;
        to->box[0][i] = s.x_begin, to->box[1][i] = s.x_end, to->box[2][i] = s.y_begin, to->box[3][i] = s.y_end;
        to->center_px[0][i] = s.center_x, to->center_px[1][i] = s.center_y;
        to->moved_px[0][i] = s.moved_x, to->moved_px[1][i] = s.moved_y;
        to->variance_px2[0][i] = s.v11, to->variance_px2[1][i] = s.v12, to->variance_px2[2][i] = s.v22;
        to->inverse[0][i] = s.q11, to->inverse[1][i] = s.q12, to->inverse[2][i] = s.q22;
        to->peak[i] = s.peak;
        to->plane[0][i] = s.plane.x, to->plane[1][i] = s.plane.y, to->plane[2][i] = s.plane.z;
        to->half_range[i] = s.half_range, to->key_low[i] = s.key_low, to->key_high[i] = s.key_high, to->epsilon[i] = s.epsilon;
        store_lane(to->center, i, s.center), store_lane(to->axis_u, i, s.u), store_lane(to->axis_v, i, s.v);
        store_lane(to->normal, i, s.normal), store_lane(to->normal_world, i, s.normal_world);
    }
}

static void project(const ewa_disc_view *view, const ewa_disc_points *points, ewa_disc_splats *splats) {
    if (view->flat)
        project_lanes(view, points, true, splats);
    else
        project_lanes(view, points, false, splats);
}

LANE void pull_back_lanes(const ewa_disc_view *from, const ewa_disc_points *points, const double units[3], bool flat,
                          ewa_disc_cotangents *cotangents) {
    ewa_disc_view view = *from;
    view.flat = flat;
    const ewa_disc_points at = *points;
    ewa_disc_cotangents to = *cotangents;
    const double of_others = units[1], of_depths = units[2];
    for (int i = 0; i < EWA_DISC_LANES; i++) {
        const disc_surfel surfel = load_disc(&view, &at, i);
        const disc_splat s = project_disc(&view, surfel);
        disc_moments m = load_moments(&view, &s, &to, i, of_others, of_depths);
        to.drawn[i] = s.near ? -1 : s.drawn ? 1 : 0;
        disc_cotangent by = {.focal_x = 0};
        ellipse_pull_back(&view, &s, &m, &by);
        way_pull_back(&view, &s, &m, surfel.curvature, &by);
        depth_pull_back(&view, &s, &m, &by);
        store_point(&view, &surfel, &s, &m, &by, &to, i);
    }
    *cotangents = to;
}

static void pull_back(const ewa_disc_view *view, const ewa_disc_points *points, const double units[3],
                      ewa_disc_cotangents *cotangents) {
    if (view->flat)
        pull_back_lanes(view, points, units, true, cotangents);
    else
        pull_back_lanes(view, points, units, false, cotangents);
}

const ewa_disc_kernels EWA_VERSION(ewa_disc_kernels) = {.project = project, .pull_back = pull_back};
