// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What writing a COPC file needs beside its points: the pages of its hierarchy.
#ifndef EWA_SRC_COPC_WRITE_H
#define EWA_SRC_COPC_WRITE_H

#include "base/base.h"
#include "io/octree.h"

/// The pages of a hierarchy, one behind the other, the root's first. Zero-initialise; free `bytes`.
typedef struct ewa_copc_pages {
    ewa_buffer bytes;
    uint64_t size_bytes, root_bytes; ///< of all; of the first
} ewa_copc_pages;

/// Makes the pages for nodes of different keys, in any order, that stand from byte `at_bytes` of the file on: one
/// while the tree is small, else several of a thousand entries at most. Nodes without points, below which
/// there are others, get entries too, since readers go from node to node. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_copc_pages_make(ewa_context *context, const ewa_octree_node *nodes, uint64_t node_count,
                               uint64_t at_bytes, ewa_copc_pages *pages);

#endif
