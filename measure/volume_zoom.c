// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Zooms out of a volume of thin vessels and prints how far pictures are from the truth, in dB: the mean of
// 256 samples in each pixel. The table of docs/volume.md.
//
// measure_volume_zoom [FOLDER]: with a folder, also writes pictures there.
#include "image_difference.h"
#include "measure/measure.h"
#include "volume/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE_PX = 128, SUPER = 16, METHODS = 4 };

/// The mean of SUPER x SUPER samples of each pixel, without a filter: as dense as that, all voxels are
/// magnified.
static ewa_image make_truth(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera) {
    ewa_camera dense = *camera;
    dense.width_px *= SUPER, dense.height_px *= SUPER;
    dense.fx_px *= SUPER, dense.fy_px *= SUPER, dense.cx_px *= SUPER, dense.cy_px *= SUPER;
    WITH_DEFAULTS(ewa_volume_options, options);
    options.method = EWA_VOLUME_SPLATS, options.prefilter_px = 0, options.minimum_transmittance = 0;
    ewa_image samples = scene_draw(context, voxels, &dense, &options), truth;
    check(ewa_image_create(context, camera->width_px, camera->height_px, 4, &truth));
    for (size_t y = 0; y < dense.height_px; y++)
        for (size_t x = 0; x < dense.width_px; x++)
            for (size_t c = 0; c < 4; c++)
                truth.pixels[4 * (y / SUPER * SIDE_PX + x / SUPER) + c] +=
                    samples.pixels[4 * (y * dense.width_px + x) + c] / (SUPER * SUPER);
    ewa_image_free(&samples);
    return truth;
}

static void save(ewa_image *const images[], uint32_t count, const char *folder, double pixels) {
    char path[1024];
    snprintf(path, sizeof path, "%s/volume_zoom_%.2f.png", folder, pixels);
    enum { ZOOM = 2 };
    ewa_image row;
    check(ewa_image_create(images[0]->context, ZOOM * SIDE_PX * count, ZOOM * SIDE_PX, 3, &row));
    for (size_t y = 0; y < row.height_px; y++)
        for (size_t x = 0; x < row.width_px; x++)
            for (size_t c = 0; c < 3; c++)
                row.pixels[3 * (y * row.width_px + x) + c] =
                    images[x / ZOOM / SIDE_PX]->pixels[4 * (y / ZOOM * SIDE_PX + x / ZOOM % SIDE_PX) + c];
    check(ewa_image_save(&row, path, NULL));
    ewa_image_free(&row);
}

static void zoom(ewa_context *context, const ewa_volume *volume, float extinction, const char *folder) {
    static const double direction[3] = {0.4, 0.25, -1};
    const ewa_transfer transfer = scene_linear(0.95f, 0.45f, 0.3f, extinction);
    ewa_voxels *voxels = scene_voxels(volume, &transfer);
    for (double pixels = 3; pixels > 0.1; pixels /= sqrt(2)) {
        ewa_camera camera = scene_camera(SIDE_PX, SIDE_PX, direction, 1);
        const double distance = camera.fy_px / pixels;
        camera = scene_camera(SIDE_PX, SIDE_PX, direction, distance);
        if (distance < 90) continue; // within the volume
        ewa_image truth = make_truth(context, voxels, &camera), drawn[METHODS];
        double psnr_db[METHODS], share = 0;
        for (int m = 0; m < METHODS; m++) {
            WITH_DEFAULTS(ewa_volume_options, options);
            options.method = m == 0 ? EWA_VOLUME_HYBRID : m == 3 ? EWA_VOLUME_POINTS : EWA_VOLUME_SPLATS;
            if (m == 2) options.prefilter_px = 0;
            drawn[m] = scene_draw(context, voxels, &camera, &options);
            if (m == 0) share = scene_point_share(context, voxels, &camera, &options);
            const image_difference difference = image_compare(&drawn[m], &truth, 0);
            psnr_db[m] = difference.psnr_db;
        }
        printf("| %g | %.2f | %.1f | %.1f | %.1f | %.1f | %.0f %% |\n", (double)extinction, pixels,
               psnr_db[0], psnr_db[1], psnr_db[2], psnr_db[3], 100 * share);
        ewa_image *const row[] = {&truth, &drawn[0], &drawn[2], &drawn[3]};
        if (folder) save(row, 4, folder, pixels);
        ewa_image_free(&truth);
        for (int m = 0; m < METHODS; m++) ewa_image_free(&drawn[m]);
    }
    ewa_voxels_destroy(&voxels);
}

int main(int argc, char **argv) {
    static const uint32_t dims[3] = {128, 128, 128};
    static const double spacing[3] = {1, 1, 1}, half = 56;
    ewa_context *context;
    check(ewa_context_create(NULL, &context));
    ewa_volume volume = scene_volume(context, dims, spacing, scene_vessels, &half);
    printf(
        "| extinction per voxel | px per voxel | hybrid | all splats | all splats, no filter | all points | "
        "points in the hybrid |\n|---|---|---|---|---|---|---|\n");
    zoom(context, &volume, 0.3f, argc > 1 ? argv[1] : NULL);
    zoom(context, &volume, 1.5f, NULL);
    ewa_volume_free(&volume);
    ewa_context_destroy(&context);
    return 0;
}
