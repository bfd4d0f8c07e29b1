// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud/neighbours*.c: exactly what brute force finds, for samplings that break grids.
#include "check.h"
#include "cloud/neighbours.h"

#include <math.h>
#include <string.h>

enum { KINDS = 11, MAX_LISTED = 256 };

static double normal_deviate(check_random *random) {
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += check_uniform(random, 0, 1);
    return sum;
}

static void make_point(int kind, uint32_t i, uint32_t count, check_random *random, float p[3]) {
    double x = check_uniform(random, -1, 1), y = check_uniform(random, -1, 1),
           z = check_uniform(random, -1, 1);
    const double length = sqrt(x * x + y * y + z * z) + 1e-9;
    const uint32_t side = (uint32_t)sqrt((double)count);
    switch (kind) {
    case 0:
        break; // volume
    case 1:
        x /= length, y /= length, z /= length;
        break;
    case 2:
        x = i % side, y = (double)(i / side), z = 0;
        break; // regular grid: nothing but ties
    case 3:
        x = 0.001 * normal_deviate(random) + (i % 7), y *= i % 3 ? 1e-3 : 1, z *= 1e-3;
        break; // clusters
    case 4:
        x = floor(x * 4), y = floor(y * 4), z = floor(z * 2);
        break; // duplicates
    case 5:
        z = i % 2 ? 1e-4 : -1e-4;
        break; // thin sheet
    case 6:
        y = z = 0;
        break; // line
    case 7:
        x = x * x * x * x * x, y = y * y * y * y * y, z = 0;
        break; // density over many decades
    case 8:
        if (i % 50 == 0) x *= 1000, y *= 1000, z *= 1000; // outliers
        break;
    case 9:
        x = i ? x * 1e-30 : 1e30, y *= 1e-30, z *= 1e-30;
        break;
    default:
        x = y = z = 0.5;
        break;
    }
    p[0] = (float)x, p[1] = (float)y, p[2] = (float)z;
    if (kind == 0 && i % 97 == 5) p[i % 3] = i % 2 ? NAN : -INFINITY;
}

typedef struct found {
    uint32_t count, listed[MAX_LISTED]; // places
    float radius2;                      // scaled back
    uint32_t visits;
} found;

static void keep_block(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    found *all = user;
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        found *f = &all[block->first_place + lane];
        f->visits++;
        f->radius2 = block->radius2[lane];
        for (uint32_t i = 0; i < block->candidate_count; i++)
            if (block->distance2[i][lane] <= block->radius2[lane] && f->count < MAX_LISTED)
                f->listed[f->count++] = block->place[i];
        // Candidates outside depend on how the search went; the neighbourhood must not.
        f->radius2 = (float)(f->radius2 * block->unit_world * block->unit_world);
    }
}

static int compare_float(const void *a, const void *b) {
    const float l = *(const float *)a, r = *(const float *)b;
    return l < r ? -1 : l > r;
}

static found *find_all(uint32_t threads, uint32_t cpu_mask, const ewa_attribute *position, uint32_t count,
                       uint32_t k, ewa_neighbours **tree, ewa_context **context) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.thread_count = threads;
    options.cpu_mask = cpu_mask;
    assert_int_equal(ewa_context_create(&options, context), EWA_OK);
    assert_int_equal(ewa_neighbours_create(*context, position, count, tree), EWA_OK);
    found *all = calloc((size_t)ewa_neighbours_place_count(*tree) + 1, sizeof *all);
    assert_non_null(all);
    const ewa_visit_choice choice = {k, 1, NULL, "test", 0, NULL};
    assert_int_equal(ewa_neighbours_visit(*tree, &choice, keep_block, all), EWA_OK);
    return all;
}

static ewa_attribute positions_of(const float *xyz) {
    return (ewa_attribute){.type = EWA_F32,
                           .component_count = 3,
                           .stride_bytes = 3 * sizeof *xyz,
                           .data = (void *)(uintptr_t)xyz};
}

static void check_against_brute_force(int kind, uint32_t count, uint32_t k) {
    OWNED(check_free) float *xyz = calloc(3 * (size_t)count + 1, sizeof *xyz);
    check_random random = {(uint64_t)kind * 1000 + count};
    uint32_t finite = 0;
    for (uint32_t i = 0; i < count; i++) {
        float *p = &xyz[3 * i];
        make_point(kind, i, count, &random, p);
        finite += isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
    }
    const ewa_attribute position = positions_of(xyz);
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
    OWNED(check_free) found *all = find_all(2, EWA_CPU_ALL, &position, count, k, &tree, &context);
    const uint32_t places = ewa_neighbours_place_count(tree);

    // Every finite point belongs to exactly one place, and places differ.
    float(*at)[3] = calloc(places + 1, sizeof *at);
    uint32_t members = 0;
    for (uint32_t p = 0; p < places; p++) {
        uint32_t n;
        const uint32_t *points = ewa_neighbours_points(tree, p, &n);
        assert_true(n > 0);
        memcpy(at[p], &xyz[3 * points[0]], sizeof at[p]);
        for (uint32_t j = 1; j < n; j++) {
            assert_true(points[j] > points[j - 1]);
            for (int c = 0; c < 3; c++) assert_true(xyz[3 * points[j] + (uint32_t)c] == at[p][c]);
        }
        members += n;
        assert_int_equal(all[p].visits, 1);
    }
    assert_int_equal(members, finite);

    float *sorted = calloc(places + 1, sizeof *sorted), *distance2 = calloc(places + 1, sizeof *sorted);
    const uint32_t step = places > 400 ? places / 400 : 1;
    for (uint32_t p = 0; p < places; p += step) {
        for (uint32_t q = 0; q < places; q++) {
            // Scaled like the block: by a power of two, which keeps 1e-30 and 1e30 in range.
            const double unit = kind == 9 && at[p][0] < 1 ? 0x1p-100 : kind == 9 ? 0x1p100 : 1;
            const float dx = (float)(at[q][0] / unit) - (float)(at[p][0] / unit);
            const float dy = (float)(at[q][1] / unit) - (float)(at[p][1] / unit);
            const float dz = (float)(at[q][2] / unit) - (float)(at[p][2] / unit);
            sorted[q] = distance2[q] = dx * dx + dy * dy + dz * dz;
        }
        qsort(sorted, places, sizeof *sorted, compare_float);
        const float radius2 = sorted[k < places ? k : places - 1];
        if (kind != 9) assert_true(all[p].radius2 == radius2);
        uint32_t n = 0;
        for (uint32_t q = 0; q < places && n < MAX_LISTED; q++) {
            if (!(distance2[q] <= radius2)) continue;
            assert_true(n < all[p].count);
            assert_int_equal(all[p].listed[n++], q);
        }
        assert_int_equal(all[p].count, n);
    }
    free(distance2);
    free(sorted);
    free(at);
}

TEST(test_against_brute_force) {
    for (int kind = 0; kind < KINDS; kind++) {
        check_against_brute_force(kind, 5000, 16);
        check_against_brute_force(kind, 3000, 6);
        check_against_brute_force(kind, 2000, 64);
    }
}

TEST(test_few_points) {
    for (int kind = 0; kind < KINDS; kind++)
        for (uint32_t count = 0; count < 40; count++) check_against_brute_force(kind, count, 16);
}

/// The same neighbourhoods for any number of threads and any instruction set.
TEST(test_threads_and_machines) {
    enum { COUNT = 20000 };
    static const uint32_t threads[] = {1, 7, 32, 2, 2};
    static const uint32_t masks[] = {EWA_CPU_ALL, EWA_CPU_ALL, EWA_CPU_ALL, EWA_CPU_AVX2, 0};
    OWNED(check_free) float *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    for (int kind = 0; kind < KINDS - 1; kind += 3) {
        check_random random = {77};
        for (uint32_t i = 0; i < COUNT; i++) make_point(kind, i, COUNT, &random, &xyz[3 * i]);
        const ewa_attribute position = positions_of(xyz);
        ewa_context *context = NULL;
        ewa_neighbours *tree = NULL;
        OWNED(check_free) found *first = find_all(2, EWA_CPU_ALL, &position, COUNT, 16, &tree, &context);
        const uint32_t places = ewa_neighbours_place_count(tree);
        ewa_neighbours_destroy(&tree);
        ewa_context_destroy(&context);
        for (int t = 0; t < 5; t++) {
            found *all = find_all(threads[t], masks[t], &position, COUNT, 16, &tree, &context);
            assert_memory_equal(all, first, places * sizeof *all);
            free(all);
            ewa_neighbours_destroy(&tree);
            ewa_context_destroy(&context);
        }
    }
}

/// Georeferenced doubles: the neighbourhoods of the same points near the origin.
TEST(test_double) {
    enum { COUNT = 4000, K = 12 };
    OWNED(check_free) double *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    check_random random = {5};
    // Multiples of 2^-20: exact at both places.
    for (uint32_t i = 0; i < 3 * COUNT; i++)
        xyz[i] = i % 3 == 2 ? 0 : floor(check_uniform(&random, 0, 1) * 0x1p20) * 0x1p-20;
    const ewa_attribute position = {
        .type = EWA_F64, .component_count = 3, .stride_bytes = 3 * sizeof *xyz, .data = xyz};
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
    OWNED(check_free) found *near = find_all(2, EWA_CPU_ALL, &position, COUNT, K, &tree, &context);
    ewa_neighbours_destroy(&tree);
    ewa_context_destroy(&context);
    for (uint32_t i = 0; i < 3 * COUNT; i++) xyz[i] += 5e6;
    OWNED(check_free) found *far = find_all(2, EWA_CPU_ALL, &position, COUNT, K, &tree, &context);
    for (uint32_t p = 0; p < ewa_neighbours_place_count(tree); p++) {
        assert_int_equal(far[p].count, near[p].count);
        assert_memory_equal(far[p].listed, near[p].listed, near[p].count * sizeof *near[p].listed);
    }
}

/// Places are where their points are, read from any place on.
TEST(test_positions) {
    enum { COUNT = 3000, STEP = 700 };
    OWNED(check_free) double *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    OWNED(check_free) float *single = calloc(3 * (size_t)COUNT, sizeof *single);
    check_random random = {6};
    for (uint32_t i = 0; i < 3 * COUNT; i++)
        xyz[i] = single[i] = (float)check_uniform(&random, 0, 1) + (float)(i % 3);
    for (int precise = 0; precise < 2; precise++) {
        const ewa_attribute position = {.type = precise ? EWA_F64 : EWA_F32,
                                        .component_count = 3,
                                        .stride_bytes = 3 * (precise ? sizeof *xyz : sizeof *single),
                                        .data = precise ? (void *)xyz : (void *)single};
        OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
        OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
        assert_int_equal(ewa_neighbours_create(context, &position, COUNT, &tree), EWA_OK);
        const uint32_t places = ewa_neighbours_place_count(tree);
        for (uint32_t first = 0; first < places; first += STEP) {
            double read[STEP][3];
            const uint32_t count = places - first < STEP ? places - first : STEP;
            ewa_neighbours_positions(tree, first, count, read);
            for (uint32_t i = 0; i < count; i++) {
                uint32_t points;
                const uint32_t point = *ewa_neighbours_points(tree, first + i, &points);
                for (int c = 0; c < 3; c++)
                    assert_true(fabs(read[i][c] - xyz[3 * (size_t)point + (size_t)c]) < 1e-7);
            }
        }
    }
}

static void count_lanes(void *user, const ewa_block *block, uint32_t worker) {
    uint32_t *lanes = user;
    lanes[16 * worker] += block->lane_count;
}

/// Clumps and far outliers cost no more than in proportion.
TEST(test_clumps) {
    enum { COUNT = 200000 };
    OWNED(check_free) float *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    check_random random = {6};
    for (uint32_t i = 0; i < COUNT; i++) {
        const double scale = i % 2 ? 0 : i % 4 ? 1e-12 : 1; // half of them at one place, a quarter in a speck
        for (int c = 0; c < 3; c++) xyz[3 * i + (uint32_t)c] = (float)(scale * check_uniform(&random, -1, 1));
    }
    for (int c = 0; c < 3; c++) xyz[c] = 1e38f;
    const ewa_attribute position = positions_of(xyz);
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
    assert_int_equal(ewa_neighbours_create(context, &position, COUNT, &tree), EWA_OK);
    uint32_t lanes[32] = {0};
    ewa_visit_choice choice = {16, 1, NULL, "test", 0, NULL};
    assert_int_equal(ewa_neighbours_visit(tree, &choice, count_lanes, lanes), EWA_OK);
    assert_int_equal(lanes[0] + lanes[16], COUNT / 2 + 1);
    memset(lanes, 0, sizeof lanes);
    choice.sample_step = 10;
    assert_int_equal(ewa_neighbours_visit(tree, &choice, count_lanes, lanes), EWA_OK);
    assert_in_range(lanes[0] + lanes[16], COUNT / 2 / 12, COUNT / 2 / 8);
    OWNED(check_free) uint8_t *chosen = calloc(COUNT, 1);
    chosen[COUNT / 4] = 1;
    choice = (ewa_visit_choice){16, 1, chosen, "test", 0, NULL};
    memset(lanes, 0, sizeof lanes);
    assert_int_equal(ewa_neighbours_visit(tree, &choice, count_lanes, lanes), EWA_OK);
    assert_in_range(lanes[0] + lanes[16], 1, EWA_BLOCK_LANES);
}

static void keep_radii(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    double *radius2 = user; // by place, world units
    for (uint32_t lane = 0; lane < block->lane_count; lane++)
        radius2[block->first_place + lane] =
            (double)block->radius2[lane] * block->unit_world * block->unit_world;
}

/// Places that are searched alone find what they find among others, whatever the search begins with: the
/// radius of a sparse leaf before a dense one, or a spacing that is wrong by any factor.
TEST_ON(test_chosen, 1) {
    enum { SPARSE = 200, COUNT = 4000 };
    static float xyz[3 * COUNT], spacing[COUNT];
    static double all[COUNT], some[COUNT];
    static uint8_t chosen[COUNT];
    check_random random = {8};
    for (uint32_t i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++)
            xyz[3 * i + (uint32_t)c] =
                (float)(i < SPARSE ? check_uniform(&random, 0, 8) : 10 + check_uniform(&random, 0, 0.25));
    const ewa_attribute position = positions_of(xyz);
    OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
    assert_int_equal(ewa_neighbours_create(context, &position, COUNT, &tree), EWA_OK);
    const uint32_t places = ewa_neighbours_place_count(tree);
    ewa_visit_choice choice = {64, 1, NULL, "test", 0, NULL};
    assert_int_equal(ewa_neighbours_visit(tree, &choice, keep_radii, all), EWA_OK);
    choice.chosen = chosen;
    choice.chosen_bits = 2;
    for (uint32_t step = 7; step < 30; step += 20) {
        for (int factor = -1; factor < 4; factor++) {
            static const float factors[] = {0, 1e-6f, 1, 1e6f};
            for (uint32_t i = 0; i < places; i++) {
                chosen[i] = i % step == 0 ? 2 : 1;
                some[i] = -1;
                spacing[i] = factor < 0 ? 0 : (float)sqrt(all[i]) * factors[factor];
            }
            choice.spacing = factor < 0 ? NULL : spacing;
            assert_int_equal(ewa_neighbours_visit(tree, &choice, keep_radii, some), EWA_OK);
            for (uint32_t i = 0; i < places; i++)
                if (chosen[i] == 2 || some[i] >= 0) assert_true(some[i] == all[i]);
        }
    }
}

static void check_places(void *user, const ewa_block *block, uint32_t worker) {
    (void)worker;
    const uint32_t places = *(const uint32_t *)user;
    assert_in_range(block->candidate_count, 0, EWA_BLOCK_CANDIDATES);
    for (uint32_t i = 0; i < block->candidate_count; i++) assert_in_range(block->place[i], 0, places - 1);
}

/// Doubles whose squared distances overflow: only places that are there are found, or none.
TEST(test_overflow) {
    enum { COUNT = 600 };
    OWNED(check_free) double *xyz = calloc(3 * (size_t)COUNT, sizeof *xyz);
    check_random random = {7};
    for (uint32_t i = 0; i < 3 * COUNT; i++) xyz[i] = check_uniform(&random, -1, 1);
    xyz[0] = 1e200, xyz[3] = -1e200, xyz[7] = 1.7e308;
    const ewa_attribute position = {
        .type = EWA_F64, .component_count = 3, .stride_bytes = 3 * sizeof *xyz, .data = xyz};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, NULL);
    for (int all = 0; all < 2; all++) { // a few far ones, then nothing else
        for (uint32_t i = 0; all && i < 3 * COUNT; i++) xyz[i] = 1e300 * check_uniform(&random, -1, 1);
        OWNED(ewa_neighbours_destroy) ewa_neighbours *tree = NULL;
        assert_int_equal(ewa_neighbours_create(context, &position, COUNT, &tree), EWA_OK);
        uint32_t places = ewa_neighbours_place_count(tree);
        assert_int_equal(places, COUNT);
        const ewa_visit_choice choice = {16, 1, NULL, "test", 0, NULL};
        assert_int_equal(ewa_neighbours_visit(tree, &choice, check_places, &places), EWA_OK);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
