// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scan to a picture: render_scan IN.ply OUT.png
#include "ewa/ewa.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH_PX = 800, HEIGHT_PX = 600 };

static void print_message(void *user, ewa_severity severity, const char *text) {
    (void)user;
    (void)severity;
    fprintf(stderr, "render_scan: %s\n", text);
}

/// Loads a file, estimates what surfels need and the file lacks, and makes surfels and a camera that sees
/// them all.
static ewa_status make_scene(ewa_context *context, const char *path, ewa_surfels **surfels,
                             ewa_camera *camera) {
    ewa_cloud *cloud = NULL;
    ewa_status status = ewa_cloud_load(context, path, &cloud);
    ewa_estimate_options estimate;
    ewa_estimate_options_init(&estimate, sizeof estimate);
    if (status == EWA_OK) status = ewa_cloud_estimate(&cloud, &estimate);
    if (status == EWA_OK) status = ewa_surfels_create(cloud, NULL, surfels);
    ewa_bounds bounds;
    if (status == EWA_OK) status = ewa_cloud_measure(cloud, &bounds);
    ewa_camera_init(camera);
    camera->width_px = WIDTH_PX;
    camera->height_px = HEIGHT_PX;
    static const double ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    if (status == EWA_OK) status = ewa_camera_set_fov(camera, 30);
    if (status == EWA_OK) status = ewa_camera_frame(camera, &bounds, ahead, up, 0.05);
    ewa_cloud_destroy(&cloud);
    return status;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fputs("usage: render_scan IN.ply OUT.png\n", stderr);
        return 2;
    }
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = print_message;
    ewa_context *context = NULL;
    ewa_surfels *surfels = NULL;
    ewa_renderer *renderer = NULL;
    ewa_camera camera;
    uint8_t *pixels = malloc((size_t)4 * WIDTH_PX * HEIGHT_PX);
    ewa_status status = pixels ? ewa_context_create(&options, &context) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = make_scene(context, argv[1], &surfels, &camera);
    if (status == EWA_OK) status = ewa_renderer_create(context, &renderer);
    const ewa_frame frame = {.rgba8 = pixels};
    if (status == EWA_OK) status = ewa_render(renderer, surfels, &camera, NULL, &frame, NULL);
    if (status == EWA_OK)
        status = ewa_png_save(context, argv[2], WIDTH_PX, HEIGHT_PX, 4, pixels, (size_t)4 * WIDTH_PX);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_context_destroy(&context);
    free(pixels);
    return status == EWA_OK ? 0 : 1;
}
