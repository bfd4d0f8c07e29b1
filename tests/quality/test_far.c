// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is far against its own picture at eight times the resolution: the comparison by known answers, and a town that stays
// as near to the truth as docs/quality.md says. Tables are printed by measure_far.
#include "check.h"
#include "quality/far_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 64, PIXELS = SIDE_PX * SIDE_PX };

/// A grey square of pixels [low, high) on both axes.
static void fill_square(float *rgba, uint32_t low, uint32_t high, float grey) {
    memset(rgba, 0, 4 * PIXELS * sizeof *rgba);
    for (uint32_t y = low; y < high; y++)
        for (uint32_t x = low; x < high; x++)
            for (uint32_t c = 0; c < 4; c++) rgba[4 * (y * SIDE_PX + x) + c] = c < 3 ? grey : 1;
}

TEST(test_comparison_has_known_answers) {
    static float truth[4 * PIXELS], other[4 * PIXELS];
    far_errors e;
    fill_square(truth, 16, 48, 0.5f);
    memcpy(other, truth, sizeof truth);
    far_compare(truth, other, SIDE_PX, &e);
    assert_true(e.linear_db > 100 && e.screen_db > 100 && e.fat_px == 0 && e.lighter_percent == 0);
    assert_int_equal(e.inner_count, 30 * 30);
    assert_int_equal(e.open_count, 0);

    other[4 * (32 * SIDE_PX + 32) + 3] = 0.9f;
    fill_square(truth, 16, 48, 0.4f);
    far_compare(truth, other, SIDE_PX, &e);
    assert_int_equal(e.open_count, 1);
    assert_true(fabs(e.linear_db - 20) < 1e-4);
    assert_true(fabs(e.lighter_percent - 25) < 1e-3);

    // A pixel more on every side: 4 x 33 pixels around 4 x 32 of outline, which central differences measure.
    fill_square(truth, 16, 48, 0.5f), fill_square(other, 15, 49, 0.5f);
    far_compare(truth, other, SIDE_PX, &e);
    assert_true(e.fat_px > 0.95 && e.fat_px < 1.1);
}

TEST(test_average_is_that_of_pixels) {
    float fine[4 * 4 * 4], rgba[4];
    for (int i = 0; i < 4 * 4 * 4; i++) fine[i] = (float)(i % 4 + 4 * (i / 4 % 2));
    far_average(fine, 1, 4, rgba);
    for (int c = 0; c < 4; c++) assert_true(rgba[c] == (float)c + 2);
}

static void draw(ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_camera *camera, uint32_t supersampling, float *rgba) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.supersampling = supersampling;
    assert_int_equal(ewa_render(renderer, surfels, camera, &options, &(ewa_frame){.rgba = rgba}, NULL), EWA_OK);
}

TEST_ON(test_town_stays_as_near_to_the_truth, 0) {
    static const struct {
        double times, least_db;
    } rows[] = {{1, 22.0}, {4, 30.0}, {8, 28.0}};
    ewa_cloud *cloud = NULL;
    ewa_bounds bounds;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(far_make(context, FAR_TOWN, 16000, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    float *fine = malloc((size_t)4 * PIXELS * FAR_FINER * FAR_FINER * sizeof *fine);
    float truth[4 * PIXELS], other[4 * PIXELS];
    assert_non_null(fine);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        far_errors e;
        ewa_camera camera = far_camera(&bounds, rows[i].times, SIDE_PX, FAR_FINER);
        draw(renderer, surfels, &camera, 1, fine);
        far_average(fine, SIDE_PX, FAR_FINER, truth);
        camera = far_camera(&bounds, rows[i].times, SIDE_PX, 1);
        draw(renderer, surfels, &camera, 0, other);
        far_compare(truth, other, SIDE_PX, &e);
        print_message("%g: %.1f dB on a screen, %.1f dB linear, %llu of %llu open, %+.2f px fat, %+.1f %% lighter\n",
                      rows[i].times, e.screen_db, e.linear_db, (unsigned long long)e.open_count,
                      (unsigned long long)e.inner_count, e.fat_px, e.lighter_percent);
        assert_true(e.screen_db > rows[i].least_db);
        assert_int_equal(e.open_count, 0);
        assert_true(fabs(e.fat_px) < 0.45);
    }
    free(fine);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
