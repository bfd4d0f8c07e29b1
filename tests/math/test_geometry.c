// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Join, meet, incidence, duality, coordinates in a triangle, Plücker lines: properties on random and
// degenerate input.
#include <fenv.h>

#include "math/box.h"
#include "math/check_math.h"
#include "math/degree.h"

enum { ROUNDS = 2000 };

#define SMALL 1e-14

TEST(test_plane_duality) {
    check_random random = {1};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_vec3 p = check_random_vec3(&random), q = check_random_vec3(&random), k, l, r;
        if (i % 4 == 1) p.z = 0; // a direction
        if (i % 4 == 2) p.z = q.z = 0;
        assert_int_equal(ewa_line2_join(p, q, &l), EWA_OK);
        check_near(ewa_incidence2(p, l), 0, SMALL);
        check_near(ewa_incidence2(q, l), 0, SMALL);
        if (i % 4 == 2)
            check_same(&l, (&(ewa_vec3){0, 0, 1}), 3, SMALL); // two directions: the line at infinity
        assert_int_equal(ewa_line2_meet(p, q, &r), EWA_OK);
        check_numbers(&r, &l, 3, 0); // the same numbers as lines: duality
        ewa_vec3 other = check_random_vec3(&random);
        assert_int_equal(ewa_line2_join(p, other, &k), EWA_OK);
        assert_int_equal(ewa_line2_meet(k, l, &r), EWA_OK); // two lines through p meet in p
        check_same(&r, &p, 3, 1e-9);
    }
}

TEST(test_space_duality) {
    check_random random = {2};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_vec4 p = check_random_vec4(&random), q = check_random_vec4(&random),
                 r = check_random_vec4(&random);
        if (i % 4 == 1) p.w = 0;
        if (i % 4 == 2) p.w = q.w = r.w = 0;
        ewa_vec4 plane, point;
        assert_int_equal(ewa_plane_join(p, q, r, &plane), EWA_OK);
        check_near(ewa_incidence3(p, plane), 0, SMALL);
        check_near(ewa_incidence3(q, plane), 0, SMALL);
        check_near(ewa_incidence3(r, plane), 0, SMALL);
        if (i % 4 == 2) check_same(&plane, (&(ewa_vec4){0, 0, 0, 1}), 4, SMALL);
        assert_int_equal(ewa_plane_meet(p, q, r, &point), EWA_OK);
        check_same(&point, &plane, 4, SMALL);
    }
    ewa_vec4 plane;
    assert_int_equal(
        ewa_plane_join(vec4_make(0, 0, 5, 1), vec4_make(1, 0, 5, 1), vec4_make(0, 1, 5, 1), &plane), EWA_OK);
    check_vec4(plane, 0, 0, 1, -5, 0); // the normal is (q - p) x (r - p)
}

static ewa_vec4 check_whole_vec4(check_random *random) {
    ewa_vec4 v = vec4_scale(check_random_vec4(random), 9);
    return vec4_make(rint(v.x), rint(v.y), rint(v.z), rint(v.w));
}

/// A line of space from two points and as the meet of two planes through them; meets and joins with planes
/// and points.
TEST(test_plucker_lines) {
    check_random random = {3};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_vec4 p = check_random_vec4(&random), q = check_random_vec4(&random),
                 r = check_random_vec4(&random);
        ewa_vec4 s = check_random_vec4(&random), a, b, c, point;
        if (i % 4 == 1) p.w = 0;
        if (i % 4 == 2) p.w = q.w = 0;
        ewa_line3 line, met, other;
        assert_int_equal(ewa_line3_join(p, q, &line), EWA_OK);
        check_near(vec3_dot(line.direction, line.moment), 0, SMALL);
        assert_int_equal(ewa_plane_join(p, q, r, &a), EWA_OK);
        assert_int_equal(ewa_plane_join(p, q, s, &b), EWA_OK);
        assert_int_equal(ewa_line3_meet(a, b, &met), EWA_OK);
        check_same(&met, &line, 6, 1e-9);
        check_near(vec3_dot(met.direction, met.moment), 0, SMALL);

        assert_int_equal(ewa_line3_join_point(line, r, &c), EWA_OK);
        check_same(&c, &a, 4, 1e-12);
        assert_true(vec4_dot(c, a) > 0); // and the same side
        check_near(ewa_incidence3(p, c), 0, SMALL);
        assert_int_equal(ewa_line3_meet_plane(line, s, &point), EWA_OK); // s taken as a plane
        check_near(ewa_incidence3(point, s), 0, 10 * SMALL);
        check_near(ewa_incidence3(point, a), 0, 10 * SMALL);
        check_near(ewa_incidence3(point, b), 0, 10 * SMALL);
        if (i % 4 == 2) check_near(point.w, 0, SMALL); // a line at infinity meets planes in directions

        assert_int_equal(ewa_line3_join(p, r, &other), EWA_OK); // shares p
        check_near(ewa_line3_incidence(line, other), 0, SMALL);
        assert_int_equal(ewa_line3_join(r, s, &other), EWA_OK);
        ewa_mat4 rows = mat4_from_rows(p, q, r, s), inverse;
        bool skew = ewa_mat4_invert(&rows, &inverse) == EWA_OK;
        assert_true(skew == (fabs(ewa_line3_incidence(line, other)) > SMALL));
    }
    for (int i = 0; i < ROUNDS;
         i++) { // on whole numbers every product is exact, and so is what does not exist
        ewa_vec4 p = check_whole_vec4(&random), q = check_whole_vec4(&random), r = check_whole_vec4(&random);
        ewa_vec4 plane, result;
        ewa_line3 line;
        if (ewa_plane_join(p, q, r, &plane) != EWA_OK) continue; // chance made them collinear
        assert_int_equal(ewa_line3_join(p, q, &line), EWA_OK);
        assert_int_equal(ewa_line3_join_point(line, q, &result), EWA_ERROR_NUMERIC); // q is on the line
        assert_int_equal(ewa_line3_meet_plane(line, plane, &result),
                         EWA_ERROR_NUMERIC); // the line is in the plane
    }
    // Parallel lines and planes.
    ewa_line3 k, l;
    assert_int_equal(ewa_line3_join(vec4_make(0, 0, 0, 1), vec4_make(1, 2, 3, 0), &k), EWA_OK);
    assert_int_equal(ewa_line3_join(vec4_make(5, 0, 0, 1), vec4_make(1, 2, 3, 0), &l), EWA_OK);
    assert_true(ewa_line3_incidence(k, l) == 0);
    assert_int_equal(ewa_line3_meet(vec4_make(0, 0, 1, 0), vec4_make(0, 0, 1, -4), &l), EWA_OK);
    check_vec3(l.direction, 0, 0, 0, 0);
    ewa_vec4 point;
    assert_int_equal(ewa_line3_meet_plane(k, vec4_make(2, -1, 0, 3), &point), EWA_OK);
    assert_true(point.w == 0);
    check_same(&point, (&(ewa_vec4){1, 2, 3, 0}), 4, SMALL);
}

TEST(test_line_transform) {
    check_random random = {4};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_vec4 p = check_random_vec4(&random), q = check_random_vec4(&random);
        ewa_mat4 map = check_random_mat4(&random);
        ewa_line3 line, image, expected;
        assert_int_equal(ewa_line3_join(p, q, &line), EWA_OK);
        image = ewa_line3_transform(line, &map);
        assert_int_equal(
            ewa_line3_join(ewa_point3_transform(p, &map), ewa_point3_transform(q, &map), &expected), EWA_OK);
        check_numbers(&image, &expected, 6, SMALL);
    }
}

TEST(test_distances) {
    double distance;
    assert_int_equal(ewa_line2_distance(vec3_make(3, 4, -10), vec3_make(2, 6, 2), &distance), EWA_OK);
    check_near(distance, (3 * 1 + 4 * 3 - 10) / 5.0, SMALL);
    assert_int_equal(ewa_plane_distance(vec4_make(2, 3, 6, -7), vec4_make(-1, -1, -1, -1), &distance),
                     EWA_OK);
    check_near(distance, 4 / 7.0, SMALL);
    assert_int_equal(ewa_line2_distance(vec3_make(0, 0, 1), vec3_make(1, 2, 1), &distance),
                     EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_line2_distance(vec3_make(1, 0, 1), vec3_make(1, 2, 0), &distance),
                     EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_plane_distance(vec4_make(0, 0, 0, 1), vec4_make(1, 2, 3, 1), &distance),
                     EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_plane_distance(vec4_make(1, 0, 0, 0), vec4_make(1, 2, 3, 0), &distance),
                     EWA_ERROR_NUMERIC);
}

TEST(test_triangle_round_trips) {
    check_random random = {5};
    for (int i = 0; i < ROUNDS; i++) {
        double offset = i % 3 == 1 ? 4e6 : 0; // as far out as map projections go
        ewa_vec3 triangle[3], point = check_random_vec3(&random), back;
        for (int k = 0; k < 3; k++) {
            double w = i % 2 ? 1 : check_uniform(&random, -2, 2); // any representative of the corners
            double x = offset + check_uniform(&random, -1, 1), y = offset + check_uniform(&random, -1, 1);
            triangle[k] = vec3_make(x * w, y * w, w);
        }
        if (i % 5 == 1) point.z = 0;
        double w[3], l[3], xy[3][2];
        ewa_status status = ewa_triangle_barycentric(triangle, point, w);
        assert_int_equal(status, EWA_OK);
        check_near(w[0] + w[1] + w[2], point.z, 1e-9 * (fabs(w[0]) + fabs(w[1]) + fabs(w[2])));
        assert_int_equal(ewa_triangle_point(triangle, w, &back), EWA_OK);
        check_numbers(&back, &point, 3,
                      (1e-12 + 1e-15 * offset) * (1 + fabs(w[0]) + fabs(w[1]) + fabs(w[2])));
        assert_int_equal(ewa_triangle_distances(triangle, point, l), EWA_OK);
        assert_int_equal(ewa_triangle_point_from_distances(triangle, l, &back), EWA_OK);
        check_numbers(&back, &point, 3,
                      (1e-12 + 1e-15 * offset) * (1 + fabs(w[0]) + fabs(w[1]) + fabs(w[2])));
        if (point.z == 0 || offset != 0) continue;
        for (int k = 0; k < 3; k++) assert_int_equal(ewa_point2_divide(triangle[k], xy[k]), EWA_OK);
        for (int k = 0; k < 3; k++) { // distances by the edge lines
            ewa_vec3 a = vec3_make(xy[(k + 1) % 3][0], xy[(k + 1) % 3][1], 1), line;
            ewa_vec3 b = vec3_make(xy[(k + 2) % 3][0], xy[(k + 2) % 3][1], 1);
            double distance, inner;
            assert_int_equal(ewa_line2_join(a, b, &line), EWA_OK);
            assert_int_equal(ewa_line2_distance(line, point, &distance), EWA_OK);
            assert_int_equal(ewa_line2_distance(line, triangle[k], &inner), EWA_OK);
            check_near(l[k] / point.z, inner > 0 ? distance : -distance, 1e-9 * (1 + fabs(distance)));
        }
    }
}

/// What does not exist is a status, exactly and to within rounding.
TEST(test_degenerate) {
    check_random random = {6};
    for (int i = 0; i < ROUNDS; i++) {
        ewa_vec3 p = check_random_vec3(&random), l;
        ewa_vec4 q = check_random_vec4(&random), r = check_random_vec4(&random), plane;
        double k = check_uniform(&random, -3, 3), s = check_uniform(&random, -3, 3);
        ewa_line3 line;
        assert_int_equal(ewa_line2_join(p, vec3_scale(p, k), &l), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line3_join(q, vec4_scale(q, k), &line), EWA_ERROR_NUMERIC);
        ewa_vec4 between = vec4_add(vec4_scale(q, k), vec4_scale(r, s));
        assert_int_equal(ewa_plane_join(q, r, between, &plane), EWA_ERROR_NUMERIC);
    }
    ewa_vec3 flat[3] = {{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}, infinite[3] = {{0, 0, 1}, {1, 1, 1}, {2, 1, 0}},
             line;
    double numbers[3] = {7, 7, 7};
    assert_int_equal(ewa_triangle_barycentric(flat, vec3_make(0, 1, 1), numbers), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_triangle_barycentric(infinite, vec3_make(0, 1, 1), numbers), EWA_ERROR_NUMERIC);
    assert_true(numbers[0] == 7); // outputs are left alone
    // Not degenerate, only far apart in scale: representatives do not matter.
    assert_int_equal(ewa_line2_join(vec3_make(1e-300, 0, 1e-300), vec3_make(0, 1e300, 1e300), &line), EWA_OK);
    check_same(&line, (&(ewa_vec3){1, 1, -1}), 3, SMALL);
}

TEST(test_not_finite) {
    double bad[3] = {NAN, INFINITY, -INFINITY}, xy[3], number;
    for (int i = 0; i < 3; i++) {
        ewa_vec3 v = {1, bad[i], 1}, good = {1, 2, 3}, line;
        ewa_vec4 v4 = {1, 2, bad[i], 1}, good4 = {1, 2, 3, 4}, other4 = {4, 3, 2, 9}, plane;
        ewa_line3 line3, bad_line = {{1, 0, 0}, {0, bad[i], 0}};
        ewa_vec3 triangle[3] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
        assert_int_equal(ewa_point2_divide(v, xy), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_point3_divide(v4, xy), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line2_join(v, good, &line), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line2_meet(good, v, &line), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line2_distance(v, good, &number), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_plane_distance(good4, v4, &number), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_plane_join(good4, other4, v4, &plane), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_plane_meet(v4, other4, good4, &plane), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line3_join(good4, v4, &line3), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line3_meet(v4, good4, &line3), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line3_meet_plane(bad_line, good4, &plane), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_line3_join_point(bad_line, good4, &plane), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_triangle_barycentric(triangle, v, xy), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_triangle_distances(triangle, v, xy), EWA_ERROR_NUMERIC);
        const double bad_weights[3] = {1, bad[i], 0};
        assert_int_equal(ewa_triangle_point(triangle, bad_weights, &line), EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_triangle_point_from_distances(triangle, bad_weights, &line), EWA_ERROR_NUMERIC);
        triangle[i] = v;
        assert_int_equal(ewa_triangle_barycentric(triangle, good, xy), EWA_ERROR_NUMERIC);
    }
}

/// w = 0 everywhere and nothing divides by it.
TEST(test_no_division_by_zero) {
    feclearexcept(FE_ALL_EXCEPT);
    double xy[3];
    ewa_vec3 triangle[3] = {{1, 1, 0}, {0, 1, 0}, {1, 0, 0}}, line, zero = {0, 0, 0};
    ewa_vec4 plane, direction = {1, 2, 3, 0}, none = {0, 0, 0, 0};
    ewa_line3 line3 = {{0, 0, 0}, {1, 2, 3}};
    assert_int_equal(ewa_point2_divide(triangle[0], xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_point3_divide(direction, xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_triangle_barycentric(triangle, zero, xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_triangle_distances(triangle, triangle[0], xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_line2_join(zero, zero, &line), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_line2_distance(zero, zero, xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_plane_join(none, direction, direction, &plane), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_plane_distance(none, direction, xy), EWA_ERROR_NUMERIC);
    assert_int_equal(ewa_line3_meet_plane(line3, vec4_make(0, 0, 1, 5), &plane), EWA_OK);
    assert_true(plane.w == 0);
    assert_int_equal(fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
}

/// A box turned and mirrored by a map is around the map's eight corners, and touches some on each side.
TEST(test_moved_boxes) {
    check_random random = {5};
    for (int i = 0; i < ROUNDS; i++) {
        double map[16] = {[15] = 1}, low[3], high[3], corner_low[3], corner_high[3];
        for (int k = 0; k < 12; k++) map[k] = check_uniform(&random, -2, 2);
        for (int c = 0; c < 3; c++) low[c] = check_uniform(&random, -3, 0), high[c] = low[c] + check_uniform(&random, 0, 2);
        for (int corner = 0; corner < 8; corner++)
            for (int r = 0; r < 3; r++) {
                double at = map[4 * r + 3];
                for (int c = 0; c < 3; c++) at += map[4 * r + c] * (corner >> c & 1 ? high[c] : low[c]);
                corner_low[r] = corner ? fmin(corner_low[r], at) : at;
                corner_high[r] = corner ? fmax(corner_high[r], at) : at;
            }
        ewa_box_transform(map, low, high);
        for (int r = 0; r < 3; r++) {
            check_near(low[r], corner_low[r], SMALL);
            check_near(high[r], corner_high[r], SMALL);
        }
    }
}

/// Lengths of a degree on the ellipsoid of WGS 84, as tables have them to a tenth of a metre.
TEST(test_degrees) {
    static const double lengths_m[][3] = {{0, 111319.5, 110574.3}, {-45, 78846.8, 111131.8}, {60, 55800.0, 111412.2}};
    for (int i = 0; i < 3; i++) {
        double length_m[2];
        ewa_degree_lengths(lengths_m[i][0], length_m);
        for (int k = 0; k < 2; k++) assert_float_equal(length_m[k], lengths_m[i][1 + k], 0.1);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
