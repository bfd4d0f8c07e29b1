// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/levels.md for films: what frames take by all surfels and by levels in memory, and how far these are off.
//
//   measure_detail [POINTS [SIDE]]
#include "ewa/ewa.h"
#include "measure/measure.h"
#include "quality/far_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

/// Processor time in the program, of all threads.
static double user_s(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
}

/// What the frames of one way of drawing take.
typedef struct frames {
    ewa_scene_renderer *renderer;
    ewa_scene_options options;
    uint8_t *rgba8;
    double first_s, best_s; ///< of one camera
    uint32_t level;
} frames;

static void draw(frames *of, ewa_scene *scene, const ewa_camera *camera) {
    of->best_s = INFINITY;
    for (int i = 0; i < 3; i++) {
        ewa_scene_stats stats;
        const double start_s = user_s();
        check(ewa_scene_draw(scene, of->renderer, camera, &of->options, &(ewa_frame){.rgba8 = of->rgba8}, &stats));
        const double took_s = user_s() - start_s;
        if (i == 0) of->first_s = took_s;
        of->best_s = fmin(of->best_s, took_s);
        of->level = stats.render.level;
    }
}

static void print_scene(ewa_context *context, far_kind kind, uint64_t point_count, uint32_t side_px, frames ways[2]) {
    ewa_cloud *cloud;
    ewa_surfels *surfels;
    ewa_asset *asset;
    ewa_scene *scene;
    ewa_bounds bounds;
    check(far_make(context, kind, point_count, &cloud));
    const double start_s = user_s();
    check(ewa_surfels_create(cloud, NULL, &surfels));
    printf("%s: surfels %.0f ms\n", far_names[kind], 1e3 * (user_s() - start_s));
    check(ewa_cloud_measure(cloud, &bounds));
    ewa_cloud_destroy(&cloud);
    const ewa_asset_source source = {.name = far_names[kind], .surfels = surfels};
    check(ewa_asset_create(context, &source, NULL, &asset));
    check(ewa_scene_create(context, NULL, &scene));
    check(ewa_scene_add(scene, asset, NULL));
    ewa_asset_release(&asset);
    for (double times = 0.5; times < 40; times *= sqrt(2)) {
        const ewa_camera camera = far_camera(&bounds, times, side_px, 1);
        for (int w = 0; w < 2; w++) draw(&ways[w], scene, &camera);
        const size_t pixels = (size_t)side_px * side_px;
        double square = 0;
        uint64_t covered = 0;
        for (size_t i = 0; i < pixels; i++) {
            const uint8_t *a = ways[0].rgba8 + 4 * i, *b = ways[1].rgba8 + 4 * i;
            bool shows = false;
            for (int c = 0; c < 3; c++) {
                square += (double)(a[c] - b[c]) * (a[c] - b[c]);
                shows = shows || a[c] < 255 || b[c] < 255;
            }
            covered += shows;
        }
        printf("| %s | %.1f | %.1f %% | %u | %.1f | %.1f (%.0f) | %.2f |\n", far_names[kind], times, 100 * (double)covered / (double)pixels,
               ways[1].level, 1e3 * ways[0].best_s, 1e3 * ways[1].best_s, 1e3 * ways[1].first_s, sqrt(square / (3 * (double)pixels)));
        fflush(stdout);
    }
    ewa_scene_destroy(&scene);
    ewa_surfels_destroy(&surfels);
}

int main(int count, char **words) {
    ewa_context *context = make_context(0);
    const uint64_t points = count > 1 ? strtoull(words[1], NULL, 10) : is_quick() ? 300000 : 2000000;
    const uint32_t side_px = count > 2 ? (uint32_t)strtoul(words[2], NULL, 10) : is_quick() ? 64 : 512;
    frames ways[2];
    for (int w = 0; w < 2; w++) {
        check(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &ways[w].renderer));
        ewa_scene_options_init(&ways[w].options, sizeof ways[w].options);
        ways[w].options.many_frames = w;
        ways[w].rgba8 = malloc(4 * (size_t)side_px * side_px);
    }
    printf("| scene | distance | covered | level | all surfels, ms | levels, ms (first) | rms, 1/255 |\n");
    for (int kind = 0; kind < FAR_KINDS; kind++) print_scene(context, (far_kind)kind, points, side_px, ways);
    for (int w = 0; w < 2; w++) {
        ewa_scene_renderer_destroy(&ways[w].renderer);
        free(ways[w].rgba8);
    }
    ewa_context_destroy(&context);
    return 0;
}
