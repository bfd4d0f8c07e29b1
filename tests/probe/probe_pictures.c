// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of random scenes and of a mirror, and the image room's curves.
#include "reference/surface.h"
#include "tests/independent/random_scene.h"
#include "tests/probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_curves(probe *to) {
    float curve[600];
    for (int i = 0; i < 300; i++) {
        const float value = (float)i / 280 - 0.03f;
        curve[2 * i] = ewa_srgb_from_linear(value), curve[2 * i + 1] = ewa_linear_from_srgb(value);
    }
    probe_floats(to, "sRGB", PROBE_NUMBERS, curve, 600);
    for (int map = 0; map <= EWA_COLORMAP_COOLWARM; map++) {
        double codes[3 * 40];
        for (int i = 0; i < 40; i++) {
            uint8_t srgb[3];
            ewa_colormap_color((ewa_colormap)map, i == 39 ? (double)NAN : i / 36.0 - 0.02, srgb);
            for (int c = 0; c < 3; c++) codes[3 * i + c] = srgb[c];
        }
        probe_doubles(to, "colours", PROBE_NUMBERS, codes, 120);
    }
}

/// A sphere that mirrors a picture of all directions.
static void put_mirrors(probe *to) {
    OWNED(ewa_image_free) ewa_image sky;
    if (ewa_image_create(to->context, 48, 24, 3, &sky) != EWA_OK) abort();
    for (uint32_t i = 0; i < 48 * 24; i++) {
        const uint32_t x = i % 48, y = i / 48;
        sky.pixels[3 * i] = (x / 4 + y / 4) % 2 ? 0.9f : 0.1f;
        sky.pixels[3 * i + 1] = (float)x / 48;
        sky.pixels[3 * i + 2] = (float)y / 24;
    }
    OWNED(ewa_environment_destroy) ewa_environment *environment = NULL;
    probe_status(to, "environment", ewa_environment_create(&sky, &environment));
    WITH_DEFAULTS(ewa_generate_options, generate);
    generate.object = EWA_OBJECT_SPHERE, generate.point_count = 800;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = NULL;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    ewa_material material;
    ewa_material_init(&material);
    material.reflection = 0.8f;
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_PHONG;
    options.materials = &material, options.material_count = 1;
    options.environment = environment;
    probe_status(to, "generate", ewa_cloud_generate(to->context, &generate, &cloud));
    probe_status(to, "surfels", ewa_surfels_create(cloud, NULL, &surfels));
    probe_status(to, "renderer", ewa_renderer_create(to->context, &renderer));
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    for (int k = 0; k < 6; k++) {
        const ewa_camera camera = probe_view(&info.bounds, k - 2.3, 1.7, -0.4, k == 4);
        options.environment_up[0] = k == 1,
        options.environment_up[1] = k == 5 ? -1 : k<2, options.environment_up[2] = k> 1 && k < 5;
        OWNED(probe_frame_free) ewa_frame frame = probe_frame(&camera, true);
        probe_status(to, "mirror", ewa_render(renderer, surfels, &camera, &options, &frame, NULL));
        probe_frame_put(to, "mirror", &camera, &frame);
        if (k < 2 && !to->brief) {
            probe_status(to, "mirror",
                         ewa_render_reference(cloud, NULL, info.unit_coverage, &camera, &options, &frame));
            probe_frame_put(to, "mirror by the reference", &camera, &frame);
        }
    }
}

void probe_pictures(probe *to) {
    put_curves(to);
    put_mirrors(to);
}

static void put_scene(probe *to, random_scene *made, bool reference) {
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = NULL;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    OWNED(probe_frame_free) ewa_frame frame = probe_frame(&made->scene.camera, true);
    probe_status(to, "surfels", ewa_surfels_create(made->cloud, &made->surfels_options, &surfels));
    probe_status(to, "renderer", ewa_renderer_create(to->context, &renderer));
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    const double numbers[4] = {(double)info.point_count, info.unit_coverage, info.transparent,
                               info.material_count};
    for (int i = 0; i < 4; i++) probe_number(to, "surfels info", numbers[i]);
    probe_doubles(to, "surfels bounds", PROBE_NUMBERS, info.bounds.low_world, 6);
    probe_status(to, "render",
                 ewa_render(renderer, surfels, &made->scene.camera, &made->scene.options, &frame, NULL));
    probe_frame_put(to, "scene", &made->scene.camera, &frame);
    if (reference) {
        probe_status(to, "reference",
                     ewa_render_reference(made->cloud, &made->surfels_options, info.unit_coverage,
                                          &made->scene.camera, &made->scene.options, &frame));
        probe_frame_put(to, "scene by the reference", &made->scene.camera, &frame);
    }
}

void probe_splats(probe *to) {
    random_scene made;
    for (uint64_t seed = 5000; seed < (to->brief ? 5012 : 5036); seed++) {
        random_scene_make(to->context, seed, &made);
        put_scene(to, &made, !to->brief && seed % 2);
        random_scene_free(&made);
    }
    for (uint32_t i = 0; named_scene_make(to->context, i, &made); i++) {
        put_scene(to, &made, false);
        random_scene_free(&made);
    }
    // More points than a packet, a run and a tile have.
    WITH_DEFAULTS(ewa_generate_options, generate);
    generate.object = EWA_OBJECT_TERRAIN, generate.point_count = 20000;
    ewa_render_options *options = &made.scene.options;
    memset(&made, 0, sizeof made);
    ewa_render_options_init(options, sizeof *options);
    ewa_surfels_options_init(&made.surfels_options, sizeof made.surfels_options);
    ewa_bounds bounds;
    probe_status(to, "generate", ewa_cloud_generate(to->context, &generate, &made.cloud));
    probe_status(to, "measure", ewa_cloud_measure(made.cloud, &bounds));
    made.scene.camera = probe_view(&bounds, 1, 0.6, -0.2, false);
    made.scene.camera.width_px = 200, made.scene.camera.height_px = 90;
    options->opacity = 0.7, options->layers = 3;
    put_scene(to, &made, false);
    options->opacity = 1, options->layers = 0;
    put_scene(to, &made, false);
    ewa_cloud_destroy(&made.cloud);
}
