// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The octree of COPC files: which chunk holds which cube of space at which level of detail.
//
// Based on: Hobu, "COPC: Cloud Optimized Point Cloud Specification 1.0", 2021.
#ifndef EWA_SRC_COPC_H
#define EWA_SRC_COPC_H

#include "io/las/las.h"

/// A cube of the octree and the chunk of its points.
typedef struct ewa_copc_node {
    int32_t level, cell[3]; ///< the cube is cell `cell` of the 2^level along each axis
    uint64_t at_bytes;
    uint32_t size_bytes, point_count;
} ewa_copc_node;

typedef struct ewa_copc_tree {
    double spacing_world; ///< of the points of the root
    ewa_copc_node *nodes; ///< in the order of the pages
    size_t node_count;
    size_t capacity_bytes;
} ewa_copc_tree;

/// Whether the file is COPC.
bool ewa_copc_is(const ewa_cloud_source *source, const ewa_las_header *header);

/// Reads the pages of the hierarchy; `*fault` (NULL: nothing) says why a part of them is left out. Free with
/// ewa_copc_tree_free(). Errors: EWA_ERROR_MEMORY.
ewa_status ewa_copc_tree_read(const ewa_cloud_source *source, const ewa_las_header *header,
                              ewa_copc_tree *tree, const char **fault);
void ewa_copc_tree_free(ewa_context *context, ewa_copc_tree *tree);

/// Notes the facts about a COPC file as "file.copc"; of others nothing. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_copc_note(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype);

#endif
