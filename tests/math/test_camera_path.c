// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/homogeneous/camera_path.c: orbits and paths through keys.
#include "check.h"
#include "math/angle.h"

#include <float.h>
#include <math.h>
#include <string.h>

static ewa_context *context;

static int enter(void **state) {
    context = check_context(1, NULL);
    return context ? 0 : -1;
}

static int leave(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, not %.17g within %g", value, expected, tolerance);
}

static ewa_camera look(double x, double y, double z, double target_x, double target_y, double target_z) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    const double eye[3] = {x, y, z}, target[3] = {target_x, target_y, target_z}, up[3] = {0, 0, 1};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    return camera;
}

/// Keys on a circle of radius 5 at height 2, looking at the origin.
static void circle(ewa_camera *keys, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double angle = 2 * EWA_PI * (double)i / (double)count;
        keys[i] = look(5 * cos(angle), 5 * sin(angle), 2, 0, 0, 0);
    }
}

static ewa_camera_path *make(const ewa_camera *keys, size_t count, bool closed) {
    ewa_camera_path *path = NULL;
    assert_int_equal(ewa_camera_path_create(context, keys, count, closed, &path), EWA_OK);
    return path;
}

/// Angle in degrees of the turn from one camera to another.
static double turn_deg(const ewa_camera *a, const ewa_camera *b) {
    double square = 0; // of the chord between the rotations: 8 sin^2(turn / 2)
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const double d = a->world_to_camera[4 * r + c] - b->world_to_camera[4 * r + c];
            square += d * d;
        }
    return 2 * asin(fmin(1, sqrt(square / 8))) * 180 / EWA_PI;
}

TEST(test_functions) {
    for (int i = 0; i <= 100000; i++) {
        const double angle = i * (EWA_PI / 100000), slope = tan(0.5 * angle);
        double sine, cosine;
        ewa_sin_cos(angle, &sine, &cosine);
        assert_near(sine, sin(angle), 4 * DBL_EPSILON);
        assert_near(cosine, cos(angle), 4 * DBL_EPSILON);
        if (slope >= 0) assert_near(ewa_atan(slope), atan(slope), 4 * DBL_EPSILON * fmax(atan(slope), 1e-3));
    }
    assert_near(ewa_atan(INFINITY), EWA_PI / 2, DBL_EPSILON);
}

TEST(test_keys) {
    ewa_camera keys[7];
    check_random random = {5};
    for (int i = 0; i < 7; i++) {
        double eye[3];
        check_uniform3(&random, -9, 9, eye);
        keys[i] = look(eye[0] + 5e6, eye[1], eye[2], 5e6, 0, 0.1);
        keys[i].fx_px += 10 * i;
        for (int k = 0; k < 12; k++) keys[i].world_to_camera[k] *= 1 + 0.1 * i;
    }
    for (int closed = 0; closed < 2; closed++) {
        OWNED(ewa_camera_path_destroy) ewa_camera_path *path = make(keys, 7, closed);
        ewa_camera camera, near;
        for (int i = 0; i < 7; i++) {
            assert_int_equal(ewa_camera_path_at(path, i, &camera), EWA_OK);
            assert_memory_equal(&camera, &keys[i], sizeof camera);
            // Next to a key, on either side, the path is next to it.
            for (int side = -1; side <= 1; side += 2) {
                assert_int_equal(ewa_camera_path_at(path, i + side * 1e-7, &near), EWA_OK);
                assert_int_equal(ewa_camera_check(context, &near), EWA_OK);
                double eye[3], key_eye[3];
                ewa_camera_eye(&near, eye);
                ewa_camera_eye(&keys[i], key_eye);
                for (int c = 0; c < 3; c++) assert_near(eye[c], key_eye[c], 1e-5);
            }
        }
        assert_int_equal(ewa_camera_path_at(path, 7, &camera), EWA_OK);
        assert_memory_equal(&camera, &keys[closed ? 0 : 6], sizeof camera);
        assert_int_equal(ewa_camera_path_at(path, -INFINITY, &camera), EWA_OK);
        assert_memory_equal(&camera, &keys[0], sizeof camera);
        assert_int_equal(ewa_camera_path_at(path, NAN, &camera), EWA_ERROR_ARGUMENT);
        ewa_camera_path_at(path, 2.25, &camera);
        assert_near(camera.fx_px, 0.75 * keys[2].fx_px + 0.25 * keys[3].fx_px, 1e-9);
    }
}

/// Half a turn about each axis, of which the quaternion has one number that is not zero: keys are met.
TEST(test_half_turns) {
    for (int axis = 0; axis < 3; axis++) {
        ewa_camera keys[2];
        for (int k = 0; k < 2; k++) ewa_camera_init(&keys[k]);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) keys[1].world_to_camera[4 * r + c] = r != c ? 0 : r == axis ? 1 : -1;
        ewa_camera_path *path = make(keys, 2, false);
        ewa_camera camera;
        assert_int_equal(ewa_camera_path_at(path, 1, &camera), EWA_OK);
        assert_near(turn_deg(&camera, &keys[1]), 0, 1e-6);
        assert_int_equal(ewa_camera_path_at(path, 0.5, &camera), EWA_OK);
        assert_near(turn_deg(&camera, &keys[0]), 90, 1e-6);
        ewa_camera_path_destroy(&path);
    }
}

/// On a circle, the rotation turns at one speed to rounding; the eye stays within 3 % (4 keys), 0.2 % (8
/// keys) of the radius, and its angular speed within 7 % and 0.5 % of its mean.
TEST(test_circle) {
    static const struct {
        size_t count;
        double radius, speed;
    } cases[] = {{4, 0.03, 0.07}, {8, 0.002, 0.005}, {24, 2e-5, 5e-5}};
    for (size_t k = 0; k < 3; k++) {
        ewa_camera keys[24];
        circle(keys, cases[k].count);
        OWNED(ewa_camera_path_destroy) ewa_camera_path *path = make(keys, cases[k].count, true);
        ewa_camera last = keys[0], camera;
        double last_eye[3] = {5, 0, 2}, eye[3];
        for (int i = 1; i <= 360; i++) {
            assert_int_equal(ewa_camera_path_at(path, i / 360.0 * (double)cases[k].count, &camera), EWA_OK);
            ewa_camera_eye(&camera, eye);
            assert_near(turn_deg(&last, &camera), 1, 1e-9);
            assert_near(hypot(eye[0], eye[1]) / 5, 1, cases[k].radius);
            assert_near(eye[2], 2, 1e-12);
            const double cross = last_eye[0] * eye[1] - last_eye[1] * eye[0];
            const double dot = last_eye[0] * eye[0] + last_eye[1] * eye[1];
            assert_near(atan2(cross, dot) * 180 / EWA_PI, 1, cases[k].speed);
            last = camera;
            memcpy(last_eye, eye, sizeof eye);
        }
    }
}

/// Through uneven keys, the turn's speed and the eye's speed and acceleration go on without a jump.
TEST(test_smooth) {
    enum { KEYS = 6 };
    ewa_camera keys[KEYS], frames[5];
    check_random random = {11};
    for (int i = 0; i < KEYS; i++) {
        const double y = check_uniform(&random, -1, 1), x = check_uniform(&random, -1, 1);
        double eye[3];
        check_uniform3(&random, -9, 9, eye);
        keys[i] = look(eye[0], eye[1], eye[2], x, y, 0);
    }
    for (int closed = 0; closed < 2; closed++) {
        OWNED(ewa_camera_path_destroy) ewa_camera_path *path = make(keys, KEYS, closed);
        for (int i = 1; i < KEYS - 1 + closed; i++) {
            const double step = 1e-3;
            double eyes[5][3];
            for (int k = 0; k < 5; k++) {
                assert_int_equal(ewa_camera_path_at(path, i + (k - 2) * step, &frames[k]), EWA_OK);
                ewa_camera_eye(&frames[k], eyes[k]);
            }
            for (int c = 0; c < 3; c++) {
                const double before = eyes[2][c] - eyes[1][c], after = eyes[3][c] - eyes[2][c];
                assert_near(after / step, before / step, 0.2);
                assert_near((eyes[4][c] - 2 * eyes[3][c] + eyes[2][c]) / (step * step),
                            (eyes[2][c] - 2 * eyes[1][c] + eyes[0][c]) / (step * step), 0.5);
            }
            // Steps of the rotation before and after the key, as matrices.
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++) {
                    double before = 0, after = 0;
                    for (int k = 0; k < 3; k++) {
                        before += frames[2].world_to_camera[4 * r + k] * frames[1].world_to_camera[4 * c + k];
                        after += frames[3].world_to_camera[4 * r + k] * frames[2].world_to_camera[4 * c + k];
                    }
                    assert_near(after / step, before / step, 0.02);
                }
        }
    }
}

/// A loop over the pole, whose quaternions come with either sign: no step is much longer than the mean.
TEST(test_pole) {
    enum { KEYS = 12, FRAMES = 600 };
    ewa_camera keys[KEYS];
    for (int i = 0; i < KEYS; i++) {
        // Carried about the y axis through both poles, twice round.
        keys[i] = look(5, 0, 0, 0, 0, 0);
        const double pivot[3] = {0}, axis[3] = {0, 1, 0};
        assert_int_equal(ewa_camera_orbit(&keys[i], pivot, axis, 720.0 * i / KEYS), EWA_OK);
    }
    OWNED(ewa_camera_path_destroy) ewa_camera_path *path = make(keys, KEYS, true);
    ewa_camera last = keys[0], camera;
    for (int i = 1; i <= FRAMES; i++) {
        assert_int_equal(ewa_camera_path_at(path, i * (double)KEYS / FRAMES, &camera), EWA_OK);
        assert_near(turn_deg(&last, &camera), 720.0 / FRAMES, 1e-9);
        last = camera;
    }
}

/// Few and odd keys: a straight line at even speed, one key, twice the same key, opposite directions.
TEST(test_few) {
    ewa_camera camera, keys[3] = {look(0, 0, 0, 1, 0, 0), look(2, 4, 6, 3, 4, 6), look(2, 4, 6, 3, 4, 6)};
    OWNED(ewa_camera_path_destroy) ewa_camera_path *path = make(keys, 2, false);
    double eye[3];
    assert_int_equal(ewa_camera_path_at(path, 0.25, &camera), EWA_OK);
    ewa_camera_eye(&camera, eye);
    for (int c = 0; c < 3; c++) assert_near(eye[c], 0.5 * (c + 1), 1e-12);
    ewa_camera_path_destroy(&path);
    for (int closed = 0; closed < 2; closed++) {
        path = make(keys, 1, closed);
        assert_int_equal(ewa_camera_path_at(path, 0.5, &camera), EWA_OK);
        ewa_camera_eye(&camera, eye);
        for (int c = 0; c < 3; c++) assert_near(eye[c], 0, 1e-12);
        ewa_camera_path_destroy(&path);
        path = make(keys + 1, 2, closed);
        assert_int_equal(ewa_camera_path_at(path, 0.5, &camera), EWA_OK);
        assert_near(turn_deg(&camera, &keys[1]), 0, 1e-9);
        ewa_camera_path_destroy(&path);
    }
    keys[1] = look(0, 0, 0, -1, 0, 0);
    path = make(keys, 2, false);
    for (int i = 0; i <= 16; i++) {
        assert_int_equal(ewa_camera_path_at(path, i / 16.0, &camera), EWA_OK);
        assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
    }
}

TEST(test_refused) {
    OWNED(ewa_camera_path_destroy) ewa_camera_path *path = NULL;
    ewa_camera keys[2] = {look(0, 0, 0, 1, 0, 0), look(2, 4, 6, 3, 4, 6)};
    assert_int_equal(ewa_camera_path_create(context, keys, 0, false, &path), EWA_ERROR_ARGUMENT);
    keys[1].width_px = 99;
    assert_int_equal(ewa_camera_path_create(context, keys, 2, false, &path), EWA_ERROR_ARGUMENT);
    keys[1] = keys[0];
    keys[1].projection = EWA_ORTHOGRAPHIC;
    assert_int_equal(ewa_camera_path_create(context, keys, 2, false, &path), EWA_ERROR_ARGUMENT);
    keys[1] = keys[0];
    keys[1].world_to_camera[0] = NAN;
    assert_int_equal(ewa_camera_path_create(context, keys, 2, false, &path), EWA_ERROR_ARGUMENT);
    assert_null(path);
}

TEST(test_orbit) {
    ewa_camera camera = look(7, 1, 1, 1, 1, 1);
    const double pivot[3] = {1, 1, 0}, axis[3] = {0, 0, 3}, none[3] = {0, 0, 0};
    double eye[3];
    assert_int_equal(ewa_camera_orbit(&camera, pivot, axis, 90), EWA_OK);
    ewa_camera_eye(&camera, eye);
    assert_true(eye[0] == 1 && eye[1] == 7 && eye[2] == 1);
    assert_true(camera.world_to_camera[9] == -1); // looks along -y
    assert_int_equal(ewa_camera_orbit(&camera, pivot, axis, -450), EWA_OK);
    ewa_camera_eye(&camera, eye);
    assert_true(eye[0] == 7 && eye[1] == 1 && eye[2] == 1);
    const ewa_camera before = camera;
    for (int i = 0; i < 36; i++) {
        assert_int_equal(ewa_camera_orbit(&camera, pivot, axis, 10), EWA_OK);
        ewa_camera_eye(&camera, eye);
        const double angle = (i + 1) * EWA_PI / 18;
        assert_near(eye[0], 1 + 6 * cos(angle), 1e-13);
        assert_near(eye[1], 1 + 6 * sin(angle), 1e-13);
        assert_int_equal(ewa_camera_check(context, &camera), EWA_OK);
    }
    for (int k = 0; k < 16; k++) assert_near(camera.world_to_camera[k], before.world_to_camera[k], 1e-13);
    // By half a degree there and back.
    for (int sign = 1; sign >= -1; sign -= 2) {
        assert_int_equal(ewa_camera_orbit(&camera, pivot, axis, 0.5 * sign), EWA_OK);
        ewa_camera_eye(&camera, eye);
        assert_near(eye[1], sign > 0 ? 1 + 6 * sin(EWA_PI / 360) : 1, 1e-13);
    }
    assert_int_equal(ewa_camera_orbit(&camera, pivot, none, 1), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_camera_orbit(&camera, pivot, axis, NAN), EWA_ERROR_NUMERIC);
}

int main(void) { return RUN_TESTS(enter, leave); }
