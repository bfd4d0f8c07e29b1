// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Many sources in a frame: they share pages of the device, so that a thousand take as many dispatches as one; and what comes
// and goes from frame to frame leaves the bytes as the processor draws them.
#include "gpu_scene.h"
#include "lod/cut.h"
#include "lod/lod_scene.h"

#include <stdlib.h>

enum { WIDTH_PX = 96, HEIGHT_PX = 72, NUMBERS = 4 * WIDTH_PX * HEIGHT_PX, MAX_SOURCES = 1000 };

static ewa_surfels *sources[MAX_SOURCES];

/// Parts of one ground, `of_each` points each.
static void make_sources(ewa_context *context, uint32_t count, uint64_t of_each) {
    for (uint32_t i = 0; i < count; i++) {
        ewa_cloud *cloud = lod_ground(context, i * of_each, of_each, (lod_look){true, true});
        float *radii = (float *)(uintptr_t)ewa_cloud_find(cloud, EWA_RADIUS)->data;
        for (uint64_t k = 0; k < of_each; k++) radii[k] = 0.02f + 0.001f * (float)(i % 7);
        sources[i] = check_surfels(cloud, NULL);
        ewa_cloud_destroy(&cloud);
    }
}

static void free_sources(uint32_t count) {
    for (uint32_t i = 0; i < count; i++) ewa_surfels_destroy(&sources[i]);
}

static ewa_camera camera_before(void) {
    ewa_camera camera = check_camera(WIDTH_PX, HEIGHT_PX);
    const double eye[3] = {0.1, -1.2, 1.6}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
    return camera;
}

/// Draws those of `count` sources of which `mask` has the bit of their number modulo 64.
static void draw(ewa_renderer *renderer, uint32_t count, uint64_t mask, uint8_t *rgba8) {
    const ewa_camera camera = camera_before();
    WITH_DEFAULTS(ewa_render_options, options);
    assert_int_equal(ewa_render_begin(renderer, &camera, &options, &(ewa_frame){.rgba8 = rgba8}), EWA_OK);
    for (uint32_t i = 0; i < count; i++)
        if (mask >> i % 64 & 1) assert_int_equal(ewa_render_add(renderer, sources[i]), EWA_OK);
    assert_int_equal(ewa_render_finish(renderer, NULL), EWA_OK);
}

static ewa_renderer_info info_of(const ewa_renderer *renderer) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    assert_int_equal(ewa_renderer_describe(renderer, &info), EWA_OK);
    return info;
}

static uint8_t by_cpu[NUMBERS], by_gpu[NUMBERS];

TEST(test_thousand) {
    enum { OF_EACH = 40, WARM_UP = 2 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = check_renderer(context);
    OWNED(ewa_renderer_destroy) ewa_renderer *gpu = NULL;
    assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &gpu), EWA_OK);
    make_sources(context, MAX_SOURCES, OF_EACH);
    uint32_t of_one = 0;
    static const uint32_t counts[] = {1, 10, MAX_SOURCES};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        for (int frame = 0; frame < WARM_UP; frame++) draw(gpu, counts[i], UINT64_MAX, by_gpu);
        draw(cpu, counts[i], UINT64_MAX, by_cpu);
        assert_memory_equal(by_gpu, by_cpu, NUMBERS);
        const ewa_renderer_info info = info_of(gpu);
        print_message("%u sources: %u dispatches\n", counts[i], info.dispatch_count);
        assert_true(info.wait_count == 1 && info.readback_count == 1);
        if (!i) of_one = info.dispatch_count;
        assert_int_equal(info.dispatch_count, of_one);
        assert_in_range(of_one, 6, 12);
    }
    free_sources(MAX_SOURCES);
}

/// Sources that come and go, with little room for those that the last frame did not use: holes are filled, packets of a source
/// lie in several, pages grow and are emptied.
TEST(test_coming_and_going) {
    enum { SOURCES = 60, OF_EACH = 150, FRAMES = 12 };
    static const char *const tunings[] = {"kept=1", "kept=100000 page=100", "page=7"};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = check_renderer(context);
    make_sources(context, SOURCES, OF_EACH);
    for (size_t i = 0; i < sizeof tunings / sizeof tunings[0]; i++) {
        assert_int_equal(setenv("EWA_GL_TUNING", tunings[i], 1), 0);
        OWNED(ewa_renderer_destroy) ewa_renderer *gpu = NULL;
        assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &gpu), EWA_OK);
        assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
        check_random random = {.state = 7 + i};
        for (int frame = 0; frame < FRAMES; frame++) {
            // All, few, or many of them.
            const uint64_t some = check_random_u64(&random), mask = frame % 3 == 0 ? UINT64_MAX : some & check_random_u64(&random);
            draw(gpu, SOURCES, mask, by_gpu);
            draw(cpu, SOURCES, mask, by_cpu);
            assert_memory_equal(by_gpu, by_cpu, NUMBERS);
        }
    }
    free_sources(SOURCES);
}

/// What the last frame did not use is kept up to a bound; the longest unused goes first.
TEST(test_kept) {
    enum { SETS = 3, OF_EACH = 160, SOURCES = 60, SET_BYTES = SOURCES / SETS * OF_EACH / 16 * 512 };
    static const struct {
        int kept;
        const char *sets; // as they are drawn
        int sent;
    } runs[] = {{1, "01010101", 2}, {1, "012012012", 9}, {1, "012121212", 3}, {2, "012012012", 3}};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    make_sources(context, SOURCES, OF_EACH);
    uint64_t sets[SETS] = {0};
    for (int i = 0; i < 64; i++) sets[i % SETS] |= (uint64_t)1 << i;
    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        char tuning[64];
        snprintf(tuning, sizeof tuning, "kept=%d", runs[i].kept * (SET_BYTES + SET_BYTES / 4));
        assert_int_equal(setenv("EWA_GL_TUNING", tuning, 1), 0);
        OWNED(ewa_renderer_destroy) ewa_renderer *gpu = NULL;
        assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &gpu), EWA_OK);
        assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
        int sent = 0;
        for (const char *set = runs[i].sets; *set; set++) {
            draw(gpu, SOURCES, sets[*set - '0'], by_gpu);
            sent += info_of(gpu).upload_bytes > SET_BYTES;
        }
        print_message("%s, %d kept: %d sent\n", runs[i].sets, runs[i].kept, sent);
        assert_int_equal(sent, runs[i].sent);
    }
    free_sources(SOURCES);
}

/// An octree of a ground in the test's folder.
static ewa_lod *open_ground(ewa_context *context, uint64_t points) {
    static const char *const names[] = {"ground.ply"}, file[] = "ground.copc.laz";
    char path[512];
    ewa_lod *lod = NULL;
    lod_clear();
    lod_save(lod_ground(context, 0, points, (lod_look){true, true}), names[0]);
    assert_int_equal(lod_build(context, names, 1, file, NULL, NULL), EWA_OK);
    assert_int_equal(ewa_lod_open(context, scratch_path(file, path), &lod), EWA_OK);
    return lod;
}

/// Many nodes are drawn as one cloud is.
TEST(test_octree) {
    enum { POINTS = 200000, MIN_NODES = 5 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = check_renderer(context);
    OWNED(ewa_renderer_destroy) ewa_renderer *gpu = NULL;
    assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &gpu), EWA_OK);
    OWNED(ewa_lod_close) ewa_lod *lod = open_ground(context, POINTS);
    const ewa_camera camera = camera_before();
    WITH_DEFAULTS(ewa_render_options, options);
    WITH_DEFAULTS(ewa_lod_options, lod_options);
    lod_options.error = 0.01, lod_options.spacing_px = 0.01, lod_options.max_splats = POINTS;
    ewa_lod_stats stats;
    const ewa_frame to_gpu = {.rgba8 = by_gpu}, to_cpu = {.rgba8 = by_cpu};
    for (int frame = 0; frame < 2; frame++)
        assert_int_equal(ewa_lod_render(lod, gpu, &camera, &options, &lod_options, &to_gpu, &stats), EWA_OK);
    const ewa_renderer_info info = info_of(gpu);
    print_message("%u nodes: %u dispatches, %u wait\n", stats.node_count, info.dispatch_count, info.wait_count);
    assert_true(stats.node_count >= MIN_NODES);
    assert_int_equal(ewa_lod_render(lod, cpu, &camera, &options, &lod_options, &to_cpu, NULL), EWA_OK);
    assert_memory_equal(by_gpu, by_cpu, NUMBERS);
    assert_true(info.wait_count == 1);
    assert_in_range(info.dispatch_count, 6, 12);
    lod_clear();
}

/// Nodes of a picture that fade: drawn with their children, both with a weight between none and all.
static uint32_t count_fading(ewa_lod *lod, const ewa_camera *camera, const ewa_render_options *options, const ewa_lod_options *chosen) {
    const ewa_lod_scene scene = {.lods = &lod, .lod_count = 1};
    ewa_cut cut;
    assert_int_equal(ewa_cut_begin(&cut, &scene, camera, options, chosen), EWA_OK);
    assert_int_equal(ewa_cut_choose(&cut, false), EWA_OK);
    uint32_t count = 0;
    for (uint32_t i = 0; i < cut.item_count; i++) count += !cut.items[i].hides && cut.items[i].weight < 1;
    return count;
}

/// There and back along a road: nodes are sent once, when they are first drawn. A frame whose nodes are all there is sent what a
/// frame says of each of them; so are the weights of those that fade.
TEST(test_dolly) {
    enum { POINTS = 400000, STEPS = 8, FRAME_BYTES = 16384, SOURCE_BYTES = 1024, SURFEL_BYTES = 30 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *cpu = check_renderer(context);
    OWNED(ewa_renderer_destroy) ewa_renderer *gpu = NULL;
    assert_int_equal(ewa_renderer_create_on(context, EWA_BACKEND_GL, &gpu), EWA_OK);
    OWNED(ewa_lod_close) ewa_lod *lod = open_ground(context, POINTS);
    WITH_DEFAULTS(ewa_render_options, options);
    WITH_DEFAULTS(ewa_lod_options, lod_options);
    options.supersampling = 1;
    const ewa_frame to_gpu = {.rgba8 = by_gpu}, to_cpu = {.rgba8 = by_cpu};
    uint64_t surfels_sent = 0, largest_bytes = 0;
    uint32_t fading = 0, frames_that_sent = 0;
    for (int frame = 0; frame < 2 * STEPS; frame++) {
        const int step = frame < STEPS ? frame : 2 * STEPS - 1 - frame;
        ewa_camera camera = check_camera(WIDTH_PX, HEIGHT_PX);
        const double eye[3] = {0.1, -4 + 0.45 * step, 0.6}, target[3] = {0, eye[1] + 1, 0}, up[3] = {0, 0, 1};
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
        ewa_lod_stats stats;
        assert_int_equal(ewa_lod_render(lod, gpu, &camera, &options, &lod_options, &to_gpu, &stats), EWA_OK);
        const uint64_t bytes = info_of(gpu).upload_bytes, beside = FRAME_BYTES + (uint64_t)SOURCE_BYTES * stats.node_count;
        if (bytes > largest_bytes) largest_bytes = bytes;
        if (bytes > beside) surfels_sent += (bytes - beside) / SURFEL_BYTES, frames_that_sent++;
        if (frame >= STEPS && bytes > beside) fail_msg("frame %d: %llu bytes of nodes that are there", frame, (unsigned long long)bytes);
        fading += count_fading(lod, &camera, &options, &lod_options);
        assert_int_equal(ewa_lod_render(lod, cpu, &camera, &options, &lod_options, &to_cpu, NULL), EWA_OK);
        assert_memory_equal(by_gpu, by_cpu, NUMBERS);
    }
    print_message("%llu surfels sent in %u of %d frames, at most %llu bytes in one; %u fading nodes\n", (unsigned long long)surfels_sent,
                  frames_that_sent, 2 * STEPS, (unsigned long long)largest_bytes, fading);
    assert_true(fading > 0 && frames_that_sent > 2);
    lod_clear();
}

int main(void) {
    if (!gpu_there()) return 77;
    return RUN_TESTS(NULL, NULL);
}
