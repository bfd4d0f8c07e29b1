// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Ranks as threads of one process, which exchange through its memory.
#ifndef EWA_TESTS_CLUSTER_RANKS_H
#define EWA_TESTS_CLUSTER_RANKS_H

#include "ewa/cluster.h"

enum { RANKS_MAX = 8 };

/// What a rank does; returns when it has nothing more to exchange.
typedef void ranks_work(const ewa_exchange *exchange, void *data);

/// How many bytes a rank has given to others so far.
uint64_t ranks_given_bytes(const ewa_exchange *exchange);

/// Runs the ranks to their end.
void ranks_run(uint32_t count, uint32_t picture_rank, ranks_work *work, void *data);

#endif
