// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What each pass of a frame takes: a torus, with eye-dome lighting, and once more in parts of pixels for their averages.
#include "ewa/ewa.h"
#include "gl/backends.h"
#include "gl/compute.h"
#include "rates.h"
#include "surface/render.h"

#include <math.h>

enum { FRAMES = 5, MILLION = 1000000, SOFTWARE = 20000, SOFTWARE_SHARE = 4 };

/// What is drawn, and what with.
typedef struct pass_scene {
    ewa_context *context;
    ewa_surfels *surfels;
    ewa_camera camera;
    ewa_renderer *renderer;
    uint8_t *rgba8;
} pass_scene;

static ewa_status make_surfels(pass_scene *scene, uint64_t point_count) {
    static const double direction[3] = {-0.3, 0.8, -0.5}, up[3] = {0, 0, 1};
    ewa_generate_options object;
    ewa_generate_options_init(&object, sizeof object);
    object.object = EWA_OBJECT_TORUS, object.point_count = point_count;
    ewa_cloud *cloud;
    EWA_TRY(ewa_cloud_generate(scene->context, &object, &cloud));
    ewa_bounds bounds;
    ewa_status status = ewa_cloud_measure(cloud, &bounds);
    if (status == EWA_OK) status = ewa_camera_set_fov(&scene->camera, 40);
    if (status == EWA_OK) status = ewa_camera_frame(&scene->camera, &bounds, direction, up, 0);
    if (status == EWA_OK) status = ewa_surfels_create(cloud, NULL, &scene->surfels);
    ewa_cloud_destroy(&cloud);
    return status;
}

/// Draws frames, and keeps of each pass the shortest time. The first frames make room and compile.
static ewa_status draw_frames(const pass_scene *scene, const ewa_render_options *options, double ms[EWA_GL_PASSES]) {
    enum { WARM_UP = 3 };
    ewa_context *context;
    void *state;
    ewa_renderer_backend(scene->renderer, &context, &state);
    const ewa_gl_compute *gl = state;
    for (int frame = -WARM_UP; frame < FRAMES; frame++) {
        const ewa_frame planes = {.rgba8 = scene->rgba8};
        EWA_TRY(ewa_render(scene->renderer, scene->surfels, &scene->camera, options, &planes, NULL));
        for (int pass = 0; pass < EWA_GL_PASSES && frame >= 0; pass++) {
            const double now_ms = 1e3 * gl->times.seconds[pass];
            if (now_ms > 0) ms[pass] = ms[pass] > 0 ? fmin(ms[pass], now_ms) : now_ms;
        }
    }
    return EWA_OK;
}

static ewa_status draw_both(const pass_scene *scene, probe_rates *rates) {
    ewa_render_options options;
    ewa_render_options_init(&options, sizeof options);
    options.supersampling = 1, options.eye_dome = 1;
    EWA_TRY(draw_frames(scene, &options, rates->pass_ms));
    double fine_ms[EWA_GL_PASSES] = {0};
    options.supersampling = 2, options.eye_dome = 0;
    EWA_TRY(draw_frames(scene, &options, fine_ms));
    rates->pass_ms[EWA_GL_AVERAGES] = fine_ms[EWA_GL_AVERAGES];
    return EWA_OK;
}

ewa_status probe_passes(ewa_context *context, bool software, probe_rates *rates) {
    const uint32_t share = software ? SOFTWARE_SHARE : 1;
    pass_scene scene = {.context = context};
    ewa_camera_init(&scene.camera);
    scene.camera.width_px = PROBE_WIDTH_PX / share, scene.camera.height_px = PROBE_HEIGHT_PX / share;
    rates->pass_splat_count = software ? SOFTWARE : MILLION;
    rates->pass_width_px = scene.camera.width_px, rates->pass_height_px = scene.camera.height_px;
    const size_t pixels = (size_t)scene.camera.width_px * scene.camera.height_px;
    scene.rgba8 = ewa_allocate(context, pixels, 4);
    ewa_status status = scene.rgba8 ? make_surfels(&scene, rates->pass_splat_count) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_renderer_create_on(context, EWA_BACKEND_GL, &scene.renderer);
    if (status == EWA_OK) status = draw_both(&scene, rates);
    ewa_renderer_destroy(&scene.renderer);
    ewa_surfels_destroy(&scene.surfels);
    if (scene.rgba8) ewa_release(context, scene.rgba8, pixels, 4);
    return status;
}
