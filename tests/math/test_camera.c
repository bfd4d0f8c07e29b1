// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/homogeneous/camera.c: placement, intrinsics, framing, checks.
#include "check.h"
#include "math/angle.h"

#include <float.h>
#include <math.h>
#include <string.h>

static ewa_camera default_camera(void) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    return camera;
}

/// Projects a world point as documented in camera.h; returns its camera-space depth.
static double project(const ewa_camera *camera, const double w[3], double pixel[2]) {
    const double *m = camera->world_to_camera;
    double p[3];
    for (int r = 0; r < 3; r++)
        p[r] = m[4 * r] * w[0] + m[4 * r + 1] * w[1] + m[4 * r + 2] * w[2] + m[4 * r + 3];
    const double divisor = camera->projection == EWA_PERSPECTIVE ? p[2] : 1;
    pixel[0] = camera->fx_px * p[0] / divisor + camera->cx_px;
    pixel[1] = camera->fy_px * p[1] / divisor + camera->cy_px;
    return p[2];
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, not %.17g within %g", value, expected, tolerance);
}

TEST(test_tangent) {
    for (int i = 0; i < 100000; i++) {
        const double angle = i * (EWA_PI / 2 / 100000), expected = tan(angle);
        assert_near(ewa_tan(angle), expected, 4 * DBL_EPSILON * fmax(expected, 1e-3) * fmax(1, expected));
    }
}

TEST_ON(test_defaults, 1) {
    const ewa_camera camera = default_camera();
    assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
    assert_int_equal(camera.width_px, 1280);
    assert_near(camera.fy_px, 360 / tan(25 * EWA_PI / 180), 1e-10);
    double pixel[2], eye[3];
    const double ahead[3] = {0, 0, 5};
    assert_true(project(&camera, ahead, pixel) == 5);
    assert_true(pixel[0] == 640 && pixel[1] == 360);
    ewa_camera_eye(&camera, eye);
    assert_true(eye[0] == 0 && eye[1] == 0 && eye[2] == 0);
}

TEST(test_look_at_known) {
    ewa_camera camera = default_camera();
    const double eye[3] = {10, 0, 0}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    double pixel[2];
    const double above[3] = {0, 0, 1}, north[3] = {0, 1, 0};
    assert_near(project(&camera, above, pixel), 10, 0);
    assert_true(pixel[0] == 640 && pixel[1] < 360); // up in the world is up in the picture
    project(&camera, north, pixel);
    assert_true(pixel[0] > 640 && pixel[1] == 360); // looking to -x with z up, +y is on the right
}

TEST_ON(test_look_at_properties, 1) {
    check_random random = {7};
    for (int round = 0; round < 1000; round++) {
        ewa_camera camera = default_camera();
        double eye[3], target[3], up[3], back[3], pixel[2];
        const double offset = round % 2 ? 5e6 : 0, scale = pow(10, check_uniform(&random, -3, 6));
        for (int i = 0; i < 3; i++) {
            eye[i] = offset + scale * check_uniform(&random, -1, 1);
            target[i] = offset + scale * check_uniform(&random, -1, 1);
            up[i] = check_uniform(&random, -1, 1);
        }
        if (round % 5 == 0)
            for (int i = 0; i < 3; i++) up[i] = target[i] - eye[i]; // parallel to the view
        if (round % 7 == 0) memset(up, 0, sizeof up);
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
        ewa_camera_eye(&camera, back);
        const double tolerance = 1e-14 * (offset + scale);
        double distance = 0;
        for (int i = 0; i < 3; i++) {
            assert_near(back[i], eye[i], tolerance);
            distance += (target[i] - eye[i]) * (target[i] - eye[i]);
        }
        distance = sqrt(distance);
        assert_near(project(&camera, target, pixel), distance, tolerance);
        assert_near(pixel[0], 640, 1e3 * tolerance / distance);
        assert_near(pixel[1], 360, 1e3 * tolerance / distance);
    }
}

TEST(test_map_from_above_has_north_up) {
    ewa_camera camera = default_camera();
    const double eye[3] = {0, 0, 10}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1}, north[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    double pixel[2];
    project(&camera, north, pixel);
    assert_true(pixel[0] == 640 && pixel[1] < 360);
}

TEST(test_failures_leave_the_camera_alone) {
    ewa_camera camera = default_camera();
    const ewa_camera before = camera;
    const double zero[3] = {0, 0, 0}, up[3] = {0, 1, 0}, ahead[3] = {0, 0, 1}, broken[3] = {NAN, 0, 0};
    const double far_away[3] = {1.7e308, 1.7e308, 1.7e308};
    assert_int_equal(ewa_camera_look_at(&camera, zero, zero, up), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_look_at(&camera, broken, zero, up), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_look_at(&camera, zero, broken, up), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_look_at(&camera, zero, ahead, broken), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_look_at(&camera, far_away, zero, up), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_set_fov(&camera, 0), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_camera_set_fov(&camera, 180), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_camera_set_fov(&camera, NAN), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_camera_set_fov(&camera, 1e-320), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_set_ortho(&camera, -1), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_camera_set_ortho(&camera, 1e-320), EWA_ERROR_NUMERIC);
    const ewa_bounds box = {{-1, -1, -1}, {1, 1, 1}, 8}, empty = {{INFINITY, 0, 0}, {-INFINITY, 0, 0}, 0};
    const ewa_bounds endless = {{-INFINITY, 0, 0}, {INFINITY, 1, 1}, 8};
    assert_int_equal(ewa_camera_frame(&camera, &empty, ahead, up, 0.05), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_frame(&camera, &endless, ahead, up, 0.05), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_frame(&camera, &box, zero, up, 0.05), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_frame(&camera, &box, ahead, up, 0.5), EWA_ERROR_ARGUMENT);
    assert_memory_equal(&camera, &before, sizeof camera);
}

TEST(test_ortho_shows_its_height) {
    ewa_camera camera = default_camera();
    assert_int_equal(ewa_camera_set_ortho(&camera, 4), EWA_OK);
    double pixel[2];
    const double bottom[3] = {0, 2, 100};
    project(&camera, bottom, pixel);
    assert_true(pixel[0] == 640 && pixel[1] == 720);
}

/// Frames a box and checks that all corners are inside the margin, that the fit is tight, and that the middle
/// of the box is in the middle of the picture.
static void check_frame(ewa_camera camera, const ewa_bounds *box, const double direction[3],
                        const double up[3], double margin, bool has_volume) {
    assert_int_equal(ewa_camera_frame(&camera, box, direction, up, margin), EWA_OK);
    const double sides[2] = {camera.width_px, camera.height_px};
    double tightest = INFINITY, nearest = INFINITY, diagonal = 0, middle[3], pixel[2];
    for (int corner = 0; corner < 8; corner++) {
        double w[3];
        for (int i = 0; i < 3; i++) w[i] = corner >> i & 1 ? box->high_world[i] : box->low_world[i];
        const double depth = project(&camera, w, pixel);
        assert_true(depth > 0);
        nearest = fmin(nearest, depth);
        for (int a = 0; a < 2; a++) {
            const double slack = fmin(pixel[a] - margin * sides[a], (1 - margin) * sides[a] - pixel[a]);
            if (!(slack >= 0))
                fail_msg("corner %d at %.12g is beyond the margin by %g", corner, pixel[a], -slack);
            tightest = fmin(tightest, slack / sides[a]);
        }
    }
    for (int i = 0; i < 3; i++) diagonal += pow(box->high_world[i] - box->low_world[i], 2);
    // A very wide view is held back by the smallest distance to the eye, not by the sides of the picture.
    const bool touches = camera.projection == EWA_ORTHOGRAPHIC || nearest > 0.011 * sqrt(diagonal);
    if (has_volume && touches && !(tightest < 1e-5)) fail_msg("a margin of %g is left over", tightest);
    for (int i = 0; i < 3; i++) middle[i] = 0.5 * (box->low_world[i] + box->high_world[i]);
    project(&camera, middle, pixel);
    assert_near(pixel[0], 0.5 * sides[0], 1e-2);
    assert_near(pixel[1], 0.5 * sides[1], 1e-2);
}

TEST(test_frame_random_boxes) {
    check_random random = {11};
    for (int round = 0; round < 4000; round++) {
        ewa_camera camera = default_camera();
        camera.width_px = 1 + (uint32_t)check_uniform(&random, 1, 3000);
        camera.height_px = 1 + (uint32_t)check_uniform(&random, 1, 3000);
        if (round % 2)
            ewa_camera_set_ortho(&camera, 1);
        else
            ewa_camera_set_fov(&camera, check_uniform(&random, 5, 150));
        camera.fx_px *= check_uniform(&random, 0.5, 2);
        camera.cx_px += camera.width_px * check_uniform(&random, -1, 1); // may lie outside the picture
        camera.cy_px += camera.height_px * check_uniform(&random, -1, 1);
        ewa_bounds box = {.finite_count = 8};
        double direction[3], up[3];
        for (int i = 0; i < 3; i++) {
            const double offset = round % 3 ? 0 : 4.6e6, size = pow(10, check_uniform(&random, 0, 2));
            box.low_world[i] = offset + check_uniform(&random, -100, 100);
            box.high_world[i] = box.low_world[i] + (round % 11 == i ? 0 : size);
            direction[i] = check_uniform(&random, -1, 1);
            up[i] = check_uniform(&random, -1, 1);
        }
        check_frame(camera, &box, direction, up, check_uniform(&random, 0, 0.3), true);
    }
}

TEST(test_frame_degenerate_boxes) {
    const double directions[3][3] = {{0, 0, 1}, {1, 0, 0}, {0.3, -0.5, 0.8}}, up[3] = {0, -1, 0};
    const ewa_bounds boxes[] = {
        {{5e5, 5.4e6, 100}, {5e5, 5.4e6, 100}, 1}, // a point
        {{0, 0, -3}, {0, 0, 4}, 2},                // a segment, seen from its end too
        {{0, 0, 0}, {10, 10, 0}, 4},               // a plane, seen edge-on too
        {{5e5, 5.4e6, 0}, {5e5 + 1e-3, 5.4e6, 0}, 2},
    };
    for (size_t b = 0; b < sizeof boxes / sizeof boxes[0]; b++) {
        for (int d = 0; d < 3; d++) {
            ewa_camera camera = default_camera();
            check_frame(camera, &boxes[b], directions[d], up, 0.05, false);
            ewa_camera_set_ortho(&camera, 1);
            check_frame(camera, &boxes[b], directions[d], up, 0.05, false);
        }
    }
}

TEST(test_frame_of_a_point_is_of_size_one) {
    ewa_camera camera = default_camera();
    ewa_camera_set_ortho(&camera, 77);
    const ewa_bounds point = {{3, 4, 5}, {3, 4, 5}, 1};
    const double ahead[3] = {0, 0, 1}, up[3] = {0, -1, 0};
    assert_int_equal(ewa_camera_frame(&camera, &point, ahead, up, 0), EWA_OK);
    assert_near(camera.height_px / camera.fy_px, 1, 1e-9);
}

TEST(test_resize_scales_pixels) {
    check_random random = {6};
    for (int round = 0; round < 200; round++) {
        ewa_camera camera = check_camera(640, 480);
        assert_int_equal(round % 2 ? ewa_camera_set_ortho(&camera, 4) : ewa_camera_set_fov(&camera, 40), EWA_OK);
        camera.cx_px += check_uniform(&random, -100, 100);
        camera.cy_px += check_uniform(&random, -100, 100);
        camera.fx_px *= 1.25;
        const double point[3] = {check_uniform(&random, -1, 1), check_uniform(&random, -1, 1), 3};
        double old[2], now[2];
        project(&camera, point, old);
        const ewa_camera before = camera;
        for (int keeps = EWA_RESIZE_STRETCH; keeps <= EWA_RESIZE_HEIGHT; keeps++) {
            ewa_camera_resize(&camera, keeps, 1920, 960);
            assert_int_equal(camera.width_px, 1920);
            assert_int_equal(camera.height_px, 960);
            project(&camera, point, now);
            assert_near(now[1], 2 * old[1], 1e-9);
            assert_near(now[0], keeps == EWA_RESIZE_STRETCH ? 3 * old[0] : 960 + 2 * (old[0] - 320), 1e-9);
            ewa_camera_resize(&camera, keeps, 640, 480);
            assert_near(camera.fx_px, before.fx_px, 1e-12 * before.fx_px);
            assert_near(camera.cx_px, before.cx_px, 1e-9);
        }
    }
    ewa_camera middle = default_camera(); // the middle stays the middle to the last bit
    ewa_camera_resize(&middle, EWA_RESIZE_STRETCH, 641, 487);
    assert_true(middle.cx_px == 320.5 && middle.cy_px == 243.5);
    ewa_camera_resize(NULL, EWA_RESIZE_STRETCH, 1, 1);
}

TEST_LOGGED(test_check_names_the_member, 1) {
    const ewa_camera good = default_camera();
    ewa_camera camera = good;
    for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= 250; // a scale is allowed
    assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
    assert_int_equal(log->count, 0);
    const struct {
        size_t offset;
        double value;
        const char *name;
    } cases[] = {
        {offsetof(ewa_camera, fx_px), 0, "fx_px"},
        {offsetof(ewa_camera, fy_px), NAN, "fy_px"},
        {offsetof(ewa_camera, cx_px), INFINITY, "cx_px"},
        {offsetof(ewa_camera, cy_px), NAN, "cy_px"},
        {offsetof(ewa_camera, world_to_camera[7]), NAN, "world_to_camera[7]"},
        {offsetof(ewa_camera, world_to_camera[12]), 1, "last row"},
        {offsetof(ewa_camera, world_to_camera[15]), 2, "last row"},
        {offsetof(ewa_camera, world_to_camera[5]), 1.001, "not a rotation"},
        {offsetof(ewa_camera, world_to_camera[1]), 0.01, "not a rotation"},
        {offsetof(ewa_camera, world_to_camera[0]), -1, "mirrors"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        camera = good;
        memcpy((char *)&camera + cases[i].offset, &cases[i].value, sizeof(double));
        assert_int_equal(ewa_camera_check(context, &camera), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, cases[i].name));
    }
    camera = good;
    camera.width_px = 65537;
    assert_int_equal(ewa_camera_check(context, &camera), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "width_px"));
    camera = good;
    memset(camera.world_to_camera, 0, 12 * sizeof(double));
    assert_int_equal(ewa_camera_check(context, &camera), EWA_ERROR_ARGUMENT);
    memset(&camera, 0, sizeof camera); // never initialised
    assert_int_equal(ewa_camera_check(context, &camera), EWA_ERROR_ARGUMENT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
