// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the fit of edges and corners begins to find them: pairs of neighbourhoods on either side of each
// limit.
#include "check.h"
#include "edges/feature_fit.h"

#include <math.h>
#include <stdbool.h>

enum { COUNT = 96 };

static const feature_scale EXACT = {.spacing = 1, .noise = 0, .cos_threshold = 0.99999};

static feature_points points;

/// Puts a point at (x, y) of a surface that bends down by `slope` where x is over `crease`.
static void put(uint32_t i, double x, double y, double crease, double slope) {
    const double length = sqrt(1 + slope * slope);
    const bool on = x > crease;
    points.x[i] = x, points.y[i] = y, points.z[i] = on ? slope * (crease - x) : 0;
    points.normal[i][0] = on ? (float)(slope / length) : 0;
    points.normal[i][1] = 0;
    points.normal[i][2] = on ? (float)(1 / length) : 1;
}

/// Points of a square of 10 by 10 about the middle, the first `far` of them beyond the crease.
static void make_crease(uint32_t far, double crease, double slope) {
    check_random random = {3};
    points = (feature_points){.count = COUNT};
    for (uint32_t i = 0; i < COUNT; i++) {
        const double x =
            i < far ? check_uniform(&random, crease + 0.3, 5) : check_uniform(&random, -5, crease - 0.1);
        put(i, x, check_uniform(&random, -5, 5), crease, slope);
    }
}

static uint32_t planes_of(const feature_scale *scale) {
    feature_model model;
    ewa_feature_fit(&points, scale, &model);
    return model.plane_count;
}

/// A tenth of the points have to be on either side of an edge.
TEST(test_edge_share) {
    make_crease(11, 3, 1);
    assert_int_equal(planes_of(&EXACT), 2);
    make_crease(8, 3, 1);
    assert_int_equal(planes_of(&EXACT), 0);
}

/// Bends a crease until the best quadric leaves so many squares.
static void bend(double squares) {
    double slope = 0.1;
    for (int turn = 0; turn < 40; turn++) {
        make_crease(COUNT / 2, 0, slope);
        const double rms = ewa_feature_quadric_residual(&points);
        slope *= sqrt(squares / (rms * rms * (COUNT - 6)));
    }
}

/// The squares of a quadric and what is never explained, 0.04 spacings, are 1.3 times those of an edge.
TEST(test_edge_gain) {
    const double rest = COUNT * 0.04 * 0.04;
    bend(0.40 * rest);
    assert_int_equal(planes_of(&EXACT), 2);
    bend(0.21 * rest);
    assert_int_equal(planes_of(&EXACT), 0);
}

/// Of noise a good fit leaves 0.6 of the squares.
TEST(test_noise) {
    feature_scale scale = EXACT;
    scale.noise = 0.2;
    const double minimum = COUNT * (0.04 * 0.04 + 0.6 * scale.noise * scale.noise);
    bend(1.07 * 1.3 * minimum - COUNT * 0.04 * 0.04);
    assert_int_equal(planes_of(&scale), 2);
    bend(0.93 * 1.3 * minimum - COUNT * 0.04 * 0.04);
    assert_int_equal(planes_of(&scale), 0);
}

/// Points far off count as three deviations, of 0.04 spacings where there is less noise, to an edge as to a
/// quadric.
TEST(test_truncation) {
    for (int steep = 0; steep < 2; steep++) {
        make_crease(COUNT / 2, 0, steep ? 0.115 : 0.09);
        // By turns above and below, far apart, so that they move neither surface much.
        for (uint32_t i = 0; i < 8; i++) points.z[12 * i] += i % 2 ? 0.3 : -0.3;
        assert_int_equal(planes_of(&EXACT), steep ? 2 : 0);
    }
}

/// A right edge along y, whose side across x bends by `slope` where y is over `third`; so many points are
/// there.
static void make_corner(uint32_t on_third, double third, double slope) {
    check_random random = {4};
    const double length = sqrt(1 + slope * slope);
    points = (feature_points){.count = COUNT};
    for (uint32_t i = 0; i < COUNT; i++) {
        const bool bent = i < on_third, top = !bent && i % 2;
        const double y = bent ? check_uniform(&random, third + 0.3, 5) : check_uniform(&random, -5, third);
        const double depth = check_uniform(&random, 0.2, 5);
        points.x[i] = top ? -depth : bent ? -slope * (y - third) : 0;
        points.y[i] = y;
        points.z[i] = top ? 0 : -depth;
        points.normal[i][0] = top ? 0 : bent ? (float)(1 / length) : 1;
        points.normal[i][1] = bent ? (float)(slope / length) : 0;
        points.normal[i][2] = top ? 1 : 0;
    }
}

/// A corner has 0.07 of the points on each of its planes.
TEST(test_corner_share) {
    make_corner(8, 2.5, 1);
    assert_int_equal(planes_of(&EXACT), 3);
    make_corner(6, 2.5, 1);
    assert_int_equal(planes_of(&EXACT), 2);
}

/// A corner explains 1.4 times as much as an edge: the squares that a bend leaves to an edge grow with its
/// slope, and are 0.4 of what is never explained at 0.046.
TEST(test_corner_gain) {
    make_corner(24, 0, 0.042);
    assert_int_equal(planes_of(&EXACT), 2);
    make_corner(24, 0, 0.050);
    assert_int_equal(planes_of(&EXACT), 3);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
