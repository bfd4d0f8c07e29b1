// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes from within: voxels at the eye, scales of the world and of the camera.
#include "check.h"
#include "image_difference.h"
#include "volume/march.h"
#include "volume/near.h"
#include "volume/scene.h"

#include <math.h>

static const double UNIT[3] = {1, 1, 1};

static ewa_volume_options defaults(void) {
    WITH_DEFAULTS(ewa_volume_options, options);
    options.minimum_transmittance = 0;
    return options;
}

/// A perspective camera at a place that looks in a direction; its principal point is not the middle.
static ewa_camera camera_at(uint32_t width_px, uint32_t height_px, const double eye[3], const double ahead[3],
                            double fov_deg) {
    static const double up[3] = {0, 1, 0};
    const double target[3] = {eye[0] + ahead[0], eye[1] + ahead[1], eye[2] + ahead[2]};
    ewa_camera camera = check_camera(width_px, height_px);
    assert_int_equal(ewa_camera_set_fov(&camera, fov_deg), EWA_OK);
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    camera.cx_px += 3.25, camera.cy_px -= 1.5;
    return camera;
}

static double optical_depth(const ewa_image *image, size_t pixel) {
    return -log(1 - (double)image->pixels[4 * pixel + 3]);
}

/// What begins at the eye is all there: rays marched from it through the sum of all kernels.
TEST_ON(test_marched, 2) {
    static const uint32_t dims[3] = {15, 14, 16};
    static const double eyes[][3] = {
        {0, 0, 0}, {1.3, -2.2, 0.4}, {0.5, 0.5, 0.5}, {-4.1, 3.3, -7.6}, {0, 0, 9.5}};
    static const double aheads[][3] = {{0, 0, -1}, {0.6, 0.5, 1}, {1, 0.1, 0.2}};
    enum { WIDTH = 16, HEIGHT = 12 };
    const double half = 6;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_vessels, &half);
    for (int i = 0; i < 15 * 14 * 16; i++) ((float *)volume.voxels)[i] += 0.3f; // fog as well
    const ewa_transfer transfer = scene_linear(1, 1, 1, 0.15f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    const march_scene scene = {.volume = &volume, .extinction = (double)0.15f, .sigma = 0.6, .step = 0.1};
    double largest = 0, maximum[2] = {0, 0};
    for (int view = 0; view < 15; view++) {
        const ewa_camera camera =
            camera_at(WIDTH, HEIGHT, eyes[view / 3], aheads[view % 3], view % 2 ? 50 : 110);
        ewa_volume_options options = defaults();
        options.method = EWA_VOLUME_SPLATS;
        options.prefilter_px = 0, options.cutoff = 4;
        ewa_image images[2] = {scene_draw(context, voxels, &camera, &options),
                               scene_draw_reference(&volume, &transfer, &camera, &options)};
        for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
            const double truth =
                march_depth(&scene, &camera, (double)(i % WIDTH) + 0.5, (double)(i / WIDTH) + 0.5);
            largest = fmax(largest, truth);
            for (int r = 0; r < 2; r++)
                maximum[r] = fmax(maximum[r], fabs(optical_depth(&images[r], i) - truth));
        }
        ewa_image_free(&images[0]);
        ewa_image_free(&images[1]);
    }
    print_message("depths up to %g; errors %g, reference %g\n", largest, maximum[0], maximum[1]);
    assert_true(largest > 1);
    assert_true(maximum[0] < 5e-4 * largest && maximum[1] < 5e-4 * largest);
}

/// The largest difference from the reference of pictures from within.
static double error_of(const double spacing[3], ewa_volume_options options, double fov_deg, bool surface) {
    static const uint32_t dims[3] = {21, 18, 23};
    static const double aheads[][3] = {{0.7, 0.4, -1}, {-0.2, -0.9, 0.3}, {0, 0, 1}};
    enum { WIDTH = 47, HEIGHT = 37 };
    const double half = 8;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, spacing, scene_vessels, &half);
    for (int i = 0; i < 21 * 18 * 23; i++) ((float *)volume.voxels)[i] += 0.05f * (float)(i % 3);
    const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.7f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    OWNED(check_free)
    float *depth = malloc(WIDTH * HEIGHT * sizeof *depth), *rgba = calloc(WIDTH * HEIGHT * 4, sizeof *rgba);
    assert_true(depth && rgba);
    for (int i = 0; i < WIDTH * HEIGHT; i++) depth[i] = 0.5f + 0.03f * (float)(i % WIDTH);
    if (surface) options.surface_depth = depth, options.surface_rgba = rgba;
    double maximum = 0, sum = 0;
    for (int view = 0; view < 6; view++) {
        const double eye[3] = {2.3 * view - 6.1, 3.7 - 1.1 * view, 0.9 * view - 2};
        const ewa_camera camera = camera_at(WIDTH, HEIGHT, eye, aheads[view % 3], fov_deg);
        OWNED(ewa_image_free) ewa_image fast = scene_draw(context, voxels, &camera, &options);
        OWNED(ewa_image_free) ewa_image slow = scene_draw_reference(&volume, &transfer, &camera, &options);
        const image_difference difference = image_compare(&fast, &slow, 0);
        maximum = fmax(maximum, difference.maximum);
        for (int i = 3; i < 4 * WIDTH * HEIGHT; i += 4) sum += (double)slow.pixels[i];
    }
    assert_true(sum > 1000);
    return maximum;
}

TEST(test_equals_reference) {
    static const double oblong[3] = {0.6, 1.7, 1};
    ewa_volume_options options = defaults();
    options.method = EWA_VOLUME_SPLATS;
    const double plain = error_of(UNIT, options, 60, false), wide = error_of(UNIT, options, 130, false);
    const double flat = error_of(oblong, options, 60, false), behind = error_of(UNIT, options, 60, true);
    options.depth_unit = 2;
    const double thick = error_of(UNIT, options, 60, false);
    options.depth_unit = 1, options.shading = EWA_SHADING_PHONG;
    const double lit = error_of(UNIT, options, 60, false);
    print_message("%g, wide %g, oblong %g, surface %g, depth unit %g, lit %g\n", plain, wide, flat, behind,
                  thick, lit);
    assert_true(plain < 1e-3 && wide < 1e-3 && thick < 1e-3);
    // The reference takes the length of oblong voxels along each pixel's ray, and a surface's share exactly.
    assert_true(flat < 2e-2);
    assert_true(behind < 2e-2);
    assert_true(lit < 2e-2);
}

/// Moving through a volume changes pictures by little at a time: nothing comes or goes at once.
TEST_ON(test_moving, 2) {
    static const uint32_t dims[3] = {24, 24, 24};
    static const double ahead[3] = {0.1, 0.05, -1};
    enum { SIDE = 64, STEPS = 160 };
    const double sides[2] = {3, 11};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_checker, sides);
    ewa_transfer transfer = {.point_count = 2, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){0.75, {0.9f, 0.2f, 0.1f}, 0.1f};
    transfer.points[1] = (ewa_transfer_point){2.25, {0.2f, 0.9f, 0.6f}, 0.1f};
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    ewa_image before = {0};
    double maximum = 0, mean = 0;
    for (int step = 0; step < STEPS; step++) {
        const double eye[3] = {0.3, 0.2, 4 - 0.05 * step};
        const ewa_camera camera = camera_at(SIDE, SIDE, eye, ahead, 70);
        ewa_image image = scene_draw(context, voxels, &camera, NULL);
        if (before.pixels) {
            const image_difference difference = image_compare(&image, &before, 0);
            maximum = fmax(maximum, difference.rms);
            mean += difference.rms / (STEPS - 1);
            ewa_image_free(&before);
        }
        before = image;
    }
    ewa_image_free(&before);
    print_message("change from step to step: mean %g, at most %g\n", mean, maximum);
    assert_true(mean > 1e-4 && maximum < 2.5 * mean);
}

/// Within homogeneous fog, a plane at any distance shows through exp(-kappa d), however near it is.
TEST_ON(test_plane_in_fog, 2) {
    static const uint32_t dims[3] = {40, 40, 40};
    static const double eye[3] = {0.2, 0.1, 0.3}, ahead[3] = {0, 0, -1};
    enum { SIDE = 32 };
    const double kappa = 0.2;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(1, 1, 1, (float)kappa);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    ewa_camera camera = camera_at(SIDE, SIDE, eye, ahead, 20);
    float depth[SIDE * SIDE], rgba[4 * SIDE * SIDE] = {0};
    ewa_volume_options options = defaults();
    options.surface_depth = depth, options.surface_rgba = rgba;
    for (double d = 1.5; d < 15; d += 0.7) {
        for (int i = 0; i < SIDE * SIDE; i++) depth[i] = (float)d;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        const double through = 1 - (double)image.pixels[4 * (SIDE / 2 * SIDE + SIDE / 2) + 3];
        if (fabs(through - exp(-kappa * d)) > 0.01) fail_msg("%g: %g, not %g", d, through, exp(-kappa * d));
    }
}

/// The same bytes from any number of threads and any instruction set, and nothing to see through from within.
TEST(test_same_bytes) {
    static const uint32_t dims[3] = {30, 30, 30};
    static const double eye[3] = {3.2, -4.1, 2.2}, ahead[3] = {-0.4, 0.7, -1};
    enum { WIDTH = 150, HEIGHT = 90, FLOATS = 4 * WIDTH * HEIGHT };
    OWNED(check_free) float *first = NULL;
    for (int variant = 0; variant < 4; variant++) {
        OWNED(ewa_context_destroy)
        ewa_context *context = check_context_of(variant == 1 ? 3 : 1, variant == 2   ? EWA_CPU_AVX2
                                                                      : variant == 3 ? 0
                                                                                     : EWA_CPU_ALL);
        OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
        const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 9);
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        const ewa_camera camera = camera_at(WIDTH, HEIGHT, eye, ahead, 75);
        ewa_volume_options options = defaults();
        options.shading = EWA_SHADING_PHONG;
        options.minimum_transmittance = variant == 0 ? 1.0 / 512 : 0;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        for (int i = 3; i < FLOATS; i += 4) assert_true(image.pixels[i] > 1 - 1.0f / 511);
        if (variant > 1) assert_memory_equal(image.pixels, first, FLOATS * sizeof(float));
        if (variant == 1) {
            first = malloc(FLOATS * sizeof *first);
            assert_non_null(first);
            memcpy(first, image.pixels, FLOATS * sizeof *first);
        }
    }
}

/// The picture does not depend on the unit of the world, nor on the camera's: scaled by a power of two, every
/// byte is the same, and depths are scaled.
TEST(test_scales) {
    static const uint32_t dims[3] = {19, 22, 17};
    static const double aheads[2][3] = {{0.4, 0.3, -1}, {0, 0.2, 1}};
    static const double scales[] = {1, 0x1p-46, 0x1p43, 0x1p-100, 0x1p100, 0x1p-400, 0x1p400};
    enum { WIDTH = 40, HEIGHT = 34, PIXELS = WIDTH * HEIGHT };
    const double half = 8;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(check_free)
    float *first = malloc(3 * 4 * PIXELS * sizeof *first), *first_depth = malloc(3 * PIXELS * sizeof *first);
    OWNED(check_free) float *pixels = malloc(4 * PIXELS * sizeof *pixels), *depth = malloc(PIXELS * sizeof *depth);
    assert_true(first && first_depth && pixels && depth);
    for (size_t n = 0; n < 2 * sizeof scales / sizeof scales[0]; n++) {
        const double world = scales[n / 2], of_camera = n % 2 ? 0x1p-30 : 1, place = world * of_camera;
        OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_vessels, &half);
        for (int i = 0; i < 12; i++) volume.index_to_world[i] *= world;
        ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.7f);
        transfer.unit_length_world = world;
        transfer.gradient_low = 0.1 / world, transfer.gradient_high = 0.6 / world;
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer;
        assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
        for (int view = 0; view < 3; view++) { // from without, from within, orthographic
            const double eye[3] = {view == 1 ? 2 : -16, view == 1 ? 1 : -12, view == 1 ? 0.5 : 40};
            ewa_camera camera = camera_at(WIDTH, HEIGHT, eye, aheads[view % 2], 40);
            if (view == 2) assert_int_equal(ewa_camera_set_ortho(&camera, 25), EWA_OK);
            if (view == 2) camera.fx_px /= place, camera.fy_px /= place;
            for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= i % 4 == 3 ? place : of_camera;
            ewa_volume_options options = defaults();
            options.shading = EWA_SHADING_PHONG;
            const ewa_frame frame = {.rgba = pixels, .depth = depth};
            assert_int_equal(ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL), EWA_OK);
            if (n == 0) {
                memcpy(first + view * 4 * PIXELS, pixels, 4 * PIXELS * sizeof *pixels);
                memcpy(first_depth + view * PIXELS, depth, PIXELS * sizeof *depth);
                double sum = 0;
                for (int i = 3; i < 4 * PIXELS; i += 4) sum += (double)pixels[i];
                assert_true(sum > 100);
            }
            assert_memory_equal(pixels, first + view * 4 * PIXELS, 4 * PIXELS * sizeof *pixels);
            for (int i = 0; i < PIXELS; i++)
                assert_true(depth[i] == (float)((double)first_depth[view * PIXELS + i] * place));
            // And the reference, in doubles, sees the same.
            ewa_image fast = {.context = context, WIDTH, HEIGHT, 4, pixels};
            OWNED(ewa_image_free) ewa_image slow = scene_draw_reference(&volume, &transfer, &camera, &options);
            const image_difference difference = image_compare(&fast, &slow, 0);
            assert_true(difference.psnr_db > 40);
        }
    }
}

/// From as far away as cameras can be, and with any focal length, pictures are numbers.
TEST_ON(test_extremes, 1) {
    static const uint32_t dims[3] = {8, 8, 8};
    static const double eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1};
    enum { SIDE = 16 };
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 1);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int power = -320; power <= 300; power += 31)
        for (int focal = 0; focal < 3; focal++)
            for (int method = EWA_VOLUME_HYBRID; method <= EWA_VOLUME_POINTS; method++) {
                ewa_camera camera = camera_at(SIDE, SIDE, eye, ahead, 40);
                camera.world_to_camera[11] = pow(10, power);
                if (focal == 1) camera.fx_px = camera.fy_px = 1e-6;
                if (focal == 2) camera.fx_px = camera.fy_px = 1e15;
                ewa_volume_options options = defaults();
                options.method = (ewa_volume_method)method;
                if (method == EWA_VOLUME_POINTS) options.prefilter_px = 0;
                ewa_image images[2] = {scene_draw(context, voxels, &camera, &options),
                                       scene_draw_reference(&volume, &transfer, &camera, &options)};
                for (int i = 0; i < 2 * 4 * SIDE * SIDE; i++) {
                    const float number = images[i / (4 * SIDE * SIDE)].pixels[i % (4 * SIDE * SIDE)];
                    if (!(number >= 0 && number < 1.01f))
                        fail_msg("1e%d, focal %d: %g", power, focal, (double)number);
                }
                ewa_image_free(&images[0]);
                ewa_image_free(&images[1]);
            }
}

/// The angle between two directions, free of cancellation.
static double angle_of(ewa_vec3 a, ewa_vec3 b) {
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

/// All rays of a rectangle of pixels are in its cone, which is no wider than the rectangle is across; it
/// meets balls at these rays, and none that lies farther off than it is wide.
TEST(test_ray_cones) {
    check_random random = {12};
    for (int round = 0; round < 200; round++) {
        ewa_grid_view grid = {.fx_px = check_uniform(&random, 60, 300),
                              .fy_px = check_uniform(&random, 60, 300)};
        grid.cx_px = check_uniform(&random, -20, 120), grid.cy_px = check_uniform(&random, -20, 120);
        // Steps of different length along axes that are turned.
        const double turn = check_uniform(&random, 0, 6);
        const double c = cos(turn), s = sin(turn), long_step = check_uniform(&random, 0.5, 2);
        grid.to_steps = (ewa_mat3){{{c, s, 0}, {-s * long_step, c * long_step, 0}, {0, 0, 1}}};
        const double left = check_uniform(&random, 0, 90), right = left + check_uniform(&random, 2, 40);
        const double top = check_uniform(&random, 0, 90), bottom = top + check_uniform(&random, 2, 40);
        ewa_ray_cone cone;
        ewa_ray_cone_make(&cone, &grid, left, top, right, bottom);
        const ewa_vec3 axis = vec3_load(cone.axis);
        assert_float_equal(vec3_length(axis), 1, 1e-12);
        ewa_vec3 corners[4];
        double across = 0;
        for (int i = 0; i < 10 * 10; i++) {
            const double x = left + (right - left) * (i % 10) / 9, y = top + (bottom - top) * (i / 10) / 9;
            const ewa_vec3 ray = vec3_mul_mat3(
                vec3_make((x - grid.cx_px) / grid.fx_px, (y - grid.cy_px) / grid.fy_px, 1), &grid.to_steps);
            const double angle = angle_of(ray, axis);
            if (angle > cone.angle)
                fail_msg("round %d: a ray at %g of a cone of %g", round, angle, cone.angle);
            const double at_ray[3] = {9 * ray.x, 9 * ray.y, 9 * ray.z};
            assert_true(ewa_ray_cone_hits(&cone, at_ray, 0.01));
            if ((i % 10 == 0 || i % 10 == 9) && (i < 10 || i >= 90))
                corners[(i >= 90) * 2 + (i % 10 == 9)] = ray;
        }
        for (int i = 0; i < 16; i++) across = fmax(across, angle_of(corners[i / 4], corners[i % 4]));
        if (cone.angle > 0.75 * across)
            fail_msg("round %d: a cone of %g around what is %g across", round, cone.angle, across);
        ewa_vec3 aside = vec3_cross(axis, vec3_make(0.3, 0.5, -0.4));
        vec3_normalize(&aside);
        const double beyond = 1.05 * across + 0.02; // a ball of 0.1 at a distance of 10 is 0.01 wide
        const ewa_vec3 far =
            vec3_add(vec3_scale(axis, 10 * cos(beyond)), vec3_scale(aside, 10 * sin(beyond)));
        const double off[3] = {far.x, far.y, far.z};
        assert_false(ewa_ray_cone_hits(&cone, off, 0.1));
        assert_true(ewa_ray_cone_hits(&cone, off, 11)); // the eye is in the ball
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
