// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/kernels.md: the kernels on the checkerboard to the horizon (figure 8 of Zwicker,
// Pfister, van Baar, Gross, "Surface Splatting", 2001), and raycast against perspective over the discs'
// radius.
#include "quality/checker_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = CHECKER_SIDE };

#define PI 3.141592653589793

static void fail(const char *what) {
    fprintf(stderr, "measure_kernels: %s failed\n", what);
    exit(1);
}

/// A way to draw the board.
typedef struct row {
    const char *name;
    ewa_kernel kernel;
    bool prefilter, one_pass;
} row;

static void print_board(ewa_context *context, const checker_truth *truth, double cutoff, double prefilter_px,
                        double sigma, double jitter) {
    static const row rows[] = {{"affine (EWA, screen space)", EWA_KERNEL_AFFINE, true, false},
                               {"source (EWA, source space)", EWA_KERNEL_SOURCE, true, false},
                               {"circular", EWA_KERNEL_CIRCULAR, true, false},
                               {"affine, no prefilter", EWA_KERNEL_AFFINE, false, false},
                               {"perspective", EWA_KERNEL_PERSPECTIVE, true, false},
                               {"raycast", EWA_KERNEL_RAYCAST, true, false},
                               {"perspective, one pass", EWA_KERNEL_PERSPECTIVE, true, true}};
    printf("\nF = %.3g, h = %.3g px, sigma = %.3g spacings, jitter %.3g\n\n", cutoff, prefilter_px, sigma,
           jitter);
    printf(
        "| kernel | PSNR dB, box | PSNR dB, Gaussian | RMSE %%, box: far / middle / near | RMSE %%, Gaussian "
        "|\n|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const checker_setting setting = {rows[i].kernel, cutoff, rows[i].prefilter ? prefilter_px : 0,
                                         sigma,          0.4,    rows[i].one_pass};
        checker_errors e;
        if (checker_measure(context, truth, &setting, &e) != EWA_OK) fail("the board");
        printf("| %s | %.2f | %.2f | %.1f / %.1f / %.1f | %.1f / %.1f / %.1f |\n", rows[i].name,
               e.box_psnr_db, e.gauss_psnr_db, e.box_percent[0], e.box_percent[1], e.box_percent[2],
               e.gauss_percent[0], e.gauss_percent[1], e.gauss_percent[2]);
    }
}

/// A floor of discs and the camera that looks down on it at 30 degrees from a distance of 1.
typedef struct floor_scene {
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    ewa_camera camera;
    float *rgba, *coverage;
} floor_scene;

static floor_scene make_floor(ewa_context *context, double radius) {
    enum { EXTENT = 5, CHECK_DISCS = 4 };
    floor_scene made = {0};
    const double spacing = radius / EWA_DEFAULT_RADIUS_SCALE;
    const double discs = ceil(EXTENT / spacing / CHECK_DISCS) * CHECK_DISCS;
    ewa_generate_options plane;
    ewa_generate_options_init(&plane, sizeof plane);
    plane.object = EWA_OBJECT_CHECKER;
    plane.point_count = (uint64_t)(discs * discs);
    plane.size_world = discs * spacing;
    plane.checks = discs / CHECK_DISCS;
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_generate(context, &plane, &cloud) != EWA_OK ||
        ewa_surfels_create(cloud, NULL, &made.surfels) != EWA_OK ||
        ewa_renderer_create(context, &made.renderer) != EWA_OK)
        fail("the floor");
    ewa_cloud_destroy(&cloud);
    const double eye[3] = {0, -cos(PI / 6), sin(PI / 6)}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    ewa_camera_init(&made.camera, sizeof made.camera);
    made.camera.width_px = made.camera.height_px = SIDE;
    ewa_camera_set_fov(&made.camera, 40);
    ewa_camera_look_at(&made.camera, eye, target, up);
    made.rgba = malloc((size_t)SIDE * SIDE * 4 * sizeof *made.rgba);
    made.coverage = malloc((size_t)SIDE * SIDE * sizeof *made.coverage);
    if (!made.rgba || !made.coverage) fail("memory");
    return made;
}

static void free_floor(floor_scene *made) {
    ewa_renderer_destroy(&made->renderer);
    ewa_surfels_destroy(&made->surfels);
    free(made->rgba);
    free(made->coverage);
}

/// Draws the floor into rgba and coverage; returns the smallest and the largest coverage.
static void draw_floor(const floor_scene *of, ewa_kernel kernel, double coverage_range[2]) {
    ewa_render_options options;
    ewa_render_options_init(&options, sizeof options);
    options.kernel = kernel;
    options.shading = EWA_SHADING_NONE;
    options.edge_antialiasing = false;
    const ewa_frame frame = {.rgba = of->rgba, .coverage = of->coverage};
    if (ewa_render(of->renderer, of->surfels, &of->camera, &options, &frame, NULL) != EWA_OK)
        fail("the floor's picture");
    coverage_range[0] = INFINITY, coverage_range[1] = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        coverage_range[0] = fmin(coverage_range[0], (double)of->coverage[i]);
        coverage_range[1] = fmax(coverage_range[1], (double)of->coverage[i]);
    }
}

static void print_floor(ewa_context *context, double radius) {
    floor_scene exact = make_floor(context, radius), other = make_floor(context, radius);
    double exact_range[2], range[2][2], mean[2] = {0, 0}, square[2] = {0, 0}, weight[2] = {0, 0};
    static const ewa_kernel kernels[2] = {EWA_KERNEL_PERSPECTIVE, EWA_KERNEL_AFFINE};
    draw_floor(&exact, EWA_KERNEL_RAYCAST, exact_range);
    for (int k = 0; k < 2; k++) {
        draw_floor(&other, kernels[k], range[k]);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double grey = (double)other.rgba[4 * i] - (double)exact.rgba[4 * i];
            const double coverage = (double)other.coverage[i] / fmax((double)exact.coverage[i], 1e-9) - 1;
            mean[k] += fabs(grey) / (SIDE * SIDE);
            square[k] += grey * grey / (SIDE * SIDE);
            weight[k] += fabs(coverage) / (SIDE * SIDE);
        }
    }
    printf("| %.3g | %.4f %% | %.1f | %.2g %% | %.4f %% | %.1f | %.2g %% | %.2f to %.2f | %.2f to %.2f | "
           "%.2f to "
           "%.2f |\n",
           radius, 100 * mean[0], -10 * log10(square[0]), 100 * weight[0], 100 * mean[1],
           -10 * log10(square[1]), 100 * weight[1], exact_range[0], exact_range[1], range[0][0], range[0][1],
           range[1][0], range[1][1]);
    free_floor(&exact);
    free_floor(&other);
}

int main(void) {
    ewa_context *context = NULL;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    checker_truth *truth = malloc(sizeof *truth);
    if (!truth) return 1;
    checker_trace(context, 1, truth);
    print_board(context, truth, 1.4142135623730951, 1, 1, 0);
    print_board(context, truth, 3, 0.35, 0.38, 0.4);
    free(truth);
    printf("\nraycast on a floor seen at 30 degrees, and how far perspective and affine are from it\n\n");
    printf(
        "| radius/distance | perspective: mean | PSNR dB | sum of weights | affine: mean | PSNR dB | sum of "
        "weights | coverage: raycast | perspective | affine |\n|---|---|---|---|---|---|---|---|---|---|\n");
    static const double radii[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5};
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) print_floor(context, radii[i]);
    ewa_context_destroy(&context);
    return 0;
}
