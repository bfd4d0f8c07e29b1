// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a rank has gathered of a tile, as bytes that travel, and the sums of those of several ranks.
#ifndef EWA_SRC_CLUSTER_PACK_H
#define EWA_SRC_CLUSTER_PACK_H

#include "surface/tile.h"

enum { EWA_JOINT_SETS = 3 };

/// A set of sums of a tile: blocks times channels, words after each other (surface/pipeline_sums.h).
typedef struct ewa_joint_set {
    const ewa_sums *of;
    uint32_t *rows; ///< [block row]: blocks that have some; NULL: those whose terms are counted
    uint32_t channels;
} ewa_joint_set;

/// The sets of the first surface (0) or one behind it; returns how many.
uint32_t ewa_joint_sets(const ewa_tile_job *job, ewa_tile_scratch *scratch, uint32_t surface,
                        ewa_joint_set sets[EWA_JOINT_SETS]);

/// The maximum number of bytes that a tile is packed into, and how many numbers its totals have.
size_t ewa_joint_packed_bytes(const ewa_tile_job *job);
size_t ewa_joint_total_numbers(const ewa_tile_job *job);

/// Packs the blocks that have something; returns how many bytes: a multiple of 4, the first four say it, too.
size_t ewa_joint_pack(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile, void *to);

/// Adds what was packed to totals that began as zeros.
void ewa_joint_add(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile, const void *packed,
                   int64_t *totals);

/// Sets the sums of blocks that have something to the totals.
void ewa_joint_put(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile,
                   const int64_t *totals);

#endif
