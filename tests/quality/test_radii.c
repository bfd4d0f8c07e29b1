// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of estimated radii as they show: no pinholes where a surface is sampled, no discs over what is not.
// measure_radii prints the same figures for more samplings and for files.
#include "quality/radii_scene.h"

#include <math.h>

static ewa_cloud *make_scene(ewa_context *context, radii_kind kind, double detail, uint32_t count) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    float *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    radii_scene_fill(kind, detail, count, xyz);
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    return cloud;
}

/// Gaps that larger discs would close are none, and pixels inside are opaque.
TEST_ON(test_closed, 0) {
    static const struct {
        const char *name;
        radii_kind kind;
        double detail;
        uint32_t count;
        double translucent, thin; ///< largest shares of the pixels inside
    } scenes[] = {{"plane", RADII_PLANE, 0, 20000, 0, 2e-4},
                  {"sphere", RADII_SPHERE, 0, 100000, 0, 1e-4},
                  {"terrain", RADII_TERRAIN, 0, 60000, 3e-5, 1e-3},
                  {"lines 5 : 1", RADII_LINES, 5, 20000, 0, 1e-4},
                  {"lines 20 : 1", RADII_LINES, 20, 20000, 1e-5, 4e-3},
                  {"noise of 1/4", RADII_NOISY, 0.25, 20000, 1e-4, 8e-3}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = make_scene(context, scenes[i].kind, scenes[i].detail, scenes[i].count);
        radii_holes holes;
        radii_measure_holes(context, cloud, RADII_WHOLE | RADII_NEAR, 3, &holes);
        const double inside = (double)holes.inside, translucent = (double)holes.translucent / inside,
                     thin = (double)holes.thin / inside;
        print_message("%s: of %.0f pixels inside %.0f are empty, %.2g translucent, %.2g not opaque\n",
                      scenes[i].name, inside, (double)holes.empty, translucent, thin);
        assert_true(inside > 200000);
        assert_int_equal(holes.empty, 0);
        assert_true(translucent <= scenes[i].translucent);
        assert_true(thin <= scenes[i].thin);
    }
}

/// No disc is much larger than the spacing around it.
TEST_ON(test_limited, 0) {
    static const struct {
        const char *name;
        radii_kind kind;
        double detail;
        uint32_t count;
        double largest; ///< in median spacings
    } scenes[] = {{"plane", RADII_PLANE, 0, 20000, 4},      {"dense plane", RADII_PLANE, 0, 1000000, 4},
                  {"sphere", RADII_SPHERE, 0, 100000, 4},   {"terrain", RADII_TERRAIN, 0, 60000, 4},
                  {"lone points", RADII_LONE, 0, 20000, 4}, {"fog", RADII_FOG, 0, 20000, 3.8},
                  {"garden", RADII_GARDEN, 0, 20000, 4.5},  {"lines 20 : 1", RADII_LINES, 20, 20000, 4}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        OWNED(ewa_cloud_destroy)
        ewa_cloud *cloud = make_scene(context, scenes[i].kind, scenes[i].detail, scenes[i].count);
        radii_sizes sizes;
        radii_measure_sizes(cloud, 300, &sizes);
        print_message("%s: radii of %.2f spacings, the largest %.2f\n", scenes[i].name, sizes.median,
                      sizes.largest);
        assert_true(sizes.largest <= scenes[i].largest);
    }
}

/// Single points above a plane get the plain radius of what is nearest, those of the plane stay as they were.
TEST_ON(test_lone_points, 0) {
    enum { COUNT = 20000 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_scene(context, RADII_LONE, 0, COUNT);
    const float *xyz = ewa_cloud_find(cloud, EWA_POSITION)->data,
                *radius = ewa_cloud_find(cloud, EWA_RADIUS)->data;
    const double spacing = 2 / sqrt((double)COUNT);
    int lone = 0;
    for (int i = 0; i < COUNT; i++) {
        if (!(xyz[3 * i + 2] > 0)) continue;
        lone++;
        assert_true((double)radius[i] > 0.5 * spacing && (double)radius[i] < 1.5 * spacing);
    }
    assert_int_equal(lone, COUNT / 5000);
}

/// The radius of a place in the middle of a round hole in a plane of unit spacing.
static double radius_in_hole(ewa_context *context, double hole) {
    enum { SIDE = 100 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL, *left = NULL;
    uint64_t kept[SIDE * SIDE], count = 0;
    assert_int_equal(ewa_cloud_create(context, SIDE * SIDE, &cloud), EWA_OK);
    float *xyz = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    check_random random = {4};
    for (int i = 0; i < SIDE * SIDE; i++) {
        xyz[3 * i] = i ? (float)(i % SIDE - SIDE / 2 + check_uniform(&random, -0.4, 0.4)) : 0;
        xyz[3 * i + 1] = i ? (float)(i / SIDE - SIDE / 2 + check_uniform(&random, -0.4, 0.4)) : 0;
        xyz[3 * i + 2] = 0;
        if (i == 0 || hypotf(xyz[3 * i], xyz[3 * i + 1]) > (float)hole) kept[count++] = (uint64_t)i;
    }
    assert_int_equal(ewa_cloud_select(cloud, kept, count, &left), EWA_OK);
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&left, &options), EWA_OK);
    const double radius = (double)((const float *)ewa_cloud_find(left, EWA_RADIUS)->data)[0];
    return radius;
}

/// A place in a gap is enlarged to close it, but in a hole that is much wider than the spacing it is alone:
/// it gets the plain radius of what is around.
TEST_ON(test_holes, 0) {
    for (int hole = 2; hole < 12; hole++) {
        const double radius = radius_in_hole(context, hole);
        print_message("in a hole of %d spacings: radius %.3f\n", hole, radius);
        if (hole <= 2) assert_true(radius > hole);
        if (hole >= 5) assert_true(radius > 1 && radius < 1.5);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
