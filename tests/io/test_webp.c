// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/webp_read.c: known pixels, alpha, every truncation, broken bytes, animations, limits.
#include "io/image/image_file.h"
#include "io/mesh_check.h"

/// 3 x 2 pixels of (188, 64, 0), lossless.
static const uint8_t plain[] = {0x52, 0x49, 0x46, 0x46, 0x1c, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50,
                                0x56, 0x50, 0x38, 0x4c, 0x10, 0x00, 0x00, 0x00, 0x2f, 0x02, 0x40, 0x00,
                                0x00, 0x07, 0x50, 0xa0, 0xf2, 0x46, 0xff, 0x03, 0x11, 0xd1, 0xff, 0x00};

/// Red, and green with alpha 51 of 255.
static const uint8_t clear[] = {0x52, 0x49, 0x46, 0x46, 0x20, 0x00, 0x00, 0x00, 0x57, 0x45,
                                0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x13, 0x00, 0x00, 0x00,
                                0x2f, 0x01, 0x00, 0x00, 0x10, 0x0f, 0x30, 0xff, 0xfb, 0x1f,
                                0xa7, 0xf9, 0x0f, 0x07, 0x15, 0x88, 0xe8, 0x7f, 0x00, 0x00};

/// The begin of an animation.
static const uint8_t animation[] = {0x52, 0x49, 0x46, 0x46, 0xc0, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42,
                                    0x50, 0x56, 0x50, 0x38, 0x58, 0x0a, 0x00, 0x00, 0x00, 0x02, 0x00,
                                    0x00, 0x00, 0x01, 0x00, 0x00, 0x01, 0x00, 0x00, 0x41, 0x4e, 0x49,
                                    0x4d, 0x06, 0x00, 0x00, 0x00, 0xff, 0xff, 0xff, 0xff, 0x00, 0x00};

TEST(test_known_pixels) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_load_memory(context, plain, sizeof plain, "a.webp", &image), EWA_OK);
    assert_true(image.width_px == 3 && image.height_px == 2 && image.channel_count == 3);
    for (int i = 0; i < 6; i++) {
        assert_float_equal(image.pixels[3 * i], ewa_linear_from_srgb(188 / 255.0f), 1e-6);
        assert_float_equal(image.pixels[3 * i + 1], ewa_linear_from_srgb(64 / 255.0f), 1e-6);
        assert_true(image.pixels[3 * i + 2] == 0);
    }
    ewa_image_free(&image);
    assert_int_equal(ewa_image_load_memory(context, clear, sizeof clear, "a.webp", &image), EWA_OK);
    assert_true(image.width_px == 2 && image.channel_count == 4 && image.pixels[0] == 1 &&
                image.pixels[3] == 1);
    assert_float_equal(image.pixels[5], 0.2, 1e-6); // premultiplied
    assert_float_equal(image.pixels[7], 0.2, 1e-6);
    ewa_image_free(&image);
    assert_int_equal(ewa_image_decode(context, clear, sizeof clear, "a.webp", true, &image), EWA_OK);
    assert_true(image.pixels[5] == 1);
}

TEST(test_broken) {
    mesh_messages messages;
    OWNED(ewa_context_destroy) ewa_context *context = mesh_context(&messages);
    ewa_image image;
    for (size_t size = 0; size < sizeof clear; size++) {
        OWNED(check_free) uint8_t *copy = malloc(size + 1); // so that a sanitizer sees the first byte too many
        memcpy(copy, clear, size);
        messages = (mesh_messages){.errors = 0};
        const ewa_status status = ewa_image_load_memory(context, copy, size, "cut.webp", &image);
        if (status == EWA_OK)
            ewa_image_free(&image); // the last byte is padding
        else
            assert_true(messages.errors == 1 && !image.pixels);
        assert_true(status != EWA_OK || size >= sizeof clear - 2);
    }
    check_random random = {3};
    for (int i = 0; i < 2000; i++) {
        uint8_t bytes[sizeof clear];
        memcpy(bytes, clear, sizeof bytes);
        for (int k = 0; k < 3; k++)
            bytes[8 + check_random_u64(&random) % (sizeof bytes - 8)] = (uint8_t)check_random_u64(&random);
        if (ewa_image_load_memory(context, bytes, sizeof bytes, "a.webp", &image) == EWA_OK)
            ewa_image_free(&image);
    }
    messages = (mesh_messages){.errors = 0};
    assert_int_equal(ewa_image_load_memory(context, animation, sizeof animation, "a.webp", &image),
                     EWA_ERROR_UNSUPPORTED);
    mesh_says(&messages, "a.webp: WebP: an animation");
}

static ewa_status work(ewa_context *context, void *user) {
    (void)user;
    ewa_image image;
    const ewa_status status = ewa_image_load_memory(context, clear, sizeof clear, "a.webp", &image);
    if (status == EWA_OK) ewa_image_free(&image);
    return status;
}

TEST(test_limits) {
    scratch_fail_each(work, NULL);
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_memory_bytes = 29;
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    ewa_image image;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    assert_int_equal(ewa_image_load_memory(context, plain, sizeof plain, "a.webp", &image), EWA_ERROR_LIMIT);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
