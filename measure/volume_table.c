// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The table of HFR's figure 9: times of 400x400 pictures of CT scans whose voxels are all splats, both, all
// points, with and without occlusion culling. The scans are those of $EWA_DATA/volumes; where the paper's are
// not there, volumes of the same size stand in. Prints the table of docs/volume.md.
//
// measure_volume_table [CURVE.csv]: also writes the time of a drawn voxel over the share of splats, of the last volume.
#include "base/base.h"
#include "measure/measure.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 7, SIDE_PX = 400, VIEWS = 3 };

/// A camera from which the spacing on the screen of voxels at `share` of the way through the volume (0: its
/// nearest corner) is `pixels`.
static ewa_camera view_at(const ewa_bounds *bounds, double share, double pixels) {
    static const double direction[3] = {0.6, 0.45, -1}, up[3] = {0, 1, 0};
    double middle[3], eye[3], radius = 0, length = 0;
    for (int axis = 0; axis < 3; axis++) {
        middle[axis] = (bounds->low_world[axis] + bounds->high_world[axis]) / 2;
        radius = hypot(radius, (bounds->high_world[axis] - bounds->low_world[axis]) / 2);
        length = hypot(length, direction[axis]);
    }
    const double distance = 3 * radius;
    for (int axis = 0; axis < 3; axis++) eye[axis] = middle[axis] + direction[axis] / length * distance;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = camera.height_px = SIDE_PX;
    camera.cx_px = camera.cy_px = SIDE_PX / 2;
    camera.fx_px = camera.fy_px = pixels * (distance + (2 * share - 1) * radius);
    check(ewa_camera_look_at(&camera, eye, middle, up));
    return camera;
}

/// The lower quartile of a few frames, in ms.
static double time_frames(ewa_volume_renderer *renderer, const ewa_voxels *voxels, const ewa_camera *camera,
                          const ewa_volume_options *options, uint8_t *pixels, ewa_volume_stats *stats) {
    const ewa_frame frame = {.rgba8 = pixels};
    double times_s[FRAMES];
    const int frame_count = is_quick() ? 1 : FRAMES;
    check(ewa_volume_render(renderer, voxels, camera, options, &frame, stats));
    for (int i = 0; i < frame_count; i++) {
        const double start_s = ewa_now_s();
        check(ewa_volume_render(renderer, voxels, camera, options, &frame, NULL));
        times_s[i] = ewa_now_s() - start_s;
    }
    qsort(times_s, (size_t)frame_count, sizeof *times_s, compare_doubles);
    return times_s[frame_count / 4] * 1e3;
}

static void print_row(ewa_context *context, const char *name, const ewa_volume *volume,
                      const ewa_transfer *transfer) {
    static const double shares[VIEWS] = {1, 0.5, 0}, spacings_px[VIEWS] = {1.25, 1.2, 1.15};
    static uint8_t pixels[4 * SIDE_PX * SIDE_PX];
    ewa_voxels *voxels = scene_voxels(volume, transfer);
    ewa_voxels_info info;
    ewa_voxels_describe(voxels, &info);
    ewa_volume_renderer *renderer;
    check(ewa_volume_renderer_create(context, &renderer));
    printf("| %s | %u x %u x %u | %.2f M |", name, volume->dims[0], volume->dims[1], volume->dims[2],
           (double)info.occupied_count * 1e-6);
    double each_ns[VIEWS];
    for (int v = 0; v < VIEWS; v++) {
        const ewa_camera camera = view_at(&info.bounds, shares[v], spacings_px[v]);
        ewa_volume_options options;
        ewa_volume_stats stats;
        ewa_volume_options_init(&options, sizeof options);
        options.shading = EWA_SHADING_PHONG;
        const double culled_ms = time_frames(renderer, voxels, &camera, &options, pixels, &stats);
        const double hidden = (double)stats.hidden_count;
        options.minimum_transmittance = 0;
        const double all_ms = time_frames(renderer, voxels, &camera, &options, pixels, &stats);
        const double drawn = (double)(stats.splat_count + stats.point_count);
        each_ns[v] = all_ms * 1e6 / drawn;
        printf(" %.1f, %.1f (%.0f %%; %.0f %%) |", all_ms, culled_ms, 100 * (1 - stats.point_share),
               100 * hidden / drawn);
    }
    printf(" %.1f |\n", each_ns[0] / each_ns[2]);
    fflush(stdout);
    ewa_volume_renderer_destroy(&renderer);
    ewa_voxels_destroy(&voxels);
}

/// The time of a picture of a volume over the share of its voxels that are splats, as CSV.
static void write_curve(ewa_context *context, const ewa_volume *volume, const ewa_transfer *transfer, const char *path) {
    static uint8_t pixels[4 * SIDE_PX * SIDE_PX];
    const int steps = is_quick() ? 2 : 12;
    FILE *file = fopen(path, "w");
    if (!file) check(EWA_ERROR_IO);
    ewa_voxels *voxels = scene_voxels(volume, transfer);
    ewa_voxels_info info;
    ewa_voxels_describe(voxels, &info);
    ewa_volume_renderer *renderer;
    check(ewa_volume_renderer_create(context, &renderer));
    fprintf(file, "splats_percent,ns_per_voxel\n");
    for (int step = 0; step <= steps; step++) {
        const ewa_camera camera = view_at(&info.bounds, (double)step / steps, 1.2);
        ewa_volume_options options;
        ewa_volume_stats stats;
        ewa_volume_options_init(&options, sizeof options);
        options.shading = EWA_SHADING_PHONG;
        options.minimum_transmittance = 0;
        const double ms = time_frames(renderer, voxels, &camera, &options, pixels, &stats);
        fprintf(file, "%.2f,%.2f\n", 100 * (1 - stats.point_share),
                ms * 1e6 / (double)(stats.splat_count + stats.point_count));
    }
    fclose(file);
    ewa_volume_renderer_destroy(&renderer);
    ewa_voxels_destroy(&voxels);
}

/// Solid from a value on: white there, tinted above.
static ewa_transfer solid_from(double value, double range) {
    ewa_transfer transfer = {.point_count = 3};
    transfer.points[0] = (ewa_transfer_point){value, {0.8f, 0.75f, 0.6f}, 0.4f};
    transfer.points[1] = (ewa_transfer_point){value + 0.3 * range, {0.9f, 0.6f, 0.4f}, 1};
    transfer.points[2] = (ewa_transfer_point){255, {0.9f, 0.3f, 0.2f}, 1};
    return transfer;
}

int main(int argc, char **argv) {
    static const struct {
        const char *name, *file;
        double solid;
    } scans[] = {
        {"Engine", "engine_256x256x128_uint8.raw.gz", 80},
        {"Head, for Skull", "visible_male_head_128x256x256_uint8.raw.gz", 100},
        {"Aneurism", "aneurism_256x256x256_uint8.raw.gz", 60},
    };
    const char *folder = getenv("EWA_DATA");
    ewa_context *context;
    check(ewa_context_create(NULL, &context));
    printf(
        "| volume | voxels | of these seen | all splats: ms, culled ms (splats; hidden) | mixed | all points "
        "| splat to point |\n|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof scans / sizeof *scans && folder && !is_quick(); i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/volumes/%s", folder, scans[i].file);
        ewa_volume volume;
        if (ewa_volume_load(context, path, NULL, &volume) != EWA_OK) continue;
        const ewa_transfer transfer = solid_from(scans[i].solid, 255 - scans[i].solid);
        print_row(context, scans[i].name, &volume, &transfer);
        ewa_volume_free(&volume);
    }
    // The checker box is the paper's own; its size is not told.
    static const uint32_t box_dims[3] = {128, 128, 128};
    static const double unit[3] = {1, 1, 1}, sides[2] = {16, 60};
    ewa_volume box = scene_volume(context, box_dims, unit, scene_checker, sides);
    ewa_transfer solid = scene_linear(0.9f, 0.8f, 0.6f, 0.3f);
    print_row(context, "CheckerBox", &box, &solid);
    ewa_volume_free(&box);
    // The lobster's size and share of seen voxels.
    static const uint32_t dims[3] = {301, 324, 56};
    static const double spacing[3] = {1, 1, 1}, half = 150;
    ewa_volume tubes = scene_volume(context, dims, spacing, scene_vessels, &half);
    ewa_transfer transfer = scene_linear(0.9f, 0.3f, 0.2f, 0.6f);
    print_row(context, "Tubes, for Lobster", &tubes, &transfer);
    if (argc > 1) write_curve(context, &tubes, &transfer, argv[1]);
    ewa_volume_free(&tubes);
    ewa_context_destroy(&context);
    return 0;
}
