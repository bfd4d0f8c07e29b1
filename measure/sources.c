// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints what a frame takes when its surfels are one source, and when they are many: a wavy ground of 2.5 million
// surfels, seen from above its near end, cut into square pieces.
#include "ewa/ewa.h"
#include "measure/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 1582, FRAMES = 9, MAX_PER_SIDE = 40, WIDTH_PX = 1280, HEIGHT_PX = 720 };

/// Columns [left, right) and rows [first, end) of the ground's grid, on [-1, 1] x [0, 4].
static ewa_surfels *make_piece(ewa_context *context, uint32_t left, uint32_t right, uint32_t first,
                               uint32_t end) {
    ewa_cloud *cloud = NULL;
    float *position, *normal, *radius;
    uint8_t *color;
    const uint32_t columns = right - left;
    check(ewa_cloud_create(context, (uint64_t)columns * (end - first), &cloud));
    check(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, (void **)&position));
    check(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)&normal));
    check(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)&radius));
    check(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&color));
    for (uint32_t row = first; row < end; row++)
        for (uint32_t column = left; column < right; column++) {
            const size_t i = (size_t)(row - first) * columns + column - left;
            const double x = 4.0 * column / SIDE - 2, y = 4.0 * row / SIDE;
            position[3 * i] = (float)x, position[3 * i + 1] = (float)y;
            position[3 * i + 2] = (float)(0.1 * sin(5 * x) * cos(4 * y));
            const double slope_x = 0.5 * cos(5 * x) * cos(4 * y), slope_y = -0.4 * sin(5 * x) * sin(4 * y);
            const double length = sqrt(1 + slope_x * slope_x + slope_y * slope_y);
            normal[3 * i] = (float)(-slope_x / length), normal[3 * i + 1] = (float)(-slope_y / length);
            normal[3 * i + 2] = (float)(1 / length);
            radius[i] = (float)(2 * 4.0 / SIDE);
            color[3 * i] = (uint8_t)column, color[3 * i + 1] = (uint8_t)row, color[3 * i + 2] = 90;
        }
    ewa_surfels *surfels = NULL;
    check(ewa_surfels_create(cloud, NULL, &surfels));
    ewa_cloud_destroy(&cloud);
    return surfels;
}

static ewa_camera make_camera(void) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = WIDTH_PX, camera.height_px = HEIGHT_PX;
    camera.fx_px = camera.fy_px = WIDTH_PX;
    camera.cx_px = WIDTH_PX / 2.0, camera.cy_px = HEIGHT_PX / 2.0;
    const double eye[3] = {0, -1.2, 1.2}, target[3] = {0, 1.6, 0}, up[3] = {0, 0, 1};
    check(ewa_camera_look_at(&camera, eye, target, up));
    return camera;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Draws the pieces FRAMES times; prints the median, and returns it in seconds.
static double measure(ewa_context *context, ewa_surfels *const *pieces, uint32_t count, uint8_t *rgba8) {
    ewa_renderer *renderer = NULL;
    check(ewa_renderer_create(context, &renderer));
    const ewa_camera camera = make_camera();
    double times_s[FRAMES], stages_s[5] = {0};
    ewa_render_stats stats;
    for (int frame = -1; frame < FRAMES; frame++) {
        check(ewa_render_begin(renderer, &camera, NULL, &(ewa_frame){.rgba8 = rgba8}));
        for (uint32_t i = 0; i < count; i++) check(ewa_render_add(renderer, pieces[i]));
        check(ewa_render_finish(renderer, &stats));
        if (frame < 0) continue;
        times_s[frame] = stats.total_s;
        const double now_s[5] = {stats.bin_s, stats.setup_s, stats.visibility_s, stats.accumulate_s,
                                 stats.edge_s + stats.resolve_s};
        for (int i = 0; i < 5; i++) stages_s[i] += now_s[i] / FRAMES;
    }
    qsort(times_s, FRAMES, sizeof *times_s, compare_numbers);
    printf("%8u %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f %10.0f\n", count, 1e3 * times_s[FRAMES / 2],
           1e3 * stages_s[0], 1e3 * stages_s[1], 1e3 * stages_s[2], 1e3 * stages_s[3], 1e3 * stages_s[4],
           (double)stats.drawn_count);
    ewa_renderer_destroy(&renderer);
    return times_s[FRAMES / 2];
}

int main(void) {
    static const uint32_t per_side[] = {1, 5, 22, MAX_PER_SIDE};
    static ewa_surfels *pieces[MAX_PER_SIDE * MAX_PER_SIDE];
    ewa_context *context = make_context(2);
    uint8_t *rgba8 = malloc((size_t)4 * WIDTH_PX * HEIGHT_PX);
    if (!rgba8) check(EWA_ERROR_MEMORY);
    printf(" sources frame_ms   bin_ms setup_ms  seen_ms   sum_ms pixel_ms     splats\n");
    double one_s = 0;
    for (size_t k = 0; k < sizeof per_side / sizeof per_side[0]; k++) {
        const uint32_t n = per_side[k];
        for (uint32_t i = 0; i < n * n; i++) {
            const uint32_t x = i % n, y = i / n;
            pieces[i] =
                make_piece(context, SIDE * x / n, SIDE * (x + 1) / n, SIDE * y / n, SIDE * (y + 1) / n);
        }
        const double frame_s = measure(context, pieces, n * n, rgba8);
        if (k == 0) one_s = frame_s;
        printf("%24.2f times one source\n", frame_s / one_s);
        for (uint32_t i = 0; i < n * n; i++) ewa_surfels_destroy(&pieces[i]);
    }
    free(rgba8);
    ewa_context_destroy(&context);
    return 0;
}
