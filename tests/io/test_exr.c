// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/exr_*.c: exact round trips, channels by name, the camera attribute, broken files.
#include "base/base.h"
#include "scratch.h"

#include <math.h>
#include <openexr.h>

static ewa_image make_image(ewa_context *context, uint32_t width, uint32_t height, uint32_t channels) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, width, height, channels, &image), EWA_OK);
    check_random random = {width + 100 * channels};
    const size_t count = (size_t)width * height * channels;
    for (size_t i = 0; i < count; i++)
        image.pixels[i] = i % 3 ? (float)check_uniform(&random, -1, 1) : (float)(i / channels % width);
    return image;
}

static void assert_same(const ewa_image *a, const ewa_image *b) {
    assert_int_equal(a->width_px, b->width_px);
    assert_int_equal(a->height_px, b->height_px);
    assert_int_equal(a->channel_count, b->channel_count);
    assert_memory_equal(a->pixels, b->pixels,
                        (size_t)a->width_px * a->height_px * a->channel_count * sizeof(float));
}

TEST(test_round_trip_is_exact) {
    static const uint32_t sizes[][2] = {{1, 1}, {3, 16}, {17, 33}, {500, 1}, {1, 100}};
    char path[512];
    scratch_path("saved.exr", path);
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
            for (uint32_t channels = 1; channels <= 8; channels++) {
                OWNED(ewa_image_free) ewa_image image = make_image(context, sizes[s][0], sizes[s][1], channels), back;
                if (channels == 3) {
                    image.pixels[0] = NAN;
                    image.pixels[1] = -INFINITY;
                    image.pixels[2] = -0.0f;
                }
                WITH_DEFAULTS(ewa_image_save_options, options);
                if (channels == 2) options.channel_names = "A,Y"; // names in the order that a file sorts them
                if (channels > 4) options.channel_names = &"a,b,c,d,e,f,g,h"[2 * (8 - channels)];
                assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
                assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
                assert_same(&image, &back);
            }
        }
    }
}

TEST_ON(test_channels_go_by_name, 1) {
    char path[512];
    scratch_path("named.exr", path);
    OWNED(ewa_image_free) ewa_image image, back;
    assert_int_equal(ewa_image_create(context, 1, 1, 6, &image), EWA_OK);
    for (int i = 0; i < 6; i++) image.pixels[i] = (float)i;
    WITH_DEFAULTS(ewa_image_save_options, options);
    options.channel_names = "Z,B,N.X,G,A,R";
    assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    assert_int_equal(back.channel_count, 4);
    assert_true(back.pixels[0] == 5 && back.pixels[1] == 3 && back.pixels[2] == 1 && back.pixels[3] == 4);
    ewa_image_free(&back);
    options.channel_names = "Z,B,N.X,G,A,Q"; // no R: alphabetical
    assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    const float expected[6] = {4, 1, 3, 2, 5, 0}; // A B G N.X Q Z
    assert_int_equal(back.channel_count, 6);
    assert_memory_equal(back.pixels, expected, sizeof expected);
}

TEST_ON(test_half, 1) {
    char path[512];
    scratch_path("half.exr", path);
    OWNED(ewa_image_free) ewa_image image, back;
    assert_int_equal(ewa_image_create(context, 3, 1, 1, &image), EWA_OK);
    image.pixels[0] = 1.0f + 0x1p-10f; // exact in half
    image.pixels[1] = 1.0f + 0x1p-12f; // rounds to 1
    image.pixels[2] = 1e6f;            // overflows
    WITH_DEFAULTS(ewa_image_save_options, options);
    options.exr_half = true;
    assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    assert_true(back.pixels[0] == 1.0f + 0x1p-10f && back.pixels[1] == 1 && isinf(back.pixels[2]));
}

TEST_ON(test_camera_attribute, 1) {
    char path[512];
    scratch_path("camera.exr", path);
    ewa_camera camera;
    ewa_camera_init(&camera);
    const double eye[3] = {1, 2, 3}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    ewa_camera_look_at(&camera, eye, target, up);
    OWNED(ewa_image_free) ewa_image image = make_image(context, 4, 4, 3);
    WITH_DEFAULTS(ewa_image_save_options, options);
    options.world_to_camera = camera.world_to_camera;
    assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    assert_int_equal(exr_start_read(&file, path, &setup), EXR_ERR_SUCCESS);
    exr_attr_m44f_t matrix;
    assert_int_equal(exr_attr_get_m44f(file, 0, "worldToCamera", &matrix), EXR_ERR_SUCCESS);
    for (int r = 0; r < 4; r++) // row vectors: the translation is the last row
        for (int c = 0; c < 4; c++)
            assert_true(matrix.m[4 * r + c] == (float)camera.world_to_camera[4 * c + r]);
    exr_compression_t compression;
    assert_int_equal(exr_get_compression(file, 0, &compression), EXR_ERR_SUCCESS);
    assert_int_equal(compression, EXR_COMPRESSION_ZIP);
    exr_finish(&file);
}

TEST_LOGGED(test_names_are_checked, 1) {
    char path[512];
    scratch_path("misnamed.exr", path);
    remove(path);
    ewa_image image = make_image(context, 2, 2, 3);
    static const char *const wrong[] = {"R,G", "R,G,B,A", "R,,B", "", "R,G,R", "R,G,B,"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        WITH_DEFAULTS(ewa_image_save_options, options);
        options.channel_names = wrong[i];
        assert_int_equal(ewa_image_save(&image, path, &options), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, "misnamed.exr"));
    }
    ewa_image_free(&image);
    image = make_image(context, 2, 2, 5);
    assert_int_equal(ewa_image_save(&image, path, NULL), EWA_ERROR_ARGUMENT);
    ewa_image_free(&image);
    image = make_image(context, 2, 2, 3);
    assert_int_equal(ewa_image_save(&image, "/nowhere/x.exr", NULL), EWA_ERROR_IO);
    ewa_image_free(&image);
    assert_int_equal(access(path, F_OK), -1);
}

TEST_LOGGED(test_real_files, 1) {
    char path[512];
    ewa_image image;
    if (check_data("images/exr_sample.exr", path, sizeof path)) {
        // Luminance with subsampled chroma.
        assert_int_equal(ewa_image_load(context, path, &image), EWA_ERROR_UNSUPPORTED);
        assert_non_null(strstr(log->text, "channel BY is subsampled 2 x 2"));
    }
    if (check_data("images/env/KernerEnvCube.exr", path, sizeof path)) { // tiles with levels
        assert_int_equal(ewa_image_load(context, path, &image), EWA_OK);
        assert_int_equal(image.width_px, 256);
        assert_int_equal(image.height_px, 1536);
        // Every part of a photographed sky is lit: no tile was left out.
        for (uint32_t y = 0; y < image.height_px; y += 16)
            for (uint32_t x = 0; x < image.width_px; x += 16) {
                float sum = 0;
                for (uint32_t i = 0; i < 256; i++)
                    sum += image.pixels[((y + i / 16) * image.width_px + x + i % 16) * image.channel_count];
                assert_true(sum > 0);
            }
        ewa_image_free(&image);
    }
}

TEST(test_hostile) {
    scratch_pictures t = {0};
    t.context = check_context(1, &t.log);
    const int count = scratch_each("hostile/exr", scratch_load_picture, &t);
    print_message("%d of %d broken files refused\n", t.refused, count);
    assert_true(2 * t.refused >= count);
    ewa_context_destroy(&t.context);
}

TEST_LOGGED(test_every_truncation_is_refused, 1) {
    char path[512];
    ewa_image image = make_image(context, 5, 20, 3);
    assert_int_equal(ewa_image_save(&image, scratch_path("whole.exr", path), NULL), EWA_OK);
    ewa_image_free(&image);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    for (size_t length = 0; length < size_bytes; length++) {
        OWNED(check_free) uint8_t *exact = malloc(length ? length : 1);
        memcpy(exact, bytes, length);
        assert_int_equal(ewa_image_load_memory(context, exact, length, "cut.exr", &image), EWA_ERROR_FORMAT);
        assert_memory_equal(log->text, "cut.exr: ", 9);
    }
    for (size_t at = 0; at < size_bytes; at++) {
        bytes[at] ^= 0x55;
        if (ewa_image_load_memory(context, bytes, size_bytes, "flipped.exr", &image) == EWA_OK)
            ewa_image_free(&image);
        bytes[at] ^= 0x55;
    }
}

TEST_LOGGED(test_lost_chunk_table_is_refused, 1) {
    char path[512];
    ewa_image image = make_image(context, 5, 20, 3);
    assert_int_equal(ewa_image_save(&image, scratch_path("table.exr", path), NULL), EWA_OK);
    ewa_image_free(&image);
    size_t size_bytes, at = 0;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    // 20 lines are two chunks: the table's two offsets of 8 bytes, the first of which points just behind it.
    for (uint64_t offset = 0; offset != at + 16; memcpy(&offset, bytes + at, sizeof offset))
        assert_true(++at + 16 < size_bytes);
    memset(bytes + at, 0, 16);
    assert_int_equal(ewa_image_load_memory(context, bytes, size_bytes, "table.exr", &image),
                     EWA_ERROR_FORMAT);
    assert_memory_equal(log->text, "table.exr: OpenEXR: ", 20);
}

TEST(test_limits) {
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    char path[512];
    ewa_image image = make_image(context, 100, 100, 3);
    assert_int_equal(ewa_image_save(&image, scratch_path("limit.exr", path), NULL), EWA_OK);
    ewa_image_free(&image);
    ewa_context_destroy(&context);
    WITH_DEFAULTS(ewa_context_options, options);
    options.message = check_log_keep;
    options.message_user = &log;
    options.limits.max_memory_bytes = 100 * 100 * 3 * 4;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &image), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log.text, "177600 bytes are needed"));
    ewa_context_destroy(&context);
    options.limits.max_image_side = 99;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &image), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log.text, "100 x 100 pixels are over the limit of 99"));
}

static ewa_status save_work(ewa_context *context, void *user) {
    float pixels[4 * 40] = {0};
    const ewa_image image = {context, 1, 40, 4, pixels};
    return ewa_image_save(&image, user, NULL);
}

static ewa_status load_work(ewa_context *context, void *user) {
    OWNED(ewa_image_free) ewa_image image;
    const ewa_status status = ewa_image_load(context, user, &image);
    return status;
}

TEST(test_failing_allocations) {
    char path[512];
    scratch_path("memory.exr", path);
    scratch_fail_each(save_work, path);
    scratch_fail_each(load_work, path);
}

/// Not a check: prints how long a picture of 1280 x 1024 takes, with `--bench`.
static void bench(void) {
    char path[512];
    scratch_path("bench.exr", path);
    for (uint32_t threads = 1; threads <= 2; threads++) {
        for (int half = 0; half < 2; half++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
            OWNED(ewa_image_free) ewa_image image;
            assert_int_equal(ewa_image_create(context, 1280, 1024, 4, &image), EWA_OK);
            for (size_t i = 0; i < 1280 * 1024; i++) {
                const double dx = ((double)(i % 1280) - 640) / 480, dy = ((double)i / 1280 - 512) / 480;
                const double square = dx * dx + dy * dy;
                if (square >= 1) continue;
                for (int c = 0; c < 3; c++)
                    image.pixels[4 * i + c] =
                        (float)(sqrt(1 - square) * (0.5 + 0.1 * c + 0.3 * sin(40 * dx)));
                image.pixels[4 * i + 3] = 1;
            }
            WITH_DEFAULTS(ewa_image_save_options, options);
            options.exr_half = half;
            double save_s = 1e9, load_s = 1e9;
            for (int round = 0; round < 5; round++) {
                OWNED(ewa_image_free) ewa_image back;
                double start_s = ewa_now_s();
                assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
                save_s = fmin(save_s, ewa_now_s() - start_s);
                start_s = ewa_now_s();
                assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
                load_s = fmin(load_s, ewa_now_s() - start_s);
            }
            struct stat facts;
            stat(path, &facts);
            printf("%s RGBA, %u threads: write %6.1f ms, read %6.1f ms, %ld bytes\n", half ? "half" : "float",
                   threads, 1e3 * save_s, 1e3 * load_s, (long)facts.st_size);
        }
    }
}

int main(int argument_count, char **arguments) {
    if (argument_count > 1 && strcmp(arguments[1], "--bench") == 0) {
        bench();
        return 0;
    }
    return RUN_TESTS(NULL, NULL);
}
