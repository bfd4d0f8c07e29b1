// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Line integrals through volumes: the footprint's index, closed forms, marched rays.
#include "check.h"
#include "image_difference.h"
#include "volume/footprint.h"
#include "volume/march.h"
#include "volume/scene.h"

#include <math.h>

static const double PI = 3.14159265358979323846, UNIT[3] = {1, 1, 1}, DIRECTION[3] = {0.4, 0.3, -1};

/// d = sin(atan(i tan alpha)) / sin alpha; with tan alpha below, as printed, the rim is at cos alpha.
TEST(test_index) {
    for (int degrees = 1; degrees <= 80; degrees += 7) {
        const double alpha = degrees * PI / 180, sine2 = sin(alpha) * sin(alpha);
        for (double i = 0; i <= 1; i += 0.125) {
            const double d = sin(atan(i * tan(alpha))) / sin(alpha);
            assert_true(fabs(sqrt(ewa_footprint_index2(i * i, sine2)) - d) < 1e-14);
            const double printed = sin(atan(i * tan(alpha))) / tan(alpha);
            assert_true(fabs(sqrt(ewa_footprint_index2_printed(i * i, sine2)) - printed) < 1e-14);
        }
        assert_true(fabs(ewa_footprint_index2(1, sine2) - 1) < 1e-15);
        assert_true(fabs(sqrt(ewa_footprint_index2_printed(1, sine2)) - cos(alpha)) < 1e-14);
    }
}

TEST(test_table) {
    ewa_footprint_table table;
    ewa_footprint_table_make(&table);
    double maximum = 0;
    for (int row = 0; row < EWA_FOOTPRINT_ANGLES; row++) {
        const double sine2 = EWA_FOOTPRINT_END * row / (EWA_FOOTPRINT_ANGLES - 1);
        for (int n = 0; n < 1000; n++) {
            const double i2 = n / 1000.0, at = i2 * EWA_FOOTPRINT_STEPS;
            const int step = (int)at;
            const double d2 =
                i2 + (double)table.start[row][step] + (at - step) * (double)table.growth[row][step];
            maximum = fmax(maximum, fabs(d2 - ewa_footprint_index2(i2, sine2)));
        }
    }
    assert_true(maximum < 1e-4);
}

static double optical_depth(const ewa_image *image, size_t pixel) {
    return -log(1 - (double)image->pixels[4 * pixel + 3]);
}

/// A Gaussian blob of Gaussian kernels is a Gaussian blob, whose line integrals are known.
TEST_ON(test_blob, 2) {
    static const uint32_t dims[3] = {48, 48, 48};
    enum { SIDE = 64 };
    const double q = 5, kappa = 0.05;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_blob, &q);
    const ewa_transfer transfer = scene_linear(1, 1, 1, (float)kappa);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int view = 0; view < 4; view++) {
        const bool ortho = view & 1, far = view & 2;
        ewa_camera camera = scene_camera(SIDE, SIDE, DIRECTION, far ? 150 : 60);
        if (ortho) assert_int_equal(ewa_camera_set_ortho(&camera, far ? 100 : 40), EWA_OK);
        WITH_DEFAULTS(ewa_volume_options, options);
        options.prefilter_px = 0, options.cutoff = 4, options.minimum_transmittance = 0;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        const double s2 = q * q + options.sigma * options.sigma, peak = kappa * q * q * q / s2 * sqrt(2 * PI);
        const double *m = camera.world_to_camera;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = (i % SIDE + 0.5 - camera.cx_px) / camera.fx_px;
            const double y = (i / SIDE + 0.5 - camera.cy_px) / camera.fy_px;
            const double along = (m[3] * x + m[7] * y + m[11]) / sqrt(x * x + y * y + 1);
            const double d2 = ortho ? (x - m[3]) * (x - m[3]) + (y - m[7]) * (y - m[7])
                                    : m[3] * m[3] + m[7] * m[7] + m[11] * m[11] - along * along;
            const double truth = peak * exp(-d2 / (2 * s2));
            assert_true(fabs(optical_depth(&image, (size_t)i) - truth) < (far ? 0.012 : 2e-4) * peak);
        }
    }
}

/// Through single voxels and thin tubes, near enough for large cone angles.
TEST_ON(test_marched, 2) {
    static const uint32_t dims[3] = {16, 16, 16};
    enum { SIDE = 48 };
    const double half = 6;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_vessels, &half);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 0.2f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    const march_scene scene = {.volume = &volume, .extinction = (double)0.2f, .sigma = 0.6, .step = 0.1};
    const ewa_camera camera = scene_camera(SIDE, SIDE, DIRECTION, 20);
    double largest = 0, errors[2] = {0, 0}, truth[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        truth[i] = march_depth(&scene, &camera, i % SIDE + 0.5, i / SIDE + 0.5);
        largest = fmax(largest, truth[i]);
    }
    for (int index = EWA_INDEX_EXACT; index <= EWA_INDEX_TABLE; index++) {
        WITH_DEFAULTS(ewa_volume_options, options);
        options.method = EWA_VOLUME_SPLATS, options.index = (ewa_volume_index)index;
        options.prefilter_px = 0, options.cutoff = 4, options.minimum_transmittance = 0;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        for (int i = 0; i < SIDE * SIDE; i++)
            errors[index] = fmax(errors[index], fabs(optical_depth(&image, (size_t)i) - truth[i]));
    }
    assert_true(largest > 0.5);
    assert_true(errors[EWA_INDEX_EXACT] < 5e-4 * largest);
    assert_true(errors[EWA_INDEX_TABLE] > 5 * errors[EWA_INDEX_EXACT]); // off the axis it is not exact
    assert_true(errors[EWA_INDEX_TABLE] < 0.05 * largest);
}

/// Largest changes between pictures of a turning box within 0.3 degrees of the diagonal, and elsewhere.
static void turn_past_diagonal(ewa_context *context, const ewa_voxels *voxels, bool ortho, double *near,
                               double *elsewhere) {
    ewa_image before = {0};
    *near = *elsewhere = 0;
    for (double degrees = 42; degrees <= 48; degrees += 0.25) {
        const double angle = degrees * PI / 180, direction[3] = {sin(angle), 0, -cos(angle)};
        ewa_camera camera = scene_camera(160, 160, direction, 80);
        if (ortho) assert_int_equal(ewa_camera_set_ortho(&camera, 55), EWA_OK);
        ewa_image image = scene_draw(context, voxels, &camera, NULL);
        if (before.pixels) {
            const image_difference difference = image_compare(&image, &before, 0);
            double *maximum = fabs(degrees - 45.125) < 0.3 ? near : elsewhere;
            *maximum = fmax(*maximum, difference.rms);
            ewa_image_free(&before);
        }
        before = image;
    }
    ewa_image_free(&before);
}

/// Turning past the diagonal changes a checker box no more than turning elsewhere.
TEST_ON(test_no_popping, 2) {
    static const uint32_t dims[3] = {32, 32, 32};
    static const double sides[2] = {4, 13};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_checker, sides);
    ewa_transfer transfer = {.point_count = 2, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){0.75, {0.9f, 0.2f, 0.1f}, 0.5f};
    transfer.points[1] = (ewa_transfer_point){2.25, {0.9f, 0.9f, 0.6f}, 0.5f};
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int ortho = 0; ortho < 2; ortho++) {
        double near, elsewhere;
        turn_past_diagonal(context, voxels, ortho, &near, &elsewhere);
        if (!(near < 1.05 * elsewhere)) print_message("%g near 45 degrees, %g elsewhere\n", near, elsewhere);
        assert_true(near < 1.05 * elsewhere);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
