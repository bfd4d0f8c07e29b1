// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/texture/texture_plan.c: maps from corners and cameras, and what is refused.
#include "homogeneous/vec.h"
#include "resample/texture_fixture.h"
#include "texture/texture.h"

#include <float.h>
#include <math.h>
#include <string.h>

static check_log said;
static ewa_context *context;

static int enter(void **state) {
    context = check_context(2, &said);
    return 0;
}

static int leave(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

TEST(test_corners) {
    static const double corners[4][2] = {{10, 20}, {300, -40}, {250, 180}, {-30, 90}};
    ewa_mat3 map;
    assert_int_equal(ewa_texture_map_from_corners(context, 64, 48, corners, &map), EWA_OK);
    static const double texels[4][2] = {{0, 0}, {64, 0}, {64, 48}, {0, 48}};
    for (int i = 0; i < 4; i++) {
        double xy[2];
        const ewa_vec3 p = ewa_point2_transform((ewa_vec3){texels[i][0], texels[i][1], 1}, &map);
        assert_true(p.z > 0);
        assert_int_equal(ewa_point2_divide(p, xy), EWA_OK);
        for (int c = 0; c < 2; c++) assert_float_equal(xy[c], corners[i][c], 1e-9);
    }
    static const double wrong[][4][2] = {
        {{0, 0}, {10, 0}, {20, 0}, {0, 10}},       // three on a line
        {{0, 0}, {10, 10}, {10, 0}, {0, 10}},      // crossed
        {{0, 0}, {10, 0}, {2, 2}, {0, 10}},        // not convex
        {{0, 0}, {0, 0}, {0, 0}, {0, 0}},          // a point
        {{NAN, 0}, {10, 0}, {10, 10}, {0, 10}},    //
        {{0, 0}, {INFINITY, 0}, {10, 10}, {0, 10}} //
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        const ewa_mat3 before = map;
        assert_int_equal(ewa_texture_map_from_corners(context, 64, 48, wrong[k], &map), EWA_ERROR_NUMERIC);
        assert_memory_equal(&before, &map, sizeof map);
        assert_non_null(strstr(said.text, "corners"));
    }
}

/// Points of the plane go where the camera sees them.
TEST(test_camera) {
    static const double origin[3] = {-2, 1, 0.5}, across[3] = {3, 0.5, 0}, down[3] = {0.2, -2, 1};
    for (int projection = 0; projection < 2; projection++) {
        ewa_camera camera;
        ewa_camera_init(&camera);
        assert_int_equal(ewa_camera_look_at(&camera, (const double[3]){1, -4, 3}, (const double[3]){0, 0, 0},
                                            (const double[3]){0, 0, 1}),
                         EWA_OK);
        if (projection) assert_int_equal(ewa_camera_set_ortho(&camera, 5), EWA_OK);
        ewa_mat3 map;
        assert_int_equal(ewa_texture_map_from_camera(context, 30, 20, &camera, origin, across, down, &map),
                         EWA_OK);
        for (int k = 0; k < 6; k++) {
            const double u = 7.5 * k, v = 20 - 3 * k;
            double p[3], xy[2];
            for (int row = 0; row < 3; row++) {
                const double *m = &camera.world_to_camera[4 * row];
                p[row] = m[3];
                for (int c = 0; c < 3; c++)
                    p[row] += m[c] * (origin[c] + u / 30 * across[c] + v / 20 * down[c]);
            }
            assert_int_equal(ewa_point2_divide(ewa_point2_transform((ewa_vec3){u, v, 1}, &map), xy), EWA_OK);
            const double z = projection ? 1 : p[2];
            assert_float_equal(xy[0], camera.fx_px * p[0] / z + camera.cx_px, 1e-9 * fabs(xy[0]) + 1e-9);
            assert_float_equal(xy[1], camera.fy_px * p[1] / z + camera.cy_px, 1e-9 * fabs(xy[1]) + 1e-9);
        }
        // Parallel axes; a plane through the eye.
        assert_int_equal(ewa_texture_map_from_camera(context, 30, 20, &camera, origin, across, across, &map),
                         EWA_ERROR_NUMERIC);
        assert_int_equal(ewa_texture_map_from_camera(context, 30, 20, &camera, (const double[3]){NAN, 0, 0},
                                                     across, down, &map),
                         EWA_ERROR_NUMERIC);
        camera.fx_px = -1;
        assert_int_equal(ewa_texture_map_from_camera(context, 30, 20, &camera, origin, across, down, &map),
                         EWA_ERROR_ARGUMENT);
    }
}

static void refuse(const raster *source, const ewa_mat3 *map, const ewa_texture_options *options,
                   const raster *target, ewa_status status, const char *word) {
    assert_int_equal(ewa_texture_map(context, &source->source, map, options, &target->target, NULL), status);
    if (!strstr(said.text, word)) fail_msg("'%s' does not say '%s'", said.text, word);
    assert_int_equal(ewa_texture_map_reference(context, &source->source, map, options, &target->target),
                     status);
}

TEST(test_refused) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_LINEAR, 3, 8, 6), target = raster_make(EWA_PIXEL_LINEAR, 4, 10, 9);
    const ewa_mat3 good = mat3_identity();
    static const double singular[][9] = {
        {0},                                   //
        {1, 2, 3, 2, 4, 6, 0, 0, 1},           // to a line
        {1, 0, 0, 0, 1, 0, 1, 0, 0},           // a line of zeros
        {1, 1, 1, 1, 1, 1, 1, 1, 1},           // to a point
        {1e-200, 0, 0, 0, 1e-200, 0, 0, 0, 1}, // areas vanish
        {1e200, 0, 0, 0, 1e200, 0, 0, 0, 1},   // areas overflow
        {1, 0, 0, 0, 1, 0, 0, 0, 0},           // all to infinity
        {1, 0, 0, 0, 1e-16, 0, 0, 1, 0},       // to a line but for rounding
    };
    for (size_t k = 0; k < sizeof singular / sizeof singular[0]; k++) {
        const ewa_mat3 map = texture_map_of(singular[k]);
        if (k == 2) continue; // u = w: regular
        refuse(&source, &map, NULL, &target, EWA_ERROR_NUMERIC, "singular");
    }
    for (int i = 0; i < 9; i++) {
        ewa_mat3 map = good;
        map.m[i / 3][i % 3] = i % 2 ? NAN : -INFINITY;
        refuse(&source, &map, NULL, &target, EWA_ERROR_ARGUMENT, "not finite");
    }
    static const double numbers[][2] = {{0.05, 5}, {0.5, 4.5}, {0.1, 3}, {0.01, 1.5}};
    static const char *const members[] = {"prefilter_px", "cutoff", "sigma_texels", "point_spacing_px"};
    for (int k = 0; k < 12; k++) {
        ewa_texture_options options = texture_options(EWA_TEXTURE_HYBRID);
        double *const at[] = {&options.prefilter_px, &options.cutoff, &options.sigma_texels,
                              &options.point_spacing_px};
        *at[k / 3] = k % 3 == 2 ? NAN : numbers[k / 3][k % 3];
        refuse(&source, &good, &options, &target, EWA_ERROR_ARGUMENT, members[k / 3]);
    }
    ewa_texture_options options = texture_options((ewa_texture_method)4);
    refuse(&source, &good, &options, &target, EWA_ERROR_ARGUMENT, "method");
    options = texture_options(EWA_TEXTURE_SPLAT);
    options.repeat = true;
    refuse(&source, &good, &options, &target, EWA_ERROR_ARGUMENT, "repeat");
    options = texture_options(EWA_TEXTURE_SPLAT);
    options.background[2] = NAN;
    refuse(&source, &good, &options, &target, EWA_ERROR_ARGUMENT, "background");
    options.struct_size = 3;
    refuse(&source, &good, &options, &target, EWA_ERROR_ARGUMENT, "struct_size");
    raster bad = source;
    bad.source.channel_count = 2;
    refuse(&bad, &good, NULL, &target, EWA_ERROR_ARGUMENT, "channels");
    bad = source;
    bad.source.stride_bytes = 8 * 3 * 4 - 4;
    refuse(&bad, &good, NULL, &target, EWA_ERROR_ARGUMENT, "rows");
    bad = source;
    bad.source.width_px = 0;
    refuse(&bad, &good, NULL, &target, EWA_ERROR_ARGUMENT, "empty");
    bad = source;
    bad.source.width_px = bad.source.height_px = 70000;
    bad.source.stride_bytes = 70000 * 12;
    refuse(&bad, &good, NULL, &target, EWA_ERROR_LIMIT, "limit");
    bad = target;
    bad.target.channel_count = 1;
    refuse(&source, &good, NULL, &bad, EWA_ERROR_ARGUMENT, "grey");
    bad = target;
    bad.target.pixels = (char *)bad.memory + 1;
    refuse(&source, &good, NULL, &bad, EWA_ERROR_ARGUMENT, "aligned");
}

/// Whatever the numbers of a map are, drawing ends, and what is drawn is finite.
TEST(test_wild_maps) {
    check_random random = {77};
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_SRGB8, 4, 40, 30),
           target = raster_make(EWA_PIXEL_LINEAR, 4, 70, 66);
    raster_paint(&source, 1);
    int drawn = 0;
    for (int k = 0; k < 280; k++) {
        ewa_mat3 map;
        const double power = check_uniform(&random, 0, k % 4 == 3 ? 40 : 3);
        for (int i = 0; i < 9; i++)
            map.m[i / 3][i % 3] =
                check_uniform(&random, -1, 1) * pow(10, check_uniform(&random, -power, power));
        if (k % 5 == 0) map.m[2][2] = -map.m[0][2] * 20 - map.m[1][2] * 15; // the horizon through the middle
        ewa_texture_options options = texture_options((ewa_texture_method)(k % 3));
        options.repeat = k % 7 == 0 && options.method != EWA_TEXTURE_SPLAT;
        const ewa_status status =
            ewa_texture_map(context, &source.source, &map, &options, &target.target, NULL);
        if (status == EWA_ERROR_NUMERIC) continue;
        assert_int_equal(status, EWA_OK);
        drawn++;
        for (uint32_t y = 0; y < 66; y++)
            for (uint32_t x = 0; x < 70; x++)
                for (uint32_t c = 0; c < 4; c++) {
                    const double number = raster_get(&target, x, y, c);
                    if (!(number >= 0 && number <= 1.0001)) fail_msg("map %d: %g at %u, %u", k, number, x, y);
                }
    }
    assert_true(drawn > 140);
    // Colours that are not finite stay where they are, and nothing crashes.
    OWNED(raster_free) raster floats = raster_make(EWA_PIXEL_LINEAR, 4, 40, 30);
    raster_paint(&floats, 2);
    raster_set(&floats, 20, 15, 1, NAN);
    raster_set(&floats, 3, 3, 0, INFINITY);
    raster_set(&floats, 5, 5, 3, (double)-FLT_MAX);
    OWNED(raster_free) raster coded = raster_make(EWA_PIXEL_SRGB8, 4, 70, 66);
    const ewa_mat3 map = mat3_identity();
    for (int method = 0; method < 4; method++) {
        const ewa_texture_options options = texture_options((ewa_texture_method)method);
        texture_draw(context, &floats, &map, &options, &coded);
        texture_draw(context, &floats, &map, &options, &target);
        assert_true(raster_get(&target, 30, 20, 1) >= 0);
    }
}

/// A failing allocation, whichever it is, fails the call and leaves nothing behind.
TEST(test_memory) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_SRGB8, 3, 256, 256),
           target = raster_make(EWA_PIXEL_SRGB8, 3, 64, 64);
    raster_paint(&source, 1);
    const ewa_mat3 map = texture_map_of((const double[9]){0.1, 0, 10, 0, 0.1, 10, 0, 0.0001, 1});
    for (int reference = 0; reference < 2; reference++) {
        int failures = 0;
        for (long fail_at = 0;; fail_at++) {
            check_memory memory = {.calls_left = -1};
            ewa_context *scarce = check_context_on(0, &memory);
            const int64_t held_bytes = memory.held_bytes;
            memory.calls_left = fail_at;
            const ewa_status status =
                reference ? ewa_texture_map_reference(scarce, &source.source, &map, NULL, &target.target)
                          : ewa_texture_map(scarce, &source.source, &map, NULL, &target.target, NULL);
            assert_true(memory.held_bytes == held_bytes);
            ewa_context_destroy(&scarce);
            if (status == EWA_OK) break;
            assert_int_equal(status, EWA_ERROR_MEMORY);
            failures++;
        }
        assert_true(failures >= (reference ? 1 : 3));
    }
}

static bool cancel(void *user, const char *stage, double fraction) {
    (void)stage;
    return fraction < *(const double *)user;
}

TEST(test_cancelled) {
    static const double ends[] = {0, 0.2, 0.9};
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_SRGB8, 3, 64, 64), target = raster_make(EWA_PIXEL_SRGB8, 3, 64, 64);
    const ewa_mat3 map = mat3_identity();
    for (int k = 0; k < 3; k++) {
        double end = ends[k];
        OWNED(ewa_context_destroy) ewa_context *made = check_context_telling(0, cancel, &end);
        assert_int_equal(ewa_texture_map(made, &source.source, &map, NULL, &target.target, NULL),
                         EWA_CANCELLED);
    }
}

int main(void) { return RUN_TESTS(enter, leave); }
