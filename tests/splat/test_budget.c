// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/surface/budget.c: the choice of levels of detail, with times that are made up.
#include "check.h"
#include "surface/budget.h"

/// What frames of some machine and view take: [level] seconds per visible splat, and per pixel.
typedef struct machine {
    double splat_s[EWA_MAX_LEVELS], pixel_s, visible_share;
} machine;

enum { LEVELS = 5 };

static const ewa_budget_work work = {
    {10000000, 2500000, 625000, 156250, 39062}, .level_count = LEVELS, .pixel_count = 1310720};

static double frame_s(const machine *m, uint32_t level) {
    return (double)work.splat_counts[level] * m->visible_share * m->splat_s[level] +
           (double)work.pixel_count * m->pixel_s;
}

/// Draws a frame that takes `slower` times what it should; returns its level.
static uint32_t draw(ewa_budget *budget, const machine *m, double budget_s, uint32_t level, double slower) {
    const uint32_t chosen = ewa_budget_choose(budget, budget_s, &work, level);
    const double total_s = frame_s(m, chosen);
    const uint64_t splats = work.splat_counts[chosen];
    const ewa_budget_frame frame = {.level = chosen,
                                    .splat_count = splats,
                                    .culled_count = splats - (uint64_t)((double)splats * m->visible_share),
                                    .pixel_count = work.pixel_count,
                                    .total_s = slower * total_s,
                                    .pixel_share = (double)work.pixel_count * m->pixel_s / total_s};
    ewa_budget_learn(budget, &frame);
    return chosen;
}

/// The finest level that a machine draws in time.
static uint32_t finest_in_time(const machine *m, double budget_s) {
    uint32_t level = 0;
    while (level + 1 < LEVELS && frame_s(m, level) > budget_s) level++;
    return level;
}

static const machine fast = {{10e-9, 14e-9, 25e-9, 60e-9, 180e-9}, 2e-9, 0.5};
static const machine slow = {{90e-9, 120e-9, 200e-9, 480e-9, 1000e-9}, 8e-9, 0.9};

TEST(test_first_frame_is_careful) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    assert_true(frame_s(&slow, draw(&budget, &slow, 0.2, 0, 1)) <= 0.2);
    ewa_budget_start(&budget);
    assert_int_equal(draw(&budget, &fast, 1e15, 0, 1), 0);
}

TEST(test_settles_and_stays) {
    static const double budgets_s[] = {0.01, 0.025, 0.04, 0.08, 0.2, 1};
    const machine *const machines[] = {&fast, &slow};
    for (int i = 0; i < 12; i++) {
        const machine *m = machines[i / 6];
        const double budget_s = budgets_s[i % 6];
        ewa_budget budget;
        ewa_budget_start(&budget);
        uint32_t level = 0;
        for (int k = 0; k < 24; k++) level = draw(&budget, m, budget_s, 0, 1);
        if (frame_s(m, finest_in_time(m, budget_s)) <= budget_s) {
            assert_true(frame_s(m, level) <= budget_s);
            // No finer one has time to spare.
            assert_true(level == 0 || frame_s(m, level - 1) > 0.7 * budget_s);
        }
        check_random random = {(uint64_t)i};
        for (int k = 0; k < 300; k++) // a still view on a machine that is disturbed a little
            assert_int_equal(draw(&budget, m, budget_s, 0, check_uniform(&random, 0.99, 1.01)), level);
    }
}

TEST(test_reacts_to_a_slower_view) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    machine m = fast;
    for (int k = 0; k < 24; k++) draw(&budget, &m, 0.06, 0, 1);
    const uint32_t before = draw(&budget, &m, 0.06, 0, 1);
    for (int l = 0; l < EWA_MAX_LEVELS; l++) m.splat_s[l] *= 4;
    assert_true(frame_s(&m, before) > 0.06);
    draw(&budget, &m, 0.06, 0, 1); // the first that shows it
    draw(&budget, &m, 0.06, 0, 1);
    for (int k = 0; k < 20; k++) assert_true(frame_s(&m, draw(&budget, &m, 0.06, 0, 1)) <= 0.06);
    m = fast;
    uint32_t level = 0;
    for (int k = 0; k < 6; k++) level = draw(&budget, &m, 0.06, 0, 1);
    assert_true(level <= before + 1); // one coarser, where the finer one has little time to spare
}

TEST(test_one_slow_frame_changes_nothing) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    for (int k = 0; k < 24; k++) draw(&budget, &fast, 0.06, 0, 1);
    const uint32_t level = draw(&budget, &fast, 0.06, 0, 1);
    draw(&budget, &fast, 0.06, 0, 20);
    for (int k = 0; k < 10; k++) assert_int_equal(draw(&budget, &fast, 0.06, 0, 1), level);
}

/// A coarse level whose splats cost far more each does not make finer ones look dear, nor the other way round.
TEST(test_levels_are_not_mixed_up) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    for (int k = 0; k < 24; k++) draw(&budget, &fast, 0.06, 0, 1);
    const double before_s = ewa_budget_expect_s(&budget, &work, 1);
    for (int k = 0; k < 8; k++) draw(&budget, &fast, 0.06, 4, 1);
    const double after_s = ewa_budget_expect_s(&budget, &work, 1);
    assert_true(after_s > 0.99 * before_s && after_s < 1.01 * before_s);
}

TEST(test_not_finer_than_asked) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    for (uint32_t level = 0; level < EWA_MAX_LEVELS; level++)
        for (int k = 0; k < 4; k++) {
            const uint32_t drawn = draw(&budget, &fast, 1e15, level, 1);
            assert_int_equal(drawn, level < LEVELS ? level : LEVELS - 1);
        }
}

/// Where nothing is fast enough, what is fastest is drawn, not what is coarsest.
TEST(test_fastest_where_time_lacks) {
    machine m = fast;
    m.splat_s[3] = 500e-9, m.splat_s[4] = 4000e-9; // level 2 takes the least
    ewa_budget budget;
    ewa_budget_start(&budget);
    for (uint32_t level = 0; level < LEVELS; level++)
        assert_int_equal(draw(&budget, &m, 1e15, level, 1), level);
    for (int k = 0; k < 8; k++) draw(&budget, &m, 1e-6, 0, 1);
    for (int k = 0; k < 20; k++) assert_int_equal(draw(&budget, &m, 1e-6, 0, 1), 2);
}

/// Frames without anything that is visible, pixels or time say nothing.
TEST(test_empty_frames) {
    ewa_budget budget;
    ewa_budget_start(&budget);
    const ewa_budget fresh = budget;
    const ewa_budget_frame frames[] = {
        {.splat_count = 100, .culled_count = 100, .pixel_count = 9, .total_s = 1},
        {.splat_count = 0, .pixel_count = 9, .total_s = 1},
        {.splat_count = 100, .pixel_count = 9, .total_s = 0},
        {.splat_count = 100, .pixel_count = 0, .total_s = 1}};
    for (int i = 0; i < 4; i++) ewa_budget_learn(&budget, &frames[i]);
    assert_memory_equal(&budget, &fresh, sizeof budget);
    const ewa_budget_work none = {.level_count = 1, .pixel_count = 1};
    assert_int_equal(ewa_budget_choose(&budget, 1e-9, &none, 7), 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
