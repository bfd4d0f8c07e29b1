// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed Gaussians in scenes: near by what all of them show, far away few that are as near to finer pictures, within what memory holds; the
// same bytes whatever was drawn before, for every number of threads, and when time was short; coloured, cut and moved as whole sets are.
#include "check.h"
#include "tests/io/scratch.h"

#include "ewa/gaussian_io.h"
#include "ewa/scene.h"

#include <math.h>
#include <stdio.h>

enum { COUNT = 300000, WIDTH = 128, HEIGHT = 96, BYTES = 4 * WIDTH * HEIGHT, LEVELS = 5 };
static const double LENGTH = 60, MERGE_PX = 2;

static const char *level_path(const char *name, char path[512]) {
    char file[64];
    snprintf(file, sizeof file, "street/%s", name);
    return scratch_path(file, path);
}

/// Small Gaussians along a street, striped, on its ground and its walls.
static void make_street(ewa_context *context, ewa_gaussians *set) {
    check_random random = {7};
    assert_int_equal(ewa_gaussians_create(context, COUNT, 0, set), EWA_OK);
    for (size_t i = 0; i < COUNT; i++) {
        const double along = check_uniform(&random, 0, LENGTH), across = check_uniform(&random, -1, 1);
        const double wall = check_uniform(&random, 0.95, 1); // not at one depth, whose order nobody says
        const double place[3] = {i % 3 ? (i % 3 == 1 ? -wall : wall) : across, i % 3 ? across : wall, along};
        for (size_t k = 0; k < 3; k++) {
            set->centers[3 * i + k] = (float)place[k];
            set->scales[3 * i + k] = 0.012f;
            set->harmonics[3 * i + k] = (float)sin(3 * along + (double)k);
        }
        set->rotations[4 * i] = 1;
        set->opacities[i] = i % 7 ? 0.8f : 0.3f;
    }
}

/// Writes the street's levels once, and returns where.
static const char *write_levels(ewa_context *context, char path[512]) {
    static bool written;
    if (!written) {
        ewa_gaussians set;
        make_street(context, &set);
        mkdir(scratch_path("street", path), 0777);
        assert_int_equal(ewa_gaussians_save(&set, level_path("lod-meta.json", path), NULL), EWA_OK);
        ewa_gaussians_free(&set);
        written = true;
    }
    return level_path("lod-meta.json", path);
}

/// A scene of the levels, or of the finest of them as a set in memory.
static ewa_scene *make_scene(ewa_context *context, bool streamed, const double to_world[16]) {
    char path[512];
    ewa_asset_options options;
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    ewa_scene *scene = NULL;
    write_levels(context, path);
    ewa_asset_options_init(&options, sizeof options);
    if (to_world) memcpy(options.to_world, to_world, sizeof options.to_world);
    if (streamed) {
        assert_int_equal(ewa_asset_load(context, path, &options, &asset), EWA_OK);
    } else {
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_load(context, path, &set, NULL), EWA_OK);
        assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.gaussians = &set}, &options, &asset), EWA_OK);
    }
    ewa_asset_info info;
    ewa_asset_describe(asset, &info);
    assert_int_equal(info.count, COUNT);
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    return scene;
}

/// Looks along the street from so far before its end.
static ewa_camera look(double before, uint32_t finer) {
    ewa_camera camera = {.width_px = finer * WIDTH, .height_px = finer * HEIGHT, .projection = EWA_PERSPECTIVE, .fx_px = 100 * finer, .fy_px = 100 * finer,
                         .cx_px = finer * WIDTH / 2.0, .cy_px = finer * HEIGHT / 2.0};
    for (int i = 0; i < 16; i += 5) camera.world_to_camera[i] = 1;
    camera.world_to_camera[11] = before;
    return camera;
}

static ewa_scene_options options_of(ewa_scene *scene, double merge_px) {
    ewa_scene_options options;
    ewa_scene_get_options(scene, &options);
    options.gaussians.merge_px = merge_px;
    return options;
}

static ewa_scene_renderer *make_renderer(ewa_context *context) {
    ewa_scene_renderer *renderer;
    assert_int_equal(ewa_scene_renderer_create(context, EWA_BACKEND_CPU, NULL, &renderer), EWA_OK);
    return renderer;
}

/// Draws; `renderer` NULL: one that draws nothing else.
static ewa_scene_stats draw(ewa_context *context, ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                            const ewa_scene_options *options, uint8_t *rgba8) {
    ewa_scene_renderer *own = renderer ? NULL : make_renderer(context);
    ewa_scene_stats stats;
    assert_int_equal(ewa_scene_draw(scene, renderer ? renderer : own, camera, options, &(ewa_frame){.rgba8 = rgba8}, &stats), EWA_OK);
    ewa_scene_renderer_destroy(&own);
    return stats;
}

static double decibels(const uint8_t *a, const uint8_t *b) {
    double square = 0;
    for (size_t i = 0; i < BYTES; i++) square += (double)(a[i] - b[i]) * (a[i] - b[i]);
    return 10 * log10(255.0 * 255 / (square / BYTES + 1e-9));
}

static uint8_t whole[BYTES], some[BYTES], again[BYTES], fine[16 * BYTES], truth[BYTES];

TEST_ON(near_by_all_and_far_away_few, 2) {
    OWNED(ewa_scene_destroy)
    ewa_scene *streamed = make_scene(context, true, NULL), *all = make_scene(context, false, NULL);
    ewa_scene_options options = options_of(streamed, 0), merged = options_of(streamed, MERGE_PX);
    ewa_scene_info info;
    ewa_scene_describe(streamed, &info);
    assert_true(info.gaussian_levels && info.gaussians);
    assert_int_equal(info.point_count, COUNT);
    const double places[] = {2, 10, 40, 120};
    uint64_t last = COUNT;
    for (size_t p = 0; p < 4; p++) {
        const ewa_camera camera = look(places[p], 1), finer = look(places[p], 4);
        draw(context, all, NULL, &camera, &options, whole);
        const ewa_scene_stats of_all = draw(context, streamed, NULL, &camera, &options, some);
        // Without a tolerance it is all of them; those at one depth may be in another order.
        assert_int_equal(of_all.render.splat_count, COUNT);
        assert_true(decibels(whole, some) > 60);
        draw(context, all, NULL, &finer, &options, fine);
        for (size_t i = 0; i < BYTES; i++) {
            const size_t x = i / 4 % WIDTH, y = i / 4 / WIDTH;
            unsigned sum = 8;
            for (size_t k = 0; k < 16; k++) sum += fine[4 * ((4 * y + k / 4) * 4 * WIDTH + 4 * x + k % 4) + i % 4];
            truth[i] = (uint8_t)(sum / 16);
        }
        const ewa_scene_stats of_some = draw(context, streamed, NULL, &camera, &merged, some);
        print_message("from %g: %llu drawn in %u parts, %.1f dB of finer pictures, all %.1f\n", places[p],
                      (unsigned long long)of_some.render.splat_count, of_some.lod.node_count, decibels(some, truth), decibels(whole, truth));
        assert_true(of_some.render.splat_count <= last && of_some.lod.node_count > 0 && of_some.lod.missing_count == 0);
        assert_true(decibels(some, truth) > decibels(whole, truth) - 0.5);
        last = of_some.render.splat_count;
    }
    assert_true(last < COUNT / 20);
    // Behind the eye nothing is read.
    const ewa_camera inside = look(-LENGTH / 2, 1);
    const ewa_scene_stats half = draw(context, streamed, NULL, &inside, &options, some);
    assert_true(half.render.splat_count < COUNT * 2 / 3 && half.lod.resident_bytes < COUNT * 2 / 3 * 64);
    draw(context, all, NULL, &inside, &options, whole);
    assert_true(decibels(whole, some) > 60);
}

TEST_ON(bounded, 2) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, true, NULL);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = make_renderer(context);
    ewa_scene_options options = options_of(scene, 0), most = options_of(scene, MERGE_PX);
    const ewa_camera here = look(2, 1), there = look(-20, 1);
    options.lod.memory_bytes = 1 << 24; // all are 18 million
    const ewa_scene_stats first = draw(context, scene, NULL, &here, &options, whole);
    assert_true(first.render.splat_count < COUNT && first.render.splat_count > COUNT / 2);
    assert_true(first.lod.resident_bytes <= options.lod.memory_bytes);
    // What was in memory before changes nothing, but that less is read.
    draw(context, scene, renderer, &there, &most, some);
    const ewa_scene_stats second = draw(context, scene, renderer, &here, &options, some);
    assert_memory_equal(some, whole, BYTES);
    assert_true(second.lod.loaded_count < first.lod.loaded_count && second.lod.resident_bytes <= options.lod.memory_bytes);
    assert_int_equal(draw(context, scene, renderer, &here, &options, some).lod.loaded_count, 0);
    most.lod.max_splats = 5000;
    const ewa_scene_stats few = draw(context, scene, renderer, &here, &most, some);
    assert_true(few.render.splat_count <= 5000 && few.render.splat_count > 1000);
    // A part of them each time, coarser where there was no time, and in the end the same.
    options.lod.load_s = 1e-9;
    ewa_scene_renderer_destroy(&renderer);
    renderer = make_renderer(context);
    uint32_t frames = 0;
    ewa_scene_stats stats;
    do {
        stats = draw(context, scene, renderer, &here, &options, some);
        assert_true(stats.lod.node_count == first.lod.node_count && stats.lod.loaded_count > 0);
        frames++;
    } while (stats.lod.missing_count);
    assert_true(frames > 1);
    assert_memory_equal(some, whole, BYTES);
}

TEST(same_bytes_for_threads) {
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads, NULL);
        OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, true, NULL);
        const ewa_scene_options options = options_of(scene, MERGE_PX);
        const ewa_camera camera = look(10, 1);
        draw(context, scene, NULL, &camera, &options, threads == 1 ? whole : some);
    }
    assert_memory_equal(some, whole, BYTES);
}

/// Colours by numbers and given ones, what regions hide and where an asset is: as of the set.
TEST_ON(shown_as_sets_are, 2) {
    static const double to_world[16] = {0, 0, 1, -20, 0, 1, 0, 0.5, -1, 0, 0, 4, 0, 0, 0, 1};
    for (int n = 0; n < 4; n++) {
        const ewa_camera camera = look(n == 3 ? 40 : 3, 1);
        ewa_scene_renderer *renderer = make_renderer(context);
        for (int streamed = 0; streamed < 2; streamed++) {
            OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, streamed, n == 3 ? to_world : NULL);
            ewa_instance instance;
            ewa_scene_options options = options_of(scene, 0);
            ewa_instance_init(&instance, sizeof instance);
            assert_int_equal(ewa_scene_get(scene, 0, &instance), EWA_OK);
            if (n == 0) strcpy(instance.coloring.attribute, "opacity"), instance.coloring.ranged = true, instance.coloring.range[1] = 1;
            if (n == 1) instance.coloring.tinted = true, instance.coloring.tint[1] = 0.75;
            if (n == 2) options.region_count = 1, options.regions[0] = (ewa_region){.has_box = true, .box_world = {-2, -2, 5, 0.3, 2, 30}};
            assert_int_equal(ewa_scene_set_options(scene, &options), EWA_OK);
            // As it is at first and red, so that what changes must come to what is in memory.
            const ewa_instance last = instance;
            draw(context, scene, renderer, &camera, &options, again);
            if (n < 2) ewa_coloring_init(&instance.coloring, sizeof instance.coloring), instance.coloring.tinted = true, instance.coloring.tint[0] = 1;
            assert_int_equal(ewa_scene_set(scene, 0, &instance), EWA_OK);
            draw(context, scene, renderer, &camera, &options, again);
            assert_int_equal(ewa_scene_set(scene, 0, &last), EWA_OK);
            draw(context, scene, renderer, &camera, &options, streamed ? some : whole);
            if (n < 2) assert_true(decibels(again, streamed ? some : whole) < 30);
        }
        ewa_scene_renderer_destroy(&renderer);
        print_message("%d: %.1f dB\n", n, decibels(whole, some));
        assert_true(decibels(whole, some) > 55);
    }
}

/// A file that is gone when it is needed is named.
TEST_LOGGED(gone, 1) {
    OWNED(ewa_scene_destroy) ewa_scene *scene = make_scene(context, true, NULL);
    OWNED(ewa_scene_renderer_destroy) ewa_scene_renderer *renderer = make_renderer(context);
    const ewa_scene_options options = options_of(scene, 0);
    const ewa_camera camera = look(2, 1);
    char from[512], to[512];
    assert_int_equal(rename(level_path("0_0.sog", from), level_path("away.sog", to)), 0);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, &options, &(ewa_frame){.rgba8 = some}, NULL), EWA_ERROR_IO);
    assert_non_null(strstr(log->text, "0_0.sog"));
    assert_int_equal(rename(to, from), 0);
    assert_int_equal(ewa_scene_draw(scene, renderer, &camera, &options, &(ewa_frame){.rgba8 = some}, NULL), EWA_OK);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
