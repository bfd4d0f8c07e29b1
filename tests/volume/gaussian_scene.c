// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sets of Gaussians for tests, and pictures of them.
#include "volume/gaussian_scene.h"
#include "image/srgb.h"
#include "volume/scene.h"

#include <math.h>

ewa_gaussians gaussians_random(ewa_context *context, uint32_t count, uint32_t sh_degree, uint64_t seed) {
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, count, sh_degree, &set), EWA_OK);
    const uint32_t harmonics = 3 * (sh_degree + 1) * (sh_degree + 1);
    check_random random = {seed};
    for (size_t i = 0; i < count; i++) {
        double length;
        do {
            length = 0;
            for (int k = 0; k < 3; k++) {
                set.centers[3 * i + (size_t)k] = (float)(check_uniform(&random, -1, 1));
                length += (double)set.centers[3 * i + (size_t)k] * (double)set.centers[3 * i + (size_t)k];
            }
        } while (length > 1);
        const double size = 0.01 * exp(2.5 * check_uniform(&random, 0, 1));
        for (size_t k = 0; k < 3; k++)
            set.scales[3 * i + k] = (float)(size * exp(-5 * check_uniform(&random, 0, 1) * (k == 2)));
        double q[4], square = 0;
        for (int k = 0; k < 4; k++) q[k] = check_uniform(&random, -1, 1), square += q[k] * q[k];
        for (size_t k = 0; k < 4; k++) set.rotations[4 * i + k] = (float)(q[k] / sqrt(square));
        set.opacities[i] = (float)check_uniform(&random, 0, 1);
        for (size_t k = 0; k < harmonics; k++)
            set.harmonics[harmonics * i + k] = (float)((check_uniform(&random, -1, 1)) * (k < 3 ? 1.5 : 0.3));
    }
    return set;
}

ewa_gaussians gaussians_one(ewa_context *context, const double center[3], const double scales[3],
                            const double rotation[4], double opacity, const double color[3]) {
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, 1, 0, &set), EWA_OK);
    for (int k = 0; k < 3; k++) {
        set.centers[k] = (float)center[k], set.scales[k] = (float)scales[k];
        set.harmonics[k] = (float)((color[k] - 0.5) / 0.28209479177387814);
    }
    for (int k = 0; k < 4; k++) set.rotations[k] = (float)rotation[k];
    set.opacities[0] = (float)opacity;
    return set;
}

ewa_camera gaussians_camera(uint32_t width_px, uint32_t height_px, double fov_deg, const double direction[3],
                            double distance) {
    ewa_camera camera = scene_camera(width_px, height_px, direction, distance);
    assert_int_equal(ewa_camera_set_fov(&camera, fov_deg), EWA_OK);
    return camera;
}

ewa_image gaussians_draw(const ewa_gaussians *set, const ewa_camera *camera,
                         const ewa_gaussian_options *options, ewa_gaussian_stats *stats) {
    ewa_image image;
    ewa_splats *splats;
    ewa_gaussian_renderer *renderer;
    assert_int_equal(ewa_image_create(set->context, camera->width_px, camera->height_px, 4, &image), EWA_OK);
    assert_int_equal(ewa_splats_create(set, true, &splats), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(set->context, &renderer), EWA_OK);
    const ewa_frame frame = {.rgba = image.pixels};
    assert_int_equal(ewa_gaussian_render(renderer, splats, camera, options, &frame, stats), EWA_OK);
    ewa_gaussian_renderer_destroy(&renderer);
    ewa_splats_destroy(&splats);
    return image;
}

ewa_image gaussians_draw_reference(const ewa_gaussians *set, const ewa_camera *camera,
                                   const ewa_gaussian_options *options) {
    ewa_image image;
    assert_int_equal(ewa_image_create(set->context, camera->width_px, camera->height_px, 4, &image), EWA_OK);
    const ewa_frame frame = {.rgba = image.pixels};
    assert_int_equal(ewa_gaussian_render_reference(set, camera, options, &frame), EWA_OK);
    return image;
}

double gaussians_decibels(const ewa_image *a, const ewa_image *b) {
    double sum = 0;
    const size_t pixels = (size_t)a->width_px * a->height_px;
    for (size_t i = 0; i < 4 * pixels; i++) {
        double values[2] = {(double)a->pixels[i], (double)b->pixels[i]};
        for (int k = 0; k < 2 && i % 4 < 3; k++) values[k] = ewa_srgb_encode(fmin(fmax(values[k], 0), 1));
        sum += (values[0] - values[1]) * (values[0] - values[1]);
    }
    return -10 * log10(sum / (4 * (double)pixels) + 1e-30);
}
