// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The exchange of ewa/cluster.h by MPI.
#ifndef EWA_MPI_EXCHANGE_H
#define EWA_MPI_EXCHANGE_H

#include <mpi.h>

#include "ewa/cluster.h"

/// What a rank of a communicator has exchanged. Zero-initialise, then mpi_exchange_open().
typedef struct mpi_exchange {
    MPI_Comm communicator;
    int rank, rank_count;
    double limit_s; ///< how long an answer may take; 0: as long as it does
    bool (*interrupted)(void);
    MPI_Request *requests;
    int *peers; ///< of the requests
    size_t room;
    uint64_t given_bytes;
    double waited_s;
    char failure[256]; ///< what went wrong in the last call that failed
} mpi_exchange;

/// Takes a communicator, which is to return errors; `interrupted` asks whether to give up.
void mpi_exchange_open(mpi_exchange *exchange, MPI_Comm communicator, double limit_s,
                       bool (*interrupted)(void));

/// The exchange as the library takes it, with pictures for rank 0. Lives as long as `exchange`.
ewa_exchange mpi_exchange_of(mpi_exchange *exchange);

void mpi_exchange_close(mpi_exchange *exchange);

#endif
