// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Depth, normal and coverage of pictures of Gaussians, volumes and surfaces together (docs/math.md section 12).
#include "reference/volume.h"
#include "surface/eye_dome.h"
#include "volume/gaussian_scene.h"
#include "volume/scene.h"

#include <math.h>

enum { WIDTH = 90, HEIGHT = 70, PIXELS = WIDTH * HEIGHT };

static const double FRONT[3] = {0, 0, -1}, SLANTED[3] = {0.3, 0.2, -1}, ROUND[4] = {1, 0, 0, 0};
static const double BLUE[3] = {0.1, 0.4, 0.9};

/// The planes of a frame.
typedef struct planes {
    float depth[PIXELS], normal[3 * PIXELS], coverage[PIXELS], rgba[4 * PIXELS];
    uint8_t rgba8[4 * PIXELS];
} planes;

static ewa_frame frame_of(planes *to) {
    return (ewa_frame){to->rgba8, to->rgba, to->depth, to->normal, to->coverage};
}

/// Where two sets of planes, but for colours, are not the same bytes in a pixel that is not left out.
static size_t count_apart(const planes *a, const planes *b, const bool *left_out) {
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (left_out && left_out[i]) continue;
        count += memcmp(&a->depth[i], &b->depth[i], sizeof(float)) ||
                 memcmp(&a->normal[3 * i], &b->normal[3 * i], 3 * sizeof(float)) ||
                 memcmp(&a->coverage[i], &b->coverage[i], sizeof(float));
    }
    return count;
}

/// A scan of a ball of radius 0.8, by ewa_render().
static void draw_scan_by(ewa_context *context, const ewa_camera *camera, const ewa_render_options *how,
                         planes *to) {
    WITH_DEFAULTS(ewa_generate_options, options);
    options.object = EWA_OBJECT_SPHERE;
    options.point_count = 4000;
    options.size_world = 1.6;
    ewa_cloud *cloud;
    ewa_surfels *surfels;
    ewa_renderer *renderer;
    assert_int_equal(ewa_cloud_generate(context, &options, &cloud), EWA_OK);
    assert_int_equal(ewa_surfels_create(cloud, NULL, &surfels), EWA_OK);
    assert_int_equal(ewa_renderer_create(context, &renderer), EWA_OK);
    const ewa_frame frame = frame_of(to);
    assert_int_equal(ewa_render(renderer, surfels, camera, how, &frame, NULL), EWA_OK);
    ewa_renderer_destroy(&renderer);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
}

static void draw_scan(ewa_context *context, const ewa_camera *camera, double opacity, planes *to) {
    WITH_DEFAULTS(ewa_render_options, how);
    how.opacity = opacity;
    draw_scan_by(context, camera, &how, to);
}

static ewa_gaussian_options options_over(const planes *surface) {
    WITH_DEFAULTS(ewa_gaussian_options, options);
    if (!surface) return options;
    options.surface_depth = surface->depth, options.surface_rgba = surface->rgba;
    options.surface_normal = surface->normal, options.surface_coverage = surface->coverage;
    return options;
}

static void draw_set(const ewa_gaussians *set, const ewa_camera *camera, const ewa_gaussian_options *options,
                     const ewa_frame *frame) {
    ewa_splats *splats;
    ewa_gaussian_renderer *renderer;
    assert_int_equal(ewa_splats_create(set, false, &splats), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(set->context, &renderer), EWA_OK);
    assert_int_equal(ewa_gaussian_render(renderer, splats, camera, options, frame, NULL), EWA_OK);
    ewa_gaussian_renderer_destroy(&renderer);
    ewa_splats_destroy(&splats);
}

static void draw_voxels(ewa_context *context, const ewa_voxels *voxels, const ewa_camera *camera,
                        const ewa_gaussian_options *like, const ewa_frame *frame) {
    ewa_volume_renderer *renderer;
    WITH_DEFAULTS(ewa_volume_options, options);
    options.surface_depth = like->surface_depth, options.surface_rgba = like->surface_rgba;
    options.surface_normal = like->surface_normal, options.surface_coverage = like->surface_coverage;
    assert_int_equal(ewa_volume_renderer_create(context, &renderer), EWA_OK);
    assert_int_equal(ewa_volume_render(renderer, voxels, camera, &options, frame, NULL), EWA_OK);
    ewa_volume_renderer_destroy(&renderer);
}

/// Both together.
static void draw_mixed(const ewa_gaussians *set, const ewa_voxels *voxels, const ewa_camera *camera,
                       const ewa_gaussian_options *options, const ewa_frame *frame) {
    ewa_splats *splats;
    ewa_gaussian_renderer *renderer;
    ewa_volume_renderer *volume_renderer;
    assert_int_equal(ewa_splats_create(set, false, &splats), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(set->context, &renderer), EWA_OK);
    assert_int_equal(ewa_volume_renderer_create(set->context, &volume_renderer), EWA_OK);
    const ewa_mixed_volume volume = {volume_renderer, voxels, NULL, NULL};
    const ewa_splats *sets[] = {splats};
    const ewa_mixture mixture = {sets, 1, 1, &volume};
    assert_int_equal(ewa_mixture_render(renderer, &mixture, camera, options, frame, NULL), EWA_OK);
    ewa_volume_renderer_destroy(&volume_renderer);
    ewa_gaussian_renderer_destroy(&renderer);
    ewa_splats_destroy(&splats);
}

/// A cube of fog, 12 voxels of 0.1 a side, around a place.
static ewa_voxels *make_fog(ewa_context *context, const double place[3], float extinction) {
    static const uint32_t dims[3] = {12, 12, 12};
    OWNED(ewa_volume_free)
    ewa_volume volume = scene_volume(context, dims, (const double[3]){0.1, 0.1, 0.1}, scene_ones, NULL);
    for (int k = 0; k < 3; k++) volume.index_to_world[4 * k + 3] += place[k];
    const ewa_transfer transfer = scene_linear(0.9f, 0.3f, 0.1f, extinction);
    ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    return voxels;
}

/// Gaussians and fog that no pixel sees leave the scan's planes as they are, its soft edges and transparent ones too.
TEST_ON(test_out_of_sight, 2) {
    static planes scan, out;
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, SLANTED, 3);
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 300, 1, 5);
    for (uint32_t i = 0; i < set.count; i++) set.centers[3 * i + 1] += 500;
    OWNED(ewa_voxels_destroy) ewa_voxels *fog = make_fog(context, (const double[3]){0, 500, 0}, 5);
    for (int n = 0; n < 4; n++) {
        draw_scan(context, &camera, n < 2 ? 1 : 0.4, &scan);
        size_t thin = 0, fat = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            thin += isfinite(scan.depth[i]) && scan.rgba[4 * i + 3] < 0.45f;
            fat += scan.coverage[i] > 1;
        }
        assert_true(thin > 5 && fat > 50);
        ewa_gaussian_options options = options_over(&scan);
        options.projection = (ewa_gaussian_projection)(n % 2);
        const ewa_frame frame = frame_of(&out);
        memset(&out, 0x5a, sizeof out);
        draw_set(&set, &camera, &options, &frame);
        assert_int_equal(count_apart(&scan, &out, NULL), 0);
        memset(&out, 0x5a, sizeof out);
        draw_voxels(context, fog, &camera, &options, &frame);
        assert_int_equal(count_apart(&scan, &out, NULL), 0);
        memset(&out, 0x5a, sizeof out);
        draw_mixed(&set, fog, &camera, &options, &frame);
        assert_int_equal(count_apart(&scan, &out, NULL), 0);
    }
}

/// Pixels beside what lets light through, and those whose surface hides it all, keep the surface's planes.
TEST_ON(test_beside, 2) {
    static planes scan, alone, out;
    static bool seen[PIXELS];
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, FRONT, 3);
    draw_scan(context, &camera, 1, &scan);
    const ewa_gaussian_options over = options_over(&scan), plain = options_over(NULL);
    const ewa_frame frame = frame_of(&out), own = frame_of(&alone);
    for (int n = 0; n < 4; n++) {
        // At the ball's outline, in front of it or behind.
        const double place[3] = {n % 2 ? 1.4 : 0.4, 0.05, n % 2 ? 1.5 : -1.5};
        OWNED(ewa_gaussians_free) ewa_gaussians set =
            gaussians_one(context, place, (const double[3]){0.12, 0.08, 0.02}, ROUND, 0.9, BLUE);
        OWNED(ewa_voxels_destroy) ewa_voxels *fog = make_fog(context, place, 2);
        if (n < 2)
            draw_set(&set, &camera, &plain, &own), draw_set(&set, &camera, &over, &frame);
        else
            draw_voxels(context, fog, &camera, &plain, &own),
                draw_voxels(context, fog, &camera, &over, &frame);
        size_t beside = 0, hidden = 0, before = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            const bool behind = n % 2 && scan.rgba[4 * i + 3] == 1;
            seen[i] = alone.coverage[i] > 0 && !behind;
            beside += alone.coverage[i] == 0, hidden += behind && alone.coverage[i] > 0;
            if (!seen[i]) continue;
            // What takes half of the light in front of the surface, or beside it, has its own depth and its own normal; fog has none.
            if (alone.coverage[i] > 0.6f && (n % 2 == 0 || isinf(scan.depth[i]))) {
                assert_true(out.depth[i] == alone.depth[i] && (n < 2 ? out.normal[3 * i + 2] < -0.9f : out.normal[3 * i + 2] == 0));
                before++;
            }
            assert_true(out.depth[i] <= scan.depth[i] || scan.rgba[4 * i + 3] < 0.5f);
        }
        assert_int_equal(count_apart(&scan, &out, seen), 0);
        print_message("beside, %d: %zu beside, %zu before, %zu hidden\n", n, beside, before, hidden);
        assert_true(beside > 500 && before > 5 && (n % 2 == 0 || hidden > 5));
    }
}

/// A surface at depth 5 whose alpha goes from 0 to 1 along rows and whose coverage is 1.5 times that.
static void make_ramp(planes *to) {
    for (size_t i = 0; i < PIXELS; i++) {
        const float cover = (float)(i % WIDTH) / (WIDTH - 1);
        to->depth[i] = 5;
        to->coverage[i] = 1.5f * cover;
        for (size_t k = 0; k < 4; k++) to->rgba[4 * i + k] = k == 1 ? 0.5f * cover : cover;
        for (size_t k = 0; k < 3; k++) to->normal[3 * i + k] = k == 2 ? -0.8f : k == 1 ? 0.6f : 0;
    }
}

/// Sheets of known opacities before and behind the ramp: depth, normal and coverage in closed form.
TEST_ON(test_sheets, 2) {
    static const double opacities[6][2] = {{0.3, 0.3},  {0.45, 0.9}, {0.6, 0.9},
                                           {0.02, 0.2}, {0.02, 0.7}, {0.9, 0.02}};
    static planes ramp, out, slow;
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 30, FRONT, 5);
    make_ramp(&ramp);
    size_t before_count = 0, own_count = 0, behind_count = 0;
    for (int n = 0; n < 12; n++) {
        OWNED(ewa_gaussians_free) ewa_gaussians set;
        assert_int_equal(ewa_gaussians_create(context, 2, 0, &set), EWA_OK);
        for (size_t i = 0; i < 2; i++) { // at the depths 4 and 6
            set.centers[3 * i + 2] = i ? 1 : -1;
            for (size_t k = 0; k < 3; k++) set.scales[3 * i + k] = k == 2 ? 0.01f : 100;
            set.rotations[4 * i] = 1;
            set.opacities[i] = (float)opacities[n % 6][i];
        }
        ewa_gaussian_options options = options_over(&ramp);
        options.projection = (ewa_gaussian_projection)(n / 6);
        const ewa_frame frame = frame_of(&out), reference = frame_of(&slow);
        draw_set(&set, &camera, &options, &frame);
        assert_int_equal(ewa_gaussian_render_reference(&set, &camera, &options, &reference),
                         EWA_OK);
        const double front = opacities[n % 6][0], back = opacities[n % 6][1];
        for (size_t i = 0; i < PIXELS; i++) {
            const double a = (double)ramp.rgba[4 * i + 3], c = (double)ramp.coverage[i];
            const double left = (1 - a) * (1 - front), rest = left * (1 - back);
            // Opacities are these to a thousandth only.
            if (fabs(left - 0.5) < 2e-3 || fabs(rest - 0.5) < 2e-3) continue;
            const double taken = a * front + (1 - a) * (1 - (1 - front) * (1 - back));
            const bool before = front > 0.5, behind = !before && left > 0.5 && rest <= 0.5;
            before_count += before, behind_count += behind, own_count += !before && !behind;
            const planes *both[2] = {&out, &slow};
            for (int k = 0; k < 2; k++) {
                const planes *p = both[k];
                if (before || behind)
                    assert_true(fabs((double)p->depth[i] - (before ? 4 : 6)) < 2e-3);
                else
                    assert_true(p->depth[i] == 5);
                const float *normal = p->normal + 3 * i, *own = ramp.normal + 3 * i;
                for (int m = 0; m < 3; m++)
                    assert_true(before || behind ? fabsf(normal[m] - (m == 2 ? -1 : 0)) < 1e-4f : normal[m] == own[m]);
                const double wanted = c >= 1 ? c : 1 - (1 - taken) * (1 - c);
                assert_true(fabs((double)p->coverage[i] - wanted) < 2e-3);
                assert_true(c < 1 || p->coverage[i] == ramp.coverage[i]);
            }
        }
    }
    assert_true(before_count > 1000 && behind_count > 1000 && own_count > 1000);
}

/// Fog of a known optical depth before a surface, by ewa_volume_render() and as a mixture.
TEST_ON(test_fog, 2) {
    static planes wall, out;
    // So narrow that every ray goes through the fog's faces, which are 1.2 apart.
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 2, FRONT, 5);
    OWNED(ewa_gaussians_free) ewa_gaussians nothing;
    assert_int_equal(ewa_gaussians_create(context, 0, 0, &nothing), EWA_OK);
    for (int n = 0; n < 4; n++) {
        const double extinction = n / 2 ? 1.5 : 0.4, taken = 1 - exp(-1.2 * extinction);
        OWNED(ewa_voxels_destroy) ewa_voxels *fog = make_fog(context, (const double[3]){0, 0, 0}, (float)extinction);
        make_ramp(&wall);
        for (size_t i = 0; i < PIXELS; i++) {
            wall.depth[i] = 6;
            wall.coverage[i] = 0.5f;
            for (size_t k = 0; k < 4; k++) wall.rgba[4 * i + k] = 1;
        }
        ewa_gaussian_options options = options_over(&wall);
        const ewa_frame frame = frame_of(&out);
        if (n % 2)
            draw_mixed(&nothing, fog, &camera, &options, &frame);
        else
            draw_voxels(context, fog, &camera, &options, &frame);
        for (size_t i = 0; i < PIXELS; i++) {
            assert_true(fabs((double)out.coverage[i] - (0.5 + 0.5 * taken)) < 0.01);
            if (n / 2 == 0) { // 38 % of the light
                assert_true(out.depth[i] == 6);
                assert_memory_equal(out.normal + 3 * i, wall.normal + 3 * i, 3 * sizeof(float));
            } else {
                assert_true(fabs((double)out.depth[i] - (4.4 + log(2) / extinction)) < 0.1);
                assert_true(out.normal[3 * i + 1] == 0 && out.normal[3 * i + 2] == 0);
            }
        }
    }
}

/// A wavy surface among Gaussians, with soft places everywhere, as the reference has it.
TEST_ON(test_reference, 2) {
    static planes surface, out, slow;
    check_random random = {3};
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 400, 1, 5);
    for (int n = 0; n < 8; n++) {
        ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 50, SLANTED, 2.5);
        if (n % 4 == 3) camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 25;
        for (int i = 0; i < 12; i++) camera.world_to_camera[i] *= n % 4 == 2 ? 3 : 1;
        for (size_t i = 0; i < PIXELS; i++) {
            const bool there = check_uniform(&random, 0, 1) < 0.8;
            const float alpha = there ? (float)fmin(check_uniform(&random, 0, 1.5), 1) : 0;
            surface.depth[i] =
                there ? (float)((n % 4 == 2 ? 3 : 1) * (2.5 + 0.5 * sin((double)i * 0.1))) : INFINITY;
            surface.coverage[i] = there ? (float)check_uniform(&random, 0.1, 1.4) : 0;
            for (size_t k = 0; k < 4; k++) surface.rgba[4 * i + k] = alpha;
            for (size_t k = 0; k < 3; k++)
                surface.normal[3 * i + k] = there ? (float)check_uniform(&random, -1, 1) : 0;
        }
        ewa_gaussian_options options = options_over(&surface);
        options.projection = (ewa_gaussian_projection)(n % 2);
        options.minimum_transmittance = 0;
        options.depth = n < 4 ? EWA_DEPTH_MEDIAN : EWA_DEPTH_EXPECTED;
        const ewa_frame frame = frame_of(&out), reference = frame_of(&slow);
        draw_set(&set, &camera, &options, &frame);
        assert_int_equal(ewa_gaussian_render_reference(&set, &camera, &options, &reference),
                         EWA_OK);
        size_t apart = 0;
        double largest = 0, sum = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            const float *a = out.normal + 3 * i, *b = slow.normal + 3 * i;
            const bool near = out.depth[i] == slow.depth[i] || fabsf(out.depth[i] - slow.depth[i]) < 1e-3f;
            bool alike = true;
            for (int c = 0; c < 3; c++) alike = alike && fabsf(a[c] - b[c]) < 5e-3f;
            apart += !near || !alike;
            const double by = fabs((double)out.coverage[i] - (double)slow.coverage[i]);
            largest = fmax(largest, by), sum += by;
        }
        print_message("reference, %d: %.2f %% of depths apart, coverage %.2g at most, %.2g on the mean\n", n,
                      100.0 * (double)apart / PIXELS, largest, sum / PIXELS);
        assert_true(apart < PIXELS / 50 && largest < 0.02 && sum / PIXELS < 1e-3);
    }
}

/// A volume's reference, over the same kind of surface.
TEST_ON(test_volume_reference, 2) {
    static planes surface, out, slow;
    const ewa_camera camera = scene_camera(WIDTH, HEIGHT, SLANTED, 24);
    static const uint32_t dims[3] = {10, 12, 11};
    static const double width = 3;
    OWNED(ewa_volume_free)
    ewa_volume volume = scene_volume(context, dims, (const double[3]){1, 1, 1}, scene_blob, &width);
    const ewa_transfer transfer = scene_linear(0.9f, 0.3f, 0.1f, 0.4f);
    OWNED(ewa_voxels_destroy) ewa_voxels *voxels = scene_voxels(&volume, &transfer);
    make_ramp(&surface);
    for (size_t i = 0; i < PIXELS; i++) surface.depth[i] = i % 5 ? 20 + (float)(i / WIDTH) * 0.1f : INFINITY;
    const ewa_gaussian_options options = options_over(&surface);
    const ewa_frame frame = frame_of(&out), reference = frame_of(&slow);
    draw_voxels(context, voxels, &camera, &options, &frame);
    WITH_DEFAULTS(ewa_volume_options, plain);
    plain.surface_depth = surface.depth, plain.surface_rgba = surface.rgba;
    plain.surface_normal = surface.normal, plain.surface_coverage = surface.coverage;
    assert_int_equal(ewa_volume_render_reference(&volume, &transfer, &camera, &plain, &reference), EWA_OK);
    size_t apart = 0, own = 0;
    double largest = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const float *a = out.normal + 3 * i, *b = slow.normal + 3 * i;
        const bool near = out.depth[i] == slow.depth[i] || fabsf(out.depth[i] - slow.depth[i]) < 1;
        apart += !near || a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
        own += out.depth[i] == surface.depth[i];
        largest = fmax(largest, fabs((double)out.coverage[i] - (double)slow.coverage[i]));
    }
    print_message("a volume's reference: %zu of %d depths apart, coverage %.2g\n", apart, PIXELS, largest);
    assert_true(own > 1000 && own < PIXELS - 500 && apart < PIXELS / 50 && largest < 0.02);
}

/// A frame's planes are the same bytes whichever others are asked for; surfaces without normals have 0, without
/// coverage their alpha.
TEST_ON(test_null, 1) {
    static planes ramp, all, some, alphas;
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 50, SLANTED, 5);
    make_ramp(&ramp), make_ramp(&alphas);
    for (size_t i = 0; i < PIXELS; i++) {
        alphas.coverage[i] = ramp.rgba[4 * i + 3];
        for (size_t k = 0; k < 3; k++) alphas.normal[3 * i + k] = 0;
    }
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 200, 1, 5);
    OWNED(ewa_voxels_destroy) ewa_voxels *fog = make_fog(context, (const double[3]){0.3, 0, -0.5}, 3);
    for (int what = 0; what < 3; what++)
        for (int given = 0; given < 4; given++) {
            ewa_gaussian_options full = options_over(&ramp), options = full;
            if (given & 1) full.surface_normal = alphas.normal, options.surface_normal = NULL;
            if (given & 2) full.surface_coverage = alphas.coverage, options.surface_coverage = NULL;
            const ewa_frame whole = frame_of(&all);
            for (int n = 0; n < 33; n++) {
                ewa_frame frame = frame_of(&some);
                memset(&some, 0x5a, sizeof some);
                if (n & 1) frame.rgba8 = NULL;
                if (n & 2) frame.rgba = NULL;
                if (n & 4) frame.depth = NULL;
                if (n & 8) frame.normal = NULL;
                if (n & 16) frame.coverage = NULL;
                const ewa_frame *to = n == 32 ? &whole : &frame; // all of them, by the same options, last
                const ewa_gaussian_options *how = n == 0 ? &full : &options;
                if (n == 0) to = &whole;
                if (what == 0) draw_set(&set, &camera, how, to);
                if (what == 1) draw_voxels(context, fog, &camera, how, to);
                if (what == 2) draw_mixed(&set, fog, &camera, how, to);
                if (to == &whole) continue;
                if (frame.rgba8) assert_memory_equal(all.rgba8, some.rgba8, sizeof all.rgba8);
                if (frame.rgba) assert_memory_equal(all.rgba, some.rgba, sizeof all.rgba);
                if (frame.depth) assert_memory_equal(all.depth, some.depth, sizeof all.depth);
                if (frame.normal) assert_memory_equal(all.normal, some.normal, sizeof all.normal);
                if (frame.coverage) assert_memory_equal(all.coverage, some.coverage, sizeof all.coverage);
            }
            if (given & 1 && what == 1)
                for (size_t i = 0; i < 3 * PIXELS; i++) assert_true(all.normal[i] == 0);
        }
    // Fog without surfaces has no normals, Gaussians have unit ones.
    const ewa_gaussian_options plain = options_over(NULL);
    const ewa_frame frame = {.normal = some.normal};
    memset(&some, 0x5a, sizeof some);
    draw_voxels(context, fog, &camera, &plain, &frame);
    for (size_t i = 0; i < 3 * PIXELS; i++) assert_true(some.normal[i] == 0);
    draw_mixed(&set, fog, &camera, &plain, &frame);
    size_t unit = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const float *n = some.normal + 3 * i, square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        assert_true(square == 0 || fabsf(square - 1) < 1e-5f);
        unit += square > 0;
    }
    assert_true(unit > PIXELS / 20);
}

/// Threads and instruction sets change no byte.
TEST(test_bytes) {
    static const uint32_t masks[3] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    static planes scan, first[3], out;
    for (int n = 0; n < 6; n++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(n % 2 ? 5 : 1, masks[n / 2]);
        const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, SLANTED, 3);
        OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 500, 1, 5);
        OWNED(ewa_voxels_destroy) ewa_voxels *fog = make_fog(context, (const double[3]){0.3, 0, -1}, 3);
        draw_scan(context, &camera, 0.6, &scan);
        const ewa_gaussian_options options = options_over(&scan);
        const ewa_frame frame = frame_of(&out);
        for (int what = 0; what < 3; what++) {
            memset(&out, 0, sizeof out);
            if (what == 0) draw_set(&set, &camera, &options, &frame);
            if (what == 1) draw_voxels(context, fog, &camera, &options, &frame);
            if (what == 2) draw_mixed(&set, fog, &camera, &options, &frame);
            if (n == 0) first[what] = out;
            assert_memory_equal(&first[what], &out, sizeof out);
        }
    }
}

/// Eye-dome lighting of a finished picture: of surfaces that of ewa_render(), to the byte; a sheet of Gaussians some way
/// before a wall darkens the wall beside it.
TEST_ON(test_eye_dome, 2) {
    static planes whole, plain;
    WITH_DEFAULTS(ewa_render_options, how);
    const float background[4] = {0.2f, 0.5f, 0.9f, 0.75f};
    for (int n = 0; n < 2; n++) {
        ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, SLANTED, 3);
        if (n) camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 25;
        how.eye_dome = 0.7;
        memcpy(how.background, background, sizeof background);
        draw_scan_by(context, &camera, &how, &whole);
        how.eye_dome = 0;
        memset(how.background, 0, sizeof how.background);
        draw_scan_by(context, &camera, &how, &plain);
        const ewa_frame frame = frame_of(&plain);
        assert_memory_not_equal(whole.rgba, plain.rgba, sizeof whole.rgba);
        assert_int_equal(ewa_eye_dome_apply(context, &camera, 0.7, background, &frame), EWA_OK);
        assert_memory_equal(whole.rgba, plain.rgba, sizeof whole.rgba);
        assert_memory_equal(whole.rgba8, plain.rgba8, sizeof whole.rgba8);
    }
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 30, FRONT, 5);
    make_ramp(&whole);
    for (size_t i = 0; i < 4 * PIXELS; i++) whole.rgba[i] = 1;
    OWNED(ewa_gaussians_free)
    ewa_gaussians set = gaussians_one(context, (const double[3]){0, 0, -1}, (const double[3]){0.3, 0.3, 0.01},
                                      ROUND, 0.95, (const double[3]){1, 1, 1});
    const ewa_gaussian_options options = options_over(&whole);
    const ewa_frame frame = frame_of(&plain);
    draw_set(&set, &camera, &options, &frame);
    assert_int_equal(ewa_eye_dome_apply(context, &camera, 1, (const float[4]){0}, &frame), EWA_OK);
    float minimum = 1;
    for (size_t i = 0; i < PIXELS; i++) minimum = fminf(minimum, plain.rgba[4 * i]);
    assert_true(minimum < 0.7f);
    assert_true(fabsf(plain.rgba[0] - 1) < 1e-3f && fabsf(plain.rgba[4 * (35 * WIDTH + 45)] - 1) < 1e-2f);
}

/// Planes of a surface that is not given.
TEST(test_bad) {
    static planes ramp, out;
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    const ewa_camera camera = gaussians_camera(WIDTH, HEIGHT, 40, FRONT, 3);
    make_ramp(&ramp);
    OWNED(ewa_gaussians_free) ewa_gaussians set = gaussians_random(context, 10, 0, 5);
    OWNED(ewa_splats_destroy) ewa_splats *splats;
    OWNED(ewa_gaussian_renderer_destroy) ewa_gaussian_renderer *renderer;
    assert_int_equal(ewa_splats_create(&set, false, &splats), EWA_OK);
    assert_int_equal(ewa_gaussian_renderer_create(context, &renderer), EWA_OK);
    const ewa_frame frame = frame_of(&out);
    static const char *const words[4] = {"surface_depth without", "surface_rgba without",
                                         "surface_normal without", "surface_coverage without"};
    for (int n = 0; n < 4; n++) {
        ewa_gaussian_options options = options_over(NULL);
        if (n == 0) options.surface_depth = ramp.depth;
        if (n == 1) options.surface_rgba = ramp.rgba;
        if (n == 2) options.surface_normal = ramp.normal;
        if (n == 3) options.surface_coverage = ramp.coverage;
        assert_int_equal(ewa_gaussian_render(renderer, splats, &camera, &options, &frame, NULL),
                         EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log.text, words[n]));
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
