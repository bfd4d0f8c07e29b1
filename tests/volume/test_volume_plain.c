// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of volumes and its reference against pictures that share nothing with them (plain.c): slanted
// grids, wide cameras off the axis, coloured lights, gradient ramps, filters.
#include "check.h"
#include "reference/volume.h"
#include "volume/plain.h"
#include "volume/scene.h"

#include <math.h>

enum { WIDTH = 30, HEIGHT = 26, PIXELS = WIDTH * HEIGHT };

static const uint32_t DIMS[3] = {9, 8, 10};

/// Smooth bumps and steps, a hole without numbers; a slanted grid of unequal steps.
static ewa_volume make_volume(ewa_context *context, bool slanted) {
    ewa_volume volume;
    assert_int_equal(ewa_volume_create(context, DIMS, EWA_F32, &volume), EWA_OK);
    float *to = volume.voxels;
    for (int n = 0; n < 9 * 8 * 10; n++) {
        const double x = n % 9, y = n / 9 % 8, z = n / 72;
        to[n] = (float)(1 + sin(0.9 * x + 0.3) * cos(0.7 * y) + (z > 5 ? 0.8 : 0) * sin(0.5 * x * y));
    }
    to[72 * 4 + 9 * 3 + 4] = NAN;
    static const double slant[12] = {0.9, 0.25, -0.1, -4.1, -0.15, 1.3, 0.2, -3.3, 0.1, 0.05, 0.8, -4.4};
    if (slanted) memcpy(volume.index_to_world, slant, sizeof slant);
    return volume;
}

typedef enum look { COLORED, WHITE, RAMP } colors;

static ewa_transfer make_transfer(colors look) {
    ewa_transfer transfer = {.point_count = 4, .unit_length_world = 1.7};
    transfer.points[0] = (ewa_transfer_point){-0.4, {0.9f, 0.1f, 0.2f}, 0};
    transfer.points[1] = (ewa_transfer_point){0.6, {0.2f, 0.8f, 0.4f}, 0.3f};
    transfer.points[2] = (ewa_transfer_point){1.4, {0.3f, 0.2f, 0.9f}, 0.9f};
    transfer.points[3] = (ewa_transfer_point){2.5, {0.9f, 0.9f, 0.3f}, 1.6f};
    if (look == RAMP) transfer.gradient_low = 0.15, transfer.gradient_high = 0.9;
    for (int i = 0; i < 12 && look == WHITE; i++) transfer.points[i / 3].color[i % 3] = 1;
    return transfer;
}

/// Views 0 to 2: from without, wide; from within; orthographic.
static ewa_camera make_camera(int view) {
    static const double eyes[3][3] = {{7, 5, 11}, {0.7, -0.4, 1.1}, {-9, 6, 8}};
    static const double targets[3][3] = {{0.5, -0.3, 0}, {2, -1.5, -3}, {0, 0, 0}}, up[3] = {0.1, 1, 0.2};
    ewa_camera camera = check_camera(WIDTH, HEIGHT);
    assert_int_equal(ewa_camera_set_fov(&camera, view == 1 ? 95 : 75), EWA_OK);
    if (view == 2) assert_int_equal(ewa_camera_set_ortho(&camera, 14), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eyes[view], targets[view], up), EWA_OK);
    camera.fy_px *= 1.2;
    camera.cx_px += 3.5, camera.cy_px -= 2.25;
    for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= 2; // its own units
    if (view == 2) camera.fx_px /= 2, camera.fy_px /= 2;
    return camera;
}

static ewa_volume_options make_options(void) {
    WITH_DEFAULTS(ewa_volume_options, options);
    options.method = EWA_VOLUME_SPLATS;
    options.minimum_transmittance = 0;
    options.prefilter_px = 0;
    return options;
}

static void light_up(ewa_volume_options *options) {
    options->shading = EWA_SHADING_PHONG;
    options->light_count = 3;
    options->lights[0] = (ewa_light){{1, 2, 0.5}, {1.4f, 0.3f, 0.1f}};
    options->lights[1] = (ewa_light){{-2, 0.3, 1}, {0.1f, 0.2f, 1.7f}};
    options->lights[2] = (ewa_light){{0, 0, 0}, {0.2f, 0.6f, 0.2f}};
    options->material.ambient = 0.22f, options->material.diffuse = 0.6f;
    options->material.specular = 1.1f, options->material.shininess = 9;
}

/// The largest differences from the plain picture: of the reference, and of the renderer.
static void compare(const ewa_volume *volume, const ewa_transfer *transfer, const ewa_camera *camera,
                    const ewa_volume_options *options, double maximum[2]) {
    double *truth = malloc(PIXELS * 4 * sizeof *truth), *half = malloc(PIXELS * sizeof *half), sum = 0;
    float *rgba = malloc(PIXELS * 4 * sizeof *rgba), *depth = malloc(PIXELS * sizeof *depth);
    assert_true(truth && half && rgba && depth);
    plain_draw(volume, transfer, camera, options, truth, half);
    ewa_voxels *voxels = scene_voxels(volume, transfer);
    ewa_volume_renderer *renderer;
    assert_int_equal(ewa_volume_renderer_create(volume->context, &renderer), EWA_OK);
    const ewa_frame frame = {.rgba = rgba, .depth = depth};
    const double unit = 1.5 * 2 * options->depth_unit; // of a camera whose units are half of the world's
    for (int fast = 0; fast < 2; fast++) {
        if (fast)
            assert_int_equal(ewa_volume_render(renderer, voxels, camera, options, &frame, NULL), EWA_OK);
        else
            assert_int_equal(ewa_volume_render_reference(volume, transfer, camera, options, &frame), EWA_OK);
        int apart = 0;
        for (int i = 0; i < 4 * PIXELS; i++)
            maximum[fast] = fmax(maximum[fast], fabs((double)rgba[i] - truth[i]));
        for (int i = 0; i < PIXELS; i++)
            apart += !(isinf(half[i]) ? isinf(depth[i]) : fabs((double)depth[i] - half[i]) < unit);
        // Where half of the light is gone between two voxels, or in one of two as far away, rounding decides.
        if (apart > (fast ? 20 : 3)) fail_msg("fast %d: %d depths are others", fast, apart);
    }
    for (int i = 3; i < 4 * PIXELS; i += 4) sum += truth[i];
    assert_true(sum > 0.1 * PIXELS);
    ewa_volume_renderer_destroy(&renderer);
    ewa_voxels_destroy(&voxels);
    free(truth);
    free(half);
    free(rgba);
    free(depth);
}

/// All views of a grid; says what was measured. Where colours differ, single precision may put a voxel at the
/// edge of a depth unit into the other one.
static void hold(const char *what, bool slanted, colors look, const ewa_volume_options *options,
                 double reference, double renderer) {
    ewa_context *context = check_context(2, NULL);
    ewa_volume volume = make_volume(context, slanted);
    const ewa_transfer transfer = make_transfer(look);
    double maximum[2] = {0, 0};
    for (int view = 0; view < 3; view++) {
        const ewa_camera camera = make_camera(view);
        compare(&volume, &transfer, &camera, options, maximum);
    }
    print_message("%s: reference %.2g, renderer %.2g\n", what, maximum[0], maximum[1]);
    assert_true(maximum[0] < reference);
    assert_true(maximum[1] < renderer);
    ewa_volume_free(&volume);
    ewa_context_destroy(&context);
}

TEST(test_bare) {
    ewa_volume_options options = make_options();
    hold("cubes", false, WHITE, &options, 2e-5, 1e-4);
    hold("cubes, coloured", false, COLORED, &options, 5e-5, 6e-3);
    options.sigma = 0.8, options.cutoff = 2.5, options.depth_unit = 2.5, options.density_scale = 0.4;
    options.background[0] = 0.3f, options.background[2] = 0.7f, options.background[3] = 0.6f;
    hold("other options", false, COLORED, &options, 3e-4, 6e-3); // a rim may pass through a pixel
}

TEST(test_slanted) {
    const ewa_volume_options options = make_options();
    // The renderer takes the length of a standard deviation in the middle, not along each ray.
    hold("slanted", true, WHITE, &options, 1e-4, 0.02);
    hold("slanted, coloured", true, COLORED, &options, 1e-4, 0.03);
}

TEST(test_ramp) {
    const ewa_volume_options options = make_options();
    hold("gradient ramp", false, RAMP, &options, 5e-5, 6e-3);
    hold("gradient ramp, slanted", true, RAMP, &options, 1e-4, 0.03);
}

TEST(test_lit) {
    ewa_volume_options options = make_options();
    light_up(&options);
    hold("coloured lights", false, COLORED, &options, 5e-5, 0.015);
    options.shading = EWA_SHADING_LAMBERT;
    hold("matt", false, COLORED, &options, 5e-5, 6e-3);
    options.shading = EWA_SHADING_PHONG;
    options.light_count = 0;
    hold("headlight", false, RAMP, &options, 5e-5, 6e-3);
}

TEST(test_filtered) {
    ewa_volume_options options = make_options();
    options.prefilter_px = 0.35;
    hold("filtered", false, WHITE, &options, 2e-5, 1e-4);
    options.prefilter_px = 1.3;
    hold("blurred", false, WHITE, &options, 2e-5, 2e-4);
    hold("blurred, slanted", true, COLORED, &options, 1e-4, 0.03);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
