// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The built-in executor: a fixed set of threads that share one counter of tasks.
#ifndef EWA_SRC_BASE_POOL_H
#define EWA_SRC_BASE_POOL_H

#include "ewa/base.h"

typedef struct ewa_pool ewa_pool;

/// Starts `worker_count` - 1 threads; the calling thread is worker 0 of every run.
ewa_status ewa_pool_create(const ewa_allocator *allocator, uint32_t worker_count, ewa_pool **pool);

/// Joins the threads and frees; accepts NULL.
void ewa_pool_destroy(const ewa_allocator *allocator, ewa_pool *pool);

uint32_t ewa_pool_worker_count(const ewa_pool *pool);

/// Runs all tasks and returns when the last is done. A run that begins while another is on, in a task of it or on another thread, is
/// done by its caller alone, as worker 0: threads that wait for each other would never end.
void ewa_pool_run(ewa_pool *pool, ewa_task *task, void *data, uint32_t count);

#endif
