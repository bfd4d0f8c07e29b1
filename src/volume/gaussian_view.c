// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Defaults and checks of the options of Gaussians; a frame's camera in units of its splats.
#include "volume/gaussian_view.h"
#include "base/base.h"
#include "base/options.h"
#include "surface/options.h"
#include "volume/options.h"
#include "volume/splats.h"

#include <math.h>

#define OF(member) offsetof(ewa_gaussian_options, member)

static const ewa_option rows[] = {
    {"projection", EWA_OPTION_CHOICE, OF(projection), .words = "trained|exact",
     .help =
         "how a Gaussian gets onto the screen: by the affine map at its centre, as in training, or by what "
         "each pixel's ray meets of it"},
    {"order", EWA_OPTION_CHOICE, OF(order), .words = "auto|centre|ray",
     .help = "what is in front of what: by the depth of the centres, as in training, or in each pixel by the depth at "
             "which its ray passes the greatest density; auto: centre of trained, ray of exact"},
    {"filter", EWA_OPTION_CHOICE, OF(filter), .words = "file|thicken|keep",
     .help =
         "what the pixel filter does to small Gaussians: what the file was trained with, of 2DGS a dot at least, nothing "
         "but thicken them, or lower them so that they add as much as before"},
    {"prefilter_px2", EWA_OPTION_F64, OF(prefilter_px2), 0, 16, .initial = 0.3, .unit = "px^2",
     .help = "variance of the pixel filter"},
    {"cutoff", EWA_OPTION_F64, OF(cutoff), 1, 6, .initial = 4,
     .help = "standard deviations at which every Gaussian ends"},
    {"minimum_alpha", EWA_OPTION_F64, OF(minimum_alpha), 1e-6, 0.5, .initial = 1.0 / 255,
     .help = "less of a Gaussian is not drawn"},
    {"minimum_transmittance", EWA_OPTION_F64, OF(minimum_transmittance), 0, 0.999999, .initial = 1.0 / 512,
     .help = "a pixel where less of what is behind would show gets nothing more"},
    {"near_world", EWA_OPTION_F64, OF(near_world), 0, 1e15, .initial = EWA_GAUSSIAN_NEAR_WORLD,
     .unit = "world", .help = "trained: Gaussians whose centres are nearer to the eye along its axis are not drawn"},
    {"merge_px", EWA_OPTION_F64, OF(merge_px), 0, 1000, .unit = "px",
     .help = "of large sets, Gaussians that are within so many pixels (RMS) of one that stands for them are drawn by that; 0: all are "
             "drawn"},
    {"display", EWA_OPTION_CHOICE, OF(display), .words = "blended|ellipsoids|points",
     .help = "what is shown of Gaussians: what they were trained to show, or each as an opaque ellipsoid, lit from the eye, or as a dot"},
    {"ellipsoid_radius", EWA_OPTION_F64, OF(ellipsoid_radius), 0.1, 4, .initial = 1,
     .help = "of ellipsoids, standard deviations"},
    {"dot_px", EWA_OPTION_F64, OF(dot_px), 1, 8, .initial = 2, .unit = "px", .help = "diameter of dots"},
    {"depth", EWA_OPTION_CHOICE, OF(depth), .words = "median|expected",
     .help = "the depth of a pixel: where half of the light is gone, or the mean of all that shows, by how much it shows"},
    {"sh_degree", EWA_OPTION_U32, OF(sh_degree), 0, EWA_MAX_SH_DEGREE, .initial = EWA_MAX_SH_DEGREE,
     .help = "spherical harmonics beyond that degree are not used"},
    {"background", EWA_OPTION_F32, OF(background), 0, 1e15, .count = 4,
     .help = "linear light, straight alpha, which is at most 1"},
    {"section_count", EWA_OPTION_U32, OF(section_count), 0, EWA_MAX_SECTION_PLANES,
     .help = "how many section planes there are"},
};

const ewa_option_table ewa_gaussian_options_table = EWA_OPTION_TABLE(ewa_gaussian_options, rows);

void ewa_gaussian_options_init(ewa_gaussian_options *options, size_t struct_size) {
    ewa_options_init(&ewa_gaussian_options_table, options, struct_size);
}

ewa_status ewa_gaussian_options_choose(ewa_context *context, const ewa_gaussian_options *given,
                                       ewa_gaussian_options *chosen) {
    ewa_gaussian_options_init(chosen, sizeof *chosen);
    EWA_TRY(ewa_options_take(context, &ewa_gaussian_options_table, given, chosen));
    EWA_TRY(ewa_option_check_background(context, chosen->background));
    EWA_TRY(ewa_option_check_sections(context, (const double(*)[4])chosen->section_planes,
                                      chosen->section_count));
    const ewa_surface_planes planes = EWA_SURFACE_PLANES_OF(chosen);
    return ewa_surface_planes_check(context, &planes);
}

/// Rotation and scale of the camera, and where the origin and the eye are.
static void place(ewa_gaussian_camera *made, const ewa_camera *camera, double unit_world,
                  const double origin_world[3]) {
    const double *m = camera->world_to_camera;
    double squares = 0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) squares += m[4 * row + column] * m[4 * row + column];
    const double scale = sqrt(squares / 3);
    made->unit_camera = unit_world * scale;
    double origin[3];
    for (int row = 0; row < 3; row++) {
        origin[row] = m[4 * row + 3] / scale;
        for (int column = 0; column < 3; column++) {
            made->turn.m[row][column] = m[4 * row + column] / scale;
            origin[row] += made->turn.m[row][column] * origin_world[column];
        }
        origin[row] /= unit_world;
    }
    made->origin = vec3_load(origin);
    made->forward = vec3_load(made->turn.m[2]);
    made->eye = vec3_scale(vec3_mul_mat3(made->origin, &made->turn), -1);
}

void ewa_gaussian_camera_make(ewa_gaussian_camera *made, const ewa_camera *camera,
                              const ewa_gaussian_options *options, bool antialiased, double unit_world,
                              const double origin_world[3]) {
    const bool orthographic = camera->projection == EWA_ORTHOGRAPHIC;
    *made = (ewa_gaussian_camera){
        .orthographic = orthographic,
        .trained = options->projection == EWA_PROJECTION_TRAINED || orthographic, // the same there
        .by_center = options->order == EWA_ORDER_CENTER ||
                     (options->order == EWA_ORDER_OF_PROJECTION && options->projection == EWA_PROJECTION_TRAINED),
        .keep = options->filter == EWA_FILTER_OF_SET ? antialiased : options->filter == EWA_FILTER_KEEP,
        .cx_px = camera->cx_px,
        .cy_px = camera->cy_px};
    place(made, camera, unit_world, origin_world);
    made->fx_px = orthographic ? camera->fx_px * made->unit_camera : camera->fx_px;
    made->fy_px = orthographic ? camera->fy_px * made->unit_camera : camera->fy_px;
    made->near = orthographic ? -INFINITY : made->trained ? options->near_world / unit_world : 0;
    // 1.3 times the field of view, and as much beyond the picture where it is not in the middle (3DGS,
    // gsplat).
    const double beyond_x = 0.15 * camera->width_px / camera->fx_px;
    const double beyond_y = 0.15 * camera->height_px / camera->fy_px;
    made->slopes[0] = -camera->cx_px / camera->fx_px - beyond_x;
    made->slopes[1] = (camera->width_px - camera->cx_px) / camera->fx_px + beyond_x;
    made->slopes[2] = -camera->cy_px / camera->fy_px - beyond_y;
    made->slopes[3] = (camera->height_px - camera->cy_px) / camera->fy_px + beyond_y;
}
