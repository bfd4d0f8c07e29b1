// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which rank has splats in which tiles, and at which rank those of a tile meet.
#ifndef EWA_SRC_CLUSTER_TILES_H
#define EWA_SRC_CLUSTER_TILES_H

#include "cluster/exchange.h"
#include "surface/tile.h"

/// A tile in which several ranks have splats, this one too.
typedef struct ewa_joint_share {
    uint32_t tile, owner;
    bool open; ///< there is more to be gathered
} ewa_joint_share;

/// A tile that this rank owns and several ranks have splats in.
typedef struct ewa_joint_meeting {
    uint32_t tile;
    uint32_t first_part; ///< of `order`
    bool open;
} ewa_joint_meeting;

/// What one rank has of a meeting.
typedef struct ewa_joint_part {
    uint32_t rank, meeting;
} ewa_joint_part;

/// The tiles of a frame, as one rank sees them. Zero-initialise.
typedef struct ewa_joint_tiles {
    uint32_t tile_count;
    uint32_t *owners;            ///< [tile]
    uint32_t *busy_counts;       ///< [tile]: ranks that have splats in it
    uint32_t *alone;             ///< tiles that the rank owns and in which one rank at most has splats
    ewa_joint_share *shares;     ///< by owners, then tiles
    uint32_t *share_first;       ///< [rank count + 1]: of those of an owner
    ewa_joint_meeting *meetings; ///< by tiles
    ewa_joint_part *parts;       ///< by ranks, then tiles: what comes in the order of the other's shares
    uint32_t *order; ///< of parts by meetings: meeting m has [meetings[m].first_part, that of m + 1)
    uint32_t alone_count, share_count, meeting_count, part_count;
    uint32_t own_part_first; ///< where the parts of the rank itself begin, in the order of its shares
    ewa_buffer busy, numbers, share_buffer, meeting_buffer, part_buffer;
} ewa_joint_tiles;

/// How many blocks some rows mark.
static inline uint32_t ewa_joint_count_blocks(const uint32_t rows[EWA_MAX_TILE_BLOCKS]) {
    uint32_t count = 0;
    for (int i = 0; i < EWA_MAX_TILE_BLOCKS; i++) count += (uint32_t)__builtin_popcount(rows[i]);
    return count;
}

/// Tells all ranks in which tiles this one has splats and settles who owns which: the same on all. Errors:
/// EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_joint_tiles_settle(ewa_context *context, const ewa_exchange *exchange, const ewa_tile_job *job,
                                  ewa_joint_tiles *tiles);

void ewa_joint_tiles_free(ewa_context *context, ewa_joint_tiles *tiles);

#endif
