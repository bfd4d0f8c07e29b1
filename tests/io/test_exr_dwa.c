// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/exr_dwa.cpp and exr_header.c: known pixels by lines and tiles, every cut, every byte changed, other attributes,
// failing allocations.
#include "dwa_sample.h"
#include "io/image/exr_header.h"
#include "scratch.h"

#include <math.h>

enum { ATTRIBUTES_AT = 8, HEADER_BYTES = 331 }; // of dwa_lines

static void check_pixels(ewa_context *context, const uint8_t *bytes, size_t size_bytes, uint32_t width_px, uint32_t height_px) {
    OWNED(ewa_image_free) ewa_image image;
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
}

TEST_ON(test_known_pixels, 1) {
    check_pixels(context, dwa_lines, sizeof dwa_lines, 32, 32);
    check_pixels(context, dwa_tiles, sizeof dwa_tiles, 40, 32);
}

/// A copy without a byte beyond its end that may be read.
static void load_exactly(ewa_context *context, const uint8_t *bytes, size_t size_bytes, ewa_status expected) {
    OWNED(check_free) uint8_t *exact = malloc(size_bytes ? size_bytes : 1);
    memcpy(exact, bytes, size_bytes);
    ewa_image image;
    assert_int_equal(ewa_image_load_memory(context, exact, size_bytes, "cut.exr", &image), expected);
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

/// Puts attributes in front of the others of dwa_lines, whose chunk moves with them; the caller frees.
static uint8_t *make_with_attributes(const uint8_t *attributes, size_t attribute_bytes, size_t *size_bytes) {
    *size_bytes = sizeof dwa_lines + attribute_bytes;
    uint8_t *bytes = malloc(*size_bytes);
    assert_non_null(bytes);
    memcpy(bytes, dwa_lines, ATTRIBUTES_AT);
    memcpy(bytes + ATTRIBUTES_AT, attributes, attribute_bytes);
    memcpy(bytes + ATTRIBUTES_AT + attribute_bytes, dwa_lines + ATTRIBUTES_AT, sizeof dwa_lines - ATTRIBUTES_AT);
    const size_t chunk_at = HEADER_BYTES + 8 + attribute_bytes;
    for (size_t i = 0; i < 8; i++) bytes[HEADER_BYTES + attribute_bytes + i] = (uint8_t)((uint64_t)chunk_at >> 8 * i);
    return bytes;
}

TEST_ON(test_other_attributes_change_no_pixel, 1) {
    static const char comments[] = "comments\0string\0\5\0\0\0hello"
                                   "preview\0preview\0\14\0\0\0\1\0\0\0\1\0\0\0\x7f\x7f\x7f\xff";
    static const char shortest[] = "a\0string\0\0\0\0\0";
    const struct {
        const char *text;
        size_t size_bytes;
    } cases[] = {{comments, sizeof comments - 1}, {shortest, sizeof shortest - 1}};
    ewa_image plain, image;
    assert_int_equal(ewa_image_load_memory(context, dwa_lines, sizeof dwa_lines, "plain.exr", &plain), EWA_OK);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t size_bytes;
        OWNED(check_free)
        uint8_t *bytes = make_with_attributes((const uint8_t *)cases[i].text, cases[i].size_bytes, &size_bytes);
        assert_int_equal(ewa_image_load_memory(context, bytes, size_bytes, "more.exr", &image), EWA_OK);
        assert_memory_equal(image.pixels, plain.pixels, sizeof(float) * 4 * 32 * 32);
        ewa_image_free(&image);
    }
    ewa_image_free(&plain);
}

/// The copy of a header: attributes that pixels do not need become one of their length, and each cut is seen.
TEST(test_header) {
    static const char two[] = "a\0b\0\0\0\0\0owner\0string\0\2\0\0\0me";
    static const char filler[] = "x\0x\0\23\0\0\0"; // 19 of the 27 bytes of these
    const size_t more = sizeof two - 1, header_bytes = HEADER_BYTES + more;
    uint8_t copy[HEADER_BYTES + sizeof two];
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = make_with_attributes((const uint8_t *)two, more, &size_bytes);
    assert_int_equal(ewa_exr_measure_header(bytes, size_bytes), header_bytes);
    ewa_exr_copy_header(bytes, header_bytes, copy);
    assert_memory_equal(copy, dwa_lines, HEADER_BYTES - 1);
    assert_memory_equal(copy + HEADER_BYTES - 1, filler, sizeof filler - 1);
    for (size_t i = HEADER_BYTES - 1 + sizeof filler - 1; i < header_bytes; i++) assert_int_equal(copy[i], 0);
    ewa_exr_copy_header(dwa_lines, HEADER_BYTES, copy);
    assert_memory_equal(copy, dwa_lines, HEADER_BYTES);
    for (size_t length = 0; length < header_bytes; length++) {
        OWNED(check_free) uint8_t *cut = malloc(length ? length : 1); // of just this size, for the sanitizer
        assert_non_null(cut);
        memcpy(cut, bytes, length);
        assert_int_equal(ewa_exr_measure_header(cut, length), 0);
        assert_int_equal(ewa_exr_has_one_part(cut, length), length >= ATTRIBUTES_AT);
    }
    bytes[ATTRIBUTES_AT + 2] = 0; // no type
    assert_int_equal(ewa_exr_measure_header(bytes, size_bytes), 0);
    bytes[ATTRIBUTES_AT + 2] = 'b';
    bytes[ATTRIBUTES_AT + more + 16] ^= 1; // the list of channels is a byte longer than it says, or shorter
    assert_int_equal(ewa_exr_measure_header(bytes, size_bytes), 0);
}

TEST(test_several_parts_are_named) {
    static const char part[] = "name\0string\0\1\0\0\0atype\0string\0\15\0\0\0scanlineimagechunkCount\0int\0\4\0\0\0\1\0\0\0";
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = make_with_attributes((const uint8_t *)part, sizeof part - 1, &size_bytes);
    bytes[5] |= 0x10;                          // of the version: there are several parts
    bytes[HEADER_BYTES + sizeof part - 1] = 0; // no second header
    load_exactly(context, bytes, size_bytes, EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log.text, "DWA, which is read of files of one part"));
}

/// Where sizes claim more than there is, no room is made for it: the limit is 1 MiB.
TEST(test_sizes_beyond_the_file_are_refused) {
    static const char *const sizes[] = {"\xff\xff\xff\x7f", "\xff\xff\xff\xff", "\0\0\0\x40", "\0\x10\0\0"};
    check_log log = {.count = 0};
    WITH_DEFAULTS(ewa_context_options, options);
    options.limits.max_memory_bytes = 1 << 20;
    options.message = check_log_keep, options.message_user = &log;
    OWNED(ewa_context_destroy) ewa_context *context;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        uint8_t attribute[] = "comments\0string\0....hello";
        size_t size_bytes;
        memcpy(attribute + 16, sizes[i], 4);
        OWNED(check_free) uint8_t *bytes = make_with_attributes(attribute, sizeof attribute - 1, &size_bytes);
        load_exactly(context, bytes, size_bytes, EWA_ERROR_FORMAT);
    }
}

static ewa_status load_work(ewa_context *context, void *user) {
    (void)user;
    OWNED(ewa_image_free) ewa_image image;
    const ewa_status status = ewa_image_load_memory(context, dwa_lines, sizeof dwa_lines, "dwa.exr", &image);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_work, NULL); }

int main(void) { return RUN_TESTS(NULL, NULL); }
