// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The octree of COPC files: which chunk holds the points of which node.
//
// Based on: Hobu, "COPC: Cloud Optimized Point Cloud Specification 1.0", 2021.
#ifndef EWA_SRC_COPC_H
#define EWA_SRC_COPC_H

#include "base/base.h"
#include "io/las/las.h"

enum { EWA_COPC_INFO_BYTES = 160, EWA_COPC_ENTRY_BYTES = 32, EWA_COPC_PAGES_ID = 1000 };

/// The record that holds levels of detail of surfels.
#define EWA_COPC_LEVELS_USER "ewa"
enum { EWA_COPC_LEVELS_ID = 1 };

enum { EWA_COPC_FAULT_BYTES = 160 };

typedef struct ewa_copc_tree {
    double centre_world[3], half_world; ///< the root's cube
    double spacing_world;               ///< of the points of the root
    ewa_buffer nodes;                   ///< ewa_octree_node, in the order of the pages
    size_t node_count;
    char fault[EWA_COPC_FAULT_BYTES]; ///< why a part of the pages is left out; empty: nothing is
} ewa_copc_tree;

/// Whether the file is COPC.
bool ewa_copc_is(const ewa_cloud_source *source, const ewa_las_header *header);

/// Reads the pages of the hierarchy. Free with ewa_copc_tree_free(). Errors: EWA_ERROR_MEMORY.
ewa_status ewa_copc_tree_read(const ewa_cloud_source *source, const ewa_las_header *header,
                              ewa_copc_tree *tree);
void ewa_copc_tree_free(ewa_context *context, ewa_copc_tree *tree);

/// Notes the facts about a COPC file as "file.copc"; of others nothing. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_copc_note(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype);

#endif
