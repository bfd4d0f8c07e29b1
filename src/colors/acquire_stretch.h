// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Loops over the surfels that get a texture, in parallel and with progress.
#ifndef EWA_SRC_COLORS_ACQUIRE_STRETCH_H
#define EWA_SRC_COLORS_ACQUIRE_STRETCH_H

#include "colors/acquire.h"

/// Points of one call of a task.
typedef struct ewa_acquire_stretch {
    uint32_t first, end;
} ewa_acquire_stretch;

enum { EWA_ACQUIRE_TASK_POINTS = 256 };

/// Calls `task` for all points, with progress of the stage "texture" from `begin` to `end`; each gets the
/// points that ewa_acquire_range() gives. Errors: EWA_CANCELLED.
ewa_status ewa_acquire_run(const ewa_acquire_set *set, ewa_task *task, void *data, double begin, double end);

/// The points of one call of a task.
static inline ewa_acquire_stretch ewa_acquire_range(const ewa_acquire_set *set, uint32_t part) {
    const uint32_t first = part * EWA_ACQUIRE_TASK_POINTS, left = set->count - first;
    return (ewa_acquire_stretch){first, left < EWA_ACQUIRE_TASK_POINTS ? set->count : first + EWA_ACQUIRE_TASK_POINTS};
}

#endif
