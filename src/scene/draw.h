// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The memory of a scene's frames.
#ifndef EWA_SRC_SCENE_DRAW_H
#define EWA_SRC_SCENE_DRAW_H

#include "base/base.h"
#include "lod/appearance.h"
#include "scene/detail.h"
#include "scene/parts.h"

/// What of streamed Gaussians is in memory (streamed.c).
typedef struct ewa_streams {
    ewa_buffer caches;         ///< of each asset that is shown,
    uint32_t cache_count;
    uint64_t frame, bytes;     ///< pictures so far; of all that is in memory
    ewa_buffer views, missing, unused; ///< of a picture: leaves that it shows; what is to be read; what need not stay
    ewa_buffer splats, colors; ///< what it is drawn of
    bool told;                 ///< that it is coarser than it was to be
} ewa_streams;

struct ewa_scene_renderer {
    ewa_context *context;
    ewa_exchange exchange; ///< swap NULL: one process
    ewa_renderer *surfaces;
    ewa_gaussian_renderer *gaussians; ///< NULL: not used yet
    bool drew_gaussians, drew_volume; ///< of the last picture: by `gaussians`; a volume alone
    ewa_volume_renderer *volumes[EWA_MAX_MIXED_VOLUMES];
    ewa_image rgba, depth, normal, coverage; ///< of surfaces among others, of the size of the last frame
    ewa_image lit_rgba, lit_depth;           ///< of everything, before eye-dome lighting
    ewa_buffer surfels, lods, splats, splat_colors; ///< lists of what is visible
    const ewa_camera *lit_from;  ///< whose left and top light of bare surfaces comes from; NULL: the frame's
    uint32_t level;              ///< of surfels in memory, of the frame (details)
    double finer;                ///< pixels of a frame for one of those that sizes of points are told in; 0: 1
    ewa_details details;         ///< of the surfels that are drawn
    ewa_streams streams;
    ewa_buffer appearances, appearance_list; ///< of the octrees: one ewa_octree_appearance each, and a pointer to its appearance
};

/// What of a scene is visible; the lists are the renderer's.
typedef struct ewa_scene_shown {
    const ewa_surfels **surfels;
    ewa_lod **lods;
    const ewa_lod_appearance **appearances; ///< of the octrees
    const ewa_splats **splats;
    const ewa_splat_colors **splat_colors; ///< of each: in place of its own; NULL: these
    const ewa_asset *volumes[EWA_MAX_MIXED_VOLUMES];
    const ewa_voxels *voxels[EWA_MAX_MIXED_VOLUMES]; ///< theirs, without what regions hide
    uint32_t surfels_count, lod_count, splats_count, volume_count;
    bool streamed;     ///< some Gaussians are, whose coarsest level is in the list
    bool colored;      ///< some surface has colours
    bool photographed; ///< all surfaces have the light of photographs
    double near_world; ///< that suits the Gaussians
} ewa_scene_shown;

/// Lists what is visible, in buffers of the renderer. Errors: those of ewa_scene_octree_appearance(), EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
ewa_status ewa_scene_list_shown(const ewa_scene *scene, const ewa_lod_options *options, ewa_scene_renderer *renderer,
                                ewa_scene_shown *shown);

/// Frees what of streamed Gaussians is in memory.
void ewa_streams_free(ewa_context *context, ewa_streams *streams);

void ewa_scene_renderer_free_lists(ewa_scene_renderer *renderer);

#endif
