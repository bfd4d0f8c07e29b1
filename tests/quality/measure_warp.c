// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/warp.md: measure_warp quality|settings|real DATA|speed.
#include "warp_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 15 };

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void check(ewa_status status) {
    if (status == EWA_OK) return;
    fprintf(stderr, "measure_warp: %s\n", ewa_status_name(status));
    exit(1);
}

static void print_message(void *user, ewa_severity severity, const char *text) {
    (void)user, (void)severity;
    fprintf(stderr, "measure_warp: %s\n", text);
}

static ewa_context *make_context(uint32_t threads) {
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.thread_count = threads;
    options.message = print_message;
    ewa_context *context = NULL;
    check(ewa_context_create(&options, &context));
    return context;
}

/// A warped picture, the holes black.
typedef struct warped {
    uint8_t *rgba8, *rgb8, *holes;
    size_t pixel_count, hole_count;
} warped;

static void *get(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (!memory) exit(1);
    return memory;
}

static warped draw(ewa_warp *warp, const ewa_camera *target, ewa_warp_method method,
                   const ewa_render_options *options) {
    warped w = {.pixel_count = (size_t)target->width_px * target->height_px};
    w.rgba8 = get(w.pixel_count, 4);
    w.rgb8 = get(w.pixel_count, 3);
    w.holes = get(w.pixel_count, 1);
    const ewa_frame frame = {.rgba8 = w.rgba8};
    check(ewa_warp_draw(warp, target, method, options, &frame, w.holes, NULL));
    for (size_t i = 0; i < w.pixel_count; i++) {
        memcpy(w.rgb8 + 3 * i, w.rgba8 + 4 * i, 3);
        w.hole_count += w.holes[i] > 0;
    }
    return w;
}

static void release(warped *w) {
    free(w->rgba8);
    free(w->rgb8);
    free(w->holes);
}

static ewa_depth_image image_of(const ewa_camera *camera, const float *depth, const uint8_t *rgb8) {
    ewa_depth_image image;
    ewa_depth_image_init(&image, sizeof image);
    image.camera = *camera;
    image.depth = depth;
    image.depth_type = EWA_F32;
    image.color = rgb8;
    return image;
}

/// One row: shares of holes, likeness over all that `seen` says a source shows.
static void print_row(const char *what, const char *method, const warped *w, const ewa_camera *target,
                      const uint8_t *truth, const uint8_t *seen) {
    size_t seen_count = 0, cracks = 0;
    for (size_t i = 0; i < w->pixel_count; i++) {
        seen_count += seen[i] > 0;
        cracks += seen[i] && w->holes[i];
    }
    const picture_likeness p = picture_compare(target->width_px, target->height_px, w->rgb8, truth, seen);
    printf("| %s | %s | %.2f %% | %.3f %% | %.2f | %.4f |\n", what, method,
           100 * (double)w->hole_count / (double)w->pixel_count, 100 * (double)cracks / (double)seen_count,
           p.psnr_db, p.ssim);
}

static const struct {
    const char *name;
    double shift[3];
} MOVES[] = {{"none", {0, 0, 0}},
             {"aside 0.3", {0.3, 0, 0}},
             {"ahead 1.0 (magnified)", {0, 0, 1.0}},
             {"back 2.0 (minified)", {0, 0, -2.0}},
             {"back 12 (minified 3 times)", {0, 0, -12}},
             {"aside 0.6, up 0.4, ahead 0.5", {0.6, -0.4, 0.5}}};

static void quality(void) {
    const uint32_t width = 640, height = 480;
    const size_t count = (size_t)width * height;
    ewa_context *context = make_context(0);
    ewa_warp *warp = NULL;
    check(ewa_warp_create(context, &warp));
    uint8_t *color = get(count, 3), *truth = get(count, 3), *seen = get(count, 1);
    float *depth = get(count, sizeof *depth);
    const ewa_camera source = warp_scene_camera(width, height, 0, 0, 0);
    warp_scene_picture(&source, color, depth);
    const ewa_depth_image image = image_of(&source, depth, color);
    check(ewa_warp_take(warp, &image, 1, NULL, NULL));
    puts("| move | method | holes | holes where the source sees | PSNR dB there | SSIM there |\n"
         "|---|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof MOVES / sizeof MOVES[0]; i++) {
        const double *s = MOVES[i].shift;
        const ewa_camera target = warp_scene_camera(width, height, s[0], s[1], s[2]);
        warp_scene_picture(&target, truth, NULL);
        warp_scene_seen(&target, &source, seen);
        for (int method = 0; method < 2; method++) {
            warped w = draw(warp, &target, (ewa_warp_method)method, NULL);
            print_row(MOVES[i].name, method ? "mcmillan" : "hybrid", &w, &target, truth, seen);
            release(&w);
        }
    }
    free(color), free(truth), free(seen), free(depth);
    ewa_warp_destroy(&warp);
    ewa_context_destroy(&context);
}

/// The same over some settings, to choose the defaults by.
static void settings(void) {
    const uint32_t width = 640, height = 480;
    const size_t count = (size_t)width * height;
    ewa_context *context = make_context(0);
    ewa_warp *warp = NULL;
    check(ewa_warp_create(context, &warp));
    uint8_t *color = get(count, 3), *truth = get(count, 3), *seen = get(count, 1);
    float *depth = get(count, sizeof *depth);
    const ewa_camera source = warp_scene_camera(width, height, 0, 0, 0);
    warp_scene_picture(&source, color, depth);
    const ewa_depth_image image = image_of(&source, depth, color);
    static const double radii[] = {0.9, 1.0, 1.14, 1.3}, prefilters[] = {0.2, 0.25, 0.3, 0.35, 0.5};
    puts("| radius, prefilter | move | holes | holes where seen | PSNR dB | SSIM |\n|---|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof MOVES / sizeof MOVES[0]; i++) {
        const double *s = MOVES[i].shift;
        const ewa_camera target = warp_scene_camera(width, height, s[0], s[1], s[2]);
        warp_scene_picture(&target, truth, NULL);
        warp_scene_seen(&target, &source, seen);
        for (size_t k = 0; k < 20; k++) {
            ewa_warp_options options;
            ewa_warp_options_init(&options, sizeof options);
            options.radius_spacings = radii[k / 5];
            ewa_render_options render;
            ewa_warp_render_options_init(&render, sizeof render);
            render.prefilter_px = prefilters[k % 5];
            check(ewa_warp_take(warp, &image, 1, &options, NULL));
            warped w = draw(warp, &target, EWA_WARP_HYBRID, &render);
            char name[64];
            snprintf(name, sizeof name, "%.2f, %.2f", options.radius_spacings, render.prefilter_px);
            print_row(name, MOVES[i].name, &w, &target, truth, seen);
            release(&w);
        }
    }
    free(color), free(truth), free(seen), free(depth);
    ewa_warp_destroy(&warp);
    ewa_context_destroy(&context);
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double lower_quartile(double times_s[ROUNDS]) {
    qsort(times_s, ROUNDS, sizeof *times_s, compare_doubles);
    return 1e3 * times_s[ROUNDS / 4];
}

/// Times of taking and drawing, warm, lower quartiles.
static void speed(void) {
    static const uint32_t sizes[][2] = {{640, 480}, {1920, 1080}};
    static const size_t moves[] = {0, 1, 2, 3};
    puts("| picture | move | threads | take ms | hybrid ms | together ms | mcmillan ms |\n|---|---|---|---|---|---|---|");
    for (size_t k = 0; k < 2; k++) {
        const uint32_t width = sizes[k][0], height = sizes[k][1];
        const size_t count = (size_t)width * height;
        uint8_t *color = get(count, 3), *rgba8 = get(count, 4);
        float *depth = get(count, sizeof *depth);
        uint16_t *depth_mm = get(count, sizeof *depth_mm);
        const ewa_camera source = warp_scene_camera(width, height, 0, 0, 0);
        warp_scene_picture(&source, color, depth);
        for (size_t i = 0; i < count; i++) depth_mm[i] = (uint16_t)(depth[i] * 1000 + 0.5f);
        ewa_depth_image image = image_of(&source, depth, color);
        image.depth = depth_mm;
        image.depth_type = EWA_U16;
        image.depth_scale = 1000;
        for (uint32_t threads = 2; threads >= 1; threads--) {
            ewa_context *context = make_context(threads);
            ewa_warp *warp = NULL;
            check(ewa_warp_create(context, &warp));
            for (size_t m = 0; m < sizeof moves / sizeof moves[0]; m++) {
                const double *s = MOVES[moves[m]].shift;
                const ewa_camera target = warp_scene_camera(width, height, s[0], s[1], s[2]);
                const ewa_frame frame = {.rgba8 = rgba8};
                double take_s[ROUNDS], draw_s[ROUNDS], all_s[ROUNDS], nearest_s[ROUNDS];
                for (int round = -2; round < ROUNDS; round++) {
                    const int at = round < 0 ? 0 : round;
                    const double started_s = now_s();
                    check(ewa_warp_take(warp, &image, 1, NULL, NULL));
                    const double taken_s = now_s();
                    check(ewa_warp_draw(warp, &target, EWA_WARP_HYBRID, NULL, &frame, NULL, NULL));
                    const double drawn_s = now_s();
                    check(ewa_warp_draw(warp, &target, EWA_WARP_MCMILLAN, NULL, &frame, NULL, NULL));
                    take_s[at] = taken_s - started_s;
                    draw_s[at] = drawn_s - taken_s;
                    all_s[at] = drawn_s - started_s;
                    nearest_s[at] = now_s() - drawn_s;
                }
                printf("| %ux%u | %s | %u | %.2f | %.2f | %.2f | %.2f |\n", width, height, MOVES[moves[m]].name,
                       threads, lower_quartile(take_s), lower_quartile(draw_s), lower_quartile(all_s),
                       lower_quartile(nearest_s));
            }
            ewa_warp_destroy(&warp);
            ewa_context_destroy(&context);
        }
        free(color), free(rgba8), free(depth), free(depth_mm);
    }
}

int main(int argc, char **argv) {
    const char *what = argc > 1 ? argv[1] : "";
    if (strcmp(what, "quality") == 0)
        quality();
    else if (strcmp(what, "settings") == 0)
        settings();
    else if (strcmp(what, "speed") == 0)
        speed();
    else
        fputs("measure_warp quality|settings|speed\n", stderr);
    return 0;
}
