// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which rank has splats in which tiles, and which rank owns the reduction of a tile.
#ifndef EWA_SRC_CLUSTER_TILES_H
#define EWA_SRC_CLUSTER_TILES_H

#include "cluster/exchange.h"
#include "surface/tile.h"

/// What this rank contributes to a tile in which several ranks have splats.
typedef struct ewa_joint_contribution {
    uint32_t tile, owner;
    bool open; ///< there is more to be gathered
} ewa_joint_contribution;

/// The reduction of a tile that this rank owns and in which several ranks have splats.
typedef struct ewa_joint_reduction {
    uint32_t tile;
    uint32_t first_incoming; ///< of `order`
    bool open;
} ewa_joint_reduction;

/// What one rank contributes to a reduction of this rank.
typedef struct ewa_joint_incoming {
    uint32_t rank, reduction;
} ewa_joint_incoming;

/// The tiles of a frame, as one rank sees them. Zero-initialise.
typedef struct ewa_joint_tiles {
    uint32_t tile_count;
    uint32_t *owners;      ///< [tile]
    uint32_t *busy_counts; ///< [tile]: ranks that have splats in it
    uint32_t *alone;       ///< tiles that the rank owns and in which one rank at most has splats
    ewa_joint_contribution *contributions; ///< by owners, then tiles
    uint32_t *contribution_first;          ///< [rank count + 1]: of those of an owner
    ewa_joint_reduction *reductions;       ///< by tiles
    ewa_joint_incoming
        *incoming; ///< by ranks, then tiles: received in the order of the sender's contributions
    uint32_t *
        order; ///< incoming contributions by reductions: reduction m has [reductions[m].first_incoming, that of m + 1)
    uint32_t alone_count, contribution_count, reduction_count, incoming_count;
    uint32_t own_incoming_first; ///< where those of the rank itself begin, in the order of its contributions
    ewa_buffer busy, numbers, contribution_buffer, reduction_buffer, incoming_buffer;
} ewa_joint_tiles;

/// How many blocks some rows mark.
static inline uint32_t ewa_joint_count_blocks(const uint32_t rows[EWA_MAX_TILE_BLOCKS]) {
    uint32_t count = 0;
    for (int i = 0; i < EWA_MAX_TILE_BLOCKS; i++) count += (uint32_t)__builtin_popcount(rows[i]);
    return count;
}

/// Tells all ranks in which tiles this one has splats and settles who owns which: the same on all. Errors:
/// EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_joint_tiles_assign(ewa_context *context, const ewa_exchange *exchange, const ewa_tile_job *job,
                                  ewa_joint_tiles *tiles);

void ewa_joint_tiles_free(ewa_context *context, ewa_joint_tiles *tiles);

#endif
