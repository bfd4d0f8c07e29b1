// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Textures on surfels: what the filters keep, that optimal is optimal, and that failures leave nothing
// behind.
#include "check_prepare.h"
#include "colors/acquire.h"

#include <math.h>
#include <string.h>

static ewa_vec3 load(const float v[3]) { return vec3_make((double)v[0], (double)v[1], (double)v[2]); }

/// A picture of smooth noise.
static void make_picture(ewa_context *context, uint32_t width, uint32_t height, uint64_t seed,
                         ewa_image *image) {
    check_random random = {seed};
    double wave[6][3];
    for (int k = 0; k < 6; k++)
        for (int c = 0; c < 3; c++) wave[k][c] = check_uniform(&random, -9, 9);
    assert_int_equal(ewa_image_create(context, width, height, 3, image), EWA_OK);
    for (uint32_t i = 0; i < width * height; i++)
        for (uint32_t c = 0; c < 3; c++) {
            double sum = 0.5;
            for (int k = 0; k < 6; k++)
                sum += 0.08 * sin(wave[k][0] * (i % width) / width + wave[k][1] * (i / width) / height +
                                  wave[k][2] * (c + 1));
            image->pixels[3 * i + c] = (float)sum;
        }
}

/// The mean under a Gaussian is the sum over all pixels, near and far, less what is under its outermost part;
/// of a picture turned upside down or around it is the same, wherever the Gaussian begins and ends.
TEST_ON(test_means_are_sums, 1) {
    enum { WIDTH = 23, HEIGHT = 19 };
    check_random random = {21};
    ewa_image images[4]; // as it is, mirrored across, mirrored down, both
    ewa_texture textures[4];
    for (int k = 0; k < 4; k++)
        assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 3, &images[k]), EWA_OK);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            for (uint32_t c = 0; c < 3; c++) {
                const float number = (float)check_uniform(&random, 0, 1);
                for (uint32_t k = 0; k < 4; k++) {
                    const uint32_t column = k & 1 ? WIDTH - 1 - x : x, row = k & 2 ? HEIGHT - 1 - y : y;
                    images[k].pixels[3 * (row * WIDTH + column) + c] = number;
                }
            }
    for (int k = 0; k < 4; k++)
        assert_int_equal(ewa_texture_make(&images[k], EWA_TEXTURE_CLAMP, EWA_TEXTURE_CLAMP, &textures[k]),
                         EWA_OK);
    for (int i = 0; i < 3000; i++) {
        // From Gaussians of a fraction of a pixel, of which single rows decide, to ones of several.
        const double xx = exp(check_uniform(&random, log(0.03), log(3))),
                     yy = exp(check_uniform(&random, log(0.03), log(3)));
        const double xy = check_uniform(&random, -0.8, 0.8) * sqrt(xx * yy), determinant = xx * yy - xy * xy;
        const double x = check_uniform(&random, 7, WIDTH - 7), y = check_uniform(&random, 7, HEIGHT - 7);
        double sums[4] = {0}, maximum = 0;
        for (uint32_t p = 0; p < WIDTH * HEIGHT; p++) {
            const double dx = p % WIDTH + 0.5 - x, dy = (double)(p / WIDTH) + 0.5 - y;
            const double weight = exp(-0.5 * (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / determinant);
            for (int c = 0; c < 3; c++) sums[c] += weight * (double)images[0].pixels[3 * p + c];
            sums[3] += weight;
            maximum = fmax(maximum, weight);
        }
        double mean[4];
        const ewa_texture_gauss gauss = {x, y, xx, xy, yy};
        ewa_texture_mean(&textures[0], 0, &gauss, mean);
        for (int c = 0; c < 3 && maximum > 0.1; c++)
            if (!(fabs(mean[c] - sums[c] / sums[3]) < 0.03))
                fail_msg("Gaussian %g %g, %g %g %g: %g, not %g", x, y, xx, xy, yy, mean[c],
                         sums[c] / sums[3]);
        for (int k = 1; k < 4; k++) {
            const ewa_texture_gauss turned = {k & 1 ? WIDTH - x : x, k & 2 ? HEIGHT - y : y, xx,
                                              k == 3 ? xy : -xy, yy};
            double again[4];
            ewa_texture_mean(&textures[k], 0, &turned, again);
            for (int c = 0; c < 3; c++)
                if (!(fabs(again[c] - mean[c]) < 1e-5))
                    fail_msg("Gaussian %g %g, %g %g %g, turned %d: %g, not %g", x, y, xx, xy, yy, k, again[c],
                             mean[c]);
        }
    }
    for (int k = 0; k < 4; k++) {
        ewa_texture_free(&textures[k]);
        ewa_image_free(&images[k]);
    }
}

/// A picture of one, three or four channels gives the same means, bit for bit, and so does one with a number that is none, which
/// counts as 0.
TEST_ON(test_means_of_channels_agree, 1) {
    enum { SIDE = 37, FORMS = 4 };
    static const uint32_t channels[FORMS] = {1, 3, 4, 3};
    ewa_image images[FORMS];
    ewa_texture textures[FORMS];
    for (int k = 0; k < FORMS; k++) {
        check_random random = {31};
        assert_int_equal(ewa_image_create(context, SIDE, SIDE, channels[k], &images[k]), EWA_OK);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const float grey = i == 700 ? 0 : (float)check_uniform(&random, 0, 1);
            for (uint32_t c = 0; c < channels[k]; c++) images[k].pixels[channels[k] * i + c] = c == 3 ? 1 : grey;
        }
        if (k == 3) images[k].pixels[3 * 700 + 1] = NAN;
        assert_int_equal(ewa_texture_make(&images[k], EWA_TEXTURE_CLAMP, EWA_TEXTURE_REPEAT, &textures[k]), EWA_OK);
        assert_true(textures[k].opaque && textures[k].level_count == textures[0].level_count);
        assert_true((textures[k].levels[0].pixels == images[k].pixels) == (k != 3)); // no copy of what may be large
    }
    check_random random = {32};
    for (int i = 0; i < 500; i++) {
        const double size = check_uniform(&random, 0.5, 40);
        const ewa_texture_gauss gauss = {check_uniform(&random, -5, 42), check_uniform(&random, -50, 90), size, 0, 1.5 * size};
        double first[4], other[4];
        const uint32_t level = ewa_texture_level_of(&textures[0], &gauss);
        for (int k = 0; k < FORMS; k++) {
            ewa_texture_mean(&textures[k], level, &gauss, k ? other : first);
            if (k) assert_memory_equal(first, other, sizeof first);
            ewa_texture_nearest(&textures[k], gauss.x_px, gauss.y_px, other);
            assert_true(other[0] == other[1] && other[1] == other[2] && other[3] == 1);
        }
    }
    for (int k = 0; k < FORMS; k++) {
        ewa_texture_free(&textures[k]);
        ewa_image_free(&images[k]);
    }
}

/// The mean on a small copy of a picture is near that on the picture itself.
TEST_ON(test_means_of_levels_agree, 1) {
    OWNED(ewa_image_free) ewa_image image;
    OWNED(ewa_texture_free) ewa_texture texture;
    make_picture(context, 203, 91, 3, &image);
    assert_int_equal(ewa_texture_make(&image, EWA_TEXTURE_CLAMP, EWA_TEXTURE_REPEAT, &texture), EWA_OK);
    check_random random = {9};
    uint32_t deepest = 0;
    for (int i = 0; i < 200; i++) {
        const double size = check_uniform(&random, 0.5, 40), skew = check_uniform(&random, -0.8, 0.8);
        ewa_texture_gauss gauss = {check_uniform(&random, 0, 203), check_uniform(&random, -91, 200), size,
                                   skew * size, 1.5 * size};
        const uint32_t level = ewa_texture_level_of(&texture, &gauss);
        double fine[4], coarse[4];
        ewa_texture_mean(&texture, 0, &gauss, fine);
        ewa_texture_mean(&texture, level, &gauss, coarse);
        for (int c = 0; c < 3; c++) assert_float_equal(fine[c], coarse[c], 0.012);
        deepest = level > deepest ? level : deepest;
    }
    assert_true(deepest >= 1);
    ewa_texture_gauss needle = {10, 10, 1e9, 0, 1e-3}, point = {1e300, NAN, 1, 0, 1};
    double color[4];
    ewa_texture_round(&needle);
    ewa_texture_mean(&texture, ewa_texture_level_of(&texture, &needle), &needle, color);
    assert_true(color[0] > 0 && color[0] < 1);
    ewa_texture_mean(&texture, 0, &point, color);
}

static ewa_cloud *make_object(ewa_context *context, ewa_object object, uint64_t count, double radius_scale) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = object;
    options.point_count = count;
    options.jitter = 1;
    options.radius_scale = radius_scale;
    options.texcoords = true;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    return cloud;
}

static ewa_acquire_options options_of(ewa_texture_filter filter) {
    WITH_DEFAULTS(ewa_acquire_options, options);
    options.filter = filter;
    options.wrap_s = options.wrap_t = EWA_TEXTURE_CLAMP;
    return options;
}

static void fill(const ewa_image *image, float r, float g, float b) {
    for (size_t i = 0; i < (size_t)image->width_px * image->height_px; i++)
        image->pixels[3 * i] = r, image->pixels[3 * i + 1] = g, image->pixels[3 * i + 2] = b;
}

TEST_ON(test_a_constant_stays, 0) {
    static const ewa_object objects[] = {EWA_OBJECT_PLANE, EWA_OBJECT_SPHERE, EWA_OBJECT_TORUS,
                                         EWA_OBJECT_CUBE, EWA_OBJECT_TERRAIN};
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_create(context, 50, 30, 3, &image), EWA_OK);
    fill(&image, 0.7f, 3, 0);
    for (size_t k = 0; k < sizeof objects / sizeof objects[0]; k++)
        for (int filter = 0; filter <= EWA_TEXTURE_OPTIMAL; filter++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, objects[k], 3000, 1.5);
            const ewa_acquire_options options = options_of((ewa_texture_filter)filter);
            ewa_acquire_report report;
            assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, &report), EWA_OK);
            assert_int_equal(report.textured_count, 3000);
            const float *color = check_stream(cloud, EWA_COLOR);
            for (int i = 0; i < 3000; i++) {
                assert_float_equal(color[3 * i], 0.7, 1e-5);
                assert_float_equal(color[3 * i + 1], 3, 5e-5);
                assert_float_equal(color[3 * i + 2], 0, 1e-5);
            }
        }
}

/// Charts of no extent: every point has the pixel that it is on, whatever is beside that, as palettes have it.
TEST_ON(test_a_palette_is_no_picture, 0) {
    enum { POINTS = 3000 };
    OWNED(ewa_image_free) ewa_image palette;
    assert_int_equal(ewa_image_create(context, 3, 1, 3, &palette), EWA_OK);
    memcpy(palette.pixels, (const float[9]){0, 0, 1, 0.7f, 0.1f, 0.2f, 1, 1, 0}, 9 * sizeof *palette.pixels);
    for (int filter = 0; filter <= EWA_TEXTURE_OPTIMAL; filter++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_CUBE, POINTS, 1.5);
        void *texcoord, *gradient[2];
        assert_int_equal(ewa_cloud_add(cloud, EWA_TEXCOORD, EWA_F32, 2, &texcoord), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_TEXCOORD_S, EWA_F32, 3, &gradient[0]), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_TEXCOORD_T, EWA_F32, 3, &gradient[1]), EWA_OK);
        for (int i = 0; i < 2 * POINTS; i++) ((float *)texcoord)[i] = 0.5f;
        for (int k = 0; k < 2; k++) memset(gradient[k], 0, 3 * POINTS * sizeof(float));
        const ewa_acquire_options options = options_of((ewa_texture_filter)filter);
        assert_int_equal(ewa_cloud_acquire(cloud, &palette, 1, &options, NULL), EWA_OK);
        const float *color = check_stream(cloud, EWA_COLOR);
        for (int i = 0; i < 3 * POINTS; i++) assert_float_equal(color[i], palette.pixels[3 + i % 3], 1e-5);
    }
}

/// The drawn colour at a place of the plane z = 0: kernels of one sigma, normalised.
static void reconstruct(const ewa_cloud *cloud, double x, double y, double color[3]) {
    const float *p = check_stream(cloud, EWA_POSITION), *radius = check_stream(cloud, EWA_RADIUS),
                *c = check_stream(cloud, EWA_COLOR);
    double sum = 0;
    color[0] = color[1] = color[2] = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        const double dx = ((double)p[3 * i] - x) * 3 / (double)radius[i],
                     dy = ((double)p[3 * i + 1] - y) * 3 / (double)radius[i], d2 = dx * dx + dy * dy;
        if (d2 > 9) continue;
        const double weight = exp(-0.5 * d2);
        for (int k = 0; k < 3; k++) color[k] += weight * (double)c[3 * i + (uint64_t)k];
        sum += weight;
    }
    for (int k = 0; k < 3; k++) color[k] /= sum;
}

/// RMS of the drawn first channel against the picture's continuous function, over the middle of the plane.
static double error_of(const ewa_cloud *cloud, const ewa_image *image, const ewa_acquire_options *options) {
    OWNED(ewa_texture_free) ewa_texture texture;
    assert_int_equal(ewa_texture_make(image, options->wrap_s, options->wrap_t, &texture), EWA_OK);
    check_random random = {77};
    const double variance = options->pixel_sigma_px * options->pixel_sigma_px;
    double sum = 0;
    enum { PLACES = 3000 };
    for (int i = 0; i < PLACES; i++) {
        const double x = check_uniform(&random, -0.7, 0.7), y = check_uniform(&random, -0.7, 0.7);
        const ewa_texture_gauss gauss = {(x + 1) / 2 * image->width_px, (1 - y) / 2 * image->height_px,
                                         variance, 0, variance};
        double truth[4], drawn[3];
        ewa_texture_mean(&texture, 0, &gauss, truth);
        reconstruct(cloud, x, y, drawn);
        sum += (drawn[0] - truth[0]) * (drawn[0] - truth[0]);
    }
    return sqrt(sum / PLACES);
}

static double measure(ewa_context *context, const ewa_image *image, ewa_texture_filter filter,
                      ewa_texture_fit fit) {
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 2500, 1.44);
    ewa_acquire_options options = options_of(filter);
    options.fit = fit;
    options.pixel_sigma_px = 1;
    ewa_acquire_report report;
    assert_int_equal(ewa_cloud_acquire(cloud, image, 1, &options, &report), EWA_OK);
    if (filter == EWA_TEXTURE_OPTIMAL) assert_true(report.gradient <= 1e-6 && report.ridge == options.ridge);
    const double error = error_of(cloud, image, &options);
    ewa_cloud_destroy(&cloud);
    return error;
}

/// A ramp of 1 over the plane, 50 points wide: within an eighth of the step from point to point.
TEST_ON(test_a_ramp_is_kept, 0) {
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_create(context, 200, 200, 3, &image), EWA_OK);
    for (uint32_t i = 0; i < 200 * 200; i++)
        for (uint32_t c = 0; c < 3; c++) image.pixels[3 * i + c] = (float)(i % 200) / 200;
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 2500, 1.44);
    const ewa_acquire_options options = options_of(EWA_TEXTURE_EWA);
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, NULL), EWA_OK);
    const float *p = check_stream(cloud, EWA_POSITION), *color = check_stream(cloud, EWA_COLOR);
    for (uint64_t i = 0; i < 2500; i++)
        if (fabsf(p[3 * i]) < 0.9f)
            assert_float_equal(color[3 * i], ((double)p[3 * i] + 1) / 2 - 0.0025, 2e-4);
    ewa_cloud_destroy(&cloud);
    const double ewa = measure(context, &image, EWA_TEXTURE_EWA, EWA_FIT_NORMALIZED),
                 optimal = measure(context, &image, EWA_TEXTURE_OPTIMAL, EWA_FIT_NORMALIZED);
    print_message("ramp: EWA %.2g, optimal %.2g of its height\n", ewa, optimal);
    assert_true(optimal < 0.0025 && optimal < 0.7 * ewa);
}

TEST_ON(test_optimal_is_better, 0) {
    OWNED(ewa_image_free) ewa_image image;
    assert_int_equal(ewa_image_create(context, 100, 100, 3, &image), EWA_OK);
    for (uint32_t i = 0; i < 100 * 100; i++)
        for (uint32_t c = 0; c < 3; c++) image.pixels[3 * i + c] = (i % 100 / 8 + i / 100 / 8) % 2 ? 0 : 1;
    const double nearest = measure(context, &image, EWA_TEXTURE_NEAREST, EWA_FIT_NORMALIZED),
                 ewa = measure(context, &image, EWA_TEXTURE_EWA, EWA_FIT_NORMALIZED),
                 optimal = measure(context, &image, EWA_TEXTURE_OPTIMAL, EWA_FIT_NORMALIZED),
                 sum = measure(context, &image, EWA_TEXTURE_OPTIMAL, EWA_FIT_SUM);
    print_message("checker: nearest %.3f, EWA %.3f, optimal %.3f, by the sum %.3f\n", nearest, ewa, optimal,
                  sum);
    assert_true(optimal < 0.7 * ewa && optimal < 0.7 * nearest && optimal < 0.7 * sum);
}

/// The gradient of what is minimised, by quadrature: nearly nothing at the optimal colours, much elsewhere.
TEST_ON(test_the_gradient_vanishes, 0) {
    enum { POINTS = 100, STEPS = 700 };
    OWNED(ewa_image_free) ewa_image image;
    OWNED(ewa_texture_free) ewa_texture texture;
    make_picture(context, 40, 40, 5, &image);
    assert_int_equal(ewa_texture_make(&image, EWA_TEXTURE_CLAMP, EWA_TEXTURE_CLAMP, &texture), EWA_OK);
    ewa_acquire_options options = options_of(EWA_TEXTURE_EWA);
    options.pixel_sigma_px = 1;
    options.ridge = 1e-6;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, POINTS, 1.5);
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, NULL), EWA_OK);
    float filtered[POINTS], optimal[POINTS];
    for (int i = 0; i < POINTS; i++) filtered[i] = check_stream(cloud, EWA_COLOR)[3 * i];
    options.filter = EWA_TEXTURE_OPTIMAL;
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, NULL), EWA_OK);
    for (int i = 0; i < POINTS; i++) optimal[i] = check_stream(cloud, EWA_COLOR)[3 * i];
    const float *p = check_stream(cloud, EWA_POSITION), *radius = check_stream(cloud, EWA_RADIUS);
    double by_filtered[POINTS] = {0}, by_optimal[POINTS] = {0};
    for (int n = 0; n < STEPS * STEPS; n++) {
        const double x = 4 * (n % STEPS + 0.5) / STEPS - 2, y = 4 * (n / STEPS + 0.5) / STEPS - 2;
        const ewa_texture_gauss gauss = {(x + 1) * 20, (1 - y) * 20, 1, 0, 1};
        double r[POINTS], sum = 0, of_filtered = 0, of_optimal = 0, truth[4];
        for (int i = 0; i < POINTS; i++) {
            const double sigma = (double)radius[i] / 3, dx = x - (double)p[3 * i],
                         dy = y - (double)p[3 * i + 1];
            r[i] = exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
            sum += r[i];
            of_filtered += r[i] * (double)filtered[i];
            of_optimal += r[i] * (double)optimal[i];
        }
        ewa_texture_mean(&texture, 0, &gauss, truth);
        for (int i = 0; i < POINTS; i++) {
            by_filtered[i] += r[i] * (sum * truth[0] - of_filtered);
            by_optimal[i] += r[i] * (sum * truth[0] - of_optimal);
        }
    }
    double filtered2 = 0, optimal2 = 0;
    for (int i = 0; i < POINTS; i++) {
        filtered2 += by_filtered[i] * by_filtered[i];
        optimal2 += by_optimal[i] * by_optimal[i];
    }
    print_message("gradient: %.2g of that at the filtered colours\n", sqrt(optimal2 / filtered2));
    assert_true(optimal2 < 1e-3 * filtered2);
}

TEST(test_threads_change_nothing) {
    static const uint32_t threads[] = {1, 2, 7};
    OWNED(check_free) float *first = NULL;
    for (int k = 0; k < 3; k++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[k], NULL);
        OWNED(ewa_image_free) ewa_image image;
        make_picture(context, 64, 48, 11, &image);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_TORUS, 5000, 1.5);
        assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_OK);
        const float *color = check_stream(cloud, EWA_COLOR);
        if (k == 0) {
            first = malloc(5000 * 3 * sizeof *first);
            assert_non_null(first);
            memcpy(first, color, 5000 * 3 * sizeof *first);
        }
        assert_memory_equal(first, color, 5000 * 3 * sizeof *first);
    }
}

/// Straight alpha comes back; colours are multiplied; what has no coordinates or no picture is white.
TEST_ON(test_alpha_tint_and_gaps, 0) {
    ewa_image image[2] = {{0}};
    assert_int_equal(ewa_image_create(context, 8, 8, 4, &image[0]), EWA_OK);
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 4; c++) image[0].pixels[4 * i + c] = c == 0 ? 0.1f : 0.5f; // premultiplied
    for (int filter = 0; filter <= EWA_TEXTURE_OPTIMAL; filter++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 400, 1.5);
        void *data = NULL;
        float *texcoord = (float *)ewa_cloud_find(cloud, EWA_TEXCOORD)->data;
        texcoord[0] = NAN;
        assert_int_equal(ewa_cloud_add(cloud, EWA_TEXTURE, EWA_U8, 1, &data), EWA_OK);
        for (int i = 0; i < 400; i++) ((uint8_t *)data)[i] = i == 1 ? 1 : i == 2 ? 9 : 0;
        uint8_t *color8 = (uint8_t *)ewa_cloud_find(cloud, EWA_COLOR)->data;
        for (int i = 0; i < 1200; i++) color8[i] = i % 3 == 1 ? 188 : 255;
        ewa_acquire_options options = options_of((ewa_texture_filter)filter);
        options.modulate = true;
        ewa_acquire_report report;
        assert_int_equal(ewa_cloud_acquire(cloud, image, 2, &options, &report), EWA_OK);
        assert_int_equal(report.textured_count, 397);
        assert_int_equal(ewa_cloud_find(cloud, EWA_COLOR)->component_count, 4);
        const float *color = check_stream(cloud, EWA_COLOR);
        assert_float_equal(color[4 * 390], 0.2, 1e-3);
        assert_float_equal(color[4 * 390 + 1], 0.503, 1e-3);
        assert_float_equal(color[4 * 390 + 2], 1, 1e-3);
        assert_float_equal(color[4 * 390 + 3], 0.5, 1e-3);
        if (filter != EWA_TEXTURE_OPTIMAL)
            for (int i = 0; i < 3; i++) {
                assert_float_equal(color[4 * i], 1, 1e-6);
                assert_float_equal(color[4 * i + 3], 1, 1e-6);
            }
    }
    ewa_image_free(&image[0]);
}

/// Points that are no surfels, at one place, or without area on the picture: finite colours.
TEST_ON(test_odd_points, 2) {
    OWNED(ewa_image_free) ewa_image image;
    make_picture(context, 32, 32, 2, &image);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 2000, 1.5);
    float *p = (float *)ewa_cloud_find(cloud, EWA_POSITION)->data,
          *n = (float *)ewa_cloud_find(cloud, EWA_NORMAL)->data,
          *radius = (float *)ewa_cloud_find(cloud, EWA_RADIUS)->data,
          *s = (float *)ewa_cloud_find(cloud, EWA_TEXCOORD_S)->data;
    p[3] = NAN, n[6] = n[7] = n[8] = 0, radius[3] = 0, radius[4] = 1e30f;
    for (int i = 300; i < 330; i++)
        memcpy(p + 3 * i, p + 900, 3 * sizeof *p), memcpy(n + 3 * i, n + 900, 3 * sizeof *n);
    for (int i = 0; i < 3; i++) s[3 * 500 + i] = 0, s[3 * 501 + i] = 1e20f;
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_OK);
    const float *color = check_stream(cloud, EWA_COLOR);
    for (int i = 0; i < 6000; i++) assert_true(isfinite(color[i]) && fabsf(color[i]) < 10);
    ewa_cloud_destroy(&cloud);
    cloud = make_object(context, EWA_OBJECT_PLANE, 0, 1.5);
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_OK);
    ewa_cloud_destroy(&cloud);
    cloud = make_object(context, EWA_OBJECT_PLANE, 1, 1.5);
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_OK);
}

TEST_LOGGED(test_wrong_use_is_named, 1) {
    OWNED(ewa_image_free) ewa_image image;
    make_picture(context, 8, 8, 2, &image);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 100, 1.5);
    static const struct {
        size_t offset;
        double value;
        const char *name;
    } wrong[] = {{offsetof(ewa_acquire_options, pixel_sigma_px), 0.1, "pixel_sigma_px"},
                 {offsetof(ewa_acquire_options, pixel_sigma_px), NAN, "pixel_sigma_px"},
                 {offsetof(ewa_acquire_options, cutoff), 0, "cutoff"},
                 {offsetof(ewa_acquire_options, ridge), 2, "ridge"}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        ewa_acquire_options options = options_of(EWA_TEXTURE_EWA);
        memcpy((char *)&options + wrong[i].offset, &wrong[i].value, sizeof wrong[i].value);
        assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, NULL), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, wrong[i].name));
    }
    ewa_acquire_options options = options_of((ewa_texture_filter)3);
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, &options, NULL), EWA_ERROR_ARGUMENT);
    image.channel_count = 2;
    assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_ERROR_ARGUMENT);
    image.channel_count = 3;
    // Far more overlap than anything is drawn with.
    ewa_cloud *batch = make_object(context, EWA_OBJECT_PLANE, 6000, 300);
    assert_int_equal(ewa_cloud_acquire(batch, &image, 1, NULL, NULL), EWA_ERROR_LIMIT);
    ewa_cloud_destroy(&batch);
    static const char *const needed[] = {EWA_RADIUS, EWA_TEXCOORD_T, EWA_TEXCOORD_S, EWA_TEXCOORD,
                                         EWA_POSITION};
    for (size_t i = 0; i < sizeof needed / sizeof needed[0]; i++) {
        ewa_cloud_remove(cloud, needed[i]);
        assert_int_equal(ewa_cloud_acquire(cloud, &image, 1, NULL, NULL), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log->text, needed[i]));
    }
}

TEST(test_every_failing_allocation_is_clean) {
    bool done = false;
    for (long n = 0; !done; n++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(2, &memory);
        ewa_image image;
        make_picture(context, 8, 8, 2, &image);
        ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 500, 1.5);
        memory.calls_left = n;
        const ewa_status status = ewa_cloud_acquire(cloud, &image, 1, NULL, NULL);
        memory.calls_left = -1;
        done = status == EWA_OK;
        if (!done) assert_int_equal(status, EWA_ERROR_MEMORY);
        assert_int_equal(ewa_cloud_find(cloud, EWA_COLOR)->type, done ? EWA_F32 : EWA_U8);
        ewa_cloud_destroy(&cloud);
        ewa_image_free(&image);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        assert_true(n < 1000);
    }
}

TEST(test_every_cancel_is_clean) {
    bool done = false;
    for (int n = 0; !done; n += 1 + n / 8) {
        int left = 1000;
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_stopped(&left, &memory);
        ewa_image image;
        make_picture(context, 8, 8, 2, &image);
        ewa_cloud *cloud = make_object(context, EWA_OBJECT_PLANE, 500, 1.5);
        left = n;
        const ewa_status status = ewa_cloud_acquire(cloud, &image, 1, NULL, NULL);
        done = status == EWA_OK;
        if (!done) assert_int_equal(status, EWA_CANCELLED);
        ewa_cloud_destroy(&cloud);
        ewa_image_free(&image);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        assert_true(n < 100000);
    }
}

/// Gradients say where points a little further on the surface are on the picture, to a thousandth of the way.
TEST_ON(test_charts_of_objects, 0) {
    static const ewa_object objects[] = {EWA_OBJECT_PLANE, EWA_OBJECT_CUBE, EWA_OBJECT_SPHERE,
                                         EWA_OBJECT_TORUS, EWA_OBJECT_TERRAIN};
    for (size_t k = 0; k < sizeof objects / sizeof objects[0]; k++) {
        enum { COUNT = 40000 };
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, objects[k], COUNT, 1.5);
        const float *p = check_stream(cloud, EWA_POSITION), *at = check_stream(cloud, EWA_TEXCOORD),
                    *n = check_stream(cloud, EWA_NORMAL);
        const float *gradient[2] = {check_stream(cloud, EWA_TEXCOORD_S), check_stream(cloud, EWA_TEXCOORD_T)};
        uint64_t compared = 0;
        double errors[2] = {0}, steps[2] = {0};
        for (uint64_t i = 0; i + 1 < COUNT; i++) {
            const ewa_vec3 d = vec3_sub(load(p + 3 * i + 3), load(p + 3 * i));
            assert_true(at[2 * i] >= 0 && at[2 * i] <= 1 && at[2 * i + 1] >= 0 && at[2 * i + 1] <= 1);
            if (objects[k] == EWA_OBJECT_SPHERE && hypotf(p[3 * i], p[3 * i + 1]) < 0.2f) continue;
            if (vec3_length(d) > 0.05 || vec3_dot(load(n + 3 * i), load(n + 3 * i + 3)) < 0.99) continue;
            for (uint64_t c = 0; c < 2; c++) {
                const ewa_vec3 g =
                    vec3_scale(vec3_add(load(gradient[c] + 3 * i), load(gradient[c] + 3 * i + 3)), 0.5);
                const double step = (double)at[2 * i + 2 + c] - (double)at[2 * i + c];
                if (fabs(step) > 0.5) continue; // seams
                const double error = fabs(vec3_dot(g, d) - step);
                assert_true(error < 2e-3);
                errors[c] += error;
                steps[c] += fabs(step);
                compared++;
            }
        }
        for (int c = 0; c < 2; c++) {
            print_message("object %d, coordinate %d: steps of %.3f on the picture, %.5f off\n",
                          (int)objects[k], c, steps[c], errors[c]);
            assert_true(errors[c] < 1e-3 * steps[c]);
        }
        assert_true(compared > COUNT / 10);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
