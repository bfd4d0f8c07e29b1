// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rough ground of few bare points, seen from above and at a low angle: what its splats move by at contours opens next to nothing of it.
#include "check.h"

#include <math.h>

enum { WIDTH = 960, HEIGHT = 540, PIXELS = WIDTH * HEIGHT, BORDER_PX = 3 };

/// Draws a cloud's alpha; `bends`: with its curvatures, else as if it were flat.
static void draw(ewa_context *context, ewa_cloud *cloud, bool bends, double elevation_deg, float *rgba) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = NULL;
    ewa_asset *asset = NULL;
    WITH_DEFAULTS(ewa_scene_options, options);
    memset(options.render.background, 0, sizeof options.render.background);
    if (!bends) ewa_cloud_remove(cloud, EWA_CURVATURE);
    assert_int_equal(ewa_scene_create(context, &options, &scene), EWA_OK);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    WITH_DEFAULTS(ewa_view_options, view);
    view.width_px = WIDTH, view.height_px = HEIGHT, view.elevation_deg = elevation_deg;
    ewa_camera camera;
    assert_int_equal(ewa_scene_place_camera(scene, &view, &camera, NULL), EWA_OK);
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, NULL, &(ewa_frame){.rgba = rgba}, NULL), EWA_OK);
}

/// Whether all pixels near one are opaque.
static bool is_inner(const float *rgba, int x, int y) {
    for (int j = y - BORDER_PX; j <= y + BORDER_PX; j++)
        for (int i = x - BORDER_PX; i <= x + BORDER_PX; i++)
            if (i < 0 || j < 0 || i >= WIDTH || j >= HEIGHT || rgba[4 * (WIDTH * j + i) + 3] < 1) return false;
    return true;
}

TEST_ON(test_ground, 0) {
    static float flat[4 * PIXELS], bent[4 * PIXELS];
    for (int k = 0; k < 4; k++) {
        WITH_DEFAULTS(ewa_generate_options, generate);
        generate.object = EWA_OBJECT_TERRAIN;
        generate.point_count = k / 2 ? 60000 : 20000;
        generate.positions_only = true;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        assert_int_equal(ewa_cloud_generate(context, &generate, &cloud), EWA_OK);
        WITH_DEFAULTS(ewa_estimate_options, options);
        assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
        const double elevation_deg = k % 2 ? -15 : 0;
        draw(context, cloud, true, elevation_deg, bent);
        draw(context, cloud, false, elevation_deg, flat);
        uint32_t inner = 0, opened = 0;
        for (int i = 0; i < PIXELS; i++)
            if (is_inner(flat, i % WIDTH, i / WIDTH)) inner++, opened += bent[4 * i + 3] < 0.9f;
        print_message("%llu points: %u of %u inner pixels opened\n", (unsigned long long)generate.point_count, opened, inner);
        assert_true(inner > 50000 && opened < 1e-4 * inner);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
