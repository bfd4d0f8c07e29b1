// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Section planes: known answers, the fast pipeline against the reference in every mode, the same bytes
// whatever the threads, instruction sets, order, origin and length of normals; what is refused.
#include "tests/splat/picture.h"

#include <math.h>
#include <time.h>

enum { POINTS = 1200, SIDE = 160, GRID = 20, CELL_PX = 8 };

static ewa_render_options plain_options(void) {
    WITH_DEFAULTS(ewa_render_options, options);
    assert_true(options.section_count == 0);
    return options;
}

static void add_plane(ewa_render_options *options, double a, double b, double c, double d) {
    const double plane[4] = {a, b, c, d};
    memcpy(options->section_planes[options->section_count++], plane, sizeof plane);
}

/// Six planes around a cube.
static void add_box(ewa_render_options *options, double low, double high) {
    for (int axis = 0; axis < 3; axis++) {
        add_plane(options, axis == 0, axis == 1, axis == 2, -low);
        add_plane(options, -(axis == 0), -(axis == 1), -(axis == 2), high);
    }
}

/// A grid of discs around (0, 0, 0) + `origin` in x and y that face an eye at z = -1 and do not touch, `spacing`
/// apart, in the order of `seed`.
static ewa_cloud *make_grid(ewa_context *context, double spacing, const double origin[3], uint64_t seed) {
    ewa_cloud *cloud = check_cloud_of(context, GRID * GRID);
    double *position = check_add(cloud, EWA_POSITION, EWA_F64, 3);
    float *normal = check_add(cloud, EWA_NORMAL, EWA_F32, 3);
    float *radius = check_add(cloud, EWA_RADIUS, EWA_F32, 1);
    ewa_cloud_set_origin(cloud, origin);
    for (uint32_t i = 0; i < GRID * GRID; i++) {
        const uint32_t at = (uint32_t)((i * (2 * seed + 1)) % (GRID * GRID)); // 2 seed + 1 is coprime to 400
        position[3 * i] = (at % GRID - (GRID - 1) / 2.0) * spacing;
        position[3 * i + 1] = ((double)(at / GRID) - (GRID - 1) / 2.0) * spacing;
        position[3 * i + 2] = 0;
        normal[3 * i] = normal[3 * i + 1] = 0, normal[3 * i + 2] = -1;
        radius[i] = (float)(0.375 * spacing);
    }
    return cloud;
}

/// A camera that sees the grid's discs CELL_PX apart from above `origin`.
static ewa_camera make_camera(bool orthographic, double spacing, const double origin[3]) {
    ewa_camera camera = check_camera(SIDE, SIDE);
    camera.cx_px = camera.cy_px = SIDE / 2;
    camera.fx_px = camera.fy_px = CELL_PX / spacing;
    if (orthographic) camera.projection = EWA_ORTHOGRAPHIC;
    camera.world_to_camera[3] = -origin[0];
    camera.world_to_camera[7] = -origin[1];
    camera.world_to_camera[11] = 1 - origin[2];
    return camera;
}

typedef struct drawn {
    float rgba[4 * SIDE * SIDE], depth[SIDE * SIDE], normal[3 * SIDE * SIDE];
    uint8_t rgba8[4 * SIDE * SIDE];
    ewa_render_stats stats;
} drawn;

/// Draws sources twice, as a warm renderer draws.
static void draw_sources(ewa_context *context, const ewa_surfels *const *surfels, int count,
                         const ewa_camera *camera, const ewa_render_options *options, drawn *to) {
    ewa_renderer *renderer = check_renderer(context);
    const ewa_frame frame = {.rgba = to->rgba, .depth = to->depth, .normal = to->normal, .rgba8 = to->rgba8};
    for (int turn = 0; turn < 2; turn++) {
        assert_int_equal(ewa_render_begin(renderer, camera, options, &frame), EWA_OK);
        for (int i = 0; i < count; i++) assert_int_equal(ewa_render_add(renderer, surfels[i]), EWA_OK);
        assert_int_equal(ewa_render_finish(renderer, &to->stats), EWA_OK);
    }
    ewa_renderer_destroy(&renderer);
}

static void draw(ewa_context *context, const ewa_cloud *cloud, const ewa_camera *camera,
                 const ewa_render_options *options, drawn *to) {
    ewa_surfels *surfels = check_surfels(cloud, NULL);
    const ewa_surfels *const sources[] = {surfels};
    draw_sources(context, sources, 1, camera, options, to);
    ewa_surfels_destroy(&surfels);
}

static void assert_same(const drawn *a, const drawn *b, const char *what) {
    if (memcmp(a->rgba, b->rgba, sizeof a->rgba) || memcmp(a->depth, b->depth, sizeof a->depth) ||
        memcmp(a->normal, b->normal, sizeof a->normal) || memcmp(a->rgba8, b->rgba8, sizeof a->rgba8))
        fail_msg("%s: other bytes", what);
}

/// How far the disc of a grid's cell lies inside of all planes, in spacings.
static double inside_of(const ewa_render_options *options, int column, int row, double spacing) {
    const double x = (column - (GRID - 1) / 2.0) * spacing, y = (row - (GRID - 1) / 2.0) * spacing;
    double minimum = INFINITY;
    for (uint32_t k = 0; k < options->section_count; k++) {
        const double *p = options->section_planes[k];
        minimum = fmin(minimum, (p[0] * x + p[1] * y + p[3]) / hypot(hypot(p[0], p[1]), p[2]) / spacing);
    }
    return minimum;
}

/// Exactly the discs inside are drawn, and nothing else.
static void check_grid(const ewa_render_options *options, double spacing, const drawn *to) {
    double sum = 0, left = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++) sum += (double)to->rgba[4 * i + 3];
    for (int row = 0; row < GRID; row++)
        for (int column = 0; column < GRID; column++) {
            const bool inside = inside_of(options, column, row, spacing) >= 0;
            for (int y = 0; y < CELL_PX; y++)
                for (int x = 0; x < CELL_PX; x++) {
                    const size_t pixel = (size_t)((row * CELL_PX + y) * SIDE + column * CELL_PX + x);
                    const float alpha = to->rgba[4 * pixel + 3];
                    if (!inside) left += (double)alpha;
                    if (inside && (x == 3 || x == 4) && (y == 3 || y == 4)) assert_true(alpha > 0.99f);
                }
        }
    assert_true(sum > 0 && left == 0);
}

/// Pixels outside of the planes are empty, those inside as in the whole picture.
static void check_cut(const ewa_render_options *options, double spacing, const drawn *whole,
                      const drawn *to) {
    int inside_count = 0, outside_count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const size_t pixel = (size_t)(y * SIDE + x);
            double inside_px = INFINITY;
            for (uint32_t k = 0; k < options->section_count; k++) {
                const double *p = options->section_planes[k];
                const double x_world = (x + 0.5 - SIDE / 2) / CELL_PX * spacing,
                             y_world = (y + 0.5 - SIDE / 2) / CELL_PX * spacing;
                const double distance = (p[0] * x_world + p[1] * y_world + p[3]) / hypot(p[0], p[1]);
                inside_px = fmin(inside_px, distance / spacing * CELL_PX);
            }
            const double alpha = (double)to->rgba[4 * pixel + 3], was = (double)whole->rgba[4 * pixel + 3];
            if (fabs(inside_px) < 0.75) continue; // the line goes through
            assert_true(inside_px > 0 ? fabs(alpha - was) < 1e-5 : alpha == 0);
            if (was == 1) inside_px > 0 ? inside_count++ : outside_count++;
        }
    assert_true(inside_count > 100 && outside_count > 100);
}

TEST_ON(test_grid, 2) {
    static const double none[3] = {0, 0, 0};
    static const double planes[][4] = {{1, 0, 0, 0},          {0, -1, 0, 0.25},      {3, 4, 0, -5.25},
                                       {1, 1, 0, 0.125},      {-1, 0.5, 7, 0.03125}, {1e-300, 0, 0, 0},
                                       {0, -1e300, 0, 2e300}, {0, 1e-320, 0, 0}};
    static drawn whole, to;
    const double spacing = 1;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_grid(context, spacing, none, 0);
    for (int way = 0; way < 2 * 2; way++)
        for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++) {
            const ewa_camera camera = make_camera(way & 1, spacing, none);
            ewa_render_options options = plain_options();
            options.point_size_px = way & 2 ? 3 : 0;
            draw(context, cloud, &camera, &options, &whole);
            add_plane(&options, planes[i][0], planes[i][1], planes[i][2], planes[i][3]);
            draw(context, cloud, &camera, &options, &to);
            if (way & 2)
                check_grid(&options, spacing, &to);
            else
                check_cut(&options, spacing, &whole, &to);
            assert_true(to.stats.culled_count > 0 && to.stats.culled_count < GRID * GRID);
        }
}

/// A box in the middle of a grid; nothing of one beside it.
TEST_ON(test_box, 2) {
    static const double none[3] = {0, 0, 0};
    static drawn to;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_grid(context, 1, none, 0);
    const ewa_camera camera = make_camera(false, 1, none);
    ewa_render_options options = plain_options();
    add_box(&options, -3, 3);
    draw(context, cloud, &camera, &options, &to);
    check_grid(&options, 1, &to);
    options.section_count = 0;
    add_box(&options, 100, 200);
    options.background[0] = options.background[3] = 0.5f;
    draw(context, cloud, &camera, &options, &to);
    assert_true(to.stats.culled_count == to.stats.splat_count && to.stats.drawn_count == 0);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        assert_true(to.rgba[4 * i] == 0.25f && to.rgba[4 * i + 3] == 0.5f && isinf(to.depth[i]));
}

/// The scenes of the other tests, cut by some planes that are not along an axis.
static void add_oblique(ewa_render_options *options, const scene *of, uint32_t count) {
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(of->cloud, &bounds), EWA_OK);
    static const double normals[3][3] = {{1, 0.3, -0.2}, {-0.4, 2, 0.5}, {0.1, 0.2, -1}};
    for (uint32_t k = 0; k < count; k++) {
        double d = 0, reach = 0;
        for (int c = 0; c < 3; c++) {
            d -= normals[k][c] * 0.5 * (bounds.low_world[c] + bounds.high_world[c]);
            reach += fabs(normals[k][c]) * (bounds.high_world[c] - bounds.low_world[c]);
        }
        add_plane(options, normals[k][0], normals[k][1], normals[k][2], d + 0.1 * reach);
    }
}

static void hold(scene_kind kind, const ewa_render_options *options, uint32_t planes, bool orthographic,
                 const char *what) {
    ewa_context *context = check_context(0, NULL);
    scene of = picture_measured_scene(context, kind, POINTS, NULL);
    if (strstr(what, "own lines")) picture_add_clips(of.cloud);
    ewa_render_options cut = *options;
    add_oblique(&cut, &of, planes);
    char name[96];
    snprintf(name, sizeof name, "%s, %s", scene_name(kind), what);
    picture_hold(&of, &cut, orthographic, name);
    scene_free(&of);
    ewa_context_destroy(&context);
}

TEST(test_pipeline_holds) {
    static const char *const names[] = {"perspective", "affine", "source", "circular", "raycast"};
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        ewa_render_options options = plain_options();
        hold((scene_kind)kind, &options, 1, false, "one plane");
        hold((scene_kind)kind, &options, 3, true, "three planes, orthographic");
        options.opacity = 0.5;
        hold((scene_kind)kind, &options, 2, false, "two planes, transparent");
    }
    static const scene_kind kinds[] = {SCENE_ELLIPSES, SCENE_NEAR, SCENE_SPHERE};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        ewa_render_options options = plain_options();
        for (int kernel = 0; kernel < 5; kernel++) {
            options.kernel = (ewa_kernel)kernel;
            hold(kinds[i], &options, 2, false, names[kernel]);
        }
        options = plain_options();
        hold(kinds[i], &options, 3, false, "three planes");
        if (kinds[i] != SCENE_SPHERE) { // which has no tangent axes
            hold(kinds[i], &options, 3, false, "three planes and own lines");
            hold(kinds[i], &options, 3, true, "three planes and own lines, orthographic");
        }
        options.cull = EWA_CULL_BACK;
        hold(kinds[i], &options, 2, false, "front only");
        options = plain_options();
        options.point_size_px = 4;
        hold(kinds[i], &options, 2, false, "points");
        options = plain_options();
        options.edge_layers = 1, options.eye_dome = 1;
        hold(kinds[i], &options, 2, true, "eye-dome");
    }
}

/// Planes that touch nothing change no byte; nor does the length of a normal.
TEST_ON(test_untouched, 2) {
    static drawn whole, cut;
    for (int kind = 0; kind < SCENE_COUNT; kind++) {
        OWNED(scene_free) scene of;
        assert_int_equal(scene_make(context, (scene_kind)kind, POINTS, SIDE, SIDE, &of), EWA_OK);
        ewa_render_options options = plain_options();
        draw(context, of.cloud, &of.camera, &options, &whole);
        add_box(&options, -1e4, 1e4);
        draw(context, of.cloud, &of.camera, &options, &cut);
        assert_same(&whole, &cut, scene_name((scene_kind)kind));
        options.section_count = 0;
        add_oblique(&options, &of, 3);
        draw(context, of.cloud, &of.camera, &options, &whole);
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 4; c++) options.section_planes[k][c] *= k == 0 ? 0x1p-900 : 0x1p30;
        draw(context, of.cloud, &of.camera, &options, &cut);
        assert_same(&whole, &cut, scene_name((scene_kind)kind));
    }
}

TEST(test_threads_and_instructions) {
    static const struct {
        uint32_t threads, mask;
    } runs[] = {{1, EWA_CPU_ALL}, {7, EWA_CPU_ALL}, {2, EWA_CPU_AVX2}, {2, 0}};
    static const scene_kind kinds[] = {SCENE_SPHERE, SCENE_NEAR, SCENE_ELLIPSES, SCENE_CUBE};
    static drawn first, other;
    for (size_t kind = 0; kind < sizeof kinds / sizeof kinds[0]; kind++)
        for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context_of(runs[i].threads, runs[i].mask);
            OWNED(scene_free) scene of;
            assert_int_equal(scene_make(context, kinds[kind], POINTS, SIDE, SIDE, &of), EWA_OK);
            ewa_render_options options = plain_options();
            add_oblique(&options, &of, 2);
            draw(context, of.cloud, &of.camera, &options, i ? &other : &first);
            if (i) assert_same(&first, &other, scene_name(kinds[kind]));
        }
}

/// Neither the order of the points, nor a distant origin, nor another source beside changes a byte.
TEST_ON(test_order_and_origin, 2) {
    static const double none[3] = {0, 0, 0}, far[3] = {4194304, -524288, 2048};
    static drawn whole, first, other;
    const double spacing = 0.25;
    const ewa_render_options no_planes = plain_options();
    ewa_render_options options = plain_options();
    add_plane(&options, 1, 0.5, 0, 0.375);
    add_plane(&options, 0, -1, 0, 1.5);
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_grid(context, spacing, none, 0);
        ewa_camera camera = make_camera(orthographic, spacing, none);
        draw(context, cloud, &camera, &no_planes, &whole);
        draw(context, cloud, &camera, &options, &first);
        ewa_cloud_destroy(&cloud);
        check_cut(&options, spacing, &whole, &first);
        cloud = make_grid(context, spacing, none, 5);
        draw(context, cloud, &camera, &options, &other);
        assert_same(&first, &other, "order");
        // Far away, and from an origin that is not the cloud's.
        ewa_cloud_destroy(&cloud);
        cloud = make_grid(context, spacing, far, 3);
        camera = make_camera(orthographic, spacing, far);
        ewa_render_options moved = options;
        for (uint32_t k = 0; k < moved.section_count; k++)
            for (int c = 0; c < 3; c++) moved.section_planes[k][3] -= moved.section_planes[k][c] * far[c];
        draw(context, cloud, &camera, &moved, &other);
        assert_same(&first, &other, "origin");
    }
}

/// What a source beside draws is cut, too, by the same planes of the world, whatever its origin.
TEST_ON(test_sources, 2) {
    static const double none[3] = {0, 0, 0}, beside[3] = {2, 0, 0};
    static drawn one, two, other;
    ewa_surfels *surfels[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_grid(context, 1, i ? beside : none, 0);
        assert_int_equal(ewa_surfels_create(cloud, NULL, &surfels[i]), EWA_OK);
    }
    const ewa_camera camera = make_camera(true, 1, none);
    ewa_render_options options = plain_options();
    add_plane(&options, -1, 0, 0, 4);
    const ewa_surfels *const sources[2] = {surfels[0], surfels[1]}, *const turned[2] = {surfels[1],
                                                                                        surfels[0]};
    draw_sources(context, sources, 1, &camera, &options, &one);
    draw_sources(context, sources, 2, &camera, &options, &two);
    draw_sources(context, turned, 2, &camera, &options, &other);
    assert_same(&two, &other, "order of the sources");
    check_grid(&options, 1, &two);
    assert_true(two.stats.culled_count > one.stats.culled_count);
    for (int i = 0; i < 2; i++) ewa_surfels_destroy(&surfels[i]);
}

TEST(test_bad_planes) {
    static const double none[3] = {0, 0, 0};
    static const double planes[][4] = {
        {0, 0, 0, 1}, {NAN, 0, 0, 1}, {1, INFINITY, 0, 0}, {1, 0, 0, -INFINITY}, {0, 0, 1, NAN}};
    static uint8_t rgba8[4 * SIDE * SIDE];
    check_log log = {.count = 0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const ewa_camera camera = make_camera(true, 1, none);
    const ewa_frame frame = {.rgba8 = rgba8};
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++) {
        ewa_render_options options = plain_options();
        add_plane(&options, 1, 0, 0, 0);
        add_plane(&options, planes[i][0], planes[i][1], planes[i][2], planes[i][3]);
        assert_int_equal(ewa_render_begin(renderer, &camera, &options, &frame), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log.text, "section_planes[1]"));
        assert_non_null(strstr(log.text, i ? "not finite" : "no normal"));
        options.section_count = 1; // those beyond the count may be anything
        assert_int_equal(ewa_render_begin(renderer, &camera, &options, &frame), EWA_OK);
        options.section_count = EWA_MAX_SECTION_PLANES + 1;
        assert_int_equal(ewa_render_begin(renderer, &camera, &options, &frame), EWA_ERROR_ARGUMENT);
        assert_non_null(strstr(log.text, "section_count"));
    }
}

static double now_s(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/// What a box saves, to be read: nothing is asserted of times.
TEST_ON(test_time_is_printed, 1) {
    static drawn to;
    OWNED(scene_free) scene of;
    assert_int_equal(scene_make(context, SCENE_SPHERE, 60000, SIDE, SIDE, &of), EWA_OK);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(of.cloud, NULL);
    const ewa_surfels *const sources[] = {surfels};
    double min_s[3] = {INFINITY, INFINITY, INFINITY};
    uint64_t culled[3];
    for (int round = 0; round < 5; round++)
        for (int planes = 0; planes < 3; planes++) {
            ewa_render_options options = plain_options();
            if (planes == 1) add_box(&options, -1e3, 1e3);
            if (planes == 2) add_plane(&options, 1, 0, 0, 0);
            const double start_s = now_s();
            draw_sources(context, sources, 1, &of.camera, &options, &to);
            min_s[planes] = fmin(min_s[planes], now_s() - start_s);
            culled[planes] = to.stats.culled_count;
        }
    print_message("whole %.2f ms, in a box %.2f ms, half %.2f ms\n", 1e3 * min_s[0], 1e3 * min_s[1],
                  1e3 * min_s[2]);
    assert_true(culled[1] == culled[0] && culled[2] > culled[0] + 20000);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
