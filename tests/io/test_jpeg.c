// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/jpeg_read.c: known pixels, every truncation, broken bytes, too many scans, limits.
#include "image/srgb.h"
#include "scratch.h"

/// A picture of the fuzzing corpus; the caller frees.
static uint8_t *read_picture(const char *name, size_t *size_bytes) {
    char path[512];
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/image/%s", getenv("EWA_SOURCE_DIR"), name);
    return scratch_read(path, size_bytes);
}

static ewa_status decode(ewa_context *context, const uint8_t *bytes, size_t size_bytes, ewa_image *image) {
    // Exactly as many bytes as there are, so that a sanitizer sees the first one too many.
    uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, bytes, size_bytes);
    const ewa_status status = ewa_image_load_memory(context, copy, size_bytes, "scan.jpg", image);
    free(copy);
    return status;
}

/// Whether a pixel has these sRGB codes, within what the compression leaves.
static bool is_near(const ewa_image *image, uint32_t x, uint32_t y, const int codes[3]) {
    bool near = true;
    const float *pixel = image->pixels + ((size_t)y * image->width_px + x) * image->channel_count;
    for (uint32_t c = 0; c < image->channel_count; c++)
        near = near && abs(ewa_srgb8_from_linear(pixel[c]) - codes[c]) <= 2;
    return near;
}

static void test_known_pixels(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    static const int red[3] = {200, 60, 40}, blue[3] = {40, 80, 220};
    static const char *const names[] = {"colour.jpg", "progressive.jpg"};
    ewa_image image;
    size_t size_bytes;
    for (int k = 0; k < 2; k++) {
        uint8_t *bytes = read_picture(names[k], &size_bytes);
        assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_OK);
        assert_true(image.width_px == 16 && image.height_px == 8 && image.channel_count == 3);
        assert_true(is_near(&image, 0, 0, red) && is_near(&image, 7, 7, red));
        assert_true(is_near(&image, 8, 0, blue) && is_near(&image, 15, 7, blue));
        ewa_image_free(&image);
        free(bytes);
    }
    uint8_t *bytes = read_picture("grey.jpg", &size_bytes); // black, grey and white rows
    assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_OK);
    assert_true(image.width_px == 5 && image.height_px == 3 && image.channel_count == 1);
    for (uint32_t y = 0; y < 3; y++)
        assert_true(is_near(&image, 4, y, (const int[3]){y == 0 ? 0 : y == 1 ? 128 : 255}));
    ewa_image_free(&image);
    free(bytes);
    ewa_context_destroy(&context);
}

/// What is cut in its pixels is a picture with a warning, as other programs have it; all else is an error.
static void test_every_truncation(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(1, &log);
    static const char *const names[] = {"colour.jpg", "progressive.jpg", "grey.jpg"};
    for (int k = 0; k < 3; k++) {
        size_t size_bytes, whole = 0;
        uint8_t *bytes = read_picture(names[k], &size_bytes);
        for (size_t cut = 0; cut < size_bytes - 2; cut++) { // libjpeg does not miss the end mark
            ewa_image image;
            log.text[0] = 0;
            const ewa_status status = decode(context, bytes, cut, &image);
            assert_true(status == EWA_OK || status == EWA_ERROR_FORMAT);
            assert_non_null(strstr(log.text, "scan.jpg"));
            assert_true((status == EWA_OK) == (image.pixels != NULL));
            assert_true(status != EWA_OK || strstr(log.text, "parts are missing or broken"));
            whole += status == EWA_OK;
            ewa_image_free(&image);
        }
        assert_true(whole > 0 && whole < size_bytes / 2);
        free(bytes);
    }
    ewa_context_destroy(&context);
}

static void test_broken_bytes(void **state) {
    (void)state;
    ewa_context *context = check_context(1, NULL);
    static const char *const names[] = {"colour.jpg", "progressive.jpg", "grey.jpg", "cmyk.jpg"};
    check_random random = {3};
    for (int k = 0; k < 4; k++) {
        size_t size_bytes;
        uint8_t *bytes = read_picture(names[k], &size_bytes);
        for (int round = 0; round < 500; round++) {
            const size_t at = (size_t)check_uniform(&random, 0, (double)size_bytes);
            const uint8_t before = bytes[at];
            bytes[at] = (uint8_t)check_uniform(&random, 0, 256);
            ewa_image image;
            const ewa_status status = decode(context, bytes, size_bytes, &image);
            assert_true((status == EWA_OK) == (image.pixels != NULL));
            ewa_image_free(&image);
            bytes[at] = before;
        }
        free(bytes);
    }
    ewa_context_destroy(&context);
}

static void test_refused(void **state) {
    (void)state;
    check_log log = {0};
    ewa_context *context = check_context(1, &log);
    ewa_image image;
    size_t size_bytes;
    uint8_t *bytes = read_picture("cmyk.jpg", &size_bytes);
    assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "scan.jpg: JPEG of 4 components"));
    free(bytes);
    // The last scan of a progressive file, over and over.
    enum { REPEATS = 400 };
    bytes = read_picture("progressive.jpg", &size_bytes);
    size_t scan = size_bytes;
    while (scan > 0 && (bytes[scan - 1] != 0xff || bytes[scan] != 0xda)) scan--;
    assert_true(scan > 0);
    scan--;
    const size_t scan_bytes = size_bytes - 2 - scan; // but for the end mark
    uint8_t *many = malloc(size_bytes + REPEATS * scan_bytes);
    memcpy(many, bytes, size_bytes - 2);
    for (size_t i = 0; i < REPEATS; i++)
        memcpy(many + size_bytes - 2 + i * scan_bytes, bytes + scan, scan_bytes);
    memcpy(many + size_bytes - 2 + REPEATS * scan_bytes, bytes + size_bytes - 2, 2);
    assert_int_equal(decode(context, many, size_bytes + REPEATS * scan_bytes, &image), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "more than 200 scans"));
    assert_null(image.pixels);
    free(many);
    free(bytes);
    ewa_context_destroy(&context);
}

/// Sizes are checked before pixels are allocated, whatever the head says.
static void test_limits(void **state) {
    (void)state;
    size_t size_bytes;
    uint8_t *bytes = read_picture("colour.jpg", &size_bytes);
    size_t head = 0; // the frame's: ff c0, length, bits, height, width
    while (bytes[head] != 0xff || bytes[head + 1] != 0xc0) head++;
    for (int k = 0; k < 3; k++) {
        ewa_context_options options;
        ewa_context_options_init(&options, sizeof options);
        if (k == 0) options.limits.max_image_side = 15;
        if (k == 1) options.limits.max_memory_bytes = 16 * 8 * 3 * sizeof(float) - 1;
        if (k == 2) { // 65,500 x 65,500
            options.limits.max_memory_bytes = (uint64_t)1 << 30;
            for (size_t i = 5; i < 9; i++) bytes[head + i] = i % 2 ? 0xff : 0xdc;
        }
        ewa_context *context = NULL;
        assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
        ewa_image image;
        assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_ERROR_LIMIT);
        assert_null(image.pixels);
        ewa_context_destroy(&context);
    }
    free(bytes);
}

static ewa_status load_colour(ewa_context *context, void *user) {
    (void)user;
    size_t size_bytes;
    uint8_t *bytes = read_picture("colour.jpg", &size_bytes);
    ewa_image image;
    const ewa_status status = decode(context, bytes, size_bytes, &image);
    ewa_image_free(&image);
    free(bytes);
    return status;
}

static void test_failing_allocations(void **state) {
    (void)state;
    scratch_fail_each(load_colour, NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_pixels), cmocka_unit_test(test_every_truncation),
        cmocka_unit_test(test_broken_bytes), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_limits),       cmocka_unit_test(test_failing_allocations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
