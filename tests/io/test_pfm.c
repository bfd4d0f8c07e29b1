// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/image/pfm.c: known bytes, exact round trips, both byte orders, broken heads.
#include "scratch.h"

#include <math.h>

TEST_ON(test_known_bytes, 1) {
    // 1 x 2, rows from the bottom up: the first in the file is the lower one.
    static const char little[] = "Pf\n1 2\n-1.0\n\0\0\x80\x3f\0\0\0\xc0",
                      big[] = "Pf 1\t2\r1e0\n\x3f\x80\0\0\xc0\0\0\0";
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_load_memory(context, little, sizeof little - 1, "little.pfm", &image), EWA_OK);
    assert_int_equal(image.channel_count, 1);
    assert_true(image.width_px == 1 && image.height_px == 2);
    assert_true(image.pixels[0] == -2 && image.pixels[1] == 1);
    char path[512];
    assert_int_equal(ewa_image_save(&image, scratch_path("known.pfm", path), NULL), EWA_OK);
    ewa_image_free(&image);
    size_t size_bytes;
    uint8_t *bytes = scratch_read(path, &size_bytes);
    assert_int_equal(size_bytes, sizeof little - 1);
    assert_memory_equal(bytes, little, size_bytes);
    free(bytes);
    assert_int_equal(ewa_image_load_memory(context, big, sizeof big - 1, "big.pfm", &image), EWA_OK);
    assert_true(image.pixels[0] == -2 && image.pixels[1] == 1);
}

TEST_ON(test_round_trip_is_exact, 1) {
    char path[512];
    scratch_path("saved.pfm", path);
    check_random random = {1};
    for (uint32_t channels = 1; channels <= 4; channels++) {
        ewa_image image, back;
        assert_int_equal(ewa_image_create(context, 37, 11, channels, &image), EWA_OK);
        for (size_t i = 0; i < (size_t)37 * 11 * channels; i++) {
            const uint32_t bits = (uint32_t)check_random_u64(&random); // any number, NaN too
            memcpy(&image.pixels[i], &bits, sizeof bits);
        }
        if (channels == 2) {
            assert_int_equal(ewa_image_save(&image, path, NULL), EWA_ERROR_UNSUPPORTED);
        } else {
            assert_int_equal(ewa_image_save(&image, path, NULL), EWA_OK);
            assert_int_equal(ewa_image_load(context, path, &back), EWA_OK);
            assert_int_equal(back.channel_count, channels == 1 ? 1 : 3);
            for (size_t i = 0; i < 37 * 11; i++)
                assert_memory_equal(&back.pixels[i * back.channel_count], &image.pixels[i * channels],
                                    back.channel_count * sizeof(float));
            ewa_image_free(&back);
        }
        ewa_image_free(&image);
    }
}

TEST_LOGGED(test_broken_heads, 1) {
    static const char *const heads[] = {
        "Pf\n",
        "Pf\n1",
        "Pf\n1 ",
        "Pf\n1 1",
        "Pf\n1 1\n",
        "Pf\n1 1\n-",
        "Pf\n1 1\n-1",
        "Pf\n0 1\n-1\nabcd",
        "Pf\n-1 1\n-1\nabcd",
        "Pf\n1 1\n0\nabcd",
        "Pf\n1 1\nx\nabcd",
        "Pf\n1 1\n-1\nabc",
        "PF\n1 1\n-1\nabcdefghijk",
        "Pf\n1 99999999999999999999\n-1\nabcd",
        "Pf\n60000 60000\n-1\nabcd",
    };
    ewa_image image;
    for (size_t i = 0; i < sizeof heads / sizeof heads[0]; i++) {
        assert_int_equal(ewa_image_load_memory(context, heads[i], strlen(heads[i]), "x.pfm", &image),
                         EWA_ERROR_FORMAT);
        assert_memory_equal(log->text, "x.pfm: PFM: ", 12);
    }
    static const char wide[] = "Pf\n4000000000 1\n-1\nabcd";
    assert_int_equal(ewa_image_load_memory(context, wide, sizeof wide - 1, "x.pfm", &image), EWA_ERROR_LIMIT);
}

TEST_ON(test_every_truncation_is_refused, 1) {
    static const char whole[] = "PF\n1 2\n-0.5\nabcdefghijklmnopqrstuvwx";
    OWNED(ewa_image_free) ewa_image image;
    for (size_t length = 0; length < sizeof whole - 1; length++) {
        OWNED(check_free) char *exact = malloc(length ? length : 1);
        memcpy(exact, whole, length);
        assert_int_equal(ewa_image_load_memory(context, exact, length, "x.pfm", &image), EWA_ERROR_FORMAT);
    }
    assert_int_equal(ewa_image_load_memory(context, whole, sizeof whole - 1, "x.pfm", &image), EWA_OK);
}

TEST_ON(test_real_file, 1) {
    char path[512];
    if (check_data("rgbd/stereo/motorcycle_disp.pfm", path, sizeof path)) {
        OWNED(ewa_image_free) ewa_image image;
        assert_int_equal(ewa_image_load(context, path, &image), EWA_OK);
        assert_true(image.width_px == 741 && image.height_px == 500 && image.channel_count == 1);
        // The floor in front, at the bottom of the picture, has larger disparities than the wall.
        double top = 0, bottom = 0;
        int top_count = 0, bottom_count = 0;
        for (uint32_t x = 0; x < 741; x++) {
            const float upper = image.pixels[20 * 741 + x], lower = image.pixels[480 * 741 + x];
            if (isfinite(upper)) top += (double)upper, top_count++;
            if (isfinite(lower)) bottom += (double)lower, bottom_count++;
        }
        assert_true(bottom / bottom_count > top / top_count);
    }
}

static ewa_status round_trip_work(ewa_context *context, void *user) {
    float pixels[6] = {0};
    ewa_image image = {context, 1, 2, 3, pixels}, back;
    ewa_status status = ewa_image_save(&image, user, NULL);
    if (status == EWA_OK) status = ewa_image_load(context, user, &back);
    if (status == EWA_OK) ewa_image_free(&back);
    return status;
}

TEST(test_failing_allocations) {
    char path[512];
    scratch_fail_each(round_trip_work, (void *)(uintptr_t)scratch_path("memory.pfm", path));
}

TEST_LOGGED(test_unwritable, 1) {
    float pixels[3] = {0};
    const ewa_image image = {context, 1, 1, 3, pixels};
    assert_int_equal(ewa_image_save(&image, "/nowhere/x.pfm", NULL), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "/nowhere/x.pfm"));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
