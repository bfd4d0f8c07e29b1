// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The exchange of ewa/cluster.h by MPI: messages from rank to rank, so that ranks that have nothing for each other send
// nothing, and waiting that can end: a rank that is stopped keeps no other waiting for ever.
#include "mpi/exchange.h"

#include <limits.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum {
    TAG = 17,
    PIECE_BYTES = 1 << 30, // of a message: MPI counts by int
    EAGER_TESTS = 20000,   // before waiting in naps
    NAP_NS = 50000,
};

void mpi_exchange_open(mpi_exchange *exchange, MPI_Comm communicator, double limit_s,
                       bool (*interrupted)(void)) {
    *exchange = (mpi_exchange){.communicator = communicator, .limit_s = limit_s, .interrupted = interrupted};
    MPI_Comm_rank(communicator, &exchange->rank);
    MPI_Comm_size(communicator, &exchange->rank_count);
}

void mpi_exchange_close(mpi_exchange *exchange) {
    free(exchange->requests);
    free(exchange->peers);
    exchange->requests = NULL;
    exchange->peers = NULL;
    exchange->room = 0;
}

/// Pieces that a parcel is sent in.
static size_t piece_count(const ewa_parcel *parcel) {
    return parcel->size_bytes / PIECE_BYTES + (parcel->size_bytes % PIECE_BYTES != 0);
}

/// Makes room for the requests of a swap.
static bool make_room(mpi_exchange *exchange, const ewa_parcel *given, const ewa_parcel *taken) {
    size_t count = 1;
    for (int r = 0; r < exchange->rank_count; r++)
        if (r != exchange->rank) count += piece_count(&given[r]) + piece_count(&taken[r]);
    if (count <= exchange->room) return true;
    MPI_Request *requests = realloc(exchange->requests, count * sizeof *requests);
    if (requests) exchange->requests = requests;
    int *peers = requests ? realloc(exchange->peers, count * sizeof *peers) : NULL;
    if (peers) exchange->peers = peers;
    if (peers) exchange->room = count;
    return peers && count <= INT_MAX;
}

/// Begins to give to a rank, or to take from it; returns the number of requests by then.
static size_t start(mpi_exchange *exchange, const ewa_parcel *parcel, int peer, bool gives, size_t count,
                    int *failed) {
    size_t left = parcel->size_bytes;
    for (char *at = parcel->data; left && *failed == MPI_SUCCESS; count++) {
        const int bytes = left < PIECE_BYTES ? (int)left : PIECE_BYTES;
        exchange->peers[count] = peer;
        MPI_Request *request = &exchange->requests[count];
        *failed = gives ? MPI_Isend(at, bytes, MPI_BYTE, peer, TAG, exchange->communicator, request)
                        : MPI_Irecv(at, bytes, MPI_BYTE, peer, TAG, exchange->communicator, request);
        at += bytes;
        left -= (size_t)bytes;
    }
    return count;
}

/// A rank that still has to answer; -1: none.
static int find_silent(const mpi_exchange *exchange, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (exchange->requests[i] != MPI_REQUEST_NULL) return exchange->peers[i];
    return -1;
}

/// Waits until all requests are done.
static ewa_status await(mpi_exchange *exchange, size_t count) {
    const double started_s = MPI_Wtime();
    for (uint64_t tests = 0;; tests++) {
        int done = 0;
        if (MPI_Testall((int)count, exchange->requests, &done, MPI_STATUSES_IGNORE) != MPI_SUCCESS) {
            snprintf(exchange->failure, sizeof exchange->failure, "an exchange with another rank has failed");
            return EWA_ERROR_IO;
        }
        const double waited_s = MPI_Wtime() - started_s;
        if (done) {
            exchange->waited_s += waited_s;
            return EWA_OK;
        }
        if (exchange->interrupted()) return EWA_CANCELLED;
        if (exchange->limit_s > 0 && waited_s > exchange->limit_s) {
            snprintf(exchange->failure, sizeof exchange->failure,
                     "rank %d has not answered for %g s (--time-limit)", find_silent(exchange, count),
                     exchange->limit_s);
            return EWA_ERROR_IO;
        }
        if (tests < EAGER_TESTS)
            sched_yield();
        else
            nanosleep(&(struct timespec){.tv_nsec = NAP_NS}, NULL);
    }
}

static ewa_status swap(void *user, const ewa_parcel *given, const ewa_parcel *taken) {
    mpi_exchange *exchange = user;
    if (!make_room(exchange, given, taken)) {
        snprintf(exchange->failure, sizeof exchange->failure, "out of memory for messages");
        return EWA_ERROR_MEMORY;
    }
    size_t count = 0;
    int failed = MPI_SUCCESS;
    // Each begins with the rank after it, so that not all speak to the same one.
    for (int i = 1; i < exchange->rank_count; i++) {
        const int from = (exchange->rank + exchange->rank_count - i) % exchange->rank_count;
        count = start(exchange, &taken[from], from, false, count, &failed);
    }
    for (int i = 1; i < exchange->rank_count; i++) {
        const int to = (exchange->rank + i) % exchange->rank_count;
        count = start(exchange, &given[to], to, true, count, &failed);
        exchange->given_bytes += given[to].size_bytes;
    }
    if (failed != MPI_SUCCESS) {
        snprintf(exchange->failure, sizeof exchange->failure, "MPI has failed to begin an exchange");
        return EWA_ERROR_IO;
    }
    return await(exchange, count);
}

ewa_exchange mpi_exchange_of(mpi_exchange *exchange) {
    return (ewa_exchange){.user = exchange,
                          .rank = (uint32_t)exchange->rank,
                          .rank_count = (uint32_t)exchange->rank_count,
                          .picture_rank = 0,
                          .swap = swap};
}
