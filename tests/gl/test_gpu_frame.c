// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a frame asks of the device (ewa_renderer_info), and its stages' times by the device's clock.
#include "gpu_scene.h"

enum { POINTS = 2000, WIDTH_PX = 96, HEIGHT_PX = 72 };

static uint8_t rgba8[4 * GPU_MAX_PX * GPU_MAX_PX];

static ewa_renderer_info info_of(const ewa_renderer *renderer) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_renderer_describe(renderer, &info), EWA_OK);
    return info;
}

/// Makes a scene, and a renderer of its frames by the device.
static ewa_renderer *make(gpu_scene *at) {
    gpu_scene_make(at, POINTS, WIDTH_PX, HEIGHT_PX);
    ewa_renderer *renderer = NULL;
    assert_int_equal(ewa_renderer_create_on(at->context, EWA_BACKEND_GL, &renderer), EWA_OK);
    return renderer;
}

/// A default frame waits once, reads once and sends the same whatever the size of the cloud; and all its programs are few.
TEST(test_counts) {
    enum { DISPATCHES = 12 };
    OWNED(gpu_scene_free) gpu_scene at;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(&at);
    assert_int_equal(info_of(renderer).wait_count, 0);
    assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    const ewa_renderer_info first = info_of(renderer);
    assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    const ewa_renderer_info second = info_of(renderer);
    assert_int_equal(second.wait_count, 1);
    assert_int_equal(second.readback_count, 1);
    assert_in_range(second.dispatch_count, 6, DISPATCHES);
    // The surfels are there by now.
    enum { SURFEL_BYTES = 30 };
    assert_true(second.upload_bytes > 0 && second.upload_bytes + SURFEL_BYTES * POINTS <= first.upload_bytes);
    gpu_scene ten;
    gpu_scene_make(&ten, 10 * POINTS, WIDTH_PX, HEIGHT_PX);
    for (int frame = 0; frame < 2; frame++) {
        const ewa_frame planes = {.rgba8 = rgba8};
        assert_int_equal(ewa_render(renderer, ten.surfels, &at.camera, &at.options, &planes, NULL), EWA_OK);
    }
    const ewa_renderer_info of_ten = info_of(renderer);
    assert_int_equal(of_ten.wait_count, 1);
    assert_int_equal(of_ten.dispatch_count, second.dispatch_count);
    assert_int_equal(of_ten.upload_bytes, second.upload_bytes);
    gpu_scene_free(&ten);
    ewa_renderer_destroy(&renderer);
    assert_int_equal(ewa_renderer_create(at.context, &renderer), EWA_OK);
    assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    const ewa_renderer_info none = info_of(renderer);
    assert_true(none.wait_count + none.readback_count + none.dispatch_count == 0 && none.upload_bytes + none.readback_bytes == 0);
}

/// Eye-dome lighting is a program more, and nothing else: its depths and colours stay on the device.
TEST(test_eye_dome) {
    OWNED(gpu_scene_free) gpu_scene at;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(&at);
    ewa_renderer_info infos[2];
    for (int lit = 0; lit < 2; lit++) {
        at.options.eye_dome = lit;
        for (int frame = 0; frame < 2; frame++) assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&at, rgba8));
        infos[lit] = info_of(renderer);
    }
    assert_int_equal(infos[1].wait_count, 1);
    assert_int_equal(infos[1].readback_count, 1);
    assert_int_equal(infos[1].dispatch_count, infos[0].dispatch_count + 1);
    assert_int_equal(infos[1].upload_bytes, infos[0].upload_bytes);
    assert_int_equal(infos[1].readback_bytes, infos[0].readback_bytes);
}

/// Of pixels in parts the averages are read, not the parts.
TEST(test_parts) {
    enum { HEAD_BYTES = 64 };
    OWNED(gpu_scene_free) gpu_scene at;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(&at);
    const uint32_t divisions[] = {1, 2, 4, 3};
    for (int i = 0; i < 4; i++) {
        at.options.supersampling = divisions[i];
        for (int frame = 0; frame < 2; frame++) assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&at, rgba8));
        const ewa_renderer_info info = info_of(renderer);
        const uint64_t pixels = WIDTH_PX * HEIGHT_PX, parts = pixels * divisions[i] * divisions[i];
        assert_int_equal(info.wait_count, 1);
        assert_int_equal(info.readback_count, 1);
        // Bytes; colours; of divisions that no tile is a multiple of, those of all parts.
        const uint64_t wanted = divisions[i] == 1 ? 4 * pixels : divisions[i] == 3 ? 16 * parts : 16 * pixels;
        assert_int_equal(info.readback_bytes, HEAD_BYTES + wanted);
    }
}

/// Of a camera among the surfels some touch the eye's plane, which the host draws up: one wait more. It gets them, and from
/// elsewhere the frame is as ever.
TEST(test_near) {
    OWNED(gpu_scene_free) gpu_scene at;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(&at);
    const ewa_camera outside = at.camera;
    const double *low = at.bounds.low_world, *high = at.bounds.high_world, z = (low[2] + high[2]) / 2;
    const double eye[3] = {high[0], (low[1] + high[1]) / 2, z}, along[3] = {high[0], high[1], z}, up[3] = {0, 0, 1};
    for (int frame = 0; frame < 6; frame++) {
        const bool near = frame == 1 || frame == 2;
        at.camera = outside;
        if (near) assert_int_equal(ewa_camera_look_at(&at.camera, eye, along, up), EWA_OK);
        assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&at, rgba8));
        if (frame == 2) assert_int_equal(info_of(renderer).wait_count, 2);
        if (frame > 3) assert_int_equal(info_of(renderer).wait_count, 1);
    }
}

/// Rows that did not fit the device are remembered: the next frame tries no others, and nobody is told again.
TEST(test_memory) {
    OWNED(gpu_scene_free) gpu_scene at;
    gpu_scene_make(&at, POINTS, GPU_MAX_PX, GPU_MAX_PX);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
    assert_int_equal(setenv("EWA_GL_TUNING", "storage=9000000", 1), 0);
    assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_OK);
    assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
    assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    const int told = at.log.count;
    assert_true(told > 0);
    for (int frame = 0; frame < 2; frame++) assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
    assert_int_equal(at.log.count, told);
    assert_true(gpu_scene_same(&at, rgba8));
    const uint32_t bands = info_of(renderer).wait_count;
    assert_in_range(bands, 2, GPU_MAX_PX / 128);
    assert_true(info_of(renderer).dispatch_count <= 12 * bands);
}

/// A first frame is given in parts by what surfels are thought to take: 2,000 of 0.11 ms in five, so that there are 16 dispatches
/// more in each of its turns: of set-up, visibility, sums and edges. The next by what they took.
TEST(test_first_frame) {
    static const char *const tunings[] = {"", "surfel_ns=1", "surfel_ns=110000"};
    uint32_t counts[3];
    for (int i = 0; i < 3; i++) {
        OWNED(gpu_scene_free) gpu_scene at;
        gpu_scene_make(&at, POINTS, WIDTH_PX, HEIGHT_PX);
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
        assert_int_equal(setenv("EWA_GL_TUNING", tunings[i], 1), 0);
        assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_OK);
        assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
        assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
        assert_true(gpu_scene_same(&at, rgba8));
        counts[i] = info_of(renderer).dispatch_count;
        const uint32_t turns = info_of(renderer).wait_count;
        if (i == 2) assert_int_equal(counts[2], counts[0] + 16 * turns);
    }
    assert_int_equal(counts[1], counts[0]);
}

/// What lies behind edges is gone over in rounds, each of so many units of a tile: the first frame finds out how many, and waits
/// after each that was too few, the next does them at once. Eye-dome lighting and averages come after the last.
TEST(test_rounds) {
    OWNED(gpu_scene_free) gpu_scene at;
    gpu_scene_make(&at, POINTS, WIDTH_PX, HEIGHT_PX);
    at.options.edge_layers = 8;
    for (int kind = 0; kind < 3; kind++) {
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = NULL;
        assert_int_equal(setenv("EWA_GL_TUNING", "unit=16 edge_units=1", 1), 0);
        assert_int_equal(ewa_renderer_create_on(at.context, EWA_BACKEND_GL, &renderer), EWA_OK);
        assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
        at.options.supersampling = kind == 1 ? 2 : 1, at.options.eye_dome = kind == 2;
        for (int frame = 0; frame < 2; frame++) {
            assert_int_equal(gpu_scene_draw(&at, renderer, rgba8), EWA_OK);
            assert_true(gpu_scene_same(&at, rgba8));
            const uint32_t waits = info_of(renderer).wait_count;
            if (frame)
                assert_int_equal(waits, 1);
            else
                assert_true(waits > 2);
        }
        const uint32_t dispatches = info_of(renderer).dispatch_count;
        print_message("%u dispatches\n", dispatches);
        assert_in_range(dispatches, 13, 500);
    }
}

TEST(test_times) {
    OWNED(gpu_scene_free) gpu_scene at;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = make(&at);
    for (int frame = 0; frame < 2; frame++) {
        ewa_render_stats stats;
        const ewa_frame planes = {.rgba8 = rgba8};
        assert_int_equal(ewa_render(renderer, at.surfels, &at.camera, &at.options, &planes, &stats), EWA_OK);
        const double stages[] = {stats.setup_s, stats.visibility_s, stats.accumulate_s, stats.edge_s, stats.resolve_s};
        double sum_s = stats.bin_s;
        for (size_t i = 0; i < sizeof stages / sizeof stages[0]; i++) {
            assert_true(stages[i] > 0);
            sum_s += stages[i];
        }
        assert_true(sum_s <= 1.01 * stats.total_s);
    }
}

int main(void) {
    if (!gpu_there()) return 77;
    return RUN_TESTS(NULL, NULL);
}
