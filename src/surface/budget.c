// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The cost model of levels of detail.
//
// A splat of a coarser level covers more pixels and costs more. How much more is not known before it is
// drawn, so each level has a cost of its own. Frames of one level tell how the view changes what splats cost,
// and change the costs of all levels alike. The first frame of a level tells what it costs beside the others.
#include "surface/budget.h"

#include <math.h>

/// Before anything is measured: seconds of one thread per splat of all surfels, and per pixel; and how much
/// more a splat of the next coarser level costs.
static const double FIRST_SPLAT_S = 60e-9, FIRST_PIXEL_S = 15e-9, COARSER = 2;

/// The share of the budget in which a finer level must be drawn so that it is worth changing, and how often
/// in a row it has to seem so.
static const double ROOM = 0.75;
enum { PATIENCE = 2 };

/// How much less a splat of a level that was never drawn is hoped to cost than one of the next coarser level: as
/// much as may be, so that it is tried.
static const double FINER = 3;

/// What a later frame of a level that others have been drawn in between says of its cost beside theirs.
static const double REMEMBERED = 0.25;

void ewa_budget_start(ewa_budget *budget) {
    *budget = (ewa_budget){.pixel_s = FIRST_PIXEL_S, .visible_share = 1};
    double splat_s = FIRST_SPLAT_S;
    for (int level = 0; level < EWA_MAX_LEVELS; level++, splat_s *= COARSER) budget->splat_s[level] = splat_s;
}

double ewa_budget_expect_s(const ewa_budget *budget, const ewa_budget_work *work, uint32_t level) {
    return (double)work->splat_counts[level] * budget->visible_share * budget->splat_s[level] +
           (double)work->pixel_count * budget->pixel_s;
}

/// The finest level from `level` on that is expected to take at most `limit_s`; the fastest if none is: very
/// coarse levels, of which each pixel sees several surfels, gain nothing.
static uint32_t finest_within(const ewa_budget *budget, const ewa_budget_work *work, uint32_t level,
                              double limit_s) {
    uint32_t fastest = level;
    double min_s = INFINITY;
    for (; level < work->level_count; level++) {
        const double expected_s = ewa_budget_expect_s(budget, work, level);
        if (expected_s <= limit_s) return level;
        if (expected_s < min_s) min_s = expected_s, fastest = level;
    }
    return fastest;
}

uint32_t ewa_budget_choose(ewa_budget *budget, double budget_s, const ewa_budget_work *work, uint32_t level) {
    const uint32_t finest = level < work->level_count ? level : work->level_count - 1;
    uint32_t chosen = finest_within(budget, work, finest, budget_s);
    const uint32_t before = budget->chosen_level;
    const bool finer = budget->drawn && before < work->level_count && chosen < before;
    if (finer) {
        // Not so if only by little: the next frame might say otherwise.
        chosen = finest_within(budget, work, finest, ROOM * budget_s);
        chosen = chosen < before ? before - 1 : before; // step by step: what is not seen is only hoped
        budget->finer_choices = chosen < before ? budget->finer_choices + 1 : 0;
        if (budget->finer_choices < PATIENCE) chosen = before;
    }
    if (!finer || chosen < before) budget->finer_choices = 0;
    budget->chosen_level = chosen;
    return chosen;
}

/// What a frame's cost counts as after that of the one before, where `known` is expected: one slow frame alone
/// was something else's fault.
static double robust_cost(double measured_s, double last_s, double known_s) {
    const double before_s = fmax(last_s, known_s);
    return measured_s < before_s ? measured_s : before_s;
}

void ewa_budget_learn(ewa_budget *budget, const ewa_budget_frame *frame) {
    const uint64_t visible =
        frame->splat_count > frame->culled_count ? frame->splat_count - frame->culled_count : 0;
    if (!(frame->total_s > 0) || frame->pixel_count == 0 || visible == 0) return;
    const uint32_t level = frame->level;
    const bool again = budget->drawn && budget->drawn_level == level;
    const double pixel_s = frame->total_s * frame->pixel_share / (double)frame->pixel_count;
    const double splat_s = frame->total_s * (1 - frame->pixel_share) / (double)visible;
    double *known = budget->splat_s;
    budget->visible_share = (double)visible / (double)frame->splat_count;
    budget->pixel_s = budget->drawn ? robust_cost(pixel_s, budget->last_pixel_s, budget->pixel_s) : pixel_s;
    const double ratio =
        (again ? robust_cost(splat_s, budget->last_splat_s, known[level]) : splat_s) / known[level];
    if (again || !budget->drawn) {
        for (int l = 0; l < EWA_MAX_LEVELS; l++) known[l] *= ratio;
    } else if (budget->seen[level]) {
        for (uint32_t l = 0; l < EWA_MAX_LEVELS; l++)
            known[l] *= l == level ? ratio : pow(ratio, 1 - REMEMBERED);
    } else {
        known[level] = splat_s;
        for (uint32_t l = level + 1; l < EWA_MAX_LEVELS && !budget->seen[l]; l++)
            known[l] = known[l - 1] * COARSER;
    }
    for (uint32_t l = level; l-- > 0 && !budget->seen[level] && !budget->seen[l];)
        known[l] = known[l + 1] / FINER;
    budget->seen[level] = budget->drawn = true;
    budget->drawn_level = level;
    budget->last_splat_s = splat_s, budget->last_pixel_s = pixel_s;
}
