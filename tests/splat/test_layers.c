// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transparent surfaces (docs/math.md section 8): known answers, the fast pipeline against the reference,
// order.
#include "tests/splat/picture.h"

#include <math.h>
#include <string.h>

enum { POINTS = 1600, SIDE = 96 };

/// Gives a cloud 8-bit colours with random alpha from `minimum` on; `step` > 1 also leaves every step-th
/// point clear.
static void add_alpha(ewa_cloud *cloud, int minimum, uint64_t step) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    uint8_t *rgba = NULL, *copy = malloc(4 * count);
    assert_non_null(copy);
    check_random random = {7};
    const double scale = color && color->type == EWA_F32 ? 255 : 1;
    for (uint64_t i = 0; i < count; i++) {
        double rgb[4] = {128, 128, 128, 255};
        if (color) ewa_attribute_read_f64(color, i, 1, rgb);
        for (int c = 0; c < 3; c++) copy[4 * i + (size_t)c] = (uint8_t)(scale * rgb[c]);
        copy[4 * i + 3] = i % step == 1 ? 0 : (uint8_t)check_uniform(&random, minimum, 255.99);
    }
    if (color) ewa_cloud_remove(cloud, EWA_COLOR);
    assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 4, (void **)&rgba), EWA_OK);
    memcpy(rgba, copy, 4 * count);
    free(copy);
}

static void hold(scene_kind kind, const ewa_render_options *options, int minimum_alpha, bool orthographic,
                 const char *what) {
    ewa_context *context = check_context(0, NULL);
    scene of = picture_measured_scene(context, kind, POINTS, NULL);
    if (minimum_alpha < 255) add_alpha(of.cloud, minimum_alpha, 9);
    char name[96];
    snprintf(name, sizeof name, "%s, %s", scene_name(kind), what);
    picture_hold(&of, options, orthographic, name);
    scene_free(&of);
    ewa_context_destroy(&context);
}

TEST(test_pipeline_holds) {
    static const scene_kind kinds[] = {SCENE_SPHERE, SCENE_TORUS, SCENE_ELLIPSES, SCENE_NEAR};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        WITH_DEFAULTS(ewa_render_options, o);
        hold(kinds[i], &o, 0, false, "alpha");
        o.opacity = 0.4;
        hold(kinds[i], &o, 255, false, "opacity 0.4");
        hold(kinds[i], &o, 50, false, "alpha and opacity");
        o.layers = 2;
        hold(kinds[i], &o, 0, false, "two layers");
        o.layers = 3, o.shading = EWA_SHADING_NONE, o.edge_antialiasing = false;
        hold(kinds[i], &o, 255, false, "three layers, no edges, no shading");
        o.layers = 1;
        hold(kinds[i], &o, 0, false, "one layer");
        ewa_render_options_init(&o, sizeof o);
        o.opacity = 0.4, o.layers = 3, o.kernel = EWA_KERNEL_RAYCAST;
        hold(kinds[i], &o, 50, false, "raycast, three layers");
    }
    WITH_DEFAULTS(ewa_render_options, o);
    o.opacity = 0.3;
    hold(SCENE_TORUS, &o, 30, true, "orthographic");
    hold(SCENE_ELLIPSES, &o, 255, true, "orthographic");
}

/// Sheets of discs in front of a camera, each a quarter farther than the one before, with a colour each; all end at
/// 45 degrees to the sides.
static ewa_cloud *make_sheets(ewa_context *context, uint32_t sheet_count, const uint8_t rgba[][4]) {
    enum { ROW = 60 };
    ewa_cloud *cloud = check_cloud_of(context, (uint64_t)sheet_count * ROW * ROW);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    uint8_t *color = check_add(cloud, EWA_COLOR, EWA_U8, 4);
    size_t i = 0;
    for (uint32_t k = 0; k < sheet_count; k++) {
        const float z = 2 * powf(1.25f, (float)k), spacing = 2 * z / ROW;
        for (int y = 0; y < ROW; y++)
            for (int x = 0; x < ROW; x++, i++) {
                position[3 * i] = ((float)x + 0.5f - ROW / 2) * spacing;
                position[3 * i + 1] = ((float)y + 0.5f - ROW / 2) * spacing;
                position[3 * i + 2] = z;
                normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = -1;
                radius[i] = 1.5f * spacing; // so large that coverage hardly ripples
                memcpy(&color[4 * i], rgba[k], 4);
            }
    }
    return cloud;
}

static ewa_camera sheet_camera(void) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
    return camera;
}

/// Colours over each other in front-to-back order, whatever the number of layers allows; a layer's own alpha
/// is that of its surfels times the opacity.
TEST_ON(test_sheets_over_each_other, 0) {
    static const uint8_t rgba[4][4] = {
        {255, 0, 0, 51}, {0, 255, 0, 102}, {0, 0, 255, 204}, {255, 255, 255, 255}};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_sheets(context, 4, rgba);
    const ewa_camera camera = sheet_camera();
    for (uint32_t layers = 1; layers <= 6; layers++) {
        WITH_DEFAULTS(ewa_render_options, o);
        o.shading = EWA_SHADING_NONE;
        o.layers = layers == 6 ? EWA_LAYERS_EXACT : layers;
        o.opacity = 0.5;
        double expected[4] = {0}, through = 1;
        for (uint32_t k = 0; k < 4 && layers > 1; k++) {
            double color[3] = {0}, weight = 0, sheets = 0;
            const bool merged = layers < 5 && k + 1 == layers; // the last layer is all that is left
            for (uint32_t j = k; j < (merged ? 4 : k + 1); j++) {
                const double a = rgba[j][3] / 255.0;
                for (int c = 0; c < 3; c++) color[c] += a * (rgba[j][c] / 255.0);
                weight += a, sheets += 1;
            }
            const double alpha = 1 - pow(1 - o.opacity * weight / sheets, sheets);
            for (int c = 0; c < 3; c++) expected[c] += through * alpha * color[c] / weight;
            through *= 1 - alpha;
            if (merged) break;
        }
        expected[3] = 1 - through;
        if (layers == 1) expected[0] = 1, expected[3] = 1; // opaque red
        OWNED(picture_free) picture made = picture_draw(context, cloud, &camera, NULL, &o);
        // The sums of kernels ripple by some percent, and with them the shares in a merged layer.
        const double allowed = layers > 1 && layers < 4 ? 0.03 : 1e-4;
        for (int y = 20; y < SIDE - 20; y++)
            for (int x = 20; x < SIDE - 20; x++)
                for (int c = 0; c < 4; c++)
                    assert_true(fabs((double)made.frame.rgba[4 * (y * SIDE + x) + c] - expected[c]) <
                                allowed);
    }
}

/// Many sheets end at one place, where each covers the same part of a pixel: the background shows no more than through
/// all of them, however few are told apart, and the last layer has the mean colour of what is left.
TEST_ON(test_last_edge_layer_takes_all, 0) {
    enum { SHEETS = 30, RED = 3 };
    uint8_t rgba[SHEETS][4] = {{255, 0, 0, 255}, {255, 0, 0, 255}, {255, 0, 0, 255}};
    for (int k = RED; k < SHEETS; k++) rgba[k][2] = rgba[k][3] = 255;
    OWNED(ewa_cloud_destroy) ewa_cloud *one = make_sheets(context, 1, rgba), *all = make_sheets(context, SHEETS, rgba);
    ewa_camera camera = check_camera(SIDE, SIDE);
    assert_int_equal(ewa_camera_set_fov(&camera, 100), EWA_OK);
    int partly_count = 0;
    for (uint32_t layers = 1; layers <= EWA_MAX_EDGE_LAYERS; layers++) {
        WITH_DEFAULTS(ewa_render_options, o);
        o.shading = EWA_SHADING_NONE, o.edge_layers = layers;
        OWNED(picture_free) picture alone = picture_draw(context, one, &camera, NULL, &o);
        OWNED(picture_free) picture made = picture_draw(context, all, &camera, NULL, &o);
        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
            const double a = (double)alone.frame.rgba[4 * i + 3], k = (double)alone.frame.coverage[i];
            const float *pixel = made.frame.rgba + 4 * i;
            if (!(a > 1e-3 && a < 0.9)) continue;
            const double left = pow(1 - a, layers - 1), rest = SHEETS + 1 - layers;
            const double last = layers > 1 ? fmin(1, a * rest) : a;
            double through = 1 - last;
            for (int n = 1; n < SHEETS && layers > 1; n++) through *= 1 - last * fmin(fmax(4 * (k * rest - n) - 2, 0), 1);
            const double red = layers > RED ? 1 - pow(1 - a, RED)
                                            : 1 - left + left * (1 - through) * (RED + 1 - layers) / rest;
            assert_true(fabs((double)pixel[3] - (1 - left * through)) < 0.01);
            if (layers > 1) assert_true((double)pixel[3] > 1 - pow(1 - a, SHEETS) - 1e-3);
            if (layers > 1) assert_true(fabs((double)pixel[0] - red) < 0.02);
            partly_count += layers == EWA_MAX_EDGE_LAYERS;
        }
    }
    assert_true(partly_count > 100);
}

/// A transparent sphere's middle has even opacity: 1 - (1 - a)^2.
TEST_ON(test_sphere_is_even, 0) {
    OWNED(scene_free) scene of = picture_measured_scene(context, SCENE_SPHERE, 8000, NULL);
    WITH_DEFAULTS(ewa_render_options, o);
    o.opacity = 0.3;
    OWNED(picture_free) picture made = picture_draw(context, of.cloud, &of.camera, NULL, &o);
    const double expected = 1 - 0.7 * 0.7;
    double sum2 = 0, minimum = 1, maximum = 0;
    int count = 0;
    for (int y = PICTURE_SIDE_PX / 2 - 30; y < PICTURE_SIDE_PX / 2 + 30; y++)
        for (int x = PICTURE_SIDE_PX / 2 - 30; x < PICTURE_SIDE_PX / 2 + 30; x++, count++) {
            const double alpha = (double)made.frame.rgba[4 * (y * PICTURE_SIDE_PX + x) + 3];
            minimum = fmin(minimum, alpha), maximum = fmax(maximum, alpha);
            sum2 += (alpha - expected) * (alpha - expected);
        }
    printf("variance of alpha over a transparent sphere's middle: %.2g, from %.4f to %.4f\n", sum2 / count,
           minimum, maximum);
    // A few pixels of random points are not quite covered.
    assert_true(sum2 / count < 1e-5 && maximum < expected + 1e-4);
}

static void assert_same(const picture *a, const picture *b) {
    const size_t pixels = (size_t)a->width_px * a->height_px;
    assert_memory_equal(a->frame.rgba8, b->frame.rgba8, 4 * pixels);
    assert_memory_equal(a->frame.rgba, b->frame.rgba, 16 * pixels);
    assert_memory_equal(a->frame.depth, b->frame.depth, 4 * pixels);
}

/// The same bytes from every instruction set, any number of threads, and the points in reverse.
TEST_ON(test_same_bytes, 0) {
    static const uint32_t threads[] = {1, 2, 7}, masks[] = {UINT32_MAX, EWA_CPU_AVX2, 0};
    OWNED(scene_free) scene of = picture_measured_scene(context, SCENE_TORUS, POINTS, NULL);
    add_alpha(of.cloud, 20, 5);
    WITH_DEFAULTS(ewa_render_options, o);
    o.opacity = 0.7;
    OWNED(picture_free) picture first = picture_draw(context, of.cloud, &of.camera, NULL, &o);
    for (int i = 0; i < 9; i++) {
        OWNED(ewa_context_destroy) ewa_context *other = check_context_of(threads[i % 3], masks[i / 3]);
        const uint64_t count = ewa_cloud_point_count(of.cloud);
        OWNED(ewa_cloud_destroy) ewa_cloud *reversed = check_cloud_of(other, count);
        for (uint32_t a = 0; a < ewa_cloud_attribute_count(of.cloud); a++) {
            const ewa_attribute *from = ewa_cloud_attribute_at(of.cloud, a);
            char *to = NULL;
            assert_int_equal(ewa_cloud_add(reversed, from->name, from->type, from->component_count, (void **)&to), EWA_OK);
            const size_t bytes = from->component_count * ewa_type_bytes(from->type);
            for (uint64_t k = 0; k < count; k++)
                memcpy(to + k * bytes, (const char *)from->data + (count - 1 - k) * from->stride_bytes,
                       bytes);
        }
        OWNED(picture_free) picture made = picture_draw(other, reversed, &of.camera, NULL, &o);
        assert_same(&first, &made);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
