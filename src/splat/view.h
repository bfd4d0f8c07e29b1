// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera and options in the single-precision form that the kernels read.
#ifndef EWA_SRC_SPLAT_VIEW_H
#define EWA_SRC_SPLAT_VIEW_H

#include "kernels/road.h"
#include "math/placement.h"
#include "splat/packets.h"
#include "splat/shading.h"

/// All arguments are checked ones; `placement` is the camera's before surfels->extent. Errors:
/// EWA_ERROR_NUMERIC for a camera without a view volume.
ewa_status ewa_view_set(ewa_view *view, const ewa_surfels *surfels, const ewa_camera *camera,
                        const ewa_placement *placement, const ewa_render_options *options, uint32_t tile_px);

void ewa_resolve_set(ewa_resolve *resolve, const ewa_surfels *surfels, const ewa_camera *camera,
                     const ewa_placement *placement, const ewa_render_options *options,
                     const ewa_shading_setup *shading, const ewa_frame *frame);

/// Sets the numbers of a material in the order in which the kernels have them.
void ewa_material_numbers(const ewa_material *material, float numbers[EWA_MATERIAL_CHANNELS]);

/// Sets the record of a near or broad surfel (packet * 16 + lane) for one tile; false: not drawn.
bool ewa_near_record_set(ewa_near_record *record, const ewa_surfels *surfels, uint32_t surfel,
                         const ewa_view *view, const ewa_tile *tile);

/// Sets the clip lines of a surfel that has some (packet * 16 + lane), on the screen of a tile.
void ewa_clip_set(ewa_clip *clip, const ewa_surfels *surfels, uint32_t surfel, const ewa_view *view,
                  const ewa_tile *tile);

#endif
