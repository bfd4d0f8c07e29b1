// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pixels drawn as several and averaged: the averages of the finer picture, plane by plane; the same bytes for threads,
// bands and instruction sets; tiles that are too full; the reference; how many parts a frame's surfels ask for; what is refused.
#include "check.h"
#include "quality/far_scene.h"
#include "reference/surface.h"
#include "homogeneous/camera.h"
#include "surface/parts.h"
#include "surface/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 48, PIXELS = SIDE_PX * SIDE_PX, TALL_PX = 300 };

typedef struct planes {
    ewa_frame frame;
    float *memory;
    size_t pixel_count;
} planes;

static planes make_planes(size_t pixel_count) {
    planes made = {.memory = malloc(pixel_count * 10 * sizeof(float)), .pixel_count = pixel_count};
    assert_non_null(made.memory);
    made.frame = (ewa_frame){.rgba = made.memory,
                             .normal = made.memory + 4 * pixel_count,
                             .depth = made.memory + 7 * pixel_count,
                             .coverage = made.memory + 8 * pixel_count,
                             .rgba8 = (uint8_t *)(made.memory + 9 * pixel_count)};
    return made;
}

static bool same_planes(const planes *a, const planes *b) {
    return memcmp(a->memory, b->memory, a->pixel_count * 10 * sizeof(float)) == 0;
}

static ewa_surfels *make_surfels(ewa_context *context, far_kind kind, uint64_t count, ewa_bounds *bounds) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    assert_int_equal(far_make(context, kind, count, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, bounds), EWA_OK);
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    return surfels;
}

static ewa_render_options options_of(uint32_t supersampling) {
    WITH_DEFAULTS(ewa_render_options, options);
    assert_int_equal(options.supersampling, 0);
    options.supersampling = supersampling;
    return options;
}

static void draw(ewa_context *context, const ewa_surfels *surfels, const ewa_camera *camera,
                 const ewa_render_options *options, const planes *to) {
    ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, camera, options, &to->frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
}

/// What a pixel of `finer` x `finer` parts is, from the picture of parts.
static void check_pixel(const planes *parts, const planes *whole, uint32_t width_px, uint32_t finer, uint32_t x,
                        uint32_t y) {
    const size_t pixel = (size_t)y * width_px + x;
    double rgba[4] = {0}, normal[3] = {0}, coverage = 0, depth = INFINITY;
    for (uint32_t j = 0; j < finer; j++)
        for (uint32_t i = 0; i < finer; i++) {
            const size_t at = ((size_t)y * finer + j) * width_px * finer + (size_t)x * finer + i;
            for (int c = 0; c < 4; c++) rgba[c] += (double)parts->frame.rgba[4 * at + (size_t)c] / (finer * finer);
            for (int c = 0; c < 3; c++) normal[c] += (double)parts->frame.normal[3 * at + (size_t)c];
            coverage += (double)parts->frame.coverage[at] / (finer * finer);
            depth = fmin(depth, (double)parts->frame.depth[at]);
        }
    const double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (size_t c = 0; c < 4; c++) {
        assert_true(fabs((double)whole->frame.rgba[4 * pixel + c] - rgba[c]) < 1e-5);
        const double straight = c < 3 ? rgba[3] > 0 ? rgba[c] / rgba[3] : 0 : 1;
        const double code = c < 3 ? 255 * (double)ewa_srgb_from_linear((float)straight) : 255 * rgba[3];
        assert_true(fabs(whole->frame.rgba8[4 * pixel + c] - code) < 0.51);
    }
    for (size_t c = 0; c < 3 && length > 1e-3; c++)
        assert_true(fabs((double)whole->frame.normal[3 * pixel + c] - normal[c] / length) < 1e-4);
    assert_true(fabs((double)whole->frame.coverage[pixel] - coverage) < 1e-4 * fmax(1, coverage));
    assert_true(isinf(depth) ? isinf(whole->frame.depth[pixel]) : (double)whole->frame.depth[pixel] == depth);
}

TEST_ON(test_planes_are_averages_of_the_finer_picture, 2) {
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_TOWN, 50000, &bounds);
    static const uint32_t finer[] = {2, 3, 8};
    for (size_t k = 0; k < sizeof finer / sizeof *finer; k++) {
        const planes parts = make_planes((size_t)PIXELS * finer[k] * finer[k]), whole = make_planes(PIXELS);
        // So far away that squares of the finer picture are blank: of them, too, pixels are the averages.
        const ewa_camera camera = far_camera(&bounds, 3, SIDE_PX, 1), fine = far_camera(&bounds, 3, SIDE_PX, finer[k]);
        ewa_render_options plain = options_of(1), options = options_of(finer[k]);
        static const float background[4] = {0.1f, 0.7f, 0.3f, 0.6f};
        memcpy(plain.background, background, sizeof background);
        memcpy(options.background, background, sizeof background);
        draw(context, surfels, &fine, &plain, &parts);
        draw(context, surfels, &camera, &options, &whole);
        for (uint32_t y = 0; y < SIDE_PX; y++)
            for (uint32_t x = 0; x < SIDE_PX; x++) check_pixel(&parts, &whole, SIDE_PX, finer[k], x, y);
        free(parts.memory);
        free(whole.memory);
    }
}

/// A picture of several bands, drawn whole and in the caller's bands, for one thread and four, for every instruction set.
TEST(test_same_bytes_for_threads_bands_and_instruction_sets) {
    static const uint32_t threads[] = {1, 4}, masks[] = {0, EWA_CPU_ALL};
    planes first = {.memory = NULL};
    for (int variant = 0; variant < 4; variant++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(threads[variant & 1], masks[variant >> 1]);
        ewa_bounds bounds;
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_TOWN, 20000, &bounds);
        ewa_camera camera = far_camera(&bounds, 1, TALL_PX, 1);
        const ewa_render_options options = options_of(2);
        const planes whole = make_planes((size_t)TALL_PX * TALL_PX), bands = make_planes((size_t)TALL_PX * TALL_PX);
        camera.cy_px += 0.3;
        draw(context, surfels, &camera, &options, &whole);
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        for (uint32_t row = 0; row < TALL_PX; row += 128) {
            assert_int_equal(ewa_render_begin(renderer, &camera, &options, &bands.frame), EWA_OK);
            assert_int_equal(ewa_render_set_rows(renderer, row, row + 128 < TALL_PX ? row + 128 : TALL_PX), EWA_OK);
            assert_int_equal(ewa_render_add(renderer, surfels), EWA_OK);
            assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
        }
        assert_true(same_planes(&whole, &bands));
        if (!first.memory) first = whole;
        assert_true(same_planes(&first, &whole));
        if (first.memory != whole.memory) free(whole.memory);
        free(bands.memory);
    }
    free(first.memory);
}

/// More parts than are drawn at a time: those of the last rows are where they belong.
TEST_ON(test_bands_of_parts_end_where_they_should, 0) {
    enum { FINER = 8, WIDE_PX = 1030, HIGH_PX = 130, FIRST_PX = 128, ROW = WIDE_PX * FINER };
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, 5000, &bounds);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    ewa_camera camera = far_camera(&bounds, 1, HIGH_PX, 1), fine = far_camera(&bounds, 1, HIGH_PX, FINER);
    camera.width_px = WIDE_PX, fine.width_px = ROW;
    camera.cy_px = HIGH_PX, fine.cy_px = HIGH_PX * FINER; // its middle is at the lower edge
    float *whole = malloc((size_t)WIDE_PX * HIGH_PX * 4 * sizeof *whole);
    OWNED(check_free) float *parts = malloc((size_t)ROW * HIGH_PX * FINER * 4 * sizeof *parts);
    assert_true(whole && parts);
    const ewa_render_options options = options_of(FINER);
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &(ewa_frame){.rgba = whole}, NULL), EWA_OK);
    assert_int_equal(ewa_render_begin(renderer, &fine, NULL, &(ewa_frame){.rgba = parts}), EWA_OK);
    assert_int_equal(ewa_render_set_rows(renderer, FIRST_PX * FINER, HIGH_PX * FINER), EWA_OK);
    assert_int_equal(ewa_render_add(renderer, surfels), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
    uint32_t shown = 0;
    for (size_t y = FIRST_PX; y < HIGH_PX; y++)
        for (size_t x = 0; x < 4 * WIDE_PX; x++) {
            double sum = 0;
            for (size_t j = 0; j < FINER; j++)
                for (size_t i = 0; i < FINER; i++)
                    sum += (double)parts[4 * ((y * FINER + j) * ROW + x / 4 * FINER + i) + x % 4];
            assert_true(fabs((double)whole[4 * WIDE_PX * y + x] - sum / (FINER * FINER)) < 1e-5);
            shown += sum > 0;
        }
    assert_true(shown > 100);
    free(whole);
}

/// What a tile has no room to keep would be set up again and again: such tiles are halved, and the bytes stay.
TEST_ON(test_crowded_tiles_are_halved, 2) {
    enum { CROWD_PX = 64, COUNT = 600000 };
    static const uint32_t sides_px[] = {0, 32, 64};
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, COUNT, &bounds);
    const ewa_camera camera = far_camera(&bounds, 1, CROWD_PX, 1);
    ewa_render_options options = options_of(1);
    options.eye_dome = 0.5;
    planes made[3];
    uint64_t drawn[3];
    for (int i = 0; i < 3; i++) {
        OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
        made[i] = make_planes((size_t)CROWD_PX * CROWD_PX);
        ewa_render_stats stats;
        ewa_renderer_set_tile(renderer, sides_px[i]);
        assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &made[i].frame, &stats), EWA_OK);
        drawn[i] = stats.drawn_count;
    }
    print_message("%llu records, %llu in tiles of 64 pixels\n", (unsigned long long)drawn[0], (unsigned long long)drawn[2]);
    assert_true(same_planes(&made[0], &made[1]) && same_planes(&made[0], &made[2]));
    assert_true(drawn[0] == drawn[1] && drawn[0] > drawn[2]); // those across a side count twice
    for (int i = 0; i < 3; i++) free(made[i].memory);
}

TEST_ON(test_reference_draws_the_same, 2) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_bounds bounds;
    ewa_surfels_info info;
    assert_int_equal(far_make(context, FAR_TOWN, 20000, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    ewa_surfels_describe(surfels, &info);
    const ewa_camera camera = far_camera(&bounds, 2, SIDE_PX, 1);
    ewa_render_options options = options_of(4);
    const planes fast = make_planes(PIXELS), plain = make_planes(PIXELS);
    draw(context, surfels, &camera, &options, &fast);
    assert_int_equal(ewa_render_reference(cloud, NULL, info.unit_coverage, &camera, &options, &plain.frame), EWA_OK);
    double square = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++) square += pow((double)fast.frame.rgba[i] - (double)plain.frame.rgba[i], 2);
    const double db = 10 * log10(4 * PIXELS / square);
    print_message("%.1f dB from the reference\n", db);
    assert_true(db > 50);
    free(fast.memory);
    free(plain.memory);
}

/// 0 takes so many parts that discs are about as large as one, none where they are, and never too many.
TEST_ON(test_surfels_say_how_many_parts, 2) {
    static const struct {
        double times;
        uint32_t parts;
    } cases[] = {{0.05, 1}, {1, 1}, {2, 2}, {4, 4}, {8, 8}, {200, 8}};
    ewa_bounds bounds;
    // Discs are 1.6 spacings of sqrt(4 pi / 40,000) in radius, 1.05 px from the distance that is called 1 here.
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, 40000, &bounds);
    const planes chosen = make_planes(PIXELS), said = make_planes(PIXELS);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ewa_camera camera = far_camera(&bounds, 1, SIDE_PX, 1);
        camera.fx_px *= 2.55 / cases[i].times, camera.fy_px *= 2.55 / cases[i].times;
        const ewa_render_options open = options_of(0), fixed = options_of(cases[i].parts);
        draw(context, surfels, &camera, &open, &chosen);
        draw(context, surfels, &camera, &fixed, &said);
        assert_true(same_planes(&chosen, &said));
    }
    free(chosen.memory);
    free(said.memory);
}

/// Sizes between two counts of parts are told apart, and where one takes over from another both are drawn.
TEST(test_sizes_say_how_many_parts) {
    const ewa_camera camera = {.width_px = SIDE_PX, .height_px = SIDE_PX};
    double before = -1;
    for (double octaves = -0.9; octaves < 3.5; octaves += 1.0 / 64) {
        ewa_part_areas areas = {.at = {0}};
        ewa_part_areas_add(&areas, 0.75 * exp2(-octaves), 3);
        ewa_part_areas_add(&areas, 100, 1), ewa_part_areas_add(&areas, 0.01, 1);
        assert_true(fabs(ewa_part_areas_octaves(&areas) - fmin(octaves, 3.25)) < 0.07);
        const ewa_division parts = ewa_parts_for(octaves, &camera);
        const double now = log2(parts.count) + parts.finer_share, slope = 8.0 / 64;
        assert_true(parts.finer_share >= 0 && parts.finer_share < 1);
        assert_true(before < 0 || (now >= before && now <= before + slope + 1e-9));
        assert_true(now <= fmax(octaves, -1) + 1 && now >= fmin(octaves, 3) - 0.125);
        before = now;
    }
    assert_true(before == 3);
    // Half of the area as large as a pixel leaves it whole, however small the rest is; so does a frame that shows nothing.
    ewa_part_areas areas = {.at = {0}};
    assert_true(ewa_part_areas_octaves(&areas) == -1);
    ewa_part_areas_add(&areas, 0.75, 2), ewa_part_areas_add(&areas, 0.01, 1);
    assert_true(ewa_part_areas_octaves(&areas) <= 1.0 / 16);
    ewa_part_areas_add(&areas, 2, 4);
    assert_true(ewa_part_areas_octaves(&areas) == -1);
    // A picture's sides have a limit.
    const ewa_camera large = {.width_px = EWA_CAMERA_MAX_SIDE_PX / 2, .height_px = 1};
    assert_int_equal(ewa_parts_for(3, &large).count, 2);
    assert_true(ewa_parts_for(3, &large).finer_share == 0);
}

static double rms(const planes *a, const planes *b) {
    double square = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++) square += pow((double)a->frame.rgba[i] - (double)b->frame.rgba[i], 2);
    return sqrt(square / (4 * PIXELS));
}

/// In between a picture is the mean of both, plane by plane.
TEST_ON(test_parts_take_over_gradually, 2) {
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, 40000, &bounds);
    const planes mixed = make_planes(PIXELS), coarse = make_planes(PIXELS), fine = make_planes(PIXELS);
    const planes before[] = {make_planes(PIXELS), make_planes(PIXELS), make_planes(PIXELS)};
    const ewa_render_options open = options_of(0), one = options_of(1), two = options_of(2);
    int between = 0;
    for (int frame = 0; frame < 60; frame++) {
        ewa_camera camera = far_camera(&bounds, 1, SIDE_PX, 1);
        camera.fx_px *= 2 * exp2(-frame / 60.0), camera.fy_px = camera.fx_px;
        draw(context, surfels, &camera, &open, &mixed);
        draw(context, surfels, &camera, &one, &coarse);
        draw(context, surfels, &camera, &two, &fine);
        if (!same_planes(&mixed, &coarse) && !same_planes(&mixed, &fine)) between++;
        double share = -1;
        for (size_t i = 0; i < PIXELS; i++) {
            assert_true(mixed.frame.depth[i] == fminf(coarse.frame.depth[i], fine.frame.depth[i]) ||
                        mixed.frame.depth[i] == coarse.frame.depth[i] || mixed.frame.depth[i] == fine.frame.depth[i]);
            for (size_t c = 4 * i; c < 4 * i + 4; c++) {
                const double step = (double)fine.frame.rgba[c] - (double)coarse.frame.rgba[c];
                if (fabs(step) < 0.02) continue;
                const double own = ((double)mixed.frame.rgba[c] - (double)coarse.frame.rgba[c]) / step;
                if (share < 0) share = own;
                assert_true(fabs(own - share) < 1e-3);
            }
            assert_true(fabs((double)mixed.frame.coverage[i] - (double)coarse.frame.coverage[i] -
                             fmax(share, 0) * ((double)fine.frame.coverage[i] - (double)coarse.frame.coverage[i])) < 2e-2);
        }
        assert_true(share <= 1.001);
        // From frame to frame there is what changes in both, and a part of what they differ by.
        if (frame)
            assert_true(rms(&mixed, &before[0]) <= fmax(rms(&coarse, &before[1]), rms(&fine, &before[2])) + 0.2 * rms(&coarse, &fine));
        const planes *const drawn[] = {&mixed, &coarse, &fine};
        for (int i = 0; i < 3; i++) memcpy(before[i].memory, drawn[i]->memory, PIXELS * 10 * sizeof(float));
    }
    print_message("%d frames between\n", between);
    assert_true(between >= 5 && between <= 9);
    const planes *const all[] = {&mixed, &coarse, &fine, &before[0], &before[1], &before[2]};
    for (int i = 0; i < 6; i++) free(all[i]->memory);
}

/// What has time enough is drawn as what has no end of it, and a coarser level by fewer parts.
TEST_ON(test_a_budget_has_parts_of_its_level, 0) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    ewa_bounds bounds;
    assert_int_equal(far_make(context, FAR_SPHERE, 20000, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_measure(cloud, &bounds), EWA_OK);
    WITH_DEFAULTS(ewa_surfels_options, with_levels);
    with_levels.level_count = 2;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, &with_levels);
    const planes a = make_planes(PIXELS), b = make_planes(PIXELS);
    ewa_camera camera = far_camera(&bounds, 4, SIDE_PX, 1);
    ewa_render_options options = options_of(0), hurried = options;
    hurried.budget_s = 1e6;
    draw(context, surfels, &camera, &options, &a);
    draw(context, surfels, &camera, &hurried, &b);
    assert_true(same_planes(&a, &b));
    options.level = hurried.level = 1, hurried.budget_s = 1e-9;
    draw(context, surfels, &camera, &options, &a);
    draw(context, surfels, &camera, &hurried, &b);
    assert_true(same_planes(&a, &b));
    options.supersampling = 8;
    draw(context, surfels, &camera, &options, &b);
    assert_false(same_planes(&a, &b));
    free(a.memory), free(b.memory);
}

TEST_LOGGED(test_refused, 1) {
    ewa_bounds bounds;
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, 100, &bounds);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const planes to = make_planes(PIXELS);
    ewa_camera camera = far_camera(&bounds, 1, SIDE_PX, 1);
    ewa_render_options options = options_of(9);
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &to.frame, NULL), EWA_ERROR_ARGUMENT);
    options = options_of(2), options.eye_dome = 1;
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &to.frame, NULL), EWA_ERROR_UNSUPPORTED);
    options.supersampling = 0;
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &to.frame, NULL), EWA_OK);
    options = options_of(8), camera.width_px = 8193;
    assert_int_equal(ewa_render(renderer, surfels, &camera, &options, &to.frame, NULL), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log->text, "8193"));
    free(to.memory);
}

TEST(test_every_failing_allocation) {
    for (int fail_at = 0;; fail_at++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(0, &memory);
        const int64_t before = memory.held_bytes;
        ewa_bounds bounds;
        ewa_surfels *surfels = make_surfels(context, FAR_SPHERE, 100, &bounds);
        const planes to = make_planes(PIXELS);
        const ewa_camera camera = far_camera(&bounds, 1, SIDE_PX, 1);
        const ewa_render_options options = options_of(2);
        ewa_renderer *renderer = check_renderer(context);
        memory.calls_left = fail_at;
        const ewa_status status = ewa_render(renderer, surfels, &camera, &options, &to.frame, NULL);
        const bool failed = memory.calls_left < 0;
        assert_int_equal(status, failed ? EWA_ERROR_MEMORY : EWA_OK);
        memory.calls_left = -1;
        free(to.memory);
        ewa_renderer_destroy(&renderer);
        ewa_surfels_destroy(&surfels);
        assert_int_equal(memory.held_bytes, before);
        ewa_context_destroy(&context);
        if (!failed) break;
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
