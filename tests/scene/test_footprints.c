// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outlines of surfels over a picture: circles and ellipses where they must be, none of what is hidden, none beyond clip lines.
#include "check.h"

#include <math.h>

enum { SIDE = 128 };

/// Two discs that face the eye, the second one behind and inside of the first; `clip`: the first ends at its middle.
static ewa_cloud *make_discs(ewa_context *context, bool clip) {
    static const float positions[6] = {0, 0, 0, 0.2f, 0, 4}, us[6] = {0.5f, 0, 0, 0.1f, 0, 0}, vs[6] = {0, 0.25f, 0, 0, 0.1f, 0};
    static const float lines[6] = {1, 0, 0, 0, 0, 0};
    static const char *const names[] = {EWA_POSITION, EWA_TANGENT_U, EWA_TANGENT_V, EWA_CLIP0};
    const float *const streams[] = {positions, us, vs, lines};
    ewa_cloud *cloud = check_cloud_of(context, 2);
    for (int i = 0; i < (clip ? 4 : 3); i++) {
        void *data = NULL;
        assert_int_equal(ewa_cloud_add(cloud, names[i], EWA_F32, 3, &data), EWA_OK);
        memcpy(data, streams[i], sizeof positions);
    }
    return cloud;
}

/// Looks along z from -10, 16 pixels per unit at the first disc.
static ewa_camera make_camera(bool orthographic) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.cx_px = camera.cy_px = SIDE / 2;
    camera.world_to_camera[11] = 10;
    camera.projection = orthographic ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
    camera.fx_px = camera.fy_px = orthographic ? 16 : 160;
    return camera;
}

/// Draws `count` outlines of a cloud's surfels on white, and destroys it; returns how many pixels are no longer white.
static int outline(ewa_context *context, ewa_cloud *cloud, bool close_gaps, bool orthographic, uint32_t count,
                   uint8_t *pixels) {
    WITH_DEFAULTS(ewa_scene_options, options);
    options.close_gaps = close_gaps;
    ewa_scene *scene = NULL;
    ewa_scene_renderer *renderer = NULL;
    ewa_asset *asset = NULL;
    assert_int_equal(ewa_scene_create(context, &options, &scene), EWA_OK);
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_asset_release(&asset);
    const ewa_camera camera = make_camera(orthographic);
    memset(pixels, 255, 4 * SIDE * SIDE);
    const ewa_canvas canvas = {pixels, SIDE, SIDE}, small = {pixels, SIDE, SIDE - 1};
    assert_int_equal(ewa_scene_draw_outlines(scene, renderer, &camera, NULL, count, &small), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_scene_draw_outlines(scene, renderer, &camera, NULL, count, &canvas), EWA_OK);
    ewa_scene_renderer_destroy(&renderer);
    ewa_scene_destroy(&scene);
    ewa_cloud_destroy(&cloud);
    int dark = 0;
    for (int i = 0; i < SIDE * SIDE; i++) dark += pixels[4 * i] < 255;
    return dark;
}

static int draw(ewa_context *context, bool clip, bool orthographic, uint32_t count, uint8_t *pixels) {
    return outline(context, make_discs(context, clip), false, orthographic, count, pixels);
}

/// The axes are 0.5 and 0.25 long, the cutoff 3: half axes of 24 and 12 pixels. Hidden discs have no outline.
TEST_ON(test_ellipses, 1) {
    static uint8_t pixels[4 * SIDE * SIDE];
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        assert_int_equal(draw(context, false, orthographic, 0, pixels), 0);
        const int dark = draw(context, false, orthographic, 100, pixels);
        assert_true(dark > 200 && dark < 450); // a line of 1.2 pixels around 116
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double dx = x + 0.5 - SIDE / 2, dy = y + 0.5 - SIDE / 2;
                const double slope = hypot(dx / (24 * 24), dy / (12 * 12));
                const double away = fabs(dx * dx / (24 * 24) + dy * dy / (12 * 12) - 1) / fmax(2 * slope, 1e-9);
                if (away < 0.3) assert_true(pixels[4 * (y * SIDE + x)] < 200);
                if (away > 2.5) assert_int_equal(pixels[4 * (y * SIDE + x)], 255);
            }
    }
}

/// A line u >= 0 leaves the right half, through which the hidden disc's middle is still not seen.
TEST_ON(test_clip_lines, 1) {
    static uint8_t pixels[4 * SIDE * SIDE];
    const int whole = draw(context, false, false, 5, pixels), half = draw(context, true, false, 5, pixels);
    assert_true(half > 0.4 * whole && half < 0.6 * whole);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE / 2 - 3; x++) assert_int_equal(pixels[4 * (y * SIDE + x)], 255);
}

/// Where gaps between the discs are closed, outlines are those of the larger discs that are drawn.
TEST_ON(test_closed_gaps, 1) {
    enum { COLUMNS = 40 };
    static uint8_t pixels[4 * SIDE * SIDE];
    int dark[2];
    for (int closed = 0; closed < 2; closed++) {
        void *position = NULL, *normal = NULL, *radius = NULL;
        ewa_cloud *cloud = check_cloud_of(context, COLUMNS * COLUMNS);
        assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, &position), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
        for (int i = 0; i < COLUMNS * COLUMNS; i++) {
            const float at[3] = {0.1f * (float)(i % COLUMNS - COLUMNS / 2), 0.1f * (float)(i / COLUMNS - COLUMNS / 2), 0};
            const float up[3] = {0, 0, -1};
            memcpy((float *)position + 3 * i, at, sizeof at);
            memcpy((float *)normal + 3 * i, up, sizeof up);
            ((float *)radius)[i] = 0.02f;
        }
        dark[closed] = outline(context, cloud, closed, true, 1, pixels);
    }
    assert_true(dark[0] > 0 && dark[1] > 2 * dark[0]);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
