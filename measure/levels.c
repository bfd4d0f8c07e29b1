// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/levels.md: how closed levels of detail are, how far from the full picture, what
// they take to make and to draw. measure_levels [POINTS...]
#include "surface/levels.h"
#include "measure/measure.h"
#include "splat/level_scene.h"

#include <math.h>
#include <time.h>

enum { COVER_POINTS = 160000, SIDE_PX = 512, WIDTH_PX = 1280, HEIGHT_PX = 1024, ROUNDS = 15 };

static ewa_surfels *make_surfels(const ewa_cloud *cloud, uint32_t level_count, double *took_s) {
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.level_count = level_count;
    ewa_surfels *surfels = NULL;
    const double start_s = now_s();
    assert_int_equal(ewa_surfels_create(cloud, &options, &surfels), EWA_OK);
    *took_s = now_s() - start_s;
    return surfels;
}

/// The smallest coverage inside of the surface, over q0, for several distances and tilts.
static void print_coverage(ewa_context *context, level_kind kind) {
    static const double distances[] = {0.3, 0.9, 2.2, 6}, tilts[] = {0, 35, 70};
    double took_s;
    ewa_cloud *cloud = level_cloud(context, kind, COVER_POINTS);
    ewa_surfels *surfels = make_surfels(cloud, EWA_MAX_LEVELS, &took_s);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    float *coverage = malloc((size_t)SIDE_PX * SIDE_PX * sizeof *coverage);
    for (uint32_t level = 0; level < info.level_count; level++) {
        double minimum = INFINITY;
        uint64_t inside = 0, thin = 0;
        uint32_t found = level;
        const ewa_surfels *drawn = ewa_levels_find(surfels, &found);
        for (int v = 0; v < 12; v++) {
            const double distance = (kind == LEVEL_SPHERE) + distances[v / 3];
            const ewa_camera camera = level_camera(SIDE_PX, SIDE_PX, distance, tilts[v % 3]);
            WITH_DEFAULTS(ewa_render_options, options);
            options.level = level;
            const ewa_frame frame = {.coverage = coverage};
            assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, NULL), EWA_OK);
            const double margin = fmin(0.3, fmax(0.05, 2 * drawn->cutoff * drawn->largest_sigmas_world[0]));
            for (uint32_t i = 0; i < SIDE_PX * SIDE_PX; i++) {
                if (!level_inside(kind, &camera, i % SIDE_PX, i / SIDE_PX, margin)) continue;
                inside++;
                thin += (double)coverage[i] < options.edge_threshold;
                minimum = fmin(minimum, (double)coverage[i]);
            }
        }
        printf("| %s | %u | %u | %.3f | %llu | %llu | %.3f |\n", level_names[kind], level, drawn->count,
               drawn->unit_coverage, (unsigned long long)inside, (unsigned long long)thin, minimum);
    }
    fflush(stdout);
    free(coverage);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
}

static double psnr_db(const uint8_t *a, const uint8_t *b, size_t pixels) {
    double sum = 0;
    uint64_t count = 0;
    for (size_t i = 0; i < 4 * pixels; i++) {
        if (a[i / 4 * 4 + 3] == 0 && b[i / 4 * 4 + 3] == 0) continue;
        const double difference = (double)a[i] - b[i];
        if (i % 4 < 3) sum += difference * difference, count++;
    }
    return 10 * log10(255.0 * 255.0 * (double)count / sum);
}

/// Frames of each level of a closed sphere, framed whole, and their distance from the full picture, at the
/// whole size and at a quarter of it.
static void print_frames(ewa_context *context, uint32_t points) {
    ewa_cloud *cloud = level_cloud(context, LEVEL_SPHERE, points);
    double times[2][ROUNDS], level_s[ROUNDS];
    ewa_surfels *surfels = NULL;
    for (int round = 0; round < 7; round++) {
        ewa_surfels_destroy(&surfels);
        surfels = make_surfels(cloud, 1, &times[0][round]);
        ewa_surfels_destroy(&surfels);
        surfels = make_surfels(cloud, EWA_MAX_LEVELS, &times[1][round]);
    }
    for (int k = 0; k < 2; k++) qsort(times[k], 7, sizeof(double), compare_doubles);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    printf("\n%u points: surfels %.1f ms, with levels %.1f ms (+%.0f %%), %.2f B/point\n\n", points,
           1e3 * times[0][0], 1e3 * times[1][0], 100 * (times[1][0] / times[0][0] - 1),
           (double)info.resident_bytes / (double)info.point_count);
    printf("| level | surfels | ms | PSNR, dB | of 320x256, dB |\n|---:|---:|---:|---:|---:|\n");
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    const size_t pixels = (size_t)WIDTH_PX * HEIGHT_PX;
    uint8_t *pictures[2] = {malloc(4 * pixels), malloc(4 * pixels)},
            *whole[2] = {malloc(4 * pixels), malloc(4 * pixels)};
    for (uint32_t level = 0; level < info.level_count; level++) {
        ewa_render_stats stats;
        double psnr[2];
        for (int size = 0; size < 2; size++) {
            const ewa_camera camera = level_camera(WIDTH_PX >> 2 * size, HEIGHT_PX >> 2 * size, 2.4, 20);
            WITH_DEFAULTS(ewa_render_options, options);
            options.level = level;
            const ewa_frame frame = {.rgba8 = level ? pictures[size] : whole[size]};
            for (int round = 0; round < (size ? 1 : ROUNDS); round++) {
                assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &frame, &stats), EWA_OK);
                if (!size) level_s[round] = stats.total_s;
            }
            psnr[size] = psnr_db(whole[size], frame.rgba8, pixels >> 4 * size);
        }
        qsort(level_s, ROUNDS, sizeof *level_s, compare_doubles);
        uint32_t found = level;
        printf("| %u | %u | %.1f | %.1f | %.1f |\n", level, ewa_levels_find(surfels, &found)->count,
               1e3 * level_s[ROUNDS / 4], psnr[0], psnr[1]);
    }
    for (int k = 0; k < 2; k++) free(pictures[k]), free(whole[k]);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
}

int main(int argc, char **argv) {
    ewa_context *context = check_context(2, NULL);
    printf("| sampling | level | surfels | q0 | pixels inside | below the threshold | smallest coverage |\n"
           "|---|---:|---:|---:|---:|---:|---:|\n");
    for (int kind = 0; kind < LEVEL_KINDS; kind++) print_coverage(context, (level_kind)kind);
    for (int i = 1; i < argc; i++) print_frames(context, (uint32_t)strtoul(argv[i], NULL, 10));
    ewa_context_destroy(&context);
    return 0;
}
