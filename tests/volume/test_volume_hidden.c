// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Voxels behind saturated pixels are left out, and no others.
#include "check.h"
#include "volume/scene.h"

enum { SIDE = 150, PIXELS = SIDE * SIDE };

static const double UNIT[3] = {1, 1, 1};

/// A picture over nothing, and what was drawn for it.
static ewa_image draw(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                      const ewa_volume_options *options, ewa_volume_stats *stats) {
    ewa_image image;
    ewa_volume_renderer *renderer;
    assert_int_equal(ewa_image_create(context, camera->width_px, camera->height_px, 4, &image), EWA_OK);
    assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
    const ewa_frame frame = {.rgba = image.pixels};
    assert_int_equal(ewa_volume_render(renderer, voxels, camera, options, &frame, stats), EWA_OK);
    ewa_volume_renderer_destroy(&renderer);
    return image;
}

/// Opaque where x is below 4, thin beyond.
static double half_wall(const void *data, double x, double y, double z) {
    (void)data, (void)y, (void)z;
    return x < 4 ? 2 : 0.02;
}

/// A pixel that is open in the end was open all the time: to the byte, it is what it is where nothing is ever
/// left out. Draws both pictures and gives the share of pixels that are not open.
static double compare_open(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                           ewa_volume_options *options, ewa_volume_stats stats[2]) {
    const double minimum = options->minimum_transmittance;
    ewa_image some = draw(context, voxels, camera, options, &stats[0]);
    options->minimum_transmittance = 0;
    ewa_image all = draw(context, voxels, camera, options, &stats[1]);
    options->minimum_transmittance = minimum;
    int closed = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (1 - (double)some.pixels[4 * i + 3] > minimum + 1e-6)
            assert_memory_equal(&some.pixels[4 * i], &all.pixels[4 * i], 16);
        else
            closed++;
    }
    ewa_image_free(&some);
    ewa_image_free(&all);
    return (double)closed / PIXELS;
}

/// Points, splats and both, behind a wall that ends within a block, from several sides.
TEST(test_open_pixels) {
    static const uint32_t dims[3] = {48, 40, 56};
    static const double directions[][3] = {{0, 0, -1}, {0.3, 0.2, -1}, {-1, 0.4, 0.1}, {0.2, 1, 0.5}};
    for (uint32_t threads = 1; threads < 3; threads++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
        OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, half_wall, NULL);
        const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.4f);
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        for (int n = 0; n < 16; n++) {
            const double distance = (n / 4 % 2 ? 100 : 170);
            ewa_camera camera = scene_camera(SIDE, SIDE, directions[n % 4], distance);
            if (n >= 8) { // one to a pixel and a half: points, then splats
                camera.projection = EWA_ORTHOGRAPHIC;
                camera.fx_px = camera.fy_px = n < 12 ? 1 : 1.5;
            }
            WITH_DEFAULTS(ewa_volume_options, options);
            options.shading = EWA_SHADING_PHONG;
            options.minimum_transmittance = 0.3;
            ewa_volume_stats stats[2];
            const double closed = compare_open(context, voxels, &camera, &options, stats);
            assert_true(closed > 0.02 && closed < 0.98);
            assert_true(stats[0].hidden_count > 0);
            assert_true(stats[0].point_count + stats[0].splat_count <
                        stats[1].point_count + stats[1].splat_count);
        }
    }
}

/// Within blocks of which a part can be seen, voxels that cannot are left out: three quarters of a box are
/// opaque in its front half, which ends within blocks, and no block is covered whole.
TEST_ON(test_part_of_block, 1) {
    enum { BOX = 16, COVERED = 12, VOXELS = BOX * BOX * BOX };
    static const uint32_t dims[3] = {BOX, BOX, BOX};
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    for (int i = 0; i < VOXELS; i++)
        ((float *)volume.voxels)[i] = i % BOX < COVERED && i < VOXELS / 2 ? 2 : 0.001f;
    const ewa_transfer transfer = scene_linear(1, 1, 1, 50);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int splats = 0; splats < 2; splats++) {
        ewa_camera camera;
        ewa_camera_init(&camera);
        camera.projection = EWA_ORTHOGRAPHIC;
        camera.width_px = camera.height_px = SIDE;
        camera.world_to_camera[11] = 100;
        camera.fx_px = camera.fy_px = splats ? 3 : 1;
        camera.cx_px = camera.cy_px = splats ? 32 : 20; // whole cells are covered; within one tile
        WITH_DEFAULTS(ewa_volume_options, options);
        options.method = splats ? EWA_VOLUME_SPLATS : EWA_VOLUME_POINTS;
        ewa_volume_stats stats;
        OWNED(ewa_image_free) ewa_image image = draw(context, voxels, &camera, &options, &stats);
        assert_true(stats.hidden_count > VOXELS / 8 && stats.hidden_count <= VOXELS / BOX * COVERED);
        assert_int_equal(stats.hidden_count + stats.splat_count + stats.point_count, VOXELS);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
