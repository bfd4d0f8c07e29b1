// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the figures of ewa bench ought to be, and what others reach; docs/performance.md discusses both.
#ifndef EWA_BENCH_GOALS_H
#define EWA_BENCH_GOALS_H

#include "bench/report.h"

/// A figure and its goals: at least the floor, if possible the target. Less is better where the target is
/// less than the floor.
typedef struct bench_goal {
    const char *figure, *unit;
    double value, floor, target;
} bench_goal;

enum { BENCH_MAX_GOALS = 8 };

/// Finds the goals for the frames of a scene; returns their number. They hold for two threads, all
/// instruction sets and the recipe's sizes.
size_t bench_goals_frames(const bench_frame_row *row, bench_goal goals[BENCH_MAX_GOALS]);

/// The same for a stage outside the frame.
size_t bench_goals_stage(const bench_stage_row *row, bench_goal goals[BENCH_MAX_GOALS]);

/// How many times worse than a goal a figure is; at most 1 where it is reached.
double bench_goal_ratio(const bench_goal *goal, double wanted);

/// Milliseconds that the best renderer of true splats takes for a scene; 0: unknown.
double bench_peer_ms(const bench_scene *scene);

#endif
