// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The bound of visibility is z + eps as it is at each pixel (semantics.h), not along a plane through the
// centre: a small disc behind a large one near the eye is seen just as far as the tolerance reaches, wherever
// the large one is hit. Both pipelines, every kernel.
#include "tests/splat/picture.h"

#include <math.h>

enum { SIDE_PX = 16 };

/// The large disc: in front of the middle of the picture, turned about y by TILT, so that its depth changes
/// fivefold. It is just small enough not to be drawn by pixel rays, and its ellipse not to be called wide by
/// the fast pipeline for its size alone.
#define TILT   1.0471975511965976 // 60 degrees
#define CENTER 2.0
#define RADIUS 1.6
#define FOCAL  5.0 ///< pixels

/// Where the large disc's plane is hit at the centre of pixel (x, SIDE_PX / 2): the depth.
static double depth_at(int x, double ray[3]) {
    ray[0] = (x + 0.5 - SIDE_PX / 2) / FOCAL, ray[1] = 0.5 / FOCAL, ray[2] = 1;
    return cos(TILT) * CENTER / (cos(TILT) - sin(TILT) * ray[0]);
}

/// Draws the first of two points, or both, with the reference and with the fast pipeline: the large disc,
/// red, and a small one, green, on a pixel's ray at a depth.
static void draw(ewa_context *context, ewa_kernel kernel, uint64_t count, const double ray[3], double z,
                 picture made[2]) {
    const float position[6] = {0, 0, (float)CENTER, (float)(ray[0] * z), (float)(ray[1] * z), (float)z};
    const float normal[6] = {(float)sin(TILT), 0, (float)-cos(TILT), 0, 0, -1};
    const float radius[2] = {(float)RADIUS, 0.1f}, color[6] = {1, 0, 0, 0, 1, 0};
    ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, position, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, normal, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, radius, 0), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_COLOR, EWA_F32, 3, color, 0), EWA_OK);
    ewa_camera camera = check_camera(SIDE_PX, SIDE_PX);
    assert_int_equal(ewa_camera_set_fov(&camera, 2 * atan(SIDE_PX / 2 / FOCAL) * 180 / acos(-1)), EWA_OK);
    // Without a prefilter the tolerance is the radius.
    WITH_DEFAULTS(ewa_render_options, options);
    options.kernel = kernel;
    options.prefilter_px = 0;
    options.edge_antialiasing = false, options.supersampling = 1;
    options.shading = EWA_SHADING_NONE;
    const scene of = {.cloud = cloud, .camera = camera, .unit_coverage = 1};
    made[0] = picture_of_scene(&of, NULL, &options);
    made[1] = picture_draw(context, cloud, &camera, NULL, &options);
    ewa_cloud_destroy(&cloud);
}

/// Whether a channel of the two pictures' pixel (x, SIDE_PX / 2) has something in each.
static void look(const picture made[2], int x, int channel, bool there[2]) {
    for (int i = 0; i < 2; i++)
        there[i] = made[i].frame.rgba[4 * (SIDE_PX / 2 * SIDE_PX + x) + channel] > 0.01f;
}

TEST_ON(test_tolerance_at_each_pixel, 0) {
    static const double origin[3] = {0, 0, 0};
    static const double beyond[] = {0.5, 0.9, 0.98, 1.02, 1.1, 1.5};
    for (int kernel = EWA_KERNEL_PERSPECTIVE; kernel <= EWA_KERNEL_RAYCAST; kernel++) {
        double nearest = INFINITY, farthest = 0;
        picture alone[2], pair[2];
        draw(context, (ewa_kernel)kernel, 1, origin, 0, alone);
        for (int x = 0; x < SIDE_PX; x++) {
            double ray[3];
            const double z = depth_at(x, ray);
            bool hit[2], shows[2];
            look(alone, x, 3, hit);
            // What a kernel covers beyond the disc has depths of its own.
            if (!hit[0] || !hit[1] || !(z > 0) || fabs(z - CENTER) > 0.95 * sin(TILT) * RADIUS) continue;
            nearest = fmin(nearest, z), farthest = fmax(farthest, z);
            for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
                draw(context, (ewa_kernel)kernel, 2, ray, z + beyond[i] * RADIUS, pair);
                look(pair, x, 1, shows);
                if (shows[0] != (beyond[i] < 1) || shows[1] != (beyond[i] < 1))
                    fail_msg("kernel %d, pixel %d, %g tolerances behind: reference %d, pipeline %d", kernel,
                             x, beyond[i], shows[0], shows[1]);
                for (int k = 0; k < 2; k++) picture_free(&pair[k]);
            }
        }
        for (int k = 0; k < 2; k++) picture_free(&alone[k]);
        print_message("kernel %d: depths %.2f to %.2f\n", kernel, nearest, farthest);
        assert_true(nearest < 0.75 * CENTER && farthest > 1.2 * CENTER);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
