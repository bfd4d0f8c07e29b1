// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Octrees that are drawn otherwise than as they are: moved, filtered, in other colours.
#ifndef EWA_SRC_LOD_APPEARANCE_H
#define EWA_SRC_LOD_APPEARANCE_H

#include "ewa/lod.h"

enum { EWA_LOD_ATTRIBUTES_BYTES = 2048 };

/// How an octree is drawn. `place` and `paint` get points, or surfels that represent some, node by node, in the order
/// in which a cloud is changed: `place` before what they lack is estimated, `paint` afterwards. Both may replace
/// `*cloud`, which may have no points then; the old one is destroyed. NULL: nothing is done.
typedef struct ewa_lod_appearance {
    double to_world[16]; ///< what `place` does to places: row-major, acts on columns, affine and invertible
    double radius_scale; ///< of all radii, above 0
    /// Of the file, that are read beside what surfels are made of, each after a comma.
    char attributes[EWA_LOD_ATTRIBUTES_BYTES];
    ewa_status (*place)(const void *user, ewa_cloud **cloud);
    ewa_status (*paint)(const void *user, ewa_cloud **cloud);
    const void *user; ///< `user_bytes` bytes that say all that both do, and are copied
    size_t user_bytes;
    bool filtered; ///< `place` takes some of what is sampled alike: what their kernels sum up to is theirs, not the file's
} ewa_lod_appearance;

/// As ewa_lod_scene_render(), with octrees looking as `appearances` [scene->lod_count] say; NULL, as a whole or one of them:
/// as they are. What is in memory of an octree stays only as long as its appearance is the same. Errors: its, and those of
/// `place` and `paint`.
ewa_status ewa_lod_scene_draw(const ewa_lod_scene *scene, const ewa_lod_appearance *const *appearances,
                              ewa_renderer *renderer, const ewa_camera *camera,
                              const ewa_render_options *options, const ewa_lod_options *lod_options,
                              const ewa_frame *frame, ewa_lod_stats *stats);

#endif
