// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How cameras move: what is held stays under the hand.
#include "check.h"
#include "viewer/navigate.h"

#include <math.h>

enum { TRIALS = 200 };

static ewa_context *context;

static int make_context(void **state) {
    context = check_context(1, NULL);
    return 0;
}

static int end_context(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

/// Some camera that looks about the origin; every other one is orthographic or has a scale.
static ewa_camera random_camera(check_random *random, int trial) {
    static const double up_world[3] = {0, 0, 1};
    double eye_world[3], target_world[3];
    ewa_camera camera = check_camera(640, 480);
    assert_int_equal(ewa_camera_set_fov(&camera, check_uniform(random, 20, 80)), EWA_OK);
    if (trial & 1) assert_int_equal(ewa_camera_set_ortho(&camera, check_uniform(random, 1, 5)), EWA_OK);
    check_uniform3(random, 3, 9, eye_world);
    check_uniform3(random, -1, 1, target_world);
    assert_int_equal(ewa_camera_look_at(&camera, eye_world, target_world, up_world), EWA_OK);
    for (int i = 0; i < 12 && trial & 2; i++) camera.world_to_camera[i] *= 2.5;
    camera.cx_px += check_uniform(random, -100, 100);
    return camera;
}

static void assert_near(double a, double b, double maximum) {
    if (!(fabs(a - b) <= maximum)) fail_msg("%.12g is not %.12g", a, b);
}

static void assert_place(const ewa_camera *camera, const double point_world[3], double x_px, double y_px) {
    double place_px[2], depth;
    assert_true(navigate_project(camera, point_world, place_px, &depth));
    assert_near(place_px[0], x_px, 1e-6);
    assert_near(place_px[1], y_px, 1e-6);
}

TEST(projects_both_ways) {
    check_random random = {1};
    for (int i = 0; i < TRIALS; i++) {
        const ewa_camera camera = random_camera(&random, i);
        double point[3], back[3], place_px[2], depth;
        check_uniform3(&random, -1, 1, point);
        assert_true(navigate_project(&camera, point, place_px, &depth));
        navigate_unproject(&camera, place_px[0], place_px[1], depth, back);
        for (int c = 0; c < 3; c++) assert_near(back[c], point[c], 1e-9);
        assert_near(navigate_depth(&camera, point), depth, 1e-9);
    }
}

TEST(zoom_keeps_the_point_in_its_place) {
    check_random random = {2};
    for (int i = 0; i < TRIALS; i++) {
        ewa_camera camera = random_camera(&random, i);
        double point[3], place_px[2], depth;
        check_uniform3(&random, -1, 1, point);
        navigate_project(&camera, point, place_px, &depth);
        const double fx_px = camera.fx_px, factor = check_uniform(&random, 0.2, 3);
        navigate_zoom(&camera, point, factor);
        assert_place(&camera, point, place_px[0], place_px[1]);
        if (camera.projection == EWA_PERSPECTIVE)
            assert_near(navigate_depth(&camera, point), depth * factor, 1e-9);
        else
            assert_near(camera.fx_px, fx_px / factor, 1e-9 * fx_px);
    }
}

TEST(pan_moves_the_point_with_the_hand) {
    check_random random = {3};
    for (int i = 0; i < TRIALS; i++) {
        ewa_camera camera = random_camera(&random, i);
        double point[3], place_px[2], depth;
        check_uniform3(&random, -1, 1, point);
        navigate_project(&camera, point, place_px, &depth);
        navigate_pan(&camera, depth, 31, -17);
        assert_place(&camera, point, place_px[0] + 31, place_px[1] - 17);
    }
}

/// How the horizon lies: the world's up has no part along the picture's right.
static double roll(const ewa_camera *camera, const double up_world[3]) {
    const double *m = camera->world_to_camera;
    return (m[0] * up_world[0] + m[1] * up_world[1] + m[2] * up_world[2]) /
           sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
}

TEST(orbit_keeps_pivot_and_horizon) {
    static const double up_world[3] = {0, 0, 1};
    check_random random = {4};
    for (int i = 0; i < TRIALS; i++) {
        ewa_camera camera = random_camera(&random, i);
        double pivot[3], place_px[2], depth;
        check_uniform3(&random, -1, 1, pivot);
        navigate_project(&camera, pivot, place_px, &depth);
        for (int k = 0; k < 20; k++) {
            const double right_deg = check_uniform(&random, -40, 40),
                         down_deg = check_uniform(&random, -40, 40);
            navigate_orbit(&camera, pivot, up_world, right_deg, down_deg);
        }
        assert_near(roll(&camera, up_world), 0, 1e-9);
        assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
        // The pivot keeps its distance from the eye; seen from its own axis it would not move at all.
        double eye_world[3], away2 = 0, before2 = 0, first[3];
        navigate_unproject(&camera, place_px[0], place_px[1], depth, first);
        ewa_camera_eye(&camera, eye_world);
        if (camera.projection == EWA_ORTHOGRAPHIC) continue;
        const double x = (place_px[0] - camera.cx_px) / camera.fx_px,
                     y = (place_px[1] - camera.cy_px) / camera.fy_px;
        const double scale = sqrt(camera.world_to_camera[8] * camera.world_to_camera[8] +
                                  camera.world_to_camera[9] * camera.world_to_camera[9] +
                                  camera.world_to_camera[10] * camera.world_to_camera[10]);
        before2 = depth * depth * (1 + x * x + y * y) / (scale * scale);
        for (int c = 0; c < 3; c++) away2 += (eye_world[c] - pivot[c]) * (eye_world[c] - pivot[c]);
        assert_near(sqrt(away2), sqrt(before2), 1e-8);
    }
}

TEST(orbit_follows_the_hand) {
    static const double up_world[3] = {0, 0, 1}, eye_world[3] = {0, -5, 0}, middle[3] = {0, 0, 0};
    static const double front[3] = {0, -1, 0};
    ewa_camera camera;
    ewa_camera_init(&camera);
    ewa_camera_look_at(&camera, eye_world, middle, up_world);
    double before[2], after[2], depth;
    navigate_project(&camera, front, before, &depth);
    navigate_orbit(&camera, middle, up_world, 10, 0);
    navigate_project(&camera, front, after, &depth);
    assert_true(after[0] > before[0] + 1); // what is in front goes to the right
    navigate_orbit(&camera, middle, up_world, -10, 10);
    navigate_project(&camera, front, after, &depth);
    assert_true(after[1] > before[1] + 1); // and down
}

TEST(turntable_stops_at_the_poles) {
    static const double up_world[3] = {0, 0, 1}, eye_world[3] = {0, -5, 0}, middle[3] = {0, 0, 0};
    ewa_camera camera;
    ewa_camera_init(&camera);
    ewa_camera_look_at(&camera, eye_world, middle, up_world);
    for (int i = 0; i < 50; i++) navigate_orbit(&camera, middle, up_world, 0, 10);
    double eye[3];
    ewa_camera_eye(&camera, eye);
    assert_near(eye[2], 5 * sin(89.5 * 3.14159265358979323846 / 180), 1e-9);
    assert_true(eye[1] < 0);
    for (int i = 0; i < 50; i++) navigate_orbit(&camera, middle, NULL, 0, 10); // the trackball goes on
    ewa_camera_eye(&camera, eye);
    assert_true(fabs(eye[2] - 5) > 0.1);
}

TEST(centers_at_the_same_depth) {
    check_random random = {5};
    for (int i = 0; i < TRIALS; i++) {
        ewa_camera camera = random_camera(&random, i);
        double point[3];
        check_uniform3(&random, -1, 1, point);
        const double depth = navigate_depth(&camera, point);
        navigate_center(&camera, point);
        assert_place(&camera, point, 320, 240);
        assert_near(navigate_depth(&camera, point), depth, 1e-9);
    }
}

TEST(ortho_and_back_keep_the_size_at_a_point) {
    check_random random = {7};
    for (int i = 0; i < TRIALS; i += 2) {
        ewa_camera camera = random_camera(&random, i & ~1);
        double point[3], a[2], b[2], beside[3], depth;
        check_uniform3(&random, -1, 1, point);
        navigate_project(&camera, point, a, &depth);
        navigate_unproject(&camera, a[0] + 10, a[1], depth, beside);
        navigate_set_ortho(&camera, true, point, 30);
        assert_int_equal(camera.projection, EWA_ORTHOGRAPHIC);
        assert_place(&camera, point, a[0], a[1]);
        assert_place(&camera, beside, a[0] + 10, a[1]);
        navigate_set_ortho(&camera, false, point, 30);
        navigate_project(&camera, point, b, &depth);
        assert_place(&camera, beside, b[0] + 10, b[1]);
        assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
    }
}

int main(void) { return RUN_TESTS(make_context, end_context); }
