// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How octrees are shown.
#ifndef EWA_SRC_SCENE_OCTREE_H
#define EWA_SRC_SCENE_OCTREE_H

#include "lod/appearance.h"
#include "scene/parts.h"

/// What is done to the points of an octree's nodes, and to what represents them.
typedef struct ewa_octree_change {
    ewa_filter filter; ///< in the octree's space
    uint32_t region_count;
    ewa_region regions[EWA_MAX_REGIONS]; ///< that hide points
    double to_world[16];
    ewa_color_scale scale; ///< of `attribute`
    double opacity, tint[3];
    uint32_t material;
    bool moved, tinted;
    char attribute[EWA_SCALAR_NAME_BYTES]; ///< that colours stand for; empty: none
} ewa_octree_change;

/// How an octree is drawn; `appearance` refers to `change`.
typedef struct ewa_octree_appearance {
    ewa_lod_appearance appearance;
    ewa_octree_change change;
} ewa_octree_appearance;

/// Says how the octree of an instance is drawn: as its asset and the instance are. Errors: EWA_ERROR_ARGUMENT (no such
/// attribute), EWA_ERROR_UNSUPPORTED (what represents points lacks the number by which they are coloured or chosen, and
/// `options` may have it drawn).
ewa_status ewa_scene_octree_appearance(const ewa_scene *scene, uint32_t index, const ewa_lod_options *options,
                                 ewa_octree_appearance *shown);

/// Reads the points of an octree in a box of the scene, and maybe some beside it, filtered and moved as the asset's. The
/// caller owns `*cloud`. Errors: those of ewa_lod_read().
ewa_status ewa_asset_read_octree(const ewa_asset *asset, const double low_world[3], const double high_world[3],
                                 ewa_cloud **cloud);

#endif
