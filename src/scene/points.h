// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The points of what a scene shows, as their files have them.
#ifndef EWA_SRC_SCENE_POINTS_H
#define EWA_SRC_SCENE_POINTS_H

#include "scene/parts.h"

/// Whether a place of the world is taken; on any thread.
typedef bool ewa_place_test(const void *user, const double place_world[3]);

/// Makes a cloud of those points of an item that no section cuts away, no region hides, and of which `test` (NULL: all are)
/// says yes; NULL where there is none, or nothing that has points. Of an octree those about a box are read. Errors: those of
/// ewa_lod_read().
ewa_status ewa_scene_cut_item(const ewa_scene *scene, const ewa_scene_item *item, const double low_world[3],
                              const double high_world[3], ewa_place_test *test, const void *user, ewa_cloud **piece);

#endif
