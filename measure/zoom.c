// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/kernels.md on time: a slow zoom of sixty frames over the checkerboard to the
// horizon. Each frame is compared with the one before it, resampled by the known zoom, and with the truth:
// what the error against the truth changes from frame to frame, on the same point of the board, is what
// flickers.
#include "measure/measure.h"
#include "quality/checker_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = CHECKER_SIDE, FRAMES = 60 };

static const double ZOOM_PER_FRAME = 1.004;

/// A way to draw the board, and the last frame of it.
typedef struct sequence {
    const char *name;
    checker_setting setting;
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    float (*now)[SIDE], (*before)[SIDE];         ///< grey
    float (*error)[SIDE], (*error_before)[SIDE]; ///< grey minus the truth
    double changed[CHECKER_BANDS], flickered[CHECKER_BANDS], error2[CHECKER_BANDS];
    uint64_t counts[CHECKER_BANDS];
} sequence;

static void fail(const char *what) {
    fprintf(stderr, "measure_zoom: %s failed\n", what);
    exit(1);
}

static void *allocate(size_t size_bytes) {
    void *memory = calloc(1, size_bytes);
    if (!memory) fail("memory");
    return memory;
}

/// A point between pixels by the cubic convolution of Keys, 1981 (a = -1/2). At least two pixels inside.
static double resample(float (*plane)[SIDE], double x_px, double y_px) {
    const double column = floor(x_px - 0.5), line = floor(y_px - 0.5);
    double weights[2][4], sum = 0;
    for (int axis = 0; axis < 2; axis++) {
        const double t = axis ? y_px - 0.5 - line : x_px - 0.5 - column;
        weights[axis][0] = t * (-0.5 + t * (1 - 0.5 * t));
        weights[axis][1] = 1 + t * t * (-2.5 + 1.5 * t);
        weights[axis][2] = t * (0.5 + t * (2 - 1.5 * t));
        weights[axis][3] = t * t * (-0.5 + 0.5 * t);
    }
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            sum += weights[1][j] * weights[0][i] * (double)plane[(int)line + j - 1][(int)column + i - 1];
    return sum;
}

static void compare(sequence *s, const checker_truth *truth, bool first) {
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) s->error[y][x] = s->now[y][x] - (float)truth->box[y][x];
    for (int y = 3; y < SIDE - 3 && !first; y++) {
        const int band = truth->band[y];
        for (int x = 3; x < SIDE - 3 && band >= 0; x++) {
            // Where this point of the board was: nearer to the principal point.
            const double from_x = truth->camera.cx_px + (x + 0.5 - truth->camera.cx_px) / ZOOM_PER_FRAME;
            const double from_y = truth->camera.cy_px + (y + 0.5 - truth->camera.cy_px) / ZOOM_PER_FRAME;
            // Both frames' filters, and the resampling's, see the board only.
            if (!truth->counts[y][x] || !truth->counts[y - 2][x] || truth->band[y - 3] < 0) continue;
            s->changed[band] += fabs((double)s->now[y][x] - resample(s->before, from_x, from_y));
            s->flickered[band] += fabs((double)s->error[y][x] - resample(s->error_before, from_x, from_y));
            s->error2[band] += (double)s->error[y][x] * (double)s->error[y][x];
            s->counts[band]++;
        }
    }
    float(*plane)[SIDE] = s->now;
    s->now = s->before, s->before = plane;
    plane = s->error;
    s->error = s->error_before, s->error_before = plane;
}

static void start(ewa_context *context, sequence *s) {
    if (checker_make(context, &s->setting, &s->surfels) != EWA_OK ||
        ewa_renderer_create(context, &s->renderer) != EWA_OK)
        fail("the board");
    s->now = allocate(SIDE * sizeof *s->now), s->before = allocate(SIDE * sizeof *s->before);
    s->error = allocate(SIDE * sizeof *s->error), s->error_before = allocate(SIDE * sizeof *s->error_before);
}

static void draw(const sequence *s, const ewa_camera *camera, float *rgba) {
    const ewa_render_options options = checker_options(&s->setting);
    const ewa_frame frame = {.rgba = rgba};
    if (ewa_render(s->renderer, s->surfels, camera, &options, &frame, NULL) != EWA_OK) fail("a frame");
    for (int i = 0; i < SIDE * SIDE; i++) s->now[i / SIDE][i % SIDE] = rgba[4 * i];
}

static void finish(sequence *s) {
    double changed[CHECKER_BANDS], flickered[CHECKER_BANDS], rmse[CHECKER_BANDS];
    for (int band = 0; band < CHECKER_BANDS; band++) {
        const double count = (double)s->counts[band];
        changed[band] = 100 * s->changed[band] / count;
        flickered[band] = 100 * s->flickered[band] / count;
        rmse[band] = 100 * sqrt(s->error2[band] / count);
    }
    printf("| %s | %.2f / %.2f / %.2f | %.2f / %.2f / %.2f | %.1f / %.1f / %.1f |\n", s->name, changed[0],
           changed[1], changed[2], flickered[0], flickered[1], flickered[2], rmse[0], rmse[1], rmse[2]);
    ewa_renderer_destroy(&s->renderer);
    ewa_surfels_destroy(&s->surfels);
    free(s->now), free(s->before), free(s->error), free(s->error_before);
}

int main(void) {
    sequence sequences[] = {
        {.name = "truth (resampling only)"},
        {.name = "perspective, h = 0.35", .setting = {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0.38, 0.4, false}},
        {.name = "perspective, h = 0.5", .setting = {EWA_KERNEL_PERSPECTIVE, 3, 0.5, 0.38, 0.4, false}},
        {.name = "perspective, h = 1", .setting = {EWA_KERNEL_PERSPECTIVE, 3, 1, 0.38, 0.4, false}},
        {.name = "perspective, no prefilter", .setting = {EWA_KERNEL_PERSPECTIVE, 3, 0, 0.38, 0.4, false}},
        {.name = "circular, h = 0.35", .setting = {EWA_KERNEL_CIRCULAR, 3, 0.35, 0.38, 0.4, false}},
        {.name = "raycast, h = 0.35", .setting = {EWA_KERNEL_RAYCAST, 3, 0.35, 0.38, 0.4, false}},
        {.name = "one pass, h = 0.35", .setting = {EWA_KERNEL_PERSPECTIVE, 3, 0.35, 0.38, 0.4, true}},
    };
    enum { COUNT = sizeof sequences / sizeof sequences[0] };
    ewa_context *context = make_context(0);
    checker_truth *truth = allocate(sizeof *truth);
    float *rgba = allocate((size_t)SIDE * SIDE * 4 * sizeof *rgba);
    sequences[0].setting = sequences[1].setting;
    for (size_t i = 0; i < COUNT; i++) start(context, &sequences[i]);
    for (int frame = 0; frame < (is_quick() ? 2 : FRAMES); frame++) {
        checker_trace(context, pow(ZOOM_PER_FRAME, frame), truth);
        for (size_t i = 0; i < COUNT; i++) {
            sequence *s = &sequences[i];
            if (i == 0)
                for (int k = 0; k < SIDE * SIDE; k++)
                    s->now[k / SIDE][k % SIDE] = (float)truth->box[k / SIDE][k % SIDE];
            else
                draw(s, &truth->camera, rgba);
            compare(s, truth, frame == 0);
        }
    }
    printf("| kernel | frame to frame %%: far / middle / near | its error, frame to frame %% | RMSE %% |\n"
           "|---|---|---|---|\n");
    for (size_t i = 0; i < COUNT; i++) finish(&sequences[i]);
    free(rgba);
    free(truth);
    ewa_context_destroy(&context);
    return 0;
}
