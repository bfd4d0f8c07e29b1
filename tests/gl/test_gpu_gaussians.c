// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians by the device: the processor's bytes in all planes, what a frame asks of the device, and what is left to the processor.
#include "gl/backends.h"
#include "gpu_scene.h"
#include "volume/gaussian_backend.h"
#include "volume/gaussian_scene.h"
#include "volume/shown.h"
#include "volume/splat_colors.h"

#include <math.h>
#include <stdlib.h>

static const double FRONT[3] = {0.3, 0.2, -1}, ROUND[4] = {1, 0, 0, 0};

enum { MAX_SETS = 3, FLOATS = 10, CODES = 1, COLORS = 2, DEPTH = 4, NORMAL = 8, COVERAGE = 16, ALL = 31 };

/// Renderers of Gaussians by both, and the sets that they draw.
typedef struct both {
    ewa_context *context;
    ewa_renderer *surfaces;
    ewa_gaussian_renderer *cpu, *gpu;
    ewa_splats *sets[MAX_SETS];
    const ewa_splat_colors *colors[MAX_SETS]; ///< NULL: its own
    uint32_t set_count;
} both;

static both make(ewa_context *context, ewa_backend_kind kind, const char *tuning) {
    both b = {.context = context};
    assert_int_equal(setenv("EWA_GL_TUNING", tuning, 1), 0);
    assert_int_equal(ewa_renderer_create_on(context, kind, &b.surfaces), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(context, &b.cpu), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(context, &b.gpu), EWA_OK);
    assert_int_equal(ewa_gl_gaussians_attach(context, b.surfaces, b.gpu), EWA_OK);
    return b;
}

static void leave(both *b) {
    ewa_gaussian_renderer_destroy(&b->gpu);
    ewa_gaussian_renderer_destroy(&b->cpu);
    ewa_renderer_destroy(&b->surfaces);
    for (uint32_t i = 0; i < b->set_count; i++) ewa_splats_destroy(&b->sets[i]);
    assert_int_equal(unsetenv("EWA_GL_TUNING"), 0);
}

/// Adds a set, and frees it.
static void add(both *b, ewa_gaussians *set) {
    assert_int_equal(ewa_splats_create(set, true, &b->sets[b->set_count++]), EWA_OK);
    ewa_gaussians_free(set);
}

static void draw(const both *b, ewa_gaussian_renderer *renderer, const ewa_camera *camera, const ewa_gaussian_options *options,
                 uint32_t planes, uint8_t *to, ewa_gaussian_stats *stats) {
    const size_t pixels = (size_t)camera->width_px * camera->height_px;
    float *floats = (float *)(void *)to;
    const ewa_frame frame = {.rgba = planes & COLORS ? floats : NULL,
                             .depth = planes & DEPTH ? floats + 4 * pixels : NULL,
                             .normal = planes & NORMAL ? floats + 5 * pixels : NULL,
                             .coverage = planes & COVERAGE ? floats + 8 * pixels : NULL,
                             .rgba8 = planes & CODES ? to + 9 * pixels * sizeof(float) : NULL};
    memset(to, 0x55, FLOATS * sizeof(float) * pixels);
    const ewa_mixture mixture = {.splats = (const ewa_splats *const *)b->sets, .splats_count = b->set_count};
    assert_int_equal(ewa_mixture_draw(renderer, &mixture, b->colors, camera, options, &frame, stats), EWA_OK);
}

/// Whether the device drew the last frame.
static bool by_device(const both *b) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    const char *remark;
    return ewa_gaussian_renderer_describe(b->gpu, &info, &remark);
}

static ewa_renderer_info info_of(const both *b) {
    ewa_renderer_info info = {.struct_size = sizeof info};
    const char *remark;
    assert_true(ewa_gaussian_renderer_describe(b->gpu, &info, &remark));
    return info;
}

/// Draws a frame by both, and compares the bytes of its planes; returns how many Gaussians were visible.
static uint64_t compare_planes(const both *b, const ewa_camera *camera, const ewa_gaussian_options *options, uint32_t planes) {
    const size_t size = FLOATS * sizeof(float) * camera->width_px * camera->height_px;
    OWNED(check_free) uint8_t *by_cpu = malloc(size), *by_gpu = malloc(size);
    ewa_gaussian_stats cpu, gpu;
    assert_true(by_cpu && by_gpu);
    draw(b, b->cpu, camera, options, planes, by_cpu, &cpu);
    draw(b, b->gpu, camera, options, planes, by_gpu, &gpu);
    assert_memory_equal(by_gpu, by_cpu, size);
    if (!by_device(b)) return UINT64_MAX;
    assert_true(cpu.splat_count == gpu.splat_count && cpu.visible_count == gpu.visible_count && cpu.tile_count == gpu.tile_count &&
                cpu.near_count == gpu.near_count);
    return gpu.visible_count;
}

/// Of all planes, and of those that need the least.
static uint64_t compare(const both *b, const ewa_camera *camera, const ewa_gaussian_options *options) {
    compare_planes(b, camera, options, CODES);
    return compare_planes(b, camera, options, ALL);
}

static ewa_gaussian_options options_of(bool exact) {
    WITH_DEFAULTS(ewa_gaussian_options, options);
    options.projection = exact ? EWA_PROJECTION_EXACT : EWA_PROJECTION_TRAINED;
    options.order = EWA_ORDER_CENTER;
    return options;
}

/// All degrees, both projections, both filters, orthographic, from within, under 130 degrees, far from the origin.
TEST_ON(test_options, 2) {
    for (uint32_t degree = 0; degree <= EWA_MAX_SH_DEGREE; degree++)
        for (int exact = 0; exact < 2; exact++) {
            OWNED(leave) both b = make(context, EWA_BACKEND_GL, degree % 2 ? "" : "arith=emulated");
            ewa_gaussians set = gaussians_random(context, 900, degree, 7 + degree);
            set.origin[0] = 1e4, set.antialiased = degree == 1;
            ewa_camera camera = gaussians_camera(90, 66, degree == 2 ? 130 : 40, FRONT, degree == 3 ? 0.5 : 3);
            for (int row = 0; row < 3; row++) camera.world_to_camera[4 * row + 3] -= 1e4 * camera.world_to_camera[4 * row];
            ewa_gaussian_options options = options_of(exact);
            options.background[0] = 0.5f, options.background[3] = degree % 2 ? 1 : 0.75f;
            if (degree == 4) {
                camera.projection = EWA_ORTHOGRAPHIC;
                camera.fx_px = camera.fy_px = 50;
                for (size_t i = 0; i < set.count; i++) set.scales[3 * i + 2] = 0;
            }
            if (degree == 3) camera.cx_px -= 40; // not in the middle
            add(&b, &set);
            assert_in_range(compare(&b, &camera, &options), 100, 900);
            options.depth = EWA_DEPTH_EXPECTED;
            options.filter = EWA_FILTER_KEEP;
            options.sh_degree = degree / 2;
            options.prefilter_px2 = 0;
            compare(&b, &camera, &options);
            options.filter = EWA_FILTER_THICKEN;
            options.minimum_alpha = 0.02, options.minimum_transmittance = 0.2, options.cutoff = 2;
            compare(&b, &camera, &options);
        }
}

/// 2D Gaussians, from outside, from within, without perspective; beside others.
TEST_ON(test_flat, 2) {
    for (int n = 0; n < 4; n++) {
        OWNED(leave) both b = make(context, EWA_BACKEND_GL, "");
        ewa_gaussians flat = gaussians_random(context, 1500, 1, 3);
        for (size_t i = 0; i < flat.count; i++) flat.scales[3 * i + 2] = 0;
        flat.flat = true;
        add(&b, &flat);
        ewa_gaussians others = gaussians_random(context, 300, 2, 4);
        if (n == 3) add(&b, &others);
        else ewa_gaussians_free(&others);
        ewa_camera camera = gaussians_camera(90, 66, n == 1 ? 110 : 60, FRONT, n == 1 ? 0.5 : 2);
        if (n == 2) {
            camera.projection = EWA_ORTHOGRAPHIC;
            camera.fx_px = camera.fy_px = 50;
        }
        for (int exact = 0; exact < 2; exact++) {
            ewa_gaussian_options options = options_of(exact);
            assert_in_range(compare(&b, &camera, &options), 100, 1800);
            options.prefilter_px2 = 0;
            compare(&b, &camera, &options);
        }
    }
}

/// Sizes of pictures that are no multiples of anything, one pixel, and a long row of tiles.
TEST_ON(test_sizes, 2) {
    static const uint32_t sizes[][2] = {{1, 1}, {3, 5}, {16, 17}, {33, 31}, {64, 32}, {1100, 9}, {7, 300}};
    OWNED(leave) both b = make(context, EWA_BACKEND_GL, "groups=7");
    ewa_gaussians set = gaussians_random(context, 900, 1, 5);
    add(&b, &set);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const ewa_camera camera = gaussians_camera(sizes[i][0], sizes[i][1], 40, FRONT, 3);
        const ewa_gaussian_options options = options_of(false);
        compare(&b, &camera, &options);
    }
}

/// Centres at one depth, in the order of the packets; faint ones and ones that hide all; ones that cover the picture.
TEST_ON(test_ties, 1) {
    enum { COUNT = 2000 };
    static const double along[3] = {0, 0, -1};
    for (int opaque = 0; opaque < 2; opaque++) {
        OWNED(leave) both b = make(context, EWA_BACKEND_GL, "");
        ewa_gaussians set = gaussians_random(context, COUNT, 0, 6);
        check_random random = {.state = 1};
        for (uint32_t i = 0; i < COUNT; i++) {
            set.centers[3 * (size_t)i + 2] = i % 3 ? 0 : 0.25f; // two planes across the view
            set.opacities[i] = opaque ? 0.999f : 0.02f;
            const float scale = check_random_u64(&random) % 64 ? 0.02f : 2;
            for (int k = 0; k < 3; k++) set.scales[3 * (size_t)i + (size_t)k] = scale;
        }
        add(&b, &set);
        const ewa_camera camera = gaussians_camera(100, 65, 40, along, 3);
        const ewa_gaussian_options options = options_of(false);
        assert_in_range(compare(&b, &camera, &options), COUNT / 2, COUNT);
    }
}

/// No Gaussian, all behind the eye, one in front of it.
TEST_ON(test_nothing, 1) {
    OWNED(leave) both b = make(context, EWA_BACKEND_GL, "");
    const double behind[3] = {0.3, 0.2, 9}, place[3] = {0, 0, 0}, scales[3] = {0.3, 0.2, 0.1}, red[3] = {1, 0, 0};
    const ewa_camera camera = gaussians_camera(70, 50, 40, FRONT, 3);
    ewa_gaussian_options options = options_of(false);
    ewa_gaussians empty = gaussians_random(context, 0, 1, 6);
    add(&b, &empty);
    options.background[1] = 0.3f, options.background[3] = 0.5f;
    assert_int_equal(compare(&b, &camera, &options), 0);
    ewa_camera away = gaussians_camera(70, 50, 40, behind, 3);
    for (int i = 0; i < 3; i++) away.world_to_camera[8 + i] *= -1, away.world_to_camera[i] *= -1;
    away.world_to_camera[11] = -3;
    ewa_gaussians one = gaussians_one(context, place, scales, ROUND, 0.9, red);
    add(&b, &one);
    assert_int_equal(compare(&b, &away, &options), 0);
    assert_int_equal(compare(&b, &camera, &options), 1);
}

/// Sets of several pages, with levels: some parts are drawn by what stands for them.
TEST_ON(test_pages_and_levels, 2) {
    enum { COUNT = 132000 };
    static const char *const tunings[] = {"", "page=777"};
    uint64_t drawn[3];
    for (int i = 0; i < 2; i++) {
        OWNED(leave) both b = make(context, EWA_BACKEND_GL, tunings[i]);
        ewa_gaussians set = gaussians_random(context, COUNT, 1, 8);
        for (size_t k = 0; k < 3 * (size_t)COUNT; k++) set.scales[k] *= 0.1f;
        add(&b, &set);
        ewa_gaussians other = gaussians_random(context, 100, 3, 9);
        add(&b, &other);
        const ewa_camera camera = gaussians_camera(120, 90, 40, FRONT, 2.5);
        ewa_gaussian_options options = options_of(false);
        static const double merges_px[] = {0, 1, 4};
        for (int k = 0; k < 3; k++) {
            options.merge_px = merges_px[k];
            drawn[k] = compare_planes(&b, &camera, &options, k == 2 ? ALL : CODES);
        }
        print_message("%u, %u, %u drawn\n", (unsigned)drawn[0], (unsigned)drawn[1], (unsigned)drawn[2]);
        assert_true(drawn[0] > drawn[1] && drawn[1] > 2 * drawn[2] && drawn[2] > 100);
        compare_planes(&b, &camera, &options, CODES);
        assert_int_equal(info_of(&b).wait_count, 1);
    }
}

/// A frame waits once, reads once, sends the same whatever the size of the set, and finds room by its second turn.
TEST_ON(test_counts, 1) {
    enum { DISPATCHES = 24, COUNT = 2000, HEAD_BYTES = 64, WIDTH_PX = 150, HEIGHT_PX = 100 };
    ewa_renderer_info infos[2];
    for (int ten = 0; ten < 2; ten++) {
        OWNED(leave) both b = make(context, EWA_BACKEND_GL, "");
        ewa_gaussians set = gaussians_random(context, ten ? 10 * COUNT : COUNT, 1, 5);
        for (size_t i = 0; i < 3 * (size_t)set.count; i++) set.scales[i] = 0.5f;
        add(&b, &set);
        const ewa_camera camera = gaussians_camera(WIDTH_PX, HEIGHT_PX, 40, FRONT, 3);
        const ewa_gaussian_options options = options_of(false);
        compare_planes(&b, &camera, &options, CODES);
        assert_int_equal(info_of(&b).wait_count, 2); // more tiles than it began with
        const uint64_t first_bytes = info_of(&b).upload_bytes;
        compare_planes(&b, &camera, &options, CODES);
        infos[ten] = info_of(&b);
        assert_int_equal(infos[ten].wait_count, 1);
        assert_int_equal(infos[ten].readback_count, 1);
        assert_int_equal(infos[ten].readback_bytes, HEAD_BYTES + 4 * WIDTH_PX * HEIGHT_PX);
        assert_in_range(infos[ten].dispatch_count, 12, DISPATCHES);
        assert_true(first_bytes > infos[ten].upload_bytes + 60 * COUNT);
    }
    assert_int_equal(infos[0].dispatch_count, infos[1].dispatch_count);
    assert_int_equal(infos[0].upload_bytes, infos[1].upload_bytes);
    print_message("%u dispatches, %u bytes sent\n", infos[0].dispatch_count, (unsigned)infos[0].upload_bytes);
}

/// Planes of surfaces: nothing, whole pixels at several depths, edges of every coverage.
static void make_surfaces(uint32_t width_px, uint32_t height_px, float *depth, float *rgba, float *coverage) {
    check_random random = {.state = 3};
    for (uint32_t i = 0; i < width_px * height_px; i++) {
        const uint32_t x = i % width_px, y = i / width_px;
        const bool some = (x / 11 + y / 7) % 3 != 0, edge = x % 11 == 0;
        depth[i] = some ? 1.5f + 0.1f * (float)(x % 23) + 0.02f * (float)y : INFINITY;
        coverage[i] = !some ? 0 : edge ? (float)(check_random_u64(&random) % 1000) / 1000 : 1;
        for (uint32_t c = 0; c < 3; c++) rgba[4 * i + c] = coverage[i] * (float)((x * (c + 3) + y) % 17) / 16;
        rgba[4 * i + 3] = coverage[i];
    }
}

/// Among surfaces, cut by section planes, and both; 2D ones, without perspective, by rays at the eye.
TEST_ON(test_among, 2) {
    enum { WIDTH_PX = 70, HEIGHT_PX = 45, PIXELS = WIDTH_PX * HEIGHT_PX };
    static float depth[PIXELS], rgba[4 * PIXELS], coverage[PIXELS], normal[3 * PIXELS];
    make_surfaces(WIDTH_PX, HEIGHT_PX, depth, rgba, coverage);
    for (int i = 0; i < 3 * PIXELS; i++) normal[i] = (float)(i % 7) / 7;
    OWNED(leave) both b = {.set_count = 0};
    for (int n = 0; n < 20; n++) {
        if (n % 10 == 0) {
            leave(&b);
            b = make(context, EWA_BACKEND_GL, n ? "arith=emulated" : "");
            ewa_gaussians set = gaussians_random(context, 700, 1, 7);
            add(&b, &set);
        }
        if (n % 10 == 5) {
            ewa_gaussians flat = gaussians_random(context, 200, 0, 3);
            flat.flat = true;
            add(&b, &flat);
        }
        ewa_camera camera = gaussians_camera(WIDTH_PX, HEIGHT_PX, 40, FRONT, n % 5 == 4 ? 0.7 : 3);
        ewa_gaussian_options options = options_of(n % 5 == 4);
        if (n % 5 == 3) camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 25;
        if (n % 2) options.surface_depth = depth, options.surface_rgba = rgba;
        if (n % 4 == 3) options.surface_coverage = coverage;
        if (n % 3 != 1 || !(n % 2)) {
            const double planes[3][4] = {{0.6, 0.1, -0.7, 0.3}, {-0.5, 1, 0.2, 0.4}, {0, 0, 1, -0.2}};
            options.section_count = 1 + (uint32_t)n % 3;
            memcpy(options.section_planes, planes, sizeof planes);
        }
        if (n % 7 == 2) options.depth = EWA_DEPTH_EXPECTED;
        options.background[2] = 0.4f, options.background[3] = 0.5f;
        if (n % 2 && n % 3) options.surface_normal = normal;
        assert_true(compare_planes(&b, &camera, &options, ALL & ~NORMAL) < UINT64_MAX);
        assert_true(compare_planes(&b, &camera, &options, ALL) < UINT64_MAX);
        assert_true(compare_planes(&b, &camera, &options, NORMAL) < UINT64_MAX);
    }
}

/// Only those in a ball about the origin.
static bool in_ball(const void *user, const double place_world[3], int32_t code) {
    (void)code;
    const double *radius = user;
    return place_world[0] * place_world[0] + place_world[1] * place_world[1] + place_world[2] * place_world[2] < *radius * *radius;
}

/// Sets of which some Gaussians are hidden, and coloured by what is not theirs; both change from frame to frame.
TEST_ON(test_looks, 2) {
    enum { COUNT = 900 };
    static const char *const tunings[] = {"", "page=5"};
    for (int i = 0; i < 2; i++) {
        OWNED(leave) both b = make(context, EWA_BACKEND_GL, tunings[i]);
        ewa_gaussians set = gaussians_random(context, COUNT, 2, 7);
        add(&b, &set);
        const ewa_camera camera = gaussians_camera(60, 45, 40, FRONT, 3);
        const ewa_gaussian_options options = options_of(false);
        const uint64_t all = compare(&b, &camera, &options);
        ewa_splats *whole = b.sets[0];
        ewa_cloud *cloud = NULL;
        uint8_t *codes;
        assert_int_equal(ewa_cloud_create(context, COUNT, &cloud), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&codes), EWA_OK);
        const double radii[] = {0.5, 0.9};
        uint64_t shown[2];
        for (int k = 0; k < 2; k++) {
            ewa_splats *view;
            assert_int_equal(ewa_splats_show(context, whole, in_ball, &radii[k], &view), EWA_OK);
            b.sets[0] = view;
            shown[k] = compare(&b, &camera, &options);
            for (size_t c = 0; c < 3 * COUNT; c++) codes[c] = (uint8_t)(c * 7 + (size_t)k * 50);
            ewa_splat_colors *colors;
            assert_int_equal(ewa_splat_colors_create(whole, cloud, NULL, &colors), EWA_OK);
            b.colors[0] = colors;
            assert_int_equal(compare(&b, &camera, &options), shown[k]);
            b.sets[0] = whole;
            assert_int_equal(compare(&b, &camera, &options), all);
            b.colors[0] = NULL;
            ewa_splat_colors_destroy(&colors);
            ewa_splats_destroy(&view);
        }
        assert_true(shown[0] > 10 && shown[0] < shown[1] && shown[1] < all);
        ewa_cloud_destroy(&cloud);
    }
}

/// What the device does not draw is drawn by the processor, and the next frame by the device again.
TEST_ON(test_left_out, 1) {
    enum { WIDTH_PX = 64, HEIGHT_PX = 48 };
    OWNED(leave) both b = make(context, EWA_BACKEND_GL, "");
    ewa_gaussians set = gaussians_random(context, 500, 1, 5);
    add(&b, &set);
    const ewa_camera camera = gaussians_camera(WIDTH_PX, HEIGHT_PX, 40, FRONT, 3);
    for (int i = 0; i < 3; i++) {
        ewa_gaussian_options options = options_of(false);
        if (i == 1) options.order = EWA_ORDER_RAY;
        if (i == 2) options.display = EWA_DISPLAY_ELLIPSOIDS;
        assert_true((compare_planes(&b, &camera, &options, ALL) == UINT64_MAX) == (i > 0));
        ewa_renderer_info info = {.struct_size = sizeof info};
        const char *remark;
        ewa_gaussian_renderer_describe(b.gpu, &info, &remark);
        assert_true((*remark != 0) == (i > 0));
    }
}

/// A device that is too small, that ends loops, or that is lost.
TEST_ON(test_failures, 1) {
    enum { MANY = 80000 };
    static const char *const tunings[] = {"storage=1000000", "", "lose=2"};
    for (int i = 0; i < 3; i++) {
        OWNED(leave) both b = make(context, i == 2 ? EWA_BACKEND_AUTO : EWA_BACKEND_GL, i == 2 ? "software=1 lose=2" : tunings[i]);
        ewa_gaussians set = gaussians_random(context, i == 1 ? MANY : 3000, 0, 5);
        for (uint32_t k = 0; k < set.count && i == 1; k++) {
            set.opacities[k] = 0.0041f;
            for (int c = 0; c < 3; c++) set.scales[3 * (size_t)k + (size_t)c] = 50;
        }
        add(&b, &set);
        ewa_camera camera = gaussians_camera(i == 1 ? 8 : 600, i == 1 ? 8 : 500, 40, FRONT, 3);
        ewa_gaussian_options options = options_of(false);
        options.minimum_transmittance = 0;
        for (int frame = 0; frame < 5; frame++) compare_planes(&b, &camera, &options, CODES);
        assert_false(by_device(&b));
        if (i == 2) continue; // a lost device stays lost
        camera.width_px = camera.height_px = 4;
        options.minimum_alpha = 0.5;
        compare_planes(&b, &camera, &options, CODES);
        assert_true(by_device(&b));
    }
}

/// The faster of both: the processor first, then the device, then one frame of each that counts.
TEST_ON(test_choice, 1) {
    static const bool expected[] = {false, true, false, true, true, true};
    OWNED(leave) both b = make(context, EWA_BACKEND_AUTO, "software=1 auto=gl");
    ewa_gaussians set = gaussians_random(context, 500, 1, 5);
    add(&b, &set);
    ewa_camera camera = gaussians_camera(64, 48, 40, FRONT, 3);
    ewa_gaussian_options options = options_of(false);
    for (int size = 0; size < 2; size++) {
        for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
            compare_planes(&b, &camera, &options, CODES);
            assert_int_equal(by_device(&b), expected[i]);
        }
        camera = gaussians_camera(128, 96, 40, FRONT, 3); // measured anew
    }
    // A software device is left alone.
    OWNED(leave) both alone = make(context, EWA_BACKEND_AUTO, "");
    ewa_gaussians same = gaussians_random(context, 500, 1, 5);
    add(&alone, &same);
    for (int i = 0; i < 5; i++) {
        compare_planes(&alone, &camera, &options, CODES);
        ewa_gpu_info gpu = {.struct_size = sizeof gpu};
        assert_int_equal(ewa_gpu_describe(context, &gpu), EWA_OK);
        if (gpu.software) assert_false(by_device(&alone));
    }
}

int main(void) {
    if (!gpu_there()) return 77;
    return RUN_TESTS(NULL, NULL);
}
