// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees of points in files, read node by node: COPC files and EPT folders; COPC is written too. A node's
// points are a sample of all that lie in it, finer by half from level to level; each point is in one node
// only.
//
// Based on: Hobu, "COPC: Cloud Optimized Point Cloud Specification 1.0", 2021; "Entwine Point Tile", 1.1.0.
#ifndef EWA_SRC_OCTREE_H
#define EWA_SRC_OCTREE_H

#include "base/base.h"
#include "ewa/cloud.h"
#include "io/ranges.h"

enum { EWA_OCTREE_LEVELS = 31 }; ///< maximum depth of a tree

/// Cell `cell` of the 2^level along each axis of the root's cube.
typedef struct ewa_octree_key {
    int32_t level, cell[3];
} ewa_octree_key;

/// Compares by level, then z, y, x.
int ewa_octree_key_compare(const ewa_octree_key *a, const ewa_octree_key *b);

/// A node and where its points are.
typedef struct ewa_octree_node {
    ewa_octree_key key;
    uint64_t point_count; ///< > 0
    uint64_t at_bytes;    ///< COPC: of the file
    uint64_t size_bytes;  ///< COPC: of the chunk; EPT: 0
} ewa_octree_node;

typedef struct ewa_octree ewa_octree;

/// What a file says of its tree.
typedef struct ewa_octree_facts {
    const char *kind;                ///< "COPC 1.0", "EPT 1.1.0"
    double low_world[3], side_world; ///< the root's cube
    double spacing_world;            ///< of the points of the root; half of it from level to level
    uint64_t point_count;            ///< of all nodes
    ewa_bounds bounds;               ///< of the points, as the file says
    const ewa_cloud *prototype;      ///< no points; attributes, origin, grid and notes of those of every node
    const ewa_octree_node *nodes;    ///< each key once, in the order of ewa_octree_key_compare()
    uint32_t node_count;
    /// COPC: the first extended record of user "ewa", id 1, as far as its table goes (ewa_levels_table_bytes()); NULL: none
    const uint8_t *levels;
    uint64_t levels_at_bytes, levels_bytes; ///< where the whole record is in the file
} ewa_octree_facts;

/// Whether a path is such a tree: a COPC file, by content, a folder that holds "ept.json", or an "ept.json". Reports
/// nothing.
bool ewa_octree_is(ewa_context *context, const char *path);

/// Opens a tree and reads its hierarchy, all pages of it. Every number is checked: nodes lie within the file, keys
/// are nodes, each comes once (else an error that names it), pages in circles end. The file stays mapped. The
/// caller closes `*octree`, which is NULL after a failure. Errors: EWA_ERROR_IO, EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_octree_open(ewa_context *context, const char *path, ewa_octree **octree);

/// Facts that stay until the tree is closed.
const ewa_octree_facts *ewa_octree_describe(const ewa_octree *octree);

/// Returns the index of the node with that key, UINT32_MAX when there is none.
uint32_t ewa_octree_find(const ewa_octree *octree, const ewa_octree_key *key);

/// Reads the points of nodes `indices[0]` to `indices[count - 1]`, all workers at once, into one cloud each that
/// the caller owns (all NULL after a failure): the attributes of the prototype that are named, comma-separated,
/// besides "position"; NULL: all. A node whose chunk is damaged, or whose file of EPT is missing or has another number of
/// points, is an error that names its key (level-x-y-z). Errors as ewa_octree_open().
ewa_status ewa_octree_read(ewa_octree *octree, const uint32_t *indices, uint32_t count,
                           const char *attributes, ewa_cloud **clouds);

/// Reads `count` parts of the record of levels, `at_bytes` from its begin, which it sorts; ewa_octree_find_level(), on any thread,
/// returns where one of them is, until ewa_octree_let_levels_go(). Errors as ewa_octree_open().
ewa_status ewa_octree_need_levels(ewa_octree *octree, ewa_range *parts, uint32_t count);
const uint8_t *ewa_octree_find_level(const ewa_octree *octree, uint64_t at_bytes, uint64_t size_bytes);
void ewa_octree_let_levels_go(ewa_octree *octree);

/// Closes the tree and sets `*octree` to NULL; accepts NULL and a pointer to NULL.
void ewa_octree_close(ewa_octree **octree);

// ---- Writing

/// What the points of some records come to, for the header.
typedef struct ewa_octree_sums {
    int32_t low[3], high[3]; ///< in steps of the grid
    uint64_t by_return[16];
    uint64_t clamped_count;
    double gps_time_low, gps_time_high; ///< low > high: none
} ewa_octree_sums;

/// A node in the form in which it stands in the file. Its memory is the context's.
typedef struct ewa_octree_chunk {
    ewa_octree_key key;
    uint32_t point_count;
    ewa_octree_sums sums;
    ewa_buffer bytes;
    size_t size_bytes;
} ewa_octree_chunk;

void ewa_octree_chunk_free(ewa_context *context, ewa_octree_chunk *chunk);

typedef struct ewa_octree_writer ewa_octree_writer;

/// What a file that is written says of its tree.
typedef struct ewa_octree_plan {
    const ewa_cloud *prototype; ///< no points; attributes, origin, grid and notes of the points of every node
    ewa_bounds bounds;          ///< of all points, world
    double low_world[3], side_world, spacing_world;
} ewa_octree_plan;

/// Begins a COPC file (LAS 1.4, point format 6, 7 or 8 by the prototype's attributes: color, nir; everything else into
/// extra bytes, normals as "NormalX" ... of the type they have). The plan is copied, but for the prototype, which must
/// outlive the writer. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_LIMIT (the box does not fit 32 bits), EWA_ERROR_IO,
/// EWA_ERROR_UNSUPPORTED (a path that cannot be patched), EWA_ERROR_MEMORY.
ewa_status ewa_octree_writer_open(ewa_context *context, const char *path, const ewa_octree_plan *plan,
                                  ewa_octree_writer **writer);

/// The grid that coordinates are rounded to in the file.
void ewa_octree_writer_grid(const ewa_octree_writer *writer, ewa_coordinate_grid *grid);

/// Encodes clouds with the prototype's attributes, in its order, as nodes, by all workers: `chunks[i]`, zero-initialised
/// or used before, gets `keys[i]` and `pieces[i]`. All positions must be finite and within the plan's bounds.
ewa_status ewa_octree_encode(ewa_octree_writer *writer, const ewa_octree_key *keys,
                             const ewa_cloud *const *pieces, uint32_t count, ewa_octree_chunk *chunks);

/// Appends a node; the same key twice is an error.
ewa_status ewa_octree_append(ewa_octree_writer *writer, const ewa_octree_chunk *chunk);

/// Ends the points and begins the extended record of user "ewa", id 1, that ewa_octree_levels_put() fills with exactly
/// `size_bytes` bytes. At most once, after the last node.
ewa_status ewa_octree_levels_begin(ewa_octree_writer *writer, uint64_t size_bytes);
ewa_status ewa_octree_levels_put(ewa_octree_writer *writer, const void *bytes, size_t size_bytes);

/// Writes the hierarchy in pages, patches header and records; the file appears. Sets `*writer` to NULL, also after a
/// failure, which removes the file.
ewa_status ewa_octree_writer_commit(ewa_octree_writer **writer);
void ewa_octree_writer_abort(ewa_octree_writer **writer);

#endif
