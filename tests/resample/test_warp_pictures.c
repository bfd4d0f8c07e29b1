// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Warped pictures with known answers: identity, shifts, steps of depth, holes, order, threads, likeness.
#include "quality/warp_scene.h"
#include "warp_planes.h"

static plane_image plane;
static plane_frame drawn, other;

TEST_ON(test_identity, 2) {
    enum { WIDTH = 320, HEIGHT = 240, COUNT = WIDTH * HEIGHT };
    static uint8_t color[3 * COUNT], rgba8[4 * COUNT], rgb8[3 * COUNT];
    static float depth[COUNT];
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    ewa_depth_image image;
    ewa_depth_image_init(&image);
    image.camera = warp_scene_camera(WIDTH, HEIGHT, 0, 0, 0);
    warp_scene_picture(&image.camera, color, depth);
    image.depth = depth;
    image.depth_type = EWA_F32;
    image.color = color;
    assert_int_equal(ewa_warp_take(warp, &image, 1, NULL, NULL), EWA_OK);
    const ewa_frame frame = {.rgba8 = rgba8};
    assert_int_equal(ewa_warp_draw(warp, &image.camera, EWA_WARP_HYBRID, NULL, &frame, NULL, NULL), EWA_OK);
    for (int i = 0; i < COUNT; i++) memcpy(rgb8 + 3 * i, rgba8 + 4 * i, 3);
    const picture_likeness likeness = picture_compare(WIDTH, HEIGHT, rgb8, color, NULL);
    print_message("identity: %.2f dB, SSIM %.4f\n", likeness.psnr_db, likeness.ssim);
    assert_true(likeness.psnr_db > 40 && likeness.ssim > 0.995);
}

/// A step of the camera that is five pixels on the plane.
TEST_ON(test_shift, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    plane_take(warp, &plane, NULL);
    const ewa_camera target = plane_camera_at(5 * 2 / 80.0, 0, 0);
    for (int method = 0; method < 2; method++) {
        plane_draw(warp, &plane.image.camera, (ewa_warp_method)method, &drawn);
        plane_draw(warp, &target, (ewa_warp_method)method, &other);
        for (int y = 0; y < PLANE_HEIGHT; y++) {
            // Borders of the plane show less of their neighbours.
            for (int x = 8; x < PLANE_WIDTH - 10; x++)
                for (int c = 0; c < 4; c++)
                    assert_in_range(drawn.rgba8[4 * (y * PLANE_WIDTH + x + 5) + c] -
                                        other.rgba8[4 * (y * PLANE_WIDTH + x) + c] + 1,
                                    0, 2);
            for (int x = 0; x < PLANE_WIDTH; x++)
                assert_int_equal(other.holes[y * PLANE_WIDTH + x], x >= PLANE_WIDTH - 5 ? 255 : 0);
        }
    }
}

TEST_ON(test_constant, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    memset(plane.rgb8, 137, sizeof plane.rgb8);
    check_random random = {5};
    for (int i = 0; i < PLANE_PIXELS; i++) plane.depth[i] = (float)check_uniform(&random, 1.9, 2.1);
    plane_take(warp, &plane, NULL);
    for (int k = 0; k < 4; k++) {
        const ewa_camera target = plane_camera_at(0.2 * k, 0.1 * k, 0.4 * k - 0.5);
        plane_draw(warp, &target, (ewa_warp_method)(k & 1), &drawn);
        for (int i = 0; i < PLANE_PIXELS; i++)
            for (int c = 0; c < 3; c++) assert_true(!drawn.rgba8[4 * i + 3] || drawn.rgba8[4 * i + c] == 137);
    }
}

/// A white half at 1 before a black one at 2, moved by 6 and 3 pixels: where the edge is, how wide, and the
/// three columns that nothing fills.
TEST_ON(test_step, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const bool near = i % PLANE_WIDTH < 40;
        plane.depth[i] = near ? 1 : 2;
        memset(plane.rgb8 + 3 * i, near ? 255 : 0, 3);
    }
    plane_take(warp, &plane, NULL);
    const double move = 6 / 80.0;
    const ewa_camera right = plane_camera_at(move, 0, 0), left = plane_camera_at(-move, 0, 0);
    for (int y = 8; y < PLANE_HEIGHT - 8; y++) {
        // From the right: near columns end at 34, far ones begin at 37.
        plane_draw(warp, &right, EWA_WARP_MCMILLAN, &drawn);
        for (int x = 0; x < 90; x++) {
            const int at = y * PLANE_WIDTH + x;
            assert_int_equal(drawn.holes[at], x >= 34 && x < 37 ? 255 : 0);
            if (!drawn.holes[at]) assert_int_equal(drawn.rgba8[4 * at], x < 34 ? 255 : 0);
        }
    }
    plane_draw(warp, &right, EWA_WARP_HYBRID, &other);
    for (int y = 8; y < PLANE_HEIGHT - 8; y++)
        for (int x = 0; x < 90; x++) {
            const int at = y * PLANE_WIDTH + x;
            assert_int_equal(other.holes[at], drawn.holes[at]);
            if (x < 34) assert_in_range(other.rgba8[4 * at], 250, 255);
            if (x >= 37) assert_in_range(other.rgba8[4 * at], 0, 5);
        }
    // From the left the near half hides the far one: no hole, and an edge of one pixel.
    plane_draw(warp, &left, EWA_WARP_HYBRID, &other);
    for (int y = 8; y < PLANE_HEIGHT - 8; y++)
        for (int x = 8; x < PLANE_WIDTH; x++) {
            const int at = y * PLANE_WIDTH + x;
            assert_int_equal(other.holes[at], 0);
            if (x < 46) assert_in_range(other.rgba8[4 * at], 250, 255);
            if (x > 46) assert_in_range(other.rgba8[4 * at], 0, 5);
        }
}

/// What hangs between two surfaces is dropped, unless it is asked for.
TEST_ON(test_flying, 1) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const int x = i % PLANE_WIDTH;
        plane.depth[i] = x < 40 ? 1 : x == 40 ? 1.4f : 2;
    }
    ewa_warp_facts facts;
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.flying_count, PLANE_HEIGHT);
    assert_int_equal(facts.sample_count, PLANE_PIXELS - PLANE_HEIGHT);
    WITH_DEFAULTS(ewa_warp_options, options);
    options.drop_flying = false;
    assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &options, &facts), EWA_OK);
    assert_int_equal(facts.sample_count, PLANE_PIXELS);
    // A wire in front of a wall is a surface.
    for (int i = 0; i < PLANE_PIXELS; i++) plane.depth[i] = i % PLANE_WIDTH == 40 ? 1 : 2;
    plane_take(warp, &plane, &facts);
    assert_int_equal(facts.sample_count, PLANE_PIXELS);
}

/// Rows and columns without depth, as depth cameras leave them, are covered; wider gaps are not.
TEST_ON(test_lattice, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    const ewa_camera target = plane_camera_at(0.02, 0.01, 0.3);
    for (int gap = 1; gap < 3; gap++) {
        plane_set(&plane, 2);
        for (int i = 0; i < PLANE_PIXELS; i++)
            if (i % PLANE_WIDTH % 6 < gap || i / PLANE_WIDTH % 6 < gap) plane.depth[i] = 0;
        plane_take(warp, &plane, NULL);
        plane_draw(warp, &target, EWA_WARP_HYBRID, &drawn);
        int hole_count = 0;
        for (int i = 0; i < PLANE_PIXELS; i++) hole_count += drawn.holes[i] > 0;
        assert_true(gap == 1 ? hole_count == 0 : hole_count > PLANE_PIXELS / 20);
    }
}

/// Steps of a sensor fade out; edges stay.
TEST_ON(test_noise, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    const float step = 0.004f;
    check_random random = {9};
    for (int i = 0; i < PLANE_PIXELS; i++) {
        const float key =
            (i % PLANE_WIDTH < 48 ? 1.0f : 0.5f) + step * (check_random_u64(&random) & 1 ? 0.5f : -0.5f);
        plane.depth[i] = 1 / key;
    }
    double error[2];
    for (int k = 0; k < 2; k++) {
        WITH_DEFAULTS(ewa_warp_options, options);
        options.depth_noise = k ? (double)step : 0;
        assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &options, NULL), EWA_OK);
        plane_draw(warp, &plane.image.camera, EWA_WARP_HYBRID, &drawn);
        error[k] = 0;
        for (int i = 0; i < PLANE_PIXELS; i++) {
            const int x = i % PLANE_WIDTH;
            if (x < 46 || x > 49)
                error[k] = fmax(error[k], fabs((double)drawn.depth[i] * (x < 48 ? 1 : 0.5) - 1));
        }
    }
    assert_true(error[0] > 1.5e-3 && error[1] < 0.6 * error[0]);
}

/// Two views of one plane, in either order.
TEST_ON(test_source_order, 2) {
    static plane_image second;
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    plane_set(&second, 2.5);
    second.image.camera = plane_camera_at(0.3, 0.1, 0);
    const ewa_depth_image forward[2] = {plane.image, second.image}, backward[2] = {second.image, plane.image};
    const ewa_camera target = plane_camera_at(0.1507, 0.0011, 0.1);
    for (int method = 0; method < 2; method++) {
        assert_int_equal(ewa_warp_take(warp, forward, 2, NULL, NULL), EWA_OK);
        plane_draw(warp, &target, (ewa_warp_method)method, &drawn);
        assert_int_equal(ewa_warp_take(warp, backward, 2, NULL, NULL), EWA_OK);
        plane_draw(warp, &target, (ewa_warp_method)method, &other);
        assert_memory_equal(drawn.holes, other.holes, sizeof drawn.holes);
        for (int i = 0; i < 4 * PLANE_PIXELS; i++) assert_in_range(drawn.rgba8[i] - other.rgba8[i] + 1, 0, 2);
    }
}

/// The same bytes from any number of threads and every instruction set, also from ragged sizes and noise.
TEST(test_same_bytes) {
    static plane_frame first[2];
    static const struct {
        uint32_t threads, mask;
    } machines[] = {{1, 0}, {3, 0}, {2, EWA_CPU_AVX2}, {1, EWA_CPU_ALL}, {5, EWA_CPU_ALL}};
    check_random random = {77};
    plane_set(&plane, 2);
    for (int i = 0; i < PLANE_PIXELS; i++)
        plane.depth[i] =
            check_uniform(&random, 0, 1) < 0.1 ? NAN : (float)(2 + 0.3 * sin(0.1 * (i % 61)) + (i % 53 < 20));
    plane.image.camera.width_px = 61;
    plane.image.camera.height_px = 53;
    for (size_t k = 0; k < sizeof machines / sizeof machines[0]; k++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(machines[k].threads, machines[k].mask);
        OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
        WITH_DEFAULTS(ewa_warp_options, warp_options);
        warp_options.depth_noise = 0.002;
        assert_int_equal(ewa_warp_take(warp, &plane.image, 1, &warp_options, NULL), EWA_OK);
        const ewa_camera target = plane_camera_at(0.1, 0.2, 0.3);
        for (int method = 0; method < 2; method++) {
            plane_draw(warp, &target, (ewa_warp_method)method, &drawn);
            if (k == 0) first[method] = drawn;
            assert_memory_equal(&first[method], &drawn, sizeof drawn);
        }
    }
}

/// A camera behind the scene, one inside of it, one that looks away; the backs of all samples are dropped on
/// request.
TEST_ON(test_strange_cameras, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    plane_take(warp, &plane, NULL);
    ewa_camera behind = plane_camera();
    const double eye[3] = {0, 0, 4}, target[3] = {0, 0, 2}, away[3] = {0, 0, 9}, up[3] = {0, -1, 0};
    assert_int_equal(ewa_camera_look_at(&behind, eye, target, up), EWA_OK);
    ewa_render_options options;
    ewa_warp_render_options_init(&options, sizeof options);
    const ewa_frame frame = {.rgba8 = drawn.rgba8};
    for (int method = 0; method < 2; method++) {
        for (int cull = 0; cull < 2; cull++) {
            options.cull = (ewa_cull)cull;
            assert_int_equal(
                ewa_warp_draw(warp, &behind, (ewa_warp_method)method, &options, &frame, drawn.holes, NULL),
                EWA_OK);
            assert_int_equal(drawn.holes[PLANE_PIXELS / 2 + PLANE_WIDTH / 2], cull ? 255 : 0);
        }
        ewa_camera inside = plane_camera_at(0, 0, 1.999), blind = plane_camera();
        assert_int_equal(ewa_camera_look_at(&blind, eye, away, up), EWA_OK);
        plane_draw(warp, &inside, (ewa_warp_method)method, &drawn);
        plane_draw(warp, &blind, (ewa_warp_method)method, &drawn);
        for (int i = 0; i < PLANE_PIXELS; i++) assert_int_equal(drawn.holes[i], 255);
    }
}

/// The background behind holes is the renderer's, whether or not the holes are asked for.
TEST_ON(test_background, 2) {
    OWNED(ewa_warp_destroy) ewa_warp *warp = plane_warp(context);
    plane_set(&plane, 2);
    plane_take(warp, &plane, NULL);
    ewa_render_options options;
    ewa_warp_render_options_init(&options, sizeof options);
    const float background[4] = {0.2f, 0.5f, 0.9f, 0.5f};
    memcpy(options.background, background, sizeof background);
    const ewa_camera target = plane_camera_at(0.4, 0.1, -0.3);
    const ewa_frame a = {.rgba8 = drawn.rgba8, .rgba = drawn.rgba},
                    b = {.rgba8 = other.rgba8, .rgba = other.rgba};
    assert_int_equal(ewa_warp_draw(warp, &target, EWA_WARP_HYBRID, &options, &a, drawn.holes, NULL), EWA_OK);
    assert_int_equal(ewa_warp_draw(warp, &target, EWA_WARP_HYBRID, &options, &b, NULL, NULL), EWA_OK);
    for (int i = 0; i < 4 * PLANE_PIXELS; i++) {
        assert_in_range(drawn.rgba8[i] - other.rgba8[i] + 1, 0, 2);
        assert_true(fabsf(drawn.rgba[i] - other.rgba[i]) < 1e-5f);
    }
}

/// Known answers of the measures that docs/warp.md uses.
TEST(test_likeness) {
    enum { SIDE = 32, COUNT = SIDE * SIDE };
    static uint8_t a[3 * COUNT], b[3 * COUNT], counts[COUNT];
    check_random random = {1};
    for (int i = 0; i < 3 * COUNT; i++) a[i] = (uint8_t)(100 + (check_random_u64(&random) & 31));
    memcpy(b, a, sizeof a);
    picture_likeness same = picture_compare(SIDE, SIDE, a, b, NULL);
    assert_true(isinf(same.psnr_db) && fabs(same.ssim - 1) < 1e-12);
    for (int i = 0; i < 3 * COUNT; i++) b[i] = (uint8_t)(a[i] + 10);
    same = picture_compare(SIDE, SIDE, a, b, NULL);
    assert_true(fabs(same.psnr_db - 20 * log10(25.5)) < 1e-9);
    // A constant offset changes the luminance term only: (2 m (m + 10) + c) / (m^2 + (m + 10)^2 + c).
    const double m = 115.5, c = 2.55 * 2.55;
    assert_true(fabs(same.ssim - (2 * m * (m + 10) + c) / (m * m + (m + 10) * (m + 10) + c)) < 1e-3);
    for (int i = 0; i < 3 * COUNT; i++) b[i] = (uint8_t)(231 - a[i]); // the negative
    assert_true(picture_compare(SIDE, SIDE, a, b, NULL).ssim < -0.1);
    // Pixels that do not count may hold anything.
    memcpy(b, a, sizeof a);
    memset(counts, 1, sizeof counts);
    memset(b + 3 * 40, 0, 9);
    memset(counts + 40, 0, 3);
    same = picture_compare(SIDE, SIDE, a, b, counts);
    assert_true(isinf(same.psnr_db) && fabs(same.ssim - 1) < 1e-12 && same.pixel_count == COUNT - 3);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
