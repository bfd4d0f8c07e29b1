// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// McMillan's order against nearest pixels by a depth buffer.
#include "warp_planes.h"

static plane_image plane;
static plane_frame drawn;

/// The nearest depth in each pixel, in double precision.
static void z_buffer(const ewa_camera *target, double nearest[PLANE_PIXELS]) {
    for (int i = 0; i < PLANE_PIXELS; i++) nearest[i] = INFINITY;
    const double *m = target->world_to_camera;
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const double z = (double)plane.depth[i];
        if (!(z > 0)) continue;
        const double p[3] = {z * (i % PLANE_WIDTH + 0.5 - PLANE_WIDTH / 2) / 80,
                             z * (i / PLANE_WIDTH + 0.5 - PLANE_HEIGHT / 2) / 80, z};
        double q[3];
        for (int r = 0; r < 3; r++)
            q[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
        const double x = floor(80 * q[0] / q[2] + PLANE_WIDTH / 2),
                     y = floor(80 * q[1] / q[2] + PLANE_HEIGHT / 2);
        if (!(q[2] > 0) || !(x >= 0 && x < PLANE_WIDTH && y >= 0 && y < PLANE_HEIGHT)) continue;
        double *at = &nearest[(int)y * PLANE_WIDTH + (int)x];
        if (q[2] < *at) *at = q[2];
    }
}

static void make_scene(void) {
    plane_set(&plane, 3);
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const int x = i % PLANE_WIDTH - PLANE_WIDTH / 2, y = i / PLANE_WIDTH - PLANE_HEIGHT / 2;
        if (x * x + y * y < 200) plane.depth[i] = 2 + 0.002f * (float)(x * x + y * y);
        if (x > 10 && x < 20) plane.depth[i] = 1.5f;
        if (y > 22) plane.depth[i] = 1.2f;
    }
}

/// From in front, behind, all sides, and where the epipole is in the picture, on its border, far outside or
/// at infinity: no more than rounding separates the order from the depth test.
TEST_ON(test_order, 2) {
    static const double places[][3] = {{0, 0, 0.5},    {0.1, 0.05, 0.6}, {0, 0, -1},        {0.3, 0.1, -0.8},
                                       {0.4, 0, 0},    {-0.4, 0, 0},     {0, 0.3, 0},       {0, -0.3, 0},
                                       {0.3, 0.3, 0},  {-0.3, 0.2, 0.1}, {-0.3, -0.3, 0.7}, {0.5, -0.2, -0.3},
                                       {0.24, 0, 0.4}, {0, 0, 0}};
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    make_scene();
    WITH_DEFAULTS(ewa_warp_options, options);
    options.drop_flying = false;
    assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &options, NULL), EWA_OK);
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        double at[3]; // a little aside, so that no sample lies just on the border of two pixels
        for (int c = 0; c < 3; c++) at[c] = places[k][c] != 0 ? places[k][c] + 0.00131 : 0;
        const ewa_camera target = plane_camera_at(at[0], at[1], at[2]);
        static double nearest[PLANE_PIXELS];
        z_buffer(&target, nearest);
        plane_draw(warp, &target, EWA_WARP_MCMILLAN, &drawn);
        int differ = 0, drawn_count = 0, hidden = 0;
        for (int i = 0; i < PLANE_PIXELS; i++) {
            if (isinf(nearest[i]) && isinf(drawn.depth[i])) continue;
            drawn_count++;
            differ += !(fabs((double)drawn.depth[i] - nearest[i]) <= 1e-5 * nearest[i]);
            hidden += (double)drawn.depth[i] > nearest[i] * 1.05;
        }
        // Where samples are minified several fall into one pixel but on different rays: these have no order.
        const bool minified = places[k][2] < 0;
        if (hidden > (minified ? 3 : 0) || differ > (minified ? drawn_count / 12 : 0))
            fail_msg("place %zu: %d of %d differ, %d hidden ones show", k, differ, drawn_count, hidden);
    }
}

/// The identity gives the bytes of the picture.
TEST_ON(test_identity, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    make_scene();
    plane_take(warp, &plane, NULL);
    plane_draw(warp, &plane.image.camera, EWA_WARP_MCMILLAN, &drawn);
    for (int i = 0; i < PLANE_PIXELS; i++) {
        if (drawn.holes[i]) continue;
        for (int c = 0; c < 3; c++) assert_int_equal(drawn.rgba8[4 * i + c], plane.rgb8[3 * i + c]);
        assert_true(fabsf(drawn.depth[i] - plane.depth[i]) < 1e-6f);
        assert_true(drawn.coverage[i] == 1);
        assert_true(drawn.normal[3 * i + 2] < 0);
    }
}

/// Of two sources the nearer one shows, whichever comes first.
TEST_ON(test_two_sources, 2) {
    static plane_image near;
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 3);
    plane_set(&near, 1);
    memset(near.rgb8, 200, sizeof near.rgb8);
    for (int i = 0; i < PLANE_PIXELS; i++)
        if (i % PLANE_WIDTH > 40) near.depth[i] = 0;
    const ewa_depth_image images[2][2] = {{plane.image, near.image}, {near.image, plane.image}};
    for (int k = 0; k < 2; k++) {
        assert_int_equal(ewa_warp_take(warp, images[k], 2, NULL, NULL), EWA_OK);
        plane_draw(warp, &plane.image.camera, EWA_WARP_MCMILLAN, &drawn);
        for (int i = 0; i < PLANE_PIXELS; i++)
            assert_true(fabsf(drawn.depth[i] - (i % PLANE_WIDTH > 40 ? 3.0f : 1.0f)) < 1e-5f);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
