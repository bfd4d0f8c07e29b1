// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/kernels.md: the kernels on the checkerboard to the horizon (figure 8 of Zwicker,
// Pfister, van Baar, Gross, "Surface Splatting", 2001), and raycast against perspective over the discs'
// radius.
#include "measure/measure.h"
#include "quality/checker_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = CHECKER_SIDE, FLOOR_KERNELS = 3, FLOOR_VIEWS = 8 };

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
                                         sigma,          jitter, rows[i].one_pass};
        checker_errors e;
        if (checker_measure(context, truth, &setting, &e) != EWA_OK) fail("the board");
        printf("| %s | %.2f | %.2f | %.1f / %.1f / %.1f | %.1f / %.1f / %.1f |\n", rows[i].name,
               e.box_psnr_db, e.gauss_psnr_db, e.box_percent[0], e.box_percent[1], e.box_percent[2],
               e.gauss_percent[0], e.gauss_percent[1], e.gauss_percent[2]);
    }
}

/// A floor of discs, black and white in turn.
typedef struct floor_scene {
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    double spacing;
    float *rgba[FLOOR_KERNELS], *coverage[FLOOR_KERNELS];
} floor_scene;

static const ewa_kernel floor_kernels[FLOOR_KERNELS] = {EWA_KERNEL_RAYCAST, EWA_KERNEL_PERSPECTIVE,
                                                        EWA_KERNEL_AFFINE};

static floor_scene make_floor(ewa_context *context, double radius) {
    enum { EXTENT = 5 };
    floor_scene made = {.spacing = radius / EWA_DEFAULT_RADIUS_SCALE};
    const double discs = ceil(EXTENT / made.spacing);
    WITH_DEFAULTS(ewa_generate_options, plane);
    plane.object = EWA_OBJECT_CHECKER;
    plane.point_count = (uint64_t)(discs * discs);
    plane.size_world = discs * made.spacing;
    plane.checks = discs;
    plane.jitter = 0;
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_generate(context, &plane, &cloud) != EWA_OK ||
        ewa_surfels_create(cloud, NULL, &made.surfels) != EWA_OK ||
        ewa_renderer_create(context, &made.renderer) != EWA_OK)
        fail("the floor");
    ewa_cloud_destroy(&cloud);
    for (int k = 0; k < FLOOR_KERNELS; k++) {
        made.rgba[k] = malloc((size_t)SIDE * SIDE * 4 * sizeof(float));
        made.coverage[k] = malloc((size_t)SIDE * SIDE * sizeof(float));
        if (!made.rgba[k] || !made.coverage[k]) fail("memory");
    }
    return made;
}

static void free_floor(floor_scene *made) {
    ewa_renderer_destroy(&made->renderer);
    ewa_surfels_destroy(&made->surfels);
    for (int k = 0; k < FLOOR_KERNELS; k++) free(made->rgba[k]), free(made->coverage[k]);
}

/// Draws the floor by all kernels from a distance of 1, looking down at 30 degrees; each view has another
/// direction and place between the discs.
static void draw_floor(const floor_scene *of, int view) {
    const double azimuth = 2 * PI * (view + 0.3) / FLOOR_VIEWS;
    const double target[3] = {of->spacing * view / FLOOR_VIEWS,
                              of->spacing * (view * 3 % FLOOR_VIEWS) / FLOOR_VIEWS, 0};
    const double eye[3] = {target[0] + cos(PI / 6) * cos(azimuth), target[1] + cos(PI / 6) * sin(azimuth),
                           sin(PI / 6)};
    const double up[3] = {0, 0, 1};
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = camera.height_px = SIDE;
    ewa_camera_set_fov(&camera, 40);
    ewa_camera_look_at(&camera, eye, target, up);
    for (int k = 0; k < FLOOR_KERNELS; k++) {
        WITH_DEFAULTS(ewa_render_options, options);
        options.kernel = floor_kernels[k];
        options.shading = EWA_SHADING_NONE;
        options.edge_antialiasing = false;
        const ewa_frame frame = {.rgba = of->rgba[k], .coverage = of->coverage[k]};
        if (ewa_render(of->renderer, of->surfels, &camera, &options, &frame, NULL) != EWA_OK)
            fail("the floor's picture");
    }
}

static void print_floor(ewa_context *context, double radius) {
    const double count = (double)SIDE * SIDE * FLOOR_VIEWS;
    floor_scene of = make_floor(context, radius);
    double grey2[FLOOR_KERNELS] = {0}, weight[FLOOR_KERNELS] = {0}, sum[FLOOR_KERNELS] = {0},
           sum2[FLOOR_KERNELS] = {0}, lowest[FLOOR_KERNELS] = {1, 1, 1};
    for (int view = 0; view < FLOOR_VIEWS; view++) {
        draw_floor(&of, view);
        for (int k = 0; k < FLOOR_KERNELS; k++)
            for (int i = 0; i < SIDE * SIDE; i++) {
                const double grey = (double)of.rgba[k][4 * i] - (double)of.rgba[0][4 * i];
                const double q = (double)of.coverage[k][i], exact = (double)of.coverage[0][i];
                grey2[k] += grey * grey / count;
                weight[k] += fabs(q - exact) / count;
                sum[k] += q / count;
                sum2[k] += q * q / count;
                lowest[k] = fmin(lowest[k], q);
            }
    }
    printf("| %.3g ", radius);
    for (int k = 1; k < FLOOR_KERNELS; k++)
        printf("| %.1f | %.2g %% ", -10 * log10(grey2[k]), 100 * weight[k] / sum[0]);
    for (int k = 0; k < FLOOR_KERNELS; k++)
        printf("| %.1f %%, %.2f ", 100 * sqrt(sum2[k] - sum[k] * sum[k]) / sum[k], lowest[k]);
    printf("|\n");
    free_floor(&of);
}

int main(void) {
    ewa_context *context = make_context(0);
    checker_truth *truth = malloc(sizeof *truth);
    if (!truth) return 1;
    checker_trace(context, 1, truth);
    print_board(context, truth, 1.4142135623730951, 1, 1, 0);
    print_board(context, truth, 3, 0.35, 0.38, 0.4);
    free(truth);
    printf(
        "\n| radius/distance | perspective: PSNR dB against raycast | weights | affine: PSNR dB | weights | "
        "raycast: unevenness, lowest | perspective | affine |\n|---|---|---|---|---|---|---|---|\n");
    static const double radii[] = {0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) print_floor(context, radii[i]);
    ewa_context_destroy(&context);
    return 0;
}
