// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/exr_dwa.cpp: known pixels by lines and tiles, every cut, every byte changed, failing allocations.
#include "dwa_sample.h"
#include "scratch.h"

#include <math.h>

static void check_pixels(ewa_context *context, const uint8_t *bytes, size_t size_bytes, uint32_t width_px, uint32_t height_px) {
    ewa_image image;
    assert_int_equal(ewa_image_load_memory(context, bytes, size_bytes, "dwa.exr", &image), EWA_OK);
    assert_int_equal(image.width_px, width_px);
    assert_int_equal(image.height_px, height_px);
    assert_int_equal(image.channel_count, 4);
    double largest = 0;
    for (uint32_t y = 0; y < height_px; y++)
        for (uint32_t x = 0; x < width_px; x++) {
            const float *pixel = image.pixels + 4 * ((size_t)y * width_px + x);
            const double color[3] = {0.25 + 0.5 * x / width_px, 0.5, 0.25 + 0.5 * y / height_px};
            for (int c = 0; c < 3; c++) largest = fmax(largest, fabs(pixel[c] - color[c]));
            assert_true(pixel[3] == (x < width_px / 2 ? 1.0f : 0.5f)); // which DWA keeps exactly
        }
    print_message("colours are up to %.2g off\n", largest);
    assert_true(largest < 0.01); // DWA drops what is not seen
    ewa_image_free(&image);
}

TEST_ON(test_known_pixels, 1) {
    check_pixels(context, dwa_lines, sizeof dwa_lines, 32, 32);
    check_pixels(context, dwa_tiles, sizeof dwa_tiles, 40, 32);
}

/// A copy without a byte beyond its end that may be read.
static void load_exactly(ewa_context *context, const uint8_t *bytes, size_t size_bytes, ewa_status expected) {
    uint8_t *exact = malloc(size_bytes ? size_bytes : 1);
    memcpy(exact, bytes, size_bytes);
    ewa_image image;
    assert_int_equal(ewa_image_load_memory(context, exact, size_bytes, "cut.exr", &image), expected);
    free(exact);
}

TEST_ON(test_every_truncation_is_refused, 1) {
    for (size_t length = 0; length < sizeof dwa_lines; length++)
        load_exactly(context, dwa_lines, length, EWA_ERROR_FORMAT);
}

TEST_ON(test_every_byte_may_be_wrong, 1) {
    uint8_t bytes[sizeof dwa_tiles];
    memcpy(bytes, dwa_tiles, sizeof bytes);
    for (size_t at = 0; at < sizeof bytes; at++) {
        bytes[at] ^= 0x55;
        ewa_image image;
        if (ewa_image_load_memory(context, bytes, sizeof bytes, "flipped.exr", &image) == EWA_OK) ewa_image_free(&image);
        bytes[at] ^= 0x55;
    }
}

static ewa_status load_work(ewa_context *context, void *user) {
    (void)user;
    ewa_image image;
    const ewa_status status = ewa_image_load_memory(context, dwa_lines, sizeof dwa_lines, "dwa.exr", &image);
    ewa_image_free(&image);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_work, NULL); }

int main(void) { return RUN_TESTS(NULL, NULL); }
