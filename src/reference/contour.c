// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How far a splat moves away from its contour (semantics.h, contours).
#include "reference/contour.h"
#include "surface/contour.h"
#include "surface/semantics.h"

#include <math.h>

void ewa_reference_view_contours(const ewa_render_options *options, bool transparent, ewa_reference_view *view) {
    view->contour_shift = ewa_contour_shift(options, view->orthographic);
    view->contour_sine2 = ewa_contour_sine2(view->cutoff, view->contour_shift);
    view->transparent = transparent;
}

void ewa_reference_move(const ewa_reference_view *view, const ewa_surfel *surfel, ewa_reference_splat *splat) {
    splat->moved_px[0] = splat->moved_px[1] = 0;
    splat->concave = false;
    if (!(view->contour_shift > 0) || splat->by_rays || splat->clip_count || !(surfel->curvature_world > 0)) return;
    const ewa_vec3 p = splat->center, n = splat->normal; // towards the viewer
    const double depth = view->orthographic ? 1 : p.z;
    const double sine = view->orthographic ? n.z : vec3_dot(n, p) / p.z;
    // Camera space may be larger than the world.
    const double scale = vec3_length(mat3_row(&view->placement.linear, 2));
    const double bend = 2 * surfel->curvature_world / scale * depth / view->fx_px;
    const double sigma_px = view->fx_px * fmax(vec3_length(splat->axis_u), vec3_length(splat->axis_v)) / depth;
    const double wide_px = EWA_CONTOUR_WIDTH * sigma_px * sine;
    const double across = sqrt(view->prefilter_px * view->prefilter_px + wide_px * wide_px);
    const double reach = fmin(EWA_CONTOUR_REACH * across * bend, view->contour_sine2);
    // The key's gradient goes against the lean of a normal that is turned to the viewer.
    const double x = -n.x / view->fx_px, y = -n.y / view->fy_px, length = sqrt(x * x + y * y);
    if (!(sine * sine < reach) || !(length > 0)) return;
    const double way = (splat->is_back ? -1 : 1) * view->contour_shift * across * (1 - sine * sine / reach) / length;
    splat->concave = splat->is_back && !view->transparent && 1 - sine * sine / reach > EWA_CONTOUR_CONCAVE;
    splat->moved_px[0] = way * x, splat->moved_px[1] = way * y;
    const int32_t wider_x = (int32_t)ceil(fabs(way * x)), wider_y = (int32_t)ceil(fabs(way * y));
    splat->x_begin = splat->x_begin > wider_x ? splat->x_begin - wider_x : 0;
    splat->y_begin = splat->y_begin > wider_y ? splat->y_begin - wider_y : 0;
    splat->x_end = splat->x_end < view->width_px - wider_x ? splat->x_end + wider_x : view->width_px;
    splat->y_end = splat->y_end < view->height_px - wider_y ? splat->y_end + wider_y : view->height_px;
}
