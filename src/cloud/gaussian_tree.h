// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Neighbours among Gaussians, for one to stand for some: a tree over them, whose cuts are groups.
#ifndef EWA_SRC_GAUSSIAN_TREE_H
#define EWA_SRC_GAUSSIAN_TREE_H

#include "cloud/gaussian_merge.h"

enum { EWA_TREE_GAUSSIANS = 8192 }; ///< at most, of a tree

/// A part of a tree's members.
typedef struct ewa_gaussian_node {
    uint32_t first, count; ///< of the members
    uint32_t halves;       ///< number of the first of its two halves; 0: it is one Gaussian
    double cost;           ///< of one for all of them: their mass times the squares of their distances from its centre
} ewa_gaussian_node;

/// A tree and what making it takes; about 1.6 MB.
typedef struct ewa_gaussian_tree {
    uint32_t count, node_count, group_count;
    uint32_t members[EWA_TREE_GAUSSIANS];         ///< numbers in the set; those of a node are in a row
    ewa_gaussian_mass masses[EWA_TREE_GAUSSIANS]; ///< theirs
    uint32_t groups[EWA_TREE_GAUSSIANS];          ///< nodes of the cut, by their first members
    ewa_gaussian_node nodes[2 * EWA_TREE_GAUSSIANS];
    // While it is made, by number among the members that were given:
    double at[3][EWA_TREE_GAUSSIANS], weights[EWA_TREE_GAUSSIANS];
    uint32_t orders[3][EWA_TREE_GAUSSIANS], moved[EWA_TREE_GAUSSIANS], keys[EWA_TREE_GAUSSIANS];
    bool low[EWA_TREE_GAUSSIANS];
} ewa_gaussian_tree;

/// Makes the tree of `count` members of a set, at least one and at most EWA_TREE_GAUSSIANS, of which none is the same twice: each node
/// is divided along the axis along which its mass is most spread, where the halves' own spreads are least. Any thread.
void ewa_gaussian_tree_make(ewa_gaussian_tree *tree, const ewa_gaussians *set, const uint32_t *members, uint32_t count);

/// Cuts the tree into `group_count` groups, at least one and at most its members: of the nodes that make them the one of highest cost is
/// divided, again and again, so that few groups reach from one thing to another. Any thread.
void ewa_gaussian_tree_cut(ewa_gaussian_tree *tree, uint32_t group_count);

/// Fills number `to` of `merged` with one Gaussian for group `group` of the cut, as ewa_gaussians_merge() does.
double ewa_gaussian_tree_merge(const ewa_gaussian_tree *tree, const ewa_gaussians *set, uint32_t group, ewa_gaussians *merged, size_t to);

#endif
