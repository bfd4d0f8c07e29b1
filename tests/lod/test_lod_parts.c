// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees made in parts: the same bytes as at once, whatever the order; parts that do not fit are refused.
#include "lod/lod_scene.h"

enum { POINTS = 300000, PARTS = 3 };

static const char *const whole_files[] = {"a.ply", "b.ply"};
static const char *const part_files[PARTS] = {"p0", "p1", "p2"};
static uint64_t part_points[PARTS];

static void make_parts(ewa_context *context, const char *const *names, uint32_t count,
                       const char *const *parts, uint64_t *points) {
    for (uint32_t i = 0; i < PARTS; i++) {
        WITH_DEFAULTS(ewa_lod_build_options, options);
        options.memory_bytes = LOD_MEMORY_BYTES;
        options.subset = i, options.subset_count = PARTS;
        ewa_lod_build_stats stats;
        assert_int_equal(lod_build(context, names, count, parts[i], &options, &stats), EWA_OK);
        if (points) points[i] = stats.point_count;
    }
}

/// Adds an attribute that what represents points has, too.
static ewa_cloud *with_classes(ewa_cloud *cloud) {
    void *classes = NULL;
    assert_int_equal(ewa_cloud_add(cloud, "classification", EWA_U8, 1, &classes), EWA_OK);
    for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) ((uint8_t *)classes)[i] = (uint8_t)(i % 7);
    return cloud;
}

/// Makes the whole at once and in parts, for all tests.
static int enter(void **state) {
    lod_clear();
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    const lod_look look = {true, true};
    lod_save(with_classes(lod_ground(context, 0, POINTS / 3, look)), whole_files[0]);
    lod_save(with_classes(lod_ground(context, POINTS / 3, POINTS - POINTS / 3, look)), whole_files[1]);
    make_parts(context, whole_files, 2, part_files, part_points);
    assert_int_equal(lod_build(context, whole_files, 2, "whole.copc.laz", NULL, NULL), EWA_OK);
    return 0;
}

static int leave(void **state) {
    lod_clear();
    return 0;
}

static ewa_status merge(ewa_context *context, const char *const *names, uint32_t count, const char *out,
                        ewa_lod_build_stats *stats) {
    enum { MAXIMUM = 4 };
    char paths[MAXIMUM][512], out_path[512];
    const char *given[MAXIMUM];
    for (uint32_t i = 0; i < count; i++) given[i] = scratch_path(names[i], paths[i]);
    return ewa_lod_merge(context, given, count, scratch_path(out, out_path), stats);
}

TEST(test_orders) {
    static const uint32_t orders[][PARTS] = {{0, 1, 2}, {1, 2, 0}, {2, 1, 0}};
    uint64_t sum = 0;
    // Several regions, so that there is something to merge.
    for (int i = 0; i < PARTS; i++) {
        assert_true(part_points[i] > 0 && part_points[i] < POINTS);
        sum += part_points[i];
    }
    assert_int_equal(sum, POINTS);
    for (size_t k = 0; k < 3; k++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context((uint32_t)k + 1, NULL);
        const char *names[PARTS];
        for (int i = 0; i < PARTS; i++) names[i] = part_files[orders[k][i]];
        ewa_lod_build_stats stats;
        assert_int_equal(merge(context, names, PARTS, "m.copc.laz", &stats), EWA_OK);
        assert_int_equal(stats.point_count, POINTS);
        lod_hold_same_files("whole.copc.laz", "m.copc.laz");
    }
    char path[512];
    unlink(scratch_path("m.copc.laz", path));
}

/// Fails unless merging is refused and leaves no file.
static void hold_refused(ewa_context *context, const char *const *names, uint32_t count, check_log *log) {
    *log = (check_log){0};
    const ewa_status status = merge(context, names, count, "x.copc.laz", NULL);
    if (status != EWA_ERROR_FORMAT) fail_msg("status %d instead of EWA_ERROR_FORMAT", (int)status);
    assert_true(log->count > 0);
    assert_false(lod_is_there("x.copc.laz"));
}

TEST_LOGGED(test_wrong_parts, 1) {
    hold_refused(context, (const char *const[]){"p0", "p1"}, 2, log);
    hold_refused(context, (const char *const[]){"p0", "p1", "p1"}, 3, log);
    assert_non_null(strstr(log->text, "twice"));
    hold_refused(context, (const char *const[]){"p0", "p1", "p2", "p0"}, 4, log);
    hold_refused(context, (const char *const[]){"p0", "p1", "a.ply"}, 3, log);
    hold_refused(context, (const char *const[]){"whole.copc.laz"}, 1, log);
    // One of other points.
    static const char *const other_files[] = {"c.ply"}, *const other_parts[] = {"q0", "q1", "q2"};
    lod_save(lod_ground(context, 5, POINTS / 10, (lod_look){true, true}), "c.ply");
    make_parts(context, other_files, 1, other_parts, NULL);
    hold_refused(context, (const char *const[]){"p0", "q1", "p2"}, 3, log);
    assert_non_null(strstr(log->text, "other points"));
}

/// Fewer regions than parts, or none at all.
TEST_ON(test_empty_parts, 2) {
    static const char *const files[] = {"e.ply"}, *const parts[] = {"e0", "e1", "e2"};
    static const uint64_t counts[] = {0, 1, 1000};
    for (int i = 0; i < 3; i++) {
        lod_save(lod_ground(context, 0, counts[i], (lod_look){.colors = true}), files[0]);
        make_parts(context, files, 1, parts, NULL);
        assert_int_equal(lod_build(context, files, 1, "e.copc.laz", NULL, NULL), EWA_OK);
        ewa_lod_build_stats stats;
        assert_int_equal(merge(context, parts, PARTS, "em.copc.laz", &stats), EWA_OK);
        assert_int_equal(stats.point_count, counts[i]);
        lod_hold_same_files("e.copc.laz", "em.copc.laz");
    }
}

/// A byte that is another, at many places, and ends of all kinds.
TEST(test_damage) {
    enum { PLACES = 60 };
    check_log log;
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, &log);
    check_random random = {5};
    char path[512];
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(scratch_path("p1", path), &size_bytes);
    const char *const names[] = {"p0", "bad", "p2"};
    for (size_t i = 0; i < PLACES; i++) {
        // All of the head first, then anywhere.
        const size_t at = i < PLACES / 2 ? 2 * i : (size_t)(check_random_u64(&random) % size_bytes);
        bytes[at] ^= (uint8_t)(1u << i % 8);
        scratch_write(scratch_path("bad", path), bytes, size_bytes);
        bytes[at] ^= (uint8_t)(1u << i % 8);
        hold_refused(context, names, 3, &log);
    }
    for (size_t i = 0; i < PLACES / 2; i++) {
        const size_t left = i < 10    ? i * 8
                            : i == 10 ? size_bytes - 1
                                      : (size_t)(check_random_u64(&random) % size_bytes);
        scratch_write(scratch_path("bad", path), bytes, left);
        hold_refused(context, names, 3, &log);
    }
    scratch_write(scratch_path("bad", path), bytes, size_bytes);
    assert_int_equal(merge(context, names, 3, "x.copc.laz", NULL), EWA_OK);
    lod_hold_same_files("whole.copc.laz", "x.copc.laz");
}

int main(void) { return RUN_TESTS(enter, leave); }
