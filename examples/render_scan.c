// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A scan to a picture: render_scan IN OUT.png. IN is anything that can be drawn: points, a mesh, Gaussians, a volume.
#include "ewa/ewa.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH_PX = 800, HEIGHT_PX = 600 };

static void print_message(void *user, ewa_severity severity, const char *text) {
    (void)user;
    (void)severity;
    fprintf(stderr, "render_scan: %s\n", text);
}

/// Makes a scene of a file and draws it from where all of it is seen.
static ewa_status draw(ewa_context *context, const char *path, uint8_t *rgba8) {
    ewa_asset *asset = NULL;
    ewa_scene *scene = NULL;
    ewa_scene_renderer *renderer = NULL;
    ewa_view_options view;
    ewa_camera camera;
    ewa_view_options_init(&view, sizeof view);
    view.width_px = WIDTH_PX;
    view.height_px = HEIGHT_PX;
    ewa_status status = ewa_asset_load(context, path, NULL, &asset);
    if (status == EWA_OK) status = ewa_scene_create(context, NULL, &scene);
    if (status == EWA_OK) status = ewa_scene_add(scene, asset, NULL);
    if (status == EWA_OK) status = ewa_scene_place_camera(scene, &view, &camera, NULL);
    if (status == EWA_OK) status = ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer);
    const ewa_frame frame = {.rgba8 = rgba8};
    if (status == EWA_OK) status = ewa_scene_draw(scene, renderer, &camera, NULL, &frame, NULL);
    ewa_scene_renderer_destroy(&renderer);
    ewa_scene_destroy(&scene);
    ewa_asset_release(&asset);
    return status;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fputs("usage: render_scan IN OUT.png\n", stderr);
        return 2;
    }
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = print_message;
    ewa_context *context = NULL;
    uint8_t *pixels = malloc((size_t)4 * WIDTH_PX * HEIGHT_PX);
    ewa_status status = pixels ? ewa_context_create(&options, &context) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = draw(context, argv[1], pixels);
    if (status == EWA_OK)
        status = ewa_png_save(context, argv[2], WIDTH_PX, HEIGHT_PX, 4, pixels, (size_t)4 * WIDTH_PX);
    ewa_context_destroy(&context);
    free(pixels);
    return status == EWA_OK ? 0 : 1;
}
