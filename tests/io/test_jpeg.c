// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/jpeg_read.c: known pixels, every truncation, broken bytes, too many scans, limits; and of
// jpeg_write.c: pixels that come back, what is transparent, what cannot be written.
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
    OWNED(check_free) uint8_t *copy = malloc(size_bytes ? size_bytes : 1);
    memcpy(copy, bytes, size_bytes);
    const ewa_status status = ewa_image_load_memory(context, copy, size_bytes, "scan.jpg", image);
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

TEST_ON(test_known_pixels, 1) {
    static const int red[3] = {200, 60, 40}, blue[3] = {40, 80, 220};
    static const char *const names[] = {"colour.jpg", "progressive.jpg"};
    OWNED(ewa_image_free) ewa_image image;
    size_t size_bytes;
    for (int k = 0; k < 2; k++) {
        OWNED(check_free) uint8_t *bytes = read_picture(names[k], &size_bytes);
        assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_OK);
        assert_true(image.width_px == 16 && image.height_px == 8 && image.channel_count == 3);
        assert_true(is_near(&image, 0, 0, red) && is_near(&image, 7, 7, red));
        assert_true(is_near(&image, 8, 0, blue) && is_near(&image, 15, 7, blue));
        ewa_image_free(&image);
    }
    OWNED(check_free) uint8_t *bytes = read_picture("grey.jpg", &size_bytes); // black, grey and white rows
    assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_OK);
    assert_true(image.width_px == 5 && image.height_px == 3 && image.channel_count == 1);
    for (uint32_t y = 0; y < 3; y++)
        assert_true(is_near(&image, 4, y, (const int[3]){y == 0 ? 0 : y == 1 ? 128 : 255}));
}

/// What is cut in its pixels is a picture with a warning, as other programs have it; all else is an error.
TEST_LOGGED(test_every_truncation, 1) {
    static const char *const names[] = {"colour.jpg", "progressive.jpg", "grey.jpg"};
    for (int k = 0; k < 3; k++) {
        size_t size_bytes, whole = 0;
        OWNED(check_free) uint8_t *bytes = read_picture(names[k], &size_bytes);
        for (size_t cut = 0; cut < size_bytes - 2; cut++) { // libjpeg does not miss the end mark
            OWNED(ewa_image_free) ewa_image image;
            log->text[0] = 0;
            const ewa_status status = decode(context, bytes, cut, &image);
            assert_true(status == EWA_OK || status == EWA_ERROR_FORMAT);
            assert_non_null(strstr(log->text, "scan.jpg"));
            assert_true((status == EWA_OK) == (image.pixels != NULL));
            assert_true(status != EWA_OK || strstr(log->text, "parts are missing or broken"));
            whole += status == EWA_OK;
        }
        assert_true(whole > 0 && whole < size_bytes / 2);
    }
}

TEST_ON(test_broken_bytes, 1) {
    static const char *const names[] = {"colour.jpg", "progressive.jpg", "grey.jpg", "cmyk.jpg"};
    check_random random = {3};
    for (int k = 0; k < 4; k++) {
        size_t size_bytes;
        OWNED(check_free) uint8_t *bytes = read_picture(names[k], &size_bytes);
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
    }
}

TEST_LOGGED(test_refused, 1) {
    ewa_image image;
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = read_picture("cmyk.jpg", &size_bytes);
    assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "scan.jpg: JPEG of 4 components"));
    free(bytes);
    // The last scan of a progressive file, over and over.
    enum { REPEATS = 400 };
    bytes = read_picture("progressive.jpg", &size_bytes);
    size_t scan = size_bytes;
    while (scan > 0 && (bytes[scan - 1] != 0xff || bytes[scan] != 0xda)) scan--;
    assert_true(scan > 0);
    scan--;
    const size_t scan_bytes = size_bytes - 2 - scan; // but for the end mark
    OWNED(check_free) uint8_t *many = malloc(size_bytes + REPEATS * scan_bytes);
    memcpy(many, bytes, size_bytes - 2);
    for (size_t i = 0; i < REPEATS; i++)
        memcpy(many + size_bytes - 2 + i * scan_bytes, bytes + scan, scan_bytes);
    memcpy(many + size_bytes - 2 + REPEATS * scan_bytes, bytes + size_bytes - 2, 2);
    assert_int_equal(decode(context, many, size_bytes + REPEATS * scan_bytes, &image), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log->text, "more than 200 scans"));
    assert_null(image.pixels);
}

/// Sizes are checked before pixels are allocated, whatever the head says.
TEST(test_limits) {
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = read_picture("colour.jpg", &size_bytes);
    size_t head = 0; // the frame's: ff c0, length, bits, height, width
    while (bytes[head] != 0xff || bytes[head + 1] != 0xc0) head++;
    for (int k = 0; k < 3; k++) {
        WITH_DEFAULTS(ewa_context_options, options);
        if (k == 0) options.limits.max_image_side = 15;
        if (k == 1) options.limits.max_memory_bytes = 16 * 8 * 3 * sizeof(float) - 1;
        if (k == 2) { // 65,500 x 65,500
            options.limits.max_memory_bytes = (uint64_t)1 << 30;
            for (size_t i = 5; i < 9; i++) bytes[head + i] = i % 2 ? 0xff : 0xdc;
        }
        OWNED(ewa_context_destroy) ewa_context *context = NULL;
        assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
        ewa_image image;
        assert_int_equal(decode(context, bytes, size_bytes, &image), EWA_ERROR_LIMIT);
        assert_null(image.pixels);
    }
}

static ewa_status load_colour(ewa_context *context, void *user) {
    (void)user;
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = read_picture("colour.jpg", &size_bytes);
    OWNED(ewa_image_free) ewa_image image;
    const ewa_status status = decode(context, bytes, size_bytes, &image);
    return status;
}

TEST(test_failing_allocations) { scratch_fail_each(load_colour, NULL); }

/// A smooth picture with a line of another colour, which coarser colours would smear.
static void fill_codes(uint8_t *codes, uint32_t width, uint32_t height, uint32_t channels) {
    for (uint32_t j = 0; j < height; j++)
        for (uint32_t i = 0; i < width; i++, codes += channels) {
            const uint8_t all[4] = {(uint8_t)(i == width / 2 ? 250 : 200 * i / width),
                                    (uint8_t)(200 * j / height), (uint8_t)(255 - 200 * i / width), 255};
            for (uint32_t c = 0; c < channels; c++) codes[c] = all[c];
        }
}

/// The mean and largest difference of codes from a file's.
static void compare(ewa_context *context, const char *path, const uint8_t *codes, uint32_t channels,
                    double *mean, int *largest) {
    ewa_image image;
    assert_int_equal(ewa_image_load(context, path, &image), EWA_OK);
    assert_int_equal(image.channel_count, channels == 1 ? 1 : 3);
    const size_t count = (size_t)image.width_px * image.height_px;
    *mean = 0, *largest = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < image.channel_count; c++) {
            const int code = ewa_srgb8_from_linear(image.pixels[i * image.channel_count + c]);
            const int off = abs(code - codes[i * channels + c]);
            *mean += off / (double)(count * image.channel_count);
            *largest = off > *largest ? off : *largest;
        }
    ewa_image_free(&image);
}

/// Grey, RGB and opaque RGBA come back, whatever the suffix's case, from 8 bits and from floats; nothing is said.
TEST_LOGGED(test_round_trip, 2) {
    static const uint32_t sizes[][2] = {{1, 1}, {7, 300}, {160, 90}}, counts[] = {1, 3, 4};
    static const char *const names[] = {"trip.jpg", "trip.jpeg", "trip.JPG"};
    for (int s = 0; s < 3; s++)
        for (int n = 0; n < 3; n++) {
            const uint32_t width = sizes[s][0], height = sizes[s][1], channels = counts[n];
            OWNED(check_free) uint8_t *codes = malloc((size_t)width * height * channels);
            char path[512];
            double mean;
            int largest;
            fill_codes(codes, width, height, channels);
            assert_int_equal(ewa_pixels_save(context, scratch_path(names[n], path), width, height, channels,
                                             codes, (size_t)width * channels, NULL),
                             EWA_OK);
            compare(context, path, codes, channels, &mean, &largest);
            if (mean > 1.2 || largest > 14)
                fail_msg("%ux%u of %u: %g, at most %d off", width, height, channels, mean, largest);
            OWNED(ewa_image_free) ewa_image image;
            assert_int_equal(ewa_image_create(context, width, height, channels, &image), EWA_OK);
            for (size_t i = 0; i < (size_t)width * height * channels; i++)
                image.pixels[i] = channels == 4 && i % 4 == 3 ? 1 : ewa_srgb_decoded[codes[i]];
            size_t first_bytes, second_bytes;
            OWNED(check_free) uint8_t *first = scratch_read(path, &first_bytes);
            assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
            OWNED(check_free) uint8_t *second = scratch_read(path, &second_bytes);
            assert_int_equal(first_bytes, second_bytes);
            assert_memory_equal(first, second, first_bytes);
        }
    assert_int_equal(log->count, 0);
}

/// What is transparent is over white, by light: half of black over white is 188, and a warning says so.
TEST_LOGGED(test_over_white, 1) {
    uint8_t codes[16 * 16 * 4] = {0}, wanted[16 * 16 * 3];
    char path[512];
    double mean;
    int largest;
    for (int alpha = 0; alpha < 256; alpha += 51) {
        for (int i = 0; i < 256; i++) codes[4 * i + 3] = (uint8_t)alpha;
        const float light = 1 - (float)alpha / 255;
        memset(wanted, ewa_srgb8_from_linear(light), sizeof wanted);
        log->count = 0;
        assert_int_equal(ewa_jpeg_save(context, scratch_path("white.jpg", path), 16, 16, 4, codes, 64, NULL),
                         EWA_OK);
        assert_int_equal(log->count, alpha < 255);
        if (log->count) assert_non_null(strstr(log->text, "no transparency"));
        compare(context, path, wanted, 3, &mean, &largest);
        assert_true(largest <= 2);
    }
}

TEST_LOGGED(test_not_written, 1) {
    char path[512];
    remove(scratch_path("never.jpg", path));
    const uint8_t codes[12] = {0};
    assert_int_equal(ewa_jpeg_save(context, path, 2, 2, 2, codes, 6, NULL), EWA_ERROR_UNSUPPORTED);
    assert_int_equal(ewa_jpeg_save(context, path, 2, 2, 3, codes, 5, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_jpeg_save(context, path, 0, 2, 3, codes, 6, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_jpeg_save(context, path, 65501, 1, 1, codes, 65501, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_pixels_save(context, NULL, 2, 2, 3, codes, 6, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_pixels_save(context, "picture.ppm", 2, 2, 3, codes, 6, NULL), EWA_ERROR_UNSUPPORTED);
    assert_null(fopen(path, "rb"));
    assert_int_equal(ewa_jpeg_save(context, "/nowhere/x.jpg", 2, 2, 3, codes, 6, NULL), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "/nowhere/x.jpg"));
    assert_int_equal(ewa_jpeg_save(context, "/dev/full", 2, 2, 3, codes, 6, NULL), EWA_ERROR_IO);
}

static ewa_status save_colour(ewa_context *context, void *user) {
    OWNED(check_free) uint8_t *codes = malloc(300 * 200 * 3);
    fill_codes(codes, 300, 200, 3);
    const ewa_status status = ewa_jpeg_save(context, user, 300, 200, 3, codes, 900, NULL);
    return status;
}

/// Lower qualities are smaller and farther off; what is out of range is refused with its name.
TEST_LOGGED(test_quality, 1) {
    enum { WIDTH = 160, HEIGHT = 90 };
    uint8_t codes[WIDTH * HEIGHT * 3];
    fill_codes(codes, WIDTH, HEIGHT, 3);
    char path[512];
    scratch_path("quality.jpg", path);
    size_t last_bytes = 0, default_bytes = 0;
    double last_off = 256;
    assert_int_equal(ewa_jpeg_save(context, path, WIDTH, HEIGHT, 3, codes, WIDTH * 3, NULL), EWA_OK);
    OWNED(check_free) uint8_t *by_default = scratch_read(path, &default_bytes);
    static const uint32_t qualities[] = {0, 30, 60, 95, 100};
    for (int k = 0; k < 5; k++) {
        WITH_DEFAULTS(ewa_image_save_options, options);
        options.jpeg_quality = qualities[k];
        assert_int_equal(ewa_pixels_save(context, path, WIDTH, HEIGHT, 3, codes, WIDTH * 3, &options), EWA_OK);
        size_t size_bytes;
        double mean;
        int largest;
        OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
        compare(context, path, codes, 3, &mean, &largest);
        assert_true(size_bytes > last_bytes && mean < last_off);
        last_bytes = size_bytes, last_off = mean;
        if (qualities[k] != 95) continue;
        assert_int_equal(size_bytes, default_bytes);
        assert_memory_equal(bytes, by_default, size_bytes);
    }
    WITH_DEFAULTS(ewa_image_save_options, options);
    options.jpeg_quality = 101;
    assert_int_equal(ewa_jpeg_save(context, path, WIDTH, HEIGHT, 3, codes, WIDTH * 3, &options), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "jpeg_quality"));
}

TEST(test_failing_saves) {
    char path[512];
    scratch_path("failing.jpg", path);
    scratch_fail_each(save_colour, path);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
