// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Regions of a scene, for its files.
#ifndef EWA_SRC_SCENE_REGION_H
#define EWA_SRC_SCENE_REGION_H

#include "ewa/region.h"
#include "ewa/render.h"

/// Whether six numbers are a lower and an upper corner.
bool ewa_region_is_box(const double box_world[6]);

/// Whether a region's box has axes of its own, other than those of the world.
bool ewa_region_is_turned(const ewa_region *region);

/// Checks that the numbers of regions are finite and as many as there may be, and boxes those of a lower and an upper corner.
ewa_status ewa_regions_check(ewa_context *context, const ewa_region *regions, uint32_t count);

/// Whether no region hides point `index` of a cloud, which is at a place of the world.
bool ewa_regions_keep(const ewa_region *regions, uint32_t count, const ewa_cloud *cloud, uint64_t index,
                      const double place_world[3]);

/// Whether no region hides a place of the world whose class has a code; -1: it has none.
bool ewa_regions_keep_place(const ewa_region *regions, uint32_t count, const double place_world[3], double code);

/// Whether a place is not cut away by the sections of a renderer.
bool ewa_sections_keep(const ewa_render_options *render, const double place_world[3]);

/// Whether some region asks for the points' classes.
bool ewa_regions_have_classes(const ewa_region *regions, uint32_t count);

/// Replaces a cloud by one of the points that regions do not hide.
ewa_status ewa_cloud_hide(ewa_context *context, const ewa_region *regions, uint32_t count, ewa_cloud **cloud);

#endif
