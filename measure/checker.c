// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/quality.md: errors of the checkerboard to the horizon over kernel, cutoff,
// prefilter and sigma. The only argument, if any, is the jitter (default 0.4).
#include "measure/measure.h"
#include "quality/checker_scene.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const kernel_names[] = {"perspective", "affine"};

static void print_row(ewa_context *context, const checker_truth *truth, const checker_setting *setting) {
    checker_errors errors;
    if (checker_measure(context, truth, setting, &errors) != EWA_OK) {
        fprintf(stderr, "measure_checker: the picture failed\n");
        exit(1);
    }
    printf("| %s | %.3g | %.3g | %.3g | %.1f / %.1f / %.1f | %.1f / %.1f / %.1f | %llu | %.2f %% | %.2f |\n",
           setting->prefilter_px > 0 ? kernel_names[setting->kernel] : "no prefilter", setting->cutoff,
           setting->prefilter_px, setting->sigma, errors.box_percent[0], errors.box_percent[1],
           errors.box_percent[2], errors.gauss_percent[0], errors.gauss_percent[1], errors.gauss_percent[2],
           (unsigned long long)errors.hole_count, errors.translucent_percent, errors.lowest_alpha);
}

/// Boards of what files have: points with colours, radii estimated, and meshes with pictures; drawn by the defaults.
static void print_sources(ewa_context *context, const checker_truth *truth) {
    static const struct {
        const char *name;
        checker_source source;
        double radius_scale;
    } rows[] = {
        {"points alone", CHECKER_OF_POINTS, 1},
        {"points alone, radii times 0.88", CHECKER_OF_POINTS, 0.88},
        {"points alone, colours refitted", CHECKER_OF_POINTS_REFITTED, 1},
        {"points alone, colours refitted, radii times 0.88", CHECKER_OF_POINTS_REFITTED, 0.88},
        {"mesh with a picture, optimal", CHECKER_OF_MESH, 1},
        {"mesh with a picture, optimal, radii times 0.88", CHECKER_OF_MESH, 0.88},
    };
    const checker_setting setting = {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0, 0, false};
    const ewa_render_options options = checker_options(&setting);
    printf("\n| of | RMSE %%, box: far / middle / near | RMSE %%, Gaussian | alpha < 1 | lowest alpha |\n|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        ewa_surfels *surfels = NULL;
        checker_errors errors;
        ewa_status status = checker_make_from(context, rows[i].source, rows[i].radius_scale, &surfels);
        if (status == EWA_OK) status = checker_compare(context, truth, &options, surfels, &errors);
        ewa_surfels_destroy(&surfels);
        if (status != EWA_OK) {
            fprintf(stderr, "measure_checker: the picture failed\n");
            exit(1);
        }
        printf("| %s | %.1f / %.1f / %.1f | %.1f / %.1f / %.1f | %.2f %% | %.2f |\n", rows[i].name, errors.box_percent[0],
               errors.box_percent[1], errors.box_percent[2], errors.gauss_percent[0], errors.gauss_percent[1],
               errors.gauss_percent[2], errors.translucent_percent, errors.lowest_alpha);
    }
}

int main(int argument_count, char **arguments) {
    const double jitter = argument_count > 1 ? strtod(arguments[1], NULL) : 0.4;
    static const double root2 = 1.4142135623730951;
    const checker_setting settings[] = {
        {EWA_KERNEL_PERSPECTIVE, root2, 1, 0.7, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, root2, 0.5, 0.7, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0.5, 0.6, jitter, false},
        {EWA_KERNEL_AFFINE, 2, 0.5, 0.6, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0, 0.6, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0.5, 0.5, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0.4, 0.6, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0.4, 0.5, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2, 0.35, 0.5, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0.5, 0.44, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0.4, 0.48, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0.4, 0.44, jitter, false},
        {EWA_KERNEL_AFFINE, 2.5, 0.4, 0.44, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0, 0.44, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0.4, 0.4, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 2.5, 0.3, 0.44, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.4, 0.45, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.4, 0.4, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.4, 0.38, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.4, 0.35, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0.4, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0.38, jitter, false},
        {EWA_KERNEL_AFFINE, 3, 0.35, 0.38, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0, 0.38, jitter, false},
        {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0.367, jitter, false},
    };
    ewa_context *context = make_context(0);
    checker_truth *truth = malloc(sizeof *truth);
    if (!truth) return 1;
    checker_trace(context, 1, truth);
    printf("| kernel | F | h px | sigma/spacing | RMSE %%, box: far / middle / near | RMSE %%, Gaussian | "
           "holes | "
           "alpha < 1 | lowest alpha |\n|---|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) print_row(context, truth, &settings[i]);
    print_sources(context, truth);
    free(truth);
    ewa_context_destroy(&context);
    return 0;
}
