// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa_image_compare() against the formulas, written plainly; ewa_photo_load() of what is transparent.
#include "ewa/ewa.h"
#include "check.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 37, HEIGHT = 23 };

static ewa_image noise(ewa_context *context, uint32_t channels, uint64_t seed, double strength) {
    ewa_image image;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, channels, &image), EWA_OK);
    check_random shared = {1}, own = {seed};
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        for (size_t c = 0; c < channels; c++)
            image.pixels[i * channels + c] =
                c == 3 ? 1 : (float)(check_uniform(&shared, 0, 1) + check_uniform(&own, -strength, strength));
    return image;
}

/// A display value, of pixels that count; 0 beyond and elsewhere.
static double shown(const ewa_image *image, const ewa_image *truth, int x, int y, int channel) {
    if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT) return 0;
    const size_t at = (size_t)y * WIDTH + (size_t)x;
    if (truth->channel_count == 4 && truth->pixels[4 * at + 3] < 1) return 0;
    return (double)ewa_srgb_from_linear(
        image->pixels[at * image->channel_count + (image->channel_count == 1 ? 0 : (size_t)channel)]);
}

/// The plain formulas: every window from its 121 pixels.
static void compare_plainly(const ewa_image *image, const ewa_image *truth, double *squares, double *ssim) {
    double weights[11][11], whole = 0, count = 0;
    for (int j = 0; j < 11; j++)
        for (int i = 0; i < 11; i++)
            whole += weights[j][i] = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
    *squares = *ssim = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            if (truth->channel_count == 4 && truth->pixels[4 * ((size_t)y * WIDTH + (size_t)x) + 3] < 1) continue;
            for (int c = 0; c < 3; c++) {
                double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
                for (int j = 0; j < 11; j++)
                    for (int i = 0; i < 11; i++) {
                        const double w = weights[j][i] / whole, p = shown(image, truth, x + i - 5, y + j - 5, c),
                                     q = shown(truth, truth, x + i - 5, y + j - 5, c);
                        a += w * p, b += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
                    }
                *ssim += (2 * a * b + 1e-4) * (2 * (ab - a * b) + 9e-4) /
                         ((a * a + b * b + 1e-4) * (aa - a * a + bb - b * b + 9e-4));
                const double off = shown(image, truth, x, y, c) - shown(truth, truth, x, y, c);
                *squares += off * off;
                count++;
            }
        }
    *squares /= count, *ssim /= count;
}

TEST(test_formulas) {
    static const uint32_t channels[3][2] = {{3, 3}, {4, 1}, {3, 4}};
    for (int n = 0; n < 3; n++) {
        double before = NAN;
        for (uint32_t workers = 1; workers < 5; workers += 3) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(workers, NULL);
            OWNED(ewa_image_free)
            ewa_image image = noise(context, channels[n][0], 2, 0.2), truth = noise(context, channels[n][1], 3, 0);
            uint64_t masked = 0;
            for (size_t i = 0; n == 2 && i < WIDTH * HEIGHT; i += 7, masked++) truth.pixels[4 * i + 3] = 0.5f;
            ewa_image_quality found;
            assert_int_equal(ewa_image_compare(&image, &truth, &found), EWA_OK);
            double squares, ssim;
            compare_plainly(&image, &truth, &squares, &ssim);
            assert_int_equal(found.pixel_count, WIDTH * HEIGHT - masked);
            if (fabs(found.mean_squared_error - squares) > 1e-9 || fabs(found.ssim - ssim) > 1e-9 ||
                fabs(found.psnr_db + 10 * log10(squares)) > 1e-6)
                fail_msg("%d: %g, SSIM %g instead of %g, %g", n, found.mean_squared_error, found.ssim, squares, ssim);
            if (workers > 1) assert_true(found.ssim == before);
            before = found.ssim;
        }
    }
}

/// The same is alike; a difference of 0.1 everywhere is 20 dB; where nothing counts there is no number.
TEST_ON(test_known, 1) {
    OWNED(ewa_image_free) ewa_image image = noise(context, 3, 2, 0.1), other;
    ewa_image_quality found;
    assert_int_equal(ewa_image_compare(&image, &image, &found), EWA_OK);
    assert_true(isinf(found.psnr_db) && fabs(found.ssim - 1) < 1e-12);
    ewa_image_free(&image);
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 3, &image), EWA_OK);
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 4, &other), EWA_OK);
    assert_int_equal(ewa_image_compare(&image, &other, &found), EWA_OK);
    assert_true(found.pixel_count == 0 && isnan(found.psnr_db) && isnan(found.ssim));
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        for (size_t c = 0; c < 4; c++) {
            if (c < 3) image.pixels[3 * i + c] = ewa_linear_from_srgb(0.5f);
            other.pixels[4 * i + c] = c < 3 ? ewa_linear_from_srgb(0.6f) : 1;
        }
    assert_int_equal(ewa_image_compare(&image, &other, &found), EWA_OK);
    assert_true(fabs(found.psnr_db - 20) < 1e-3);
    OWNED(ewa_image_free) ewa_image small;
    assert_int_equal(ewa_image_create(context, WIDTH, 5, 3, &small), EWA_OK);
    assert_int_equal(ewa_image_compare(&small, &image, &found), EWA_ERROR_ARGUMENT);
    small.channel_count = 2;
    assert_int_equal(ewa_image_compare(&small, &image, &found), EWA_ERROR_ARGUMENT);
    small.channel_count = 3;
}

/// Half of red over a background of 0.25 is what sRGB numbers make of it; without one it stays as it is.
TEST_ON(test_transparent, 1) {
    OWNED(ewa_image_free) ewa_image half;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 4, &half), EWA_OK);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) half.pixels[4 * i] = half.pixels[4 * i + 3] = i ? 0.5f : 0;
    ewa_photo photo = {.image = &half};
    ewa_camera_init(&photo.camera);
    photo.camera.width_px = WIDTH, photo.camera.height_px = HEIGHT;
    const float background[3] = {0.25f, 0.25f, 0.25f};
    ewa_image loaded;
    assert_int_equal(ewa_photo_load(context, &photo, background, &loaded), EWA_OK);
    assert_true(fabsf(ewa_srgb_from_linear(loaded.pixels[4]) - 0.625f) < 1e-5f);
    assert_true(fabsf(ewa_srgb_from_linear(loaded.pixels[5]) - 0.125f) < 1e-5f && loaded.pixels[7] == 1);
    assert_true(fabsf(ewa_srgb_from_linear(loaded.pixels[0]) - 0.25f) < 1e-5f);
    ewa_image_free(&loaded);
    assert_int_equal(ewa_photo_load(context, &photo, NULL, &loaded), EWA_OK);
    assert_memory_equal(loaded.pixels, half.pixels, sizeof(float) * 4 * WIDTH * HEIGHT);
    assert_true(loaded.pixels != half.pixels); // a copy
    ewa_image_free(&loaded);
    photo.camera.width_px++;
    assert_int_equal(ewa_photo_load(context, &photo, background, &loaded), EWA_ERROR_ARGUMENT);
    assert_null(loaded.pixels);
    photo.image = NULL;
    assert_int_equal(ewa_photo_load(context, &photo, background, &loaded), EWA_ERROR_ARGUMENT);
}

TEST(test_memory) {
    for (long n = 0;; n++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(1, &memory);
        ewa_image image = noise(context, 3, 2, 0.1);
        ewa_image_quality found;
        memory.calls_left = n;
        const ewa_status status = ewa_image_compare(&image, &image, &found);
        const bool failed = memory.calls_left < 0;
        assert_int_equal(status, failed ? EWA_ERROR_MEMORY : EWA_OK);
        ewa_image_free(&image);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        if (!failed) break;
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
