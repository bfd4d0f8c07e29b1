// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parallel work that allocates.
#include "base/allocating.h"
#include "base/context.h"

void ewa_parallel_allocating(ewa_context *context, ewa_task *task, void *data, uint32_t count) {
    if (context->options.allocator.allocate == ewa_allocate_default) {
        ewa_parallel(context, task, data, count);
        return;
    }
    for (uint32_t i = 0; i < count; i++) task(data, i, 0);
}

ewa_status ewa_parallel_allocating_stoppable(ewa_context *context, const char *stage, ewa_task *task,
                                             void *data, uint32_t count) {
    if (context->options.allocator.allocate == ewa_allocate_default)
        return ewa_parallel_stoppable(context, stage, task, data, count);
    for (uint32_t i = 0; i < count; i++) {
        task(data, i, 0);
        EWA_TRY(ewa_progress(context, stage, (i + 1.0) / count));
    }
    return EWA_OK;
}
