// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast volumes are drawn: a gyroid whose walls take up a tenth of the voxels, from 64^3 to 512^3, at
// 400x400, transparent and nearly opaque, seen as VTK frames it (its sphere in 30 degrees) and from near.
// Prints the table of docs/volume.md.
//
// measure_volume_speed [SIDE [EXTINCTION [near]]]
#include "base/base.h"
#include "ewa/ewa.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 15, SIDE_PX = 400 };

static int by_value(const void *a, const void *b) {
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

/// 8-bit walls of a gyroid of eight periods.
static ewa_volume make_volume(ewa_context *context, uint32_t side) {
    ewa_volume volume;
    const uint32_t dims[3] = {side, side, side};
    if (ewa_volume_create(context, dims, EWA_U8, &volume) != EWA_OK) exit(1);
    uint8_t *to = volume.voxels;
    double *sine = malloc(2 * side * sizeof *sine), *cosine = sine + side;
    if (!sine) exit(1);
    for (uint32_t i = 0; i < side; i++) {
        const double angle = 2 * 3.14159265358979323846 * 4 * (i + 0.5) / side;
        sine[i] = sin(angle), cosine[i] = cos(angle);
    }
    for (uint32_t k = 0; k < side; k++)
        for (uint32_t j = 0; j < side; j++)
            for (uint32_t i = 0; i < side; i++) {
                const double gyroid = sine[i] * cosine[j] + sine[j] * cosine[k] + sine[k] * cosine[i];
                *to++ = (uint8_t)fmax(0, 255 * (1 - fabs(gyroid) / 0.154));
            }
    free(sine);
    return volume;
}

static void measure(ewa_context *context, uint32_t side, float extinction, bool near, uint32_t side_px) {
    static const double direction[3] = {0.5, 0.35, -1};
    ewa_volume volume = make_volume(context, side);
    ewa_transfer transfer = {.point_count = 3};
    transfer.points[0] = (ewa_transfer_point){1, {0.9f, 0.5f, 0.2f}, extinction};
    transfer.points[1] = (ewa_transfer_point){128, {0.9f, 0.8f, 0.6f}, extinction};
    transfer.points[2] = (ewa_transfer_point){255, {0.3f, 0.5f, 0.9f}, extinction};
    const double start_s = ewa_now_s();
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    const double made_s = ewa_now_s() - start_s;
    ewa_voxels_info info;
    ewa_voxels_describe(voxels, &info);
    ewa_camera camera = scene_camera(side_px, side_px, direction, (near ? 2.2 : 3.35) * side);
    if (!near && ewa_camera_set_fov(&camera, 30) != EWA_OK) exit(1);
    ewa_volume_renderer *renderer;
    uint8_t *pixels = malloc(4 * (size_t)side_px * side_px);
    if (!pixels || ewa_volume_renderer_create(context, &renderer) != EWA_OK) exit(1);
    const ewa_frame frame = {.rgba8 = pixels};
    ewa_volume_options options;
    ewa_volume_options_init(&options, sizeof options);
    options.shading = EWA_SHADING_PHONG;
    double times_s[FRAMES];
    ewa_volume_stats stats;
    for (int i = -2; i < FRAMES; i++) {
        if (ewa_volume_render(renderer, voxels, &camera, &options, &frame, i < 0 ? &stats : NULL) != EWA_OK)
            exit(1);
        const double frame_s = ewa_now_s();
        if (ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL) != EWA_OK) exit(1);
        if (i >= 0) times_s[i] = ewa_now_s() - frame_s;
    }
    qsort(times_s, FRAMES, sizeof *times_s, by_value);
    const double voxel_count = (double)info.occupied_count;
    printf("| %u³ | %g | %s, %u px | %.2f M (%.1f %%) | %.0f %% | %.1f | %.1f | %.1f | %.0f ms |\n", side,
           (double)extinction, near ? "near" : "whole", side_px, voxel_count * 1e-6,
           100 * voxel_count / (double)info.voxel_count, 100 * stats.point_share, times_s[FRAMES / 4] * 1e3,
           times_s[FRAMES / 4] * 1e9 / voxel_count, (double)info.resident_bytes / voxel_count, made_s * 1e3);
    printf(
        "<!-- thread ms: bin %.1f, set-up %.1f, points %.1f, splats %.1f, resolve %.1f; hidden %.2f M -->\n",
        stats.bin_s * 1e3, stats.setup_s * 1e3, stats.points_s * 1e3, stats.splats_s * 1e3,
        stats.resolve_s * 1e3, (double)stats.hidden_count * 1e-6);
    ewa_volume_renderer_destroy(&renderer);
    free(pixels);
    ewa_voxels_destroy(&voxels);
    ewa_volume_free(&volume);
}

int main(int argc, char **argv) {
    ewa_context *context;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    printf(
        "| volume | extinction | view | occupied | points | ms | ns per voxel | bytes per voxel | made in |\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    if (argc > 1) {
        measure(context, (uint32_t)atoi(argv[1]), argc > 2 ? (float)atof(argv[2]) : 0.02f, argc > 3, SIDE_PX);
    } else {
        for (int near = 0; near < 2; near++) {
            measure(context, 256, 0.02f, near, SIDE_PX);
            measure(context, 256, 1, near, SIDE_PX);
        }
        // Voxels as large on the screen whatever their number, then a picture of one size.
        for (uint32_t side = 64; side <= 512; side *= 2)
            measure(context, side, 0.02f, false, SIDE_PX * side / 256);
        for (uint32_t side = 64; side <= 512; side *= 2)
            if (side != 256) measure(context, side, 0.02f, false, SIDE_PX);
    }
    ewa_context_destroy(&context);
    return 0;
}
