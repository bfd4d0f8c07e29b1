// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the tables of docs/warp.md: measure_warp quality|settings|speed|real DATA; writes the files of the
// gallery's pictures into the working folder: measure_warp scene.
#include "measure/measure.h"
#include "quality/warp_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 15 };

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
    ewa_depth_image_init(&image);
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
    for (size_t i = 0; i < (is_quick() ? 1 : sizeof MOVES / sizeof MOVES[0]); i++) {
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
    puts("| radius, prefilter | move | holes | holes where seen | PSNR dB | SSIM "
         "|\n|---|---|---|---|---|---|");
    for (size_t i = 0; i < sizeof MOVES / sizeof MOVES[0]; i++) {
        const double *s = MOVES[i].shift;
        const ewa_camera target = warp_scene_camera(width, height, s[0], s[1], s[2]);
        warp_scene_picture(&target, truth, NULL);
        warp_scene_seen(&target, &source, seen);
        for (size_t k = 0; k < 20; k++) {
            WITH_DEFAULTS(ewa_warp_options, options);
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

/// A picture of the real pairs, with its depth and its camera.
typedef struct view {
    ewa_image color, depth;
    ewa_camera camera;
} view;

typedef struct wanted_pose {
    uint32_t index;
    ewa_camera *camera;
} wanted_pose;

static void take_pose(void *user, uint32_t index, const ewa_camera *camera) {
    const wanted_pose *wanted = user;
    if (index == wanted->index) *wanted->camera = *camera;
}

/// Loads a view; `depth_name` and `pose_name` may be NULL.
static view load_view(ewa_context *context, const char *folder, const char *color_name,
                      const char *depth_name, const char *pose_name, uint32_t pose,
                      const double intrinsics[4]) {
    view v = {.color = {0}};
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, color_name);
    check(ewa_image_load(context, path, &v.color));
    if (depth_name) {
        snprintf(path, sizeof path, "%s/%s", folder, depth_name);
        check(ewa_depth_load(context, path, &v.depth));
    }
    ewa_camera_init(&v.camera);
    v.camera.width_px = v.color.width_px;
    v.camera.height_px = v.color.height_px;
    v.camera.fx_px = intrinsics[0], v.camera.fy_px = intrinsics[1];
    v.camera.cx_px = intrinsics[2], v.camera.cy_px = intrinsics[3];
    if (!pose_name) return v;
    snprintf(path, sizeof path, "%s/%s", folder, pose_name);
    wanted_pose wanted = {pose, &v.camera};
    const ewa_camera lens = v.camera;
    check(ewa_camera_load_poses(context, path, &lens, take_pose, &wanted));
    return v;
}

static void free_view(view *v) {
    ewa_image_free(&v->color);
    ewa_image_free(&v->depth);
}

/// Rows for views warped to another, whose photograph is the truth.
static void compare_real(ewa_context *context, const char *what, const view *from, uint32_t count,
                         const view *to, const ewa_depth_image *common, double depth_noise) {
    const size_t pixel_count = (size_t)to->camera.width_px * to->camera.height_px;
    ewa_depth_image images[4];
    for (uint32_t i = 0; i < count; i++) {
        images[i] = *common;
        images[i].camera = from[i].camera;
        images[i].depth = from[i].depth.pixels;
        images[i].depth_type = EWA_F32;
        images[i].color = from[i].color.pixels;
        images[i].color_type = EWA_F32;
        images[i].color_channel_count = from[i].color.channel_count;
    }
    ewa_warp *warp = NULL;
    check(ewa_warp_create(context, &warp));
    WITH_DEFAULTS(ewa_warp_options, options);
    options.depth_noise = depth_noise;
    check(ewa_warp_take(warp, images, count, &options, NULL));
    warped w[2];
    for (int m = 0; m < 2; m++) w[m] = draw(warp, &to->camera, (ewa_warp_method)m, NULL);
    uint8_t *truth = get(pixel_count, 3), *either = get(pixel_count, 1), *both = get(pixel_count, 1);
    for (size_t i = 0; i < pixel_count; i++) {
        for (int c = 0; c < 3; c++)
            truth[3 * i + c] = (uint8_t)(255 * ewa_srgb_from_linear(to->color.pixels[3 * i + c]) + 0.5f);
        either[i] = !w[0].holes[i] || !w[1].holes[i];
        both[i] = !w[0].holes[i] && !w[1].holes[i];
    }
    for (int m = 0; m < 2; m++) {
        const uint32_t width = to->camera.width_px, height = to->camera.height_px;
        const picture_likeness a = picture_compare(width, height, w[m].rgb8, truth, either),
                               b = picture_compare(width, height, w[m].rgb8, truth, both);
        printf("| %s | %s | %.2f %% | %.2f | %.4f | %.2f |\n", what, m ? "mcmillan" : "hybrid",
               100 * (double)w[m].hole_count / (double)pixel_count, a.psnr_db, a.ssim, b.psnr_db);
        release(&w[m]);
    }
    free(truth), free(either), free(both);
    ewa_warp_destroy(&warp);
}

static void real(const char *data) {
    // Principal points are those of the data sets, whose pixel centres are whole numbers, plus half a pixel.
    static const double room_lens[4] = {525, 525, 320, 240},
                        box_lens[4] = {615.195, 615.195, 298.943, 248.019},
                        stereo_lens[4] = {994.978, 994.978, 311.693, 255.377};
    char folder[1024];
    ewa_context *context = make_context(0);
    ewa_depth_image common;
    ewa_depth_image_init(&common);
    common.depth_scale = 1000;
    puts("| pair | method | holes | PSNR dB where either draws | SSIM there | PSNR dB where both draw |\n"
         "|---|---|---|---|---|---|");
    snprintf(folder, sizeof folder, "%s/rgbd/livingroom", data);
    view room[3] = {
        load_view(context, folder, "color/00000.jpg", "depth/00000.png", "trajectory.log", 0, room_lens),
        load_view(context, folder, "color/00002.jpg", "depth/00002.png", "trajectory.log", 2, room_lens),
        load_view(context, folder, "color/00004.jpg", NULL, "trajectory.log", 4, room_lens)};
    compare_real(context, "living room, 0 to 4", room, 1, &room[2], &common, 0.0036);
    compare_real(context, "the same, noise kept", room, 1, &room[2], &common, 0);
    compare_real(context, "living room, 0 and 2 to 4", room, 2, &room[2], &common, 0.0036);
    for (int i = 0; i < 3; i++) free_view(&room[i]);
    snprintf(folder, sizeof folder, "%s/rgbd/sensor_sequence", data);
    view box[2] = {
        load_view(context, folder, "frame-000065.color.png", "frame-000065.depth.png",
                  "frame-000065.pose.txt", 0, box_lens),
        load_view(context, folder, "frame-000085.color.png", NULL, "frame-000085.pose.txt", 0, box_lens)};
    compare_real(context, "sensor, 65 to 85", box, 1, &box[1], &common, 0.003);
    for (int i = 0; i < 2; i++) free_view(&box[i]);
    snprintf(folder, sizeof folder, "%s/rgbd/stereo", data);
    view eyes[2] = {
        load_view(context, folder, "motorcycle_left.png", "motorcycle_disp.pfm", NULL, 0, stereo_lens),
        load_view(context, folder, "motorcycle_right.png", NULL, NULL, 0, stereo_lens)};
    eyes[1].camera.cx_px += 31.086;
    eyes[1].camera.world_to_camera[3] = -193.001;
    common.depth_scale = 1;
    common.kind = EWA_DEPTH_DISPARITY;
    common.baseline_world = 193.001;
    common.disparity_offset_px = 31.086;
    compare_real(context, "motorcycle, left to right", eyes, 1, &eyes[1], &common, 0);
    for (int i = 0; i < 2; i++) free_view(&eyes[i]);
    ewa_context_destroy(&context);
}

static double lower_quartile(double times_s[ROUNDS]) {
    qsort(times_s, ROUNDS, sizeof *times_s, compare_doubles);
    return 1e3 * times_s[ROUNDS / 4];
}

/// Times of taking and drawing, warm, lower quartiles.
static void speed(void) {
    static const uint32_t sizes[][2] = {{640, 480}, {1920, 1080}};
    static const size_t moves[] = {0, 1, 2, 3};
    puts("| picture | move | threads | take ms | hybrid ms | together ms | mcmillan ms "
         "|\n|---|---|---|---|---|---|---|");
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
                printf("| %ux%u | %s | %u | %.2f | %.2f | %.2f | %.2f |\n", width, height,
                       MOVES[moves[m]].name, threads, lower_quartile(take_s), lower_quartile(draw_s),
                       lower_quartile(all_s), lower_quartile(nearest_s));
            }
            ewa_warp_destroy(&warp);
            ewa_context_destroy(&context);
        }
        free(color), free(rgba8), free(depth), free(depth_mm);
    }
}

/// Writes the room for the gallery: a picture with its depth and camera, and the truth of another camera.
static void scene(void) {
    const uint32_t width = 320, height = 240;
    const size_t count = (size_t)width * height;
    ewa_context *context = make_context(0);
    uint8_t *rgb8 = get(count, 3);
    ewa_image depth;
    check(ewa_image_create(context, width, height, 1, &depth));
    const ewa_camera source = warp_scene_camera(width, height, 0, 0, 0),
                     target = warp_scene_camera(width, height, 0.4, -0.3, 1.1);
    warp_scene_picture(&source, rgb8, depth.pixels);
    check(ewa_png_save(context, "warp_source.png", width, height, 3, rgb8, 3 * (size_t)width));
    check(ewa_image_save(&depth, "warp_depth.pfm", NULL));
    check(ewa_camera_save(context, &source, "warp_source.json"));
    warp_scene_picture(&target, rgb8, NULL);
    check(ewa_png_save(context, "warp_truth.png", width, height, 3, rgb8, 3 * (size_t)width));
    check(ewa_camera_save(context, &target, "warp_target.json"));
    ewa_image_free(&depth);
    free(rgb8);
    ewa_context_destroy(&context);
}

int main(int argc, char **argv) {
    const char *what = argc > 1 ? argv[1] : "";
    if (strcmp(what, "quality") == 0)
        quality();
    else if (strcmp(what, "settings") == 0)
        settings();
    else if (strcmp(what, "speed") == 0)
        speed();
    else if (strcmp(what, "scene") == 0)
        scene();
    else if (strcmp(what, "real") == 0 && argc > 2)
        real(argv[2]);
    else
        fputs("measure_warp quality|settings|speed|scene|real DATA\n", stderr);
    return 0;
}
