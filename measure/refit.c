// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/colors.md on refitted colours; with a fine cloud and a coarse one of the same
// object as arguments, what refitting the coarse one's colours does to its picture, against that of the fine
// one.
#include "measure/measure.h"
#include "quality/refit_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 800 };

/// Draws a cloud from the front without shading; false when a call fails.
static bool draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera, float *rgba) {
    ewa_surfels *surfels = NULL;
    ewa_renderer *renderer = NULL;
    WITH_DEFAULTS(ewa_render_options, look);
    look.shading = EWA_SHADING_NONE;
    const ewa_frame frame = {.rgba = rgba};
    const bool done = ewa_surfels_create(cloud, NULL, &surfels) == EWA_OK &&
                      ewa_renderer_create(context, &renderer) == EWA_OK &&
                      ewa_render(renderer, surfels, camera, &look, &frame, NULL) == EWA_OK;
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    return done;
}

/// In dB, of linear colours where both pictures are opaque.
static double psnr(const float *a, const float *b) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
        for (size_t c = 0; c < 3 && a[4 * i + 3] >= 1 && b[4 * i + 3] >= 1; c++) {
            const double x = fmin(fmax((double)a[4 * i + c], 0), 1),
                         y = fmin(fmax((double)b[4 * i + c], 0), 1);
            sum += (x - y) * (x - y);
            count++;
        }
    return -10 * log10(sum / count);
}

static int compare_clouds(ewa_context *context, const char *fine_path, const char *coarse_path) {
    ewa_cloud *fine = NULL;
    float *truth = malloc(sizeof(float[4]) * SIDE * SIDE), *shown = malloc(sizeof(float[4]) * SIDE * SIDE);
    ewa_bounds bounds;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = camera.height_px = SIDE;
    ewa_camera_set_fov(&camera, 30);
    const double forward[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    bool done = truth && shown && ewa_cloud_load(context, fine_path, &fine) == EWA_OK &&
                ewa_cloud_measure(fine, &bounds) == EWA_OK &&
                ewa_camera_frame(&camera, &bounds, forward, up, 0.02) == EWA_OK &&
                draw(context, fine, &camera, truth);
    for (int goal = REFIT_PLAIN; done && goal <= EWA_REFIT_FIT; goal++) {
        static const char *const names[] = {"plain", "interpolate", "fit"};
        ewa_cloud *coarse = NULL;
        WITH_DEFAULTS(ewa_refit_options, options);
        options.goal = (ewa_refit)goal;
        done = ewa_cloud_load(context, coarse_path, &coarse) == EWA_OK &&
               (goal == REFIT_PLAIN || ewa_cloud_refit_colors(coarse, &options, NULL) == EWA_OK) &&
               draw(context, coarse, &camera, shown);
        if (done) printf("%s: %.2f dB\n", names[goal + 1], psnr(shown, truth));
        ewa_cloud_destroy(&coarse);
    }
    ewa_cloud_destroy(&fine);
    free(shown);
    free(truth);
    return done ? 0 : 1;
}

int main(int count, char **words) {
    static const char *const names[] = {"checker", "marble", "wood", "noise"};
    static const refit_setting settings[] = {
        {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 1.14, 0}, {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 2, 0},    {EWA_PROCEDURE_MARBLE, 4, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.14, 0},    {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 1.5, 10000, 0.5, 1.6, 0},   {EWA_PROCEDURE_NOISE, 1.5, 10000, 1, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0},       {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.6, 0.02},
        {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0.02},    {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0.05},
    };
    ewa_context *context = make_context(0);
    if (count == 3) {
        const int failed = compare_clouds(context, words[1], words[2]);
        ewa_context_destroy(&context);
        return failed;
    }
    printf("| texture | features per spacing | jitter | radius | noise | plain | interpolate | fit | error "
           "at the "
           "points, plain | interpolate | fit | steps | coefficients |\n"
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        const refit_setting *s = &settings[i];
        ewa_refit_report interpolated = {0}, fitted = {0};
        const double plain_db = refit_scene_psnr(context, s, REFIT_PLAIN, NULL),
                     interpolate_db = refit_scene_psnr(context, s, EWA_REFIT_INTERPOLATE, &interpolated),
                     fit_db = refit_scene_psnr(context, s, EWA_REFIT_FIT, &fitted);
        printf("| %s | %.2g | %g | %g | %g | %.2f dB | %.2f dB | %.2f dB | %.4f | %.4f | %.4f | %u, %u | "
               "%.2g to "
               "%.2g, %.2g to %.2g |\n",
               names[s->texture], s->frequency * 2 / 100, s->jitter, s->radius_scale, s->noise, plain_db,
               interpolate_db, fit_db, interpolated.before_rms, interpolated.after_rms, fitted.after_rms,
               interpolated.iteration_count, fitted.iteration_count, (double)interpolated.low,
               (double)interpolated.high, (double)fitted.low, (double)fitted.high);
    }
    ewa_context_destroy(&context);
    return 0;
}
