// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels that represent others: areas are added, all else is a mean by area, sheets stay apart, cells too.
#include "check.h"
#include "lod/representative.h"

#include <math.h>

enum { CELL_LEVEL = 2, MANY = 1000 };

/// Surfel number `index` of a cell.
static ewa_representative surfel_of(uint64_t cell, uint32_t index, const float normal[3], float radius) {
    ewa_representative s = {.code = (cell << 3 * (EWA_CODE_LEVELS - CELL_LEVEL)) + index,
                            .radius_world = radius,
                            .alpha = 0.25f * (float)(1 + index % 3)};
    for (int c = 0; c < 3; c++) {
        s.at_world[c] = (double)(index + (uint32_t)c);
        s.normal[c] = normal[c];
        s.color[c] = 0.125f * (float)((index + (uint32_t)c) % 8);
    }
    return s;
}

static ewa_representatives merge(const ewa_representative *fine, uint32_t count) {
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_representatives merged = {.count = 0};
    const ewa_representatives all = {.items = (ewa_representative *)fine, .count = count};
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 0, UINT32_MAX, &merged), EWA_OK);
    ewa_representatives kept = merged; // of no context
    kept.items = malloc((merged.count + (size_t)1) * sizeof *kept.items);
    memcpy(kept.items, merged.items, merged.count * sizeof *kept.items);
    ewa_representatives_free(context, &merged);
    return kept;
}

static const float up[3] = {0, 0, 1}, ahead[3] = {1, 0, 0};

static void hold_near(double found, double wanted) {
    assert_true(fabs(found - wanted) <= 1e-6 * fmax(1, fabs(wanted)));
}

/// One alone stays as it is; of two of a sheet, areas are added and all else is their mean by area.
TEST(test_means) {
    const ewa_representative alone = surfel_of(3, 5, up, 2);
    ewa_representatives merged = merge(&alone, 1);
    assert_int_equal(merged.count, 1);
    assert_memory_equal(merged.items->at_world, alone.at_world, sizeof alone.at_world);
    assert_memory_equal(merged.items->shown, alone.color, sizeof alone.color);
    assert_true(merged.items->radius_world == 2);
    free(merged.items);
    const ewa_representative two[2] = {surfel_of(3, 1, up, 1), surfel_of(3, 5, up, 3)};
    merged = merge(two, 2);
    assert_int_equal(merged.count, 1);
    const ewa_representative *s = merged.items;
    hold_near((double)s->radius_world, sqrt(1 + 9));
    hold_near((double)s->alpha, 0.1 * (double)two[0].alpha + 0.9 * (double)two[1].alpha);
    for (int c = 0; c < 3; c++) {
        hold_near(s->at_world[c], 0.1 * two[0].at_world[c] + 0.9 * two[1].at_world[c]);
        hold_near((double)s->color[c], 0.1 * (double)two[0].color[c] + 0.9 * (double)two[1].color[c]);
        assert_true(s->shown[c] == s->color[c] && s->normal[c] == up[c]);
    }
    assert_int_equal(s->code, two[0].code);
    free(merged.items);
}

/// Normals up to 60 degrees apart are of one sheet, which is that of the first that is nearest.
TEST(test_sheets) {
    const float edge[3] = {sqrtf(0.75f), 0, 0.5f}, beyond[3] = {sqrtf(0.7501f), 0, 0.4999f},
                between[3] = {sqrtf(0.5f), 0, sqrtf(0.5f)};
    ewa_representative of[3] = {surfel_of(0, 0, up, 1), surfel_of(0, 1, edge, 1)};
    ewa_representatives merged = merge(of, 2);
    assert_int_equal(merged.count, 1);
    free(merged.items);
    of[1] = surfel_of(0, 1, beyond, 1);
    merged = merge(of, 2);
    assert_int_equal(merged.count, 2);
    free(merged.items);
    of[1] = surfel_of(0, 1, ahead, 1), of[2] = surfel_of(0, 2, between, 2);
    merged = merge(of, 3);
    assert_int_equal(merged.count, 2);
    hold_near((double)merged.items[0].radius_world, sqrt(5)); // as far from both: to the first
    hold_near((double)merged.items[1].radius_world, 1);
    free(merged.items);
    // Eight directions, each more than 60 degrees from all others, make six sheets, and two go to the nearest.
    ewa_representative corners[8];
    const float part = sqrtf(1.0f / 3);
    for (uint32_t k = 0; k < 8; k++) {
        const float corner[3] = {k & 1 ? part : -part, k & 2 ? part : -part, k & 4 ? part : -part};
        corners[k] = surfel_of(0, k, corner, 1);
    }
    merged = merge(corners, 8);
    assert_int_equal(merged.count, 6);
    double area = 0;
    for (uint32_t k = 0; k < 6; k++)
        area += (double)merged.items[k].radius_world * (double)merged.items[k].radius_world;
    hold_near(area, 8);
    hold_near((double)merged.items[2].radius_world, sqrt(2)); // corner 6 is as near to 2 as to 4
    hold_near((double)merged.items[3].radius_world, sqrt(2)); // corner 7 to 3, before 5
    free(merged.items);
    // Two that look against each other are two sheets, too.
    const float down[3] = {0, 0, -1};
    of[0] = surfel_of(0, 0, up, 1), of[1] = surfel_of(0, 1, down, 1);
    merged = merge(of, 2);
    assert_int_equal(merged.count, 2);
    free(merged.items);
}

/// What stands for members of a surface that bends lies on it, not in their middle below; where nothing is known to bend,
/// in the middle.
TEST(test_bent) {
    for (int saddle = 0; saddle < 2; saddle++) {
        // z = -(x^2 + y^2) / 8 or -(x^2 - y^2 / 2) / 8, with normals to second order.
        static const double places[4][2] = {{-0.3, -0.3}, {0.4, -0.3}, {-0.3, 0.4}, {0.4, 0.4}};
        ewa_representative of[4];
        for (uint32_t k = 0; k < 4; k++) {
            const double x = places[k][0], y = places[k][1], b = saddle ? -0.5 : 1;
            const float normal[3] = {(float)(x / 4), (float)(b * y / 4), 1};
            of[k] = surfel_of(0, k, normal, 1);
            of[k].at_world[0] = 5 + x, of[k].at_world[1] = 7 + y, of[k].at_world[2] = 9 - (x * x + b * y * y) / 8;
            of[k].curvature = 0.125f * (float)(1 + k);
        }
        ewa_representatives merged = merge(of, 4);
        assert_int_equal(merged.count, 1);
        const double *at = merged.items->at_world, x = at[0] - 5, y = at[1] - 7;
        assert_true(fabs(at[2] - (9 - (x * x + (saddle ? -0.5 : 1) * y * y) / 8)) < 5e-4);
        hold_near((double)merged.items->curvature, 0.125 * 2.5);
        free(merged.items);
        double middle = 0;
        for (uint32_t k = 0; k < 4; k++) of[k].curvature = 0, middle += of[k].at_world[2] / 4;
        merged = merge(of, 4);
        hold_near(merged.items->at_world[2], middle);
        assert_true(merged.items->curvature == 0);
        free(merged.items);
    }
}

/// From five surfels on, radii count up to three times their median.
TEST(test_large_radii) {
    ewa_representative few[5];
    for (uint32_t k = 0; k < 5; k++) few[k] = surfel_of(0, k, up, k == 4 ? 100 : 1);
    ewa_representatives merged = merge(few, 5);
    hold_near((double)merged.items->radius_world, sqrt(4 + 9));
    free(merged.items);
    merged = merge(few + 1, 4);
    hold_near((double)merged.items->radius_world, sqrt(3 + 1e4));
    free(merged.items);
    few[4].radius_world = 2.75f; // below the limit, and counted whole
    merged = merge(few, 5);
    hold_near((double)merged.items->radius_world, sqrt(4 + 2.75 * 2.75));
    free(merged.items);
}

/// Cells stay apart, in their order, wherever the parts of the work end.
TEST(test_cells) {
    static ewa_representative fine[MANY];
    uint32_t count = 0;
    for (uint64_t cell = 0; cell < 64; cell++)
        for (uint32_t k = 0; k < 1 + cell * 7 % 23 && count < MANY; k++)
            fine[count++] = surfel_of(cell, k, up, 1);
    ewa_representatives merged = merge(fine, count);
    assert_int_equal(merged.count, 64);
    for (uint64_t cell = 0; cell < 64; cell++) {
        assert_int_equal(ewa_code_prefix(merged.items[cell].code, CELL_LEVEL), cell);
        hold_near((double)merged.items[cell].radius_world, sqrt((double)(1 + cell * 7 % 23)));
    }
    free(merged.items);
}

/// Of numbers, what represents members has the mean by area of the finite ones, or that of most area, of its sheet alone.
TEST(test_numbers) {
    enum { COUNT = 8, NUMBERS = 2 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_representative of[COUNT];
    // Six of one sheet, one of another, one in another cell; the limit of radii is 3.
    static const float radii[COUNT] = {1, 1, 1, 2, 1, 9, 1, 5};
    double numbers[COUNT][NUMBERS] = {{6, 10}, {2, 20}, {6, 30}, {5, 40}, {2, NAN}, {9, 60}, {7, 70}, {8, 80}};
    for (uint32_t k = 0; k < COUNT; k++) of[k] = surfel_of(k / 7, k, k == 6 ? ahead : up, radii[k]);
    const ewa_representatives all = {.items = of, .count = COUNT, .numbers = &numbers[0][0], .number_count = NUMBERS};
    ewa_representatives merged = {.count = 0};
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 1u << 1, UINT32_MAX, &merged), EWA_OK);
    assert_int_equal(merged.count, 3);
    assert_int_equal(merged.number_count, NUMBERS);
    const double *made = merged.numbers;
    assert_true(made[0] == 9 && made[2] == 7 && made[4] == 8 && made[3] == 70 && made[5] == 80);
    hold_near(made[1], (10 + 20 + 30 + 4 * 40 + 9 * 60) / 16.0);
    // As much of one as of another: the smaller one.
    of[5].radius_world = 2;
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 1u << 1, UINT32_MAX, &merged), EWA_OK);
    assert_true(merged.numbers[0] == 5);
    for (uint32_t k = 0; k < 6; k++) numbers[k][1] = (double)NAN;
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 3, UINT32_MAX, &merged), EWA_OK);
    assert_true(isnan(merged.numbers[1]) && merged.numbers[3] == 70);
    ewa_representatives_free(context, &merged);
}

/// Codes that are kept apart are not mixed, so that few of many are still there; sheets of one code are as without.
TEST(test_codes_apart) {
    enum { COUNT = 12 };
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    ewa_representative of[COUNT];
    double codes[COUNT];
    for (uint32_t k = 0; k < COUNT; k++) {
        of[k] = surfel_of(0, k, k == 11 ? ahead : up, 1);
        codes[k] = k == 4 ? 14 : k < 8 ? 2 : 6;
        of[k].color[0] = (float)codes[k];
    }
    const ewa_representatives all = {.items = of, .count = COUNT, .numbers = codes, .number_count = 1};
    ewa_representatives merged = {.count = 0};
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 0, UINT32_MAX, &merged), EWA_OK);
    assert_int_equal(merged.count, 2);
    assert_true(merged.numbers[0] == 2);
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 0, 0, &merged), EWA_OK);
    assert_int_equal(merged.count, 4);
    static const double made[4] = {2, 14, 6, 6}, members[4] = {7, 1, 3, 1};
    for (uint32_t k = 0; k < 4; k++) {
        assert_true(merged.numbers[k] == made[k]);
        hold_near((double)merged.items[k].color[0], made[k]);
        hold_near((double)merged.items[k].radius_world, sqrt(members[k]));
    }
    // Of more codes than a cell has sheets, the last are mixed with others: nothing is lost.
    for (uint32_t k = 0; k < COUNT; k++) codes[k] = k;
    assert_int_equal(ewa_representatives_merge(context, &all, CELL_LEVEL, 0, 0, &merged), EWA_OK);
    double area = 0;
    for (uint32_t k = 0; k < merged.count; k++) area += (double)merged.items[k].radius_world * (double)merged.items[k].radius_world;
    assert_true(merged.count < COUNT);
    hold_near(area, COUNT);
    ewa_representatives_free(context, &merged);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
