// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of volumes against its reference, closed forms, and itself.
#include "check.h"
#include "image_difference.h"
#include "volume/scene.h"

#include <math.h>
#include <string.h>

static const double UNIT[3] = {1, 1, 1};

static ewa_volume_options defaults(void) {
    WITH_DEFAULTS(ewa_volume_options, options);
    return options;
}

static double largest_difference(const ewa_image *a, const ewa_image *b) {
    const image_difference difference = image_compare(a, b, 0);
    return difference.maximum;
}

static double psnr_db(const ewa_image *a, const ewa_image *b) {
    const image_difference difference = image_compare(a, b, 0);
    return difference.psnr_db;
}

/// A picture of everything, near enough for splats, held to the reference.
static double error_of(const double spacing[3], double distance, ewa_volume_options options, bool ortho) {
    static const uint32_t dims[3] = {23, 18, 21};
    static const double direction[3] = {0.7, 0.4, -1};
    const double half = 8;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, spacing, scene_vessels, &half);
    const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.7f);
    ewa_camera camera = scene_camera(93, 71, direction, distance);
    if (ortho) assert_int_equal(ewa_camera_set_ortho(&camera, distance * 0.7), EWA_OK);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    options.minimum_transmittance = 0;
    OWNED(ewa_image_free) ewa_image fast = scene_draw(context, voxels, &camera, &options);
    OWNED(ewa_image_free) ewa_image slow = scene_draw_reference(&volume, &transfer, &camera, &options);
    const double error = largest_difference(&fast, &slow);
    double sum = 0;
    for (int i = 3; i < 4 * 93 * 71; i += 4) sum += (double)slow.pixels[i];
    assert_true(sum > 100); // there is something to compare
    return error;
}

TEST(test_splats_equal_reference) {
    static const double oblong[3] = {0.8, 1.3, 1};
    ewa_volume_options options = defaults();
    options.method = EWA_VOLUME_SPLATS;
    assert_true(error_of(UNIT, 40, options, false) < 1e-4);
    assert_true(error_of(UNIT, 25, options, false) < 1e-4);
    assert_true(error_of(UNIT, 40, options, true) < 1e-4);
    // The reference takes the length of oblong voxels along each pixel's ray, not the middle's.
    assert_true(error_of(oblong, 40, options, false) < 3e-3);
    options.index = EWA_INDEX_TABLE;
    assert_true(error_of(UNIT, 40, options, false) < 1e-3);
    options.shading = EWA_SHADING_PHONG;
    options.index = EWA_INDEX_EXACT;
    assert_true(error_of(UNIT, 40, options, false) < 2e-2); // gradients are resident in 30 bits
}

TEST(test_points_are_near_reference) {
    ewa_volume_options options = defaults();
    // 71 px for 40 degrees: voxels of 1 px at a distance of 97.
    assert_true(error_of(UNIT, 120, options, false) < 0.05);
    assert_true(error_of(UNIT, 120, options, true) < 0.05);
}

/// Through a slab of thickness t gets exp(-kappa t), from any direction in which it is thick enough.
TEST_ON(test_slab, 2) {
    static const uint32_t dims[3] = {64, 64, 12};
    static const double direction[3] = {0, 0, -1};
    const double kappa = 0.11, truth = 1 - exp(-kappa * 12);
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ones, NULL);
    const ewa_transfer transfer = scene_linear(1, 1, 1, (float)kappa);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    for (int method = EWA_VOLUME_HYBRID; method <= EWA_VOLUME_POINTS; method++)
        for (int sight = 0; sight < 3; sight++) {
            const double distance = sight == 0 ? 40 : sight == 1 ? 90 : 150; // 2.5, 1, 0.6 px
            if (method == EWA_VOLUME_POINTS && sight == 0) continue;         // holes
            ewa_camera camera = scene_camera(64, 64, direction, distance);
            ewa_volume_options options = defaults();
            options.method = (ewa_volume_method)method;
            OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
            for (int y = 28; y < 36; y++)
                for (int x = 28; x < 36; x++) {
                    const double alpha = (double)image.pixels[4 * (64 * y + x) + 3];
                    // Rays are slightly slanted, kernels have a ripple of 0.2 %.
                    if (fabs(alpha - truth) > 0.006)
                        print_message("%d %d: %g, not %g\n", method, sight, alpha, truth);
                    assert_true(fabs(alpha - truth) < 0.006);
                }
        }
}

/// The same bytes from any number of threads and any instruction set.
TEST(test_same_bytes) {
    static const uint32_t dims[3] = {60, 60, 60};
    static const double direction[3] = {0.7, 0.4, -1};
    const double half = 28;
    OWNED(check_free) uint8_t *first = NULL;
    const size_t bytes = 4 * 201 * 150 * sizeof(float);
    for (int variant = 0; variant < 4; variant++) {
        OWNED(ewa_context_destroy)
        ewa_context *context = check_context_of(variant == 1 ? 3 : 1, variant == 2   ? EWA_CPU_AVX2
                                                                      : variant == 3 ? 0
                                                                                     : EWA_CPU_ALL);
        OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_vessels, &half);
        const ewa_transfer transfer = scene_linear(0.9f, 0.5f, 0.2f, 0.9f);
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        uint8_t *all = malloc(4 * bytes);
        assert_non_null(all);
        for (int sight = 0; sight < 4; sight++) {
            ewa_camera camera = scene_camera(201, 150, direction, sight < 2 ? 80 : 200);
            ewa_volume_options options = defaults();
            options.index = sight == 1 ? EWA_INDEX_TABLE : EWA_INDEX_EXACT;
            options.shading = sight & 1 ? EWA_SHADING_PHONG : EWA_SHADING_NONE;
            OWNED(ewa_image_free) ewa_image image = scene_draw(context, voxels, &camera, &options);
            memcpy(all + (size_t)sight * bytes, image.pixels, bytes);
        }
        if (first)
            assert_memory_equal(first, all, 4 * bytes);
        else
            first = all;
        if (first != all) free(all);
    }
}

/// What is culled because it is hidden does not show.
TEST_ON(test_culling_changes_nothing, 2) {
    static const uint32_t dims[3] = {48, 48, 48};
    static const double direction[3] = {0.3, 0.2, -1};
    const double radius = 20;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ball, &radius);
    const ewa_transfer transfer = scene_linear(0.2f, 0.5f, 0.9f, 3);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer;
    assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
    for (int sight = 0; sight < 2; sight++) {
        const ewa_camera camera = scene_camera(150, 150, direction, sight ? 60 : 260);
        float *pixels[2];
        uint64_t hidden[2];
        for (int culled = 0; culled < 2; culled++) {
            ewa_volume_options options = defaults();
            if (!culled) options.minimum_transmittance = 0;
            pixels[culled] = malloc(4 * 150 * 150 * sizeof(float));
            const ewa_frame frame = {.rgba = pixels[culled]};
            ewa_volume_stats stats;
            assert_int_equal(ewa_volume_render(renderer, voxels, &camera, &options, &frame, &stats), EWA_OK);
            hidden[culled] = stats.hidden_count;
            assert_true(sight ? stats.point_count == 0 : stats.splat_count == 0);
        }
        assert_true(hidden[1] > hidden[0] + 1000);
        for (int i = 0; i < 4 * 150 * 150; i++) assert_true(fabsf(pixels[0][i] - pixels[1][i]) <= 1.0f / 511);
        free(pixels[0]);
        free(pixels[1]);
    }
}

/// Reports of progress, and the one that says stop (0: none).
typedef struct stopper {
    int reports, stop_at;
} stopper;

static bool on_progress(void *user, const char *stage, double fraction) {
    stopper *self = user;
    assert_true(fraction >= 0 && fraction <= 1);
    return strcmp(stage, "volume") != 0 || ++self->reports != self->stop_at;
}

/// One thread asks after each of its tiles; of two, the one that asks may be left without any by the other.
TEST(test_stops_between_tiles) {
    static const uint32_t dims[3] = {32, 32, 32};
    static const double direction[3] = {0.3, 0.2, -1};
    const double radius = 12;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        stopper self = {0};
        OWNED(ewa_context_destroy) ewa_context *context = check_context_telling(threads, on_progress, &self);
        OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_ball, &radius);
        const ewa_transfer transfer = scene_linear(0.2f, 0.5f, 0.9f, 3);
        OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
        const ewa_camera camera = scene_camera(300, 300, direction, 60);
        OWNED(ewa_volume_renderer_destroy) ewa_volume_renderer *renderer;
        assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
        OWNED(check_free) float *pixels = malloc(4 * 300 * 300 * sizeof *pixels);
        const ewa_frame frame = {.rgba = pixels};
        const ewa_volume_options options = defaults();
        for (self.stop_at = 1; self.stop_at <= 4; self.stop_at++, self.reports = 0) {
            const ewa_status status = ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL);
            assert_true(threads == 2 || self.reports == self.stop_at);
            assert_int_equal(status, self.reports == self.stop_at ? EWA_CANCELLED : EWA_OK);
        }
        self.stop_at = 0;
        assert_int_equal(ewa_volume_render(renderer, voxels, &camera, &options, &frame, NULL), EWA_OK);
    }
}

/// Even fog, 40 units deep, that a camera looks into along z.
enum { SIDE = 64 };
static const double ALONG[3] = {0, 0, -1}, KAPPA = 0.07;

typedef struct fog {
    ewa_context *context;
    ewa_volume volume;
    ewa_transfer transfer;
    ewa_voxels *voxels;
} fog;

static fog make_fog(void) {
    static const uint32_t dims[3] = {64, 64, 40};
    fog f = {.context = check_context(2, NULL), .transfer = scene_linear(1, 1, 1, (float)KAPPA)};
    f.volume = scene_volume(f.context, dims, UNIT, scene_ones, NULL);
    f.voxels = scene_voxels(&f.volume, &f.transfer);
    return f;
}

static void free_fog(fog *f) {
    ewa_voxels_destroy(&f->voxels);
    ewa_volume_free(&f->volume);
    ewa_context_destroy(&f->context);
}

/// A plane in homogeneous fog: exp(-kappa d) of it is seen through d of fog.
TEST(test_surface_in_fog) {
    fog f = make_fog();
    float depth[SIDE * SIDE], rgba[4 * SIDE * SIDE];
    for (int method = EWA_VOLUME_HYBRID; method <= EWA_VOLUME_POINTS; method++)
        for (double d = 3.5; d < 40; d += 7.3) {
            const double distance = method == EWA_VOLUME_POINTS ? 140 : 60;
            const ewa_camera camera = scene_camera(SIDE, SIDE, ALONG, distance);
            for (int i = 0; i < SIDE * SIDE; i++) {
                depth[i] = (float)(distance - 20 + d);
                rgba[4 * i] = 0, rgba[4 * i + 1] = 1, rgba[4 * i + 2] = 0, rgba[4 * i + 3] = 1;
            }
            ewa_volume_options options = defaults();
            options.method = (ewa_volume_method)method;
            options.surface_depth = depth, options.surface_rgba = rgba;
            OWNED(ewa_image_free) ewa_image image = scene_draw(f.context, f.voxels, &camera, &options);
            const float *middle = image.pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2);
            const double through = 1 - (double)middle[0], truth = exp(-KAPPA * d);
            if (fabs(through - truth) > 0.01)
                print_message("%d, %g: %g, not %g\n", method, d, through, truth);
            assert_true(fabs(through - truth) < 0.01);
            assert_true(fabsf(middle[1] - 1) < 1e-5f && fabsf(middle[3] - 1) < 1e-5f);
        }
    free_fog(&f);
}

/// Coarser levels are the same fog in fewer voxels.
/// What section planes leave of fog keeps the light off as far as it reaches; the rest is as the reference has it.
TEST(test_sections) {
    fog f = make_fog();
    for (int method = EWA_VOLUME_HYBRID; method <= EWA_VOLUME_POINTS; method++)
        for (double low = -15.2; low < 10; low += 6.1) {
            const double distance = method == EWA_VOLUME_POINTS ? 140 : 60;
            const ewa_camera camera = scene_camera(SIDE, SIDE, ALONG, distance);
            ewa_volume_options options = defaults();
            options.method = (ewa_volume_method)method;
            options.section_count = 2; // from low to 13 along z, the eye being below
            options.section_planes[0][2] = 2, options.section_planes[0][3] = -2 * low;
            options.section_planes[1][2] = -1, options.section_planes[1][3] = 13;
            OWNED(ewa_image_free) ewa_image image = scene_draw(f.context, f.voxels, &camera, &options);
            const double through = 1 - (double)image.pixels[4 * (SIDE / 2 * SIDE + SIDE / 2) + 3];
            const double truth = exp(-KAPPA * (13 - low));
            if (fabs(through - truth) > 0.01)
                print_message("%d, from %g: %g, not %g\n", method, low, through, truth);
            assert_true(fabs(through - truth) < 0.01);
        }
    const ewa_camera aside = scene_camera(SIDE, SIDE, (const double[3]){1, 0.4, -0.7}, 80);
    ewa_volume_options options = defaults();
    options.method = EWA_VOLUME_SPLATS;
    options.section_count = 1;
    options.section_planes[0][0] = 1, options.section_planes[0][1] = -0.5, options.section_planes[0][3] = 4;
    ewa_image fast = scene_draw(f.context, f.voxels, &aside, &options);
    ewa_image slow = scene_draw_reference(&f.volume, &f.transfer, &aside, &options);
    double largest = 0;
    for (size_t i = 0; i < 4 * SIDE * SIDE; i++)
        largest = fmax(largest, fabs((double)fast.pixels[i] - (double)slow.pixels[i]));
    print_message("sections: %.2g from the reference\n", largest);
    assert_true(largest < 0.01);
    ewa_image_free(&fast);
    ewa_image_free(&slow);
    free_fog(&f);
}

TEST_ON(test_levels, 2) {
    static const uint32_t dims[3] = {50, 50, 50};
    static const double direction[3] = {0.3, 0.2, -1};
    const double sigma = 9;
    OWNED(ewa_volume_free) ewa_volume volume = scene_volume(context, dims, UNIT, scene_blob, &sigma);
    const ewa_transfer transfer = scene_linear(0.2f, 0.5f, 0.9f, 0.1f);
    WITH_DEFAULTS(ewa_voxels_options, voxels_options);
    voxels_options.level_count = 3;
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels;
    assert_int_equal(ewa_voxels_create(&volume, &transfer, &voxels_options, &voxels), EWA_OK);
    const ewa_camera camera = scene_camera(100, 100, direction, 150);
    ewa_volume_options options = defaults();
    ewa_image images[3];
    for (uint32_t level = 0; level < 3; level++) {
        options.level = level;
        images[level] = scene_draw(context, voxels, &camera, &options);
    }
    assert_true(psnr_db(&images[0], &images[1]) > 40);
    assert_true(psnr_db(&images[0], &images[2]) > 30);
    for (int i = 0; i < 3; i++) ewa_image_free(&images[i]);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
