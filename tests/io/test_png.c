// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/png_*.c: what is written is read back by libspng, known values, broken files.
#include "base/base.h"
#include "image/srgb.h"
#include "image_difference.h"
#include "scratch.h"

#include <libdeflate.h>
#include <math.h>
#include <time.h>

/// A picture with flat, smooth and noisy parts.
static uint8_t *make_codes(uint32_t width, uint32_t height, uint32_t channels) {
    uint8_t *codes = malloc((size_t)width * height * channels);
    check_random random = {width * 31 + height};
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channels; c++) {
                uint8_t value = 30;
                if (x > width / 3) value = (uint8_t)(x * 3 + y * 2 + c * 40);
                if (x > 2 * width / 3) value = (uint8_t)check_random_u64(&random);
                codes[((size_t)y * width + x) * channels + c] = value;
            }
    return codes;
}

TEST_ON(test_save_and_load, 2) {
    static const uint32_t sizes[][2] = {{1, 1}, {1, 300},     {300, 1},
                                        {7, 5}, {1100, 1100}, {44000, 3}}; // the fifth: several IDAT chunks
    char path[512];
    scratch_path("saved.png", path);
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        for (uint32_t channels = 1; channels <= 4; channels++) {
            if (channels == 2) continue;
            const uint32_t width = sizes[s][0], height = sizes[s][1];
            const size_t stride = (size_t)width * channels + 13;
            OWNED(check_free) uint8_t *codes = make_codes(width, height, channels), *rows = calloc(height, stride);
            for (uint32_t y = 0; y < height; y++)
                memcpy(rows + y * stride, codes + (size_t)y * width * channels, (size_t)width * channels);
            assert_int_equal(ewa_png_save(context, path, width, height, channels, rows, stride), EWA_OK);
            OWNED(ewa_image_free) ewa_image image;
            assert_int_equal(ewa_image_load(context, path, &image), EWA_OK);
            assert_int_equal(image.width_px, width);
            assert_int_equal(image.height_px, height);
            assert_int_equal(image.channel_count, channels);
            for (size_t i = 0; i < (size_t)width * height * channels; i++) {
                const float alpha = channels == 4 ? (float)codes[i / 4 * 4 + 3] / 255.0f : 1;
                const bool is_alpha = channels == 4 && i % 4 == 3;
                assert_true(image.pixels[i] == (is_alpha ? alpha : ewa_srgb_decoded[codes[i]] * alpha));
            }
        }
    }
}

TEST(test_same_file_for_any_thread_count) {
    enum { WIDTH = 700, HEIGHT = 900 };
    static const uint32_t threads[] = {1, 2, 7, 32};
    OWNED(check_free) uint8_t *codes = make_codes(WIDTH, HEIGHT, 3), *first = NULL;
    size_t first_bytes = 0;
    char path[512];
    for (size_t t = 0; t < 4; t++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[t], NULL);
        scratch_path("threads.png", path);
        assert_int_equal(ewa_png_save(context, path, WIDTH, HEIGHT, 3, codes, 3 * WIDTH), EWA_OK);
        size_t size_bytes;
        uint8_t *bytes = scratch_read(path, &size_bytes);
        if (first) {
            assert_int_equal(size_bytes, first_bytes);
            assert_memory_equal(bytes, first, size_bytes);
            free(bytes);
        } else {
            first = bytes;
            first_bytes = size_bytes;
        }
    }
}

TEST_ON(test_float_to_codes, 1) {
    char path[512];
    scratch_path("float.png", path);
    OWNED(ewa_image_free) ewa_image image, back;
    assert_int_equal(ewa_image_create(context, 4, 1, 4, &image), EWA_OK);
    const float pixels[16] = {0.25f, 0.5f, 0, 0.5f, // half transparent: straight (0.5, 1, 0)
                              0,     0,    0, 0,    // nothing
                              2,     -1,   1, 1,    // clamped
                              NAN,   1,    1, 1};
    memcpy(image.pixels, pixels, sizeof pixels);
    assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    assert_int_equal(back.channel_count, 4);
    const float half = 128 / 255.0f;
    const float expected[16] = {
        ewa_srgb_decoded[188] * half, half, 0, half, 0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 1, 1};
    for (int i = 0; i < 16; i++) assert_true(back.pixels[i] == expected[i]);
    ewa_image_free(&back);

    // Without un-premultiplying the colours stay what they are.
    WITH_DEFAULTS(ewa_image_save_options, options);
    options.srgb_alpha_straight = false;
    assert_int_equal(ewa_image_save(&image, path, &options), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    assert_true(back.pixels[0] == ewa_srgb_decoded[137] * half);
    ewa_image_free(&back);

    // Alpha of 1 all over is left out.
    for (int i = 0; i < 4; i++) image.pixels[4 * i + 3] = 1;
    assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
    assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
    assert_int_equal(back.channel_count, 3);
}

TEST_ON(test_head_says_srgb, 1) {
    char path[512];
    const uint8_t code = 77;
    assert_int_equal(ewa_png_save(context, scratch_path("head.png", path), 1, 1, 1, &code, 1), EWA_OK);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    assert_memory_equal(bytes, "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0", 29);
    assert_memory_equal(bytes + 33, "\0\0\0\1sRGB\0\xae\xce\x1c\xe9", 13);
}

static void load_good(void *user, const char *path) {
    OWNED(ewa_image_free) ewa_image image;
    if (ewa_image_load(user, path, &image) != EWA_OK) fail_msg("%s did not load", path);
    assert_true(image.width_px > 0 && image.pixels);
    for (size_t i = 0; i < (size_t)image.width_px * image.height_px * image.channel_count; i++)
        assert_true(image.pixels[i] >= 0 && image.pixels[i] <= 1);
}

TEST_ON(test_pngsuite, 1) {
    scratch_each("images/pngsuite", load_good, context);
    char path[512];
    ewa_image a, b;
    if (check_data("images/pngsuite/basn6a16.png", path, sizeof path)) {
        // Interlaced or not, the pixels are the same.
        assert_int_equal(ewa_image_load(context, path, &a), EWA_OK);
        check_data("images/pngsuite/basi6a16.png", path, sizeof path);
        assert_int_equal(ewa_image_load(context, path, &b), EWA_OK);
        const image_difference difference = image_compare(&a, &b, 0);
        assert_true(difference.maximum == 0 && a.channel_count == 4);
        ewa_image_free(&a);
        ewa_image_free(&b);
    }
    if (check_data("images/pngsuite/basn0g16.png", path, sizeof path)) {
        assert_int_equal(ewa_image_load(context, path, &a), EWA_OK);
        assert_int_equal(a.channel_count, 1);
        assert_true(a.pixels[0] == 0 && fabs((double)a.pixels[28] - 0.964856) < 1e-6);
        ewa_image_free(&a);
    }
    if (check_data("images/pngsuite/tbbn3p08.png", path, sizeof path)) { // a palette with transparency
        assert_int_equal(ewa_image_load(context, path, &a), EWA_OK);
        assert_int_equal(a.channel_count, 4);
        assert_true(a.pixels[3] == 0);
        ewa_image_free(&a);
    }
}

TEST(test_hostile) {
    scratch_pictures t = {0};
    t.context = check_context(1, &t.log);
    if (scratch_each("hostile/png", scratch_load_picture, &t) > 0) assert_true(t.refused >= 7);
    char path[512];
    if (check_data("hostile/png/badcrc.png", path, sizeof path)) {
        scratch_load_picture(&t, path);
        print_message("%s\n", t.log.text);
    }
    ewa_context_destroy(&t.context);
}

TEST_LOGGED(test_every_truncation_is_refused, 1) {
    char path[512];
    OWNED(check_free) uint8_t *codes = make_codes(12, 9, 4);
    assert_int_equal(ewa_png_save(context, scratch_path("whole.png", path), 12, 9, 4, codes, 48), EWA_OK);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    OWNED(ewa_image_free) ewa_image image;
    // libspng takes the end chunk without its checksum.
    for (size_t length = 0; length < size_bytes - 4; length++) {
        uint8_t *copy = malloc(length + 1); // of its own size, so that a sanitizer sees reads beyond
        memcpy(copy, bytes, length);
        OWNED(check_free) uint8_t *exact = realloc(copy, length ? length : 1);
        assert_int_equal(ewa_image_load_memory(context, exact, length, "cut.png", &image), EWA_ERROR_FORMAT);
        assert_memory_equal(log->text, "cut.png: ", 9);
    }
    for (size_t at = 0; at < size_bytes; at++) { // a flipped byte is refused or changes metadata only
        bytes[at] ^= 0x55;
        if (ewa_image_load_memory(context, bytes, size_bytes, "flipped.png", &image) == EWA_OK)
            ewa_image_free(&image);
        bytes[at] ^= 0x55;
    }
    assert_int_equal(ewa_image_load_memory(context, bytes, size_bytes, "whole.png", &image), EWA_OK);
}

TEST(test_limits_come_before_memory) {
    check_log log = {0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.message = check_log_keep;
    options.message_user = &log;
    options.limits.max_image_side = 600;
    options.limits.max_memory_bytes = 100000;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    // 601 x 1 pixels, then 500 x 500, then 599 x 599 of 64 bits, all in 57 bytes.
    const uint32_t sizes[3][2] = {{601, 1}, {500, 500}, {599, 599}};
    uint8_t head[57] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR";
    ewa_image image;
    for (int i = 0; i < 3; i++) {
        for (int byte = 0; byte < 4; byte++) {
            head[16 + byte] = (uint8_t)(sizes[i][0] >> (24 - 8 * byte));
            head[20 + byte] = (uint8_t)(sizes[i][1] >> (24 - 8 * byte));
        }
        memcpy(head + 24, i == 2 ? "\x10\6\0\0\0" : "\1\0\0\0\0", 5);
        const uint32_t crc = libdeflate_crc32(0, head + 12, 17);
        for (int byte = 0; byte < 4; byte++) head[29 + byte] = (uint8_t)(crc >> (24 - 8 * byte));
        memcpy(head + 33, "\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82", 24);
        const ewa_status status = ewa_image_load_memory(context, head, sizeof head, "big.png", &image);
        assert_int_equal(status, i == 2 ? EWA_ERROR_FORMAT : EWA_ERROR_LIMIT);
        assert_non_null(strstr(log.text, i == 0 ? "601 x 1" : i == 1 ? "need" : "cannot hold"));
    }
}

TEST_LOGGED(test_arguments, 1) {
    char path[512];
    scratch_path("never.png", path);
    remove(path);
    const uint8_t codes[12] = {0};
    assert_int_equal(ewa_png_save(context, path, 2, 2, 2, codes, 6), EWA_ERROR_UNSUPPORTED);
    assert_int_equal(ewa_png_save(context, path, 2, 2, 3, codes, 5), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_png_save(context, path, 0, 2, 3, codes, 6), EWA_ERROR_ARGUMENT);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(ewa_png_save(context, "/nowhere/x.png", 2, 2, 3, codes, 6), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "/nowhere/x.png"));
    assert_int_equal(ewa_png_save(context, "/dev/full", 2, 2, 3, codes, 6), EWA_ERROR_IO);
    ewa_image image;
    assert_int_equal(ewa_image_create(context, 2, 2, 3, &image), EWA_OK);
    assert_int_equal(ewa_image_save(&image, scratch_path("picture.gif", path), NULL), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "picture.gif"));
    ewa_image_free(&image);
    assert_int_equal(ewa_image_load(context, "/nowhere/x.png", &image), EWA_ERROR_IO);
    assert_int_equal(ewa_image_load_memory(context, "GIF89a", 6, "x.gif", &image), EWA_ERROR_FORMAT);
}

static ewa_status save_work(ewa_context *context, void *user) {
    OWNED(check_free) uint8_t *codes = make_codes(100, 3000, 3);
    const ewa_status status = ewa_png_save(context, user, 100, 3000, 3, codes, 300);
    return status;
}

static ewa_status load_work(ewa_context *context, void *user) {
    OWNED(ewa_image_free) ewa_image image;
    const ewa_status status = ewa_image_load(context, user, &image);
    return status;
}

static ewa_status save_float_work(ewa_context *context, void *user) {
    float pixels[12] = {0};
    const ewa_image image = {context, 1, 4, 3, pixels};
    return ewa_image_save(&image, user, NULL);
}

TEST(test_failing_allocations) {
    char path[512];
    scratch_path("memory.png", path);
    remove(path);
    scratch_fail_each(save_work, path);
    scratch_fail_each(load_work, path);
    scratch_fail_each(save_float_work, path);
    if (check_data("images/pngsuite/basn6a16.png", path, sizeof path)) scratch_fail_each(load_work, path);
}

/// Time of all threads of this process, whatever else the machine does.
static double processor_time_s(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/// Not a check: prints how much processor time a picture of 1280 x 1024 takes, with `--bench`.
static void bench(void) {
    enum { WIDTH = 1280, HEIGHT = 1024 };
    OWNED(check_free) uint8_t *codes = malloc(3 * WIDTH * HEIGHT);
    char path[512];
    scratch_path("bench.png", path);
    for (int kind = 0; kind < 4; kind++) {
        static const char *const names[] = {"flat", "shaded sphere", "shaded, noise of 4 %", "noise"};
        check_random random = {5};
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                const double dx = (x - 640) / 480.0, dy = (y - 512) / 480.0, square = dx * dx + dy * dy;
                double shade = 0.12, albedo = 1;
                if (kind > 0 && square < 1) {
                    const double u = 8 * atan2(dx, sqrt(1 - square)), v = 8 * asin(dy);
                    albedo = 0.5 + 0.25 * sin(3 * u) * sin(3 * v) + 0.2 * sin(17 * u + 3 * v) * cos(13 * v);
                    shade = fmax(0, fmin(1, sqrt(1 - square) + 0.15 * sin(40 * dx) * sin(37 * dy)));
                }
                for (int c = 0; c < 3; c++) {
                    double value = shade * (0.3 + 0.1 * c + (c == 2 ? -0.3 : 0.5) * albedo);
                    if (kind == 2) value += square < 1 ? check_uniform(&random, -0.02, 0.02) : 0;
                    if (kind == 3) value = check_uniform(&random, 0, 1);
                    codes[3 * (y * WIDTH + x) + c] = ewa_srgb8_from_linear((float)value);
                }
            }
        for (uint32_t threads = 1; threads <= 2; threads++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
            double best_s = 1e9;
            for (int round = 0; round < 15; round++) {
                const double start_s = processor_time_s();
                assert_int_equal(ewa_png_save(context, path, WIDTH, HEIGHT, 3, codes, 3 * WIDTH), EWA_OK);
                best_s = fmin(best_s, processor_time_s() - start_s);
            }
            struct stat facts;
            stat(path, &facts);
            printf("%-22s %u threads %6.2f ms %8ld bytes\n", names[kind], threads, 1e3 * best_s,
                   (long)facts.st_size);
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
