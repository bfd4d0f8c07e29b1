// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of Gaussians: held to the reference, the same bytes however they are made, and what is known of
// them.
#include "volume/gaussian_scene.h"

#include <math.h>

static const double FRONT[3] = {0.3, 0.2, -1}, ROUND[4] = {1, 0, 0, 0};

static ewa_gaussian_options options_of(ewa_gaussian_projection projection) {
    WITH_DEFAULTS(ewa_gaussian_options, options);
    options.projection = projection;
    return options;
}

static void check_order(const ewa_gaussians *set, const ewa_camera *camera, const ewa_gaussian_options *options,
                        const char *what) {
    ewa_image fast = gaussians_draw(set, camera, options, NULL);
    ewa_image slow = gaussians_draw_reference(set, camera, options);
    const double decibels = gaussians_decibels(&fast, &slow);
    const char *order = options->order == EWA_ORDER_RAY ? "rays" : "centres";
    print_message("%s, by %s: %.1f dB\n", what, order, decibels);
    if (!(decibels > 60)) fail_msg("%s, by %s: %.1f dB from the reference", what, order, decibels);
    double sum = 0;
    for (size_t i = 0; i < (size_t)slow.width_px * slow.height_px; i++) sum += (double)slow.pixels[4 * i + 3];
    assert_true(sum > 0.01 * slow.width_px * slow.height_px); // there is something
    ewa_image_free(&fast);
    ewa_image_free(&slow);
}

static void check_held(const ewa_gaussians *set, const ewa_camera *camera, const ewa_gaussian_options *options,
                       const char *what) {
    ewa_gaussian_options ordered = *options;
    for (int order = EWA_ORDER_CENTER; order <= EWA_ORDER_RAY; order++) {
        ordered.order = (ewa_gaussian_order)order;
        check_order(set, camera, &ordered, what);
    }
}

/// Both projections, both orders, all degrees, both filters, flat ones, orthographic, from within, under 130 degrees.
TEST_ON(test_reference, 2) {
    for (uint32_t degree = 0; degree <= EWA_MAX_SH_DEGREE; degree++)
        for (int exact = 0; exact < 2; exact++) {
            OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 1500, degree, 7 + degree);
            set.origin[0] = 1e4, set.antialiased = degree == 1;
            ewa_camera camera =
                gaussians_camera(150, 110, degree == 2 ? 130 : 40, FRONT, degree == 3 ? 0.5 : 3);
            for (int row = 0; row < 3; row++) // to where the set is
                camera.world_to_camera[4 * row + 3] -= 1e4 * camera.world_to_camera[4 * row];
            ewa_gaussian_options options = options_of(exact ? EWA_PROJECTION_EXACT : EWA_PROJECTION_TRAINED);
            options.background[0] = 0.5f, options.background[3] = 0.75f;
            if (degree == 4) {
                camera.projection = EWA_ORTHOGRAPHIC;
                camera.fx_px = camera.fy_px = 50;
                for (size_t i = 0; i < set.count; i++) set.scales[3 * i + 2] = 0;
            }
            if (degree == 3) camera.cx_px -= 40; // not in the middle
            char what[64];
            snprintf(what, sizeof what, "degree %u, %s", degree, exact ? "exact" : "trained");
            check_held(&set, &camera, &options, what);
        }
    OWNED(ewa_gaussians_free) ewa_gaussians flat = gaussians_random(context, 1500, 0, 3);
    for (size_t i = 0; i < flat.count; i++) flat.scales[3 * i + 2] = 0;
    const ewa_camera camera = gaussians_camera(150, 110, 60, FRONT, 2);
    for (int exact = 0; exact < 2; exact++) {
        ewa_gaussian_options options = options_of(exact ? EWA_PROJECTION_EXACT : EWA_PROJECTION_TRAINED);
        check_held(&flat, &camera, &options, exact ? "flat, exact" : "flat, trained");
        options.prefilter_px2 = 0;
        check_held(&flat, &camera, &options, "without a filter");
    }
    // 2D ones as 2DGS trains, from outside, from within, without perspective.
    flat.flat = true;
    for (int n = 0; n < 4; n++) {
        ewa_camera place = gaussians_camera(150, 110, n == 1 ? 110 : 60, FRONT, n == 1 ? 0.5 : 2);
        if (n == 2) {
            place.projection = EWA_ORTHOGRAPHIC;
            place.fx_px = place.fy_px = 50;
        }
        ewa_gaussian_options options = options_of(EWA_PROJECTION_TRAINED);
        if (n == 3) options.prefilter_px2 = 0;
        check_held(&flat, &place, &options, "2D");
    }
}

/// More faint ones behind each other than are sorted at once: over many octaves of depth, at one depth.
TEST_ON(test_dense, 2) {
    for (int many = 0; many < 2; many++)
        for (int flat = 0; flat < 2; flat++) {
            OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, many ? 3000 : 150, 0, 21);
            check_random random = {4};
            for (size_t i = 0; i < set.count; i++) {
                const double depth =
                    flat ? check_uniform(&random, -3, 3) : exp(check_uniform(&random, -3, 7));
                const bool tied = i % 3 == 0;
                const double at[3] = {0.1 * depth * check_uniform(&random, -1, 1),
                                      0.1 * depth * check_uniform(&random, -1, 1),
                                      tied ? 2 : depth}; // from the eye, at z = -1
                for (size_t k = 0; k < 3; k++) {
                    set.centers[3 * i + k] = (float)(flat && k < 2 ? at[k] / depth : at[k] - (k == 2));
                    set.scales[3 * i + k] = (float)(tied || flat ? 0.1 : 0.05 * depth);
                    if (tied) set.harmonics[3 * i + k] = 1;
                }
                set.opacities[i] = 0.01f;
            }
            ewa_camera camera = gaussians_camera(24, 20, 20, (const double[3]){0, 0, -1}, 1);
            if (flat) {
                camera.projection = EWA_ORTHOGRAPHIC;
                camera.fx_px = camera.fy_px = 80;
            }
            ewa_gaussian_options options = options_of(EWA_PROJECTION_EXACT);
            options.minimum_alpha = 1e-4, options.minimum_transmittance = 0;
            char what[64];
            snprintf(what, sizeof what, "%u, %s", set.count, flat ? "orthographic" : "perspective");
            check_held(&set, &camera, &options, what);
        }
}

/// Threads, instruction sets, order of the set: nothing changes a byte.
TEST(test_bytes) {
    static const uint32_t masks[3] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    const ewa_camera camera = gaussians_camera(203, 131, 70, FRONT, 1.2);
    for (int mode = 0; mode < 4; mode++) {
        ewa_image first = {0};
        for (int n = 0; n < 12; n++) {
            ewa_context *context = check_context_of(n % 4 < 2 ? 1 : 5, masks[n / 4]);
            ewa_gaussians set = gaussians_random(context, 4000, 3, 5);
            // Some are the same but for their colours: nothing but these tells which is in front.
            for (size_t i = 1; i < 300; i++) {
                memcpy(set.centers + 3 * i, set.centers, 3 * sizeof(float));
                memcpy(set.scales + 3 * i, set.scales, 3 * sizeof(float));
                memcpy(set.rotations + 4 * i, set.rotations, 4 * sizeof(float));
            }
            for (size_t i = 0; n % 2 && i < set.count / 2; i++) { // the other way round
                const size_t j = set.count - 1 - i;
                float *const streams[5] = {set.centers, set.scales, set.rotations, set.opacities,
                                           set.harmonics};
                static const size_t counts[5] = {3, 3, 4, 1, 48};
                for (int s = 0; s < 5; s++)
                    for (size_t k = 0; k < counts[s]; k++) {
                        const float swap = streams[s][counts[s] * i + k];
                        streams[s][counts[s] * i + k] = streams[s][counts[s] * j + k];
                        streams[s][counts[s] * j + k] = swap;
                    }
            }
            ewa_gaussian_options options = options_of((ewa_gaussian_projection)(mode / 2));
            options.order = mode % 2 ? EWA_ORDER_RAY : EWA_ORDER_CENTER;
            ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
            if (n == 0) assert_int_equal(ewa_image_create(context, 203, 131, 4, &first), EWA_OK);
            const size_t bytes = 203 * 131 * 4 * sizeof(float);
            if (n == 0) memcpy(first.pixels, image.pixels, bytes);
            assert_memory_equal(first.pixels, image.pixels, bytes);
            ewa_image_free(&image);
            ewa_gaussians_free(&set);
            if (n > 0) ewa_context_destroy(&context);
        }
        ewa_context *context = first.context;
        ewa_image_free(&first);
        ewa_context_destroy(&context);
    }
}

/// Two sheets that cross where the middle column looks, red nearer on the left, blue on the right, red's centre 0.01
/// nearer, or blue's: in each pixel by its ray, or red before blue, or blue before red, in all of them. The defaults are
/// the order of centres of the trained projection and that of rays of the exact one.
TEST_ON(test_crossing, 1) {
    static const double half_deg = 20 * 3.141592653589793 / 180;
    static const ewa_gaussian_order orders[3] = {EWA_ORDER_OF_PROJECTION, EWA_ORDER_CENTER, EWA_ORDER_RAY};
    const ewa_camera camera = gaussians_camera(65, 33, 30, (const double[3]){0, 0, -1}, 5);
    for (int n = 0; n < 12; n++) {
        const bool red_first = n % 2;
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, 2, 0, &set), EWA_OK);
        for (size_t i = 0; i < 2; i++) {
            // Turned about y by 40 degrees either way; x is to the right of this camera or to the left.
            const double side = (i == 0 ? 1 : -1) * (camera.world_to_camera[0] > 0 ? 1 : -1);
            set.centers[3 * i + 2] = (i == 0) == red_first ? -0.01f : 0;
            set.rotations[4 * i] = (float)cos(half_deg), set.rotations[4 * i + 2] = (float)(-side * sin(half_deg));
            for (size_t k = 0; k < 3; k++) {
                set.scales[3 * i + k] = k == 2 ? 1e-2f : 100;
                set.harmonics[3 * i + k] = (float)((k == 2 * i ? 0.5 : -0.5) / 0.28209479177387814);
            }
            set.opacities[i] = 0.75f;
        }
        ewa_gaussian_options options = options_of((ewa_gaussian_projection)(n / 6));
        options.order = orders[n % 6 / 2];
        const bool by_ray = options.order == EWA_ORDER_RAY || (n / 6 == 1 && options.order == EWA_ORDER_OF_PROJECTION);
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
        for (size_t x = 5; x < 65; x += 54) {
            const float *pixel = image.pixels + 4 * (16 * 65 + x);
            const bool red = by_ray ? x < 32 : red_first;
            const double alpha = 1 - 0.25 * 0.25, front = 0.75 / alpha, back = 0.25 * 0.75 / alpha;
            const double linear[2] = {pow((front + 0.055) / 1.055, 2.4), pow((back + 0.055) / 1.055, 2.4)};
            assert_true(fabs((double)pixel[3] - alpha) < 2e-3);
            if (fabs((double)(pixel[red ? 0 : 2] / pixel[3]) - linear[0]) > 2e-3 ||
                fabs((double)(pixel[red ? 2 : 0] / pixel[3]) - linear[1]) > 2e-3)
                fail_msg("%d, column %zu: %g %g", n, x, (double)pixel[0], (double)pixel[2]);
        }
    }
}

/// A sheet that goes through another one, whose deviations in depth are 0.1: by rays the share of the farther one that is in
/// front is 1/2 (1 - distance / 0.2), but no longer when a third one is nearer to it, and nothing changes at once.
TEST_ON(test_passing, 1) {
    static const double scales[3] = {80, 80, 0.1};
    const ewa_camera camera = gaussians_camera(16, 16, 5, (const double[3]){0, 0, -1}, 5);
    double before = 0;
    for (int n = 0; n < 200; n++) {
        const bool third = n >= 100;
        const double at = (n % 100 - 50) * 0.008; // of blue, behind red, which is at 0; the third one at 0.1 is black
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, third ? 3 : 2, 0, &set), EWA_OK);
        for (size_t i = 0; i < set.count; i++) {
            set.centers[3 * i + 2] = i == 0 ? 0 : i == 1 ? (float)at : 0.1f;
            set.rotations[4 * i] = 1;
            for (size_t k = 0; k < 3; k++) {
                set.scales[3 * i + k] = (float)scales[k];
                set.harmonics[3 * i + k] = (float)((k == 2 * i ? 0.5 : -0.5) / 0.28209479177387814);
            }
            set.opacities[i] = 0.6f;
        }
        ewa_gaussian_options options = options_of((ewa_gaussian_projection)(n % 2));
        options.order = EWA_ORDER_RAY;
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
        OWNED(ewa_image_free) ewa_image slow = gaussians_draw_reference(&set, &camera, &options);
        assert_true(gaussians_decibels(&image, &slow) > 90);
        const float *pixel = image.pixels + 4 * (8 * 16 + 8);
        const double alpha = (double)pixel[3];
        double red = (double)pixel[0] / alpha;
        red = (red <= 0.0031308 ? 12.92 * red : 1.055 * pow(red, 1 / 2.4) - 0.055) * alpha;
        const double share = 0.5 * fmax(1 - fabs(at) / 0.2, 0), in_front = at >= 0 ? share : 1 - share;
        if (!third && fabs(red - 0.6 * (1 - 0.6 * in_front)) > 1e-3)
            fail_msg("%g apart: %g, not %g", at, red, 0.6 * (1 - 0.6 * in_front));
        if (n % 100 && fabs(red - before) > 0.05) fail_msg("%g apart, %d: from %g to %g", at, n, before, red);
        before = red;
    }
}

/// Trained 2D Gaussians of which the numbers are known: one that leans by 60 degrees, where its ray crosses it, and one far
/// smaller than a pixel, a dot of variance 1/2 px^2.
TEST_ON(test_flat, 1) {
    static const double white[3] = {1, 1, 1}, sizes[2] = {1, 1e-4}, turn = 30 * 3.141592653589793 / 180;
    const double lean[4] = {cos(turn), 0, sin(turn), 0}; // about y, by twice that
    const ewa_camera camera = gaussians_camera(65, 65, 40, (const double[3]){0, 0, -1}, 4);
    for (int n = 0; n < 2; n++) {
        OWNED(ewa_gaussians_free)
        ewa_gaussians set = gaussians_one(context, (const double[3]){0, 0, 0}, (const double[3]){sizes[n], sizes[n], 0},
                                          lean, 0.8, white);
        set.flat = true;
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, NULL, NULL);
        for (int i = 0; i < 65; i++)
            for (int k = -1; k < 2; k++) {
                const double x = (i - 32) / camera.fx_px, y = k / camera.fy_px; // of the ray, at a depth of 1
                const double side = camera.world_to_camera[0] > 0 ? 1 : -1;
                // The plane turned about y by 60 degrees: depth 4 + tan 60 times what is to the side, with a sign.
                const double t = 4 / (1 + side * x * tan(2 * turn)), across = t * x / cos(2 * turn), down = t * y;
                const double crossed2 = t > 0.2 ? (across * across + down * down) / (sizes[n] * sizes[n]) : 1e30;
                const double dot2 = 2 * ((i - 32) * (i - 32) + k * k);
                double alpha = 0.8 * exp(-fmin(crossed2, dot2) / 2);
                if (alpha < 1.0 / 255) alpha = 0;
                const double drawn = (double)image.pixels[4 * ((size_t)(32 + k) * 65 + (size_t)i) + 3];
                if (fabs(drawn - alpha) > 2e-4) fail_msg("%d, column %d, row %d: %g instead of %g", n, i, k, drawn, alpha);
            }
    }
}

/// A colour that all have is that of the picture, whatever is behind what.
TEST_ON(test_constant, 1) {
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 3000, 0, 11);
    for (size_t i = 0; i < set.count; i++)
        for (size_t k = 0; k < 3; k++)
            set.harmonics[3 * i + k] = (float)((0.2 + 0.3 * (double)k - 0.5) / 0.28209479177387814);
    const ewa_camera camera = gaussians_camera(120, 90, 50, FRONT, 1.5);
    ewa_gaussian_options options = options_of(EWA_PROJECTION_TRAINED);
    OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
    for (size_t i = 0; i < 120 * 90; i++) {
        const double alpha = (double)image.pixels[4 * i + 3];
        assert_true(alpha >= 0 && alpha <= 1.000001);
        for (size_t k = 0; k < 3 && alpha > 0.01; k++) {
            const double display = 0.2 + 0.3 * (double)k;
            const double linear = display <= 0.04045 ? display / 12.92 : pow((display + 0.055) / 1.055, 2.4);
            if (fabs((double)image.pixels[4 * i + k] / alpha - linear) > 2e-5)
                fail_msg("%g instead of %g", (double)image.pixels[4 * i + k] / alpha, linear);
        }
    }
}

/// None, those without opacity, numbers that are none: the background.
TEST_ON(test_nothing, 1) {
    const ewa_camera camera = gaussians_camera(40, 30, 50, FRONT, 2);
    ewa_gaussian_options options = options_of(EWA_PROJECTION_EXACT);
    options.background[1] = options.background[3] = 1;
    for (uint32_t count = 0; count < 3; count++) {
        OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 10 * count, 1, 2);
        for (size_t i = 0; i < set.count; i++) {
            if (count == 1) set.opacities[i] = 0;
            if (count == 2) set.scales[3 * i] = i % 2 ? NAN : INFINITY;
        }
        ewa_gaussian_stats stats;
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, &stats);
        assert_int_equal(stats.splat_count, 0);
        for (size_t i = 0; i < 40 * 30; i++) {
            assert_true(image.pixels[4 * i] == 0 && image.pixels[4 * i + 3] == 1);
            assert_true(fabsf(image.pixels[4 * i + 1] - 1) < 1e-6f);
        }
    }
}

/// One that covers the picture: alpha is its opacity, to 0.99; depth is where half of the light is gone.
TEST_ON(test_one, 1) {
    static const double center[3] = {0, 0, 0}, scales[3] = {50, 50, 0.1}, color[3] = {1, 0.25, 0.5};
    static const double front[3] = {0, 0, -1};
    const ewa_camera camera = gaussians_camera(64, 48, 30, front, 5);
    for (int n = 0; n < 6; n++) {
        const double opacity = n % 3 == 0 ? 0.3 : n % 3 == 1 ? 0.8 : 1;
        OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_one(context, center, scales, ROUND, opacity, color);
        const ewa_gaussian_options options = options_of((ewa_gaussian_projection)(n / 3));
        OWNED(ewa_splats_destroy) ewa_splats *splats;
        OWNED(ewa_gaussian_renderer_destroy) ewa_gaussian_renderer *renderer;
        assert_int_equal(ewa_splats_create(&set, false, &splats), EWA_OK);
        assert_int_equal(ewa_gaussian_renderer_create(context, &renderer), EWA_OK);
        static float coverage[64 * 48], depth[64 * 48];
        const ewa_frame frame = {.coverage = coverage, .depth = depth};
        assert_int_equal(ewa_gaussian_render(renderer, splats, &camera, &options, &frame, NULL), EWA_OK);
        for (size_t i = 0; i < 64 * 48; i++) {
            assert_true(fabs((double)coverage[i] - fmin(opacity, 0.99)) < 2e-3);
            assert_true(opacity < 0.5 ? isinf(depth[i]) : fabsf(depth[i] - 5) < 1e-3f);
        }
    }
}

/// A surface a standard deviation behind the middle of a Gaussian leaves 84.13 % of it, 1.665 behind it 95.20 %, one before it
/// nothing, one behind it all.
TEST_ON(test_surface, 1) {
    enum { PIXELS = 64 * 48 };
    static const double center[3] = {0, 0, 0}, scales[3] = {20, 20, 0.5}, color[3] = {1, 0, 0};
    static const double front[3] = {0, 0, -1};
    enum { CASES = 4 };
    static const double depths[CASES] = {5.5, 5.8325, 2, 8}, wanted[CASES] = {0.8 * 0.841345, 0.8 * 0.952043, 0, 0.8};
    static float depth[PIXELS], rgba[4 * PIXELS];
    const ewa_camera camera = gaussians_camera(64, 48, 10, front, 5);
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_one(context, center, scales, ROUND, 0.8, color);
    for (int n = 0; n < 2 * CASES; n++) {
        for (size_t i = 0; i < PIXELS; i++) {
            depth[i] = (float)depths[n % CASES];
            rgba[4 * i + 2] = rgba[4 * i + 3] = 1; // blue
        }
        ewa_gaussian_options options = options_of((ewa_gaussian_projection)(n / CASES));
        options.surface_depth = depth, options.surface_rgba = rgba;
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
        const double red = wanted[n % CASES];
        const size_t middle = 4 * (24 * 64 + 32);
        const double linear[2] = {red <= 0.04045 ? red / 12.92 : pow((red + 0.055) / 1.055, 2.4),
                                  pow((1 - red + 0.055) / 1.055, 2.4)};
        assert_true(fabs((double)image.pixels[middle] - linear[0]) < 2e-4);
        assert_true(fabs((double)image.pixels[middle + 2] - linear[1]) < 2e-4);
        OWNED(ewa_image_free) ewa_image slow = gaussians_draw_reference(&set, &camera, &options);
        assert_true(gaussians_decibels(&image, &slow) > 70);
    }
}

/// Section planes cut along every ray; also with edges of surfaces, whose share of a pixel is what the reference has.
TEST_ON(test_sections, 2) {
    enum { PIXELS = 150 * 110 };
    static float depth[PIXELS], rgba[4 * PIXELS];
    static const double planes[3][4] = {{0, 2, 0, 0.4}, {-3, 0, 1, 1}, {0.1, 0.2, 1, 0.1}};
    ewa_gaussians set = gaussians_random(context, 1500, 0, 7);
    set.origin[1] = 100;
    for (int n = 0; n < 8; n++) {
        ewa_camera camera = gaussians_camera(150, 110, n % 4 == 3 ? 110 : 40, FRONT, n % 4 == 3 ? 0.5 : 3);
        for (int row = 0; row < 3; row++) // to where the set is, in a space twice as large
            camera.world_to_camera[4 * row + 3] -= 100 * camera.world_to_camera[4 * row + 1];
        for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= 2;
        if (n % 4 == 2) {
            camera.projection = EWA_ORTHOGRAPHIC;
            camera.fx_px = camera.fy_px = 20;
        }
        ewa_gaussian_options options = options_of((ewa_gaussian_projection)(n % 2));
        OWNED(ewa_image_free) ewa_image whole = gaussians_draw(&set, &camera, &options, NULL);
        for (uint32_t i = 0; i < 3; i++) {
            memcpy(options.section_planes[i], planes[i], sizeof planes[i]);
            options.section_planes[i][3] -= 100 * planes[i][1];
        }
        options.section_count = 2 + (uint32_t)(n % 2);
        if (n >= 4) {
            for (size_t i = 0; i < PIXELS; i++) {
                const float cover = (float)(i % 7) / 6;
                depth[i] = i % 7 ? 6 : INFINITY;
                for (size_t k = 0; k < 4; k++) rgba[4 * i + k] = cover * (k == 1 ? 0.5f : 1);
            }
            options.surface_depth = depth, options.surface_rgba = rgba;
        }
        options.background[2] = options.background[3] = 1;
        OWNED(ewa_image_free) ewa_image cut = gaussians_draw(&set, &camera, &options, NULL);
        OWNED(ewa_image_free) ewa_image slow = gaussians_draw_reference(&set, &camera, &options);
        const double decibels = gaussians_decibels(&cut, &slow), changed = gaussians_decibels(&cut, &whole);
        print_message("sections, %d: %.1f dB, the whole: %.1f dB\n", n, decibels, changed);
        assert_true(decibels > 80 && changed < 30);
    }
    ewa_gaussians_free(&set);
    // A plane that every pixel lies on one side of: all, or nothing.
    const ewa_camera camera = gaussians_camera(64, 48, 30, (const double[3]){0, 0, -1}, 5);
    OWNED(ewa_gaussians_free)
    ewa_gaussians sheet = gaussians_one(context, (const double[3]){0, 0, 0}, (const double[3]){50, 50, 0.01},
                                        ROUND, 0.8, (const double[3]){1, 1, 1});
    for (int n = 0; n < 3; n++) {
        ewa_gaussian_options options = options_of(EWA_PROJECTION_TRAINED);
        options.section_count = 1;
        options.section_planes[0][n == 0 ? 0 : 2] = n == 2 ? -1 : 1;
        if (n) options.section_planes[0][3] = n == 1 ? -1 : 1;
        OWNED(ewa_image_free) ewa_image cut = gaussians_draw(&sheet, &camera, &options, NULL);
        const float left = cut.pixels[4 * (24 * 64 + 10) + 3], right = cut.pixels[4 * (24 * 64 + 50) + 3];
        if (n == 0) assert_true(fminf(left, right) == 0 && fabsf(fmaxf(left, right) - 0.8f) < 1e-2f);
        if (n == 1) assert_true(left == 0 && right == 0);
        if (n == 2) assert_true(fabsf(left - 0.8f) < 1e-2f && fabsf(right - 0.8f) < 1e-2f);
    }
    ewa_gaussian_options wrong = options_of(EWA_PROJECTION_TRAINED);
    wrong.section_count = 1;
    OWNED(ewa_image_free) ewa_image none;
    assert_int_equal(ewa_image_create(context, 64, 48, 4, &none), EWA_OK);
    const ewa_frame frame = {.rgba = none.pixels};
    assert_int_equal(ewa_gaussian_render_reference(&sheet, &camera, &wrong, &frame),
                     EWA_ERROR_ARGUMENT);
}

/// Harmonics are orthonormal: means over directions of products of two, from the colours that they give.
TEST_ON(test_harmonics, 1) {
    enum { COUNT = 25, AROUND = 24, DOWN = 12 };
    // Gauss-Legendre places and weights for polynomials up to degree 23.
    static const double places[6] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                     0.7699026741943047, 0.9041172563704749, 0.9815606342467192};
    static const double weights[6] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                      0.1600783285433462, 0.1069393259953184, 0.0471753363865118};
    static double values[AROUND * DOWN][COUNT];
    static const double center[3] = {0}, scales[3] = {0.1, 0.1, 0.1}, grey[3] = {0.5, 0.5, 0.5};
    for (size_t k = 0; k < COUNT; k += 3) {
        OWNED(ewa_gaussians_free) ewa_gaussians one = gaussians_one(context, center, scales, ROUND, 0.99, grey), set;
        assert_int_equal(ewa_gaussians_create(context, 1, 4, &set), EWA_OK);
        memcpy(set.scales, one.scales, 3 * sizeof(float));
        memcpy(set.rotations, one.rotations, 4 * sizeof(float));
        set.opacities[0] = 0.99f;
        for (size_t c = 0; c < 3 && k + c < COUNT; c++) set.harmonics[3 * (k + c) + c] = 0.25f;
        OWNED(ewa_splats_destroy) ewa_splats *splats;
        OWNED(ewa_gaussian_renderer_destroy) ewa_gaussian_renderer *renderer;
        assert_int_equal(ewa_splats_create(&set, false, &splats), EWA_OK);
        assert_int_equal(ewa_gaussian_renderer_create(context, &renderer), EWA_OK);
        for (size_t n = 0; n < AROUND * DOWN; n++) {
            const double z = n % DOWN < 6 ? places[n % DOWN] : -places[n % DOWN - 6];
            const double angle = 6.283185307179586 * (double)(n / DOWN) / AROUND;
            // Seen from -d, along d.
            const double from[3] = {-sqrt(1 - z * z) * cos(angle), -sqrt(1 - z * z) * sin(angle), -z};
            const ewa_camera camera = gaussians_camera(5, 5, 1, from, 3);
            float rgba[100];
            const ewa_frame frame = {.rgba = rgba};
            assert_int_equal(ewa_gaussian_render(renderer, splats, &camera, NULL, &frame, NULL), EWA_OK);
            for (size_t c = 0; c < 3 && k + c < COUNT; c++) {
                const double linear = (double)(rgba[4 * 12 + c] / rgba[4 * 12 + 3]);
                values[n][k + c] = (1.055 * pow(linear, 1 / 2.4) - 0.055 - 0.5) / 0.25;
            }
        }
    }
    for (size_t i = 0; i < COUNT; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = 0;
            for (size_t n = 0; n < AROUND * DOWN; n++)
                sum += values[n][i] * values[n][j] * weights[n % DOWN % 6] * 6.283185307179586 / AROUND;
            if (fabs(sum - (i == j)) > 1e-3) fail_msg("harmonics %zu and %zu: %g", i, j, sum);
        }
}

/// Whichever allocation fails, the calls say so and leave nothing behind.
TEST(test_memory) {
    const ewa_camera camera = gaussians_camera(40, 30, 50, FRONT, 2);
    for (long n = 0;; n++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(1, &memory);
        ewa_gaussians set = gaussians_random(context, 50, 1, 4);
        memory.calls_left = n;
        ewa_splats *splats = NULL;
        ewa_gaussian_renderer *renderer = NULL;
        static float rgba[40 * 30 * 4];
        const ewa_frame frame = {.rgba = rgba};
        ewa_status status = ewa_splats_create(&set, false, &splats);
        if (status == EWA_OK) status = ewa_gaussian_renderer_create(context, &renderer);
        if (status == EWA_OK) status = ewa_gaussian_render(renderer, splats, &camera, NULL, &frame, NULL);
        if (status == EWA_OK)
            status = ewa_gaussian_render_reference(&set, &camera, NULL, &frame);
        const bool failed = memory.calls_left < 0;
        assert_int_equal(status, failed ? EWA_ERROR_MEMORY : EWA_OK);
        ewa_gaussian_renderer_destroy(&renderer);
        ewa_splats_destroy(&splats);
        ewa_gaussians_free(&set);
        ewa_context_destroy(&context);
        assert_int_equal(memory.held_bytes, 0);
        if (!failed) break;
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
