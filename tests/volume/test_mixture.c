// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Volumes and Gaussians in one picture: what is in front of what, in whose colours, over surfaces and their edges.
#include "image/srgb.h"
#include "volume/gaussian_scene.h"
#include "volume/scene.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { WIDTH = 150, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

static const double FRONT[3] = {0, 0, -1}, SLANTED[3] = {0.3, 0.2, -1}, ROUND[4] = {1, 0, 0, 0};

/// Where a field of cubes begins and ends along z, in voxels from the middle.
typedef struct cut {
    double low, high;
} cut;

static double cut_ball(const void *data, double x, double y, double z) {
    const cut *c = data;
    return x * x + y * y + z * z < 100 && z > c->low && z < c->high;
}

/// What a test draws: up to two volumes and two sets.
typedef struct cast {
    ewa_context *context;
    ewa_gaussian_renderer *renderer;
    ewa_volume_renderer *volume_renderers[2];
    ewa_voxels *voxels[2];
    ewa_splats *splats[2];
    ewa_mixed_volume volumes[2];
    ewa_volume_options volume_options;
    ewa_gaussian_options options;
    uint32_t splats_count, volume_count;
} cast;

/// Of the Gaussians of all pictures: every test runs with both.
static ewa_gaussian_order order;

static int by_centers(void **state) { return order = EWA_ORDER_CENTER, 0; }
static int by_rays(void **state) { return order = EWA_ORDER_RAY, 0; }

static cast start_on(ewa_context *context) {
    cast c = {.context = context};
    assert_int_equal(ewa_gaussian_renderer_create(context, &c.renderer), EWA_OK);
    ewa_volume_options_init(&c.volume_options, sizeof c.volume_options);
    ewa_gaussian_options_init(&c.options, sizeof c.options);
    c.options.order = order;
    c.options.background[0] = 0.2f, c.options.background[1] = 0.5f, c.options.background[3] = 0.75f;
    memcpy(c.volume_options.background, c.options.background, sizeof c.options.background);
    return c;
}

static void add_ball(cast *c, double low, double high, float extinction) {
    static const uint32_t dims[3] = {24, 24, 24};
    static const double spacing[3] = {0.1, 0.1, 0.1};
    // Fields get world units; the cut is in voxels.
    const cut at = {low, high};
    ewa_volume volume = scene_volume(c->context, dims, (const double[3]){1, 1, 1}, cut_ball, &at);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) volume.index_to_world[4 * row + column] *= spacing[row];
    const ewa_transfer transfer = scene_linear(0.9f, 0.3f, 0.1f, extinction);
    const uint32_t i = c->volume_count++;
    c->voxels[i] = scene_voxels(&volume, &transfer);
    ewa_volume_free(&volume);
    assert_int_equal(ewa_volume_renderer_create(c->context, &c->volume_renderers[i]), EWA_OK);
}

static void add_set(cast *c, ewa_gaussians *set) {
    assert_int_equal(ewa_splats_create(set, false, &c->splats[c->splats_count++]), EWA_OK);
    ewa_gaussians_free(set);
}

static const double SHEET_COLOR[3] = {0.1, 0.4, 0.9}, SHEET_OPACITY = 0.6;

/// A sheet across the picture, thin and flat, at a depth from the middle.
static void add_sheet(cast *c, double z) {
    ewa_gaussians set =
        gaussians_one(c->context, (const double[3]){0, 0, z}, (const double[3]){5000, 5000, 0.005}, ROUND,
                      SHEET_OPACITY, SHEET_COLOR);
    add_set(c, &set);
}

static ewa_mixture mixture_of(cast *c) {
    for (uint32_t i = 0; i < c->volume_count; i++)
        c->volumes[i] = (ewa_mixed_volume){c->volume_renderers[i], c->voxels[i], &c->volume_options, NULL};
    return (ewa_mixture){(const ewa_splats *const *)c->splats, c->splats_count, c->volume_count, c->volumes};
}

static ewa_image draw_cast(cast *c, const ewa_camera *camera) {
    ewa_image image;
    const ewa_mixture mixture = mixture_of(c);
    assert_int_equal(ewa_image_create(c->context, camera->width_px, camera->height_px, 4, &image), EWA_OK);
    const ewa_frame frame = {.rgba = image.pixels};
    assert_int_equal(ewa_mixture_render(c->renderer, &mixture, camera, &c->options, &frame, NULL), EWA_OK);
    return image;
}

static void end(cast *c) {
    ewa_gaussian_renderer_destroy(&c->renderer);
    for (int i = 0; i < 2; i++) {
        ewa_volume_renderer_destroy(&c->volume_renderers[i]);
        ewa_voxels_destroy(&c->voxels[i]);
        ewa_splats_destroy(&c->splats[i]);
    }
}

static double largest_difference(const ewa_image *a, const ewa_image *b) {
    double largest = 0;
    for (size_t i = 0; i < 4 * (size_t)a->width_px * a->height_px; i++)
        largest = fmax(largest, fabs((double)a->pixels[i] - (double)b->pixels[i]));
    return largest;
}

/// A camera at the distance at which voxels are splats, points, or at the eye.
static ewa_camera camera_of(int n) {
    ewa_camera camera = scene_camera(WIDTH, HEIGHT, n == 3 ? FRONT : SLANTED, n == 1 ? 12 : n == 2 ? 0.3 : 3);
    if (n == 3) {
        camera.projection = EWA_ORTHOGRAPHIC;
        camera.fx_px = camera.fy_px = 30;
    }
    return camera;
}

/// One volume is drawn as ewa_volume_render() does; one set, and nothing, as ewa_gaussian_render(), to the byte.
TEST_ON(test_alone, 2) {
    for (int n = 0; n < 4; n++) {
        const ewa_camera camera = camera_of(n);
        cast c = start_on(context);
        add_ball(&c, -20, 20, 2);
        c.options.section_count = (uint32_t)(n % 2); // the volume's own are not used
        c.options.section_planes[0][0] = 1, c.options.section_planes[0][2] = -0.5;
        ewa_image mixed = draw_cast(&c, &camera);
        memcpy(c.volume_options.section_planes, c.options.section_planes, sizeof c.options.section_planes);
        c.volume_options.section_count = c.options.section_count;
        ewa_image plain = scene_draw(context, c.voxels[0], &camera, &c.volume_options);
        const double apart = largest_difference(&mixed, &plain);
        print_message("a volume alone, %d: %.2g\n", n, apart);
        assert_true(apart < 1e-5);
        ewa_image_free(&mixed);
        ewa_image_free(&plain);
        end(&c);
    }
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 60, SLANTED, 3);
    ewa_gaussians set = gaussians_random(context, 2000, 2, 5);
    cast c = start_on(context);
    ewa_image plain = gaussians_draw(&set, &camera, &c.options, NULL);
    add_set(&c, &set);
    ewa_image mixed = draw_cast(&c, &camera);
    assert_memory_equal(plain.pixels, mixed.pixels, PIXELS * 4 * sizeof(float));
    c.splats_count = 0;
    ewa_image nothing = draw_cast(&c, &camera);
    for (size_t i = 0; i < PIXELS; i++)
        for (size_t k = 0; k < 4; k++) {
            const float *b = c.options.background;
            assert_true(nothing.pixels[4 * i + k] == (k < 3 ? b[k] * b[3] : b[3]));
        }
    c.splats_count = 1;
    ewa_image_free(&plain);
    ewa_image_free(&mixed);
    ewa_image_free(&nothing);
    end(&c);
}

/// Linear premultiplied colours to display values, and back.
static void convert(const double from[4], bool back, double to[4]) {
    to[3] = from[3];
    for (int k = 0; k < 3; k++) {
        const double x = from[3] > 0 ? from[k] / from[3] : 0;
        const double y = back             ? x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4)
                                     : x <= 0.0031308 ? 12.92 * x
                                          : 1.055 * pow(x, 1 / 2.4) - 0.055;
        to[k] = y * from[3];
    }
}

/// A sheet within a ball: the ball's front half, the sheet, its back half, of pictures of their own.
TEST_ON(test_between, 2) {
    for (int n = 0; n < 3; n++) {
        ewa_camera camera =
            scene_camera(WIDTH, HEIGHT, FRONT, n == 1 ? 30 : 4); // splats, points, orthographic
        if (n == 2) {
            camera.projection = EWA_ORTHOGRAPHIC;
            camera.fx_px = camera.fy_px = 25;
        }
        cast c = start_on(context);
        add_ball(&c, -20, 20, 1);
        add_sheet(&c, 0);
        ewa_image mixed = draw_cast(&c, &camera);
        ewa_volume_options plain = c.volume_options;
        memset(plain.background, 0, sizeof plain.background);
        ewa_image halves[2];
        for (int half = 0; half < 2; half++) {
            cast h = start_on(context);
            add_ball(&h, half ? 0 : -20, half ? 20 : 0, 1);
            halves[half] = scene_draw(context, h.voxels[0], &camera, &plain);
            end(&h);
        }
        double largest = 0, seen = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            const float *front = halves[0].pixels + 4 * i, *back = halves[1].pixels + 4 * i;
            const double through = 1 - (double)front[3], own = through * SHEET_OPACITY;
            const double rest = through - own, last = rest * (1 - (double)back[3]);
            double under[4], display[4], out[4];
            for (size_t k = 0; k < 4; k++) {
                const double behind =
                    (double)(k < 3 ? c.options.background[k] : 1) * (double)c.options.background[3];
                under[k] = (double)front[k] + rest * (double)back[k] + last * behind;
            }
            convert(under, false, display);
            for (size_t k = 0; k < 3; k++) display[k] += own * SHEET_COLOR[k];
            display[3] += own;
            convert(display, true, out);
            for (size_t k = 0; k < 4; k++)
                largest = fmax(largest, fabs(out[k] - (double)mixed.pixels[4 * i + k]));
            seen = fmax(seen, (double)front[3]);
        }
        print_message("a sheet within a ball, %d: %.2g\n", n, largest);
        assert_true(seen > 0.3 && largest < 1e-4);
        for (int half = 0; half < 2; half++) ewa_image_free(&halves[half]);
        ewa_image_free(&mixed);
        end(&c);
    }
}

/// Halves of a volume, and of a set, are the whole, also where the sets have other units and origins.
TEST_ON(test_halves, 2) {
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, FRONT, 3);
    cast whole = start_on(context), halves = start_on(context);
    add_ball(&whole, -20, 20, 1);
    add_ball(&halves, 0, 20, 1); // the one behind first
    add_ball(&halves, -20, 0, 1);
    ewa_gaussians all = gaussians_random(context, 1000, 1, 9), parts[2];
    for (size_t p = 0; p < 2; p++) {
        assert_int_equal(ewa_gaussians_create(context, 501, 1, &parts[p]), EWA_OK);
        ewa_gaussians *part = &parts[p];
        for (size_t i = 0; i < 500; i++) {
            for (size_t k = 0; k < 3; k++) {
                part->centers[3 * i + k] = all.centers[3 * (2 * i + p) + k] - (k == 0 ? (float)p : 0);
                part->scales[3 * i + k] = all.scales[3 * (2 * i + p) + k];
            }
            memcpy(part->rotations + 4 * i, all.rotations + 4 * (2 * i + p), 4 * sizeof(float));
            part->opacities[i] = all.opacities[2 * i + p];
            memcpy(part->harmonics + 12 * i, all.harmonics + 12 * (2 * i + p), 12 * sizeof(float));
        }
        part->origin[0] = (double)p;
        // One more, far off, so that a set's unit is another.
        part->centers[3 * 500] = p ? 5000 : 30;
        part->scales[3 * 500] = 0.1f, part->rotations[4 * 500] = 1, part->opacities[500] = 0.5f;
    }
    add_set(&whole, &all);
    add_set(&halves, &parts[0]);
    add_set(&halves, &parts[1]);
    ewa_image one = draw_cast(&whole, &camera), two = draw_cast(&halves, &camera);
    const double decibels = gaussians_decibels(&one, &two);
    print_message("halves: %.1f dB\n", decibels);
    assert_true(decibels > 60);
    ewa_image_free(&one);
    ewa_image_free(&two);
    end(&whole);
    end(&halves);
}

/// A pixel that a surface covers in part shows the surface with what is in front of it there, and all there is
/// in the rest.
TEST_ON(test_edges, 2) {
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, SLANTED, 3);
    static float depth[PIXELS], rgba[4 * PIXELS], solid[4 * PIXELS];
    for (int n = 0; n < 3; n++) {
        cast c = start_on(context);
        if (n != 1) add_ball(&c, -20, 20, 1);
        ewa_gaussians set = gaussians_random(context, 500, 1, 9);
        if (n != 0)
            add_set(&c, &set);
        else
            ewa_gaussians_free(&set);
        for (size_t i = 0; i < PIXELS; i++) {
            const size_t x = i % WIDTH;
            depth[i] = x < 30 ? INFINITY : 3;
            const float cover = x < 30 ? 0 : x < 100 ? (float)(x - 30) / 70 : 1;
            for (size_t k = 0; k < 4; k++) {
                solid[4 * i + k] = k == 1 ? 0.75f : 1;
                rgba[4 * i + k] = cover * solid[4 * i + k];
            }
        }
        c.options.surface_depth = depth, c.options.surface_rgba = rgba;
        ewa_image edge = draw_cast(&c, &camera);
        c.options.surface_rgba = solid;
        ewa_image covered = draw_cast(&c, &camera);
        c.options.surface_rgba = c.options.surface_depth = NULL;
        ewa_image open = draw_cast(&c, &camera);
        double largest = 0, apart = 0;
        for (size_t i = 0; i < 4 * PIXELS; i++) {
            const double share = (double)rgba[i / 4 * 4 + 3];
            const double expected = share * (double)covered.pixels[i] + (1 - share) * (double)open.pixels[i];
            largest = fmax(largest, fabs(expected - (double)edge.pixels[i]));
            apart = fmax(apart, fabs((double)covered.pixels[i] - (double)open.pixels[i]));
        }
        print_message("edges, %d: %.2g\n", n, largest);
        assert_true(apart > 0.1 && largest < 1e-5);
        ewa_image_free(&edge);
        ewa_image_free(&covered);
        ewa_image_free(&open);
        end(&c);
    }
}

/// Depth is where half of the light is gone, of whatever takes it.
TEST_ON(test_depth, 1) {
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, FRONT, 4);
    static float depth[PIXELS], coverage[PIXELS];
    for (int n = 0; n < 2; n++) {
        cast c = start_on(context);
        add_ball(&c, -20, 20, n ? 0.01f : 1000);
        add_sheet(&c, n ? -0.5 : 1.5);
        const ewa_mixture mixture = mixture_of(&c);
        const ewa_frame frame = {.depth = depth, .coverage = coverage};
        assert_int_equal(ewa_mixture_render(c.renderer, &mixture, &camera, &c.options, &frame, NULL), EWA_OK);
        const size_t middle = (size_t)HEIGHT / 2 * WIDTH + WIDTH / 2;
        assert_true(fabs((double)depth[middle] - (n ? 3.5 : 3)) < 0.2);
        assert_true(fabs((double)depth[0] - (n ? 3.5 : 5.5)) < 0.02);
        assert_true(fabs((double)coverage[0] - SHEET_OPACITY) < 1e-3);
        end(&c);
    }
}

/// Threads and instruction sets change no byte.
TEST(test_bytes) {
    static const uint32_t masks[3] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    static float first[4 * PIXELS];
    for (int n = 0; n < 6; n++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(n % 2 ? 5 : 1, masks[n / 2]);
        const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 50, SLANTED, 2);
        cast c = start_on(context);
        add_ball(&c, -20, 0, 1);
        add_ball(&c, -5, 20, 2);
        ewa_gaussians set = gaussians_random(context, 1500, 3, 5);
        add_set(&c, &set);
        c.volume_options.shading = EWA_SHADING_PHONG;
        ewa_image image = draw_cast(&c, &camera);
        if (n == 0) memcpy(first, image.pixels, sizeof first);
        assert_memory_equal(first, image.pixels, sizeof first);
        ewa_image_free(&image);
        end(&c);
    }
}

TEST_ON(test_bad, 1) {
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, FRONT, 4);
    cast c = start_on(context);
    add_ball(&c, -20, 20, 1);
    static float rgba[4 * PIXELS];
    static ewa_mixed_volume many[EWA_MAX_MIXED_VOLUMES + 1];
    const ewa_frame frame = {.rgba = rgba};
    const ewa_mixed_volume twice[2] = {{c.volume_renderers[0], c.voxels[0], NULL, NULL},
                                       {c.volume_renderers[0], c.voxels[0], NULL, NULL}};
    ewa_volume_options coarse = c.volume_options;
    coarse.level = 3;
    const ewa_mixed_volume level = {c.volume_renderers[0], c.voxels[0], &coarse, NULL},
                           empty = {NULL, NULL, NULL, NULL};
    const ewa_splats *nothing = NULL;
    const ewa_mixture wrong[] = {{NULL, 0, 2, twice},
                                 {NULL, 0, 1, &level},
                                 {NULL, 0, 1, &empty},
                                 {NULL, 0, 1, NULL},
                                 {NULL, 1, 0, NULL},
                                 {&nothing, 1, 0, NULL},
                                 {NULL, 0, EWA_MAX_MIXED_VOLUMES + 1, many}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(ewa_mixture_render(c.renderer, &wrong[i], &camera, NULL, &frame, NULL),
                         EWA_ERROR_ARGUMENT);
    ewa_context *elsewhere = check_context(4, NULL);
    ewa_gaussian_renderer *foreign;
    assert_int_equal(ewa_gaussian_renderer_create(elsewhere, &foreign), EWA_OK);
    const ewa_mixture here = mixture_of(&c);
    assert_int_equal(ewa_mixture_render(foreign, &here, &camera, NULL, &frame, NULL), EWA_ERROR_ARGUMENT);
    ewa_gaussian_renderer_destroy(&foreign);
    ewa_context_destroy(&elsewhere);
    assert_int_equal(ewa_mixture_render(c.renderer, NULL, &camera, NULL, &frame, NULL), EWA_ERROR_ARGUMENT);
    end(&c);
}

/// Whichever allocation fails, the call says so; the next one draws.
TEST(test_memory) {
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, SLANTED, 3);
    check_memory memory = {.calls_left = -1};
    OWNED(ewa_context_destroy) ewa_context *context = check_context_on(1, &memory);
    for (long n = 0, done = 0; !done; n++) {
        cast c = start_on(context);
        add_ball(&c, -20, 20, 1);
        add_sheet(&c, 0);
        const ewa_mixture mixture = mixture_of(&c);
        static float rgba[4 * PIXELS];
        const ewa_frame frame = {.rgba = rgba};
        memory.calls_left = n;
        const ewa_status status = ewa_mixture_render(c.renderer, &mixture, &camera, NULL, &frame, NULL);
        memory.calls_left = -1;
        assert_true(status == EWA_OK || status == EWA_ERROR_MEMORY);
        done = status == EWA_OK;
        assert_true(done ? n > 10 : n < 1000);
        assert_int_equal(ewa_mixture_render(c.renderer, &mixture, &camera, NULL, &frame, NULL), EWA_OK);
        end(&c);
    }
}

/// An allocator that is asked by the thread that calls the library only.
typedef struct own_thread {
    pthread_t caller;
    atomic_uint strange_count;
} own_thread;

static void *give(void *user, size_t size_bytes) {
    own_thread *own = user;
    if (!pthread_equal(pthread_self(), own->caller)) atomic_fetch_add(&own->strange_count, 1);
    return check_aligned(size_bytes);
}

static void take(void *user, void *memory, size_t size_bytes) {
    own_thread *own = user;
    (void)size_bytes;
    if (!pthread_equal(pthread_self(), own->caller)) atomic_fetch_add(&own->strange_count, 1);
    check_aligned_release(memory);
}

TEST(test_allocator) {
    own_thread own = {.caller = pthread_self()};
    WITH_DEFAULTS(ewa_context_options, chosen);
    chosen.thread_count = 4;
    chosen.allocator = (ewa_allocator){.user = &own, .allocate = give, .release = take};
    ewa_context *context;
    assert_int_equal(ewa_context_create(&chosen, &context), EWA_OK);
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, SLANTED, 3);
    cast c = start_on(context);
    add_ball(&c, -20, 20, 1);
    add_sheet(&c, 0);
    ewa_image image = draw_cast(&c, &camera);
    ewa_image_free(&image);
    end(&c);
    ewa_context_destroy(&context);
    assert_int_equal(own.strange_count, 0);
}

/// A world of any scale, whose camera makes up for it; no sets and one beside a volume.
TEST_ON(test_scales, 2) {
    OWNED(ewa_image_free) ewa_image first = {0};
    for (int n = 0; n < 3; n++) {
        const int exponent = n == 0 ? 0 : n == 1 ? 200 : -200;
        static const uint32_t dims[3] = {24, 24, 24};
        const cut at = {-20, 20};
        ewa_volume volume = scene_volume(context, dims, (const double[3]){1, 1, 1}, cut_ball, &at);
        for (int i = 0; i < 12; i++)
            volume.index_to_world[i] = ldexp(0.1 * volume.index_to_world[i], exponent);
        ewa_transfer transfer = scene_linear(0.9f, 0.3f, 0.1f, 1);
        transfer.unit_length_world = ldexp(1, exponent);
        cast c = start_on(context);
        c.voxels[0] = scene_voxels(&volume, &transfer);
        c.volume_count = 1;
        assert_int_equal(ewa_volume_renderer_create(context, &c.volume_renderers[0]), EWA_OK);
        ewa_camera camera = scene_camera(WIDTH, HEIGHT, SLANTED, 3);
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 3; column++)
                camera.world_to_camera[4 * row + column] =
                    ldexp(camera.world_to_camera[4 * row + column], -exponent);
        ewa_image image = draw_cast(&c, &camera);
        if (n == 0)
            first = image;
        else
            assert_true(largest_difference(&first, &image) < 1e-4);
        if (n) ewa_image_free(&image);
        ewa_volume_free(&volume);
        end(&c);
    }
}

int main(void) {
    return RUN_TESTS(by_centers, NULL) +
           RUN_TESTS(by_rays, NULL);
}
