// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees made of files: every point is there once, as it was, for any number of threads; and odd inputs.
#include "lod/inputs.h"
#include "lod/lod_scene.h"

#include <math.h>

enum { POINTS = 300000, FILES = 3 };

static const char *const files[FILES] = {"a.las", "b.las", "c.las"};

/// A folder without files but those that are made here.
static int enter(void **state) {
    lod_clear();
    return 0;
}

static void make_files(ewa_context *context, lod_look look) {
    for (uint64_t i = 0; i < FILES; i++)
        lod_save(lod_ground(context, i * POINTS / FILES, POINTS / FILES, look), files[i]);
}

/// Estimated or given, every point has a unit normal and a radius.
static void hold_surfels(const ewa_cloud *cloud) {
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS);
    assert_non_null(normal);
    assert_non_null(radius);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
        float n[4], r[4];
        ewa_attribute_read_f32(normal, i, 1, n);
        ewa_attribute_read_f32(radius, i, 1, r);
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-3f);
        assert_true(r[0] > 0 && r[0] < 0.1f);
    }
}

TEST_WITHIN(test_points, enter, NULL) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    make_files(context, (lod_look){.colors = true});
    ewa_lod_build_stats stats;
    assert_int_equal(lod_build(context, files, FILES, "o.copc.laz", NULL, &stats), EWA_OK);
    assert_int_equal(stats.point_count, POINTS);
    assert_int_equal(stats.left_out_count, 0);
    assert_true(stats.merged_count > 0 && stats.temporary_bytes > 0 && stats.node_count > 8);
    ewa_cloud *inputs[FILES], *output = lod_load(context, "o.copc.laz");
    for (int i = 0; i < FILES; i++) inputs[i] = lod_load(context, files[i]);
    lod_hold_same(inputs, FILES, output, false);
    hold_surfels(output);
    // Estimated normals are those of the ground, whose slope is at most 1/2.
    const ewa_attribute *normal = ewa_cloud_find(output, EWA_NORMAL);
    for (uint64_t i = 0; i < POINTS; i++) {
        float n[4];
        ewa_attribute_read_f32(normal, i, 1, n);
        assert_true(fabsf(n[2]) > 0.8f);
    }
    ewa_lod *lod = NULL;
    char path[512];
    assert_int_equal(ewa_lod_open(context, scratch_path("o.copc.laz", path), &lod), EWA_OK);
    ewa_lod_info info;
    ewa_lod_describe(lod, &info);
    assert_int_equal(info.point_count, POINTS);
    assert_int_equal(info.node_count, stats.node_count);
    assert_int_equal(info.level_count, stats.level_count);
    assert_int_equal(info.merged_count, stats.merged_count);
    assert_true(info.merged && info.surfels);
    // The box that the file says is that of the points, exactly: they lie on its grid.
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(output, &bounds), EWA_OK);
    for (int c = 0; c < 3; c++) {
        assert_true(info.bounds.low_world[c] == bounds.low_world[c]);
        assert_true(info.bounds.high_world[c] == bounds.high_world[c]);
        assert_true(info.low_world[c] <= bounds.low_world[c]);
        assert_true(info.low_world[c] + info.side_world >= bounds.high_world[c]);
    }
    ewa_lod_close(&lod);
    for (int i = 0; i < FILES; i++) ewa_cloud_destroy(&inputs[i]);
    ewa_cloud_destroy(&output);
    // The three inputs and the output, nothing else.
    assert_int_equal(lod_clear(), FILES + 1);
}

TEST_WITHIN(test_threads, enter, NULL) {
    static const uint32_t threads[] = {1, 2, 4};
    char names[3][16];
    for (int i = 0; i < 3; i++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(threads[i], NULL);
        if (i == 0) make_files(context, (lod_look){.colors = true});
        snprintf(names[i], sizeof names[i], "%u.copc.laz", threads[i]);
        assert_int_equal(lod_build(context, files, FILES, names[i], NULL, NULL), EWA_OK);
        if (i > 0) lod_hold_same_files(names[0], names[i]);
    }
    lod_clear();
}

/// Normals and radii that points have stay as they are, in files of different kinds.
TEST_WITHIN(test_own_surfels, enter, NULL) {
    static const char *const names[] = {"a.las", "b.ply"};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    const lod_look look = {true, true};
    lod_save(lod_ground(context, 0, 20000, look), names[0]);
    lod_save(lod_ground(context, 20000, 10000, look), names[1]);
    assert_int_equal(lod_build(context, names, 2, "o.copc.laz", NULL, NULL), EWA_OK);
    ewa_cloud *inputs[2], *output = lod_load(context, "o.copc.laz");
    for (int i = 0; i < 2; i++) inputs[i] = lod_load(context, names[i]);
    lod_hold_same(inputs, 2, output, true);
    for (int i = 0; i < 2; i++) ewa_cloud_destroy(&inputs[i]);
    ewa_cloud_destroy(&output);
    assert_int_equal(lod_clear(), 3);
}

/// One scan of a square, from 3 above or below it, as PTX: its points are told from the scanner.
static void put_scan(FILE *file, double x_world, double scanner_z_world) {
    enum { SIDE = 60 };
    fprintf(file, "%d\n%d\n%g 0 %g\n1 0 0\n0 1 0\n0 0 1\n", SIDE, SIDE, x_world, scanner_z_world);
    fprintf(file, "1 0 0 0\n0 1 0 0\n0 0 1 0\n%g 0 %g 1\n", x_world, scanner_z_world);
    for (int i = 0; i < SIDE * SIDE; i++)
        fprintf(file, "%.6f %.6f %g 0.5\n", (i % SIDE) / 30.0 - 1, (i / SIDE) / 30.0 - 1, -scanner_z_world);
}

/// Normals that are made face the scanner that saw the point.
TEST_WITHIN(test_scanners, enter, NULL) {
    static const char *const names[] = {"two.ptx"};
    char path[512];
    FILE *file = fopen(scratch_path(names[0], path), "w");
    assert_non_null(file);
    put_scan(file, 0, 3), put_scan(file, 4, -3);
    assert_int_equal(fclose(file), 0);
    ewa_context *context = check_context(2, NULL);
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", NULL, NULL), EWA_OK);
    ewa_cloud *output = lod_load(context, "o.copc.laz");
    const ewa_attribute *position = ewa_cloud_find(output, EWA_POSITION), *normal = ewa_cloud_find(output, EWA_NORMAL);
    const uint64_t count = ewa_cloud_point_count(output);
    double origin[3];
    ewa_cloud_origin(output, origin);
    assert_true(normal && count == 2 * 60 * 60);
    for (uint64_t i = 0; i < count; i++) {
        double p[3], n[3];
        ewa_attribute_read_f64(position, i, 1, p);
        ewa_attribute_read_f64(normal, i, 1, n);
        assert_true(p[0] + origin[0] < 2 ? n[2] > 0 : n[2] < 0);
    }
    ewa_cloud_destroy(&output);
    ewa_context_destroy(&context);
    assert_int_equal(lod_clear(), 2);
}

/// Points and what stands for them know how much their surface bends, to the side of the normals that they came with.
TEST_WITHIN(test_curvatures, enter, NULL) {
    enum { COUNT = 100000 }; // of one region
    static const char *const names[] = {"a.ply"};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    for (int inward = -1; inward < 2; inward++) { // -1: without normals
        ewa_cloud *cloud = NULL;
        WITH_DEFAULTS(ewa_generate_options, sphere);
        sphere.object = EWA_OBJECT_SPHERE, sphere.size_world = 4, sphere.point_count = COUNT;
        assert_int_equal(ewa_cloud_generate(context, &sphere, &cloud), EWA_OK);
        ewa_cloud_remove(cloud, EWA_CURVATURE);
        ewa_cloud_remove(cloud, EWA_RADIUS);
        if (inward < 0) ewa_cloud_remove(cloud, EWA_NORMAL);
        float *normal = inward > 0 ? ewa_cloud_find(cloud, EWA_NORMAL)->data : NULL;
        for (int i = 0; i < 3 * COUNT && inward > 0; i++) normal[i] = -normal[i];
        lod_save(cloud, names[0]);
        assert_int_equal(lod_build(context, names, 1, "o.copc.laz", NULL, NULL), EWA_OK);
        ewa_cloud *output = lod_load(context, "o.copc.laz");
        const ewa_attribute *found = ewa_cloud_find(output, EWA_CURVATURE);
        assert_true(found && found->type == EWA_F32 && found->component_count == 1);
        uint64_t right = 0;
        for (uint64_t i = 0; i < COUNT; i++) {
            double value;
            ewa_attribute_read_f64(found, i, 1, &value);
            right += fabs(value - (inward > 0 ? -0.5 : 0.5)) < 0.05; // a radius of 2
        }
        assert_true(right > 0.98 * COUNT);
        ewa_cloud_destroy(&output);
        assert_int_equal(lod_clear(), 2);
    }
}

/// Surfaces end in an octree where they end in its file: along the rim, and nowhere else.
TEST_WITHIN(test_borders, enter, NULL) {
    static const char *const names[] = {"a.las"};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    lod_save(lod_ground(context, 0, 50000, (lod_look){.colors = true}), names[0]);
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", NULL, NULL), EWA_OK);
    OWNED(ewa_cloud_destroy) ewa_cloud *output = lod_load(context, "o.copc.laz");
    const ewa_attribute *position = ewa_cloud_find(output, EWA_POSITION), *border = ewa_cloud_find(output, EWA_BORDER);
    assert_true(border && border->type == EWA_F32 && border->component_count == 3);
    double origin[3];
    ewa_cloud_origin(output, origin);
    int rim = 0, inside = 0;
    for (uint64_t i = 0; i < ewa_cloud_point_count(output); i++) {
        double p[3], to[3];
        ewa_attribute_read_f64(position, i, 1, p);
        ewa_attribute_read_f64(border, i, 1, to);
        if (to[0] == 0 && to[1] == 0 && to[2] == 0) continue;
        const double x = p[0] + origin[0], y = p[1] + origin[1];
        const bool is_rim = fmax(fabs(x), fabs(y)) > 0.95;
        rim += is_rim && x * to[0] + y * to[1] > 0; // it points outward
        inside += !is_rim;
    }
    print_message("%d borders along the rim, %d inside\n", rim, inside);
    assert_true(rim > 500 && inside == 0);
    assert_int_equal(lod_clear(), 2);
}

TEST_WITHIN(test_without_colors, enter, NULL) {
    static const char *const names[] = {"a.ply"};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    lod_save(lod_ground(context, 0, 20000, (lod_look){.colors = false}), names[0]);
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", NULL, NULL), EWA_OK);
    ewa_cloud *input = lod_load(context, names[0]), *output = lod_load(context, "o.copc.laz");
    assert_null(ewa_cloud_find(output, EWA_COLOR));
    lod_hold_same(&input, 1, output, false);
    hold_surfels(output);
    ewa_cloud_destroy(&input);
    ewa_cloud_destroy(&output);
    lod_clear();
}

/// Makes an octree of a cloud, which is destroyed, and loads what is in it.
static ewa_cloud *build_of(ewa_context *context, ewa_cloud *cloud, ewa_lod_build_stats *stats) {
    static const char *const names[] = {"a.ply"};
    lod_save(cloud, names[0]);
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", NULL, stats), EWA_OK);
    char path[512];
    ewa_lod *lod = NULL;
    assert_int_equal(ewa_lod_open(context, scratch_path("o.copc.laz", path), &lod), EWA_OK);
    ewa_lod_close(&lod);
    ewa_cloud *made = lod_load(context, "o.copc.laz");
    assert_int_equal(lod_clear(), 2);
    return made;
}

TEST_WITHIN(test_few, enter, NULL) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    static const uint64_t counts[] = {0, 1, 2, 3, 10};
    for (int i = 0; i < 5; i++) {
        ewa_lod_build_stats stats;
        OWNED(ewa_cloud_destroy) ewa_cloud *made =
            build_of(context, lod_ground(context, 0, counts[i], (lod_look){.colors = true}), &stats);
        assert_int_equal(stats.point_count, counts[i]);
        assert_int_equal(ewa_cloud_point_count(made), counts[i]);
        OWNED(ewa_cloud_destroy) ewa_cloud *plain = lod_ground(context, 0, counts[i], (lod_look){.colors = true});
        // Without a grid places are in steps of 10^-8 of the box or finer.
        if (counts[i]) lod_hold_same(&plain, 1, made, false);
    }
}

TEST_WITHIN(test_one_place, enter, NULL) {
    enum { COUNT = 5000 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_cloud *cloud = lod_ground(context, 0, COUNT, (lod_look){.colors = true});
    double *at = ewa_cloud_find(cloud, EWA_POSITION)->data;
    for (int i = 0; i < COUNT; i++) at[3 * i] = 0.5, at[3 * i + 1] = -0.25, at[3 * i + 2] = 1;
    ewa_lod_build_stats stats;
    OWNED(ewa_cloud_destroy) ewa_cloud *made = build_of(context, cloud, &stats);
    assert_int_equal(stats.point_count, COUNT);
    assert_int_equal(ewa_cloud_point_count(made), COUNT);
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(made, &bounds), EWA_OK);
    const double place[3] = {0.5, -0.25, 1};
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(bounds.low_world[c] - place[c]) < 1e-3);
        assert_true(bounds.low_world[c] == bounds.high_world[c]);
    }
}

TEST_WITHIN(test_left_out, enter, NULL) {
    enum { COUNT = 5000 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_cloud *cloud = lod_ground(context, 0, COUNT, (lod_look){.colors = true});
    double *at = ewa_cloud_find(cloud, EWA_POSITION)->data;
    at[0] = (double)NAN, at[3 * 77 + 1] = (double)INFINITY, at[3 * (COUNT - 1) + 2] = -(double)INFINITY;
    ewa_lod_build_stats stats;
    OWNED(ewa_cloud_destroy) ewa_cloud *made = build_of(context, cloud, &stats);
    assert_int_equal(stats.point_count, COUNT - 3);
    assert_int_equal(stats.left_out_count, 3);
    assert_int_equal(ewa_cloud_point_count(made), COUNT - 3);
    ewa_bounds bounds;
    assert_int_equal(ewa_cloud_measure(made, &bounds), EWA_OK);
    assert_int_equal(bounds.finite_count, COUNT - 3);
}

TEST_WITHIN(test_refusals, enter, NULL) {
    static const char *const names[] = {"a.ply", "nothing.ply"};
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    lod_save(lod_ground(context, 0, 100, (lod_look){.colors = true}), names[0]);
    assert_int_equal(lod_build(context, names, 2, "o.copc.laz", NULL, NULL), EWA_ERROR_IO);
    assert_non_null(strstr(log.text, "nothing.ply"));
    assert_int_equal(lod_build(context, names, 0, "o.copc.laz", NULL, NULL), EWA_ERROR_ARGUMENT);
    WITH_DEFAULTS(ewa_lod_build_options, options);
    options.subset = options.subset_count = 2;
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", &options, NULL), EWA_ERROR_ARGUMENT);
    ewa_lod_build_options_init(&options, sizeof options);
    options.memory_bytes = 1 << 20;
    assert_int_equal(lod_build(context, names, 1, "o.copc.laz", &options, NULL), EWA_ERROR_ARGUMENT);
    assert_int_equal(lod_clear(), 1);
}

/// Points of a reading, and a number that says in which order.
typedef struct seen {
    uint64_t count;
    double order;
} seen;

static ewa_status see(void *user, const ewa_cloud *piece) {
    seen *s = user;
    const ewa_attribute *position = ewa_cloud_find(piece, EWA_POSITION);
    double origin[3];
    ewa_cloud_origin(piece, origin);
    for (uint64_t i = 0; i < ewa_cloud_point_count(piece); i++) {
        double at[3];
        ewa_attribute_read_f64(position, i, 1, at);
        s->order = s->order * 0.999 + at[0] + origin[0];
        s->count++;
    }
    return EWA_OK;
}

/// Which files are read again: those that did not fit, and all behind them. A file that is gone tells.
TEST_WITHIN(test_pieces_are_kept, enter, NULL) {
    enum { COUNT = 1000 };
    static const struct {
        uint64_t keep_bytes;
        bool kept[2];
    } cases[] = {{0, {false, false}}, {COUNT * 80, {true, false}}, {COUNT * 160, {true, true}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int gone = 0; gone < 2; gone++) {
            OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
            static const char *const names[2] = {"a.laz", "b.laz"};
            char paths[2][512];
            for (int k = 0; k < 2; k++) {
                lod_save(lod_ground(context, (uint64_t)k * COUNT, COUNT, (lod_look){.colors = true}), names[k]);
                scratch_path(names[k], paths[k]);
            }
            const char *const both[2] = {paths[0], paths[1]};
            ewa_inputs inputs;
            seen first = {0, 0}, again = {0, 0};
            assert_int_equal(ewa_inputs_open(context, both, 2, false, cases[i].keep_bytes, &inputs), EWA_OK);
            assert_int_equal(ewa_inputs_read(&inputs, "first", see, &first), EWA_OK);
            assert_true(inputs.kept_bytes <= cases[i].keep_bytes);
            remove(paths[gone]);
            const bool kept = cases[i].kept[gone];
            assert_int_equal(ewa_inputs_read(&inputs, "again", see, &again), kept ? EWA_OK : EWA_ERROR_IO);
            assert_int_equal(first.count, 2 * COUNT);
            if (kept) assert_true(again.count == first.count && again.order == first.order);
            ewa_inputs_forget(&inputs);
            assert_int_equal(ewa_inputs_read(&inputs, "forgotten", see, &again), EWA_ERROR_IO);
            ewa_inputs_free(&inputs);
        }
    lod_clear();
}

int main(void) { return RUN_TESTS(NULL, NULL); }
