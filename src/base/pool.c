// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The built-in executor: a fixed set of threads that share one counter of tasks.
//
// A run is announced by a new generation number under the mutex. Every thread takes part in every run, so the
// last one to leave wakes the caller, and no thread can see a task of another run.
#include "base/pool.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct worker {
    ewa_pool *pool;
    pthread_t thread;
    uint32_t index;
} worker;

struct ewa_pool {
    pthread_mutex_t mutex;
    pthread_cond_t start, finish;
    uint64_t generation;
    uint32_t working; // threads that have not left the current run
    bool running; // a run is on
    bool quit;
    ewa_task *task;
    void *data;
    uint32_t count;
    atomic_uint next;
    uint32_t worker_count;
    worker workers[];
};

static size_t pool_bytes(uint32_t worker_count) { return sizeof(ewa_pool) + worker_count * sizeof(worker); }

static void take_tasks(ewa_pool *pool, uint32_t worker_index) {
    for (;;) {
        const uint32_t index = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
        if (index >= pool->count) return;
        pool->task(pool->data, index, worker_index);
    }
}

static void *work(void *argument) {
    const worker *self = argument;
    ewa_pool *pool = self->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (!pool->quit && pool->generation == seen) pthread_cond_wait(&pool->start, &pool->mutex);
        if (pool->quit) break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->mutex);
        take_tasks(pool, self->index);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->working == 0) pthread_cond_signal(&pool->finish);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

ewa_status ewa_pool_create(const ewa_allocator *allocator, uint32_t worker_count, ewa_pool **pool) {
    ewa_pool *made = allocator->allocate(allocator->user, pool_bytes(worker_count));
    if (!made) return EWA_ERROR_MEMORY;
    *made = (ewa_pool){.worker_count = worker_count};
    atomic_init(&made->next, 0);
    pthread_mutex_init(&made->mutex, NULL);
    pthread_cond_init(&made->start, NULL);
    pthread_cond_init(&made->finish, NULL);
    for (uint32_t i = 1; i < worker_count; i++) {
        made->workers[i] = (worker){.pool = made, .index = i};
        if (pthread_create(&made->workers[i].thread, NULL, work, &made->workers[i]) != 0) {
            // The system has no more threads to give: fewer workers do the same work.
            made->worker_count = i;
            break;
        }
    }
    made->workers[0] = (worker){.pool = made, .index = worker_count}; // remembers the allocated size
    *pool = made;
    return EWA_OK;
}

void ewa_pool_destroy(const ewa_allocator *allocator, ewa_pool *pool) {
    if (!pool) return;
    pthread_mutex_lock(&pool->mutex);
    pool->quit = true;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->mutex);
    for (uint32_t i = 1; i < pool->worker_count; i++) pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->finish);
    pthread_cond_destroy(&pool->start);
    pthread_mutex_destroy(&pool->mutex);
    allocator->release(allocator->user, pool, pool_bytes(pool->workers[0].index));
}

uint32_t ewa_pool_worker_count(const ewa_pool *pool) { return pool->worker_count; }

/// Announces a run, unless one is on.
static bool start(ewa_pool *pool, ewa_task *task, void *data, uint32_t count) {
    pthread_mutex_lock(&pool->mutex);
    const bool free = !pool->running;
    if (free) {
        pool->running = true;
        pool->task = task;
        pool->data = data;
        pool->count = count;
        atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
        pool->working = pool->worker_count - 1;
        pool->generation++;
        pthread_cond_broadcast(&pool->start);
    }
    pthread_mutex_unlock(&pool->mutex);
    return free;
}

void ewa_pool_run(ewa_pool *pool, ewa_task *task, void *data, uint32_t count) {
    if (count == 0) return;
    if (pool->worker_count == 1 || count == 1 || !start(pool, task, data, count)) {
        for (uint32_t i = 0; i < count; i++) task(data, i, 0);
        return;
    }
    take_tasks(pool, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->working) pthread_cond_wait(&pool->finish, &pool->mutex);
    pool->running = false;
    pthread_mutex_unlock(&pool->mutex);
}
