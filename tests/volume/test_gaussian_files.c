// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Trained Gaussians of the data set against the reference.
#include "volume/gaussian_scene.h"

#include <math.h>

TEST(test_scenes) {
    static const char *const files[] = {"gaussians/guitar_3dgs.ply", "gaussians/pc_short_100_sh3.ply",
                                        "gaussians/train_3_points.ply",
                                        "gaussians/guitar_40k_2dgs_derived.ply"};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        char path[1024];
        if (!check_data(files[f], path, sizeof path)) continue;
        OWNED(ewa_context_destroy) ewa_context *context = check_context(0, NULL);
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_load(context, path, &set, NULL), EWA_OK);
        ewa_splats *splats;
        ewa_splats_info info;
        assert_int_equal(ewa_splats_create(&set, false, &splats), EWA_OK);
        ewa_splats_describe(splats, &info);
        if (info.splat_count > 1000) assert_true(info.resident_bytes < 200 * (size_t)info.splat_count);
        ewa_splats_destroy(&splats);
        ewa_camera camera = check_camera(300, 300);
        assert_int_equal(ewa_camera_set_fov(&camera, 40), EWA_OK);
        assert_int_equal(ewa_camera_frame(&camera, &info.core, (const double[3]){1, 0.2, 0.3},
                                          (const double[3]){0, -1, 0}, 0.05),
                         EWA_OK);
        for (int n = 0; n < 4; n++) {
            WITH_DEFAULTS(ewa_gaussian_options, options);
            options.projection = (ewa_gaussian_projection)(n / 2);
            options.order = n % 2 ? EWA_ORDER_RAY : EWA_ORDER_CENTER;
            options.near_world = 0; // the three points' scene is small
            OWNED(ewa_image_free) ewa_image fast = gaussians_draw(&set, &camera, &options, NULL);
            OWNED(ewa_image_free) ewa_image slow = gaussians_draw_reference(&set, &camera, &options);
            const double decibels = gaussians_decibels(&fast, &slow);
            print_message("%s, %s by %s: %.1f dB\n", files[f], n / 2 ? "exact" : "trained",
                          n % 2 ? "rays" : "centres", decibels);
            assert_true(decibels > 60);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
