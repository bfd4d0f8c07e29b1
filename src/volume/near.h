// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Voxels at the eye: those whose kernels reach the plane of the eye have no ellipse on the screen and are
// drawn ray by ray, before all others.
#ifndef EWA_SRC_VOLUME_NEAR_H
#define EWA_SRC_VOLUME_NEAR_H

#include "volume/bin.h"

/// All rays of a part of the picture lie in a cone, in standard deviations of the kernel along i, j, k.
typedef struct ewa_ray_cone {
    double axis[3]; ///< length 1
    double angle;   ///< half, radians; pi: everywhere
} ewa_ray_cone;

/// The cone of the pixels [left, right) x [top, bottom). Perspective only.
void ewa_ray_cone_make(ewa_ray_cone *cone, const ewa_grid_view *grid, double left, double top, double right,
                       double bottom);

/// Whether the cone meets a ball at `offset` from the eye; true when in doubt.
bool ewa_ray_cone_hits(const ewa_ray_cone *cone, const double offset[3], double radius);

/// The voxels at the eye of a frame, front to back. Zero-initialise.
typedef struct ewa_near_list {
    uint32_t count;
    const ewa_near_voxel *voxels; ///< [count]
    ewa_buffer found, sorted, order, keys;
} ewa_near_list;

/// Lists them. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_near_list_fill(ewa_context *context, ewa_near_list *list, const ewa_volume_kernels *kernels,
                              const ewa_volume_view *view, const ewa_voxel_level *level,
                              const ewa_grid_view *grid, const ewa_volume_bins *bins,
                              const ewa_camera *camera);

void ewa_near_list_free(ewa_context *context, ewa_near_list *list);

/// Where the voxels of a block are, for the kernels.
ewa_volume_source ewa_block_source(const ewa_voxel_level *level, const ewa_grid_view *grid,
                                   const ewa_block_view *view);

#endif
