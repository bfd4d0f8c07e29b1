// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames of which many follow, by levels in memory: off by no more than they may be, the same whichever frames came before, and those of
// all surfels where levels are not enough. Tables are printed by measure_detail.
#include "check.h"
#include "quality/far_scene.h"
#include "scene/draw.h"
#include "surface/levels.h"
#include "surface/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 128, BYTES = 4 * SIDE_PX * SIDE_PX, POINTS = 270000 };

/// Surfels in a scene of their own.
typedef struct film {
    ewa_context *context;
    ewa_cloud *cloud;
    ewa_surfels *surfels;
    ewa_scene *scene;
    ewa_bounds bounds;
} film;

static film make_film(ewa_context *context, far_kind kind, uint64_t point_count) {
    film made = {.context = context};
    OWNED(ewa_asset_release) ewa_asset *asset;
    assert_int_equal(far_make(context, kind, point_count, &made.cloud), EWA_OK);
    assert_int_equal(ewa_surfels_create(made.cloud, NULL, &made.surfels), EWA_OK);
    assert_int_equal(ewa_cloud_measure(made.cloud, &made.bounds), EWA_OK);
    const ewa_asset_source source = {.name = "surfels", .surfels = made.surfels};
    assert_int_equal(ewa_asset_create(context, &source, NULL, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &made.scene), EWA_OK);
    assert_int_equal(ewa_scene_add(made.scene, asset, NULL), EWA_OK);
    return made;
}

static void end_film(film *of) {
    ewa_scene_destroy(&of->scene);
    ewa_surfels_destroy(&of->surfels);
    ewa_cloud_destroy(&of->cloud);
}

static ewa_scene_renderer *make_renderer(ewa_context *context) {
    ewa_scene_renderer *renderer;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    return renderer;
}

/// Draws a frame from so many times the distance at which all is in the picture; returns the level that was drawn. `renderer` NULL: of
/// a renderer that draws nothing else.
static uint32_t draw(const film *of, ewa_scene_renderer *renderer, double times, const ewa_scene_options *options, uint8_t *rgba8) {
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *own = renderer ? NULL : make_renderer(of->context);
    const ewa_camera camera = far_camera(&of->bounds, times, SIDE_PX, 1);
    ewa_scene_stats stats;
    assert_int_equal(ewa_scene_draw(of->scene, renderer ? renderer : own, &camera, options, &(ewa_frame){.rgba8 = rgba8}, &stats), EWA_OK);
    return stats.render.level;
}

static ewa_scene_options options_of(bool many_frames) {
    WITH_DEFAULTS(ewa_scene_options, options);
    assert_false(options.many_frames);
    options.many_frames = many_frames;
    return options;
}

static double rms(const uint8_t *a, const uint8_t *b) {
    double square = 0;
    for (size_t i = 0; i < BYTES; i++) square += (double)(a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square / (BYTES / 4 * 3));
}

static uint8_t all[BYTES], some[BYTES], again[BYTES];

TEST_ON(test_films_are_off_by_next_to_nothing, 0) {
    film of = make_film(context, FAR_TERRAIN, POINTS);
    const ewa_scene_options many = options_of(true), one = options_of(false);
    ewa_scene_renderer *renderer = make_renderer(context);
    uint32_t before = 0;
    double times = 0.75;
    for (; times < 20; times *= 4.6) {
        const uint32_t level = draw(&of, renderer, times, &many, some);
        assert_int_equal(draw(&of, NULL, times, &one, all), 0);
        if (!level) assert_memory_equal(all, some, BYTES);
        assert_true(rms(all, some) <= 1);
        assert_true(level >= before);
        before = level;
    }
    assert_true(before >= 1);
    // A frame alone has the bytes that it has among others.
    assert_int_equal(draw(&of, NULL, times / 4.6, &many, again), before);
    assert_memory_equal(again, some, BYTES);
    ewa_scene_renderer_destroy(&renderer);
    end_film(&of);
}

/// Far away levels have the parts of pixels that all surfels have, where that is cheaper than a finer level with its own, and then other
/// bytes than by their own.
TEST_ON(test_levels_have_parts_of_all, 0) {
    film of = make_film(context, FAR_SPHERE, POINTS);
    ewa_scene_renderer *renderer = make_renderer(context);
    const ewa_scene_options many = options_of(true), one = options_of(false);
    WITH_DEFAULTS(ewa_surfels_options, with_levels);
    with_levels.level_count = EWA_MAX_LEVELS;
    OWNED(ewa_surfels_destroy) ewa_surfels *finest = check_surfels(of.cloud, &with_levels);
    uint32_t by_all = 0;
    for (double times = 2; times < 5; times *= 1.15) {
        const uint32_t level = draw(&of, renderer, times, &many, some);
        const ewa_details *details = &renderer->details;
        if (!level || details->parts_of[0] != of.surfels) continue;
        draw(&of, NULL, times, &one, all);
        assert_true(rms(all, some) <= 1);
        ewa_renderer_set_parts_of(renderer->surfaces, NULL, 0);
        const ewa_camera camera = far_camera(&of.bounds, times, SIDE_PX, 1);
        uint32_t found = level;
        const ewa_surfels *coarse = ewa_levels_find(finest, &found);
        assert_int_equal(ewa_render(renderer->surfaces, coarse, &camera, &many.render, &(ewa_frame){.rgba8 = again}, NULL), EWA_OK);
        assert_true(rms(all, again) > rms(all, some));
        by_all++;
    }
    assert_true(by_all > 0);
    ewa_scene_renderer_destroy(&renderer);
    end_film(&of);
}

TEST_ON(test_whoever_says_how_fine_has_the_say, 0) {
    film of = make_film(context, FAR_TERRAIN, POINTS);
    ewa_scene_renderer *renderer = make_renderer(context);
    ewa_scene_options options = options_of(true);
    assert_true(draw(&of, renderer, 16, &options, some) > 0);
    options.lod.error = 0;
    assert_int_equal(draw(&of, renderer, 16, &options, some), 0);
    options = options_of(true);
    options.render.supersampling = 1;
    assert_int_equal(draw(&of, renderer, 16, &options, some), 0);
    options = options_of(true);
    options.render.level = 1;
    // Surfels without levels are drawn by all.
    assert_int_equal(draw(&of, renderer, 16, &options, some), 0);
    ewa_scene_renderer_destroy(&renderer);
    end_film(&of);
    of = make_film(context, FAR_TERRAIN, 30000);
    options = options_of(true);
    assert_int_equal(draw(&of, NULL, 16, &options, some), 0);
    end_film(&of);
}

/// Levels stay while the camera is among the surfels, and go with these.
TEST_ON(test_levels_stay, 0) {
    film of = make_film(context, FAR_TERRAIN, POINTS), other = make_film(context, FAR_TERRAIN, 30000);
    ewa_scene_renderer *renderer = make_renderer(context);
    const ewa_scene_options many = options_of(true);
    assert_true(draw(&of, renderer, 16, &many, some) > 0);
    assert_int_equal(draw(&of, renderer, 0.01, &many, some), 0);
    assert_int_equal(renderer->details.count, 1);
    assert_int_equal(draw(&other, renderer, 1, &many, some), 0);
    assert_int_equal(renderer->details.count, 0);
    ewa_scene_renderer_destroy(&renderer);
    end_film(&of), end_film(&other);
}

TEST(test_levels_depend_on_no_machine) {
    (void)state;
    uint8_t *const pictures[] = {some, again};
    for (uint32_t i = 0; i < 2; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(i ? 3 : 1, i ? 0 : EWA_CPU_ALL);
        film of = make_film(context, FAR_TERRAIN, POINTS);
        const ewa_scene_options many = options_of(true);
        assert_true(draw(&of, NULL, 16, &many, pictures[i]) > 0);
        end_film(&of);
    }
    assert_memory_equal(some, again, BYTES);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
