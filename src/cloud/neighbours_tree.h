// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The tree that neighbours.c builds and neighbours_search.c searches, and the hot loops of the search.
#ifndef EWA_SRC_CLOUD_NEIGHBOURS_TREE_H
#define EWA_SRC_CLOUD_NEIGHBOURS_TREE_H

#include "cloud/neighbours.h"
#include "wide/isa.h"

enum {
    TREE_ARITY = 16,
    TREE_MAX_LEVELS = 9, // 16^8 leaves
    LEAF_PLACES = EWA_BLOCK_LANES,
};

/// The boxes of 16 consecutive nodes of one level; empty ones have low > high.
typedef struct tree_group {
    double low[3][TREE_ARITY], high[3][TREE_ARITY];
} tree_group;

struct ewa_neighbours {
    ewa_context *context;
    uint32_t point_count, place_count, leaf_count;
    uint32_t *order;      // [point_count] points in the order of places
    uint32_t *first;      // [place_count + 1] first entry of `order` of each place
    uint32_t *leaf_first; // [leaf_count + 1] first place of each leaf
    float *offset[3];     // [place_count + EWA_BLOCK_LANES] position relative to its leaf's anchor
    bool anchored;        // the anchor of a leaf is the low corner of its box, else the origin
    tree_group
        *groups; // all levels, leaves first; node n of a level has the children of group n one level below
    size_t group_count;
    uint32_t level_count;
    size_t level_start[TREE_MAX_LEVELS];
};

/// Where a search gathers candidates: all places up to a radius from the box of those that search.
typedef struct tree_query {
    double low[3], high[3], radius2; // for boxes
    double anchor[3];                // of the block
    // The same for places, in units of the block from its anchor, with a margin for rounding.
    float local_low[3], local_high[3], local_radius2;
    float per_unit; // 1 / unit_world
} tree_query;

/// The hot loops, compiled once per instruction set, all with the same results.
typedef struct search_kernels {
    /// Returns the bits of those boxes of the group that are near enough.
    uint32_t (*overlap)(const tree_group *group, const tree_query *query);
    /// Appends those of `count` places from `first` on that are near enough; `shift` is what their offsets
    /// lack, in units of the block.
    void (*gather)(const ewa_neighbours *tree, const tree_query *query, uint32_t first, uint32_t count,
                   const float shift[3], ewa_block *block);
    /// Fills distance2 and counts the candidates of each lane within `limit2`.
    void (*measure)(ewa_block *block, float limit2, float within[EWA_BLOCK_LANES]);
    /// Sets radius2 to the `rank`-th smallest distance2 of each lane; at least `rank` of them are within
    /// `limit2`, as `within` says.
    void (*select)(ewa_block *block, float limit2, const float within[EWA_BLOCK_LANES], int32_t rank);
} search_kernels;

EWA_DECLARE_VERSIONS(const search_kernels, ewa_search_kernels);

#endif
