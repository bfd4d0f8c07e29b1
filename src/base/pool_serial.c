// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The built-in executor of a library without threads: the caller does all.
#include "base/pool.h"

struct ewa_pool {
    uint32_t worker_count;
};

ewa_status ewa_pool_create(const ewa_allocator *allocator, uint32_t worker_count, ewa_pool **pool) {
    (void)worker_count;
    *pool = allocator->allocate(allocator->user, sizeof **pool);
    if (!*pool) return EWA_ERROR_MEMORY;
    **pool = (ewa_pool){.worker_count = 1};
    return EWA_OK;
}

void ewa_pool_destroy(const ewa_allocator *allocator, ewa_pool *pool) {
    if (pool) allocator->release(allocator->user, pool, sizeof *pool);
}

uint32_t ewa_pool_worker_count(const ewa_pool *pool) { return pool->worker_count; }

void ewa_pool_run(ewa_pool *pool, ewa_task *task, void *data, uint32_t count) {
    (void)pool;
    for (uint32_t i = 0; i < count; i++) task(data, i, 0);
}
