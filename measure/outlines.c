// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/quality.md: how far outlines of spheres and tori are off against analytic coverage, from random
// points, from levels of detail in memory, from octrees, and from surfels that say no curvature.
// measure_outlines [POINTS...]; PICTURES=FOLDER keeps the pictures.
#include "measure/measure.h"
#include "quality/outline_scene.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = OUTLINE_SIDE_PX, LEVEL_COUNT = 6 };

typedef struct outline_run {
    ewa_context *context;
    ewa_renderer *renderer;
    const char *name;
    uint64_t points;
    ewa_camera camera;
    outline_truth truth;
    float rgba[SIDE * SIDE * 4];
} outline_run;

static void print(outline_run *run, const char *what, uint64_t surfels) {
    const outline_errors found = outline_compare(&run->truth, run->rgba + 3, 4);
    printf("| %s, %llu | %s | %llu | %+.3f | %.3f | %.4f | %.3f | %.4f |\n", run->name, (unsigned long long)run->points, what,
           (unsigned long long)surfels, found.fat_px, found.rms, 100 * found.open, found.deepest, 100 * found.strewn);
    fflush(stdout);
    const char *folder = getenv("PICTURES");
    if (!folder) return;
    char path[512];
    snprintf(path, sizeof path, "%s/%s_%llu_%s.png", folder, run->name, (unsigned long long)run->points, what);
    for (char *at = path + strlen(folder) + 1; *at; at++)
        if (*at == '/' || *at == ' ' || *at == ',') *at = '_';
    ewa_image image;
    check(ewa_image_create(run->context, SIDE, SIDE, 4, &image));
    memcpy(image.pixels, run->rgba, sizeof run->rgba);
    check(ewa_image_save(&image, path, NULL));
    ewa_image_free(&image);
}

static void print_levels(outline_run *run, const ewa_cloud *cloud, const char *what, uint32_t level_count) {
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.level_count = level_count;
    ewa_surfels *surfels = NULL;
    check(ewa_surfels_create(cloud, &options, &surfels));
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    WITH_DEFAULTS(ewa_render_options, render);
    for (uint32_t level = 0; level < info.level_count; level++) {
        render.level = level;
        ewa_render_stats stats;
        check(ewa_render(run->renderer, surfels, &run->camera, &render, &(ewa_frame){.rgba = run->rgba}, &stats));
        char name[64];
        snprintf(name, sizeof name, level ? "%s, level %u" : "%s", what, level);
        print(run, name, stats.splat_count);
    }
    ewa_surfels_destroy(&surfels);
}

/// Writes a cloud into a file beside which others may be made; `path` has room for 256 characters.
static void save(const ewa_cloud *cloud, const char *suffix, char *path) {
    const char *folder = getenv("TMPDIR");
    snprintf(path, 256, "%s/measure_outlines_%ld%s", folder ? folder : "/tmp", (long)getpid(), suffix);
    if (cloud) check(ewa_cloud_save(cloud, path, NULL));
}

/// Draws an octree as coarse as surfels so many pixels apart make it.
static void print_octree(outline_run *run, const ewa_cloud *cloud, const char *what) {
    static const double spacings_px[] = {0.25, 0.5, 1, 2};
    char path[256], points[256];
    save(NULL, ".copc.laz", path);
    save(cloud, ".ply", points);
    const char *const paths[1] = {points};
    check(ewa_lod_build(run->context, paths, 1, path, NULL, NULL));
    remove(points);
    ewa_lod *lod = NULL;
    check(ewa_lod_open(run->context, path, &lod));
    for (int i = 0; i < 4; i++) {
        WITH_DEFAULTS(ewa_lod_options, options);
        options.spacing_px = spacings_px[i];
        options.error = 255;
        options.max_splats = UINT64_C(1) << 40;
        ewa_lod_stats stats;
        check(ewa_lod_render(lod, run->renderer, &run->camera, NULL, &options, &(ewa_frame){.rgba = run->rgba}, &stats));
        char name[64];
        snprintf(name, sizeof name, "%s, %g px", what, spacings_px[i]);
        print(run, name, stats.surfel_count);
    }
    ewa_lod_close(&lod);
    remove(path);
}

static ewa_cloud *estimated(ewa_cloud *cloud) {
    WITH_DEFAULTS(ewa_estimate_options, options);
    check(ewa_cloud_estimate(&cloud, &options));
    return cloud;
}

static void print_shape(outline_run *run, outline_shape shape, uint64_t points) {
    static const double eye[3] = {1.2, -2.6, 1.7};
    run->name = shape == OUTLINE_SPHERE ? "sphere" : "torus";
    run->points = points;
    outline_camera(eye, 42, &run->camera);
    outline_trace(run->context, shape, &run->camera, &run->truth);
    ewa_cloud *bare = outline_points(run->context, shape, points);
    print_octree(run, bare, "octree of points");
    ewa_cloud *cloud = estimated(bare);
    print_levels(run, cloud, "points", LEVEL_COUNT);
    ewa_cloud_remove(cloud, EWA_CURVATURE);
    print_levels(run, cloud, "surfels without curvature", 1);
    print_octree(run, cloud, "octree of surfels without curvature");
    ewa_cloud_destroy(&cloud);
}

int main(int count, char **words) {
    outline_run *run = calloc(1, sizeof *run);
    run->context = make_context(0);
    check(ewa_renderer_create(run->context, &run->renderer));
    printf("| shape | drawn | surfels | fat, px | alpha - truth, rms | open inside, %% | deepest | outside, %% |\n"
           "|---|---|---:|---:|---:|---:|---:|---:|\n");
    uint64_t points[16] = {20000, is_quick() ? 0 : 100000, is_quick() ? 0 : 1000000};
    for (int i = 1; i < count && i < 16; i++) points[i - 1] = strtoull(words[i], NULL, 10), points[i] = 0;
    for (int i = 0; i < 16 && points[i]; i++)
        for (int torus = 0; torus < 2; torus++) print_shape(run, torus ? OUTLINE_TORUS : OUTLINE_SPHERE, points[i]);
    ewa_renderer_destroy(&run->renderer);
    ewa_context_destroy(&run->context);
    free(run);
    return 0;
}
