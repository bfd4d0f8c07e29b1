// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Nodes of octrees that are read beside what draws them: nothing of it is drawn before, all of it afterwards, the same bytes as without,
// also while pictures are drawn on another thread, and whatever is damaged.
#include "lod/lod_scene.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT, POINTS = 500000 /* more than are read of it when it is opened */, MOST = 3 };

static const char file[] = "ground.copc.laz", points[] = "ground.ply", damaged[] = "damaged.copc.laz";

typedef struct shown {
    ewa_context *context;
    ewa_scene *scene;
    ewa_scene_renderer *renderer;
    ewa_scene_options options;
    ewa_camera camera;
    ewa_scene_stats stats;
    uint8_t rgba8[4 * PIXELS];
} shown;

static shown one, other;
static check_log heard;

static int enter(void **state) {
    static const char *const names[] = {points};
    lod_clear();
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    lod_save(lod_ground(context, 0, POINTS, (lod_look){true, true}), points);
    assert_int_equal(lod_build(context, names, 1, file, NULL, NULL), EWA_OK);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

/// Opens an octree, so near that points are drawn.
static void open_scene(shown *s, const char *name) {
    char path[512];
    ewa_asset *asset = NULL;
    WITH_DEFAULTS(ewa_asset_options, how);
    how.levels = EWA_OCTREE_ALWAYS;
    how.own_context = true;
    *s = (shown){.context = check_context(2, &heard)};
    heard.count = 0;
    ewa_scene_options_init(&s->options, sizeof s->options);
    s->options.lod.error = 1;
    assert_int_equal(ewa_asset_load(s->context, scratch_path(name, path), &how, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(s->context, &s->options, &s->scene), EWA_OK);
    assert_int_equal(ewa_scene_add(s->scene, asset, NULL), EWA_OK);
    assert_int_equal(ewa_scene_commit(s->scene), EWA_OK);
    ewa_asset_release(&asset);
    assert_int_equal(ewa_scene_renderer_create(s->context, EWA_BACKEND_CPU, NULL, &s->renderer), EWA_OK);
    WITH_DEFAULTS(ewa_view_options, view);
    view.width_px = WIDTH, view.height_px = HEIGHT;
    assert_int_equal(ewa_scene_place_camera(s->scene, &view, &s->camera, NULL), EWA_OK);
    s->camera.fx_px *= 2, s->camera.fy_px *= 2;
}

static void close_scene(shown *s) {
    ewa_scene_renderer_destroy(&s->renderer);
    ewa_scene_destroy(&s->scene);
    ewa_context_destroy(&s->context);
}

static ewa_status draw(shown *s, bool resident_only) {
    s->options.lod.resident_only = resident_only;
    return ewa_scene_draw(s->scene, s->renderer, &s->camera, &s->options, &(ewa_frame){.rgba8 = s->rgba8}, &s->stats);
}

/// Reads all that is missing; returns how many readings failed.
static uint32_t read_all(shown *s, ewa_scene_reader *reader, uint32_t *read_count) {
    uint32_t failed = 0, count;
    *read_count = 0;
    for (;;) {
        assert_int_equal(ewa_scene_reader_choose(reader, s->scene, &s->camera, &s->options, MOST, &count), EWA_OK);
        assert_true(count <= MOST);
        if (!count) return failed;
        failed += ewa_scene_reader_read(reader) != EWA_OK;
        ewa_scene_reader_put(reader);
        *read_count += count;
        assert_true(*read_count < 100000);
    }
}

TEST(all_of_it_in_the_end) {
    open_scene(&one, file);
    open_scene(&other, file);
    ewa_scene_reader *reader = NULL;
    ewa_context *context = check_context(1, NULL);
    assert_int_equal(ewa_scene_reader_create(context, &reader), EWA_OK);
    // Nothing is there, and nothing is read by drawing.
    for (int i = 0; i < 2; i++) {
        assert_int_equal(draw(&one, true), EWA_OK);
        assert_int_equal(one.stats.lod.missing_count, 1);
        assert_int_equal(one.stats.lod.loaded_count, 0);
        assert_int_equal(one.stats.lod.surfel_count, 0);
    }
    // The root comes first, alone, and every picture after it shows something.
    uint32_t count;
    assert_int_equal(ewa_scene_reader_choose(reader, one.scene, &one.camera, &one.options, MOST, &count), EWA_OK);
    assert_int_equal(count, 1);
    assert_int_equal(ewa_scene_reader_read(reader), EWA_OK);
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_int_equal(one.stats.lod.surfel_count, 0); // it was read, not put
    ewa_scene_reader_put(reader);
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_true(one.stats.lod.surfel_count > 0 && one.stats.lod.missing_count > 0);
    assert_int_equal(read_all(&one, reader, &count), 0);
    assert_true(count > 3);
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_int_equal(one.stats.lod.missing_count, 0);
    assert_int_equal(draw(&other, false), EWA_OK);
    assert_memory_equal(one.rgba8, other.rgba8, sizeof one.rgba8);
    // Pictures cannot be of a rank's part of what is there.
    one.options.lod.share_count = 2;
    assert_int_equal(draw(&one, true), EWA_ERROR_ARGUMENT);
    ewa_scene_reader_destroy(&reader);
    ewa_context_destroy(&context);
    close_scene(&one);
    close_scene(&other);
}

/// What was read for another look comes to nothing.
TEST(looks_that_change) {
    open_scene(&one, file);
    ewa_scene_reader *reader = NULL;
    ewa_context *context = check_context(1, NULL);
    assert_int_equal(ewa_scene_reader_create(context, &reader), EWA_OK);
    uint32_t count;
    assert_int_equal(ewa_scene_reader_choose(reader, one.scene, &one.camera, &one.options, MOST, &count), EWA_OK);
    assert_int_equal(count, 1);
    assert_int_equal(ewa_scene_reader_read(reader), EWA_OK);
    WITH_DEFAULTS(ewa_instance, instance);
    instance.coloring.tinted = true;
    assert_int_equal(ewa_scene_set(one.scene, 0, &instance), EWA_OK);
    assert_int_equal(ewa_scene_commit(one.scene), EWA_OK);
    assert_int_equal(draw(&one, true), EWA_OK);
    ewa_scene_reader_put(reader);
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_int_equal(one.stats.lod.surfel_count, 0);
    assert_int_equal(read_all(&one, reader, &count), 0);
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_true(one.stats.lod.surfel_count > 0);
    assert_int_equal(one.stats.lod.missing_count, 0);
    ewa_scene_reader_destroy(&reader);
    ewa_context_destroy(&context);
    close_scene(&one);
}

typedef struct beside {
    pthread_mutex_t nodes;
    ewa_scene_reader *reader;
    atomic_bool done;
    uint32_t failed, count;
} beside;

static void *read_beside(void *data) {
    beside *b = data;
    for (uint32_t count = 1; count;) {
        pthread_mutex_lock(&b->nodes);
        const ewa_status chosen =
            ewa_scene_reader_choose(b->reader, one.scene, &one.camera, &one.options, MOST, &count);
        pthread_mutex_unlock(&b->nodes);
        if (chosen != EWA_OK) b->failed++;
        if (!count) break;
        b->failed += ewa_scene_reader_read(b->reader) != EWA_OK;
        pthread_mutex_lock(&b->nodes);
        ewa_scene_reader_put(b->reader);
        pthread_mutex_unlock(&b->nodes);
        b->count += count;
    }
    atomic_store(&b->done, true);
    return NULL;
}

TEST(pictures_meanwhile) {
    open_scene(&one, file);
    open_scene(&other, file);
    one.options.lod.resident_only = true;
    ewa_context *context = check_context(1, NULL);
    beside b = {.failed = 0};
    pthread_mutex_init(&b.nodes, NULL);
    assert_int_equal(ewa_scene_reader_create(context, &b.reader), EWA_OK);
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, read_beside, &b), 0);
    uint32_t missing = UINT32_MAX;
    for (bool last = false; !last;) {
        last = atomic_load(&b.done);
        pthread_mutex_lock(&b.nodes);
        const ewa_status status = draw(&one, true);
        pthread_mutex_unlock(&b.nodes);
        assert_int_equal(status, EWA_OK);
        missing = one.stats.lod.missing_count;
    }
    pthread_join(thread, NULL);
    assert_int_equal(b.failed, 0);
    assert_true(b.count > 3);
    assert_int_equal(missing, 0);
    assert_int_equal(draw(&other, false), EWA_OK);
    assert_memory_equal(one.rgba8, other.rgba8, sizeof one.rgba8);
    ewa_scene_reader_destroy(&b.reader);
    ewa_context_destroy(&context);
    pthread_mutex_destroy(&b.nodes);
    close_scene(&one);
    close_scene(&other);
}

/// Copies the file with a chunk of points in it damaged.
static void damage(void) {
    char path[512];
    FILE *from = fopen(scratch_path(file, path), "rb");
    assert_non_null(from);
    static uint8_t bytes[1 << 24];
    const size_t size = fread(bytes, 1, sizeof bytes, from);
    assert_true(size > 1 << 16 && size < sizeof bytes);
    fclose(from);
    memset(bytes + size / 8, 0x55, 4096);
    FILE *to = fopen(scratch_path(damaged, path), "wb");
    assert_int_equal(fwrite(bytes, 1, size, to), size);
    fclose(to);
}

/// What is damaged is read once by itself, and represented by what is above it for good.
TEST(damaged_nodes_are_left_out) {
    damage();
    open_scene(&one, damaged);
    one.options.lod.error = 0.01;
    ewa_scene_reader *reader = NULL;
    ewa_context *context = check_context(1, NULL);
    assert_int_equal(ewa_scene_reader_create(context, &reader), EWA_OK);
    uint32_t count;
    const uint32_t failed = read_all(&one, reader, &count);
    assert_true(failed >= 1);
    assert_true(count > failed + 3);
    assert_int_equal(heard.count, 1);
    assert_non_null(strstr(heard.text, damaged));
    assert_int_equal(draw(&one, true), EWA_OK);
    assert_true(one.stats.lod.missing_count > 0 && one.stats.lod.surfel_count > 0);
    assert_int_equal(read_all(&one, reader, &count), 0);
    assert_int_equal(count, 0);
    assert_int_not_equal(draw(&one, false), EWA_OK); // as without a reader
    ewa_scene_reader_destroy(&reader);
    ewa_context_destroy(&context);
    close_scene(&one);
}

int main(void) { return RUN_TESTS(enter, leave); }
