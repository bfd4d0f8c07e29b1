// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud/thin_voxels.c, thin_distance.c and cubes.c: thinning, against its definitions by brute
// force.
#include "check.h"

#include <math.h>

/// A cloud of tests: F64 positions, and its number as "id".
static ewa_cloud *make_cloud(ewa_context *context, uint32_t count, const double *positions,
                             const double origin[3]) {
    void *data, *ids;
    ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &data), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, "id", EWA_U32, 1, &ids), EWA_OK);
    memcpy(data, positions, 3 * count * sizeof *positions);
    for (uint32_t i = 0; i < count; i++) ((uint32_t *)ids)[i] = i;
    ewa_cloud_set_origin(cloud, origin);
    return cloud;
}

static const double no_origin[3] = {0, 0, 0};

/// Points of a kind: in a cube, on a wavy sheet, on a line, many at the same places, on a lattice, with far
/// outliers.
static void fill(int kind, uint32_t count, double *p) {
    check_random random = {(uint64_t)kind};
    for (uint32_t i = 0; i < count; i++, p += 3) {
        check_uniform3(&random, -3, 3, p);
        if (kind == 1) p[2] = 0.3 * sin(3 * p[0]) * cos(2 * p[1]);
        if (kind == 2) p[1] = p[2] = 0.25;
        if (kind == 3)
            for (int c = 0; c < 3; c++) p[c] = floor(p[c] * 2) / 2;
        if (kind == 4)
            for (int c = 0; c < 3; c++) p[c] = (double)(i / (c == 0 ? 1 : c == 1 ? 17 : 289) % 17) * 0.125;
        if (kind == 5 && i % 100 == 0) p[i / 100 % 3] = 1e9 * (i % 200 ? -1 : 1);
        if (kind == 6 && i % 50 == 0) p[i % 3] = i % 100 ? NAN : INFINITY;
    }
}

enum { KINDS = 7, COUNT = 6000 };

static bool is_finite(const double *p) { return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]); }

static double distance2(const double *a, const double *b) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/// No two that stay are nearer than the distance, and every one that goes is nearer to one that stays.
static void check_distance(const double *p, uint32_t count, const uint8_t *wanted, const uint8_t *marks,
                           double distance) {
    for (uint32_t i = 0; i < count; i++) {
        if (!wanted[i] || !is_finite(p + 3 * i)) {
            assert_int_equal(marks[i], 0);
            continue;
        }
        bool near = false;
        for (uint32_t k = 0; k < count && !near; k++)
            near = k != i && marks[k] && distance2(p + 3 * i, p + 3 * k) < distance * distance;
        if (near == (marks[i] != 0)) fail_msg("point %u %s", i, near ? "stays near another" : "is missing");
    }
}

TEST_ON(test_distance, 3) {
    static double p[3 * COUNT];
    static const double distances[] = {0.05, 0.125, 0.31, 2, 30};
    for (int kind = 0; kind < KINDS; kind++) {
        fill(kind, COUNT, p);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT, p, no_origin);
        for (size_t k = 0; k < sizeof distances / sizeof distances[0]; k++) {
            uint8_t wanted[COUNT], marks[COUNT];
            for (int i = 0; i < COUNT; i++) wanted[i] = marks[i] = i % 13 != 0;
            assert_int_equal(ewa_cloud_thin_distance(cloud, distances[k], marks), EWA_OK);
            check_distance(p, COUNT, wanted, marks, distances[k]);
        }
    }
}

/// Two points at the very distance both stay; one step nearer, one goes.
TEST_ON(test_exact_distance, 1) {
    double p[6] = {0, 0, 0, 3, 4, 0};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, 2, p, no_origin);
    uint8_t marks[2] = {1, 1};
    assert_int_equal(ewa_cloud_thin_distance(cloud, 5, marks), EWA_OK);
    assert_true(marks[0] && marks[1]);
    assert_int_equal(ewa_cloud_thin_distance(cloud, nextafter(5, 6), marks), EWA_OK);
    assert_int_equal(marks[0] + marks[1], 1);
}

/// One point stays of each voxel, the one nearest to the mean.
static void check_voxels(const double *p, uint32_t count, const uint8_t *wanted, const uint8_t *marks,
                         double size, const double origin[3]) {
    for (uint32_t i = 0; i < count; i++) {
        if (!wanted[i] || !is_finite(p + 3 * i)) {
            assert_int_equal(marks[i], 0);
            continue;
        }
        double sum[3] = {0}, minimum = INFINITY, cell[3];
        uint32_t members[COUNT], member_count = 0;
        for (int c = 0; c < 3; c++) cell[c] = floor((p[3 * i + (uint32_t)c] + origin[c]) / size);
        for (uint32_t k = 0; k < count; k++) {
            bool same = wanted[k] && is_finite(p + 3 * k);
            for (uint32_t c = 0; same && c < 3; c++)
                same = floor((p[3 * k + c] + origin[c]) / size) == cell[c];
            if (!same) continue;
            if (k < i) break; // seen before, with its first point
            members[member_count++] = k;
            for (uint32_t c = 0; c < 3; c++) sum[c] += p[3 * k + c] - p[3 * i + c];
        }
        if (!member_count || members[0] != i) continue;
        double mean[3];
        uint32_t stays = 0, which = 0;
        for (uint32_t c = 0; c < 3; c++) mean[c] = p[3 * i + c] + sum[c] / member_count;
        for (uint32_t m = 0; m < member_count; m++) {
            minimum = fmin(minimum, distance2(p + 3 * members[m], mean));
            stays += marks[members[m]];
            if (marks[members[m]]) which = members[m];
        }
        assert_int_equal(stays, 1);
        if (sqrt(distance2(p + 3 * which, mean)) > sqrt(minimum) + 1e-8 * size)
            fail_msg("point %u is %g from the mean, another %g", which, sqrt(distance2(p + 3 * which, mean)),
                     sqrt(minimum));
    }
}

TEST_ON(test_voxels, 3) {
    static double p[3 * COUNT];
    static const double sizes[] = {0.05, 0.125, 0.31, 2, 30}, far[3] = {500000.125, -4200000, 123};
    for (int kind = 0; kind < KINDS; kind++) {
        fill(kind, COUNT, p);
        const double *origin = kind % 2 ? far : no_origin;
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, COUNT, p, origin);
        for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
            uint8_t wanted[COUNT], marks[COUNT];
            for (int i = 0; i < COUNT; i++) wanted[i] = marks[i] = i % 13 != 0;
            assert_int_equal(ewa_cloud_thin_voxels(cloud, sizes[k], marks), EWA_OK);
            check_voxels(p, COUNT, wanted, marks, sizes[k], origin);
        }
    }
}

/// Known answers: cubes are aligned to the world's origin, below as above.
TEST_ON(test_known_voxels, 2) {
    const double p[] = {0.1, 0, 0, 0.9, 0, 0, 0.45, 0, 0, -0.1, 0, 0, 1, 0, 0, 1.5, 0, 0};
    const uint8_t expected[] = {0, 0, 1, 1, 1, 0};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, 6, p, no_origin);
    uint8_t marks[] = {1, 1, 1, 1, 1, 1};
    assert_int_equal(ewa_cloud_thin_voxels(cloud, 1, marks), EWA_OK);
    assert_memory_equal(marks, expected, sizeof marks);
}

/// Numbers of the points that stay, in rising order.
static uint32_t thin(ewa_context *context, bool voxels, uint32_t count, const double *p, const uint32_t *ids,
                     const double origin[3], uint8_t *stays) {
    ewa_cloud *cloud = make_cloud(context, count, p, origin);
    memcpy(ewa_cloud_find(cloud, "id")->data, ids, count * sizeof *ids);
    uint8_t *marks = malloc(count);
    assert_non_null(marks);
    memset(marks, 1, count);
    assert_int_equal(voxels ? ewa_cloud_thin_voxels(cloud, 0.21, marks)
                            : ewa_cloud_thin_distance(cloud, 0.21, marks),
                     EWA_OK);
    memset(stays, 0, count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        stays[ids[i]] = marks[i];
        kept += marks[i];
    }
    free(marks);
    ewa_cloud_destroy(&cloud);
    return kept;
}

/// Neither the order of the points, nor threads, nor the origin that the same places are kept from change what
/// stays; duplicates are told apart by their other attributes.
TEST(test_order_and_threads) {
    enum { MANY = 40000 };
    double *p = malloc(3 * MANY * sizeof *p), *q = malloc(3 * MANY * sizeof *q);
    uint32_t *ids = malloc(MANY * sizeof *ids);
    OWNED(check_free) uint8_t *first = malloc(MANY), *other = malloc(MANY);
    assert_true(p && q && ids && first && other);
    for (int run = 0; run < 2 * KINDS; run++) {
        fill(run % KINDS, MANY, p);
        for (int i = 0; i < 3 * MANY; i++) p[i] = floor(p[i] * 1024) / 1024; // exact from both origins
        ewa_context *context = check_context(1, NULL);
        for (uint32_t i = 0; i < MANY; i++) ids[i] = i;
        const uint32_t kept = thin(context, run >= KINDS, MANY, p, ids, no_origin, first);
        assert_in_range(kept, 1, MANY - 1);
        ewa_context_destroy(&context);
        static const uint32_t threads[] = {2, 5, 1};
        static const double moved[3] = {-64, 128, 0.5};
        for (int k = 0; k < 3; k++) {
            context = check_context(threads[k], NULL);
            check_random random = {(uint64_t)(77 + k)};
            for (uint32_t i = MANY; i-- > 1;) {
                const uint32_t to = (uint32_t)(check_random_u64(&random) % (i + 1)), id = ids[i];
                ids[i] = ids[to];
                ids[to] = id;
            }
            for (uint32_t i = 0; i < MANY; i++)
                for (uint32_t c = 0; c < 3; c++) q[3 * i + c] = p[3 * ids[i] + c] - (k == 2 ? moved[c] : 0);
            assert_int_equal(thin(context, run >= KINDS, MANY, q, ids, k == 2 ? moved : no_origin, other),
                             kept);
            assert_memory_equal(first, other, MANY);
            ewa_context_destroy(&context);
        }
    }
    free(p), free(q), free(ids);
}

TEST_LOGGED(test_refusals, 2) {
    const double p[] = {0, 0, 0, 1e30, 0, 0};
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_cloud(context, 2, p, no_origin);
    uint8_t marks[2] = {1, 1};
    static const double bad[] = {0, -1, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(ewa_cloud_thin_voxels(cloud, bad[k], marks), EWA_ERROR_ARGUMENT);
        assert_int_equal(ewa_cloud_thin_distance(cloud, bad[k], marks), EWA_ERROR_ARGUMENT);
    }
    assert_int_equal(ewa_cloud_thin_voxels(cloud, 1e-300, marks), EWA_OK);
    assert_true(marks[0] && marks[1]);
    assert_int_equal(ewa_cloud_thin_distance(cloud, 0.01, marks), EWA_ERROR_NUMERIC);
    assert_non_null(strstr(log->text, "a distance of 0.01 cannot be kept: coordinates are over 1.0"));
    marks[0] = 1, marks[1] = 0; // a point that is left out does no harm
    assert_int_equal(ewa_cloud_thin_distance(cloud, 0.01, marks), EWA_OK);
    assert_true(marks[0] && !marks[1]);
    ewa_cloud_remove(cloud, EWA_POSITION);
    assert_int_equal(ewa_cloud_thin_voxels(cloud, 1, marks), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_cloud_thin_distance(cloud, 1, marks), EWA_ERROR_ARGUMENT);
    ewa_cloud_destroy(&cloud);
    assert_int_equal(ewa_cloud_create(context, 0, &cloud), EWA_OK);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F32, 3, NULL), EWA_OK);
    assert_int_equal(ewa_cloud_thin_voxels(cloud, 1, marks), EWA_OK);
    assert_int_equal(ewa_cloud_thin_distance(cloud, 1, marks), EWA_OK);
}

/// Whichever allocation fails, the call says so and holds nothing.
TEST(test_memory) {
    static double p[3 * COUNT];
    fill(1, COUNT, p);
    for (int voxels = 0; voxels < 2; voxels++) {
        ewa_status status = EWA_ERROR_MEMORY;
        for (long fails = 0; status != EWA_OK; fails++) {
            assert_in_range(fails, 0, 40);
            check_memory memory = {.calls_left = -1};
            ewa_context *context = check_context_on(2, &memory);
            ewa_cloud *cloud = make_cloud(context, COUNT, p, no_origin);
            uint8_t marks[COUNT];
            memset(marks, 1, sizeof marks);
            const int64_t before = memory.held_bytes;
            memory.calls_left = fails;
            status = voxels ? ewa_cloud_thin_voxels(cloud, 0.1, marks)
                            : ewa_cloud_thin_distance(cloud, 0.1, marks);
            assert_true(status == EWA_OK || status == EWA_ERROR_MEMORY);
            assert_true(memory.held_bytes == before);
            memory.calls_left = -1;
            ewa_cloud_destroy(&cloud);
            ewa_context_destroy(&context);
            assert_true(memory.held_bytes == 0);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
