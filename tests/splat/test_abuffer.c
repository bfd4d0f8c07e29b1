// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The paper's A-buffer: known answers, what the order of the points does to it, and that it agrees with the
// exact layers where it has room.
#include "splat/abuffer.h"
#include "tests/splat/picture.h"

#include <math.h>
#include <string.h>

enum { SIDE = 8, MIDDLE = 4 * (SIDE / 2 * SIDE + SIDE / 2), FRAGMENTS = 2 };

/// A disc across the view axis.
typedef struct disc {
    double z;
    float color[3];
} disc;

static const disc red = {2, {1, 0, 0}}, green = {3, {0, 1, 0}}, blue = {5, {0, 0, 1}};

static ewa_cloud *make_discs(ewa_context *context, const disc *discs, uint64_t count) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    float *color = check_add(cloud, EWA_COLOR, EWA_F32, 3);
    for (uint64_t i = 0; i < count; i++) {
        position[3 * i] = position[3 * i + 1] = 0, position[3 * i + 2] = (float)discs[i].z;
        normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = -1;
        radius[i] = 0.4f;
        memcpy(&color[3 * i], discs[i].color, sizeof discs[i].color);
    }
    return cloud;
}

static ewa_camera disc_camera(void) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.cx_px = camera.cy_px = SIDE / 2;
    camera.fx_px = camera.fy_px = 1000;
    return camera;
}

/// The middle pixel of discs of opacity 0.5 whose coverage is whole.
static void draw_discs(const disc *discs, uint64_t count, uint32_t limit, abuffer_shader *shader,
                       void *shader_data, double rgba[4]) {
    ewa_context *context = check_context(1, NULL);
    ewa_cloud *cloud = make_discs(context, discs, count);
    const ewa_camera camera = disc_camera();
    WITH_DEFAULTS(ewa_render_options, options);
    options.opacity = 0.5;
    options.edge_antialiasing = false;
    float plane[4 * SIDE * SIDE];
    assert_int_equal(abuffer_render(cloud, 1, &camera, &options, limit, shader, shader_data, plane), EWA_OK);
    for (int c = 0; c < 4; c++) rgba[c] = (double)plane[MIDDLE + c];
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
}

static void assert_rgba(const double found[4], double r, double g, double b, double a) {
    const double wanted[4] = {r, g, b, a};
    for (int c = 0; c < 4; c++) assert_true(fabs(found[c] - wanted[c]) < 1e-6);
}

/// With room for all, every order gives equation 12 from front to back.
TEST(test_room_for_all) {
    const disc orders[][3] = {{red, green, blue}, {blue, green, red}, {green, blue, red}, {red, blue, green}};
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        double rgba[4];
        draw_discs(orders[i], 3, 3, NULL, NULL, rgba);
        assert_rgba(rgba, 0.5, 0.25, 0.125, 0.875);
    }
}

/// With too few fragments the points' order decides: what was merged cannot be parted any more.
TEST(test_order_decides) {
    const disc in_order[3] = {red, green, blue}, out_of_order[3] = {red, blue, green};
    double rgba[4];
    draw_discs(in_order, 3, 1, NULL, NULL, rgba);
    assert_rgba(rgba, 0.5, 0.25, 0.125, 0.875);
    draw_discs(out_of_order, 3, 1, NULL, NULL, rgba); // red over blue is one by the time green comes
    assert_rgba(rgba, 0.5, 0.125, 0.25, 0.875);
    // Of three, red and green are nearest in depth and adjacent: nothing is lost.
    draw_discs(out_of_order, 3, 2, NULL, NULL, rgba);
    assert_rgba(rgba, 0.5, 0.25, 0.125, 0.875);
    const disc four[4] = {{2, {1, 0, 0}}, {2.9, {0, 0, 1}}, {5, {0, 0, 0}}, {2.45, {0, 1, 0}}};
    draw_discs(four, 4, 2, NULL, NULL, rgba);
    assert_rgba(rgba, 0.5, 0.125, 0.25, 0.9375);
}

static ewa_vec3 square(const void *data, ewa_vec3 color, ewa_vec3 normal_world, double x_px, double y_px) {
    int *calls = *(int *const *)data;
    if (x_px == SIDE / 2 + 0.5 && y_px == SIDE / 2 + 0.5) (*calls)++;
    assert_true(fabs(normal_world.z + 1) < 1e-12);
    return vec3_make(color.x * color.x, color.y * color.y, color.z * color.z);
}

/// Contributions of one surface are averaged and then shaded; fragments are shaded, once each, and then
/// merged.
TEST(test_shading) {
    int calls = 0, *const counter = &calls;
    double rgba[4];
    const disc one_surface[2] = {{2, {0.2f, 0, 0}}, {2, {0.6f, 0, 0}}};
    draw_discs(one_surface, 2, 1, square, (void *)&counter, rgba);
    assert_rgba(rgba, 0.5 * 0.4 * 0.4, 0, 0, 0.5);
    assert_int_equal(calls, 1);
    const disc two[2] = {{2, {0.2f, 0, 0}}, {3, {0.6f, 0, 0}}};
    calls = 0;
    draw_discs(two, 2, 1, square, (void *)&counter, rgba);
    assert_rgba(rgba, 0.5 * 0.2 * 0.2 + 0.25 * 0.6 * 0.6, 0, 0, 0.75);
    assert_int_equal(calls, 2);
}

/// In the middle of a sphere, front and back, as many fragments as surfaces are exact layers.
TEST_ON(test_exact_on_separate_surfaces, 0) {
    OWNED(scene_free) scene of = picture_measured_scene(context, SCENE_SPHERE, 8000, NULL);
    WITH_DEFAULTS(ewa_render_options, options);
    options.opacity = 0.5;
    options.shading = EWA_SHADING_NONE;
    OWNED(picture_free) picture exact = picture_of_scene(&of, NULL, &options);
    OWNED(check_free) float *greedy = malloc((size_t)PICTURE_SIDE_PX * PICTURE_SIDE_PX * 4 * sizeof *greedy);
    assert_non_null(greedy);
    assert_int_equal(
        abuffer_render(of.cloud, of.unit_coverage, &of.camera, &options, FRAGMENTS, NULL, NULL, greedy),
        EWA_OK);
    uint64_t different = 0, compared = 0;
    for (int y = 0; y < PICTURE_SIDE_PX; y++)
        for (int x = 0; x < PICTURE_SIDE_PX; x++) {
            if (hypot(x - PICTURE_SIDE_PX / 2, y - PICTURE_SIDE_PX / 2) > PICTURE_SIDE_PX / 5) continue;
            const size_t at = 4 * ((size_t)y * PICTURE_SIDE_PX + (size_t)x);
            bool same = true;
            for (size_t c = 0; c < 4; c++) same &= fabsf(greedy[at + c] - exact.frame.rgba[at + c]) < 1e-5f;
            different += !same;
            compared++;
        }
    printf("%llu of %llu pixels differ\n", (unsigned long long)different, (unsigned long long)compared);
    assert_true(compared > 3000 && different == 0);
}

TEST_ON(test_arguments, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_discs(context, &red, 1);
    ewa_camera camera = disc_camera();
    WITH_DEFAULTS(ewa_render_options, options);
    float plane[4 * SIDE * SIDE];
    assert_int_equal(abuffer_render(cloud, 1, &camera, &options, 0, NULL, NULL, plane), EWA_ERROR_ARGUMENT);
    assert_int_equal(abuffer_render(cloud, 1, NULL, &options, 1, NULL, NULL, plane), EWA_ERROR_ARGUMENT);
    camera.fx_px = 0;
    assert_int_equal(abuffer_render(cloud, 1, &camera, &options, 1, NULL, NULL, plane), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
