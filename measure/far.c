// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/quality.md: what is far, drawn whole, from a level in memory and from an octree, against its own
// picture at eight times the resolution. measure_far [POINTS [FILE...]], without generated scenes where POINTS is 0;
// PICTURES=FOLDER keeps the pictures.
#include "measure/measure.h"
#include "quality/far_scene.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

enum { SIDE_PX = 512, QUICK_SIDE_PX = 64, LEVEL_COUNT = 8 };

/// As far apart in pixels as a level's surfels may be: what octrees take for a node's (ewa_lod_options.spacing_px).
#define LEVEL_SPACING_PX 0.5

typedef struct far_run {
    ewa_context *context;
    ewa_renderer *renderer;
    const char *name;
    uint32_t side_px;
    ewa_bounds bounds;
    ewa_surfels *surfels;
    double spacing_world; ///< median
    ewa_lod *lod;
    float *fine, *truth, *other;
} far_run;

static void save(const far_run *run, const char *what, double times, const float *rgba) {
    const char *folder = getenv("PICTURES");
    if (!folder) return;
    char path[512];
    snprintf(path, sizeof path, "%s/%s_%g_%s.exr", folder, run->name, times, what);
    for (char *at = path + strlen(folder) + 1; *at; at++)
        if (*at == '/' || *at == ' ' || *at == ',') *at = '_';
    ewa_image image;
    check(ewa_image_create(run->context, run->side_px, run->side_px, 4, &image));
    memcpy(image.pixels, rgba, (size_t)run->side_px * run->side_px * 4 * sizeof *rgba);
    check(ewa_image_save(&image, path, NULL));
    ewa_image_free(&image);
}

static void draw(const far_run *run, double times, uint32_t finer, uint32_t level, uint32_t supersampling,
                 float *rgba) {
    const ewa_camera camera = far_camera(&run->bounds, times, run->side_px, finer);
    WITH_DEFAULTS(ewa_render_options, options);
    options.level = level, options.supersampling = supersampling;
    check(ewa_render(run->renderer, run->surfels, &camera, &options, &(ewa_frame){.rgba = rgba}, NULL));
}

static void draw_octree(const far_run *run, double times, uint32_t supersampling, float *rgba) {
    const ewa_camera camera = far_camera(&run->bounds, times, run->side_px, 1);
    WITH_DEFAULTS(ewa_render_options, options);
    options.supersampling = supersampling;
    check(ewa_lod_render(run->lod, run->renderer, &camera, &options, NULL, &(ewa_frame){.rgba = rgba}, NULL));
}

/// The coarsest level whose surfels are no farther apart than LEVEL_SPACING_PX in the middle: each has up to four of the
/// level before, so that they are twice as far apart.
static uint32_t level_at(const far_run *run, double times) {
    const ewa_camera camera = far_camera(&run->bounds, times, run->side_px, 1);
    double eye[3], distance2 = 0;
    ewa_camera_eye(&camera, eye);
    for (int c = 0; c < 3; c++) {
        const double off = eye[c] - (run->bounds.low_world[c] + run->bounds.high_world[c]) / 2;
        distance2 += off * off;
    }
    ewa_surfels_info info;
    ewa_surfels_describe(run->surfels, &info);
    double spacing_px = run->spacing_world * camera.fy_px / sqrt(distance2);
    uint32_t level = 0;
    while (level + 1 < info.level_count && 2 * spacing_px <= LEVEL_SPACING_PX) level++, spacing_px *= 2;
    return level;
}

/// Half of the discs are smaller; generated ones are 1.6 spacings in radius, others about as large.
static double median_spacing(const ewa_cloud *cloud) {
    const ewa_attribute *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    const uint64_t count = ewa_cloud_point_count(cloud);
    double *sorted = malloc(count * sizeof *sorted);
    for (uint64_t i = 0; i < count; i++) sorted[i] = (double)((const float *)radius->data)[i];
    qsort(sorted, count, sizeof *sorted, compare_doubles);
    const double median = sorted[count / 2];
    free(sorted);
    return median / 1.6;
}

static void print(const far_run *run, double times, const char *what, const float *rgba) {
    far_errors e;
    far_compare(run->truth, rgba, run->side_px, &e);
    printf("| %s | %g | %s | %.1f | %.1f | %llu of %llu | %+.2f | %+.1f |\n", run->name, times, what, e.screen_db,
           e.linear_db, (unsigned long long)e.open_count, (unsigned long long)e.inner_count, e.fat_px,
           e.lighter_percent);
    fflush(stdout);
    save(run, what, times, rgba);
}

static void print_scene(far_run *run, ewa_cloud *cloud) {
    char path[512];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/measure_far_%ld.copc.laz", folder ? folder : "/tmp", (long)getpid());
    char points[520];
    snprintf(points, sizeof points, "%s.ply", path);
    check(ewa_cloud_save(cloud, points, NULL));
    const char *const paths[1] = {points};
    check(ewa_lod_build(run->context, paths, 1, path, NULL, NULL));
    remove(points);
    check(ewa_lod_open(run->context, path, &run->lod));
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.level_count = LEVEL_COUNT;
    check(ewa_surfels_create(cloud, &options, &run->surfels));
    check(ewa_cloud_measure(cloud, &run->bounds));
    run->spacing_world = median_spacing(cloud);
    const double distances[] = {1, 2, 4, 8, 16};
    for (int i = 0; i < 5; i++) {
        draw(run, distances[i], FAR_FINER, 0, 1, run->fine);
        far_average(run->fine, run->side_px, FAR_FINER, run->truth);
        save(run, "truth", distances[i], run->truth);
        draw(run, distances[i], 1, 0, 1, run->other);
        print(run, distances[i], "all points, supersampling 1", run->other);
        draw(run, distances[i], 1, 0, 0, run->other);
        print(run, distances[i], "all points", run->other);
        const uint32_t level = level_at(run, distances[i]);
        char what[32];
        snprintf(what, sizeof what, "level %u", level);
        draw(run, distances[i], 1, level, 1, run->other);
        if (level) print(run, distances[i], what, run->other);
        draw_octree(run, distances[i], 1, run->other);
        print(run, distances[i], "octree, supersampling 1", run->other);
        draw_octree(run, distances[i], 0, run->other);
        print(run, distances[i], "octree", run->other);
    }
    ewa_surfels_destroy(&run->surfels);
    ewa_lod_close(&run->lod);
    remove(path);
}

int main(int count, char **words) {
    far_run run = {.context = make_context(0), .side_px = is_quick() ? QUICK_SIDE_PX : SIDE_PX};
    const uint64_t points = count > 1 ? strtoull(words[1], NULL, 10) : is_quick() ? 20000 : 1000000;
    const size_t pixels = (size_t)run.side_px * run.side_px;
    check(ewa_renderer_create(run.context, &run.renderer));
    run.fine = malloc(pixels * FAR_FINER * FAR_FINER * 4 * sizeof *run.fine);
    run.truth = malloc(pixels * 4 * sizeof *run.truth);
    run.other = malloc(pixels * 4 * sizeof *run.other);
    printf("| scene | distance | drawn | sRGB, dB | linear, dB | open inner pixels | outlines fat, px | lighter, %% |\n"
           "|---|---:|---|---:|---:|---:|---:|---:|\n");
    for (int kind = 0; points > 0 && kind < FAR_KINDS; kind++) {
        ewa_cloud *cloud = NULL;
        check(far_make(run.context, (far_kind)kind, points, &cloud));
        run.name = far_names[kind];
        print_scene(&run, cloud);
        ewa_cloud_destroy(&cloud);
    }
    for (int i = 2; i < count; i++) {
        ewa_cloud *cloud = NULL;
        WITH_DEFAULTS(ewa_estimate_options, estimate);
        check(ewa_cloud_load(run.context, words[i], &cloud));
        check(ewa_cloud_estimate(&cloud, &estimate));
        run.name = strrchr(words[i], '/') ? strrchr(words[i], '/') + 1 : words[i];
        print_scene(&run, cloud);
        ewa_cloud_destroy(&cloud);
    }
    free(run.fine);
    free(run.truth);
    free(run.other);
    ewa_renderer_destroy(&run.renderer);
    ewa_context_destroy(&run.context);
    return 0;
}
