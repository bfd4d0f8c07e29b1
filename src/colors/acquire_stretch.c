// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Stretch by stretch, so that progress is told and a call can be cancelled in between.
#include "colors/acquire_stretch.h"
#include "base/base.h"

enum { STRETCH_POINTS = 1 << 16 };

ewa_status ewa_acquire_run(const ewa_acquire_set *set, ewa_task *task, ewa_acquire_stretch *stretch,
                           double begin, double end) {
    for (stretch->first = 0; stretch->first < set->count; stretch->first = stretch->end) {
        const double share = (double)stretch->first / set->count;
        EWA_TRY(ewa_progress(set->context, "texture", begin + share * (end - begin)));
        const uint32_t left = set->count - stretch->first;
        stretch->end = left < STRETCH_POINTS ? set->count : stretch->first + STRETCH_POINTS;
        ewa_parallel(set->context, task, stretch,
                     (stretch->end - stretch->first + EWA_ACQUIRE_TASK_POINTS - 1) / EWA_ACQUIRE_TASK_POINTS);
    }
    return EWA_OK;
}
