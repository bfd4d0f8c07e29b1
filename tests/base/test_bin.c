// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Binning against a plain list per bin, for any number of workers: rectangles of every size, candidates in no
// bin, more bins than candidates, nothing at all; and tiles that cover each pixel once.
#include "tests/check.h"

#include "tiling/bin.h"
#include "tiling/tiles.h"

enum { MAXIMUM = 3000 };

typedef struct scene {
    uint32_t count;
    uint32_t left[MAXIMUM], top[MAXIMUM], right[MAXIMUM], bottom[MAXIMUM]; // empty: in no bin
} scene;

static uint32_t find(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                     const ewa_bin_items *items) {
    const scene *s = data;
    (void)worker;
    assert_int_equal(first % EWA_BIN_ALIGNMENT, 0);
    uint32_t next = first;
    for (uint32_t i = first; i < first + count; i++) {
        if (s->left[i] >= s->right[i] || s->top[i] >= s->bottom[i]) continue;
        items->ids[next] = (int32_t)(7 * i);
        items->first[next] = (int32_t)(s->left[i] | s->top[i] << 16);
        items->end[next++] = (int32_t)(s->right[i] | s->bottom[i] << 16);
    }
    return next - first;
}

static void hold_lists(const ewa_bin_lists *lists, const scene *s, uint32_t columns, uint32_t rows) {
    uint64_t at = 0, largest = 0, kept = 0;
    for (uint32_t i = 0; i < s->count; i++) kept += s->left[i] < s->right[i] && s->top[i] < s->bottom[i];
    for (uint32_t bin = 0; bin < columns * rows; bin++) {
        const uint32_t x = bin % columns, y = bin / columns;
        const uint64_t first = at;
        assert_int_equal(lists->starts[bin], at);
        for (uint32_t i = 0; i < s->count; i++)
            if (s->left[i] <= x && x < s->right[i] && s->top[i] <= y && y < s->bottom[i])
                assert_int_equal(lists->ids[at++], 7 * i);
        if (at - first > largest) largest = at - first;
    }
    assert_int_equal(lists->starts[columns * rows], at);
    assert_int_equal(lists->largest, largest);
    assert_int_equal(lists->item_count, kept);
}

static void hold(ewa_context *context, ewa_bin_lists *lists, const scene *s, uint32_t columns,
                 uint32_t rows) {
    assert_int_equal(ewa_bin_lists_fill(context, lists, columns, rows, s->count, find, s), EWA_OK);
    hold_lists(lists, s, columns, rows);
}

static void make_rectangles(check_random *random, uint32_t count, uint32_t columns, uint32_t rows, scene *s) {
    s->count = count;
    for (uint32_t i = 0; i < count; i++) {
        s->left[i] = (uint32_t)check_random_u64(random) % columns;
        s->top[i] = (uint32_t)check_random_u64(random) % rows;
        s->right[i] = s->left[i] + (uint32_t)check_random_u64(random) % (columns - s->left[i] + 1);
        s->bottom[i] = s->top[i] + (uint32_t)check_random_u64(random) % (rows - s->top[i] + 1);
    }
}

TEST(test_lists) {
    static const uint32_t workers[] = {1, 2, 7}, counts[] = {0, 1, 15, 16, 17, 500, MAXIMUM};
    static const uint32_t grids[][2] = {{1, 1}, {5, 3}, {40, 30}, {1, 200}};
    static scene s;
    check_random random = {5};
    for (int w = 0; w < 3; w++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(workers[w], NULL);
        ewa_bin_lists lists = {0};
        for (int g = 0; g < 4; g++)
            for (int c = 0; c < 7; c++) {
                make_rectangles(&random, counts[c], grids[g][0], grids[g][1], &s);
                hold(context, &lists, &s, grids[g][0], grids[g][1]);
            }
        ewa_bin_lists_free(context, &lists);
    }
}

/// Many sets of lists at once, some without candidates: as one after the other.
TEST(test_many_lists) {
    enum { SETS = 9, COLUMNS = 6, ROWS = 4 };
    static const uint32_t workers[] = {1, 2, 7}, counts[SETS] = {0, 1, 700, 0, 17, 16, MAXIMUM, 33, 0};
    static scene scenes[SETS];
    for (int w = 0; w < 3; w++) {
        OWNED(ewa_context_destroy) ewa_context *context = check_context(workers[w], NULL);
        check_random random = {8};
        ewa_bin_lists lists[SETS] = {0};
        ewa_bin_request requests[SETS];
        ewa_buffer room = {0};
        for (uint32_t set_count = 0; set_count <= SETS; set_count++) {
            for (uint32_t i = 0; i < set_count; i++) {
                make_rectangles(&random, counts[i], COLUMNS, ROWS, &scenes[i]);
                requests[i] = (ewa_bin_request){&lists[i], counts[i], find, &scenes[i]};
            }
            assert_int_equal(ewa_bin_lists_fill_all(context, &room, requests, set_count, COLUMNS, ROWS),
                             EWA_OK);
            for (uint32_t i = 0; i < set_count; i++) hold_lists(&lists[i], &scenes[i], COLUMNS, ROWS);
        }
        for (uint32_t i = 0; i < SETS; i++) ewa_bin_lists_free(context, &lists[i]);
        ewa_buffer_free(context, &room);
    }
}

TEST(test_tiles) {
    static const uint32_t sizes[][3] = {
        {1, 1, 64}, {64, 64, 64}, {65, 63, 64}, {200, 129, 32}, {7, 300, 128}};
    for (int i = 0; i < 5; i++) {
        const ewa_tiles tiles = ewa_tiles_make(sizes[i][0], sizes[i][1], sizes[i][2]);
        static uint8_t seen[300][300];
        memset(seen, 0, sizeof seen);
        for (uint32_t t = 0; t < ewa_tiles_count(&tiles); t++) {
            const ewa_tile_rect r = ewa_tiles_rect(&tiles, t);
            assert_true(r.width_px > 0 && r.width_px <= sizes[i][2] && r.height_px <= sizes[i][2]);
            for (uint32_t y = r.y_px; y < r.y_px + r.height_px; y++)
                for (uint32_t x = r.x_px; x < r.x_px + r.width_px; x++) seen[y][x]++;
        }
        for (uint32_t y = 0; y < 300; y++)
            for (uint32_t x = 0; x < 300; x++)
                assert_int_equal(seen[y][x], x < sizes[i][0] && y < sizes[i][1]);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
