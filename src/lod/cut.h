// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The cut through octrees that a picture is drawn of.
#ifndef EWA_SRC_LOD_CUT_H
#define EWA_SRC_LOD_CUT_H

#include "lod/tree.h"
#include "surface/parts.h"

/// A node of the picture.
typedef struct ewa_cut_item {
    ewa_lod *lod;
    uint32_t node;
    uint32_t level; ///< of the node's surfels; other than 0: of roots
    double weight;
    bool hides;
    double spacing_px, offset_px; ///< of the level; from the picture's middle
    uint32_t first_row, end_row;  ///< of the picture that it may touch
} ewa_cut_item;

/// Surfels of an item, about.
static inline uint64_t ewa_cut_item_count(const ewa_cut_item *item) {
    return item->lod->nodes[item->node].count >> 2 * item->level;
}

/// What is known while nodes are chosen.
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
    double coarser;   ///< by which spacing and error may be larger than the options say
    bool loaded_only; ///< nodes that are not in memory are drawn by what represents them
    ewa_cut_item *items;
    uint32_t item_count;
    uint32_t missing_count;
    ewa_status status;
} ewa_cut;

/// Nodes as fine as so many parts along a pixel's side.
static inline void ewa_cut_divide(ewa_lod_options *options, uint32_t count) { options->spacing_px /= count, options->error /= count; }

/// Says into how many parts pixels are divided: where the options leave it open, as many as make them as small as what is drawn, but of octrees no
/// more than take about as many surfels as a picture that these fill. The same for all ranks, bands, and what is in memory.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_choose_parts(const ewa_lod_scene *scene, const ewa_camera *camera, const ewa_render_options *options,
                                const ewa_lod_options *chosen, ewa_division *parts);

/// Begins a picture of octrees: what was wanted before may go, and what is known of the cut is filled in, also how much coarser the
/// picture has to be, so that it takes no more surfels than it may. `options` and `chosen` for parts of pixels. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_begin(ewa_cut *cut, const ewa_lod_scene *scene, const ewa_camera *camera,
                         const ewa_render_options *options, const ewa_lod_options *chosen);

/// What was wanted before may go.
void ewa_cut_next_frame(const ewa_lod_scene *scene);

/// Bytes that all octrees of a picture but one keep.
uint64_t ewa_cut_bytes_beside(const ewa_lod_scene *scene, const ewa_lod *lod);

/// Lists the nodes that are drawn; `loaded_only`: of those in memory. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_choose(ewa_cut *cut, bool loaded_only);

/// Lists each node that the picture wants with all of its ancestors, so that they can be read from the
/// coarsest on and every picture on the way shows all that is there. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_cut_list_with_ancestors(ewa_cut *cut);

/// The same in the order in which they are to be read, marked as wanted: what is coarse first, then what is large and in the middle.
ewa_status ewa_cut_list_urgent(ewa_cut *cut);

#endif
