// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ranks as threads of one process.
#include "cluster/ranks.h"

#include <pthread.h>
#include <string.h>

/// What all ranks see.
typedef struct shared {
    pthread_barrier_t barrier;
    uint32_t count;
    const ewa_parcel *given[RANKS_MAX];
    ranks_work *work;
    void *data;
    uint32_t picture_rank;
    uint64_t bytes[RANKS_MAX];
    bool unequal; ///< somebody took another size than was given
} shared;

typedef struct rank {
    shared *all;
    uint32_t number;
} rank;

static ewa_status swap(void *user, const ewa_parcel *given, const ewa_parcel *taken) {
    rank *of = user;
    shared *all = of->all;
    all->given[of->number] = given;
    pthread_barrier_wait(&all->barrier);
    for (uint32_t r = 0; r < all->count; r++) {
        const ewa_parcel *from = &all->given[r][of->number];
        if (r == of->number) continue;
        all->bytes[of->number] += given[r].size_bytes;
        if (from->size_bytes != taken[r].size_bytes)
            all->unequal = true;
        else if (from->size_bytes)
            memcpy(taken[r].data, from->data, from->size_bytes);
    }
    pthread_barrier_wait(&all->barrier);
    return all->unequal ? EWA_ERROR_IO : EWA_OK;
}

uint64_t ranks_given_bytes(const ewa_exchange *exchange) {
    const rank *of = exchange->user;
    return of->all->bytes[of->number];
}

static void *run(void *data) {
    rank *of = data;
    const ewa_exchange exchange = {of, of->number, of->all->count, of->all->picture_rank, swap};
    of->all->work(&exchange, of->all->data);
    return NULL;
}

void ranks_run(uint32_t count, uint32_t picture_rank, ranks_work *work, void *data) {
    shared all = {.count = count, .picture_rank = picture_rank, .work = work, .data = data};
    rank ranks[RANKS_MAX];
    pthread_t threads[RANKS_MAX];
    pthread_barrier_init(&all.barrier, NULL, count);
    for (uint32_t i = 0; i < count; i++) {
        ranks[i] = (rank){&all, i};
        pthread_create(&threads[i], NULL, run, &ranks[i]);
    }
    for (uint32_t i = 0; i < count; i++) pthread_join(threads[i], NULL);
    pthread_barrier_destroy(&all.barrier);
}
