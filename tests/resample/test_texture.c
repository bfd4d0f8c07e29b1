// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/texture/texture*.c: the fast way against the reference, the same bytes from every machine,
// known answers.
#include "resample/texture_fixture.h"

#include <math.h>
#include <string.h>

static ewa_context *context;

static int enter(void **state) {
    context = check_context(2, NULL);
    return 0;
}

static int leave(void **state) {
    ewa_context_destroy(&context);
    return 0;
}

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/// Maps of a texture of 96 x 80 into a picture of 150 x 110, of all kinds.
static const struct {
    const char *name;
    double h[9];
} maps[] = {
    {"identity", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"shifted, turned", {0.8, -0.5, 50.3, 0.45, 0.85, 5.2, 0, 0, 1}},
    {"magnified", {4.3, 0.2, -60, -0.3, 3.9, -40, 0, 0, 1}},
    {"minified", {0.21, 0.05, 40, -0.06, 0.19, 40, 0, 0, 1}},
    {"anisotropic", {2.5, 0.3, -40, 0.02, 0.11, 50, 0, 0, 1}},
    {"mirrored", {-1.2, 0, 130, 0, 1.1, 5, 0, 0, 1}},
    {"tilted", {1.1, 0.9, -20, 0.05, 0.9, 10, 0.0004, 0.009, 0.3}},
    {"horizon inside", {1.5, 0.9, 20, 0.1, -0.9, 60, 0.0004, 0.02, -0.4}},
    {"eye on the texture", {1.5, 0.9, 20, 0.1, 1.9, -20, 0.0001, 0.04, -1.001}},
    {"magnified a thousandfold", {1000, 0, -48000, 0, 1000, -40000, 0, 0, 1}},
    {"one pixel for all", {0.004, 0, 70.2, 0, 0.004, 50.6, 0, 0, 1}},
    {"beside the picture", {1, 0, 400, 0, 1, 0, 0, 0, 1}},
};

enum { MAPS = sizeof maps / sizeof maps[0] };

static const char *const methods[] = {"hybrid", "splat", "point", "bilinear"};

/// Floats differ by rounding; the hybrid's blocks decide together what texels are, and use levels.
TEST(test_reference) {
    for (int channels = 1; channels <= 4; channels++) {
        if (channels == 2) continue;
        raster source = raster_make(EWA_PIXEL_LINEAR, (uint32_t)channels, 96, 80);
        OWNED(raster_free) raster fast = raster_make(EWA_PIXEL_LINEAR, (uint32_t)channels, 150, 110);
        OWNED(raster_free) raster slow = raster_make(EWA_PIXEL_LINEAR, (uint32_t)channels, 150, 110);
        raster_paint(&source, 5);
        for (int m = 0; m < MAPS; m++) {
            for (int method = 0; method < 4; method++) {
                ewa_texture_options options = texture_options((ewa_texture_method)method);
                options.background[0] = options.background[3] = 0.3f;
                const ewa_mat3 map = texture_map_of(maps[m].h);
                texture_draw(context, &source, &map, &options, &fast);
                texture_draw_reference(context, &source, &map, &options, &slow);
                const bool levels = method == EWA_TEXTURE_HYBRID || method == EWA_TEXTURE_POINT;
                const double largest = raster_difference(&fast, &slow), rms = raster_rms(&fast, &slow);
                if (!(largest < (levels ? 0.05 : 2e-3) && rms < (levels ? 3e-3 : 3e-5)))
                    fail_msg("%s, %s, %d channels: largest %g, rms %g", maps[m].name, methods[method],
                             channels, largest, rms);
            }
        }
        raster_free(&source);
    }
}

/// Wide kernels, whose points do not fit into two by two pixels, and narrow ones.
TEST(test_reference_kernels) {
    static const double kernels[][4] = {
        {0.3, 2, 0.3, 0.5}, {0.7, 3, 0.5, 0.8}, {2, 4, 2, 1}, {0.1, 1, 1, 0.1}};
    OWNED(raster_free) raster source = raster_make(EWA_PIXEL_SRGB8, 3, 96, 80);
    OWNED(raster_free)
    raster fast = raster_make(EWA_PIXEL_LINEAR, 4, 150, 110),
           slow = raster_make(EWA_PIXEL_LINEAR, 4, 150, 110);
    raster_paint(&source, 6);
    for (size_t k = 0; k < 4; k++) {
        for (int m = 1; m < MAPS; m++) {
            for (int method = 0; method < 3; method++) {
                ewa_texture_options options = texture_options((ewa_texture_method)method);
                options.prefilter_px = kernels[k][0];
                options.cutoff = kernels[k][1];
                options.sigma_texels = kernels[k][2];
                options.point_spacing_px = kernels[k][3];
                const ewa_mat3 map = texture_map_of(maps[m].h);
                texture_draw(context, &source, &map, &options, &fast);
                texture_draw_reference(context, &source, &map, &options, &slow);
                // A kernel that ends high lets pixels jump where rounding moves its rim.
                const double limit = method == EWA_TEXTURE_SPLAT ? 4e-3 : 3e-2,
                             rms = raster_rms(&fast, &slow);
                if (!(rms < limit))
                    fail_msg("kernel %zu, %s, %s: rms %g", k, maps[m].name, methods[method], rms);
            }
        }
    }
}

/// The same bytes for one thread and for many, and from each instruction set.
TEST(test_same_bytes) {
    OWNED(raster_free) raster source = raster_make(EWA_PIXEL_SRGB8, 4, 130, 117);
    raster_paint(&source, 8);
    for (int m = 0; m < MAPS; m++) {
        for (int method = 0; method < 4; method++) {
            OWNED(raster_free) raster first = raster_make(EWA_PIXEL_SRGB8, 4, 150, 110);
            const ewa_mat3 map = texture_map_of(maps[m].h);
            const uint32_t masks[] = {EWA_CPU_ALL, EWA_CPU_ALL, EWA_CPU_AVX2, 0};
            const uint32_t threads[] = {1, 5, 2, 2};
            for (int k = 0; k < 4; k++) {
                OWNED(ewa_context_destroy) ewa_context *other = check_context_of(threads[k], masks[k]);
                OWNED(raster_free) raster again = raster_make(EWA_PIXEL_SRGB8, 4, 150, 110);
                ewa_texture_options options = texture_options((ewa_texture_method)method);
                options.repeat = m % 2 && method != EWA_TEXTURE_SPLAT;
                texture_draw(other, &source, &map, &options, k ? &again : &first);
                if (k && !raster_same(&first, &again))
                    fail_msg("%s, %s: run %d differs by %g", maps[m].name, methods[method], k,
                             raster_difference(&first, &again));
            }
        }
    }
}

/// Identity keeps every pixel covered and blurs a little: by the filter and the discs together, whose
/// standard deviation is half a pixel. A smooth image comes back within 1 %.
TEST(test_identity) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_LINEAR, 3, 100, 90),
           target = raster_make(EWA_PIXEL_LINEAR, 4, 100, 90);
    for (uint32_t y = 0; y < 90; y++)
        for (uint32_t x = 0; x < 100; x++)
            for (uint32_t c = 0; c < 3; c++)
                raster_set(&source, x, y, c, 0.5 + 0.3 * sin(0.2 * x + c) * cos(0.17 * y));
    const ewa_mat3 map = texture_map_of(identity);
    for (int method = 0; method < 4; method++) {
        const ewa_texture_options options = texture_options((ewa_texture_method)method);
        texture_draw(context, &source, &map, &options, &target);
        for (uint32_t y = 0; y < 90; y++) {
            for (uint32_t x = 0; x < 100; x++) {
                assert_true(raster_get(&target, x, y, 3) == 1);
                // At the border, only one side is averaged.
                const double tolerance = x == 0 || y == 0 || x == 99 || y == 89 ? 0.03 : 0.01;
                for (uint32_t c = 0; c < 3; c++)
                    assert_float_equal(raster_get(&target, x, y, c), raster_get(&source, x, y, c), tolerance);
            }
        }
    }
    // An impulse is spread as the two Gaussians together are: V' = sigma^2 + h^2.
    memset(source.memory, 0, source.row_bytes);
    for (uint32_t y = 0; y < 90; y++)
        for (uint32_t x = 0; x < 100; x++)
            for (uint32_t c = 0; c < 3; c++) raster_set(&source, x, y, c, x == 50 && y == 40);
    const ewa_texture_options options = texture_options(EWA_TEXTURE_SPLAT);
    texture_draw(context, &source, &map, &options, &target);
    const double variance =
        options.sigma_texels * options.sigma_texels + options.prefilter_px * options.prefilter_px;
    const double middle = raster_get(&target, 50, 40, 0);
    assert_float_equal(raster_get(&target, 51, 40, 0) / middle, exp(-0.5 / variance), 1e-4);
    assert_float_equal(raster_get(&target, 51, 41, 0) / middle, exp(-1 / variance), 1e-4);
    assert_true(raster_get(&target, 53, 40, 0) == 0);
}

/// Whole shifts move the bytes, also across tiles.
TEST(test_shift) {
    OWNED(raster_free) raster source = raster_make(EWA_PIXEL_SRGB8, 4, 90, 70);
    raster_paint(&source, 12);
    for (int method = 0; method < 4; method++) {
        const ewa_texture_options options = texture_options((ewa_texture_method)method);
        OWNED(raster_free)
        raster still = raster_make(EWA_PIXEL_SRGB8, 4, 90, 70),
               moved = raster_make(EWA_PIXEL_SRGB8, 4, 200, 170);
        ewa_mat3 map = texture_map_of(identity);
        texture_draw(context, &source, &map, &options, &still);
        map.m[2][0] = 57;
        map.m[2][1] = 93;
        texture_draw(context, &source, &map, &options, &moved);
        for (uint32_t y = 0; y < 170; y++) {
            for (uint32_t x = 0; x < 200; x++) {
                const bool inside = x >= 57 && x < 57 + 90 && y >= 93 && y < 93 + 70;
                for (uint32_t c = 0; c < 4; c++)
                    assert_true(raster_get(&moved, x, y, c) ==
                                (inside ? raster_get(&still, x - 57, y - 93, c) : 0));
            }
        }
    }
}

/// One colour stays that colour, wherever it is seen, and alpha is the share of the pixel that is covered:
/// all of it together is the area of the quadrangle.
TEST(test_constant_and_area) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_LINEAR, 3, 96, 80),
           target = raster_make(EWA_PIXEL_LINEAR, 4, 150, 110);
    static const double color[3] = {0.2, 0.5, 0.8};
    for (uint32_t y = 0; y < 80; y++)
        for (uint32_t x = 0; x < 96; x++)
            for (uint32_t c = 0; c < 3; c++) raster_set(&source, x, y, c, color[c]);
    static const double corners[][4][2] = {
        {{10.3, 12.1}, {130.7, 5.5}, {140.2, 100.9}, {3.3, 80.2}}, // as large
        {{60.1, 50.2}, {80.8, 52.3}, {75.5, 66.6}, {61.9, 61.1}},  // small
        {{20.5, 90.25}, {130, 92}, {131, 95.5}, {19, 94.75}},      // thin
        {{130, 10}, {12, 5}, {9, 100}, {120, 90}},                 // mirrored
    };
    for (size_t k = 0; k < 4; k++) {
        ewa_mat3 map;
        assert_int_equal(ewa_texture_map_from_corners(context, 96, 80, corners[k], &map), EWA_OK);
        double area = 0;
        for (int i = 0; i < 4; i++) {
            const double *p = corners[k][i], *q = corners[k][(i + 1) % 4];
            area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
        }
        for (int method = 0; method < 4; method++) {
            if (method == EWA_TEXTURE_POINT && k != 1) continue; // has holes
            const ewa_texture_options options = texture_options((ewa_texture_method)method);
            texture_draw(context, &source, &map, &options, &target);
            double sum = 0;
            for (uint32_t y = 0; y < 110; y++) {
                for (uint32_t x = 0; x < 150; x++) {
                    const double alpha = raster_get(&target, x, y, 3);
                    assert_in_range(floor(alpha * 1000), 0, 1000);
                    sum += alpha;
                    for (uint32_t c = 0; c < 3; c++)
                        assert_float_equal(raster_get(&target, x, y, c), alpha * color[c], 1e-5);
                }
            }
            assert_float_equal(sum, fabs(area), method == EWA_TEXTURE_BILINEAR ? 1e-2 : 0.002 * fabs(area));
        }
    }
}

/// Where a texture is minified, its mean stays.
TEST(test_energy) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_LINEAR, 1, 512, 384),
           target = raster_make(EWA_PIXEL_LINEAR, 1, 128, 96);
    check_random random = {3};
    double mean = 0;
    for (uint32_t y = 0; y < 384; y++)
        for (uint32_t x = 0; x < 512; x++) {
            raster_set(&source, x, y, 0, check_uniform(&random, 0, 1));
            mean += raster_get(&source, x, y, 0) / (512 * 384);
        }
    const ewa_mat3 map = texture_map_of((const double[9]){0.25, 0, 0, 0, 0.25, 0, 0, 0, 1});
    for (int method = 0; method < 3; method++) {
        const ewa_texture_options options = texture_options((ewa_texture_method)method);
        texture_draw(context, &source, &map, &options, &target);
        double sum = 0;
        for (uint32_t y = 0; y < 96; y++)
            for (uint32_t x = 0; x < 128; x++) sum += raster_get(&target, x, y, 0) / (128 * 96);
        assert_float_equal(sum, mean, 1e-3);
    }
}

/// 8-bit and float sources and targets say the same; straight and premultiplied alpha too.
TEST(test_formats) {
    const ewa_mat3 map = texture_map_of(maps[6].h);
    const ewa_texture_options options = texture_options(EWA_TEXTURE_HYBRID);
    for (uint32_t channels = 1; channels <= 4; channels++) {
        if (channels == 2) continue;
        raster bytes = raster_make(EWA_PIXEL_SRGB8, channels, 60, 50);
        raster floats = raster_make(EWA_PIXEL_LINEAR, channels, 60, 50);
        raster_paint(&bytes, 31);
        for (uint32_t y = 0; y < 50; y++)
            for (uint32_t x = 0; x < 60; x++) {
                const double alpha = channels == 4 ? raster_get(&bytes, x, y, 3) / 255 : 1;
                for (uint32_t c = 0; c < channels && c < 3; c++)
                    raster_set(&floats, x, y, c,
                               alpha *
                                   (double)ewa_linear_from_srgb((float)raster_get(&bytes, x, y, c) / 255));
                if (channels == 4) raster_set(&floats, x, y, 3, alpha);
            }
        raster of_bytes = raster_make(EWA_PIXEL_LINEAR, channels, 120, 80);
        OWNED(raster_free) raster of_floats = raster_make(EWA_PIXEL_LINEAR, channels, 120, 80);
        OWNED(raster_free) raster coded = raster_make(EWA_PIXEL_SRGB8, channels, 120, 80);
        texture_draw(context, &bytes, &map, &options, &of_bytes);
        texture_draw(context, &floats, &map, &options, &of_floats);
        texture_draw(context, &floats, &map, &options, &coded);
        assert_true(raster_difference(&of_bytes, &of_floats) < 1e-5);
        for (uint32_t y = 0; y < 80; y++) {
            for (uint32_t x = 0; x < 120; x++) {
                const double alpha = channels == 4 ? raster_get(&of_floats, x, y, 3) : 1;
                if (channels == 4) assert_float_equal(raster_get(&coded, x, y, 3), 255 * alpha, 0.51);
                for (uint32_t c = 0; c < channels && c < 3 && alpha > 0.003; c++) {
                    const float straight = (float)(raster_get(&of_floats, x, y, c) / alpha);
                    assert_float_equal(raster_get(&coded, x, y, c),
                                       255 * (double)ewa_srgb_from_linear(straight), 0.52);
                }
            }
        }
        raster_free(&bytes);
        raster_free(&floats);
        raster_free(&of_bytes);
    }
}

/// What lies behind the eye does not show: the picture above the horizon stays empty.
TEST(test_horizon) {
    OWNED(raster_free)
    raster source = raster_make(EWA_PIXEL_SRGB8, 3, 64, 64),
           target = raster_make(EWA_PIXEL_LINEAR, 4, 100, 100);
    raster_paint(&source, 2);
    // w = v - 20: texels above row 20 are behind; y = (40 v - 700) / (v - 20), horizon at y = 40.
    const ewa_mat3 map = texture_map_of((const double[9]){30, 50, -1960, 0, 40, -700, 0, 1, -20});
    for (int method = 0; method < 4; method++) {
        for (int repeat = 0; repeat < 2; repeat++) {
            ewa_texture_options options = texture_options((ewa_texture_method)method);
            options.repeat = repeat == 1;
            if (repeat && method == EWA_TEXTURE_SPLAT) continue;
            texture_draw(context, &source, &map, &options, &target);
            for (uint32_t y = 0; y < 100; y++) {
                for (uint32_t x = 0; x < 100; x++) {
                    const double alpha = raster_get(&target, x, y, 3);
                    assert_true(isfinite(raster_get(&target, x, y, 0)));
                    if (y < 40) assert_true(alpha == 0);
                    if (repeat && y >= 40 && method != EWA_TEXTURE_POINT) assert_true(alpha == 1);
                }
            }
        }
    }
}

/// Repeating is the same as a texture of copies, for sides of any factors; where one draws levels and the
/// other does not, the noise of these textures differs by up to 1.5 %.
TEST(test_repeat) {
    static const uint32_t sides[][2] = {{32, 32}, {12, 20}, {7, 5}, {1, 1}, {13, 64}};
    for (size_t k = 0; k < 5; k++) {
        const uint32_t width = sides[k][0], height = sides[k][1], across = 1200 / width, down = 1200 / height;
        OWNED(raster_free) raster one = raster_make(EWA_PIXEL_SRGB8, 3, width, height);
        OWNED(raster_free) raster many = raster_make(EWA_PIXEL_SRGB8, 3, width * across, height * down);
        raster_paint(&one, 40 + k);
        for (uint32_t y = 0; y < height * down; y++)
            for (uint32_t x = 0; x < width * across; x++)
                for (uint32_t c = 0; c < 3; c++)
                    raster_set(&many, x, y, c, raster_get(&one, x % width, y % height, c));
        // The picture sees the middle of the copies only.
        const double x0 = width * (across / 2), y0 = height * (down / 2);
        static const double scales[] = {1.3, 0.4, 0.23};
        for (int s = 0; s < 3; s++) {
            const double a = scales[s];
            const ewa_mat3 of_one =
                texture_map_of((const double[9]){a, 0.1 * a, 5, -0.1 * a, a, 7, 0, 0.0005, 1});
            const ewa_mat3 back = {{{1, 0, 0}, {0, 1, 0}, {-x0, -y0, 1}}};
            const ewa_mat3 of_many = ewa_mat3_concatenate(&back, &of_one);
            for (int method = 0; method < 4; method += 3) {
                ewa_texture_options options = texture_options((ewa_texture_method)method);
                OWNED(raster_free) raster a_picture = raster_make(EWA_PIXEL_LINEAR, 3, 70, 70);
                OWNED(raster_free) raster b_picture = raster_make(EWA_PIXEL_LINEAR, 3, 70, 70);
                texture_draw(context, &many, &of_many, &options, &a_picture);
                options.repeat = true;
                texture_draw(context, &one, &of_one, &options, &b_picture);
                const double rms = raster_rms(&a_picture, &b_picture);
                if (!(rms < 1.5e-2))
                    fail_msg("%u x %u, scale %g, %s: rms %g", width, height, a, methods[method], rms);
            }
        }
    }
}

/// Where in the texture a place of the picture is from; false where that is behind the eye or near it.
static bool pull_back(const double h[9], double x, double y, double *u, double *v) {
    // u (h0 - x h6) + v (h1 - x h7) + h2 - x h8 = 0, and the same for y.
    const double a = h[0] - x * h[6], b = h[1] - x * h[7], c = h[2] - x * h[8];
    const double d = h[3] - y * h[6], e = h[4] - y * h[7], f = h[5] - y * h[8];
    *u = (b * f - c * e) / (a * e - b * d), *v = (c * d - a * f) / (a * e - b * d);
    return *u * h[6] + *v * h[7] + h[8] > 0.1;
}

/// Backward mapping is the sum of the texels around where a pixel's centre is from, each weighted by what the
/// distance leaves of a texel along u and along v.
TEST(test_bilinear) {
    enum { WIDTH = 150, HEIGHT = 110, U = 96, V = 80 };
    OWNED(raster_free) raster source = raster_make(EWA_PIXEL_LINEAR, 4, U, V);
    OWNED(raster_free) raster target = raster_make(EWA_PIXEL_LINEAR, 4, WIDTH, HEIGHT);
    raster_paint(&source, 11);
    for (int m = 0; m < 8; m++) {
        const ewa_mat3 map = texture_map_of(maps[m].h);
        const ewa_texture_options options = texture_options(EWA_TEXTURE_BILINEAR);
        texture_draw(context, &source, &map, &options, &target);
        int compared = 0;
        for (uint32_t at = 0; at < WIDTH * HEIGHT; at++) {
            const uint32_t x = at % WIDTH, y = at / WIDTH;
            double u = 0, v = 0;
            bool inside = true; // all of the pixel: at its ends the texture covers pixels in part
            for (int corner = 0; corner < 5; corner++) {
                const double dx = corner < 4 ? corner & 1 : 0.5, dy = corner < 4 ? corner >> 1 : 0.5;
                inside = inside && pull_back(maps[m].h, x + dx, y + dy, &u, &v) && u > 1 && v > 1 &&
                         u < U - 1 && v < V - 1;
            }
            if (!inside) continue;
            double sums[4] = {0};
            for (uint32_t j = (uint32_t)v - 1; j <= (uint32_t)v + 1; j++)
                for (uint32_t i = (uint32_t)u - 1; i <= (uint32_t)u + 1; i++)
                    for (uint32_t c = 0; c < 4; c++)
                        sums[c] += fmax(1 - fabs(u - i - 0.5), 0) * fmax(1 - fabs(v - j - 0.5), 0) *
                                   raster_get(&source, i, j, c);
            for (uint32_t c = 0; c < 4; c++)
                if (!(fabs(raster_get(&target, x, y, c) - sums[c]) < 2e-5))
                    fail_msg("%s, pixel %u %u: %g, not %g", maps[m].name, x, y, raster_get(&target, x, y, c),
                             sums[c]);
            compared++;
        }
        if (compared < 100) fail_msg("%s: %d pixels", maps[m].name, compared);
    }
}

/// Where neighbours along one axis part ever farther along the other, like the ribs of a fan, only texels
/// that are close along both axes are points: not more than by the definition, and not a few.
TEST(test_points_of_a_fan) {
    enum { RIBS = 128, LONG = 24 };
    const double wide = 0.5, high = 0.3, tilt = 0.02;
    for (int k = 0; k < 4; k++) {
        const bool turned = k & 1;
        const double shift = k & 2 ? 128 : 0; // whole tiles
        // (wide u, high v) / (1 + tilt v) from `shift` on, with u and v swapped in every other case.
        const double fan[9] = {wide, shift * tilt, shift, 0, high, 0, 0, tilt, 1};
        const double swapped[9] = {shift * tilt, wide, shift, high, 0, 0, tilt, 0, 1};
        const ewa_mat3 map = texture_map_of(turned ? swapped : fan);
        OWNED(raster_free) raster source = raster_make(EWA_PIXEL_LINEAR, 3, turned ? LONG : RIBS, turned ? RIBS : LONG);
        OWNED(raster_free) raster target = raster_make(EWA_PIXEL_LINEAR, 3, 200, 12);
        ewa_texture_options options = texture_options(EWA_TEXTURE_HYBRID);
        options.point_spacing_px = 0.55; // no texel is just as close
        uint64_t minified = 0;
        for (int n = 0; n < RIBS * LONG; n++) {
            const double u = n % RIBS + 0.5, v = n / RIBS + 0.5, w = 1 + tilt * v;
            // The places' derivatives by u and by v.
            const double along_u = wide / w;
            const double along_v = hypot(wide * u * tilt / (w * w), high / w - high * v * tilt / (w * w));
            minified += along_u <= options.point_spacing_px && along_v <= options.point_spacing_px;
        }
        assert_true(minified > RIBS * LONG / 2 && minified < RIBS * LONG);
        ewa_texture_stats stats;
        assert_int_equal(ewa_texture_map(context, &source.source, &map, &options, &target.target, &stats),
                         EWA_OK);
        print_message("fan %d: %llu of %d texels are close, %llu are points\n", k,
                      (unsigned long long)minified, RIBS * LONG, (unsigned long long)stats.point_texel_count);
        assert_true(stats.point_texel_count <= minified && stats.point_texel_count > minified / 4);
    }
}

/// The least textures and pictures.
TEST(test_tiny) {
    static const uint32_t sides[][2] = {{1, 1}, {1, 9}, {33, 1}, {2, 2}};
    for (size_t k = 0; k < 4; k++) {
        OWNED(raster_free) raster source = raster_make(EWA_PIXEL_SRGB8, 4, sides[k][0], sides[k][1]);
        OWNED(raster_free) raster target = raster_make(EWA_PIXEL_SRGB8, 4, sides[3 - k][0], sides[3 - k][1]);
        for (uint32_t y = 0; y < sides[k][1]; y++)
            for (uint32_t x = 0; x < sides[k][0]; x++)
                for (uint32_t c = 0; c < 4; c++) raster_set(&source, x, y, c, c == 3 ? 255 : 100);
        const double corners[4][2] = {
            {0, 0}, {sides[3 - k][0], 0}, {sides[3 - k][0], sides[3 - k][1]}, {0, sides[3 - k][1]}};
        ewa_mat3 map;
        assert_int_equal(ewa_texture_map_from_corners(context, sides[k][0], sides[k][1], corners, &map),
                         EWA_OK);
        for (int method = 0; method < 4; method++) {
            const ewa_texture_options options = texture_options((ewa_texture_method)method);
            texture_draw(context, &source, &map, &options, &target);
            for (uint32_t y = 0; y < sides[3 - k][1] && method != EWA_TEXTURE_POINT; y++)
                for (uint32_t x = 0; x < sides[3 - k][0]; x++)
                    for (uint32_t c = 0; c < 4; c++)
                        assert_int_equal(raster_get(&target, x, y, c), c == 3 ? 255 : 100);
        }
    }
}

int main(void) { return RUN_TESTS(enter, leave); }
