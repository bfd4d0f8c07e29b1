// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A small scene for tests of back ends.
#ifndef EWA_TESTS_GPU_SCENE_H
#define EWA_TESTS_GPU_SCENE_H

#include "check.h"

/// A context, and a torus before a camera.
typedef struct gpu_scene {
    check_log log;
    check_memory memory; ///< of the context; all of it is given back in the end
    ewa_context *context;
    ewa_surfels *surfels;
    ewa_bounds bounds;
    ewa_camera camera;
    ewa_render_options options;
} gpu_scene;

enum { GPU_MAX_PX = 512 };

/// Says why there is nothing to test, and returns false, where there is no device with compute programs.
bool gpu_there(void);

/// Makes the scene; `of` is not to be moved.
void gpu_scene_make(gpu_scene *of, uint64_t points, uint32_t width_px, uint32_t height_px);
void gpu_scene_free(gpu_scene *of);

/// Sets the camera's size.
void gpu_scene_resize(gpu_scene *of, uint32_t width_px, uint32_t height_px);

/// Draws a frame of 4 bytes per pixel.
ewa_status gpu_scene_draw(const gpu_scene *of, ewa_renderer *renderer, uint8_t *rgba8);

/// Draws with the processor and compares all bytes.
bool gpu_scene_same(const gpu_scene *of, const uint8_t *rgba8);

/// What draws, by name.
const char *gpu_backend(const ewa_renderer *renderer);

#endif
