// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/cloud/morton.c: against a plain sort, at any scale, with any number of threads.
#include "check.h"
#include "cloud/morton.h"

#include <math.h>
#include <string.h>

typedef struct plain_item {
    uint64_t code;
    uint32_t index;
} plain_item;

static int compare_plain(const void *a, const void *b) {
    const plain_item *l = a, *r = b;
    if (l->code != r->code) return l->code < r->code ? -1 : 1;
    return l->index < r->index ? -1 : 1;
}

static ewa_attribute positions_of(const float *xyz) {
    return (ewa_attribute){.name = EWA_POSITION,
                           .type = EWA_F32,
                           .component_count = 3,
                           .stride_bytes = 3 * sizeof *xyz,
                           .data = (void *)(uintptr_t)xyz};
}

static float *random_points(uint32_t count, uint64_t seed) {
    float *xyz = malloc(3 * sizeof *xyz * count);
    assert_non_null(xyz);
    check_random random = {seed};
    for (uint32_t i = 0; i < 3 * count; i++) xyz[i] = (float)check_uniform(&random, -3, 5);
    return xyz;
}

static void order_points(uint32_t threads, const float *xyz, uint32_t count, uint32_t *order,
                         uint16_t *level) {
    ewa_context *context = check_context(threads, NULL);
    const ewa_attribute position = positions_of(xyz);
    assert_int_equal(ewa_morton_order(context, &position, count, order, level, NULL), EWA_OK);
    ewa_context_destroy(&context);
}

/// Interleaves bit by bit the cells of the one grid that a cloud without dense cells needs.
TEST(test_against_plain_sort) {
    enum { COUNT = 200000 };
    OWNED(check_free) float *xyz = random_points(COUNT, 1);
    OWNED(check_free) plain_item *items = calloc(COUNT, sizeof *items);
    OWNED(check_free) uint32_t *order = calloc(COUNT, sizeof *order);
    double low[3] = {INFINITY, INFINITY, INFINITY}, high = 0;
    for (int i = 0; i < 3 * COUNT; i++) low[i % 3] = fmin(low[i % 3], xyz[i]);
    for (int i = 0; i < 3 * COUNT; i++) high = fmax(high, xyz[i] - low[i % 3]);
    for (uint32_t i = 0; i < COUNT; i++) {
        items[i].index = i;
        for (int c = 0; c < 3; c++) {
            const double cell =
                fmin(floor((xyz[3 * i + (uint32_t)c] - low[c]) * (0x1p21 / high)), 0x1p21 - 1);
            for (int bit = 0; bit < 21; bit++) items[i].code |= ((uint64_t)cell >> bit & 1) << (3 * bit + c);
        }
    }
    qsort(items, COUNT, sizeof *items, compare_plain);
    order_points(2, xyz, COUNT, order, NULL);
    uint32_t differing = 0;
    for (uint32_t i = 0; i < COUNT; i++) differing += order[i] != items[i].index;
    // Half units round differently where a coordinate sits on a cell's border.
    assert_in_range(differing, 0, 8);
}

/// A mixture that needs many grids: clusters down to 1e-30, an outlier, duplicates, NaN.
static float *hostile_points(uint32_t count) {
    float *xyz = random_points(count, 2);
    check_random random = {3};
    for (uint32_t i = 0; i < count; i++) {
        float *p = &xyz[3 * i];
        switch (i % 5) {
        case 0:
            break;
        case 1:
            for (int c = 0; c < 3; c++) p[c] *= 1e-9f;
            break;
        case 2:
            for (int c = 0; c < 3; c++) p[c] *= 1e-30f;
            break;
        case 3:
            p[0] = p[1] = p[2] = 0.25f;
            break;
        default:
            for (int c = 0; c < 3; c++) p[c] = floorf(p[c] * 4) / 4;
        }
        if (check_uniform(&random, 0, 1) < 0.001) p[i % 3] = i % 2 ? NAN : INFINITY;
    }
    xyz[0] = 1e30f;
    return xyz;
}

TEST(test_threads) {
    enum { COUNT = 150000 };
    static const uint32_t threads[] = {2, 7, 32};
    OWNED(check_free) float *xyz = hostile_points(COUNT);
    OWNED(check_free) uint32_t *first = calloc(COUNT, sizeof *first), *order = calloc(COUNT, sizeof *order);
    OWNED(check_free) uint16_t *first_level = calloc(COUNT, sizeof *first_level), *level = calloc(COUNT, sizeof *level);
    order_points(1, xyz, COUNT, first, first_level);
    for (int t = 0; t < 3; t++) {
        memset(order, 0xff, COUNT * sizeof *order);
        memset(level, 0xee, COUNT * sizeof *level);
        order_points(threads[t], xyz, COUNT, order, level);
        assert_memory_equal(order, first, COUNT * sizeof *order);
        assert_memory_equal(level, first_level, COUNT * sizeof *level);
    }
    // Each index once; those that are not finite at the end.
    OWNED(check_free) uint8_t *seen = calloc(COUNT, 1);
    bool tail = false;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float *p = &xyz[3 * order[i]];
        const bool finite = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
        assert_false(tail && finite);
        tail = !finite;
        assert_int_equal(seen[order[i]]++, 0);
    }
    assert_true(tail);
}

/// An outlier so far away that all others share a cell leaves their order as it was.
TEST(test_outlier) {
    enum { COUNT = 100000 };
    OWNED(check_free) float *xyz = random_points(COUNT, 4);
    OWNED(check_free) uint32_t *alone = calloc(COUNT, sizeof *alone), *order = calloc(COUNT, sizeof *order);
    order_points(2, xyz, COUNT - 1, alone, NULL);
    for (int c = 0; c < 3; c++) xyz[3 * (COUNT - 1) + c] = 3e38f;
    order_points(2, xyz, COUNT, order, NULL);
    assert_int_equal(order[COUNT - 1], COUNT - 1);
    assert_memory_equal(order, alone, (COUNT - 1) * sizeof *order);
}

/// Doubles of georeferenced data are told apart to the last digit.
TEST_ON(test_double, 1) {
    enum { COUNT = 1000 };
    double xyz[3 * COUNT];
    uint32_t order[COUNT], finite = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        xyz[3 * i] = 4e6 + 1e-7 * ((i * 617) % COUNT);
        xyz[3 * i + 1] = 5e5;
        xyz[3 * i + 2] = i ? 0 : -1e307;
    }
    const ewa_attribute position = {
        .type = EWA_F64, .component_count = 3, .stride_bytes = 3 * sizeof *xyz, .data = xyz};
    assert_int_equal(ewa_morton_order(context, &position, COUNT, order, NULL, &finite), EWA_OK);
    assert_int_equal(finite, COUNT);
    assert_int_equal(order[0], 0);
    for (uint32_t i = 2; i < COUNT; i++) assert_true(xyz[3 * order[i]] >= xyz[3 * order[i - 1]]);
}

/// The smallest level inside a run says how large a cell holds it: runs cut there are boxes that do not
/// overlap.
TEST(test_split_levels) {
    enum { COUNT = 50000 };
    OWNED(check_free) float *xyz = random_points(COUNT, 5);
    OWNED(check_free) uint32_t *order = calloc(COUNT, sizeof *order);
    OWNED(check_free) uint16_t *level = calloc(COUNT, sizeof *level);
    order_points(2, xyz, COUNT, order, level);
    for (uint16_t cut = 2; cut < 14; cut++) {
        // All points of one run lie in a box whose edges are at most the cell's, so its volume is bounded.
        const int halvings[3] = {(cut - 1 + 0) / 3, (cut - 1 + 1) / 3, (cut - 1 + 2) / 3};
        float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (uint32_t i = 0; i < COUNT; i++) {
            if (i && level[i] <= cut - 1) {
                for (int c = 0; c < 3; c++) low[c] = INFINITY, high[c] = -INFINITY;
            }
            for (int c = 0; c < 3; c++) {
                low[c] = fminf(low[c], xyz[3 * order[i] + (uint32_t)c]);
                high[c] = fmaxf(high[c], xyz[3 * order[i] + (uint32_t)c]);
                assert_true(high[c] - low[c] <= ldexpf(8.0001f, -halvings[c]));
            }
        }
    }
}

TEST_ON(test_few, 2) {
    float xyz[3 * 40] = {0};
    const ewa_attribute position = positions_of(xyz);
    uint32_t order[40];
    uint16_t level[40];
    for (uint32_t count = 0; count <= 40; count++) {
        assert_int_equal(ewa_morton_order(context, &position, count, order, level, NULL), EWA_OK);
        for (uint32_t i = 0; i < count; i++) {
            assert_int_equal(order[i], i);
            if (i) assert_int_equal(level[i], EWA_MORTON_SAME);
        }
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
