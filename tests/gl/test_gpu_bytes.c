// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How work is divided has no say: pages, tiles, units, bands and the order of sources give the bytes that the processor gives.
// That frames of every kind do is held by the tests of the renderer (shadow.c).
#include "ewa/gpu.h"
#include "splat/picture.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH_PX = 203, HEIGHT_PX = 150, POINTS = 3000 };

/// Makes a renderer by OpenGL with a tuning (src/gl/compute.c).
static ewa_renderer *open_tuned(ewa_context *context, const char *tuning) {
    ewa_renderer *made = NULL;
    setenv("EWA_GL_TUNING", tuning, 1);
    assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &made), EWA_OK);
    unsetenv("EWA_GL_TUNING");
    return made;
}

static void assert_same(const picture *a, const picture *b, const char *what) {
    const size_t pixels = (size_t)a->width_px * a->height_px;
    const bool same = memcmp(a->frame.rgba8, b->frame.rgba8, 4 * pixels) == 0 &&
                      memcmp(a->frame.rgba, b->frame.rgba, 16 * pixels) == 0 &&
                      memcmp(a->frame.depth, b->frame.depth, 4 * pixels) == 0 &&
                      memcmp(a->frame.normal, b->frame.normal, 12 * pixels) == 0 &&
                      memcmp(a->frame.coverage, b->frame.coverage, 4 * pixels) == 0;
    if (!same) fail_msg("%s: other bytes", what);
}

/// Draws sources in the order of `order`, a digit each.
static void draw(ewa_renderer *renderer, ewa_surfels *const *parts, const char *order, const scene *of,
                 const ewa_render_options *options, picture *into) {
    const size_t pixels = (size_t)into->width_px * into->height_px;
    memset(into->frame.rgba8, 1, 4 * pixels);
    memset(into->frame.rgba, 1, 16 * pixels);
    assert_int_equal(ewa_render_begin(renderer, &of->camera, options, &into->frame), EWA_OK);
    for (; *order; order++) assert_int_equal(ewa_render_add(renderer, parts[*order - '0']), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

TEST_ON(test_division_has_no_say, 0) {
    static const char *const tunings[][2] = {{"tile_px=8 unit=1 page=3", "tile_px=16 storage=4500000"},
                                             {"tile_px=4 unit=7 page=100 edge_units=4", "tile_px=16 unit=5000"},
                                             {"tile_px=16 unit=100 page=7 parts=3 edge_units=1", "storage=4500000"}};
    static const scene_kind kinds[] = {SCENE_CUBE, SCENE_NEAR, SCENE_ELLIPSES};
    OWNED(picture_free) picture expected = picture_make(WIDTH_PX, HEIGHT_PX), found = picture_make(WIDTH_PX, HEIGHT_PX);
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        OWNED(scene_free) scene of;
        assert_int_equal(scene_make(context, kinds[k], POINTS, WIDTH_PX, HEIGHT_PX, &of), EWA_OK);
        ewa_surfels *parts[1];
        assert_int_equal(ewa_surfels_create(of.cloud, NULL, &parts[0]), EWA_OK);
        WITH_DEFAULTS(ewa_render_options, options);
        options.opacity = k == 2 ? 0.5 : 1;
        ewa_renderer *cpu = check_renderer(context);
        draw(cpu, parts, "0", &of, &options, &expected);
        for (size_t i = 0; i < 2; i++) {
            OWNED(ewa_renderer_destroy) ewa_renderer *gl = open_tuned(context, tunings[k][i]);
            draw(gl, parts, "0", &of, &options, &found);
            assert_same(&expected, &found, tunings[k][i]);
        }
        ewa_renderer_destroy(&cpu);
        ewa_surfels_destroy(&parts[0]);
    }
}

/// The device lights what is drawn in one band, the processor what bands have drawn; with planes and without, over nothing and over
/// colours, of pictures that no group of pixels fits.
TEST_ON(test_eye_dome, 0) {
    static const char *const tunings[] = {"", "arith=emulated", "storage=3800000"};
    OWNED(picture_free) picture expected = picture_make(WIDTH_PX, HEIGHT_PX), found = picture_make(WIDTH_PX, HEIGHT_PX);
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, POINTS, WIDTH_PX, HEIGHT_PX, &of), EWA_OK);
    ewa_surfels *parts[1];
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &parts[0]), EWA_OK);
    ewa_renderer *cpu = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    options.eye_dome = 1;
    const size_t pixels = (size_t)WIDTH_PX * HEIGHT_PX;
    for (size_t t = 0; t < sizeof tunings / sizeof tunings[0]; t++) {
        OWNED(ewa_renderer_destroy) ewa_renderer *gl = open_tuned(context, tunings[t]);
        for (int kind = t ? 2 : 0; kind < 4; kind++) {
            of.camera.projection = kind & 1 ? EWA_ORTHOGRAPHIC : EWA_PERSPECTIVE;
            options.opacity = kind & 2 ? 0.6 : 1;
            for (int c = 0; c < 4; c++) options.background[c] = kind & 2 ? 0.3f + 0.2f * (float)c : 0;
            draw(cpu, parts, "0", &of, &options, &expected);
            draw(gl, parts, "0", &of, &options, &found);
            assert_same(&expected, &found, tunings[t]);
            const ewa_frame bytes = {.rgba8 = found.frame.rgba8}, colors = {.rgba = found.frame.rgba};
            memset(bytes.rgba8, 1, 4 * pixels), memset(colors.rgba, 1, 16 * pixels);
            assert_int_equal(ewa_render(gl, parts[0], &of.camera, &options, &bytes, NULL), EWA_OK);
            assert_int_equal(ewa_render(gl, parts[0], &of.camera, &options, &colors, NULL), EWA_OK);
            assert_same(&expected, &found, "a plane alone");
            ewa_renderer_info info = {.struct_size = sizeof info};
            assert_int_equal(ewa_renderer_describe(gl, &info), EWA_OK);
            assert_int_equal(info.wait_count, t == 2 ? 2 : 1);
        }
    }
    options.eye_dome = 0;
    draw(cpu, parts, "0", &of, &options, &found);
    assert_memory_not_equal(expected.frame.rgba8, found.frame.rgba8, 4 * pixels);
    ewa_renderer_destroy(&cpu);
    ewa_surfels_destroy(&parts[0]);
}

TEST_ON(test_pixels_of_parts, 0) {
    enum { SMALL_PX = 75 };
    static const char *const tunings[] = {"", "storage=2500000"};
    OWNED(picture_free) picture expected = picture_make(SMALL_PX, SMALL_PX), found = picture_make(SMALL_PX, SMALL_PX);
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_CUBE, POINTS, SMALL_PX, SMALL_PX, &of), EWA_OK);
    ewa_surfels *parts[1];
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &parts[0]), EWA_OK);
    ewa_renderer *cpu = NULL;
    assert_int_equal(ewa_renderer_create(context, &cpu), EWA_OK);
    WITH_DEFAULTS(ewa_render_options, options);
    for (int banded = 0; banded < 2; banded++) {
        OWNED(ewa_renderer_destroy) ewa_renderer *gl = open_tuned(context, tunings[banded]);
        for (options.supersampling = banded ? 2 : 0; options.supersampling <= (banded ? 2 : 4); options.supersampling++) {
            draw(cpu, parts, "0", &of, &options, &expected);
            draw(gl, parts, "0", &of, &options, &found);
            assert_same(&expected, &found, "supersampled");
            memset(found.frame.rgba8, 1, 4 * (size_t)SMALL_PX * SMALL_PX);
            const ewa_frame bytes = {.rgba8 = found.frame.rgba8};
            assert_int_equal(ewa_render(gl, parts[0], &of.camera, &options, &bytes, NULL), EWA_OK);
            assert_same(&expected, &found, "supersampled, bytes alone");
            draw(gl, parts, "0", &of, &options, &found); // there is room by now
            ewa_renderer_info info = {.struct_size = sizeof info};
            assert_int_equal(ewa_renderer_describe(gl, &info), EWA_OK);
            if (options.supersampling > 1) assert_true((info.wait_count > 1) == banded);
        }
    }
    ewa_renderer_destroy(&cpu);
    ewa_surfels_destroy(&parts[0]);
}

TEST_ON(test_order_has_no_say, 0) {
    static const scene_kind kinds[] = {SCENE_SPHERE, SCENE_CUBE, SCENE_TORUS};
    OWNED(picture_free) picture expected = picture_make(WIDTH_PX, HEIGHT_PX), found = picture_make(WIDTH_PX, HEIGHT_PX);
    scene scenes[3];
    ewa_surfels *parts[3];
    for (int i = 0; i < 3; i++) {
        assert_int_equal(scene_make(context, kinds[i], POINTS / 2, WIDTH_PX, HEIGHT_PX, &scenes[i]), EWA_OK);
        float *surfaceness = NULL; // of one: a fourth of its points are on no surface
        float *curvature = NULL;   // of the others: to either side, or none
        if (i != 2)
            assert_int_equal(ewa_cloud_add(scenes[i].cloud, EWA_CURVATURE, EWA_F32, 1, (void **)&curvature), EWA_OK);
        for (uint64_t k = 0; curvature && k < ewa_cloud_point_count(scenes[i].cloud); k++)
            curvature[k] = (float)(k % 5) - 1;
        if (i == 2)
            assert_int_equal(ewa_cloud_add(scenes[i].cloud, EWA_SURFACENESS, EWA_F32, 1, (void **)&surfaceness),
                             EWA_OK);
        for (uint64_t k = 0; surfaceness && k < ewa_cloud_point_count(scenes[i].cloud); k++) surfaceness[k] = k % 4 > 0;
        assert_int_equal(ewa_surfels_create(scenes[i].cloud, NULL, &parts[i]), EWA_OK);
    }
    ewa_renderer *cpu = NULL, *gl = open_tuned(context, "");
    assert_int_equal(ewa_renderer_create(context, &cpu), EWA_OK);
    draw(cpu, parts, "012", &scenes[0], NULL, &expected);
    static const char *const orders[] = {"012", "201", "210"};
    for (int i = 0; i < 3; i++) {
        draw(gl, parts, orders[i], &scenes[0], NULL, &found);
        assert_same(&expected, &found, orders[i]);
    }
    ewa_renderer_destroy(&gl);
    ewa_renderer_destroy(&cpu);
    for (int i = 0; i < 3; i++) {
        ewa_surfels_destroy(&parts[i]);
        scene_free(&scenes[i]);
    }
}

/// Surfels that are freed and made again at the same address are other surfels.
TEST_ON(test_surfels_come_and_go, 0) {
    OWNED(picture_free) picture expected = picture_make(WIDTH_PX, HEIGHT_PX), found = picture_make(WIDTH_PX, HEIGHT_PX);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = NULL, *gl = open_tuned(context, "");
    assert_int_equal(ewa_renderer_create(context, &cpu), EWA_OK);
    for (int i = 0; i < 4; i++) {
        OWNED(scene_free) scene of;
        assert_int_equal(
            scene_make(context, i % 2 ? SCENE_TORUS : SCENE_SPHERE, 2000, WIDTH_PX, HEIGHT_PX, &of), EWA_OK);
        ewa_surfels *parts[1];
        assert_int_equal(ewa_surfels_create(of.cloud, NULL, &parts[0]), EWA_OK);
        draw(cpu, parts, "0", &of, NULL, &expected);
        draw(gl, parts, "0", &of, NULL, &found);
        assert_same(&expected, &found, "new surfels");
        ewa_surfels_destroy(&parts[0]);
    }
}

int main(void) {
    ewa_context *context = check_context(0, NULL);
    ewa_renderer *probe = NULL;
    const ewa_status status = ewa_renderer_create_on(context, EWA_BACKEND_GL, &probe);
    ewa_renderer_destroy(&probe);
    ewa_context_destroy(&context);
    if (status != EWA_OK) {
        printf("skipped: no device that draws by OpenGL 4.3\n");
        return 77;
    }
    return RUN_TESTS(NULL, NULL);
}
