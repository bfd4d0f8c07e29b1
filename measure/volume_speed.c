// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How fast volumes are drawn: a gyroid whose walls take up a tenth of the voxels, from 64^3 to 512^3, at
// 400x400, transparent and nearly opaque, seen as VTK frames it (its sphere in 30 degrees) and from near;
// then with walls that take up 1 to 100 % of 256^3. Prints the tables of docs/volume.md.
//
// measure_volume_speed [SIDE [EXTINCTION [whole|near [gl]]]]: gl: by the device, whose times the stages are
// measure_volume_speed occupied PERCENT EXTINCTION [VOLUME.nrrd]: one row of the curve; saves its volume
#include "base/base.h"
#include "ewa/ewa.h"
#include "gl/backends.h"
#include "measure/measure.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 15, SIDE_PX = 400, CURVE_SIDE = 256 };

/// The walls are where the gyroid is at most that far from 0, and so many per cent of the voxels.
typedef struct occupancy {
    int percent;
    double wall;
} occupancy;

static const occupancy tenth = {10, 0.154};
static const occupancy curve[] = {{1, 0.0154}, {3, 0.0462}, {10, 0.154}, {30, 0.46}, {60, 0.92}, {100, 1.6}};

enum { CURVE_COUNT = sizeof curve / sizeof *curve };

/// What is drawn.
typedef struct scene {
    uint32_t side, side_px;
    occupancy occupied;
    float extinction; ///< per voxel
    bool near;
    const char *save_path; ///< of the volume, or NULL
    bool by_device;
} scene;

/// What came of it.
typedef struct figures {
    ewa_voxels_info info;
    ewa_volume_stats stats;
    double made_s, frame_s;
} figures;

/// 8-bit walls of a gyroid of four periods.
static ewa_volume make_volume(ewa_context *context, uint32_t side, double wall) {
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
                *to++ = (uint8_t)fmax(0, 255 * (1 - fabs(gyroid) / wall));
            }
    free(sine);
    return volume;
}

static figures measure(ewa_context *context, const scene *at) {
    static const double direction[3] = {0.5, 0.35, -1};
    ewa_volume volume = make_volume(context, at->side, at->occupied.wall);
    if (at->save_path && ewa_volume_save(&volume, at->save_path, NULL) != EWA_OK) exit(1);
    ewa_transfer transfer = {.point_count = 3};
    transfer.points[0] = (ewa_transfer_point){1, {0.9f, 0.5f, 0.2f}, at->extinction};
    transfer.points[1] = (ewa_transfer_point){128, {0.9f, 0.8f, 0.6f}, at->extinction};
    transfer.points[2] = (ewa_transfer_point){255, {0.3f, 0.5f, 0.9f}, at->extinction};
    figures out;
    const double start_s = ewa_now_s();
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    out.made_s = ewa_now_s() - start_s;
    ewa_voxels_describe(voxels, &out.info);
    ewa_camera camera = scene_camera(at->side_px, at->side_px, direction, (at->near ? 2.2 : 3.35) * at->side);
    if (!at->near && ewa_camera_set_fov(&camera, 30) != EWA_OK) exit(1);
    ewa_volume_renderer *renderer;
    uint8_t *pixels = malloc(4 * (size_t)at->side_px * at->side_px);
    if (!pixels || ewa_volume_renderer_create(context, &renderer) != EWA_OK) exit(1);
    ewa_renderer *surfaces = NULL;
    if (at->by_device && (ewa_renderer_create_on(context, EWA_BACKEND_GL, &surfaces) != EWA_OK ||
                          ewa_gl_volume_attach(context, surfaces, renderer) != EWA_OK))
        exit(1);
    const ewa_frame frame = {.rgba8 = pixels};
    WITH_DEFAULTS(ewa_volume_options, options);
    options.shading = EWA_SHADING_PHONG;
    double times_s[FRAMES];
    for (int i = -2; i < FRAMES; i++) {
        if (ewa_volume_render(renderer, voxels, &camera, &options, &frame, i < 0 ? &out.stats : NULL) !=
            EWA_OK)
            exit(1);
        const double frame_s = ewa_now_s();
        if (ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL) != EWA_OK) exit(1);
        if (i >= 0) times_s[i] = ewa_now_s() - frame_s;
    }
    qsort(times_s, FRAMES, sizeof *times_s, compare_doubles);
    out.frame_s = times_s[FRAMES / 4];
    ewa_volume_renderer_destroy(&renderer);
    ewa_renderer_destroy(&surfaces);
    free(pixels);
    ewa_voxels_destroy(&voxels);
    ewa_volume_free(&volume);
    return out;
}

static void print_stages(const ewa_volume_stats *stats) {
    printf("<!-- in tiles: %.2f M splats, %.2f M points -->\n", (double)stats->splat_count * 1e-6, (double)stats->point_count * 1e-6);
    printf(
        "<!-- thread ms: bin %.1f, set-up %.1f, points %.1f, splats %.1f, resolve %.1f; hidden %.2f M -->\n",
        stats->bin_s * 1e3, stats->setup_s * 1e3, stats->points_s * 1e3, stats->splats_s * 1e3,
        stats->resolve_s * 1e3, (double)stats->hidden_count * 1e-6);
}

static void print_size(ewa_context *context, uint32_t side, float extinction, bool near, uint32_t side_px, bool by_device) {
    const scene at = {side, side_px, tenth, extinction, near, NULL, by_device};
    const figures out = measure(context, &at);
    const double voxel_count = (double)out.info.occupied_count;
    printf("| %u³ | %g | %s, %u px | %.2f M (%.1f %%) | %.0f %% | %.1f | %.1f | %.1f | %.0f ms |\n", side,
           (double)extinction, near ? "near" : "whole", side_px, voxel_count * 1e-6,
           100 * voxel_count / (double)out.info.voxel_count, 100 * out.stats.point_share, out.frame_s * 1e3,
           out.frame_s * 1e9 / voxel_count, (double)out.info.resident_bytes / voxel_count, out.made_s * 1e3);
    print_stages(&out.stats);
}

static void print_sizes(ewa_context *context) {
    for (int near = 0; near < 2; near++) {
        print_size(context, 256, 0.02f, near, SIDE_PX, false);
        print_size(context, 256, 1, near, SIDE_PX, false);
    }
    // Voxels as large on the screen whatever their number, then a picture of one size.
    for (uint32_t side = 64; side <= 512; side *= 2)
        print_size(context, side, 0.02f, false, SIDE_PX * side / 256, false);
    for (uint32_t side = 64; side <= 512; side *= 2)
        if (side != 256) print_size(context, side, 0.02f, false, SIDE_PX, false);
}

static void print_occupancy(ewa_context *context, occupancy occupied, float extinction,
                            const char *save_path) {
    const scene at = {CURVE_SIDE, SIDE_PX, occupied, extinction, false, save_path, false};
    const figures out = measure(context, &at);
    printf("| %g | %d %% | %.2f M | %.1f | %.1f |\n", (double)extinction, occupied.percent,
           (double)out.info.occupied_count * 1e-6, out.frame_s * 1e3,
           out.frame_s * 1e9 / (double)out.info.occupied_count);
    print_stages(&out.stats);
}

static void print_curve(ewa_context *context) {
    for (int i = 0; i < CURVE_COUNT; i++) print_occupancy(context, curve[i], 0.02f, NULL);
    for (int i = 0; i < CURVE_COUNT; i++) print_occupancy(context, curve[i], 1, NULL);
}

int main(int argc, char **argv) {
    static const char *const size_head =
        "| volume | extinction | view | occupied | points | ms | ns per voxel | bytes per voxel | made in |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    static const char *const curve_head =
        "| extinction | occupied | voxels | ms | ns per voxel |\n|---|---|---|---|---|\n";
    ewa_context *context;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    if (argc > 3 && strcmp(argv[1], "occupied") == 0) {
        for (int i = 0; i < CURVE_COUNT; i++)
            if (curve[i].percent == atoi(argv[2]))
                print_occupancy(context, curve[i], (float)atof(argv[3]), argc > 4 ? argv[4] : NULL);
    } else if (argc > 1) {
        printf("%s", size_head);
        print_size(context, (uint32_t)atoi(argv[1]), argc > 2 ? (float)atof(argv[2]) : 0.02f,
                   argc > 3 && strcmp(argv[3], "near") == 0, SIDE_PX, argc > 4 && strcmp(argv[4], "gl") == 0);
    } else {
        printf("%s", size_head);
        print_sizes(context);
        printf("\n%s", curve_head);
        print_curve(context);
    }
    ewa_context_destroy(&context);
    return 0;
}
