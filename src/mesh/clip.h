// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clip lines of discs near sharp edges.
#ifndef EWA_SRC_MESH_CLIP_H
#define EWA_SRC_MESH_CLIP_H

#include "mesh/surface.h"

/// Finds the edges within reach of a place.
typedef struct mesh_edge_grid {
    const mesh_surface *surface;
    double reach_world, cell_world;
    uint32_t *first; ///< by hash of a cell and a part: bucket_count + 1 sums
    uint32_t *edge;  ///< edges of the part within reach of some place in the cell, for a hash; may repeat
    size_t bucket_count, entry_count;
} mesh_edge_grid;

/// A disc in its plane: centre relative to the surface's origin, axes of unit length, and up to two lines (a,
/// b, c), c in world units; without a line a = b = 0.
typedef struct mesh_clip_disc {
    double center[3], u[3], v[3], normal[3];
    double radius_world;
    uint32_t part;
    double line[2][3]; ///< out
    bool either;       ///< out: what one of two lines keeps is kept
} mesh_clip_disc;

/// Sorts the edges of the surface by cells. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_mesh_edge_grid_make(const mesh_surface *surface, double reach_world, mesh_edge_grid *grid);
void ewa_mesh_edge_grid_free(mesh_edge_grid *grid);

/// Sets the lines of a disc whose radius is at most the grid's reach. Any thread.
void ewa_mesh_clip_disc(const mesh_edge_grid *grid, mesh_clip_disc *disc);

#endif
