// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A group of processes that run one command together, as ewa-mpi starts them.
#ifndef EWA_CLI_BASE_PROCESS_GROUP_H
#define EWA_CLI_BASE_PROCESS_GROUP_H

#include "ewa/cluster.h"

/// The process group; NULL: this process alone.
typedef struct cli_process_group {
    ewa_exchange exchange; ///< pictures are for rank 0
    bool
        shares_cloud; ///< each process has some nodes of the octree for every picture; else it draws some of the pictures
    /// How many bytes this one has given to others so far, and how long it has waited for theirs.
    uint64_t (*given_bytes)(const struct cli_process_group *group);
    double (*waited_s)(const struct cli_process_group *group);
    char *
        failure; ///< of `failure_bytes`: message of a rank other than 0 about its failure; it prints nothing itself
    size_t failure_bytes;
} cli_process_group;

/// Whether this process prints messages and writes the results of the group.
static inline bool process_group_leads(const cli_process_group *group) {
    return !group || group->exchange.rank == 0;
}

/// Whether all draw every picture together.
static inline bool process_group_shares_cloud(const cli_process_group *group) {
    return group && group->shares_cloud;
}

#endif
