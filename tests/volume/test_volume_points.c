// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Single voxels on the screen: their optical depth, where it is and how wide, as points and as splats; which
// of both they are; what coarser levels hold.
#include "check.h"
#include "volume/scene.h"

#include <math.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE };

static const double UNIT[3] = {1, 1, 1};

static ewa_volume_options defaults(void) {
    WITH_DEFAULTS(ewa_volume_options, options);
    options.minimum_transmittance = 0;
    return options;
}

/// Optical depth on the screen: its sum, middle and variance along x and y, px.
typedef struct footprint {
    double mass, middle[2], variance[2];
} footprint;

static footprint measure(const ewa_image *image) {
    footprint f = {.mass = 0};
    double squares[2] = {0, 0};
    for (int i = 0; i < PIXELS; i++) {
        const double depth = -log1p(-(double)image->pixels[4 * i + 3]),
                     at[2] = {i % SIDE + 0.5, i / SIDE + 0.5};
        f.mass += depth;
        for (int k = 0; k < 2; k++) f.middle[k] += depth * at[k], squares[k] += depth * at[k] * at[k];
    }
    for (int k = 0; k < 2; k++) {
        f.middle[k] /= f.mass;
        f.variance[k] = squares[k] / f.mass - f.middle[k] * f.middle[k];
    }
    return f;
}

static void expect(const char *what, double value, double wanted, double tolerance) {
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %g, wanted %g (+- %g)", what, value, wanted, tolerance);
}

/// A camera that looks along z at the origin from `distance`, with a focal length, and a picture whose middle
/// is moved.
static ewa_camera look(double distance, double focal_px, double shift_px) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.world_to_camera[11] = distance;
    camera.fx_px = camera.fy_px = focal_px;
    camera.cx_px = 0.5 * SIDE + shift_px, camera.cy_px = 0.5 * SIDE - 0.5 * shift_px;
    return camera;
}

/// One voxel: extinction times cell, seen from p with the Jacobian fx fy |p| / z^3, is all there is; it is as
/// wide as its kernel and the pixel's filter together.
TEST_ON(test_single_voxels, 1) {
    static const uint32_t dims[3] = {3, 3, 3};
    const double kappa = 0.02, spacing[3] = {1.3, 1.3, 1.3}, cell = 1.3 * 1.3 * 1.3;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, spacing, scene_ones, NULL);
    for (int i = 0; i < 27; i++) ((float *)volume.voxels)[i] = i == 13;
    const ewa_transfer transfer = scene_linear(1, 1, 1, (float)kappa);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int n = 0; n < 24; n++) {
        const bool points = n % 2, ortho = n / 2 % 2;
        const double shift = 0.37 * (n / 4), prefilter = n < 12 ? 0.35 : 0.55, distance = 40 + 3 * n;
        // Points of 0.7 px; splats large enough for pixels to be samples of them.
        const double step_px = points ? 0.7 : 2, focal = step_px / 1.3;
        ewa_camera camera = look(distance, ortho ? focal : focal * distance, shift);
        if (ortho) camera.projection = EWA_ORTHOGRAPHIC;
        ewa_volume_options options = defaults();
        options.method = points ? EWA_VOLUME_POINTS : EWA_VOLUME_SPLATS;
        options.prefilter_px = prefilter;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        const footprint f = measure(&image);
        const double mass = kappa * cell * focal * focal;
        expect("mass", f.mass, mass, 0.005 * mass);
        expect("x", f.middle[0], 0.5 * SIDE + shift, 0.035);
        expect("y", f.middle[1], 0.5 * SIDE - 0.5 * shift, 0.035);
        // What a cutoff at three standard deviations leaves of the variance, and 4 taps of a wide filter.
        const double whole = 0.36 * step_px * step_px + prefilter * prefilter,
                     kept = 1 - 4.5 * exp(-4.5) / (1 - exp(-4.5));
        for (int k = 0; k < 2; k++)
            expect("variance", f.variance[k], points ? whole : kept * whole,
                   points ? 0.08 * whole : 0.02 * whole);
    }
    // Off the axis the length of the way through it grows, and its area.
    const double place[3] = {18, -11, 0}, distance = 30;
    for (int axis = 0; axis < 3; axis++) volume.index_to_world[4 * axis + 3] += place[axis];
    ewa_voxels_destroy(&voxels);
    voxels = scene_voxels(&volume, &transfer);
    for (int points = 0; points < 2; points++) {
        ewa_camera camera = look(distance, 0.7 / 1.3 * distance, 0);
        camera.cx_px -= camera.fx_px * place[0] / distance,
            camera.cy_px -= camera.fy_px * place[1] / distance;
        ewa_volume_options options = defaults();
        options.method = points ? EWA_VOLUME_POINTS : EWA_VOLUME_SPLATS;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        const double length = sqrt(place[0] * place[0] + place[1] * place[1] + distance * distance);
        const double mass = kappa * cell * (0.7 / 1.3) * (0.7 / 1.3) * length / distance;
        expect("mass off the axis", measure(&image).mass, mass, 0.02 * mass);
    }
}

/// A point that is less than a rounding beside the middle of a pixel is drawn as one that is there, by every filter.
TEST_ON(test_just_beside_a_pixel, 1) {
    static const uint32_t dims[3] = {3, 3, 3};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    for (int i = 0; i < 27; i++) ((float *)volume.voxels)[i] = i == 13;
    const ewa_transfer transfer = scene_linear(1, 1, 1, 0.2f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int n = 0; n < 64; n++) {
        ewa_camera camera = look(40, 0.01 + 0.0124 * n, 0);
        camera.projection = EWA_ORTHOGRAPHIC;
        ewa_volume_options options = defaults();
        options.method = EWA_VOLUME_POINTS;
        options.prefilter_px = 0.2 + 0.009 * n;
        camera.cx_px = camera.cy_px = 0.5;
        OWNED(ewa_image_free) ewa_image there = scene_draw(context, voxels, &camera, &options);
        camera.cx_px = camera.cy_px = (double)nextafterf(0.5f, 0);
        OWNED(ewa_image_free) ewa_image beside = scene_draw(context, voxels, &camera, &options);
        assert_true(there.pixels[3] > 0);
        for (int i = 0; i < 4 * PIXELS; i++)
            expect("pixel", (double)beside.pixels[i], (double)there.pixels[i], 0.1 * (double)there.pixels[3]);
    }
}

/// Voxels are points while they are at most 1.2 px apart and their filter at most 0.8 px wide.
TEST_ON(test_threshold, 1) {
    static const uint32_t dims[3] = {6, 6, 6};
    static const struct {
        double step_px, prefilter_px, threshold_px;
        bool points;
    } cases[] = {
        {1.19, 0.3, 1.2, true}, {1.21, 0.3, 1.2, false}, {0.87, 0.6, 1.2, true},   {0.89, 0.6, 1.2, false},
        {0.69, 0.3, 0.7, true}, {0.71, 0.3, 0.7, false}, {0.01, 0.85, 1.2, false}, {0.01, 0.3, 0, false},
    };
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 0.1f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int ortho = 0; ortho < 2; ortho++) {
            // All voxels are nearly as far away as the middle.
            ewa_camera camera = look(1e5, cases[i].step_px * (ortho ? 1 : 1e5), 0);
            if (ortho) camera.projection = EWA_ORTHOGRAPHIC;
            ewa_volume_options options = defaults();
            options.prefilter_px = cases[i].prefilter_px;
            options.point_threshold_px = cases[i].threshold_px;
            expect("share of points", scene_point_share(context, voxels, &camera, &options), cases[i].points,
                   0);
        }
}

/// Coarser levels hold the means of eight: in thin fog the same light, from the middle of these eight.
TEST_ON(test_levels, 1) {
    static const uint32_t dims[3] = {4, 4, 4};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    check_random random = {3};
    double light[3] = {0, 0, 0}, middle[2] = {0, 0}, all = 0;
    ewa_transfer transfer = {.point_count = 3, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){0, {1, 0, 0}, 0};
    transfer.points[1] = (ewa_transfer_point){1, {0.5f, 1, 0}, 2e-4f};
    transfer.points[2] = (ewa_transfer_point){2, {0, 0.5f, 1}, 4e-4f};
    for (int i = 0; i < 64; i++) {
        const double value = i % 3 ? check_uniform(&random, 0, 2) : 0, extinction = 2e-4 * value;
        ((float *)volume.voxels)[i] = (float)value;
        const double t = value < 1 ? value : value - 1;
        const double color[3] = {value < 1 ? 1 - 0.5 * t : 0.5 - 0.5 * t, value < 1 ? t : 1 - 0.5 * t,
                                 value < 1 ? 0 : t};
        for (int c = 0; c < 3; c++) light[c] += extinction * color[c];
        middle[0] += extinction * (i % 4 - 1.5), middle[1] += extinction * (i / 4 % 4 - 1.5);
        all += extinction;
    }
    WITH_DEFAULTS(ewa_voxels_options, voxels_options);
    voxels_options.level_count = 3;
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels;
    assert_int_equal(ewa_voxels_create(&volume, &transfer, &voxels_options, &voxels), EWA_OK);
    const double step_px = 1.3, area = step_px * step_px;
    ewa_camera camera = look(100, step_px, 0);
    camera.projection = EWA_ORTHOGRAPHIC;
    for (uint32_t level = 0; level < 3; level++) {
        ewa_volume_options options = defaults();
        options.level = level;
        OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
        double sums[3] = {0, 0, 0};
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) sums[c] += (double)image.pixels[4 * i + c];
        for (int c = 0; c < 3; c++)
            expect(level == 0   ? "light 0"
                   : level == 1 ? "light 1"
                                : "light 2",
                   sums[c], area * light[c], 0.01 * area * light[c]);
        const footprint f = measure(&image);
        expect("mass", f.mass, area * all, 0.01 * area * all);
        // A mean lies in the middle of its eight, so up to half a finer step off.
        for (int k = 0; k < 2; k++) {
            const double fine = 0.5 * SIDE + step_px * middle[k] / all, middle_px = 0.5 * SIDE;
            expect("middle", f.middle[k], level == 2 ? middle_px : fine, level == 1 ? 0.35 : 0.02);
        }
    }
}

/// Marked splats are red, in the reference as well; points keep their colours, to the bit.
TEST_ON(test_marks, 1) {
    static const uint32_t dims[3] = {8, 8, 8};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(0.2f, 0.9f, 0.4f, 0.05f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    const ewa_camera camera = look(40, 60, 0);
    ewa_volume_options plain = defaults(), marked = defaults();
    marked.mark_splats = true;
    for (int points = 0; points < 2; points++) {
        plain.method = marked.method = points ? EWA_VOLUME_POINTS : EWA_VOLUME_SPLATS;
        OWNED(ewa_image_free)
        ewa_image before = scene_draw(context, voxels, &camera, &plain), after = scene_draw(context, voxels, &camera, &marked);
        OWNED(ewa_image_free) ewa_image reference = scene_draw_reference(&volume, &transfer, &camera, &marked);
        for (int i = 0; i < PIXELS; i++) {
            const float *was = before.pixels + 4 * i, *is = after.pixels + 4 * i, alpha = is[3];
            assert_true(alpha == was[3]);
            if (points)
                assert_memory_equal(is, was, 4 * sizeof *is);
            else
                for (int c = 0; c < 3; c++) {
                    const double color = c == 0 ? EWA_MARKED_SPLAT_RED : EWA_MARKED_SPLAT_OTHER;
                    expect("a marked splat", (double)is[c], color * (double)alpha, 1e-5);
                    expect("the reference's", (double)reference.pixels[4 * i + c], color * (double)alpha, 1e-4);
                }
        }
    }
    // Both at once: the near half of a long volume is of splats.
    static const uint32_t long_dims[3] = {4, 4, 60};
    OWNED(ewa_volume_free) ewa_volume row = scene_volume(context, long_dims, UNIT, scene_ones, NULL);
    OWNED(ewa_voxels_destroy) ewa_voxels *mixed = scene_voxels(&row, &transfer);
    const ewa_camera ahead = look(60, 72, 0); // 2.4 px at 30, 0.8 px at 90
    marked.method = EWA_VOLUME_HYBRID;
    const double share = scene_point_share(context, mixed, &ahead, &marked);
    OWNED(ewa_image_free) ewa_image image = scene_draw(context, mixed, &ahead, &marked);
    double sums[3] = {0};
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) sums[c] += (double)image.pixels[4 * i + c];
    assert_true(share > 0.3 && share < 0.7);
    assert_true(sums[0] > sums[1] && sums[1] > 0.1 * sums[0]); // red, and green behind it
}

int main(void) { return RUN_TESTS(NULL, NULL); }
