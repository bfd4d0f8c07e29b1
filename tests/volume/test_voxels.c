// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of volumes, and what both it and the renderer refuse or survive.
#include "check.h"
#include "reference/volume.h"
#include "volume/classify.h"
#include "volume/scene.h"

#include <math.h>
#include <string.h>

static const double UNIT[3] = {1, 1, 1}, DIRECTION[3] = {0.7, 0.4, -1};

TEST_ON(test_counts_and_bytes, 2) {
    static const uint32_t dims[3] = {61, 70, 83};
    const double radius = 22;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ball, &radius);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 1);
    uint64_t occupied = 0;
    for (size_t i = 0; i < (size_t)61 * 70 * 83; i++) occupied += ((float *)volume.voxels)[i] > 0;
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    ewa_voxels_info info;
    ewa_voxels_describe(voxels, &info);
    assert_int_equal(info.occupied_count, occupied);
    assert_int_equal(info.voxel_count, 61 * 70 * 83);
    assert_int_equal(info.block_count, 8 * 9 * 11);
    assert_true(info.skipped_count > 300);
    assert_true(info.resident_bytes < 32 * occupied);
    for (int axis = 0; axis < 3; axis++) {
        assert_true(fabs(info.bounds.low_world[axis] + radius) < 1);
        assert_true(fabs(info.bounds.high_world[axis] - radius) < 1);
    }
    ewa_voxels_destroy(&voxels);
    assert_null(voxels);
}

/// Where a volume is does not matter, nor in which type its numbers are, nor what is NaN or out of range.
TEST_ON(test_types_and_holes, 2) {
    static const uint32_t dims[3] = {20, 20, 20};
    enum { COUNT = 8000 };
    ewa_transfer transfer = {.point_count = 2, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){10, {1, 1, 1}, 0.5f};
    transfer.points[1] = (ewa_transfer_point){100, {1, 0, 0}, 1};
    static const ewa_type types[] = {EWA_U8, EWA_I8, EWA_U16, EWA_I16, EWA_F32};
    const ewa_camera camera = scene_camera(60, 60, DIRECTION, 60);
    WITH_DEFAULTS(ewa_volume_options, options);
    OWNED(ewa_image_free) ewa_image first = {0};
    for (int t = 0; t < 5; t++) {
        OWNED(ewa_volume_free) ewa_volume volume;
        assert_int_equal(ewa_volume_create(context, dims, types[t], &volume), EWA_OK);
        for (int i = 0; i < COUNT; i++) {
            const int value = i % 125;
            switch (types[t]) {
            case EWA_U8:
                ((uint8_t *)volume.voxels)[i] = (uint8_t)value;
                break;
            case EWA_I8:
                ((int8_t *)volume.voxels)[i] = (int8_t)value;
                break;
            case EWA_U16:
                ((uint16_t *)volume.voxels)[i] = (uint16_t)value;
                break;
            case EWA_I16:
                ((int16_t *)volume.voxels)[i] = (int16_t)value;
                break;
            default:
                ((float *)volume.voxels)[i] = value > 100 ? NAN : (float)value;
            }
        }
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        ewa_image image = scene_draw(context, voxels, &camera, &options);
        for (int i = 0; i < 4 * 60 * 60; i++) assert_true(isfinite(image.pixels[i]));
        if (t) {
            assert_memory_equal(image.pixels, first.pixels, 4 * 60 * 60 * sizeof(float));
            ewa_image_free(&image);
        } else {
            first = image;
        }
    }
}

static void refuse(ewa_context *context, const ewa_volume *volume, const ewa_transfer *transfer,
                   check_log *log, const char *part) {
    (void)context;
    ewa_voxels *voxels = (ewa_voxels *)(uintptr_t)64;
    assert_int_equal(ewa_voxels_create(volume, transfer, NULL, &voxels), EWA_ERROR_ARGUMENT);
    assert_null(voxels);
    if (!strstr(log->text, part)) print_message("%s\n", log->text);
    assert_non_null(strstr(log->text, part));
}

/// A volume of values that are a plane has that plane's gradient in every voxel, the border among them, and
/// for every type. Around it in memory lie other numbers, that no border may look at.
TEST_ON(test_gradients_up_to_the_border, 1) {
    enum { GUARD = 400, MAXIMUM = 7 * 6 * 9 };
    static const uint32_t shapes[][3] = {{7, 6, 3}, {3, 7, 6}, {6, 3, 7}, {2, 5, 9}, {5, 2, 2}, {4, 4, 4}};
    static const ewa_type types[] = {EWA_U8, EWA_I8, EWA_U16, EWA_I16, EWA_F32};
    static union {
        uint8_t u8[MAXIMUM + 2 * GUARD];
        int8_t i8[MAXIMUM + 2 * GUARD];
        uint16_t u16[MAXIMUM + 2 * GUARD];
        int16_t i16[MAXIMUM + 2 * GUARD];
        float f32[MAXIMUM + 2 * GUARD];
    } numbers;
    ewa_transfer transfer = {.point_count = 2, .unit_length_world = 1};
    transfer.points[0] = (ewa_transfer_point){-1000, {1, 1, 1}, 1};
    transfer.points[1] = (ewa_transfer_point){1000, {1, 1, 1}, 1};
    for (int k = 0; k < 30; k++) {
        ewa_volume volume = {.type = types[k % 5], .index_to_world = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0}};
        memcpy(volume.dims, shapes[k / 5], sizeof volume.dims);
        const uint32_t *dims = volume.dims, count = dims[0] * dims[1] * dims[2];
        for (uint32_t n = 0; n < MAXIMUM + 2 * GUARD; n++) {
            const uint32_t at = n - GUARD;
            const bool inside = at < count; // what comes before wraps around
            const int value =
                inside
                    ? (int)(3 * (at % dims[0]) + 8 * (at / dims[0] % dims[1]) + 5 * (at / dims[0] / dims[1]))
                    : 119 - (int)(n % 7);
            switch (volume.type) {
            case EWA_U8:
                numbers.u8[n] = (uint8_t)value;
                break;
            case EWA_I8:
                numbers.i8[n] = (int8_t)value;
                break;
            case EWA_U16:
                numbers.u16[n] = (uint16_t)value;
                break;
            case EWA_I16:
                numbers.i16[n] = (int16_t)value;
                break;
            default:
                numbers.f32[n] = (float)value;
            }
        }
        static const size_t bytes[] = {1, 1, 2, 2, 4};
        volume.voxels = numbers.u8 + GUARD * bytes[k % 5];
        ewa_classifier classifier;
        assert_int_equal(ewa_classifier_make(context, &volume, &transfer, &classifier), EWA_OK);
        const double expected[3] = {3, 4, 5.0 / 3}, length = sqrt(9 + 16 + 25.0 / 9);
        for (uint32_t n = 0; n < count; n++) {
            ewa_voxel voxel;
            assert_true(ewa_classify(&classifier, n % dims[0], n / dims[0] % dims[1], n / dims[0] / dims[1],
                                     true, &voxel));
            assert_float_equal(voxel.normal_world.x, -expected[0] / length, 1e-9);
            assert_float_equal(voxel.normal_world.y, -expected[1] / length, 1e-9);
            assert_float_equal(voxel.normal_world.z, -expected[2] / length, 1e-9);
        }
    }
}

TEST(test_bad_input) {
    static const uint32_t dims[3] = {4, 4, 4};
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    ewa_transfer transfer = scene_linear(1, 1, 1, 1);
    ewa_volume wrong = volume;
    wrong.index_to_world[5] = 0;
    refuse(context, &wrong, &transfer, &log, "not invertible");
    wrong.index_to_world[5] = NAN;
    refuse(context, &wrong, &transfer, &log, "index_to_world[5]");
    wrong = volume;
    wrong.dims[1] = 0;
    refuse(context, &wrong, &transfer, &log, "4 x 0 x 4");
    wrong = volume;
    wrong.type = EWA_F64;
    refuse(context, &wrong, &transfer, &log, "type");
    wrong = volume;
    wrong.voxels = NULL;
    refuse(context, &wrong, &transfer, &log, "no voxels");
    transfer.points[1].value = -1;
    refuse(context, &volume, &transfer, &log, "point 1");
    transfer.point_count = 1;
    refuse(context, &volume, &transfer, &log, "1 points");
}

TEST(test_bad_options) {
    static const uint32_t dims[3] = {4, 4, 4};
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 1);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer;
    assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
    const ewa_camera camera = scene_camera(8, 8, DIRECTION, 20);
    float pixels[4 * 8 * 8];
    ewa_frame frame = {.rgba = pixels};
    WITH_DEFAULTS(ewa_volume_options, good);
    for (int i = 0; i < 14; i++) {
        ewa_volume_options bad = good;
        switch (i) {
        case 0:
            bad.struct_size = 1;
            break;
        case 1:
            bad.sigma = NAN;
            break;
        case 2:
            bad.cutoff = 0;
            break;
        case 3:
            bad.method = (ewa_volume_method)7;
            break;
        case 4:
            bad.index = (ewa_volume_index)7;
            break;
        case 5:
            bad.level = 2;
            break;
        case 6:
            bad.minimum_transmittance = 1;
            break;
        case 7:
            bad.surface_depth = pixels;
            break;
        case 8:
            bad.material.shininess = 0;
            break;
        case 9:
            bad.background[3] = 2;
            break;
        case 10:
            bad.light_count = 9;
            break;
        case 11:
            bad.surface_normal = pixels;
            break;
        case 12:
            bad.surface_coverage = pixels;
            break;
        default:
            bad.depth_unit = 0;
        }
        log.text[0] = 0;
        assert_int_equal(ewa_volume_render(renderer, voxels, &camera, &bad, &frame, NULL),
                         EWA_ERROR_ARGUMENT);
        assert_true(log.text[0] != 0);
        if (i == 5 || i == 6) continue; // not looked at
        assert_int_equal(ewa_volume_render_reference(&volume, &transfer, &camera, &bad, &frame),
                         EWA_ERROR_ARGUMENT);
    }
}

/// Everything from volume to picture; the status of what fails first.
static ewa_status draw_all(ewa_context *context, uint32_t frames, const check_memory *memory, long *calls) {
    static const uint32_t dims[3] = {20, 20, 20};
    OWNED(ewa_volume_free) ewa_volume volume;
    ewa_status status = ewa_volume_create(context, dims, EWA_U8, &volume);
    if (status != EWA_OK) return status;
    for (int i = 0; i < 8000; i++) ((uint8_t *)volume.voxels)[i] = (uint8_t)(i % 3);
    const ewa_transfer transfer = scene_linear(1, 1, 1, 1);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = NULL;
    OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer = NULL;
    float pixels[4 * 70 * 70];
    float surface_depth[70 * 70], surface_rgba[4 * 70 * 70];
    for (int i = 0; i < 70 * 70; i++) surface_depth[i] = 2 + (float)(i % 70);
    memset(surface_rgba, 0, sizeof surface_rgba);
    const ewa_frame frame = {.rgba = pixels};
    // From without, and from within with a surface: voxels at the eye, too.
    const ewa_camera cameras[2] = {scene_camera(70, 70, DIRECTION, 50), scene_camera(70, 70, DIRECTION, 5)};
    ewa_volume_options options[2];
    for (int i = 0; i < 2; i++) ewa_volume_options_init(&options[i], sizeof options[i]);
    options[1].surface_depth = surface_depth, options[1].surface_rgba = surface_rgba;
    status = ewa_voxels_create(&volume, &transfer, NULL, &voxels);
    if (status == EWA_OK) status = ewa_volume_renderer_create(context, &renderer);
    for (uint32_t i = 0; i < frames && status == EWA_OK; i++) {
        for (int view = 0; view < 2 && status == EWA_OK; view++)
            status = ewa_volume_render(renderer, voxels, &cameras[view], &options[view], &frame, NULL);
        if (calls) calls[i] = memory->calls_left;
    }
    for (int view = 0; view < 2 && status == EWA_OK; view++)
        status = ewa_volume_render_reference(&volume, &transfer, &cameras[view], &options[view], &frame);
    return status;
}

TEST(test_failing_memory) {
    check_memory memory = {.calls_left = -1};
    ewa_context *context = check_context_on(2, &memory);
    const int64_t held_bytes = memory.held_bytes;
    long failed = 0;
    for (;; failed++) {
        memory.calls_left = failed;
        const ewa_status status = draw_all(context, 1, &memory, NULL);
        assert_int_equal(memory.held_bytes, held_bytes);
        if (status == EWA_OK) break;
        assert_int_equal(status, EWA_ERROR_MEMORY);
    }
    assert_true(failed > 40);
    // A warm frame allocates nothing.
    long calls[3];
    memory.calls_left = 1000;
    assert_int_equal(draw_all(context, 3, &memory, calls), EWA_OK);
    assert_int_equal(calls[1], calls[0]);
    assert_int_equal(calls[2], calls[0]);
    ewa_context_destroy(&context);
    assert_int_equal(memory.held_bytes, 0);
}

/// From within, from behind, from far away, of nothing: finite pictures.
TEST_ON(test_odd_views, 2) {
    static const uint32_t dims[3] = {30, 30, 30};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfers[2] = {scene_linear(1, 1, 1, 0.2f), scene_linear(1, 1, 1, 0)};
    for (int empty = 0; empty < 2; empty++) {
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfers[empty]);
        static const double distances[] = {0.1, 3, 15, 17, 1e4, 1e9};
        for (int view = 0; view < 12; view++) {
            ewa_camera camera = scene_camera(70, 50, DIRECTION, distances[view % 6]);
            if (view >= 6) assert_int_equal(ewa_camera_set_ortho(&camera, distances[view % 6]), EWA_OK);
            WITH_DEFAULTS(ewa_volume_options, options);
            options.shading = EWA_SHADING_PHONG;
            options.method = (ewa_volume_method)(view % 3);
            ewa_image image = scene_draw(context, voxels, &camera, &options);
            double sum = 0;
            for (int i = 0; i < 4 * 70 * 50; i++) {
                assert_true(image.pixels[i] >= 0 && image.pixels[i] < 1.5f);
                sum += (double)image.pixels[i];
            }
            if (empty) assert_true(sum == 0);
            if (!empty && view < 2) assert_true(sum > 0); // the fog around the eye
            ewa_image_free(&image);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
