// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of the resident forms of Gaussians and volumes, by places.
#ifndef EWA_SRC_VOLUME_SHOWN_H
#define EWA_SRC_VOLUME_SHOWN_H

#include "ewa/gaussian_render.h"
#include "ewa/volume_render.h"

/// Whether what is at a place of the world is shown; on any thread. `code`: its class; -1: it is of none.
typedef bool ewa_place_shown(const void *user, const double place_world[3], int32_t code);

/// Makes, by a context of the calling thread, a view of splats that shows those, of levels too, whose centres are shown; it borrows all else, and is destroyed before
/// `splats`. Its facts are those of `splats`. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_splats_show(ewa_context *context, const ewa_splats *splats, ewa_place_shown *test, const void *user,
                           ewa_splats **view);

/// Makes, likewise, voxels of those, of all levels, whose centres are shown; their facts, but for what is counted, are those of `voxels`.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_voxels_show(ewa_context *context, const ewa_voxels *voxels, ewa_place_shown *test, const void *user,
                           ewa_voxels **part);

/// Calls `visit` for the centre of every splat, or of every voxel of the finest level, that is resident and shown.
typedef void ewa_place_visit(void *user, const double place_world[3], int32_t code);
void ewa_splats_visit(const ewa_splats *splats, ewa_place_visit *visit, void *user);
void ewa_voxels_visit(const ewa_voxels *voxels, ewa_place_visit *visit, void *user);

#endif
