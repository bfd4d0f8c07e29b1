// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/hdr.c: known pixels in every kind of row, exposure, every truncation, broken heads.
#include "scratch.h"

#include <math.h>

/// A literal with zero bytes in it.
#define BYTES(text) (const uint8_t *)(text), sizeof(text) - 1

static ewa_status decode(ewa_context *context, const uint8_t *bytes, size_t size_bytes, ewa_image *image) {
    // Exactly as many bytes as there are, so that a sanitizer sees the first one too many.
    OWNED(check_free) uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, bytes, size_bytes);
    const ewa_status status = ewa_image_load_memory(context, copy, size_bytes, "sky.hdr", image);
    return status;
}

/// 2 x 2 pixels, plain.
#define PLAIN_HEAD "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n"

TEST_ON(test_plain_rows, 1) {
    static const char pixels[] = "\x80\x40\x00\x81\xff\x00\x01\x80\x01\x02\x03\x88\x00\x00\x00\x00";
    for (int from_bottom = 0; from_bottom < 2; from_bottom++) {
        char file[256];
        const int head = snprintf(file, sizeof file, PLAIN_HEAD "%cY 2 +X 2\n", from_bottom ? '+' : '-');
        memcpy(file + head, pixels, 16);
        OWNED(ewa_image_free) ewa_image image;
        assert_int_equal(decode(context, (const uint8_t *)file, (size_t)head + 16, &image), EWA_OK);
        assert_true(image.width_px == 2 && image.height_px == 2 && image.channel_count == 3);
        const float *first = image.pixels + (from_bottom ? 6 : 0),
                    *last = image.pixels + (from_bottom ? 0 : 6);
        // (mantissa + 1/2) 2^(exponent - 136)
        const float wanted[6] = {128.5f / 128, 64.5f / 128, 0.5f / 128, 255.5f / 256, 0.5f / 256, 1.5f / 256};
        for (int i = 0; i < 6; i++) assert_true(first[i] == wanted[i]);
        assert_true(last[0] == 1.5f && last[1] == 2.5f && last[2] == 3.5f);
        assert_true(last[3] == 0 && last[4] == 0 && last[5] == 0);
    }
}

TEST_ON(test_repeated_pixels, 1) {
    // 1 pixel, 2 more like it, another, and 0x0102 = 258 more like that: the low digit comes first.
    static const char file[] = PLAIN_HEAD
        "-Y 1 +X 262\n\x10\x20\x30\x88\x01\x01\x01\x02\x40\x50\x60\x88\x01\x01\x01\x02\x01\x01\x01\x01";
    ewa_image image;
    assert_int_equal(decode(context, BYTES(file), &image), EWA_OK);
    for (size_t x = 0; x < 262; x++) assert_true(image.pixels[3 * x] == (x < 3 ? 16.5f : 64.5f));
    ewa_image_free(&image);
    // One too many for the row.
    char longer[sizeof file];
    memcpy(longer, file, sizeof file);
    longer[sizeof file - 6] = 3;
    assert_int_equal(decode(context, (const uint8_t *)longer, sizeof file - 1, &image), EWA_ERROR_FORMAT);
}

static const char RUNS[] = "#?RADIANCE\r\nEXPOSURE=2\nEXPOSURE= 0.25\n\n-Y 2 +X 8\n"
                           "\x02\x02\x00\x08\x88\x80\x88\x40\x83\x20\x05\x01\x02\x03\x04\x05\x88\x88"
                           "\x02\x02\x00\x08\x08\x00\x01\x02\x03\x04\x05\x06\x07\x88\x40\x88\x20\x88\x88";

TEST_ON(test_runs_of_components, 1) {
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(decode(context, BYTES(RUNS), &image), EWA_OK);
    for (size_t x = 0; x < 8; x++) {
        assert_true(image.pixels[3 * x] == 2 * 128.5f && image.pixels[3 * x + 1] == 2 * 64.5f);
        assert_true(image.pixels[3 * x + 2] == 2 * (x < 3 ? 32.5f : (float)(x - 2) + 0.5f));
        assert_true(image.pixels[24 + 3 * x] == 2 * ((float)x + 0.5f));
    }
}

TEST_LOGGED(test_every_truncation_fails, 1) {
    ewa_image image;
    for (size_t size_bytes = 0; size_bytes < sizeof RUNS - 1; size_bytes++) {
        assert_int_equal(decode(context, (const uint8_t *)RUNS, size_bytes, &image), EWA_ERROR_FORMAT);
        assert_non_null(strstr(log->text, "sky.hdr: "));
        assert_null(image.pixels);
    }
}

TEST_ON(test_broken_files, 1) {
    static const struct {
        const char *text;
        ewa_status status;
    } files[] = {
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", EWA_ERROR_UNSUPPORTED},
        {"#?RADIANCE\n\n+X 1 -Y 1\nabcd", EWA_ERROR_UNSUPPORTED},
        {"#?RADIANCE\n\n-Y 1 -X 1\nabcd", EWA_ERROR_UNSUPPORTED},
        {"#?RADIANCE\n\n-Y 0 +X 1\nabcd", EWA_ERROR_UNSUPPORTED},
        {"#?RADIANCE\n\nY 1 +X 1\nabcd", EWA_ERROR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\nabcd", EWA_ERROR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=\n\n-Y 1 +X 1\nabcd", EWA_ERROR_FORMAT},
        {"#?RADIANCE\n\n-Y 4000000000 +X 1\nabcd", EWA_ERROR_LIMIT},
        {"#?RADIANCE\n\n-Y 1000 +X 1\nabcd", EWA_ERROR_FORMAT},
        {"#?RADIANCE\n\n-Y 1 +X 9\n\2\2\1\11abcdefghijklmnopqrstuvwxyz",
         EWA_ERROR_FORMAT}, // of another width
        {"#?RADIANCE\n\n-Y 1 +X 8\n\2\2\1", EWA_ERROR_FORMAT},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        ewa_image image;
        assert_int_equal(decode(context, (const uint8_t *)files[i].text, strlen(files[i].text), &image),
                         files[i].status);
    }
}

static ewa_status load_runs(ewa_context *context, void *user) {
    (void)user;
    OWNED(ewa_image_free) ewa_image image;
    const ewa_status status = decode(context, BYTES(RUNS), &image);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_runs, NULL); }

int main(void) { return RUN_TESTS(NULL, NULL); }
