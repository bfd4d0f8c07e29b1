// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Processes that do one command together, as ewa-mpi starts them.
#ifndef EWA_CLI_CREW_H
#define EWA_CLI_CREW_H

#include "ewa/cluster.h"

/// The processes; NULL where one is meant: this one alone.
typedef struct cli_crew {
    ewa_exchange exchange; ///< pictures are for rank 0
    bool
        shares_cloud; ///< of every picture each has some of the cubes of an octree; else some of the pictures
    /// How many bytes this one has given to others so far, and how long it has waited for theirs.
    uint64_t (*given_bytes)(const struct cli_crew *crew);
    double (*waited_s)(const struct cli_crew *crew);
    char *
        failure; ///< of `failure_bytes`: what a rank but 0 has to say of its failure; it prints nothing itself
    size_t failure_bytes;
} cli_crew;

/// Whether this process is the one that speaks, and writes what all have made together.
static inline bool crew_leads(const cli_crew *crew) { return !crew || crew->exchange.rank == 0; }

/// Whether all draw every picture together.
static inline bool crew_shares_cloud(const cli_crew *crew) { return crew && crew->shares_cloud; }

#endif
