// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A small scene for tests of back ends.
#include "gpu_scene.h"

bool gpu_there(void) {
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    ewa_gpu_info info = {.struct_size = sizeof info};
    const ewa_status status = ewa_gpu_describe(context, &info);
    const bool there = status == EWA_OK && info.device_class >= EWA_GPU_CLOSE;
    if (!there) print_message("skipped: %s\n", log.count ? log.text : ewa_status_name(status));
    return there;
}

void gpu_scene_resize(gpu_scene *of, uint32_t width_px, uint32_t height_px) {
    static const double direction[3] = {-0.3, 0.8, -0.5}, up[3] = {0, 0, 1};
    ewa_camera_init(&of->camera);
    of->camera.width_px = width_px, of->camera.height_px = height_px;
    assert_int_equal(ewa_camera_set_fov(&of->camera, 40), EWA_OK);
    assert_int_equal(ewa_camera_frame(&of->camera, &of->bounds, direction, up, 0), EWA_OK);
}

void gpu_scene_make(gpu_scene *of, uint64_t points, uint32_t width_px, uint32_t height_px) {
    of->log.count = 0;
    of->memory = (check_memory){.calls_left = -1};
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = 1;
    options.allocator = check_allocator(&of->memory);
    options.message = check_log_keep;
    options.message_user = &of->log;
    assert_int_equal(ewa_context_create(&options, &of->context), EWA_OK);
    WITH_DEFAULTS(ewa_generate_options, object);
    object.object = EWA_OBJECT_TORUS;
    object.point_count = points;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(of->context, &object, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, &of->bounds), EWA_OK);
    assert_int_equal(ewa_surfels_create(cloud, NULL, &of->surfels), EWA_OK);
    ewa_cloud_destroy(&cloud);
    ewa_render_options_init(&of->options, sizeof of->options);
    gpu_scene_resize(of, width_px, height_px);
}

void gpu_scene_free(gpu_scene *of) {
    ewa_surfels_destroy(&of->surfels);
    ewa_context_destroy(&of->context);
    assert_int_equal(of->memory.held_bytes, 0);
}

ewa_status gpu_scene_draw(const gpu_scene *of, ewa_renderer *renderer, uint8_t *rgba8) {
    return ewa_render(renderer, of->surfels, &of->camera, &of->options, &(ewa_frame){.rgba8 = rgba8}, NULL);
}

bool gpu_scene_same(const gpu_scene *of, const uint8_t *rgba8) {
    const size_t size = (size_t)of->camera.width_px * of->camera.height_px * 4;
    OWNED(check_free) uint8_t *wanted = malloc(size);
    assert_non_null(wanted);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = check_renderer(of->context);
    assert_int_equal(gpu_scene_draw(of, cpu, wanted), EWA_OK);
    const bool same = memcmp(wanted, rgba8, size) == 0;
    return same;
}

const char *gpu_backend(const ewa_renderer *renderer) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_renderer_describe(renderer, &info), EWA_OK);
    return strcmp(info.backend, "gl") == 0 ? "gl" : strcmp(info.backend, "cpu") == 0 ? "cpu" : "other";
}
