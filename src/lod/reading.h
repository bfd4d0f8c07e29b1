// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Nodes that are read on one thread while another one draws those that are there.
#ifndef EWA_SRC_LOD_READING_H
#define EWA_SRC_LOD_READING_H

#include "lod/tree.h"

/// Nodes of one octree that are read at once. Zero-initialise but for the context.
typedef struct ewa_lod_reading {
    ewa_context *context; ///< of the thread that reads
    ewa_lod *lod; ///< borrowed from choosing to putting
    uint32_t nodes[EWA_TREE_BATCH], count;
    ewa_surfels *surfels[EWA_TREE_BATCH]; ///< all NULL where they could not be read
    uint32_t careful_count;               ///< so many are to be read one by one: one of them is damaged
    ewa_lod_appearance appearance;        ///< the octree's when they were chosen
    ewa_buffer appearance_user;
    uint64_t frame, memory_bytes;
} ewa_lod_reading;

/// Makes a picture of octrees ready: instances in the place of octrees that are there several times, as they look, and complete options,
/// where what has but some time leaves pixels whole. `scene` has octrees; `appearances` and `options` may be NULL. Errors: as ewa_lod_scene_draw().
ewa_status ewa_lod_begin_picture(ewa_lod_scene *scene, const ewa_lod_appearance *const *appearances, const ewa_render_options *options,
                           ewa_render_options *plain);

/// Chooses at most `max_count` nodes that a picture needs and that are not in memory, the most urgent first; none where nothing
/// is missing, or where there is no memory for more. Not while the octrees are drawn. Errors: as ewa_lod_scene_draw().
ewa_status ewa_lod_reading_choose(ewa_lod_reading *reading, const ewa_lod_scene *scene, const ewa_lod_appearance *const *appearances,
                                  const ewa_camera *camera, const ewa_render_options *options,
                                  const ewa_lod_options *lod_options, uint32_t max_count);

/// Reads them, also while the octrees are drawn with ewa_lod_options.resident_only. What is damaged of an octree is reported once. Errors: as
/// ewa_lod_open().
ewa_status ewa_lod_reading_read(ewa_lod_reading *reading);

/// Has pictures be drawn of what was read, and no node be read again that could not be. Not while the octrees are drawn. What
/// was chosen for another appearance is given up.
void ewa_lod_reading_put(ewa_lod_reading *reading);

/// Frees what is kept from one choice to the next; nothing is chosen.
void ewa_lod_reading_free(ewa_lod_reading *reading);

#endif
