// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Measurements of squares, right angles and slopes, at the origin and far from it.
#include "check.h"
#include "ewa/measure.h"

#include <math.h>

static const double up[3] = {0, 0, 2};

static ewa_measurement measure(ewa_measure_kind kind, const double *places, uint32_t count) {
    ewa_measurement m;
    assert_int_equal(ewa_places_measure(kind, places, count, up, &m), EWA_OK);
    return m;
}

TEST(test_squares) {
    (void)state;
    for (int far = 0; far < 2; far++) {
        const double x = far ? 500000.25 : 0, y = far ? 4200000.5 : 0, z = far ? 300.125 : 0;
        const double flat[12] = {x, y, z, x + 3, y, z, x + 3, y + 3, z, x, y + 3, z};
        ewa_measurement m = measure(EWA_MEASURE_AREA, flat, 4);
        assert_true(m.area == 9 && m.horizontal_area == 9 && m.length_world == 12 && m.horizontal_world == 12);
        // A roof of 45 degrees: the same map, the root of two times the area; upright, nothing of it is seen from above.
        const double roof[12] = {x, y, z, x + 3, y, z + 3, x + 3, y + 3, z + 3, x, y + 3, z};
        m = measure(EWA_MEASURE_AREA, roof, 4);
        assert_true(fabs(m.area - 9 * sqrt(2)) < 1e-12 && m.horizontal_area == 9);
        const double wall[12] = {x, y, z, x + 3, y, z, x + 3, y, z + 3, x, y, z + 3};
        m = measure(EWA_MEASURE_AREA, wall, 4);
        assert_true(m.area == 9 && m.horizontal_area == 0);
        // An L of 5, whichever corner is the first.
        const double l[18] = {x, y, z, x + 3, y, z, x + 3, y + 1, z, x + 1, y + 1, z, x + 1, y + 3, z, x, y + 3, z};
        double turned[18];
        for (int first = 0; first < 6; first++) {
            for (int i = 0; i < 18; i++) turned[i] = l[(3 * first + i) % 18];
            assert_true(measure(EWA_MEASURE_AREA, turned, 6).area == 5);
        }
    }
}

TEST(test_angles) {
    (void)state;
    const double right[9] = {1, 0, 0, 0, 0, 0, 0, 5, 0}, straight[9] = {1, 1, 1, 2, 2, 2, 4, 4, 4}, sixty[9] = {1, 0, 0, 0, 0, 0, 1, 0, sqrt(3)};
    assert_true(measure(EWA_MEASURE_ANGLE, right, 3).angle_deg == 90);
    assert_true(fabs(measure(EWA_MEASURE_ANGLE, straight, 3).angle_deg - 180) < 1e-12);
    assert_true(fabs(measure(EWA_MEASURE_ANGLE, sixty, 3).angle_deg - 60) < 1e-12);
    const double back[9] = {3, 0, 0, 0, 0, 0, 7, 0, 0};
    assert_true(measure(EWA_MEASURE_ANGLE, back, 3).angle_deg == 0);
}

TEST(test_distances) {
    (void)state;
    const double way[9] = {0, 0, 0, 3, 4, 0, 3, 4, 12}, slope[6] = {0, 0, 5, 3, 4, 0};
    ewa_measurement m = measure(EWA_MEASURE_DISTANCE, way, 3);
    assert_true(m.length_world == 17 && m.horizontal_world == 5 && m.rise_world == 12);
    assert_true(fabs(m.slope_deg - atan2(12, 5) * 180 / 3.14159265358979323846) < 1e-12);
    m = measure(EWA_MEASURE_HEIGHT, slope, 2);
    assert_true(m.rise_world == -5 && m.horizontal_world == 5 && m.slope_deg == -45);
    // Of what is as upright as can be, next to nothing is seen from above.
    const double oblique[3] = {1, 2, 2}, mast[6] = {0.5, 0.25, 7, 0.5 + 100.0 / 3, 0.25 + 200.0 / 3, 7 + 200.0 / 3};
    assert_int_equal(ewa_places_measure(EWA_MEASURE_HEIGHT, mast, 2, oblique, &m), EWA_OK);
    assert_true(fabs(m.rise_world - 100) < 1e-12 && m.horizontal_world < 1e-12 && m.slope_deg > 90 - 1e-12);
    const double same[6] = {1, 2, 3, 1, 2, 3};
    m = measure(EWA_MEASURE_DISTANCE, same, 2);
    assert_true(m.length_world == 0 && m.slope_deg == 0);
}

TEST(test_refused) {
    (void)state;
    const double places[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, none[3] = {0}, wild[6] = {0, 0, 0, NAN, 0, 0};
    ewa_measurement m;
    assert_int_equal(ewa_places_measure(EWA_MEASURE_ANGLE, places, 2, up, &m), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_ANGLE, places, 4, up, &m), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_HEIGHT, places, 3, up, &m), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_DISTANCE, places, 1, up, &m), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_DISTANCE, places, 2, none, &m), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_DISTANCE, wild, 2, up, &m), EWA_ERROR_ARGUMENT);
    assert_string_equal(ewa_measure_kind_name(2), "angle");
    assert_string_equal(ewa_measure_kind_name(4), "note");
    assert_int_equal(ewa_places_measure(EWA_MEASURE_NOTE, places, 1, up, &m), EWA_OK);
    assert_int_equal(ewa_places_measure(EWA_MEASURE_NOTE, places, 2, up, &m), EWA_ERROR_ARGUMENT);
    assert_null(ewa_measure_kind_name(5));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
