// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a kind of file with an octree of points has to offer.
#ifndef EWA_SRC_OCTREE_FORMAT_H
#define EWA_SRC_OCTREE_FORMAT_H

#include "io/cloud/format.h"
#include "io/octree.h"

enum { EWA_OCTREE_WAVE = 256 }; ///< most nodes that are read at once

/// What became of a node that was read.
typedef struct ewa_octree_result {
    ewa_status status;    ///< EWA_ERROR_MEMORY, EWA_ERROR_FORMAT; EWA_OK
    const char *fault;    ///< of EWA_ERROR_FORMAT: what is wrong, a text that stays
    uint64_t above_count; ///< colours that are more than their type holds
} ewa_octree_result;

/// One kind of file. Each lives in a file of its own.
typedef struct ewa_octree_format {
    /// Whether a path is of this kind; reports nothing.
    bool (*is)(ewa_context *context, const char *path);

    /// Opens `octree->path`: sets the facts but for the nodes and what is counted from them, fills prototype and nodes
    /// in any order.
    ewa_status (*open)(ewa_octree *octree);

    /// Makes ready for reading a wave of nodes, by the thread that calls. May be NULL.
    ewa_status (*begin)(ewa_octree *octree, const uint32_t *indices, uint32_t count);

    /// Reads node `slot` of the wave into one sink per attribute of the prototype. Any thread; may allocate.
    void (*read)(ewa_octree *octree, const ewa_octree_node *node, uint32_t slot, uint32_t worker,
                 const ewa_cloud_sink *sinks, ewa_octree_result *result);

    /// Ends a wave, also one that did not begin. May be NULL.
    void (*end)(ewa_octree *octree);

    /// Of files with levels: reads parts of the file, sorting them, which find() then gives until end(). NULL: there are no
    /// levels.
    ewa_status (*need)(ewa_octree *octree, ewa_range *parts, uint32_t count);
    const uint8_t *(*find)(const ewa_octree *octree, const ewa_range *part);

    /// Frees what open() made; also after its failure.
    void (*close)(ewa_octree *octree);
} ewa_octree_format;

struct ewa_octree {
    ewa_context *context;
    const ewa_octree_format *format;
    char *path;
    ewa_octree_facts facts;
    ewa_cloud *prototype;
    ewa_buffer nodes; ///< ewa_octree_node
    uint64_t node_count;
    uint64_t above_count;
    void *state;
};

/// Appends a node. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_octree_add(ewa_octree *octree, const ewa_octree_node *node);

extern const ewa_octree_format ewa_octree_copc, ewa_octree_ept;

#endif
