// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The cut through octrees that a picture is drawn of.
#ifndef EWA_SRC_LOD_CUT_H
#define EWA_SRC_LOD_CUT_H

#include "lod/tree.h"

/// A node of the picture.
typedef struct ewa_cut_item {
    ewa_lod *lod;
    uint32_t node;
    double weight;
    bool hides;
    double spacing_px, offset_px; ///< of the node; from the picture's middle
    uint32_t first_row, end_row;  ///< of the picture that it may touch
} ewa_cut_item;

/// What is known while nodes are chosen. The caller sets scene, home, camera, options, margin and parts.
typedef struct ewa_cut {
    const ewa_lod_scene *scene;
    ewa_lod *home; ///< the first octree, which keeps the lists
    ewa_lod *lod;  ///< in which nodes are chosen
    const ewa_camera *camera;
    double to_camera[12]; ///< of the octree's space: rows of an affine map
    const ewa_lod_options *options;
    double scale; ///< camera units that a unit of the octree's space has at most
    double margin_px;
    double parts_per_pixel; ///< that are drawn, and averaged
    double coarser;   ///< by which spacing and error may be larger than the options say; ewa_cut_settle() finds it
    bool loaded_only; ///< nodes that are not in memory are drawn by what represents them
    ewa_cut_item *items;
    uint32_t item_count;
    uint32_t missing_count;
    ewa_status status;
} ewa_cut;

/// Finds how much coarser the picture has to be, so that it takes no more surfels than it may. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_settle(ewa_cut *cut);

/// Lists the nodes that are drawn; `loaded_only`: of those in memory. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_choose(ewa_cut *cut, bool loaded_only);

/// Lists each node that the picture wants with all of its ancestors, so that they can be read from the
/// coarsest on and every picture on the way shows all that is there. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_list_ways(ewa_cut *cut);

#endif
