// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sources with weights, and sources that hide nothing: what a cross-fade between two samplings of one surface is
// made of.
#include "splat/cubes.h"

#include <math.h>

enum { SIDE = 120, POINTS = 1800 };

typedef struct part {
    const ewa_surfels *surfels;
    double weight;
    bool hides;
} part;

static void draw(ewa_renderer *renderer, const scene *of, const ewa_render_options *options,
                 const part *parts, uint32_t count, const picture *to) {
    assert_int_equal(ewa_render_begin(renderer, &of->camera, options, &to->frame), EWA_OK);
    for (uint32_t i = 0; i < count; i++) {
        const ewa_render_source how = {parts[i].weight, parts[i].hides};
        assert_int_equal(ewa_render_add_source(renderer, parts[i].surfels, &how), EWA_OK);
    }
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

/// A weight of 1 changes nothing, two halves next to nothing.
static void hold_halves(scene_kind kind, const ewa_render_options *options, bool clips, bool bytes_only,
                        const char *what) {
    ewa_context *context = check_context(0, NULL);
    scene of;
    assert_int_equal(scene_make(context, kind, POINTS, SIDE, SIDE, &of), EWA_OK);
    if (clips) picture_add_clips(of.cloud);
    ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    ewa_renderer *renderer = check_renderer(context);
    picture drawn[3];
    for (int i = 0; i < 3; i++) drawn[i] = picture_make(SIDE, SIDE);
    picture to[3] = {drawn[0], drawn[1], drawn[2]};
    for (int i = 0; i < 3 && bytes_only; i++) to[i].frame = (ewa_frame){.rgba8 = drawn[i].frame.rgba8};
    assert_int_equal(ewa_render(renderer, surfels, &of.camera, options, &to[0].frame, NULL), EWA_OK);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, options, &to[1].frame), EWA_OK);
    assert_int_equal(ewa_render_add_weighted(renderer, surfels, 1), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
    if (!bytes_only) picture_expect_same(&drawn[0], &drawn[1]);
    assert_int_equal(cubes_largest_step(&drawn[0], &drawn[1]), 0);
    draw(renderer, &of, options, (part[]){{surfels, 0.5, true}, {surfels, 0.5, true}}, 2, &to[2]);
    const uint32_t step = cubes_largest_step(&drawn[0], &drawn[2]);
    print_message("%s, %s: two halves are %u off\n", scene_name(kind), what, step);
    // Of few units of a side that is turned away the mean is coarse (docs/math.md section 6): one number may be 2 off.
    size_t apart = 0;
    for (size_t i = 0; i < 4 * (size_t)SIDE * SIDE; i++)
        apart += abs((int)drawn[0].frame.rgba8[i] - (int)drawn[2].frame.rgba8[i]) > 1;
    assert_true(step <= 2 && apart <= 1);
    for (size_t i = 0; i < (size_t)SIDE * SIDE && !bytes_only; i++) {
        const double whole = (double)drawn[0].frame.coverage[i], sum = (double)drawn[2].frame.coverage[i];
        assert_true(fabs(whole - sum) <= 1e-4 * fmax(whole, 1));
    }
    for (int i = 0; i < 3; i++) picture_free(&drawn[i]);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    scene_free(&of);
    ewa_context_destroy(&context);
}

TEST(test_halves) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.background[0] = 0.3f, options.background[3] = 1; // no colour is divided by a small alpha
    for (scene_kind kind = 0; kind < SCENE_COUNT; kind++)
        hold_halves(kind, &options, false, false, "as it is");
    hold_halves(SCENE_SPHERE, &options, false, true, "bytes only");
    hold_halves(SCENE_ELLIPSES, &options, true, false, "clipped");
    options.kernel = EWA_KERNEL_RAYCAST;
    hold_halves(SCENE_ELLIPSES, &options, false, false, "raycast");
    options.kernel = EWA_KERNEL_PERSPECTIVE;
    options.opacity = 0.5;
    hold_halves(SCENE_TORUS, &options, false, false, "transparent");
    options.layers = 2;
    hold_halves(SCENE_TORUS, &options, false, false, "two layers");
    options.opacity = 1;
    options.point_size_px = 5;
    hold_halves(SCENE_CUBE, &options, false, false, "points");
    options.point_size_px = 0;
    options.passes = 1;
    hold_halves(SCENE_CUBE, &options, false, false, "one pass");
}

/// A sheet of one colour across the picture, `z` before the eye.
static ewa_surfels *make_sheet(ewa_context *context, double z, uint8_t red, uint8_t blue, double half_width) {
    enum { SHEET = 40 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, SHEET * SHEET);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 3);
    for (uint32_t i = 0; i < SHEET * SHEET; i++) {
        position[3 * i] = (float)(half_width * (2.0 * (i % SHEET) / (SHEET - 1) - 1));
        position[3 * i + 1] = (float)(2.0 * (i / SHEET) / (SHEET - 1) - 1);
        position[3 * i + 2] = (float)z;
        normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = -1;
        radius[i] = 0.08f;
        color[3 * i] = red, color[3 * i + 1] = 0, color[3 * i + 2] = blue;
    }
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    return surfels;
}

/// A camera at the origin that looks along z at sheets of that size.
static scene sheet_scene(void) {
    scene of = {.cloud = NULL};
    ewa_camera_init(&of.camera);
    of.camera.width_px = of.camera.height_px = SIDE;
    of.camera.fx_px = of.camera.fy_px = 1.5 * SIDE;
    of.camera.cx_px = of.camera.cy_px = SIDE / 2.0;
    return of;
}

/// The linear red and blue of the middle of the picture.
static void read_middle(const picture *from, double mean[2]) {
    mean[0] = mean[1] = 0;
    for (uint32_t y = SIDE / 2 - 10; y < SIDE / 2 + 10; y++)
        for (uint32_t x = SIDE / 2 - 10; x < SIDE / 2 + 10; x++) {
            const float *pixel = from->frame.rgba + 4 * (y * SIDE + x);
            mean[0] += (double)pixel[0] / 400, mean[1] += (double)pixel[2] / 400;
        }
}

/// Two sheets at one place: the picture goes from one to the other as the weights do.
TEST_ON(test_cross_fade, 0) {
    scene of = sheet_scene();
    OWNED(ewa_surfels_destroy)
    ewa_surfels *red = make_sheet(context, 4, 255, 0, 1), *blue = make_sheet(context, 4, 0, 255, 1);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    OWNED(picture_free) picture drawn = picture_make(SIDE, SIDE);
    for (double t = 1.0 / 64; t < 1; t += 1.0 / 64) {
        draw(renderer, &of, &options, (part[]){{red, 1 - t, true}, {blue, t, true}}, 2, &drawn);
        double mean[2];
        read_middle(&drawn, mean);
        assert_true(fabs(mean[0] - (1 - t)) < 1e-3);
        assert_true(fabs(mean[1] - t) < 1e-3);
    }
}

/// A faint sheet a little in front hides what is behind it only if it is to.
TEST_ON(test_hiding, 0) {
    scene of = sheet_scene();
    OWNED(ewa_surfels_destroy)
    ewa_surfels *front = make_sheet(context, 3.5, 255, 0, 1), *back = make_sheet(context, 4, 0, 255, 0.7),
                *far = make_sheet(context, 4.5, 255, 0, 1);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_NONE;
    OWNED(picture_free) picture drawn = picture_make(SIDE, SIDE), alone = picture_make(SIDE, SIDE);
    double mean[2];
    const double weight = 1.0 / 64;
    draw(renderer, &of, &options, (part[]){{front, weight, true}, {back, 1, true}}, 2, &drawn);
    read_middle(&drawn, mean);
    assert_true(mean[0] > 0.03 && mean[1] < 0.98); // the part of the pixel that it covers, and what is behind
    const double hidden_blue = mean[1];
    draw(renderer, &of, &options, (part[]){{front, weight, false}, {back, 1, true}}, 2, &drawn);
    read_middle(&drawn, mean);
    print_message("a weight of %g, which hides nothing, adds %.5f\n", weight, mean[0]);
    assert_true(fabs(mean[0] - weight / (1 + weight)) < 4e-3);
    assert_true(fabs(mean[1] - 1 / (1 + weight)) < 4e-3);
    assert_true(mean[1] > hidden_blue);
    // Behind the nearest surface it is not seen, in front of nothing neither.
    draw(renderer, &of, &options, (part[]){{back, 1, true}}, 1, &alone);
    draw(renderer, &of, &options, (part[]){{far, weight, false}, {back, 1, true}}, 2, &drawn);
    read_middle(&drawn, mean);
    assert_true(mean[0] == 0 && mean[1] > 0.999);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        if (alone.frame.depth[i] < INFINITY) continue;
        for (int c = 0; c < 4; c++) assert_true(drawn.frame.rgba[4 * i + (size_t)c] == 0);
        assert_true(drawn.frame.depth[i] == INFINITY && drawn.frame.coverage[i] == 0);
    }
    draw(renderer, &of, &options, NULL, 0, &alone);
    draw(renderer, &of, &options, (part[]){{front, 1, false}}, 1, &drawn);
    picture_expect_same(&alone, &drawn);
    options.opacity = 0.5;
    draw(renderer, &of, &options, NULL, 0, &alone);
    draw(renderer, &of, &options, (part[]){{front, 1, false}, {far, 0.5, false}}, 2, &drawn);
    picture_expect_same(&alone, &drawn);
    // Of transparent surfaces it takes part in each that it is near enough to.
    draw(renderer, &of, &options, (part[]){{back, 1, true}, {far, 1, true}}, 2, &alone);
    draw(renderer, &of, &options, (part[]){{back, 1, true}, {far, 0.5, true}, {far, 0.5, false}}, 3, &drawn);
    assert_true(cubes_largest_step(&alone, &drawn) <= 1);
}

/// With weights and sources that hide nothing, too, no order, number of threads or size of tiles changes a byte.
static void hold_invariance(scene_kind kind, const ewa_render_options *options, const char *what) {
    static const uint32_t threads[] = {1, 2, 4, 8}, tiles_px[] = {16, 32, 64, 128};
    picture drawn[2] = {picture_make(SIDE, SIDE), picture_make(SIDE, SIDE)};
    print_message("%s, %s\n", scene_name(kind), what);
    for (int turn = 0; turn < 4; turn++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[turn], NULL);
        OWNED(scene_free) scene of;
        assert_int_equal(scene_make(context, kind, POINTS, SIDE, SIDE, &of), EWA_OK);
        OWNED(cubes_free) cubes made = cubes_make(of.cloud, 3);
        part parts[2 * CUBES_MAX];
        uint32_t count = 0;
        for (uint32_t k = 0; k < made.count; k++) {
            const uint32_t i = turn % 2 ? made.count - 1 - k : k;
            const double weight = (i + 1.0) / (made.count + 1);
            parts[count++] = (part){made.part[i], weight, i % 3 != 1};
            if (i % 2) parts[count++] = (part){made.part[i], 1 - weight, i % 3 == 1};
        }
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        ewa_renderer_set_tile(renderer, tiles_px[turn]);
        draw(renderer, &of, options, parts, count, &drawn[turn > 0]);
        if (turn > 0) picture_expect_same(&drawn[0], &drawn[1]);
    }
    for (int i = 0; i < 2; i++) picture_free(&drawn[i]);
}

TEST(test_invariance) {
    WITH_DEFAULTS(ewa_render_options, options);
    for (scene_kind kind = 0; kind < SCENE_COUNT; kind++) hold_invariance(kind, &options, "as it is");
    options.kernel = EWA_KERNEL_RAYCAST;
    hold_invariance(SCENE_ELLIPSES, &options, "raycast");
    options.kernel = EWA_KERNEL_AFFINE;
    hold_invariance(SCENE_ELLIPSES, &options, "affine");
    options.kernel = EWA_KERNEL_PERSPECTIVE;
    options.opacity = 0.5;
    hold_invariance(SCENE_TORUS, &options, "transparent");
    options.layers = 3;
    hold_invariance(SCENE_ELLIPSES, &options, "three layers");
}

TEST_LOGGED(test_refusals, 0) {
    scene of = sheet_scene();
    OWNED(ewa_surfels_destroy) ewa_surfels *sheet = make_sheet(context, 4, 255, 0, 1);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render_add_weighted(renderer, sheet, 1), EWA_ERROR_ARGUMENT);
    OWNED(picture_free) picture drawn = picture_make(SIDE, SIDE);
    assert_int_equal(ewa_render_begin(renderer, &of.camera, NULL, &drawn.frame), EWA_OK);
    static const double wrong[] = {0, -1, 1.0000001, INFINITY, NAN};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(ewa_render_add_weighted(renderer, sheet, wrong[i]), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_add_weighted(renderer, sheet, 1e-300), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
