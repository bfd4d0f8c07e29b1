// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The magnified plane and the texture under its pixels.
#include "quality/refit_scene.h"
#include "check.h"
#include "colors/pattern.h"

enum { SIDE = 400 };

static const double SHOWN_WORLD = 1.6;
static const double PREFILTER_PX = 0.35;

static void make_pattern(const refit_setting *setting, ewa_procedure_options *options, pattern *made) {
    ewa_procedure_options_init(options, setting->texture, sizeof *options);
    options->frequency = setting->frequency;
    ewa_pattern_make(options, made);
}

/// The texture's green at a place, under a round Gaussian of deviation `sigma_world`. Off the plane z = 0,
/// which is an edge of the checkerboard of space.
static double truth_at(const pattern *texture, const ewa_procedure_options *options, double x, double y,
                       double sigma_world) {
    const pattern_footprint footprint = {
        {x, y, 0.25 / options->frequency}, {sigma_world, 0, 0}, {0, sigma_world, 0}};
    const double low = (double)options->colors[0][1], high = (double)options->colors[1][1];
    return low + ewa_pattern_mean(texture, &footprint) * (high - low);
}

/// Points of the plane with colours of the texture where they are.
static ewa_cloud *make_cloud(ewa_context *context, const refit_setting *setting, const pattern *texture,
                             const ewa_procedure_options *options) {
    WITH_DEFAULTS(ewa_generate_options, generate);
    generate.object = EWA_OBJECT_PLANE;
    generate.point_count = setting->point_count;
    generate.jitter = setting->jitter;
    generate.radius_scale = setting->radius_scale;
    ewa_cloud *cloud = NULL;
    float *color;
    if (ewa_cloud_generate(context, &generate, &cloud) != EWA_OK ||
        ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 3, (void **)&color) != EWA_OK) {
        ewa_cloud_destroy(&cloud);
        return NULL;
    }
    const float *position = ewa_cloud_find(cloud, EWA_POSITION)->data;
    check_random random = {3};
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        double error = 0; // near to normal: twelve uniform numbers have the variance 1
        for (int k = 0; k < 12; k++) error += check_uniform(&random, -0.5, 0.5);
        const double green =
            truth_at(texture, options, (double)position[3 * i], (double)position[3 * i + 1], 0) +
            setting->noise * error;
        for (uint64_t c = 0; c < 3; c++) color[3 * i + c] = (float)green;
    }
    return cloud;
}

/// Draws the cloud and compares.
static double measure(ewa_context *context, const ewa_cloud *cloud, const pattern *texture,
                      const ewa_procedure_options *options) {
    const double eye[3] = {0, 0, 5}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    ewa_camera camera = check_camera(SIDE, SIDE);
    ewa_camera_look_at(&camera, eye, target, up);
    ewa_camera_set_ortho(&camera, SHOWN_WORLD);
    WITH_DEFAULTS(ewa_render_options, look);
    look.shading = EWA_SHADING_NONE;
    look.prefilter_px = PREFILTER_PX;
    ewa_surfels *surfels = NULL;
    ewa_renderer *renderer = NULL;
    float *rgba = malloc(sizeof(float[4]) * SIDE * SIDE);
    const ewa_frame frame = {.rgba = rgba};
    double sum = -1;
    if (rgba && ewa_surfels_create(cloud, NULL, &surfels) == EWA_OK &&
        ewa_renderer_create(context, &renderer) == EWA_OK &&
        ewa_render(renderer, surfels, &camera, &look, &frame, NULL) == EWA_OK) {
        const double pixel = SHOWN_WORLD / SIDE;
        sum = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double truth = truth_at(texture, options, (x + 0.5 - 0.5 * SIDE) * pixel,
                                              (0.5 * SIDE - y - 0.5) * pixel, PREFILTER_PX * pixel);
                const double shown = fmin(fmax((double)rgba[4 * (y * SIDE + x) + 1], 0), 1);
                sum += (shown - truth) * (shown - truth);
            }
    }
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    free(rgba);
    return sum < 0 ? -1 : -10 * log10(sum / (SIDE * SIDE));
}

double refit_scene_psnr(ewa_context *context, const refit_setting *setting, int goal,
                        ewa_refit_report *report) {
    ewa_procedure_options options;
    pattern texture;
    make_pattern(setting, &options, &texture);
    ewa_cloud *cloud = make_cloud(context, setting, &texture, &options);
    WITH_DEFAULTS(ewa_refit_options, refit);
    refit.goal = (ewa_refit)goal;
    bool done = cloud != NULL;
    if (done && goal != REFIT_PLAIN) done = ewa_cloud_refit_colors(cloud, &refit, report) == EWA_OK;
    const double psnr = done ? measure(context, cloud, &texture, &options) : -1;
    ewa_cloud_destroy(&cloud);
    return psnr;
}
