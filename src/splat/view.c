// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera and options in the single-precision form that the kernels read.
#include "splat/view.h"
#include "kernels/semantics.h"

#include <math.h>
#include <string.h>

/// Splits the upper left 3x3 of world_to_camera into a rotation and its scale.
static double split_scale(const ewa_camera *camera, double rotation[9]) {
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += camera->world_to_camera[4 * i + j] * camera->world_to_camera[4 * i + j];
    const double scale = sqrt(sum / 3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) rotation[3 * i + j] = camera->world_to_camera[4 * i + j] / scale;
    return scale;
}

/// Inward normal of the frustum's side through the eye and the line of slopes a x + b y + c = 0.
static void set_side(float plane[3], double a, double b, double c) {
    const double length = sqrt(a * a + b * b + c * c);
    plane[0] = (float)(a / length), plane[1] = (float)(b / length), plane[2] = (float)(c / length);
}

void ewa_view_set(ewa_view *view, const ewa_surfels *surfels, const ewa_camera *camera,
                  const ewa_render_options *options, uint32_t tile_px) {
    double rotation[9];
    memset(view, 0, sizeof *view);
    const double scale = split_scale(camera, rotation);
    view->scale = (float)scale;
    for (int i = 0; i < 9; i++) view->rotation[i] = (float)rotation[i];
    for (int i = 0; i < 3; i++) {
        const double *row = &camera->world_to_camera[4 * i];
        double t = row[3];
        for (int j = 0; j < 3; j++) t += row[j] * surfels->origin_world[j];
        view->translation[i] = (float)t;
    }
    view->fx_px = (float)camera->fx_px, view->fy_px = (float)camera->fy_px;
    view->cx_px = (float)camera->cx_px, view->cy_px = (float)camera->cy_px;
    const double cutoff = surfels->cutoff, prefilter = options->prefilter_px;
    view->cutoff = (float)cutoff, view->cutoff2 = (float)(cutoff * cutoff);
    view->prefilter2_px2 = (float)(prefilter * prefilter);
    view->reach_px = (float)(cutoff * prefilter);
    // With one pass the nearest splat wins: no tolerance.
    view->tolerance = options->passes == 1 ? 0 : (float)(options->tolerance * cutoff);
    view->grazing_limit = options->passes == 1 ? 0 : (float)(EWA_GRAZING_TOLERANCE * cutoff);
    memcpy(view->color_scale, surfels->color_scale, sizeof view->color_scale);
    memcpy(view->color_offset, surfels->color_offset, sizeof view->color_offset);
    // Halve r^2 / 2 until F^2 / 2 is in the range of the exponential's polynomial.
    view->doublings = 2;
    double exponent_scale = 0.125;
    while (exponent_scale * cutoff * cutoff > EWA_EXPONENT_END) exponent_scale *= 0.5, view->doublings++;
    view->exponent_scale = (float)exponent_scale;
    view->exponent_end = (float)(exponent_scale * cutoff * cutoff);
    view->width_px = camera->width_px, view->height_px = camera->height_px;
    view->tile_px = tile_px;
    view->orthographic = camera->projection == EWA_ORTHOGRAPHIC;
    view->affine = options->kernel == EWA_KERNEL_AFFINE;
    view->cull_back = options->cull == EWA_CULL_BACK;
    view->ellipses = surfels->ellipses;
    const double margin = cutoff * prefilter + 1;
    set_side(view->side_planes[0], camera->fx_px, 0, camera->cx_px + margin);
    set_side(view->side_planes[1], -camera->fx_px, 0, camera->width_px - camera->cx_px + margin);
    set_side(view->side_planes[2], 0, camera->fy_px, camera->cy_px + margin);
    set_side(view->side_planes[3], 0, -camera->fy_px, camera->height_px - camera->cy_px + margin);
}

void ewa_resolve_set(ewa_resolve *resolve, const ewa_surfels *surfels, const ewa_camera *camera,
                     const ewa_render_options *options, const ewa_frame *frame) {
    double rotation[9];
    memset(resolve, 0, sizeof *resolve);
    split_scale(camera, rotation);
    resolve->unit_coverage_inverse = (float)(1 / surfels->unit_coverage);
    resolve->alpha_scale = (float)(1 / (options->edge_threshold * surfels->unit_coverage));
    resolve->one_pass = options->passes == 1;
    resolve->edge_antialiasing = options->edge_antialiasing && !resolve->one_pass;
    resolve->lambert = options->shading == EWA_SHADING_LAMBERT;
    resolve->orthographic = camera->projection == EWA_ORTHOGRAPHIC;
    resolve->ambient = (float)options->ambient;
    const double *light = options->light_world;
    const double length = sqrt(light[0] * light[0] + light[1] * light[1] + light[2] * light[2]);
    resolve->headlight = length == 0;
    for (int i = 0; i < 3; i++) {
        double toward = i == 2 ? -1 : 0; // orthographic headlight: against the view direction
        if (!resolve->headlight)
            toward = (rotation[3 * i] * light[0] + rotation[3 * i + 1] * light[1] +
                      rotation[3 * i + 2] * light[2]) /
                     length;
        resolve->light[i] = (float)toward;
        resolve->background[i] = options->background[i] * options->background[3];
        for (int j = 0; j < 3; j++) resolve->to_world[3 * i + j] = (float)rotation[3 * j + i];
    }
    resolve->background[3] = options->background[3];
    resolve->ray_x[0] = (float)(1 / camera->fx_px),
    resolve->ray_x[1] = (float)(-camera->cx_px / camera->fx_px);
    resolve->ray_y[0] = (float)(1 / camera->fy_px),
    resolve->ray_y[1] = (float)(-camera->cy_px / camera->fy_px);
    resolve->width_px = camera->width_px;
    resolve->rgba8 = frame->rgba8;
    resolve->rgba = frame->rgba;
    resolve->depth = frame->depth;
    resolve->normal = frame->normal;
    resolve->coverage = frame->coverage;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Camera-space direction of a local vector, without scale.
static void turn(const ewa_view *view, const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = view->rotation[3 * i] * v[0] + view->rotation[3 * i + 1] * v[1] +
                 view->rotation[3 * i + 2] * v[2];
}

/// Sets `terms` to the linear function of tile pixels that a direction's dot product with pixel rays is.
static void set_linear(float terms[3], const double n[3], const ewa_view *view, const ewa_tile *tile,
                       double sign) {
    const double x = (tile->x_px - (double)view->cx_px) / view->fx_px;
    const double y = (tile->y_px - (double)view->cy_px) / view->fy_px;
    terms[0] = (float)(sign * (n[0] * x + n[1] * y + n[2]));
    terms[1] = (float)(sign * n[0] / view->fx_px);
    terms[2] = (float)(sign * n[1] / view->fy_px);
}

bool ewa_near_record_set(ewa_near_record *record, const ewa_surfels *surfels, uint32_t surfel,
                         const ewa_view *view, const ewa_tile *tile) {
    ewa_packet_surfel s;
    ewa_packet_decode(surfels, &surfels->packets[surfel / EWA_PACKET_LANES], surfel % EWA_PACKET_LANES, &s);
    double p[3], u[3], v[3], n[3];
    turn(view, s.center, p);
    turn(view, s.axis_u, u);
    turn(view, s.axis_v, v);
    turn(view, s.normal, n);
    const double scale = view->scale;
    for (int i = 0; i < 3; i++) p[i] = scale * p[i] + view->translation[i], u[i] *= scale, v[i] *= scale;
    const double plane = dot(n, p);
    if (fabs(plane) < EWA_EDGE_ON * sqrt(dot(p, p))) return false;
    // u = (q.u) / (u.u) with q = z d - p, z = plane / n.d: a ratio of linear functions of the pixel.
    const double *axes[2] = {u, v};
    float *numerators[2] = {record->u, record->v};
    for (int k = 0; k < 2; k++) {
        const double *a = axes[k], length2 = dot(a, a), along = dot(p, a);
        double m[3];
        for (int i = 0; i < 3; i++) m[i] = (plane * a[i] - along * n[i]) / length2;
        set_linear(numerators[k], m, view, tile, 1);
    }
    set_linear(record->w, n, view, tile, 1);
    record->plane = (float)plane;
    const double range = surfels->cutoff * sqrt(u[2] * u[2] + v[2] * v[2]);
    record->depth_low = (float)(p[2] - range);
    record->depth_high = (float)(p[2] + range);
    const double sigma = sqrt(dot(u, u)), slope_x = n[0] / plane / view->fx_px,
                 slope_y = n[1] / plane / view->fy_px;
    const double per_px = sqrt(slope_x * slope_x + slope_y * slope_y) * p[2] * p[2];
    record->tolerance =
        (float)(view->tolerance * sigma + fmin(view->reach_px * per_px, view->grazing_limit * sigma));
    const double toward = plane > 0 ? -1 : 1; // normals face the viewer
    for (int i = 0; i < 3; i++) {
        record->color[i] = (float)s.color[i];
        record->normal[i] = (float)(toward * n[i]);
    }
    return !(view->cull_back && plane >= 0);
}
