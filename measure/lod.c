// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/scale.md: how far pictures of octrees are from those of all points, how steady they are when the
// camera moves, what they take.
//
//   measure_lod build OUT.copc.laz IN...       makes an octree and says what it took
//   measure_lod quality FILE [SPACING...]   PSNR against all points, of the octree and of picks of as many points
//   measure_lod dolly FILE [FRAMES [ALL [OCTREE [FIRST]]]]  steps between the frames of a slow dolly, of parts that the sides of pixels are
//                                            divided into, from FIRST times the distance on at which all fills the picture
//   measure_lod speed FILE [DISTANCE]       cold and warm frames
#include "ewa/ewa.h"
#include "measure/measure.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

enum { WIDTH_PX = 1280, HEIGHT_PX = 720, PIXELS = WIDTH_PX * HEIGHT_PX, INSIDE_PX = 3 };

/// Processor time in the program, of all threads.
static double user_s(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
}

static double peak_mib(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/// A camera that sees the whole from `times` the distance at which it fills the picture.
static ewa_camera camera_at(const ewa_bounds *bounds, double times) {
    static const double direction[3] = {-0.3, 0.8, -0.5}, up[3] = {0, 0, 1};
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = WIDTH_PX, camera.height_px = HEIGHT_PX;
    check(ewa_camera_set_fov(&camera, 40));
    check(ewa_camera_frame(&camera, bounds, direction, up, 0));
    double eye[3], middle[3];
    ewa_camera_eye(&camera, eye);
    for (int c = 0; c < 3; c++) {
        middle[c] = (bounds->low_world[c] + bounds->high_world[c]) / 2;
        eye[c] = middle[c] + (eye[c] - middle[c]) * times;
    }
    check(ewa_camera_look_at(&camera, eye, middle, up));
    return camera;
}

/// Mean square differences of two pictures over what shows something, and over what has nothing else around it.
typedef struct comparison {
    double object_db, inside_db;
    uint64_t object_count, inside_count;
} comparison;

static bool is_inside(const uint8_t *rgba, int x, int y) {
    for (int dy = -INSIDE_PX; dy <= INSIDE_PX; dy++)
        for (int dx = -INSIDE_PX; dx <= INSIDE_PX; dx++) {
            const int u = x + dx, v = y + dy;
            if (u < 0 || v < 0 || u >= WIDTH_PX || v >= HEIGHT_PX || rgba[4 * (v * WIDTH_PX + u) + 3] < 255)
                return false;
        }
    return true;
}

static double db(double square, uint64_t count) {
    return count ? 10 * log10(255 * 255 / fmax(square / (3 * (double)count), 1e-9)) : 0;
}

static comparison compare(const uint8_t *full, const uint8_t *other) {
    comparison c = {0, 0, 0, 0};
    double object = 0, inside = 0;
    for (int y = 0; y < HEIGHT_PX; y++)
        for (int x = 0; x < WIDTH_PX; x++) {
            const uint8_t *p = full + 4 * (y * WIDTH_PX + x), *q = other + 4 * (y * WIDTH_PX + x);
            if (!p[3] && !q[3]) continue;
            double square = 0;
            for (int k = 0; k < 3; k++) {
                const double d = p[k] * p[3] / 255.0 - q[k] * q[3] / 255.0;
                square += d * d;
            }
            object += square;
            c.object_count++;
            if (!is_inside(full, x, y)) continue;
            inside += square;
            c.inside_count++;
        }
    c.object_db = db(object, c.object_count), c.inside_db = db(inside, c.inside_count);
    return c;
}

static ewa_render_options unlit(void) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = getenv("LIT") ? EWA_SHADING_LAMBERT : EWA_SHADING_NONE;
    return options;
}

static void save(ewa_context *context, const char *name, const uint8_t *rgba) {
    const char *folder = getenv("PICTURES");
    char path[512];
    if (!folder) return;
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    check(ewa_png_save(context, path, WIDTH_PX, HEIGHT_PX, 4, rgba, (size_t)4 * WIDTH_PX));
}

/// Loads all points as surfels.
static ewa_cloud *load(ewa_context *context, const char *path, bool has_surfels) {
    ewa_cloud *cloud = NULL;
    WITH_DEFAULTS(ewa_estimate_options, options);
    check(ewa_cloud_load(context, path, &cloud));
    if (!has_surfels) check(ewa_cloud_estimate(&cloud, &options));
    return cloud;
}

static int build(ewa_context *context, int count, char **words) {
    WITH_DEFAULTS(ewa_lod_build_options, options);
    if (getenv("MEMORY")) options.memory_bytes = strtoull(getenv("MEMORY"), NULL, 10);
    ewa_lod_build_stats stats;
    check(ewa_lod_build(context, (const char *const *)words + 1, (uint32_t)count - 1, words[0], &options,
                        &stats));
    printf("%llu points, %llu left out, %llu merged, %u nodes, %u levels, %.1f B/point temporary, %.0f MiB "
           "resident\n",
           (unsigned long long)stats.point_count, (unsigned long long)stats.left_out_count,
           (unsigned long long)stats.merged_count, stats.node_count, stats.level_count,
           (double)stats.temporary_bytes / (double)stats.point_count, peak_mib());
    printf("statistics %.1f s, distribute %.1f s, estimate %.1f s, nodes %.1f s, merge %.1f s, all %.1f s: %.3f "
           "M points/s\n",
           stats.statistics_s, stats.distribute_s, stats.estimate_s, stats.write_s, stats.merge_s,
           stats.total_s, 1e-6 * (double)stats.point_count / stats.total_s);
    return 0;
}

/// Makes surfels of every k-th point, with areas that make up for it, as programs do that draw samples.
static ewa_surfels *pick(ewa_context *context, const ewa_cloud *cloud, uint64_t count) {
    const uint64_t all = ewa_cloud_point_count(cloud);
    uint64_t *indices = malloc(count * sizeof *indices);
    uint64_t state = 1;
    for (uint64_t i = 0; i < count; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        indices[i] = i * all / count + (state >> 33) % (all / count + 1);
        if (indices[i] >= all) indices[i] = all - 1;
    }
    ewa_cloud *some = NULL;
    check(ewa_cloud_select(cloud, indices, count, &some));
    free(indices);
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.radius_scale = sqrt((double)all / (double)count);
    ewa_surfels *surfels = NULL;
    check(ewa_surfels_create(some, &options, &surfels));
    ewa_cloud_destroy(&some);
    (void)context;
    return surfels;
}

static int quality(ewa_context *context, int count, char **words) {
    ewa_lod *lod = NULL;
    ewa_lod_info info;
    check(ewa_lod_open(context, words[0], &lod));
    ewa_lod_describe(lod, &info);
    ewa_cloud *cloud = load(context, words[0], info.surfels);
    ewa_surfels *surfels = NULL;
    check(ewa_surfels_create(cloud, NULL, &surfels));
    ewa_surfels_info facts;
    ewa_surfels_describe(surfels, &facts);
    ewa_renderer *renderer = NULL;
    check(ewa_renderer_create(context, &renderer));
    uint8_t *full = malloc((size_t)4 * PIXELS), *other = malloc((size_t)4 * PIXELS);
    printf("%llu points, q0 %.4f\n", (unsigned long long)info.point_count, facts.unit_coverage);
    printf("distance spacing   surfels cubes  object  inside | picks object  inside | pixels\n");
    const double distances[] = {1, 1.4, 2, 2.8, 4, 8};
    for (size_t d = 0; d < sizeof distances / sizeof *distances; d++) {
        const ewa_camera camera = camera_at(&info.bounds, distances[d]);
        const ewa_render_options options = unlit();
        const ewa_frame frame = {.rgba8 = full}, frame2 = {.rgba8 = other};
        check(ewa_render(renderer, surfels, &camera, &options, &frame, NULL));
        char full_name[64];
        snprintf(full_name, sizeof full_name, "full_%g", distances[d]);
        save(context, full_name, full);
        for (int s = 0; s < (count > 1 ? count - 1 : 2); s++) {
            WITH_DEFAULTS(ewa_lod_options, lod_options);
            lod_options.spacing_px = count > 1 ? atof(words[1 + s]) : 0.5 + 0.5 * s;
            lod_options.error = getenv("ERROR") ? atof(getenv("ERROR")) : 255;
            lod_options.memory_bytes = (uint64_t)1 << 33;
            ewa_lod_stats stats;
            check(ewa_lod_render(lod, renderer, &camera, &options, &lod_options, &frame2, &stats));
            const comparison c = compare(full, other);
            char name[64];
            snprintf(name, sizeof name, "lod_%g_%g", distances[d], lod_options.spacing_px);
            save(context, name, other);
            comparison p = {0, 0, 0, 0};
            if (stats.surfel_count < info.point_count) {
                ewa_surfels *picks = pick(context, cloud, stats.surfel_count);
                check(ewa_render(renderer, picks, &camera, &options, &frame2, NULL));
                ewa_surfels_destroy(&picks);
                p = compare(full, other);
            }
            printf("%8g %7g %9llu %5u  %6.2f  %6.2f |       %6.2f  %6.2f | %llu\n", distances[d],
                   lod_options.spacing_px, (unsigned long long)stats.surfel_count, stats.node_count,
                   c.object_db, c.inside_db, p.object_db, p.inside_db, (unsigned long long)c.object_count);
        }
    }
    free(full);
    free(other);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
    ewa_lod_close(&lod);
    return 0;
}

/// Colours of pixels that show next to nothing say nothing.
static void put_over_black(uint8_t *rgba) {
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t c = 0; c < 3; c++)
            rgba[4 * i + c] = (uint8_t)((rgba[4 * i + c] * rgba[4 * i + 3] + 127) / 255);
}

static int dolly(ewa_context *context, int count, char **words) {
    const int frame_count = count > 1 ? atoi(words[1]) : 240;
    const double first = count > 4 ? atof(words[4]) : 1.2;
    ewa_lod *lod = NULL;
    ewa_lod_info info;
    check(ewa_lod_open(context, words[0], &lod));
    ewa_lod_describe(lod, &info);
    ewa_cloud *cloud = load(context, words[0], info.surfels);
    ewa_surfels *surfels = NULL;
    check(ewa_surfels_create(cloud, NULL, &surfels));
    ewa_renderer *renderer = NULL;
    check(ewa_renderer_create(context, &renderer));
    uint8_t *pictures[4];
    for (int i = 0; i < 4; i++) pictures[i] = malloc((size_t)4 * PIXELS);
    double largest_step = 0, last_rms = 0;
    int max_jump = 0;
    uint64_t jumps = 0, values = 0;
    for (int f = 0; f < frame_count; f++) {
        const ewa_camera camera = camera_at(&info.bounds, first * pow(1.01, f));
        ewa_render_options options = unlit(), of_octree = unlit();
        if (count > 2) options.supersampling = (uint32_t)atoi(words[2]);
        if (count > 3) of_octree.supersampling = (uint32_t)atoi(words[3]);
        const ewa_frame full = {.rgba8 = pictures[f & 1]}, part = {.rgba8 = pictures[2 + (f & 1)]};
        WITH_DEFAULTS(ewa_lod_options, lod_options);
        lod_options.memory_bytes = (uint64_t)1 << 33;
        if (getenv("ERROR")) lod_options.error = atof(getenv("ERROR"));
        check(ewa_render(renderer, surfels, &camera, &options, &full, NULL));
        check(ewa_lod_render(lod, renderer, &camera, &of_octree, &lod_options, &part, NULL));
        put_over_black(full.rgba8);
        put_over_black(part.rgba8);
        double square = 0;
        uint64_t shown = 0;
        int jump = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            if (!full.rgba8[4 * i + 3] && !part.rgba8[4 * i + 3]) continue;
            shown++;
            for (uint32_t c = 0; c < 4; c++) {
                const int error = part.rgba8[4 * i + c] - full.rgba8[4 * i + c];
                if (c < 3) square += error * error;
                if (f == 0) continue;
                const int own = abs(pictures[2 + (f & 1)][4 * i + c] - pictures[2 + (~f & 1)][4 * i + c]),
                          of_full = abs(pictures[f & 1][4 * i + c] - pictures[~f & 1][4 * i + c]);
                jump = own - of_full > jump ? own - of_full : jump;
                jumps += own - of_full > 8;
                values++;
            }
        }
        const double rms = sqrt(square / (3 * (double)(shown ? shown : 1)));
        if (f && fabs(rms - last_rms) > largest_step) largest_step = fabs(rms - last_rms);
        max_jump = jump > max_jump ? jump : max_jump;
        if (getenv("VERBOSE")) printf("%3d rms %.3f jump %d\n", f, rms, jump);
        last_rms = rms;
    }
    printf("%d frames: rms error changes by at most %.3f/255 a frame; largest jump beyond the full picture's "
           "%d/255, %llu of %llu values beyond 8\n",
           frame_count, largest_step, max_jump, (unsigned long long)jumps, (unsigned long long)values);
    for (int i = 0; i < 4; i++) free(pictures[i]);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
    ewa_lod_close(&lod);
    return 0;
}

static int speed(ewa_context *context, int count, char **words) {
    enum { ROUNDS = 9 };
    const double start_s = now_s();
    ewa_lod *lod = NULL;
    ewa_lod_info info;
    check(ewa_lod_open(context, words[0], &lod));
    ewa_lod_describe(lod, &info);
    ewa_renderer *renderer = NULL;
    check(ewa_renderer_create(context, &renderer));
    uint8_t *rgba = malloc((size_t)4 * PIXELS);
    const ewa_camera camera = camera_at(&info.bounds, count > 1 ? atof(words[1]) : 1);
    const ewa_render_options options = unlit();
    const ewa_frame frame = {.rgba8 = rgba};
    WITH_DEFAULTS(ewa_lod_options, lod_options);
    ewa_lod_stats stats;
    double warm_s = INFINITY, warm_user_s = INFINITY;
    for (int i = 0; i < ROUNDS; i++) {
        const double before_s = i ? now_s() : start_s, before_user_s = user_s();
        check(ewa_lod_render(lod, renderer, &camera, &options, &lod_options, &frame, &stats));
        const double took_s = now_s() - before_s;
        if (i == 0)
            printf(
                "%llu points: cold %.3f s (read %.3f s, draw %.3f s), %llu surfels in %u cubes, %u bands\n",
                (unsigned long long)info.point_count, took_s, stats.load_s, stats.render.total_s,
                (unsigned long long)stats.surfel_count, stats.node_count, stats.band_count);
        else if (took_s < warm_s)
            warm_s = took_s;
        const double took_user_s = user_s() - before_user_s;
        if (i && took_user_s < warm_user_s) warm_user_s = took_user_s;
        if (!i) printf("cold, user %.3f s\n", took_user_s);
    }
    uint64_t covered = 0;
    for (size_t i = 0; i < PIXELS; i++) covered += rgba[4 * i + 3] > 0;
    printf("warm %.3f s (user %.3f s, choose %.4f s), %.0f MiB of cubes, %.0f MiB resident, %.2f surfels for a covered pixel\n", warm_s,
           warm_user_s, stats.choose_s, (double)stats.resident_bytes / 1048576, peak_mib(),
           (double)stats.surfel_count / (double)covered);
    printf("thread time: bins %.3f s, set-up %.3f s, visibility %.3f s, accumulation %.3f s, edges %.3f s, "
           "resolve %.3f s\n",
           stats.render.bin_s, stats.render.setup_s, stats.render.visibility_s, stats.render.accumulate_s,
           stats.render.edge_s, stats.render.resolve_s);
    save(context, "speed", rgba);
    free(rgba);
    ewa_renderer_destroy(&renderer);
    ewa_lod_close(&lod);
    return 0;
}

int main(int count, char **words) {
    ewa_context *context = make_context(getenv("THREADS") ? (uint32_t)atoi(getenv("THREADS")) : 0);
    int status = 2;
    if (count > 3 && strcmp(words[1], "build") == 0) status = build(context, count - 2, words + 2);
    if (count > 2 && strcmp(words[1], "quality") == 0) status = quality(context, count - 2, words + 2);
    if (count > 2 && strcmp(words[1], "dolly") == 0) status = dolly(context, count - 2, words + 2);
    if (count > 2 && strcmp(words[1], "speed") == 0) status = speed(context, count - 2, words + 2);
    if (status == 2) fprintf(stderr, "usage: measure_lod build|quality|dolly|speed FILE...\n");
    ewa_context_destroy(&context);
    return status;
}
