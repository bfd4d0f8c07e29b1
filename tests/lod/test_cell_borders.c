// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Borders of the points of one node, estimated alone: what ends at its cube's inner faces goes, what ends elsewhere stays.
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cloud/cloud.h"
#include "ewa/prepare.h"
#include "lod/cell_borders.h"

enum { POINTS = 6000 };

/// The root's cube from -1 to 1; of its eight nodes the points of one, at x and y below 0: a quarter of a square.
static const ewa_octree_facts facts = {.low_world = {-1, -1, -1}, .side_world = 2};
static const ewa_octree_key quarter = {.level = 1, .cell = {0, 0, 1}};

/// How many borders there are along the square's own sides, away from the faces, and along the inner faces.
typedef struct border_counts {
    int own, inner;
} border_counts;

/// A map that turns, enlarges and moves; with `shear` it keeps no angles.
static void make_map(double shear, double m[16]) {
    const double rows[16] = {0, -3, shear, 50, 3, 0, 0, -20, 0, 0, 3, 7, 0, 0, 0, 1};
    for (int i = 0; i < 16; i++) m[i] = rows[i];
}

static border_counts count_borders(ewa_context *context, const ewa_octree_key *key, const double *to_world, double z) {
    static const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double *m = to_world ? to_world : none;
    check_random random = {11};
    static double places[POINTS][2];
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, POINTS);
    float *p = check_add(cloud, EWA_POSITION, EWA_F32, 3);
    for (int i = 0; i < POINTS; i++) {
        double at[3] = {0, 0, z};
        for (int c = 0; c < 2; c++) at[c] = places[i][c] = check_uniform(&random, -1, 0);
        for (int r = 0; r < 3; r++)
            p[3 * i + r] = (float)(m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3]);
    }
    WITH_DEFAULTS(ewa_estimate_options, options);
    assert_int_equal(ewa_cloud_estimate(&cloud, &options), EWA_OK);
    ewa_cell_keep_borders(&facts, key, m, cloud);
    border_counts counts = {0};
    const ewa_attribute *border = ewa_cloud_find(cloud, EWA_BORDER);
    for (uint64_t i = 0; border && i < POINTS; i++) {
        double to[3];
        ewa_attribute_read_f64(border, i, 1, to);
        const double low = fmin(places[i][0], places[i][1]), high = fmax(places[i][0], places[i][1]);
        if (to[0] == 0 && to[1] == 0 && to[2] == 0) continue;
        counts.own += high < -0.1;
        counts.inner += high > -0.1 && low > -0.9;
    }
    return counts;
}

TEST_ON(test_faces, 2) {
    static const ewa_octree_key root = {.level = 0};
    const border_counts all = count_borders(context, &root, NULL, 0.3), kept = count_borders(context, &quarter, NULL, 0.3);
    print_message("all: %d at its own sides, %d at inner faces; kept: %d, %d\n", all.own, all.inner, kept.own, kept.inner);
    assert_true(all.own > 100 && all.inner > 100);
    assert_true(kept.own == all.own && kept.inner == 0);
    // Along a face, which cuts what lies just beside it anyhow.
    assert_true(count_borders(context, &quarter, NULL, 1e-4).own == 0);
    double m[16];
    make_map(0, m);
    const border_counts moved = count_borders(context, &quarter, m, 0.3);
    assert_true(abs(moved.own - all.own) < 20 && moved.inner == 0);
    make_map(0.5, m);
    const border_counts sheared = count_borders(context, &quarter, m, 0.3);
    assert_true(sheared.own == 0 && sheared.inner == 0);
}

/// What files call borders and radii has other shapes: it is left out, and nothing is written beyond it.
TEST_ON(test_other_shapes, 0) {
    static const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const ewa_octree_key keys[2] = {{.level = 0}, {.level = 1, .cell = {0, 0, 1}}};
    static const struct {
        ewa_type type;
        uint32_t border_components, radius_components;
    } shapes[] = {{EWA_U8, 1, 1}, {EWA_F32, 1, 1}, {EWA_F32, 4, 1}, {EWA_F64, 3, 1}, {EWA_F32, 3, 4}, {EWA_F32, 3, 0}};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int k = 0; k < 2; k++) {
            OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1000);
            uint8_t *to = check_add(cloud, EWA_POSITION, EWA_F32, 3);
            memset(to, 0, 3000 * sizeof(float));
            assert_int_equal(ewa_cloud_add(cloud, EWA_BORDER, shapes[s].type, shapes[s].border_components, (void **)&to), EWA_OK);
            memset(to, 1, 1000 * shapes[s].border_components * ewa_type_bytes(shapes[s].type));
            if (shapes[s].radius_components) {
                assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, shapes[s].radius_components, (void **)&to), EWA_OK);
                memset(to, 1, 1000 * shapes[s].radius_components * sizeof(float));
            }
            ewa_cell_keep_borders(&facts, &keys[k], none, cloud);
            assert_null(ewa_cloud_find(cloud, EWA_BORDER));
        }
}

TEST_ON(test_no_borders, 0) {
    void *to;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = check_cloud_of(context, 1000);
    ewa_cell_drop_empty_borders(cloud);
    assert_int_equal(ewa_cloud_add(cloud, EWA_BORDER, EWA_F32, 3, &to), EWA_OK);
    memset(to, 0, 3000 * sizeof(float));
    ((float *)to)[2999] = 1;
    ewa_cell_drop_empty_borders(cloud);
    assert_non_null(ewa_cloud_find(cloud, EWA_BORDER));
    ((float *)to)[2999] = 0;
    ewa_cell_drop_empty_borders(cloud);
    assert_null(ewa_cloud_find(cloud, EWA_BORDER));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
