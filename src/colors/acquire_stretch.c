// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// In stretches, between which progress is told and a call can be cancelled.
#include "colors/acquire_stretch.h"
#include "base/base.h"

ewa_status ewa_acquire_run(const ewa_acquire_set *set, ewa_task *task, void *data, double begin, double end) {
    const uint32_t tasks = set->count / EWA_ACQUIRE_TASK_POINTS + (set->count % EWA_ACQUIRE_TASK_POINTS != 0);
    return ewa_parallel_within(set->context, "texture", begin, end, task, data, tasks);
}
