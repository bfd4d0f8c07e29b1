// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Levels of large sets: nearer to what all Gaussians give in a finer picture than all of them in this one are, of few splats; the same
// bytes for every number of threads and order of the set.
#include "gaussian_scene.h"

#include "volume/splats.h"

#include <math.h>

enum { COUNT = EWA_SPLAT_LEVELS_FROM + 1000, WIDTH = 128, HEIGHT = 96, FINER = 4 };

/// Discs on a ball of radius 1, with stripes, some of them nearly clear.
static ewa_gaussians ball(ewa_context *context, bool backwards) {
    ewa_gaussians set;
    assert_int_equal(ewa_gaussians_create(context, COUNT, 1, &set), EWA_OK);
    for (size_t n = 0; n < COUNT; n++) {
        const size_t i = backwards ? COUNT - 1 - n : n;
        const double z = 2 * ((double)n + 0.5) / COUNT - 1, angle = 2.399963229728653 * (double)n, radius = sqrt(1 - z * z);
        const double normal[3] = {radius * cos(angle), radius * sin(angle), z};
        // The turn that brings z to the normal.
        const double q[4] = {1 + z, -normal[1], normal[0], 0}, norm = sqrt(2 + 2 * z);
        for (size_t k = 0; k < 3; k++) {
            set.centers[3 * i + k] = (float)normal[k];
            set.scales[3 * i + k] = k == 2 ? 5e-5f : 4e-3f;
            set.harmonics[12 * i + k] = (float)sin(40 * normal[k]);
            set.harmonics[12 * i + 3 + k] = (float)(0.2 * normal[(k + 1) % 3]);
        }
        for (size_t k = 0; k < 4; k++) set.rotations[4 * i + k] = (float)(q[k] / norm);
        set.opacities[i] = n % 5 ? 0.9f : 0.1f;
    }
    return set;
}

/// The mean of each FINER x FINER pixels.
static ewa_image coarser(ewa_context *context, const ewa_image *fine) {
    ewa_image made;
    assert_int_equal(ewa_image_create(context, WIDTH, HEIGHT, 4, &made), EWA_OK);
    for (size_t y = 0; y < FINER * HEIGHT; y++)
        for (size_t x = 0; x < FINER * WIDTH; x++)
            for (size_t k = 0; k < 4; k++)
                made.pixels[4 * (y / FINER * WIDTH + x / FINER) + k] += fine->pixels[4 * (y * FINER * WIDTH + x) + k] / (FINER * FINER);
    return made;
}

TEST_ON(nearer_to_finer_pictures, 2) {
    OWNED(ewa_gaussians_free) ewa_gaussians set = ball(context, false);
    ewa_gaussian_options options;
    ewa_gaussian_stats stats;
    ewa_gaussian_options_init(&options, sizeof options);
    const double direction[3] = {-1, 0.3, 0.2};
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, direction, 4), finer = gaussians_camera(FINER * WIDTH, FINER * HEIGHT, 40, direction, 4);
    OWNED(ewa_image_free)
    ewa_image fine = gaussians_draw(&set, &finer, &options, NULL), truth = coarser(context, &fine);
    OWNED(ewa_image_free) ewa_image all = gaussians_draw(&set, &camera, &options, &stats);
    const uint64_t all_count = stats.visible_count;
    const double of_all = gaussians_decibels(&all, &truth);
    static const struct {
        double merge_px, decibels;
        uint64_t fewer;
    } cases[] = {{1e-9, 0, 1}, {0.5, 0.5, 2}, {1, 2, 5}, {2, 3, 15}};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        options.merge_px = cases[c].merge_px;
        OWNED(ewa_image_free) ewa_image merged = gaussians_draw(&set, &camera, &options, &stats);
        const double decibels = gaussians_decibels(&merged, &truth);
        print_message("%g px: %llu of %llu, %.2f dB of finer pictures, all %.2f dB\n", cases[c].merge_px,
                      (unsigned long long)stats.visible_count, (unsigned long long)all_count, decibels, of_all);
        assert_true(stats.visible_count * cases[c].fewer <= all_count && decibels >= of_all + cases[c].decibels);
        if (c == 0) assert_memory_equal(merged.pixels, all.pixels, 16 * WIDTH * HEIGHT);
    }
}

/// Small sets have none, nor do 2D Gaussians, nor sets that are not to have any.
TEST_ON(only_large_sets, 2) {
    for (int k = 0; k < 4; k++) {
        OWNED(ewa_gaussians_free) ewa_gaussians set = ball(context, false);
        ewa_splats *splats;
        ewa_splats_info info;
        if (k == 1) set.count = EWA_SPLAT_LEVELS_FROM - 1;
        set.flat = k == 2;
        assert_int_equal(ewa_splats_create(&set, k != 3, &splats), EWA_OK);
        ewa_splats_describe(splats, &info);
        assert_true(info.has_levels == (k == 0));
        ewa_splats_destroy(&splats);
        set.count = COUNT;
    }
}

/// What stands for several is of the class of most of it.
TEST(classes) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_gaussians_free) ewa_gaussians set = ball(context, false);
    OWNED(ewa_splats_destroy) ewa_splats *splats = NULL;
    assert_int_equal(ewa_gaussians_add_classes(&set), EWA_OK);
    for (size_t i = 0; i < COUNT; i++) set.classes[i] = i % 8 == 7 ? 9 : set.centers[3 * i + 2] > 0 ? 700 : 2;
    assert_int_equal(ewa_splats_create(&set, true, &splats), EWA_OK);
    assert_true(splats->info.has_levels && splats->info.has_classes);
    size_t counts[3] = {0}, amiss = 0;
    for (size_t p = 0; p < ewa_splats_all_packets(splats); p++)
        for (uint32_t lane = 0; lane < EWA_SPLAT_LANES; lane++) {
            const float z = splats->packets[p][EWA_SPLAT_PLACE + 2][lane];
            const uint16_t class = splats->classes[p][lane];
            if (splats->packets[p][EWA_SPLAT_OPACITY][lane] <= 0) continue;
            const bool merged = p >= splats->packet_count;
            counts[merged ? 2 : class == 9]++;
            if (class != 9) amiss += class != (z > 0 ? 700 : 2);
            else if (merged) amiss++;
        }
    print_message("of %zu that stand for others %zu are of another class than most around them\n", counts[2], amiss);
    assert_int_equal(counts[0] + counts[1], COUNT);
    assert_int_equal(counts[1], COUNT / 8);
    assert_true(counts[2] > COUNT / 4 && amiss < counts[2] / 20);
}

TEST(same_bytes) {
    OWNED(check_free) float *first = NULL;
    WITH_DEFAULTS(ewa_gaussian_options, options);
    options.merge_px = 1;
    for (uint32_t threads = 1; threads < 4; threads += 2) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
        OWNED(ewa_gaussians_free) ewa_gaussians set = ball(context, threads > 1);
        const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, (const double[]){1, 0.3, -0.2}, 1.5);
        OWNED(ewa_image_free) ewa_image image = gaussians_draw(&set, &camera, &options, NULL);
        if (first) {
            assert_memory_equal(image.pixels, first, 16 * WIDTH * HEIGHT);
        } else {
            first = malloc(16 * WIDTH * HEIGHT);
            assert_non_null(first);
            memcpy(first, image.pixels, 16 * WIDTH * HEIGHT);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
