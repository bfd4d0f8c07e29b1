// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures through maps, and depth images to other cameras.
#include "homogeneous/vec.h"
#include "tests/probe/probe.h"
#include "texture/texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 80 };

static void put_textures(probe *to) {
    static float pixels[SIDE * SIDE * 4], target[96 * 64 * 4];
    static uint8_t codes[SIDE * SIDE * 3];
    uint64_t state = 11;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t x = i % SIDE, y = i / SIDE;
        for (uint32_t c = 0; c < 3; c++) codes[3 * i + c] = (uint8_t)(255 * probe_random(&state));
        for (uint32_t c = 0; c < 4; c++)
            pixels[4 * i + c] = (x / 6 + y / 5) % 2 ? 0.1f + 0.2f * (float)c : 0.9f - 0.1f * (float)c;
        pixels[4 * i + 3] = (x + y) % 9 ? 1 : 0.95f;
    }
    static const double corners[4][4][2] = {{{3, 2}, {90, 5}, {85, 60}, {6, 55}},
                                            {{30, 10}, {60, 10}, {140, 70}, {-40, 65}},
                                            {{-300, -200}, {400, -180}, {380, 300}, {-250, 320}},
                                            {{10, 10}, {14, 11}, {13, 15}, {9, 14}}};
    for (int k = 0; k < 16; k++) {
        const bool bytes = k % 2;
        const ewa_texture_source source = {.pixels = bytes ? (const void *)codes : pixels,
                                           .format = bytes ? EWA_PIXEL_SRGB8 : EWA_PIXEL_LINEAR,
                                           .channel_count = bytes ? 3 : 4,
                                           .width_px = SIDE,
                                           .height_px = SIDE,
                                           .stride_bytes = SIDE * (bytes ? 3 : 16)};
        const ewa_texture_target into = {.pixels = target,
                                         .format = EWA_PIXEL_LINEAR,
                                         .channel_count = 4,
                                         .width_px = 96,
                                         .height_px = 64,
                                         .stride_bytes = 96 * 16};
        WITH_DEFAULTS(ewa_texture_options, options);
        options.method = (ewa_texture_method)(k / 4);
        options.repeat = k % 4 == 1 && options.method != EWA_TEXTURE_SPLAT;
        if (k % 3 == 0) options.background[1] = 0.3f, options.background[3] = 0.6f;
        if (k % 5 == 0) options.prefilter_px = 0.8, options.sigma_texels = 0.6;
        ewa_mat3 map = mat3_identity();
        probe_status(to, "corners",
                     ewa_texture_map_from_corners(to->context, SIDE, SIDE, corners[k % 4], &map));
        probe_doubles(to, "map", PROBE_NUMBERS, &map.m[0][0], 9);
        memset(target, 0, sizeof target);
        probe_status(to, "texture", ewa_texture_map(to->context, &source, &map, &options, &into, NULL));
        probe_floats(to, "texture", PROBE_PICTURE, target, 96 * 64 * 4);
        if (k % 4 == 1 || to->brief) continue;
        memset(target, 0, sizeof target);
        probe_status(to, "reference", ewa_texture_map_reference(to->context, &source, &map, &options, &into));
        probe_floats(to, "reference", PROBE_PICTURE, target, 96 * 64 * 4);
    }
    ewa_camera camera;
    ewa_camera_init(&camera);
    const double origin[3] = {-1, 0.5, 3}, across[3] = {2, 0.1, 0.4}, down[3] = {0, 0.3, -1.5};
    ewa_mat3 map = mat3_identity();
    probe_status(to, "camera",
                 ewa_texture_map_from_camera(to->context, 20, 30, &camera, origin, across, down, &map));
    probe_doubles(to, "map of a camera", PROBE_NUMBERS, &map.m[0][0], 9);
}

/// A ball before a wall and a floor, with creases, steps and noise.
static void make_depths(float *depth, uint8_t *color, bool noisy) {
    uint64_t state = 21;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE + 0.5 - 40) / 70, y = (i / SIDE + 0.5 - 40) / 70;
        double z = 4 + 0.3 * x;
        if (y > 0.1) z = fmin(z, 0.35 / y);
        const double a = x * x + y * y + 1, b = -2 * (0.1 * x - 0.15 * y + 2), c = 0.01 + 0.0225 + 4 - 0.25;
        const double root = b * b - 4 * a * c;
        if (root > 0) z = fmin(z, (-b - sqrt(root)) / (2 * a));
        if (noisy) z = 1 / (1 / z + 0.0036 * (probe_random(&state) - 0.5));
        depth[i] = i % 97 == 5 ? 0 : (float)z;
        for (int k = 0; k < 3; k++)
            color[3 * i + k] = (uint8_t)(40 + 60 * ((i % SIDE / 5 + i / SIDE / 6 + k) % 3));
    }
}

static void put_warps(probe *to) {
    static float depth[SIDE * SIDE], numbers[SIDE * SIDE];
    static uint16_t steps[SIDE * SIDE];
    static uint8_t color[SIDE * SIDE * 3], holes[SIDE * SIDE];
    for (int k = 0; k < 9; k++) {
        make_depths(depth, color, k == 1 || k == 5);
        ewa_depth_image image;
        ewa_depth_image_init(&image);
        ewa_camera *camera = &image.camera;
        ewa_camera_init(camera);
        camera->width_px = camera->height_px = SIDE;
        camera->fx_px = camera->fy_px = 70, camera->cx_px = camera->cy_px = 40;
        image.kind = (ewa_depth_kind)(k % 3);
        image.depth_type = k >= 6 ? EWA_U16 : EWA_F32;
        image.baseline_world = 0.1, image.disparity_offset_px = 0.5;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = (i % SIDE + 0.5 - 40) / 70, y = (i / SIDE + 0.5 - 40) / 70, z = (double)depth[i];
            numbers[i] = (float)(k % 3 == 0   ? z
                                 : k % 3 == 1 ? z * sqrt(x * x + y * y + 1)
                                 : z > 0      ? 7 / z - 0.5
                                              : 0);
            steps[i] = (uint16_t)(1000 * (double)numbers[i]);
        }
        image.depth = image.depth_type == EWA_U16 ? (const void *)steps : numbers;
        image.depth_scale = image.depth_type == EWA_U16 ? 1000 : 1;
        image.color = color, image.color_type = EWA_U8, image.color_channel_count = 3;
        WITH_DEFAULTS(ewa_warp_options, options);
        options.depth_noise = k == 1 || k == 5 ? 0.0036 : 0;
        options.drop_flying = k != 2;
        OWNED(ewa_warp_destroy) ewa_warp *warp = NULL;
        ewa_warp_facts facts;
        memset(&facts, 0, sizeof facts);
        probe_status(to, "warp", ewa_warp_create(to->context, &warp));
        probe_status(to, "take", ewa_warp_take(warp, &image, 1, &options, &facts));
        probe_number(to, "samples", (double)facts.sample_count),
            probe_number(to, "flying", (double)facts.flying_count);
        ewa_camera view = *camera;
        const double eye[3] = {0.4, -0.25, -0.1}, target[3] = {0, 0, 2.5}, up[3] = {0, -1, 0};
        ewa_camera_look_at(&view, eye, target, up);
        for (int method = 0; method < 2; method++) {
            ewa_render_options render;
            ewa_warp_render_options_init(&render, sizeof render);
            if (k >= 3) render.shading = EWA_SHADING_LAMBERT, render.cull = EWA_CULL_BACK;
            OWNED(probe_frame_free) ewa_frame frame = probe_frame(&view, true);
            probe_status(to, "draw",
                         ewa_warp_draw(warp, &view, (ewa_warp_method)method, &render, &frame, holes, NULL));
            probe_frame_put(to, method ? "McMillan" : "warped", &view, &frame);
            double share = 0;
            for (int i = 0; i < SIDE * SIDE; i++) share += holes[i];
            probe_number(to, "holes", share);
        }
    }
}

void probe_resample(probe *to) {
    put_textures(to);
    put_warps(to);
}
