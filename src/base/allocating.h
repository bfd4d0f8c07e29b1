// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parallel work that allocates.
#ifndef EWA_SRC_ALLOCATING_H
#define EWA_SRC_ALLOCATING_H

#include "base/base.h"

/// Like ewa_parallel(), for tasks that allocate: an allocator of the caller's is asked from the thread that
/// called the library only, so that with one the tasks run one after the other, on worker 0.
void ewa_parallel_allocating(ewa_context *context, ewa_task *task, void *data, uint32_t count);

/// The same as ewa_parallel_stoppable(). Errors: EWA_CANCELLED.
ewa_status ewa_parallel_allocating_stoppable(ewa_context *context, const char *stage, ewa_task *task,
                                             void *data, uint32_t count);

#endif
