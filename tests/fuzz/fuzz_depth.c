// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as a depth image; what can be read is warped a little.
#include "ewa/ewa.h"
#include "fuzz.h"

#include <stdlib.h>

enum { MAX_PIXELS = 1 << 16 };

static void warp(ewa_context *context, const ewa_image *depth) {
    const size_t pixel_count = (size_t)depth->width_px * depth->height_px;
    if (pixel_count > MAX_PIXELS) return;
    ewa_depth_image image;
    ewa_depth_image_init(&image);
    image.camera.width_px = depth->width_px;
    image.camera.height_px = depth->height_px;
    image.depth = depth->pixels;
    image.depth_type = EWA_F32;
    image.kind = (ewa_depth_kind)(pixel_count % 2);
    ewa_camera target = image.camera;
    target.world_to_camera[3] = 0.1;
    ewa_warp *warp = NULL;
    uint8_t *rgba8 = malloc(4 * pixel_count);
    const ewa_frame frame = {.rgba8 = rgba8};
    if (rgba8 && ewa_warp_create(context, &warp) == EWA_OK &&
        ewa_warp_take(warp, &image, 1, NULL, NULL) == EWA_OK)
        for (int method = 0; method < 2; method++)
            if (ewa_warp_draw(warp, &target, (ewa_warp_method)method, NULL, &frame, NULL, NULL) != EWA_OK)
                abort();
    free(rgba8);
    ewa_warp_destroy(&warp);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = fuzz_context(1, 0, NULL);
    ewa_image depth;
    if (ewa_depth_load_memory(context, bytes, size_bytes, "fuzz", &depth) == EWA_OK) {
        warp(context, &depth);
        ewa_image_free(&depth);
    }
    ewa_context_destroy(&context);
    return 0;
}
