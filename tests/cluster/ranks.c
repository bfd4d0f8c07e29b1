// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ranks as threads of one process.
#include "cluster/ranks.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/// What all ranks see.
typedef struct shared {
    pthread_barrier_t barrier;
    uint32_t count;
    const void *given[RANKS_MOST];
    ranks_work *work;
    void *data;
    uint64_t bytes;
} shared;

typedef struct rank {
    shared *all;
    uint32_t number;
} rank;

/// Shows what this rank gives to the others and waits for theirs.
static shared *show(rank *of, const void *mine, size_t size_bytes) {
    of->all->given[of->number] = mine;
    if (of->number == 0) of->all->bytes += size_bytes;
    pthread_barrier_wait(&of->all->barrier);
    return of->all;
}

static ewa_status gather(void *user, const void *mine, size_t size_bytes, void *to) {
    rank *of = user;
    shared *all = show(of, mine, size_bytes);
    for (uint32_t i = 0; i < all->count; i++) memcpy((char *)to + i * size_bytes, all->given[i], size_bytes);
    pthread_barrier_wait(&all->barrier);
    return EWA_OK;
}

static ewa_status take_largest(void *user, float *values, size_t count) {
    rank *of = user;
    float *largest = malloc((count ? count : 1) * sizeof *largest);
    shared *all = show(of, values, count * sizeof *values);
    memcpy(largest, all->given[0], count * sizeof *largest);
    for (uint32_t r = 1; r < all->count; r++) {
        const float *other = all->given[r];
        for (size_t i = 0; i < count; i++) largest[i] = other[i] > largest[i] ? other[i] : largest[i];
    }
    pthread_barrier_wait(&all->barrier);
    memcpy(values, largest, count * sizeof *values);
    free(largest);
    return EWA_OK;
}

static ewa_status add(void *user, int64_t *values, size_t count) {
    rank *of = user;
    int64_t *sums = calloc(count ? count : 1, sizeof *sums);
    shared *all = show(of, values, count * sizeof *values);
    for (uint32_t r = 0; r < all->count; r++) {
        const int64_t *other = all->given[r];
        for (size_t i = 0; i < count; i++) sums[i] += other[i];
    }
    pthread_barrier_wait(&all->barrier);
    memcpy(values, sums, count * sizeof *values);
    free(sums);
    return EWA_OK;
}

static void *run(void *data) {
    rank *of = data;
    const ewa_exchange exchange = {of, of->number, of->all->count, gather, take_largest, add};
    of->all->work(&exchange, of->all->data);
    return NULL;
}

uint64_t ranks_run(uint32_t count, ranks_work *work, void *data) {
    shared all = {.count = count, .work = work, .data = data};
    rank ranks[RANKS_MOST];
    pthread_t threads[RANKS_MOST];
    pthread_barrier_init(&all.barrier, NULL, count);
    for (uint32_t i = 0; i < count; i++) {
        ranks[i] = (rank){&all, i};
        pthread_create(&threads[i], NULL, run, &ranks[i]);
    }
    for (uint32_t i = 0; i < count; i++) pthread_join(threads[i], NULL);
    pthread_barrier_destroy(&all.barrier);
    return all.bytes;
}
