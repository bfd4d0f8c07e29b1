// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pictures of octrees: like those of all points, the same for every number of threads and every memory, complete once
// everything is read; and points read out of them.
#include "io/octree.h"
#include "lod/lod_scene.h"

#include <math.h>

enum { POINTS = 600000, WIDTH_PX = 480, HEIGHT_PX = 640, NUMBERS = 4 * WIDTH_PX * HEIGHT_PX };

typedef struct shot {
    ewa_lod_stats stats;
    uint8_t rgba8[NUMBERS];
} shot;

static const char file[] = "ground.copc.laz";

/// One octree for all tests, of points with normals and radii.
static int enter(void **state) {
    lod_build_ground(POINTS, file);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

/// From far above, the ground as high as the picture, or from close by.
static ewa_camera camera_at(double distance) {
    ewa_camera camera = check_camera(WIDTH_PX, HEIGHT_PX);
    const double eye[3] = {0.1, -0.6 * distance, distance}, target[3] = {0, 0, 0}, up[3] = {0, 1, 0};
    assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
    assert_int_equal(ewa_camera_set_fov(&camera, 45), EWA_OK);
    return camera;
}

static ewa_lod *open_file(ewa_context *context, const char *name) {
    char path[512];
    ewa_lod *lod = NULL;
    assert_int_equal(ewa_lod_open(context, scratch_path(name, path), &lod), EWA_OK);
    return lod;
}

/// Pixels as they are.
static ewa_render_options over_black(void) {
    WITH_DEFAULTS(ewa_render_options, options);
    options.background[3] = 1, options.supersampling = 1;
    return options;
}

static ewa_lod_options lod_options_of(double error, double spacing_px, uint64_t memory_bytes) {
    WITH_DEFAULTS(ewa_lod_options, options);
    options.error = error, options.spacing_px = spacing_px, options.memory_bytes = memory_bytes;
    return options;
}

static ewa_status try_draw(ewa_lod *lod, ewa_context *context, const ewa_camera *camera,
                           const ewa_lod_options *lod_options, shot *made) {
    ewa_renderer *renderer = check_renderer(context);
    const ewa_render_options options = over_black();
    const ewa_frame frame = {.rgba8 = made->rgba8};
    const ewa_status status =
        ewa_lod_render(lod, renderer, camera, &options, lod_options, &frame, &made->stats);
    ewa_renderer_destroy(&renderer);
    return status;
}

static shot *draw(ewa_lod *lod, ewa_context *context, const ewa_camera *camera,
                  const ewa_lod_options *lod_options) {
    shot *made = calloc(1, sizeof *made);
    assert_non_null(made);
    assert_int_equal(try_draw(lod, context, camera, lod_options, made), EWA_OK);
    return made;
}

/// All points of a file at once.
static shot *draw_plain(ewa_context *context, const char *name, const ewa_camera *camera) {
    shot *made = calloc(1, sizeof *made);
    assert_non_null(made);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = lod_load(context, name);
    OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
    OWNED(ewa_renderer_destroy) ewa_renderer *renderer = check_renderer(context);
    const ewa_render_options options = over_black();
    const ewa_frame frame = {.rgba8 = made->rgba8};
    assert_int_equal(ewa_render(renderer, surfels, camera, &options, &frame, NULL), EWA_OK);
    return made;
}

/// Over the pixels that are not black in both: the rest of a picture is no merit.
static double psnr_db(const shot *a, const shot *b) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < NUMBERS; i += 4) {
        bool black = true;
        for (size_t c = i; c < i + 3; c++) {
            const double off = (double)a->rgba8[c] - (double)b->rgba8[c];
            black = black && !a->rgba8[c] && !b->rgba8[c];
            sum += off * off;
        }
        if (!black) count += 3;
    }
    return sum > 0 ? 10 * log10(255.0 * 255 * (double)count / sum) : (double)INFINITY;
}

/// Share of the pixels that are not black.
static double filled(const shot *made) {
    size_t count = 0;
    for (size_t i = 0; i < NUMBERS; i += 4)
        count += made->rgba8[i] || made->rgba8[i + 1] || made->rgba8[i + 2];
    return (double)count / (WIDTH_PX * HEIGHT_PX);
}

static void hold_same(const shot *a, const shot *b) {
    assert_memory_equal(a->rgba8, b->rgba8, sizeof a->rgba8);
}

static void hold_like(const char *what, const shot *plain, const shot *made, double min_db) {
    const double found = psnr_db(plain, made);
    print_message("%s: %.1f dB, %u nodes, %llu surfels\n", what, found, made->stats.node_count,
                  (unsigned long long)made->stats.surfel_count);
    assert_true(found >= min_db);
}

TEST_ON(test_like_plain, 2) {
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    static const double distances[] = {0.6, 2.2, 8, 25};
    for (int i = 0; i < 4; i++) {
        const ewa_camera camera = camera_at(distances[i]);
        const ewa_lod_options all = lod_options_of(0, 0.5, 1 << 30),
                              levels = lod_options_of(16, 0.5, 1 << 30);
        OWNED(check_free)
        shot *plain = draw_plain(context, file, &camera), *points = draw(lod, context, &camera, &all),
             *merged = draw(lod, context, &camera, &levels);
        assert_true(filled(plain) > 0.005);
        hold_like("all points", plain, points, 45);
        hold_like("levels", plain, merged, 38);
        assert_int_equal(points->stats.missing_count, 0);
        assert_int_equal(points->stats.band_count, 1);
        // From far away few surfels represent all points.
        if (i == 3) assert_true(merged->stats.surfel_count < points->stats.surfel_count / 2);
    }
}

/// Nodes seen twice as large show an error twice as large: with twice the bound they are the same ones.
TEST_ON(test_error_grows_with_nodes, 2) {
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    static const double errors[] = {0.125, 1, 8};
    uint32_t different = 0, count = 0;
    for (int i = 0; i < 3; i++) {
        ewa_camera camera = camera_at(8);
        camera.projection = EWA_ORTHOGRAPHIC, camera.fx_px = camera.fy_px = 24;
        ewa_lod_options once = lod_options_of(errors[i], 64, 1 << 30), twice = lod_options_of(2 * errors[i], 64, 1 << 30);
        once.max_splats = twice.max_splats = POINTS; // the picture's size bounds nothing
        OWNED(check_free) shot *small = draw(lod, context, &camera, &once);
        camera.fx_px = camera.fy_px = 48;
        OWNED(check_free) shot *large = draw(lod, context, &camera, &twice);
        assert_int_equal(small->stats.node_count, large->stats.node_count);
        assert_int_equal(small->stats.surfel_count, large->stats.surfel_count);
        print_message("error %g: %u nodes\n", errors[i], small->stats.node_count);
        different += small->stats.node_count != count, count = small->stats.node_count;
    }
    assert_true(different >= 2); // the error does choose
}

TEST(test_threads) {
    static const uint32_t threads[] = {1, 2, 4, 8};
    const ewa_camera camera = camera_at(2.2);
    const ewa_lod_options options = lod_options_of(16, 2, 1 << 30);
    OWNED(check_free) shot *first = NULL;
    for (int i = 0; i < 4; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[i], NULL);
        OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
        shot *made = draw(lod, context, &camera, &options);
        if (first)
            hold_same(first, made);
        else
            first = made;
        if (first != made) free(made);
    }
    assert_true(filled(first) > 0.1);
}

TEST_ON(test_memory, 2) {
    static const uint64_t memories[] = {1 << 30, 1 << 26, 1 << 24};
    static const double errors[] = {0, 16};
    const ewa_camera camera = camera_at(2.2);
    for (int e = 0; e < 2; e++) {
        OWNED(check_free) shot *first = NULL;
        for (int i = 0; i < 3; i++) {
            OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
            const ewa_lod_options options = lod_options_of(errors[e], 0.5, memories[i]);
            shot *made = draw(lod, context, &camera, &options);
            print_message("memory %llu: %u bands, %llu surfels\n", (unsigned long long)memories[i],
                          made->stats.band_count, (unsigned long long)made->stats.surfel_count);
            // 600,000 points of 40 bytes or more do not fit.
            if (errors[e] == 0 && i == 2) assert_true(made->stats.band_count > 1);
            assert_true(made->stats.resident_bytes <= memories[i]);
            if (first) {
                hold_same(first, made);
                free(made);
            } else {
                first = made;
            }
        }
    }
}

/// Where the nodes of no band fit, nothing is read.
TEST_LOGGED(test_refused_memory, 2) {
    ewa_camera camera = camera_at(2.2);
    camera.fx_px *= 0.3, camera.fy_px *= 0.3; // 128 rows have all nodes
    const ewa_lod_options little = lod_options_of(0, 0.5, 1 << 24);
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    OWNED(check_free) shot *made = calloc(1, sizeof *made);
    assert_non_null(made);
    assert_int_equal(try_draw(lod, context, &camera, &little, made), EWA_ERROR_LIMIT);
    assert_non_null(strstr(log->text, "rows of the picture need 2"));
    assert_int_equal(made->stats.loaded_count, 0);
}

/// No more than 8 surfels for a covered pixel, from wherever it is seen; a few nodes are few surfels.
TEST_ON(test_bound, 2) {
    enum { FEW_NODES = 8 };
    static const double distances[] = {1, 2.2, 3.1, 6, 16, 64};
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    for (size_t i = 0; i < sizeof distances / sizeof distances[0]; i++) {
        const ewa_camera camera = camera_at(distances[i]);
        OWNED(check_free) shot *made = draw(lod, context, &camera, NULL);
        const double each = (double)made->stats.surfel_count / (filled(made) * WIDTH_PX * HEIGHT_PX);
        print_message("distance %g: %u nodes, %.2f surfels a pixel, coarser %.2f\n", distances[i], made->stats.node_count, each,
                      made->stats.coarser);
        assert_true(each <= 8 || made->stats.node_count <= FEW_NODES);
    }
}

/// As many surfels as were asked for, about: what fades counts twice, and the root is never left out.
TEST_ON(test_max_splats, 2) {
    static const uint64_t counts[] = {UINT64_C(1) << 50, 400000, 200000, 100000, 1};
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    const ewa_camera camera = camera_at(5);
    ewa_lod_options options = lod_options_of(3, 0.25, 1 << 30);
    options.max_splats = 1;
    OWNED(check_free) shot *root = draw(lod, context, &camera, &options), *before = NULL;
    assert_int_equal(root->stats.node_count, 1);
    const uint64_t next_count = 120000; // of the root and its children
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        options.max_splats = counts[i];
        shot *made = draw(lod, context, &camera, &options);
        print_message("%llu: %llu surfels, coarser %.3f\n", (unsigned long long)counts[i],
                      (unsigned long long)made->stats.surfel_count, made->stats.coarser);
        if (i == 0) assert_true(made->stats.coarser == 1);
        // Few nodes fade all at once: the smallest cut and the next finer one are drawn together.
        assert_true(made->stats.surfel_count <= counts[i] + counts[i] / 2 + next_count);
        if (before) {
            assert_true(made->stats.coarser > before->stats.coarser);
        }
        free(before);
        before = made;
    }
    hold_same(root, before);
    // All points are all points.
    const ewa_lod_options all = lod_options_of(0, 0.5, 1 << 30);
    options.error = 0;
    OWNED(check_free) shot *points = draw(lod, context, &camera, &all), *few = draw(lod, context, &camera, &options);
    hold_same(points, few);
}

/// Going near, with few surfels: no value changes much more from picture to picture than in those of all points.
TEST_ON(test_no_jumps, 2) {
    enum { FRAMES = 12, JUMP = 8 };
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    ewa_lod_options options = lod_options_of(3, 1, 1 << 30);
    options.max_splats = 180000;
    const ewa_lod_options all = lod_options_of(0, 1, 1 << 30);
    OWNED(check_free) shot *before = NULL, *before_plain = NULL;
    size_t jumps = 0, values = 0;
    uint64_t most = 0, fewest = UINT64_MAX;
    for (int f = 0; f < FRAMES; f++) {
        const ewa_camera camera = camera_at(7 * pow(0.99, f));
        shot *made = draw(lod, context, &camera, &options), *plain = draw(lod, context, &camera, &all);
        most = made->stats.surfel_count > most ? made->stats.surfel_count : most;
        fewest = made->stats.surfel_count < fewest ? made->stats.surfel_count : fewest;
        for (size_t i = 0; before && i < NUMBERS; i++) {
            const int own = abs(made->rgba8[i] - before->rgba8[i]), of_plain = abs(plain->rgba8[i] - before_plain->rgba8[i]);
            values += made->rgba8[i] > 0;
            jumps += own - of_plain > JUMP;
        }
        free(before), free(before_plain);
        before = made, before_plain = plain;
    }
    print_message("%zu of %zu values jump; %llu to %llu surfels\n", jumps, values, (unsigned long long)fewest, (unsigned long long)most);
    assert_true(most > fewest);
    assert_true((double)jumps < 8e-4 * (double)values);
}

/// Draws an octree, or without one all points of the file, in parts of pixels.
static shot *draw_parts(ewa_lod *lod, ewa_context *context, const ewa_camera *camera,
                        const ewa_lod_options *lod_options, uint32_t supersampling) {
    shot *made = calloc(1, sizeof *made);
    assert_non_null(made);
    ewa_renderer *renderer = check_renderer(context);
    ewa_render_options options = over_black();
    options.supersampling = supersampling;
    const ewa_frame frame = {.rgba8 = made->rgba8};
    if (lod) {
        assert_int_equal(ewa_lod_render(lod, renderer, camera, &options, lod_options, &frame, &made->stats), EWA_OK);
    } else {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = lod_load(context, file);
        OWNED(ewa_surfels_destroy) ewa_surfels *surfels = check_surfels(cloud, NULL);
        assert_int_equal(ewa_render(renderer, surfels, camera, &options, &frame, NULL), EWA_OK);
    }
    ewa_renderer_destroy(&renderer);
    return made;
}

/// From far away parts of pixels are nearer to the truth, as many as the nodes' surfels ask for.
TEST_ON(test_supersampling, 2) {
    const ewa_camera camera = camera_at(40);
    OWNED(check_free) shot *truth = draw_parts(NULL, context, &camera, NULL, EWA_MAX_SUPERSAMPLING);
    const ewa_lod_options options = lod_options_of(255, 0.5, 1 << 30);
    double found[4];
    for (uint32_t n = 0; n < 4; n++) {
        OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
        OWNED(check_free) shot *made = draw_parts(lod, context, &camera, &options, n);
        found[n] = psnr_db(truth, made);
        print_message("%u: %.1f dB, %llu surfels\n", n, found[n], (unsigned long long)made->stats.surfel_count);
    }
    assert_true(found[0] > found[1] + 3 && found[2] > found[1] + 3 && found[3] > found[1] + 2);
}

/// Where nobody says how many parts: one near by, and from far away as many as take no more surfels than a picture that octrees fill.
TEST_ON(test_parts_by_default, 2) {
    static const double distances[] = {1, 40, 64, 100};
    double before_db = 0;
    for (size_t i = 0; i < sizeof distances / sizeof *distances; i++) {
        const ewa_camera camera = camera_at(distances[i]);
        ewa_lod *lod = open_file(context, file);
        shot *truth = draw_parts(NULL, context, &camera, NULL, EWA_MAX_SUPERSAMPLING);
        shot *whole = draw_parts(lod, context, &camera, NULL, 1), *made = draw_parts(lod, context, &camera, NULL, 0);
        const double db = psnr_db(truth, made), whole_db = psnr_db(truth, whole);
        print_message("%g: %.1f dB, %llu surfels; as they are %.1f, %llu\n", distances[i], db,
                      (unsigned long long)made->stats.surfel_count, whole_db, (unsigned long long)whole->stats.surfel_count);
        if (i == 0) hold_same(whole, made);
        if (i > 0) assert_true(db > whole_db + 3 && made->stats.surfel_count < 2 << 20);
        before_db = db;
        free(truth), free(whole), free(made);
        ewa_lod_close(&lod);
    }
    assert_true(before_db > 30);
}

static double rms(const shot *a, const shot *b) {
    double sum = 0;
    for (size_t i = 0; i < NUMBERS; i++) sum += pow(a->rgba8[i] - b->rgba8[i], 2);
    return sqrt(sum / NUMBERS);
}

/// The pictures of one camera by default, with one part and with two.
typedef struct trio {
    shot *chosen, *one, *two;
} trio;

static trio draw_trio(ewa_lod *lod, ewa_context *context, double distance) {
    const ewa_camera camera = camera_at(distance);
    return (trio){draw_parts(lod, context, &camera, NULL, 0), draw_parts(lod, context, &camera, NULL, 1),
                  draw_parts(lod, context, &camera, NULL, 2)};
}

static void free_trio(trio *of) { free(of->chosen), free(of->one), free(of->two); }

static bool same_shots(const shot *a, const shot *b) { return memcmp(a->rgba8, b->rgba8, sizeof a->rgba8) == 0; }

/// Finds how far away the picture is no longer that of one part, or is that of two.
static double find_change(ewa_lod *lod, ewa_context *context, double low, double high, bool to_two) {
    for (int i = 0; i < 12; i++) {
        const double middle = sqrt(low * high);
        trio made = draw_trio(lod, context, middle);
        const bool before = to_two ? !same_shots(made.chosen, made.two) : same_shots(made.chosen, made.one);
        *(before ? &low : &high) = middle;
        free_trio(&made);
    }
    return high;
}

/// Going away, parts of pixels come in bit by bit: nowhere does a picture differ much from the one of slightly nearer.
TEST_ON(test_parts_take_over_gradually, 2) {
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    const double from = find_change(lod, context, 2, 20, false), to = find_change(lod, context, from, 1.4 * from, true);
    print_message("two parts from %.3f to %.3f\n", from, to);
    assert_true(to > 1.05 * from && to < 1.15 * from);
    const double between[] = {from * 1.001, sqrt(from * to), to * 0.999};
    double off_one[3], off_two[3];
    for (int i = 0; i < 3; i++) {
        trio made = draw_trio(lod, context, between[i]);
        const double whole = rms(made.one, made.two);
        off_one[i] = rms(made.chosen, made.one) / whole, off_two[i] = rms(made.chosen, made.two) / whole;
        print_message("%.3f: of %.2f/255 %.2f from one part, %.2f from two\n", between[i], whole, off_one[i], off_two[i]);
        assert_true(whole > 0.5);
        free_trio(&made);
    }
    assert_true(off_one[0] < 0.1 && off_two[2] < 0.1);
    assert_true(off_one[1] > 0.25 && off_one[1] < 0.75 && off_two[1] > 0.25 && off_two[1] < 0.75);
}

/// Bands know as little of each other's nodes as ranks do, and come to as many parts.
TEST_ON(test_supersampling_in_bands, 2) {
    const ewa_camera camera = camera_at(2.2);
    for (uint32_t n = 0; n < 4; n += 2) {
        shot *made[2];
        for (int i = 0; i < 2; i++) {
            OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
            const ewa_lod_options options = lod_options_of(0, 0.5, i ? 1 << 24 : 1 << 30);
            made[i] = draw_parts(lod, context, &camera, &options, n);
        }
        assert_true(made[0]->stats.band_count == 1 && made[1]->stats.band_count > 1);
        hold_same(made[0], made[1]);
        free(made[0]);
        free(made[1]);
    }
}

/// With next to no time each picture shows more, until nothing is missing.
TEST_ON(test_load, 2) {
    enum { MAX_CALLS = 400 };
    const ewa_camera camera = camera_at(1);
    ewa_lod_options options = lod_options_of(16, 0.5, 1 << 30);
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    OWNED(check_free) shot *whole = draw(lod, context, &camera, &options), *made = calloc(1, sizeof *made);
    assert_non_null(made);
    ewa_lod_close(&lod);
    lod = open_file(context, file);
    options.load_s = 1e-9;
    assert_int_equal(try_draw(lod, context, &camera, &options, made), EWA_OK);
    assert_true(made->stats.missing_count > 0);
    assert_true(filled(made) > 0.1);
    const double first_db = psnr_db(whole, made);
    int calls = 1;
    for (; made->stats.missing_count > 0 && calls < MAX_CALLS; calls++)
        assert_int_equal(try_draw(lod, context, &camera, &options, made), EWA_OK);
    print_message("%d calls, first %.1f dB\n", calls, first_db);
    assert_int_equal(made->stats.missing_count, 0);
    hold_same(whole, made);
}

/// Points of a box are those of the whole file that lie in it.
TEST_ON(test_read, 2) {
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    assert_int_equal(info.point_count, POINTS);
    assert_true(info.merged && info.surfels && info.merged_count > 0);
    assert_true(info.level_count > 1 && info.node_count > info.level_count);
    assert_int_equal(ewa_cloud_point_count(info.prototype), 0);
    ewa_cloud *all = lod_load(context, file), *read = NULL, *expected = NULL;
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(all, &bounds), EWA_OK);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(bounds.low_world[c] - info.bounds.low_world[c]) < 1e-6);
        assert_true(fabs(bounds.high_world[c] - info.bounds.high_world[c]) < 1e-6);
        assert_true(info.low_world[c] <= bounds.low_world[c] + 1e-9);
        assert_true(info.low_world[c] + info.side_world >= bounds.high_world[c] - 1e-9);
    }
    static const double low[3] = {-0.3, 0.1, -0.05}, high[3] = {0.25, 0.9, 0.2};
    uint64_t *inside = malloc(POINTS * sizeof *inside), count = 0;
    assert_non_null(inside);
    double origin[3];
    ewa_cloud_origin(all, origin);
    const ewa_attribute *position = ewa_cloud_find(all, EWA_POSITION);
    for (uint64_t i = 0; i < POINTS; i++) {
        double at[4];
        bool in = true;
        ewa_attribute_read_f64(position, i, 1, at);
        for (int c = 0; c < 3; c++) in = in && at[c] + origin[c] >= low[c] && at[c] + origin[c] <= high[c];
        if (in) inside[count++] = i;
    }
    assert_true(count > 10000 && count < POINTS / 2);
    assert_int_equal(ewa_cloud_select(all, inside, count, &expected), EWA_OK);
    assert_int_equal(ewa_lod_read(lod, low, high, 0, &read), EWA_OK);
    lod_hold_same(&expected, 1, read, true);
    ewa_cloud_destroy(&read);
    // Coarser: fewer, all of them in the box; outside: none.
    assert_int_equal(ewa_lod_read(lod, low, high, info.spacing_world, &read), EWA_OK);
    assert_true(ewa_cloud_point_count(read) > 0 && ewa_cloud_point_count(read) < count);
    ewa_cloud_destroy(&read);
    static const double far_low[3] = {5, 5, 5}, far_high[3] = {6, 6, 6};
    assert_int_equal(ewa_lod_read(lod, far_low, far_high, 0, &read), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(read), 0);
    ewa_cloud_destroy(&read);
    assert_int_equal(ewa_lod_read(lod, low, high, -1, &read), EWA_ERROR_ARGUMENT);
    ewa_cloud_destroy(&expected);
    ewa_cloud_destroy(&all);
    free(inside);
}

TEST_ON(test_sample, 2) {
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, file);
    ewa_cloud *few = NULL, *some = NULL, *all = NULL;
    assert_int_equal(ewa_lod_sample(lod, 1, &few), EWA_OK);
    assert_int_equal(ewa_lod_sample(lod, POINTS / 2, &some), EWA_OK);
    assert_int_equal(ewa_lod_sample(lod, POINTS, &all), EWA_OK);
    assert_true(ewa_cloud_point_count(few) > 0);
    assert_true(ewa_cloud_point_count(some) >= ewa_cloud_point_count(few));
    assert_true(ewa_cloud_point_count(some) <= POINTS / 2);
    assert_int_equal(ewa_cloud_point_count(all), POINTS);
    // The coarsest level is a sample of the whole ground.
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(few, &bounds), EWA_OK);
    for (int c = 0; c < 2; c++) assert_true(bounds.low_world[c] < -0.9 && bounds.high_world[c] > 0.9);
    ewa_cloud_destroy(&few);
    assert_int_equal(ewa_lod_sample(lod, 0, &few), EWA_ERROR_ARGUMENT);
    ewa_cloud_destroy(&some);
    ewa_cloud_destroy(&all);
}

/// Copies the file with another user in the record of surfels, as one that another program has made.
static void strip(const char *from, const char *to) {
    static const uint8_t user[18] = {'e', 'w', 'a', [16] = 1}; // 16 bytes of name, the number 1
    char path[512];
    size_t size_bytes, found = 0;
    OWNED(check_free) uint8_t *bytes = scratch_read(scratch_path(from, path), &size_bytes);
    for (size_t at = 0; at + sizeof user <= size_bytes; at++)
        if (memcmp(bytes + at, user, sizeof user) == 0) bytes[at] = 'x', found++;
    assert_int_equal(found, 1);
    scratch_write(scratch_path(to, path), bytes, size_bytes);
}

TEST_ON(test_without_levels, 2) {
    strip(file, "plain.copc.laz");
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, "plain.copc.laz");
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    assert_false(info.merged);
    assert_int_equal(info.point_count, POINTS);
    const ewa_camera camera = camera_at(2.2);
    const ewa_lod_options all = lod_options_of(0, 0.5, 1 << 30), some = lod_options_of(16, 0.5, 1 << 30);
    shot *plain = draw_plain(context, file, &camera), *made = draw(lod, context, &camera, &all),
         *coarse = draw(lod, context, &camera, &some);
    hold_like("without levels, all points", plain, made, 45);
    hold_like("without levels", plain, coarse, 25);
    // Bands are the same bytes here, too.
    ewa_lod_close(&lod);
    lod = open_file(context, "plain.copc.laz");
    const ewa_lod_options little = lod_options_of(0, 0.5, 1 << 24);
    shot *bands = draw(lod, context, &camera, &little);
    assert_true(bands->stats.band_count > 1);
    hold_same(made, bands);
    free(plain);
    free(made);
    free(bands);
    free(coarse);
}

/// Points of a node that lie in a part of it without a node are drawn, too: other programs leave such parts
/// out.
TEST_ON(test_parts_without_nodes, 2) {
    enum { COUNT = 40000 };
    ewa_cloud *coarse = lod_ground(context, 0, COUNT, (lod_look){true, true}),
              *all = lod_ground(context, COUNT, COUNT, (lod_look){true, true}), *corner = NULL;
    uint64_t *indices = malloc(COUNT * sizeof *indices), count = 0;
    assert_non_null(indices);
    const double *at = ewa_cloud_find(all, EWA_POSITION)->data;
    for (uint64_t i = 0; i < COUNT; i++)
        if (at[3 * i] < 0 && at[3 * i + 1] < 0 && at[3 * i + 2] < 0) indices[count++] = i;
    assert_int_equal(ewa_cloud_select(all, indices, count, &corner), EWA_OK);
    free(indices);
    ewa_cloud *prototype = NULL;
    assert_int_equal(ewa_cloud_select(all, NULL, 0, &prototype), EWA_OK);
    const ewa_octree_plan plan = {.prototype = prototype,
                                  .bounds = {{-1, -1, -1}, {1, 1, 1}, 2},
                                  .low_world = {-1, -1, -1},
                                  .side_world = 2,
                                  .spacing_world = 0.01};
    const ewa_octree_key keys[2] = {{0, {0, 0, 0}}, {1, {0, 0, 0}}};
    const ewa_cloud *const pieces[2] = {coarse, corner};
    ewa_octree_chunk chunks[2] = {{.size_bytes = 0}};
    ewa_octree_writer *writer = NULL;
    char path[512];
    assert_int_equal(ewa_octree_writer_open(context, scratch_path("gaps.copc.laz", path), &plan, &writer),
                     EWA_OK);
    assert_int_equal(ewa_octree_encode(writer, keys, pieces, 2, chunks), EWA_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ewa_octree_append(writer, &chunks[i]), EWA_OK);
        ewa_octree_chunk_free(context, &chunks[i]);
    }
    assert_int_equal(ewa_octree_writer_commit(&writer), EWA_OK);
    ewa_cloud_destroy(&coarse);
    ewa_cloud_destroy(&all);
    ewa_cloud_destroy(&corner);
    ewa_cloud_destroy(&prototype);
    OWNED(ewa_lod_close) ewa_lod *lod = open_file(context, "gaps.copc.laz");
    const ewa_camera camera = camera_at(2.2);
    const ewa_lod_options options = lod_options_of(0, 0.5, 1 << 30);
    OWNED(check_free)
    shot *plain = draw_plain(context, "gaps.copc.laz", &camera),
         *made = draw(lod, context, &camera, &options);
    hold_like("parts without nodes", plain, made, 45);
}

int main(void) { return RUN_TESTS(enter, leave); }
