// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A surface of surfels as a solid, near its edges: roofs of two planes are told from bent surfaces by the
// angle between their normals.
#include "check_prepare.h"
#include "edges/solid.h"

#include <math.h>

enum { SIDE = 24, COUNT = 2 * SIDE * SIDE };

static const double STEP = 0.05;

/// Two planes that meet in the y axis, whose normals are (-sin, 0, cos) and (sin, 0, cos) of half their
/// angle.
static ewa_cloud *make_roof(ewa_context *context, double half_angle) {
    float *position, *normal, *radius;
    ewa_cloud *cloud = check_cloud(context, COUNT, &position);
    assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, (void **)&normal), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, (void **)&radius), EWA_OK);
    for (int i = 0; i < COUNT; i++) {
        const int side = i % 2 ? 1 : -1, column = i / 2 % SIDE, row = i / 2 / SIDE;
        const double along = side * (column + 0.5) * STEP;
        position[3 * i] = (float)(along * cos(half_angle));
        position[3 * i + 1] = (float)((row - SIDE / 2) * STEP);
        position[3 * i + 2] = (float)(-fabs(along) * sin(half_angle));
        normal[3 * i] = (float)(side * sin(half_angle));
        normal[3 * i + 1] = 0;
        normal[3 * i + 2] = (float)cos(half_angle);
        radius[i] = (float)STEP;
    }
    return cloud;
}

/// What there is to see from a place above the ridge: one bent surface up to 37 degrees, from there on two
/// planes, each with its own normal and distance.
TEST_ON(test_roofs, 1) {
    static const double origin[3] = {0, 0, 0};
    static const double degrees[] = {10, 30, 45, 55, 80, 120};
    for (int k = 0; k < 6; k++) {
        const double half = degrees[k] * acos(-1) / 360;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_roof(context, half);
        OWNED(ewa_solid_close) ewa_solid solid;
        assert_int_equal(ewa_solid_open(cloud, "roof", origin, 3, &solid), EWA_OK);
        const ewa_vec3 place = vec3_make(0.3 * STEP, 0.26 * STEP, 0.4 * STEP);
        ewa_local_surface surface;
        ewa_solid_look(&solid, place, &surface);
        if (degrees[k] < 37) {
            assert_int_equal(surface.plane_count, 1);
            assert_true(surface.normal[0].z > 0.99);
        } else {
            assert_int_equal(surface.plane_count, 2);
            assert_true(surface.convex);
            for (int n = 0; n < 2; n++) {
                const double side = surface.normal[n].x > 0 ? 1 : -1;
                assert_float_equal(surface.normal[n].x, side * sin(half), 1e-6);
                assert_float_equal(surface.normal[n].z, cos(half), 1e-6);
                assert_float_equal(surface.distance[n], side * sin(half) * place.x + cos(half) * place.z,
                                   1e-6);
            }
            assert_true(surface.normal[0].x > 0 && surface.normal[1].x < 0);
        }
    }
}

/// Either of two clip lines may leave a place in, where the mode is 1; of a single one there is no either.
TEST_ON(test_lines, 1) {
    enum { CASES = 4 };
    static const double origin[3] = {0, 0, 0};
    static const float lines[2][3 * CASES] = {{1, 0, 0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 0, 0, 1},
                                              {0, 1, 0.25f, 0, 1, 0.25f, 0, 0, 0, NAN, 1, 0}};
    static const uint8_t modes[CASES] = {0, 1, 1, 1};
    static const uint32_t counts[CASES] = {2, 2, 1, 0};
    float *position, *axis[2];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud(context, CASES, &position);
    assert_int_equal(ewa_cloud_add(cloud, EWA_TANGENT_U, EWA_F32, 3, (void **)&axis[0]), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_TANGENT_V, EWA_F32, 3, (void **)&axis[1]), EWA_OK);
    for (int i = 0; i < CASES; i++)
        for (int c = 0; c < 3; c++) {
            position[3 * i + c] = c == 0 ? (float)i : 0;
            for (int k = 0; k < 2; k++) axis[k][3 * i + c] = c == k ? 0.1f : 0;
        }
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_CLIP0, EWA_F32, 3, lines[0], 3 * sizeof(float)), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_CLIP1, EWA_F32, 3, lines[1], 3 * sizeof(float)), EWA_OK);
    assert_int_equal(ewa_cloud_borrow(cloud, EWA_CLIP_MODE, EWA_U8, 1, modes, 1), EWA_OK);
    OWNED(ewa_solid_close) ewa_solid solid;
    assert_int_equal(ewa_solid_open(cloud, "lines", origin, 3, &solid), EWA_OK);
    assert_int_equal(solid.count, CASES);
    for (uint32_t s = 0; s < CASES; s++) {
        ewa_vec3 found[2];
        bool either;
        const uint32_t point = solid.surfels[s].point;
        assert_int_equal(ewa_solid_lines(&solid, s, found, &either), counts[point]);
        assert_int_equal(either, point == 1);
        if (counts[point]) assert_true(found[0].x == 1 && found[0].z == 0.5);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
