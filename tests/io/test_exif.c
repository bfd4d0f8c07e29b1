// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/exif.c: every orientation in both orders of bytes, every truncation, broken directories, and
// pictures that are turned where their size is wanted so.
#include "io/image/exif.h"
#include "io/image/image_file.h"
#include "scratch.h"

enum { TIFF_BYTES = 26, HEAD_BYTES = 10 };

static void put(uint8_t *to, bool big, uint32_t size, uint32_t value) {
    for (uint32_t i = 0; i < size; i++) to[i] = (uint8_t)(value >> 8 * (big ? size - 1 - i : i));
}

/// An APP1 segment that says an orientation.
static void make_segment(uint8_t segment[HEAD_BYTES + TIFF_BYTES], bool big, uint32_t orientation) {
    memset(segment, 0, HEAD_BYTES + TIFF_BYTES);
    memcpy(segment, "\xff\xe1\0\0" "Exif\0", 9);
    put(segment + 2, true, 2, HEAD_BYTES + TIFF_BYTES - 2);
    uint8_t *tiff = segment + HEAD_BYTES;
    memcpy(tiff, big ? "MM" : "II", 2);
    put(tiff + 2, big, 2, 42), put(tiff + 4, big, 4, 8);
    put(tiff + 8, big, 2, 1);
    put(tiff + 10, big, 2, 0x0112), put(tiff + 12, big, 2, 3), put(tiff + 14, big, 4, 1), put(tiff + 18, big, 2, orientation);
}

/// A picture of the fuzzing corpus, 16 x 8 pixels, red on the left and blue on the right, with a segment in it.
static uint8_t *make_picture(const uint8_t *segment, size_t segment_bytes, size_t *size_bytes) {
    char path[512];
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/image/colour.jpg", getenv("EWA_SOURCE_DIR"));
    uint8_t *bytes = scratch_read(path, size_bytes), *made = malloc(*size_bytes + segment_bytes);
    assert_true(bytes && made);
    memcpy(made, bytes, 2), memcpy(made + 2, segment, segment_bytes);
    memcpy(made + 2 + segment_bytes, bytes + 2, *size_bytes - 2);
    *size_bytes += segment_bytes;
    free(bytes);
    return made;
}

TEST(test_orientations) {
    (void)state;
    uint8_t segment[HEAD_BYTES + TIFF_BYTES];
    for (int big = 0; big < 2; big++)
        for (uint32_t orientation = 0; orientation <= 9; orientation++) {
            size_t size_bytes;
            make_segment(segment, big, orientation);
            OWNED(check_free) uint8_t *bytes = make_picture(segment, sizeof segment, &size_bytes);
            const uint32_t wanted = orientation >= 1 && orientation <= 8 ? orientation : 1;
            assert_int_equal(ewa_exif_orientation(bytes, size_bytes), wanted);
            // Every truncation, exactly as many bytes as there are, so that a sanitizer sees one too many.
            for (size_t cut = 0; cut < 2 + sizeof segment + 40; cut++) {
                OWNED(check_free) uint8_t *part = malloc(cut + 1);
                memcpy(part + 1, bytes, cut);
                const uint32_t found = ewa_exif_orientation(part + 1, cut);
                assert_true(found == 1 || found == wanted);
                if (cut < 2 + HEAD_BYTES + 20) assert_int_equal(found, 1);
            }
        }
}

/// What is broken says nothing.
TEST(test_broken) {
    (void)state;
    static const struct {
        size_t at;
        uint8_t value;
    } edits[] = {{1, 0xe2},  {4, 'e'},   {HEAD_BYTES, 'X'},      {HEAD_BYTES + 1, 'M'},  {HEAD_BYTES + 2, 43},
                 {3, 9},     {2, 0xff},  {HEAD_BYTES + 4, 0xff}, {HEAD_BYTES + 7, 0xff}, {HEAD_BYTES + 8, 0},
                 {HEAD_BYTES + 10, 0x13}, {HEAD_BYTES + 12, 4},  {HEAD_BYTES + 14, 2},   {HEAD_BYTES + 18, 0}};
    for (size_t i = 0; i < sizeof edits / sizeof edits[0]; i++) {
        uint8_t segment[HEAD_BYTES + TIFF_BYTES];
        size_t size_bytes;
        make_segment(segment, false, 6);
        segment[edits[i].at] = edits[i].value;
        OWNED(check_free) uint8_t *bytes = make_picture(segment, sizeof segment, &size_bytes);
        assert_int_equal(ewa_exif_orientation(bytes, size_bytes), 1);
    }
}

/// Whether a pixel is red.
static bool is_red(const ewa_image *image, uint32_t x, uint32_t y) {
    const float *pixel = image->pixels + ((size_t)y * image->width_px + x) * 3;
    return pixel[0] > pixel[2];
}

/// Writes a picture of 16 x 8 pixels, red in the upper left quarter, else blue, with a segment in it.
static void write_quarters(ewa_context *context, const char *path, const uint8_t *segment, size_t segment_bytes) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, 16, 8, 3, &image), EWA_OK);
    for (uint32_t y = 0; y < 8; y++)
        for (uint32_t x = 0; x < 16; x++) {
            float *pixel = image.pixels + 3 * (16 * y + x);
            pixel[0] = x < 8 && y < 4, pixel[1] = 0, pixel[2] = 1 - pixel[0];
        }
    assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
    ewa_image_free(&image);
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes), *made = malloc(size_bytes + segment_bytes);
    assert_non_null(made);
    memcpy(made, bytes, 2), memcpy(made + 2, segment, segment_bytes);
    memcpy(made + 2 + segment_bytes, bytes + 2, size_bytes - 2);
    scratch_write(path, made, size_bytes + segment_bytes);
}

/// Where the red quarter is: 1: on the right, 2: below.
static int quarter_of(const ewa_image *image) {
    const uint32_t right = image->width_px - 2, below = image->height_px - 2;
    int found = -1;
    for (int i = 0; i < 4; i++) {
        if (!is_red(image, i & 1 ? right : 1, i & 2 ? below : 1)) continue;
        assert_int_equal(found, -1);
        found = i;
    }
    return found;
}

TEST(test_turned) {
    (void)state;
    static const int wanted[9] = {[5] = 0, [6] = 1, [7] = 3, [8] = 2};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    char path[512];
    scratch_path("turned.jpg", path);
    for (uint32_t orientation = 1; orientation <= 8; orientation++) {
        uint8_t segment[HEAD_BYTES + TIFF_BYTES];
        make_segment(segment, true, orientation);
        write_quarters(context, path, segment, sizeof segment);
        OWNED(ewa_image_free) ewa_image image;
        assert_int_equal(ewa_image_load_sized(context, path, 16, 8, &image), EWA_OK); // as it is stored
        assert_true(image.width_px == 16 && quarter_of(&image) == 0);
        ewa_image_free(&image);
        assert_int_equal(ewa_image_load_sized(context, path, 8, 16, &image), EWA_OK);
        assert_int_equal(image.width_px, orientation < 5 ? 16 : 8); // 16: that it does not fit is the caller's to say
        assert_int_equal(quarter_of(&image), wanted[orientation]);
    }
    ewa_image image;
    assert_int_equal(ewa_image_load_sized(context, "nowhere.jpg", 8, 16, &image), EWA_ERROR_IO);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
