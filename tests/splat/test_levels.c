// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/surface/levels.c and groups_body.h: levels of detail are closed, keep colours, and do not depend on
// anything that pictures do not depend on.
#include "splat/level_scene.h"
#include "surface/levels.h"

#include <math.h>

enum { SIDE_PX = 256, PIXELS = SIDE_PX * SIDE_PX, POINTS = 40000 };

static ewa_surfels *surfels_of(const ewa_cloud *cloud, uint32_t level_count) {
    WITH_DEFAULTS(ewa_surfels_options, options);
    options.level_count = level_count;
    ewa_surfels *surfels = check_surfels(cloud, &options);
    return surfels;
}

static uint32_t level_count_of(const ewa_surfels *surfels) {
    ewa_surfels_info info;
    ewa_surfels_describe(surfels, &info);
    return info.level_count;
}

static ewa_render_stats draw(ewa_context *context, const ewa_surfels *surfels, const ewa_camera *camera,
                             uint32_t level, const ewa_frame *frame) {
    ewa_render_options options;
    ewa_render_stats stats;
    ewa_render_options_init(&options, sizeof options);
    options.level = level;
    ewa_renderer *renderer = check_renderer(context);
    assert_int_equal(ewa_render(renderer, surfels, camera, &options, frame, &stats), EWA_OK);
    ewa_renderer_destroy(&renderer);
    return stats;
}

static void assert_same_level(const ewa_surfels *a, const ewa_surfels *b) {
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->packet_count, b->packet_count);
    assert_memory_equal(a->packets, b->packets, a->packet_count * sizeof *a->packets);
    assert_memory_equal(a->bounds_memory, b->bounds_memory, a->bounds_stride * EWA_BOUNDS_BYTES);
    assert_true(a->unit_coverage == b->unit_coverage);
}

TEST_ON(test_first_level_is_all_surfels, 2) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_SPHERE, POINTS);
    OWNED(ewa_surfels_destroy) ewa_surfels *plain = surfels_of(cloud, 1), *levels = surfels_of(cloud, EWA_MAX_LEVELS);
    assert_same_level(plain, levels);
    assert_null(plain->coarser);
    assert_int_equal(level_count_of(plain), 1);
    assert_int_equal(level_count_of(levels), 3);
    ewa_surfels_info one, all;
    ewa_surfels_describe(plain, &one);
    ewa_surfels_describe(levels, &all);
    assert_true(all.resident_bytes > one.resident_bytes && all.resident_bytes < 1.5 * one.resident_bytes);
    static uint8_t pictures[2][4 * PIXELS];
    const ewa_camera camera = level_camera(SIDE_PX, SIDE_PX, 2.2, 20);
    draw(context, plain, &camera, 0, &(ewa_frame){.rgba8 = pictures[0]});
    const ewa_render_stats stats = draw(context, levels, &camera, 0, &(ewa_frame){.rgba8 = pictures[1]});
    assert_int_equal(stats.level, 0);
    assert_int_equal(stats.splat_count, POINTS);
    assert_memory_equal(pictures[0], pictures[1], sizeof pictures[0]);
}

/// Every pixel inside of a closed surface is opaque, at every level, from near and far, from above and aslant.
TEST_ON(test_levels_are_closed, 2) {
    static const double distances[] = {0.4, 1.3, 4}, tilts[] = {0, 40, 65};
    static uint8_t rgba8[4 * PIXELS];
    for (int kind = 0; kind < LEVEL_KINDS; kind++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, (level_kind)kind, POINTS);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, EWA_MAX_LEVELS);
        const uint32_t levels = level_count_of(surfels);
        assert_true(levels >= 3);
        for (uint32_t level = 1; level < levels; level++) {
            uint32_t found = level;
            const ewa_surfels *drawn = ewa_levels_find(surfels, &found);
            const double reach = drawn->cutoff * drawn->largest_sigmas_world[0];
            const double margin = fmin(0.3, fmax(0.05, 2 * reach));
            uint64_t inside = 0;
            for (int v = 0; v < 9; v++) {
                const ewa_camera camera =
                    level_camera(SIDE_PX, SIDE_PX, (kind == LEVEL_SPHERE) + distances[v / 3], tilts[v % 3]);
                assert_int_equal(draw(context, surfels, &camera, level, &(ewa_frame){.rgba8 = rgba8}).level,
                                 level);
                for (uint32_t i = 0; i < PIXELS; i++) {
                    if (!level_inside((level_kind)kind, &camera, i % SIDE_PX, i / SIDE_PX, margin)) continue;
                    inside++;
                    if (rgba8[4 * i + 3] != 255)
                        fail_msg("%s, level %u, view %d: alpha %u at %u, %u", level_names[kind], level, v,
                                 rgba8[4 * i + 3], i % SIDE_PX, i / SIDE_PX);
                }
            }
            assert_true(inside > PIXELS);
        }
    }
}

/// The same cloud with its points in another order.
static ewa_cloud *shuffled(ewa_context *context, const ewa_cloud *of) {
    static const char *const names[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS, EWA_BORDER, EWA_COLOR};
    const uint64_t count = ewa_cloud_point_count(of);
    ewa_cloud *made = check_cloud_of(context, count);
    for (int k = 0; k < 5; k++) {
        const ewa_attribute *from = ewa_cloud_find(of, names[k]);
        if (!from) continue; // no borders where nothing ends
        void *to = NULL;
        assert_int_equal(ewa_cloud_add(made, names[k], from->type, from->component_count, &to), EWA_OK);
        const size_t bytes = from->component_count * (k == 4 ? 1 : sizeof(float));
        for (uint64_t i = 0; i < count; i++)
            memcpy((char *)to + i * bytes,
                   (const char *)from->data + (i * 7919 + 13) % count * from->stride_bytes, bytes);
    }
    return made;
}

TEST(test_same_bytes) {
    static const struct {
        uint32_t threads, cpu_mask;
    } ways[] = {{2, EWA_CPU_ALL}, {3, EWA_CPU_AVX2}, {1, EWA_CPU_ALL}};
    OWNED(ewa_context_destroy) ewa_context *plain = check_context_of(1, 0);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(plain, LEVEL_WHITE, POINTS);
    OWNED(ewa_surfels_destroy) ewa_surfels *expected = surfels_of(cloud, EWA_MAX_LEVELS);
    for (int i = 0; i < 3; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context_of(ways[i].threads, ways[i].cpu_mask);
        OWNED(ewa_cloud_destroy) ewa_cloud *other = shuffled(context, cloud);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(other, EWA_MAX_LEVELS);
        const ewa_surfels *a = expected, *b = surfels;
        for (; a && b; a = a->coarser, b = b->coarser) assert_same_level(a, b);
        assert_true(!a && !b);
    }
}

/// Sums over a level, weighted by area: what a picture from far away shows.
static void mean_color(const ewa_surfels *surfels, double mean[4]) {
    double area = 0;
    for (int c = 0; c < 4; c++) mean[c] = 0;
    for (uint32_t p = 0; p < surfels->packet_count; p++)
        for (uint32_t lane = 0; lane < EWA_PACKET_LANES; lane++) {
            ewa_packet_surfel surfel;
            if (!(surfels->packets[p].sigma[lane] > 0)) continue;
            ewa_packet_decode(surfels, p, lane, &surfel);
            const double here = vec3_length(surfel.axis_u) * vec3_length(surfel.axis_v);
            area += here;
            for (int c = 0; c < 3; c++) mean[c] += here * surfel.color[c] * surfel.opacity;
            mean[3] += here * surfel.opacity;
        }
    for (int c = 0; c < 4; c++) mean[c] /= area;
}

TEST_ON(test_colors_are_kept, 2) {
    for (int constant = 0; constant < 2; constant++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_EVEN, POINTS);
        const uint64_t count = ewa_cloud_point_count(cloud);
        ewa_cloud_remove(cloud, EWA_COLOR);
        float *rgba = check_add(cloud, EWA_COLOR, EWA_F32, 4);
        check_random random = {5};
        for (uint64_t i = 0; i < 4 * count; i++)
            rgba[i] = constant ? (float)(i % 4 + 1) / 8 : (float)check_uniform(&random, 0, 1);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, EWA_MAX_LEVELS);
        double first[4], mean[4];
        mean_color(surfels, first);
        for (const ewa_surfels *level = surfels->coarser; level; level = level->coarser) {
            mean_color(level, mean);
            for (int c = 0; c < 4; c++) assert_true(fabs(mean[c] - first[c]) < (constant ? 2e-4 : 0.02));
        }
    }
}

/// A picture of a budget's level is that of the level itself; what is beyond the last one is the last one.
TEST_ON(test_budget_draws_a_level, 2) {
    static uint8_t pictures[2][4 * PIXELS];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_GRID, POINTS);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, EWA_MAX_LEVELS);
    const ewa_camera camera = level_camera(SIDE_PX, SIDE_PX, 1.5, 30);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    static const double budgets_s[] = {1e-9, 1e-3, 1e15};
    for (int i = 0; i < 9; i++) {
        ewa_render_options options;
        ewa_render_stats stats;
        ewa_render_options_init(&options, sizeof options);
        options.budget_s = budgets_s[i / 3];
        options.level = (uint32_t)i % 3;
        assert_int_equal(
            ewa_render(renderer, surfels, &camera, &options, &(ewa_frame){.rgba8 = pictures[0]}, &stats),
            EWA_OK);
        assert_true(stats.level >= options.level);
        draw(context, surfels, &camera, stats.level, &(ewa_frame){.rgba8 = pictures[1]});
        assert_memory_equal(pictures[0], pictures[1], sizeof pictures[0]);
    }
    assert_int_equal(draw(context, surfels, &camera, 7, &(ewa_frame){.rgba8 = pictures[0]}).level, 2);
}

/// Discs at `places`, of one radius, whose normals point up.
static ewa_cloud *discs_at(ewa_context *context, uint32_t count, const double (*places)[3], float size) {
    ewa_cloud *cloud = check_cloud_of(context, count);
    double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    for (uint32_t i = 0; i < count; i++) {
        memcpy(position + 3 * (size_t)i, places[i], sizeof places[i]);
        normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = 1;
        radius[i] = size;
    }
    return cloud;
}

TEST_ON(test_few_points, 2) {
    static const uint32_t counts[] = {0, 1, 3, 5, 15, 17, 1023, 1024, 4095, 4096, 4200, 5000};
    static double places[5000][3];
    for (uint32_t i = 0; i < 5000; i++) places[i][0] = i % 71, places[i][1] = i / 71, places[i][2] = 0;
    for (int i = 0; i < 12; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = discs_at(context, counts[i], (const double(*)[3])places, 1.14f);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, EWA_MAX_LEVELS);
        const uint32_t levels = level_count_of(surfels);
        assert_true(counts[i] > 1024 || levels == 1);
        assert_true(counts[i] < 4200 || levels == 2);
        assert_true(!surfels->coarser || surfels->coarser->count >= 1024);
    }
}

/// Points upon each other do not grow; two patches far from each other stay what each of them is alone.
TEST_ON(test_odd_places, 2) {
    enum { COUNT = 20000, HALF = COUNT / 2 };
    static double places[COUNT][3];
    for (int i = 0; i < COUNT; i++) places[i][0] = 5, places[i][1] = -3, places[i][2] = 1;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = discs_at(context, COUNT, (const double(*)[3])places, 1);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, EWA_MAX_LEVELS);
    assert_non_null(surfels->coarser);
    for (const ewa_surfels *level = surfels; level; level = level->coarser)
        assert_true(level->largest_sigmas_world[0] == surfels->largest_sigmas_world[0]);
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
    for (int i = 0; i < COUNT; i++) {
        const int k = i % HALF;
        places[i][0] = (i < HALF ? -1e5 : 1e5) + 1e-4 * (k % 100), places[i][1] = 1e-4 * (k / 100.0);
        places[i][2] = i < HALF ? 1e5 : -1e5;
    }
    cloud = discs_at(context, COUNT, (const double(*)[3])places, 1.14e-4f);
    surfels = surfels_of(cloud, EWA_MAX_LEVELS);
    assert_non_null(surfels->coarser);
    for (const ewa_surfels *level = surfels; level; level = level->coarser) {
        assert_true(level->largest_sigmas_world[0] < 1e-2);
        assert_true(level->reach_world < 1); // no packet holds surfels of both
    }
    ewa_surfels_destroy(&surfels);
    ewa_cloud_destroy(&cloud);
    for (int i = 0; i < COUNT; i++) // farther apart than any packet may reach
        for (int c = 0; c < 3; c++) places[i][c] = 1e30 * ((i * (7 + c)) % COUNT - COUNT / 2);
    cloud = discs_at(context, COUNT, (const double(*)[3])places, 1e-20f);
    surfels = surfels_of(cloud, EWA_MAX_LEVELS);
}

/// Clip lines stay where they are in the world; materials are some member's; opacities are means.
TEST_ON(test_extras, 2) {
    enum { SIDE = 128, COUNT = SIDE * SIDE };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, COUNT);
    float *position = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    float *u = check_add(cloud, EWA_TANGENT_U, EWA_F32, 3);
    float *v = check_add(cloud, EWA_TANGENT_V, EWA_F32, 3);
    float *clip = check_add(cloud, EWA_CLIP0, EWA_F32, 3);
    float *rgba = check_add(cloud, EWA_COLOR, EWA_F32, 4);
    uint8_t *material = check_add(cloud, EWA_MATERIAL, EWA_U8, 1);
    const float sigma = 0.4f;
    for (int i = 0; i < COUNT; i++) {
        float *const p = position + 3 * i;
        p[0] = (float)(i % SIDE), p[1] = (float)(i / SIDE), p[2] = 0;
        for (int c = 0; c < 3; c++) u[3 * i + c] = sigma * (c == 0), v[3 * i + c] = 0.8f * sigma * (c == 1);
        // The surface ends at x = 100.25.
        const bool cut = fabsf(p[0] - 100.25f) < 3;
        clip[3 * i] = cut ? -sigma : 0, clip[3 * i + 1] = 0, clip[3 * i + 2] = cut ? 100.25f - p[0] : 0;
        for (int c = 0; c < 4; c++) rgba[4 * i + c] = 0.5f;
        material[i] = p[1] < 60 ? 3 : 9;
    }
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, 3);
    assert_non_null(surfels->coarser);
    for (const ewa_surfels *level = surfels; level; level = level->coarser) {
        uint64_t clips = 0;
        for (uint32_t p = 0; p < level->packet_count; p++)
            for (uint32_t lane = 0; lane < EWA_PACKET_LANES; lane++) {
                ewa_packet_surfel surfel;
                if (!(level->packets[p].sigma[lane] > 0)) continue;
                ewa_packet_decode(level, p, lane, &surfel);
                const ewa_vec3 at =
                    vec3_scale(vec3_add(ewa_packet_center(level, p), surfel.offset), level->unit);
                const size_t i = (size_t)p * EWA_PACKET_LANES + lane;
                assert_int_equal(level->materials[i], at.y < 59.5   ? 3
                                                      : at.y > 60.5 ? 9
                                                                    : level->materials[i]);
                assert_true(abs((int)level->opacities[i] - 32768) <= 1);
                if (!(level->clip_masks[p] >> lane & 1)) continue;
                const uint32_t before =
                    (uint32_t)__builtin_popcount(level->clip_masks[p] & ((1u << lane) - 1));
                const ewa_surfel_clip *line = &level->clips[level->clip_first[p] + before];
                clips++;
                assert_true(fabs((double)line->toward[0][0] + 1) < 1e-6);
                assert_true(fabs((double)line->offset[0] * level->unit - (100.25 - at.x)) < 1e-4);
            }
        assert_int_equal(clips, level->clip_count);
        assert_true(clips >= 6 * SIDE / (level == surfels ? 1u : 40u));
    }
    assert_int_equal(surfels->coarser->max_material, 9);
}

/// Callers of before levels have smaller structs, and no levels.
TEST_ON(test_older_callers, 1) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_GRID, POINTS);
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, offsetof(ewa_surfels_options, level_count));
    options.level_count = 77; // beyond its struct
    ewa_surfels *surfels = check_surfels(cloud, &options);
    assert_int_equal(level_count_of(surfels), 1);
    ewa_surfels_destroy(&surfels);
    ewa_surfels_options_init(&options, sizeof options);
    options.level_count = EWA_MAX_LEVELS + 1;
    assert_int_equal(ewa_surfels_create(cloud, &options, &surfels), EWA_ERROR_ARGUMENT);
}

/// Whichever allocation fails, nothing is left behind.
TEST(test_out_of_memory) {
    OWNED(ewa_context_destroy) ewa_context *plain = check_context(1, NULL);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(plain, LEVEL_GRID, 6000);
    for (long call = 0;; call++) {
        check_memory memory = {.calls_left = -1};
        ewa_context *context = check_context_on(1, &memory);
        ewa_cloud *own = shuffled(context, cloud);
        const int64_t held = memory.held_bytes;
        WITH_DEFAULTS(ewa_surfels_options, surfels_options);
        surfels_options.level_count = 2;
        ewa_surfels *surfels = NULL;
        memory.calls_left = call;
        const ewa_status status = ewa_surfels_create(own, &surfels_options, &surfels);
        assert_true(status == EWA_OK || status == EWA_ERROR_MEMORY);
        memory.calls_left = -1;
        ewa_surfels_destroy(&surfels);
        assert_int_equal(memory.held_bytes, held);
        ewa_cloud_destroy(&own);
        ewa_context_destroy(&context);
        if (status == EWA_OK) break;
    }
}

/// Stops the call that is told of its progress for that many times.
static bool stop_after(void *user, const char *stage, double fraction) {
    (void)stage, (void)fraction;
    int *left = user;
    return *left < 0 || (*left)-- > 0;
}

TEST(test_cancelled_frame_changes_nothing) {
    static uint8_t pictures[2][4 * PIXELS];
    int left = -1;
    OWNED(ewa_context_destroy) ewa_context *context = check_context_telling(2, stop_after, &left);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_SPHERE, POINTS);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = surfels_of(cloud, 2);
    const ewa_camera camera = level_camera(SIDE_PX, SIDE_PX, 2.2, 20);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const ewa_frame frames[2] = {{.rgba8 = pictures[0]}, {.rgba8 = pictures[1]}};
    assert_int_equal(ewa_render(renderer, surfels, &camera, NULL, &frames[0], NULL), EWA_OK);
    for (int calls = 0; calls < 4; calls++) {
        left = calls;
        const ewa_status status = ewa_render(renderer, surfels, &camera, NULL, &frames[1], NULL);
        // It is told at the beginning and at the end, and between only where this thread draws a tile.
        if (calls < 2 || status != EWA_OK) assert_int_equal(status, EWA_CANCELLED);
        left = -1;
        assert_int_equal(ewa_render(renderer, surfels, &camera, NULL, &frames[1], NULL), EWA_OK);
        assert_memory_equal(pictures[0], pictures[1], sizeof pictures[0]);
    }
}

/// What is said of a frame is its coarsest part: 0 says that all surfels were drawn.
TEST_ON(level_of_several_sources, 2) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = level_cloud(context, LEVEL_SPHERE, POINTS);
    ewa_surfels *sources[2] = {surfels_of(cloud, 1), surfels_of(cloud, EWA_MAX_LEVELS)};
    const ewa_camera camera = level_camera(SIDE_PX, SIDE_PX, 2.2, 20);
    static uint8_t picture[4 * PIXELS];
    ewa_renderer *renderer = check_renderer(context);
    for (int count = 0; count <= 2; count++) {
        ewa_render_options options;
        ewa_render_stats stats;
        ewa_render_options_init(&options, sizeof options);
        options.level = 2;
        assert_int_equal(ewa_render_begin(renderer, &camera, &options, &(ewa_frame){.rgba8 = picture}),
                         EWA_OK);
        for (int i = 0; i < count; i++) assert_int_equal(ewa_render_add(renderer, sources[i]), EWA_OK);
        assert_int_equal(ewa_render_finish(renderer, &stats), EWA_OK);
        assert_int_equal(stats.level, count == 2 ? 2 : 0);
    }
    ewa_renderer_destroy(&renderer);
    for (int i = 0; i < 2; i++) ewa_surfels_destroy(&sources[i]);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
