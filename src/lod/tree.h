// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The nodes of an open octree, what can be drawn of each, and those that are in memory.
#ifndef EWA_SRC_LOD_TREE_H
#define EWA_SRC_LOD_TREE_H

#include "ewa/lod.h"
#include "io/levels.h"
#include "io/octree.h"
#include "lod/appearance.h"

#include <math.h>

#define EWA_NO_NODE UINT32_MAX

/// A node: either surfels represent all of its points (it is divided, and its children hold more), or its
/// points are drawn.
typedef struct ewa_lod_node {
    ewa_octree_key key;
    uint32_t children[8]; ///< EWA_NO_NODE: none
    uint32_t file_node;   ///< of the file's octree; UINT32_MAX: none with points
    uint32_t page;        ///< of the levels; UINT32_MAX: there are none
    bool divided;
    double low_world[3], side_world;
    double box_low_world[3], box_high_world[3]; ///< in that, of what is drawn of it
    double spacing_world;        ///< of what is drawn of it
    double error;                ///< of that, rms, 1/255, where it is half a pixel apart
    double largest_radius_world; ///< of that
    uint64_t count;              ///< surfels or points of it, about
    ewa_surfels *surfels;        ///< NULL: not in memory
    size_t resident_bytes;
    uint64_t last_frame; ///< that drew it
    bool damaged;        ///< it cannot be read: what represents it stays
} ewa_lod_node;

struct ewa_lod {
    ewa_context *context;
    ewa_octree *octree;
    const ewa_octree_facts *facts;
    ewa_levels levels;
    ewa_cloud *represented; ///< no points; what surfels of pages have; NULL: there are no pages
    bool has_levels, has_surfels;
    ewa_lod_node *nodes; ///< the root first
    uint32_t node_count;
    size_t node_capacity_bytes;
    uint64_t frame;
    size_t resident_bytes;  ///< of all surfels
    ewa_cloud **clouds;     ///< [node]: its points, of those that are kept; else NULL
    uint64_t *cloud_frames; ///< [node]: when its points were wanted last
    char cloud_attributes[EWA_LOD_ATTRIBUTES_BYTES]; ///< that they were read with, beside those of surfels
    size_t cloud_bytes;
    ewa_lod_appearance appearance; ///< of what is in memory
    double stretch;                 ///< that no length grows by more in `appearance`
    ewa_buffer appearance_user; ///< the copy that it has
    bool damage_reported; ///< that some nodes cannot be read
    bool fewest_reported; ///< that there are no fewer surfels than are drawn
    ewa_lod *next;        ///< another instance of the same octree, closed with this one; NULL: none
    bool is_instance;     ///< file and levels are those of the octree that was opened
    ewa_buffer items;     ///< of the frame (cut.c)
    ewa_buffer cover;     ///< of the frame (cut.c)
    ewa_buffer measured;  ///< of the frame (cut.c)
    ewa_buffer instances; ///< of the frame: what is drawn
    ewa_buffer mixing;    ///< of the frame: two pictures of it
    ewa_buffer wanted;    ///< nodes to load
};

/// Finds an instance of an open octree, which looks as it does in one of several places of a picture: 0 the octree
/// itself, others with the same file and levels, and with nodes in memory of their own. It stays until the octree is
/// closed. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_tree_instance(ewa_lod *lod, uint32_t number, ewa_lod **instance);

/// Sets how an octree appearances, NULL: as it is, and drops what is in memory if it looked otherwise. Errors:
/// EWA_ERROR_MEMORY; then nothing is in memory.
ewa_status ewa_tree_set_appearance(ewa_lod *lod, const ewa_lod_appearance *appearance);

/// Whether what was made with one appearance is what another one makes.
bool ewa_tree_appearances_equal(const ewa_lod_appearance *a, const ewa_lod_appearance *b);

/// Makes the nodes of an open octree. Errors: EWA_ERROR_MEMORY, EWA_ERROR_FORMAT.
ewa_status ewa_tree_make(ewa_lod *lod);

/// Makes the cloud of no points whose attributes surfels of pages have. The caller owns it. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_tree_make_represented(const ewa_lod *lod, ewa_cloud **cloud);

/// The cells of one level within the node of a file node, whose own level is not finer.
typedef struct ewa_tree_cells {
    double per_side, low_world[3], first[3], last[3];
} ewa_tree_cells;

void ewa_tree_cells_begin(const ewa_lod *lod, const ewa_octree_key *file_node, int32_t level, ewa_tree_cells *cells);

/// The cell that contains a place, within the node of the file node that holds the point.
static inline void ewa_tree_cell(const ewa_tree_cells *cells, const double world[3], int32_t cell[3]) {
    for (int c = 0; c < 3; c++) {
        const double at = floor((world[c] - cells->low_world[c]) * cells->per_side);
        cell[c] = (int32_t)(at >= cells->first[c] ? (at <= cells->last[c] ? at : cells->last[c]) : cells->first[c]);
    }
}

/// Which of its parent's children a node is.
uint32_t ewa_tree_child_of(const ewa_octree_key *key);

/// How nodes are read.
typedef struct ewa_tree_reading {
    const ewa_lod_appearance *appearance;
    uint64_t frame, memory_bytes; ///< an eighth of the memory is for points that nodes share
} ewa_tree_reading;

enum { EWA_TREE_BATCH = 16 }; ///< nodes that are read at once

/// Reads what is drawn of at most EWA_TREE_BATCH nodes, which are not in memory and stay so: the caller owns `surfels` [count],
/// all NULL after a failure. One thread at a time reads, while another one may draw what is in memory. Errors: as ewa_lod_open().
ewa_status ewa_tree_read(ewa_lod *lod, const ewa_tree_reading *how, const uint32_t *nodes, uint32_t count,
                         ewa_surfels **surfels);

/// Puts a node that was read into memory; its surfels become the tree's.
void ewa_tree_put(ewa_lod *lod, uint32_t node, ewa_surfels *surfels);

/// Keeps the points of a node of the file, of which there are none yet, for the nodes below that share them.
void ewa_tree_keep_points(ewa_lod *lod, uint32_t file_node, ewa_cloud *points);

/// Drops points of nodes, those that were wanted longest ago first, until `memory_bytes` are enough for the others.
void ewa_tree_trim_points(ewa_lod *lod, uint64_t memory_bytes);

/// Reads what is drawn of some nodes, all at once, into memory. Errors: as ewa_lod_open().
ewa_status ewa_tree_load(ewa_lod *lod, const uint32_t *nodes, uint32_t count, uint64_t memory_bytes);

/// Drops nodes and points that were not wanted by this frame, those that were wanted longest ago first, until
/// `memory_bytes` are enough.
void ewa_tree_trim(ewa_lod *lod, uint64_t memory_bytes);

/// Bytes of what is drawn of a node, about where it is not in memory.
uint64_t ewa_tree_bytes_of(const ewa_lod_node *node);

/// Makes room for a node that is not in memory; false: what this frame wants takes it.
bool ewa_tree_make_room(ewa_lod *lod, uint32_t node, uint64_t memory_bytes);

/// Drops what is in memory of a node.
void ewa_tree_drop(ewa_lod *lod, uint32_t node);

#endif
