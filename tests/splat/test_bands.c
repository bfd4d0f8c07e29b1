// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Frames drawn band by band, with proxies of the sources that a band does not see: the bytes of the whole.
#include "splat/cubes.h"
#include "surface/proxy.h"

#include <math.h>

enum { WIDTH = 150, HEIGHT = 420, POINTS = 10000, BAND = 128, BANDS = (HEIGHT + BAND - 1) / BAND };

typedef struct bench {
    ewa_context *context;
    scene of;
    cubes full;
    ewa_surfels *proxy[CUBES_MAX];
    ewa_renderer *renderer;
} bench;

static bench start(uint32_t threads, scene_kind kind, bool clips) {
    bench b = {.context = check_context(threads, NULL)};
    assert_int_equal(scene_make(b.context, kind, POINTS, WIDTH, HEIGHT, &b.of), EWA_OK);
    if (clips) picture_add_clips(b.of.cloud);
    b.full = cubes_make(b.of.cloud, 4);
    for (uint32_t i = 0; i < b.full.count; i++)
        assert_int_equal(ewa_surfels_proxy(b.full.part[i], &b.proxy[i]), EWA_OK);
    assert_int_equal(ewa_renderer_create(b.context, &b.renderer), EWA_OK);
    return b;
}

static void stop(bench *b) {
    for (uint32_t i = 0; i < b->full.count; i++) ewa_surfels_destroy(&b->proxy[i]);
    cubes_free(&b->full);
    ewa_renderer_destroy(&b->renderer);
    scene_free(&b->of);
    ewa_context_destroy(&b->context);
}

static uint32_t band_end(uint32_t first_px) { return first_px + BAND < HEIGHT ? first_px + BAND : HEIGHT; }

/// Which sources have some pixel in which bands; returns in how many bands they have none.
static uint32_t find_seen(const bench *b, const ewa_render_options *options, const picture *room,
                          bool seen[BANDS][CUBES_MAX]) {
    ewa_render_options plain = *options;
    plain.eye_dome = 0;
    uint32_t proxy_count = 0;
    for (uint32_t source = 0; source < b->full.count; source++) {
        assert_int_equal(ewa_render(b->renderer, b->full.part[source], &b->of.camera, &plain, &room->frame, NULL),
                         EWA_OK);
        for (uint32_t band = 0; band < BANDS; band++) {
            bool any = false;
            for (size_t i = (size_t)band * BAND * WIDTH; i < (size_t)band_end(band * BAND) * WIDTH; i++)
                any = any || room->frame.depth[i] < INFINITY;
            seen[band][source] = any;
            proxy_count += !any;
        }
    }
    return proxy_count;
}

static void fill(const picture *to, int byte) {
    const size_t count = (size_t)WIDTH * HEIGHT;
    memset(to->frame.rgba8, byte, 4 * count);
    memset(to->frame.rgba, byte, 16 * count);
    memset(to->frame.depth, byte, 4 * count);
    memset(to->frame.normal, byte, 12 * count);
    memset(to->frame.coverage, byte, 4 * count);
}

/// Adds the sources, proxies where `seen` is false; some have weights, some hide nothing.
static void add_sources(const bench *b, const bool *seen) {
    for (uint32_t i = 0; i < b->full.count; i++) {
        const ewa_render_source how = {i % 4 ? 1 : 0.3, i % 5 != 2};
        const ewa_surfels *surfels = !seen || seen[i] ? b->full.part[i] : b->proxy[i];
        assert_int_equal(ewa_render_add_source(b->renderer, surfels, &how), EWA_OK);
    }
}

/// Draws the whole frame, then band by band, and compares.
static void hold_bands(const bench *b, const ewa_render_options *options, bool seen[BANDS][CUBES_MAX],
                       const picture *whole, const picture *banded) {
    assert_int_equal(ewa_render_begin(b->renderer, &b->of.camera, options, &whole->frame), EWA_OK);
    add_sources(b, NULL);
    assert_int_equal(ewa_render_finish(b->renderer, NULL), EWA_OK);
    fill(banded, 0xa5);
    for (uint32_t first = 0; first < HEIGHT; first += BAND) {
        assert_int_equal(ewa_render_begin(b->renderer, &b->of.camera, options, &banded->frame), EWA_OK);
        assert_int_equal(ewa_render_set_rows(b->renderer, first, band_end(first)), EWA_OK);
        add_sources(b, seen[first / BAND]);
        assert_int_equal(ewa_render_finish(b->renderer, NULL), EWA_OK);
        // What is not in the band stays as it was.
        for (size_t i = (size_t)band_end(first) * WIDTH; i < (size_t)WIDTH * HEIGHT; i++) {
            assert_int_equal(banded->frame.rgba8[4 * i], 0xa5);
            assert_memory_equal(&banded->frame.coverage[i], "\xa5\xa5\xa5\xa5", 4);
        }
    }
    picture_expect_same(whole, banded);
}

static void hold(scene_kind kind, const ewa_render_options *options, bool clips, const char *what) {
    const picture whole = picture_make(WIDTH, HEIGHT), banded = picture_make(WIDTH, HEIGHT);
    picture first = picture_make(WIDTH, HEIGHT);
    static const uint32_t threads[] = {1, 2, 4, 8};
    bool seen[BANDS][CUBES_MAX];
    for (int i = 0; i < 4; i++) {
        bench b = start(threads[i], kind, clips);
        ewa_renderer_set_tile(b.renderer, i == 1 ? 32 : i == 2 ? 128 : 0);
        if (!i) {
            const uint32_t proxy_count = find_seen(&b, options, &banded, seen);
            print_message("%s, %s: %u of %u proxy\n", scene_name(kind), what, proxy_count, BANDS * b.full.count);
            assert_true(proxy_count > 0 || kind == SCENE_NEAR);
        }
        hold_bands(&b, options, seen, i ? &whole : &first, &banded);
        if (i) picture_expect_same(&first, &whole);
        stop(&b);
    }
    picture done[] = {whole, banded, first};
    for (int i = 0; i < 3; i++) picture_free(&done[i]);
}

TEST(test_bands) {
    WITH_DEFAULTS(ewa_render_options, options);
    for (scene_kind kind = 0; kind < SCENE_COUNT; kind++) hold(kind, &options, false, "as it is");
    hold(SCENE_ELLIPSES, &options, true, "clipped");
    options.eye_dome = 1;
    hold(SCENE_TORUS, &options, false, "eye-dome lighting");
    options.eye_dome = 0;
    options.opacity = 0.6;
    hold(SCENE_TORUS, &options, false, "transparent");
    options.opacity = 1;
    options.kernel = EWA_KERNEL_RAYCAST;
    hold(SCENE_CUBE, &options, false, "raycast");
    options.kernel = EWA_KERNEL_PERSPECTIVE;
    options.point_size_px = 4;
    hold(SCENE_CUBE, &options, false, "points");
}

/// Eye-dome lighting where neither depths nor linear colours are asked for.
TEST(test_eye_dome_bytes) {
    bench b = start(2, SCENE_TORUS, false);
    WITH_DEFAULTS(ewa_render_options, options);
    options.eye_dome = 1;
    picture whole = picture_make(WIDTH, HEIGHT), banded = picture_make(WIDTH, HEIGHT);
    const ewa_frame frames[2] = {{.rgba8 = whole.frame.rgba8}, {.rgba8 = banded.frame.rgba8}};
    for (int k = 0; k < 2; k++)
        for (uint32_t first = 0; first < HEIGHT; first = k ? band_end(first) : HEIGHT) {
            assert_int_equal(ewa_render_begin(b.renderer, &b.of.camera, &options, &frames[k]), EWA_OK);
            if (k) assert_int_equal(ewa_render_set_rows(b.renderer, first, band_end(first)), EWA_OK);
            add_sources(&b, NULL);
            assert_int_equal(ewa_render_finish(b.renderer, NULL), EWA_OK);
        }
    assert_memory_equal(whole.frame.rgba8, banded.frame.rgba8, (size_t)4 * WIDTH * HEIGHT);
    picture_free(&whole);
    picture_free(&banded);
    stop(&b);
}

/// What only some sources have: alphas and materials of a proxy count.
TEST_ON(test_proxy_facts, 2) {
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_TORUS, POINTS, WIDTH, HEIGHT, &of), EWA_OK);
    enum { FEW = 40 };
    OWNED(ewa_cloud_destroy) ewa_cloud *other = check_cloud_of(context, FEW);
    float *position = check_add(other, EWA_POSITION, EWA_F32, 3);
    float *normal = check_add(other, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(other, EWA_RADIUS, EWA_F32, 1);
    uint8_t *color = check_add(other, EWA_COLOR, EWA_U8, 4);
    uint8_t *material = check_add(other, EWA_MATERIAL, EWA_U8, 1);
    for (uint32_t i = 0; i < FEW; i++) { // far behind the eye
        for (int c = 0; c < 3; c++)
            position[3 * i + (uint32_t)c] = (float)(-40 * of.camera.world_to_camera[8 + c] + 0.01 * (i % 5));
        normal[3 * i] = 1, normal[3 * i + 1] = normal[3 * i + 2] = 0;
        radius[i] = 0.01f;
        for (uint32_t c = 0; c < 4; c++) color[4 * i + c] = (uint8_t)(100 + i);
        material[i] = i % 2;
    }
    ewa_surfels *surfels[3] = {0};
    assert_int_equal(ewa_surfels_create(of.cloud, NULL, &surfels[0]), EWA_OK);
    assert_int_equal(ewa_surfels_create(other, NULL, &surfels[1]), EWA_OK);
    assert_int_equal(ewa_surfels_proxy(surfels[1], &surfels[2]), EWA_OK);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels[2], &info);
    assert_true(info.resident_bytes < 1024 && info.point_count == 0);
    ewa_material materials[2];
    ewa_material_init(&materials[0]), ewa_material_init(&materials[1]);
    WITH_DEFAULTS(ewa_render_options, options);
    options.shading = EWA_SHADING_PHONG;
    options.materials = materials, options.material_count = 2;
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    picture drawn[3];
    for (int i = 0; i < 3; i++) { // with the other, with its proxy, alone
        drawn[i] = picture_make(WIDTH, HEIGHT);
        assert_int_equal(ewa_render_begin(renderer, &of.camera, &options, &drawn[i].frame), EWA_OK);
        assert_int_equal(ewa_render_add(renderer, surfels[0]), EWA_OK);
        if (i < 2) assert_int_equal(ewa_render_add(renderer, surfels[1 + i]), EWA_OK);
        ewa_render_stats stats;
        assert_int_equal(ewa_render_finish(renderer, &stats), EWA_OK);
        assert_int_equal(stats.splat_count, ewa_cloud_point_count(of.cloud) + (i == 0 ? FEW : 0));
    }
    picture_expect_same(&drawn[0], &drawn[1]);
    const size_t bytes = (size_t)16 * WIDTH * HEIGHT; // without the proxy the picture is another one
    assert_true(memcmp(drawn[0].frame.rgba, drawn[2].frame.rgba, bytes) != 0);
    for (int i = 0; i < 3; i++) picture_free(&drawn[i]), ewa_surfels_destroy(&surfels[i]);
}

/// q0 that is set is what coverage is measured by.
TEST(test_unit_coverage) {
    bench b = start(2, SCENE_SPHERE, false);
    picture drawn[2] = {picture_make(WIDTH, HEIGHT), picture_make(WIDTH, HEIGHT)};
    ewa_surfels *surfels = check_surfels(b.of.cloud, NULL);
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    assert_int_equal(ewa_render(b.renderer, surfels, &b.of.camera, NULL, &drawn[0].frame, NULL), EWA_OK);
    assert_int_equal(ewa_surfels_set_unit_coverage(surfels, info.unit_coverage / 2), EWA_OK);
    assert_int_equal(ewa_render(b.renderer, surfels, &b.of.camera, NULL, &drawn[1].frame, NULL), EWA_OK);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const double once = (double)drawn[0].frame.coverage[i], twice = (double)drawn[1].frame.coverage[i];
        assert_true(fabs(2 * once - twice) < 1e-4 * (1 + twice));
    }
    static const double wrong[] = {0, -1, INFINITY, NAN};
    for (int i = 0; i < 4; i++)
        assert_int_equal(ewa_surfels_set_unit_coverage(surfels, wrong[i]), EWA_ERROR_ARGUMENT);
    for (int i = 0; i < 2; i++) picture_free(&drawn[i]);
    ewa_surfels_destroy(&surfels);
    stop(&b);
}

TEST(test_refusals) {
    bench b = start(1, SCENE_SPHERE, false);
    picture drawn = picture_make(WIDTH, HEIGHT);
    assert_int_equal(ewa_render_set_rows(b.renderer, 0, BAND), EWA_ERROR_ARGUMENT);
    WITH_DEFAULTS(ewa_render_options, options);
    assert_int_equal(ewa_render_begin(b.renderer, &b.of.camera, &options, &drawn.frame), EWA_OK);
    static const uint32_t wrong[][2] = {{0, 0},     {0, 100}, {64, 128}, {128, 128},
                                        {256, 128}, {0, 512}, {384, 421}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(ewa_render_set_rows(b.renderer, wrong[i][0], wrong[i][1]), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_render_set_rows(b.renderer, 128, HEIGHT), EWA_OK);
    options.budget_s = 1;
    assert_int_equal(ewa_render_begin(b.renderer, &b.of.camera, &options, &drawn.frame), EWA_OK);
    assert_int_equal(ewa_render_set_rows(b.renderer, 0, BAND), EWA_ERROR_UNSUPPORTED);
    picture_free(&drawn);
    stop(&b);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
