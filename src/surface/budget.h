// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which level of detail a frame has time for: a model of what frames cost, measured from those before.
#ifndef EWA_SRC_SURFACE_BUDGET_H
#define EWA_SRC_SURFACE_BUDGET_H

#include "ewa/render.h"

/// What a frame has to draw.
typedef struct ewa_budget_work {
    uint64_t splat_counts[EWA_MAX_LEVELS]; ///< at each level, of all sources
    uint32_t level_count;                  ///< 1 or more
    uint64_t pixel_count;
} ewa_budget_work;

/// What a frame took. Times are wall clock; the part that pixels take is what edges and resolving do.
typedef struct ewa_budget_frame {
    uint32_t level;
    uint64_t splat_count, culled_count, pixel_count;
    double total_s, pixel_share; ///< pixel_share in [0, 1]
} ewa_budget_frame;

/// The model: a frame takes visible splats times their level's splat_s, and pixels times pixel_s.
typedef struct ewa_budget {
    double splat_s[EWA_MAX_LEVELS]; ///< per splat that is not culled
    bool seen[EWA_MAX_LEVELS];      ///< some frame was drawn at that level
    double pixel_s;
    double visible_share;              ///< of the splats, in the last frame
    double last_splat_s, last_pixel_s; ///< as the last frame had them, whatever those before say
    uint32_t drawn_level;              ///< of the last frame
    bool drawn;                        ///< there was one
    uint32_t chosen_level;             ///< of the last choice
    uint32_t finer_choices;            ///< one after another at which a finer level had time enough
} ewa_budget;

/// A model that has seen no frame: careful numbers, which machines of one thread keep.
void ewa_budget_start(ewa_budget *budget);

/// The seconds that a frame is expected to take at a level.
double ewa_budget_expect_s(const ewa_budget *budget, const ewa_budget_work *work, uint32_t level);

/// Chooses the finest level, from `level` on, that is expected to take at most `budget_s`; the one that
/// takes least if none is. The next finer level than the one before is taken where it leaves time to spare, twice in a row,
/// so that a still view keeps its level.
uint32_t ewa_budget_choose(ewa_budget *budget, double budget_s, const ewa_budget_work *work, uint32_t level);

/// Takes a frame into the model.
void ewa_budget_learn(ewa_budget *budget, const ewa_budget_frame *frame);

#endif
