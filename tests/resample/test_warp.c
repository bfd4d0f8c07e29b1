// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Depth images to surfels: which pixels count, kinds of depth, memory layouts, options, failures.
#include "cloud/color.h"
#include "io/scratch.h"
#include "warp/warp_place.h"
#include "warp_planes.h"

static plane_image plane;
static plane_frame drawn, other;

TEST_ON(test_masked_depths, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    ewa_warp_facts facts;
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.pixel_count, PLANE_PIXELS);
    assert_int_equal(facts.sample_count, PLANE_PIXELS);
    static const float bad[] = {0, -1, NAN, INFINITY, -INFINITY, 1e30f, 1e-30f, -0.0f};
    for (int i = 0; i < 8; i++) plane.depth[700 + 3 * i] = bad[i];
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.sample_count, PLANE_PIXELS - 8);
    assert_int_equal(facts.flying_count, 0);
    // A single missing pixel is covered by its neighbours.
    plane_draw(warp, &plane.image.camera, EWA_WARP_HYBRID, &drawn);
    for (int i = 0; i < PLANE_PIXELS; i++) assert_int_equal(drawn.holes[i], 0);
    // Nothing at all is no failure: the picture is empty.
    for (int i = 0; i < PLANE_PIXELS; i++) plane.depth[i] = bad[i % 8];
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.sample_count, 0);
    for (int method = 0; method < 2; method++) {
        plane_draw(warp, &plane.image.camera, (ewa_warp_method)method, &drawn);
        for (int i = 0; i < PLANE_PIXELS; i++) {
            assert_int_equal(drawn.holes[i], 255);
            assert_int_equal(drawn.rgba8[4 * i + 3], 0);
            assert_true(isinf(drawn.depth[i]));
        }
    }
}

TEST_ON(test_sixteen_bits, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    static uint16_t numbers[PLANE_PIXELS];
    for (int i = 0; i < PLANE_PIXELS; i++) numbers[i] = (uint16_t)(2000 + i % 7);
    for (int i = 0; i < PLANE_PIXELS; i++) plane.depth[i] = (float)numbers[i] / 1000.0f;
    plane_take(warp, &plane, NULL);
    const ewa_camera target = plane_camera_at(0.1, 0, 0.3);
    plane_draw(warp, &target, EWA_WARP_HYBRID, &other);
    plane.image.depth = numbers;
    plane.image.depth_type = EWA_U16;
    plane.image.depth_scale = 1000;
    plane_take(warp, &plane, NULL);
    plane_draw(warp, &target, EWA_WARP_HYBRID, &drawn);
    for (int i = 0; i < PLANE_PIXELS; i++)
        assert_true(isinf(drawn.depth[i]) ? isinf(other.depth[i])
                                          : fabsf(drawn.depth[i] - other.depth[i]) < 1e-5f);
    numbers[5] = 0, numbers[300] = 65535;
    ewa_warp_facts facts;
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.sample_count, PLANE_PIXELS - 2);
}

/// z, distance and disparity of one slanted plane give the same surface, whose normals are known.
TEST_ON(test_kinds, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    const double n[3] = {0.4, -0.3, -0.866025403784}, at = -2 * n[2]; // n.p = -at
    for (int kind = 0; kind < 3; kind++) {
        plane_set(&plane, 1);
        plane.image.kind = (ewa_depth_kind)kind;
        plane.image.baseline_world = 0.25;
        plane.image.disparity_offset_px = 3;
        plane.image.depth_scale = kind == EWA_DEPTH_DISPARITY ? 4 : 1;
        for (int i = 0; i < PLANE_PIXELS; i++) {
            const double x = (i % PLANE_WIDTH + 0.5 - PLANE_WIDTH / 2) / 80,
                         y = (i / PLANE_WIDTH + 0.5 - PLANE_HEIGHT / 2) / 80;
            const double z = -at / (n[0] * x + n[1] * y + n[2]), ray = sqrt(1 + x * x + y * y);
            plane.depth[i] = (float)(kind == EWA_DEPTH_Z     ? z
                                     : kind == EWA_DEPTH_RAY ? z * ray
                                                             : 4 * (80 * 0.25 / z - 3));
        }
        plane_take(warp, &plane, NULL);
        plane_draw(warp, &plane.image.camera, EWA_WARP_HYBRID, &drawn);
        for (int i = 0; i < PLANE_PIXELS; i++) {
            const double x = (i % PLANE_WIDTH + 0.5 - PLANE_WIDTH / 2) / 80,
                         y = (i / PLANE_WIDTH + 0.5 - PLANE_HEIGHT / 2) / 80;
            assert_int_equal(drawn.holes[i], 0);
            assert_true(fabs((double)drawn.depth[i] / (-at / (n[0] * x + n[1] * y + n[2])) - 1) < 2e-3);
            for (int c = 0; c < 3; c++) assert_true(fabs((double)drawn.normal[3 * i + c] - n[c]) < 2e-3);
        }
    }
}

/// The covariance of the packed ellipses is that of the axes they were made of.
TEST_ON(test_packed_ellipses, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 1);
    plane.image.camera.fy_px = 50; // samples that are no squares
    const double n[3] = {0.6, 0.3, -0.74161984871}, at = -2 * n[2];
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const double x = (i % PLANE_WIDTH + 0.5 - PLANE_WIDTH / 2) / 80,
                     y = (i / PLANE_WIDTH + 0.5 - PLANE_HEIGHT / 2) / 50;
        plane.depth[i] = (float)(-at / (n[0] * x + n[1] * y + n[2]));
    }
    plane_take(warp, &plane, NULL);
    const double sigma = 1.14 / 3;
    for (int i = 0; i < PLANE_PIXELS; i += 37) {
        const uint32_t column = (uint32_t)i % PLANE_WIDTH, row = (uint32_t)i / PLANE_WIDTH;
        const double x = (column + 0.5 - PLANE_WIDTH / 2) / 80, y = (row + 0.5 - PLANE_HEIGHT / 2) / 50;
        const double below = n[0] * x + n[1] * y + n[2], z = -at / below;
        // The derivatives of p = z (x, y, 1) by column and row.
        const double zx = at * n[0] / (below * below) / 80, zy = at * n[1] / (below * below) / 50;
        const double u[3] = {sigma * (zx * x + z / 80), sigma * zx * y, sigma * zx},
                     v[3] = {sigma * zy * x, sigma * (zy * y + z / 50), sigma * zy};
        ewa_packet_surfel surfel;
        const uint32_t packet = (uint32_t)ewa_warp_packet(&warp->sources[0], column, row);
        ewa_packet_decode(&warp->grid.surfels, packet, ewa_warp_lane(column, row), &surfel);
        const ewa_vec3 center = vec3_add(ewa_packet_center(&warp->grid.surfels, packet), surfel.offset);
        const double a[3] = {surfel.axis_u.x, surfel.axis_u.y, surfel.axis_u.z},
                     b[3] = {surfel.axis_v.x, surfel.axis_v.y, surfel.axis_v.z};
        const double scale = u[0] * u[0] + v[1] * v[1];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                assert_true(fabs(u[r] * u[c] + v[r] * v[c] - a[r] * a[c] - b[r] * b[c]) < 4e-3 * scale);
        assert_true(fabs(center.x - z * x) + fabs(center.y - z * y) + fabs(center.z - z) < 1e-5);
    }
}

/// The normal of the surfel that a pixel was made into.
static ewa_vec3 normal_at(const ewa_warp *warp, uint32_t column, uint32_t row) {
    ewa_packet_surfel surfel;
    const uint32_t packet = (uint32_t)ewa_warp_packet(&warp->sources[0], column, row);
    ewa_packet_decode(&warp->grid.surfels, packet, ewa_warp_lane(column, row), &surfel);
    ewa_vec3 normal = vec3_cross(surfel.axis_u, surfel.axis_v);
    vec3_normalize(&normal);
    return normal;
}

/// Roofs whose sides' slopes differ by more than 0.36 have a crease: a surfel at the ridge lies on one side.
/// Flatter ones are bent, and it lies between both. Along rows and columns, with pixels that are no squares.
TEST_ON(test_creases, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    static const double slopes[] = {0.05, 0.12, 0.16, 0.2, 0.25, 0.33};
    for (int k = 0; k < 12; k++) {
        const double slope = slopes[k / 2];
        const bool down = k % 2;
        plane_set(&plane, 1);
        plane.image.camera.fy_px = 50;
        const int ridge_x = PLANE_WIDTH / 2, ridge_y = PLANE_HEIGHT / 2;
        for (int i = 0; i < PLANE_PIXELS;
             i++) { // z = 2 + slope |x|, whose ridge passes through a pixel's centre
            const double x = (i % PLANE_WIDTH - ridge_x) / 80.0, y = (i / PLANE_WIDTH - ridge_y) / 50.0;
            plane.depth[i] = (float)(2 / (1 - slope * fabs(down ? y : x)));
        }
        plane.image.camera.cx_px += 0.5, plane.image.camera.cy_px += 0.5;
        plane_take(warp, &plane, NULL);
        const uint32_t column = (uint32_t)ridge_x, row = (uint32_t)ridge_y;
        const ewa_vec3 n = normal_at(warp, down ? column + 5 : column, down ? row : row + 5),
                       beside = normal_at(warp, down ? column : column + 3, down ? row + 3 : row);
        const double across = fabs((down ? n.y : n.x) / n.z);
        assert_float_equal(fabs((down ? beside.y : beside.x) / beside.z), slope, 4e-3);
        assert_float_equal(across, 2 * slope > 0.36 ? slope : 0, 4e-3);
    }
}

/// What a plane's grid adds up to, seen from where it was taken, whatever the kernels' size and cutoff are:
/// the sum is told as the coverage that a whole surface has.
TEST_ON(test_coverage_of_planes, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    static const double cutoffs[] = {1.5, 2, 3}, radii[] = {1.1, 1.3, 1.5};
    for (int k = 0; k < 9; k++) {
        plane_set(&plane, 2);
        WITH_DEFAULTS(ewa_warp_options, options);
        options.cutoff = cutoffs[k / 3], options.radius_spacings = radii[k % 3];
        assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &options, NULL), EWA_OK);
        // Eight times as near: kernels so large that the filter adds nothing; the mean of some 4 spacings.
        ewa_camera target = plane.image.camera;
        target.fx_px *= 8, target.fy_px *= 8;
        plane_draw(warp, &target, EWA_WARP_HYBRID, &drawn);
        double mean = 0;
        int count = 0;
        for (int y = 24; y < 40; y++)
            for (int x = 40; x < 56; x++) mean += (double)drawn.coverage[y * PLANE_WIDTH + x], count++;
        assert_float_equal(mean / count, 1, 0.02);
    }
}

/// Rows with gaps between them, floats instead of bytes, grey and alpha.
/// Files whose numbers nobody says the unit of: PNG has millimetres, but for disparities.
TEST(test_file_scales) {
    assert_true(ewa_depth_file_scale("a.depth.PNG", EWA_DEPTH_Z) == 1000);
    assert_true(ewa_depth_file_scale("a.png", EWA_DEPTH_RAY) == 1000);
    assert_true(ewa_depth_file_scale("a.png", EWA_DEPTH_DISPARITY) == 1);
    assert_true(ewa_depth_file_scale("a.png.exr", EWA_DEPTH_Z) == 1);
    assert_true(ewa_depth_file_scale("-", EWA_DEPTH_Z) == 1 && ewa_depth_file_scale(NULL, EWA_DEPTH_RAY) == 1);
}

TEST_ON(test_layouts, 2) {
    enum { STRIDE = PLANE_WIDTH + 13 };
    static float depth[PLANE_HEIGHT * STRIDE], color[4 * PLANE_HEIGHT * STRIDE];
    static uint8_t color8[4 * PLANE_HEIGHT * STRIDE];
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    const ewa_camera target = plane_camera_at(0.07, -0.03, 0.2);
    plane_take(warp, &plane, NULL);
    plane_draw(warp, &target, EWA_WARP_HYBRID, &drawn);
    for (int kind = 0; kind < 2; kind++) {
        for (int i = 0; i < PLANE_HEIGHT * STRIDE; i++) {
            const int x = i % STRIDE, y = i / STRIDE, from = y * PLANE_WIDTH + x;
            const bool inside = x < PLANE_WIDTH;
            depth[i] = inside ? plane.depth[from] : NAN;
            for (int c = 0; c < 4; c++) {
                const uint8_t code = !inside ? 17 : c == 3 ? 255 : plane.rgb8[3 * from + c];
                color8[4 * i + c] = code;
                color[4 * i + c] = c == 3 ? 1 : ewa_linear_from_srgb(code / 255.0f);
            }
        }
        plane.image.depth = depth;
        plane.image.depth_stride_bytes = STRIDE * sizeof *depth;
        plane.image.color = kind ? (const void *)color : color8;
        plane.image.color_type = kind ? EWA_F32 : EWA_U8;
        plane.image.color_channel_count = 4;
        plane.image.color_stride_bytes = 4 * STRIDE * (kind ? sizeof *color : 1);
        plane_take(warp, &plane, NULL);
        plane_draw(warp, &target, EWA_WARP_HYBRID, &other);
        for (int i = 0; i < 4 * PLANE_PIXELS; i++)
            assert_in_range(other.rgba8[i] - drawn.rgba8[i] + 1, 0, kind ? 2 : 1);
        if (!kind) assert_memory_equal(other.rgba, drawn.rgba, sizeof drawn.rgba);
        color8[4 * 5 + 3] = 0;
        color[4 * 5 + 3] = 0;
        ewa_warp_facts facts;
        plane_take(warp, &plane, &facts);
        assert_int_equal(facts.sample_count, PLANE_PIXELS - 1);
    }
    // Colours brighter than 1 stay.
    for (int i = 0; i < 4 * PLANE_HEIGHT * STRIDE; i++) color[i] = i % 4 == 3 ? 1 : 7.5f;
    plane_take(warp, &plane, NULL);
    plane_draw(warp, &target, EWA_WARP_HYBRID, &other);
    for (int c = 0; c < 3; c++)
        assert_true(fabsf(other.rgba[4 * (PLANE_PIXELS / 2 + 40) + c] - 7.5f) < 1e-3f);
    // No colour: grey.
    plane.image.color = NULL;
    plane_take(warp, &plane, NULL);
    for (int method = 0; method < 2; method++) {
        plane_draw(warp, &target, (ewa_warp_method)method, &other);
        int grey = 0;
        for (int i = 0; i < PLANE_PIXELS; i++) {
            if (other.holes[i] || other.rgba[4 * i + 3] < 1) continue;
            grey++;
            for (int c = 0; c < 3; c++)
                assert_true(fabs((double)other.rgba[4 * i + c] - EWA_DEFAULT_GREY) < 1e-4);
        }
        assert_true(grey > PLANE_PIXELS / 2);
    }
}

static void expect(ewa_warp *warp, check_log *log, ewa_status status, const char *said) {
    log->text[0] = 0;
    assert_int_equal(ewa_warp_take(warp, &plane.image, 1, NULL, NULL), status);
    if (!strstr(log->text, said)) fail_msg("'%s' does not say '%s'", log->text, said);
    plane_set(&plane, 2);
}

TEST_LOGGED(test_bad_images, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    plane.image.camera.fx_px = 0;
    expect(warp, log, EWA_ERROR_ARGUMENT, "fx");
    plane.image.camera.projection = EWA_ORTHOGRAPHIC;
    expect(warp, log, EWA_ERROR_UNSUPPORTED, "orthographic");
    plane.image.camera.fx_px = 1e9;
    expect(warp, log, EWA_ERROR_UNSUPPORTED, "focal lengths");
    plane.image.camera.world_to_camera[3] = 1e13;
    expect(warp, log, EWA_ERROR_UNSUPPORTED, "place of the camera");
    plane.image.depth = NULL;
    expect(warp, log, EWA_ERROR_ARGUMENT, "no depth");
    plane.image.depth_type = EWA_F64;
    expect(warp, log, EWA_ERROR_ARGUMENT, "depth_type");
    plane.image.depth_stride_bytes = 4 * PLANE_WIDTH - 1;
    expect(warp, log, EWA_ERROR_ARGUMENT, "depth_stride_bytes");
    plane.image.kind = (ewa_depth_kind)7;
    expect(warp, log, EWA_ERROR_ARGUMENT, "kind");
    plane.image.depth_scale = 0;
    expect(warp, log, EWA_ERROR_ARGUMENT, "depth_scale is 0");
    plane.image.kind = EWA_DEPTH_DISPARITY;
    expect(warp, log, EWA_ERROR_ARGUMENT, "baseline_world is 0");
    plane.image.kind = EWA_DEPTH_DISPARITY, plane.image.baseline_world = 1;
    plane.image.disparity_offset_px = NAN;
    expect(warp, log, EWA_ERROR_ARGUMENT, "disparity_offset_px");
    plane.image.color_type = EWA_I16;
    expect(warp, log, EWA_ERROR_ARGUMENT, "color_type");
    plane.image.color_channel_count = 2;
    expect(warp, log, EWA_ERROR_ARGUMENT, "color_channel_count is 2");
    plane.image.color_stride_bytes = 3 * PLANE_WIDTH - 1;
    expect(warp, log, EWA_ERROR_ARGUMENT, "color_stride_bytes");
    // After a failure there is nothing to draw.
    const ewa_frame frame = {.rgba8 = drawn.rgba8};
    assert_int_equal(ewa_warp_draw(warp, &plane.image.camera, EWA_WARP_HYBRID, NULL, &frame, NULL, NULL),
                     EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "no depth image"));
    expect(warp, log, EWA_OK, "");
    ewa_camera broken = plane.image.camera;
    broken.width_px = 0;
    assert_int_equal(ewa_warp_draw(warp, &broken, EWA_WARP_MCMILLAN, NULL, &frame, NULL, NULL),
                     EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_warp_draw(warp, &plane.image.camera, (ewa_warp_method)9, NULL, &frame, NULL, NULL),
                     EWA_ERROR_ARGUMENT);
}

TEST_LOGGED(test_bad_options, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    for (int k = 0; k < 8; k++) {
        static const char *const said[] = {"struct_size", "cutoff",        "radius_spacings", "depth_jump",
                                           "depth_noise", "nearest_world", "farthest_world",  "cutoff"};
        WITH_DEFAULTS(ewa_warp_options, options);
        double *const members[] = {NULL,
                                   &options.cutoff,
                                   &options.radius_spacings,
                                   &options.depth_jump,
                                   &options.depth_noise,
                                   &options.nearest_world,
                                   &options.farthest_world,
                                   &options.cutoff};
        static const double bad[] = {0, 0, 0.1, 0, -1, 0, 1e-6, NAN};
        if (k == 0)
            options.struct_size = 1;
        else
            *members[k] = bad[k];
        assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &options, NULL), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, said[k]));
    }
    assert_int_equal(ewa_warp_take(warp, &plane.image, 0, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_warp_take(NULL, &plane.image, 1, NULL, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_warp_create(NULL, &warp), EWA_ERROR_ARGUMENT);
    ewa_warp_destroy(NULL);
}

static ewa_status work(ewa_context *context, void *user) {
    const ewa_depth_image *image = user;
    const ewa_depth_image images[2] = {*image, *image};
    OWNED(ewa_warp_destroy) ewa_warp *warp = NULL;
    ewa_status status = ewa_warp_create(context, &warp);
    if (status == EWA_OK) status = ewa_warp_take(warp, images, 2, NULL, NULL);
    const ewa_frame frame = {.rgba8 = drawn.rgba8, .depth = drawn.depth};
    for (int method = 0; method < 2 && status == EWA_OK; method++)
        status =
            ewa_warp_draw(warp, &image->camera, (ewa_warp_method)method, NULL, &frame, drawn.holes, NULL);
    return status;
}

TEST(test_failing_allocations) {
    plane_set(&plane, 2);
    scratch_fail_each(work, &plane.image);
}

/// Whoever says no at any time, while images are taken, too, is heard, and nothing is left.
TEST(test_every_stop_is_clean) {
    plane_set(&plane, 2);
    ewa_status status = EWA_CANCELLED;
    int stops = 0;
    for (; status != EWA_OK; stops++) {
        int left = stops;
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_stopped(&left, &memory);
        status = work(context, &plane.image);
        if (status != EWA_OK) assert_int_equal(status, EWA_CANCELLED);
        if (stops == 0) {
            OWNED(ewa_warp_destroy) ewa_warp *warp = NULL;
            assert_int_equal(ewa_warp_create(context, &warp), EWA_OK);
            assert_int_equal(ewa_warp_take(warp, &plane.image, 1, NULL, NULL), EWA_CANCELLED);
        }
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
    }
    assert_true(stops > 10);
}

/// Nothing is allocated from the second frame on.
TEST(test_warm) {
    check_memory memory = {.calls_left = -1};
    check_log log = {0};
    ewa_context *context = scratch_context(&memory, &log);
    ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    const ewa_camera target = plane_camera_at(0.1, 0.1, 0.1);
    for (int frame = 0; frame < 3; frame++) {
        if (frame > 0) memory.calls_left = 0; // the next one fails
        plane_take(warp, &plane, NULL);
        plane_draw(warp, &target, EWA_WARP_HYBRID, &drawn);
        plane_draw(warp, &target, EWA_WARP_MCMILLAN, &drawn);
    }
    ewa_warp_destroy(&warp);
    ewa_context_destroy(&context);
    assert_int_equal(memory.held_bytes, 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
