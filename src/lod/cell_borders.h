// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Borders of the points of one node, which were estimated without those of others.
#ifndef EWA_SRC_LOD_CELL_BORDERS_H
#define EWA_SRC_LOD_CELL_BORDERS_H

#include "io/octree.h"

/// Whether a row-major affine map keeps angles, so that densities and squares of radii change alike. Any thread.
bool ewa_cell_is_similar(const double to_world[16]);

/// Removes the borders ("border", floats, 3 each, of discs) that a node's points have where its cube ends, beyond which
/// other nodes go on. The points are mapped by `to_world`, row-major and affine; where that keeps no angles no border is left.
void ewa_cell_keep_borders(const ewa_octree_facts *facts, const ewa_octree_key *key, const double to_world[16],
                           ewa_cloud *cloud);

/// Removes "border" where no point has one: pictures would read it of every point. Any thread.
void ewa_cell_drop_empty_borders(ewa_cloud *cloud);

#endif
