// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera, grid and options in the single-precision form that the kernels read.
#ifndef EWA_SRC_VOLUME_VIEW_H
#define EWA_SRC_VOLUME_VIEW_H

#include <math.h>

#include "surface/shading.h"
#include "volume/geometry.h"
#include "volume/kernels.h"
#include "volume/voxels.h"

/// Depth units of a frame. Unit 0 has the depth of voxel 0, 0, 0 in its middle, so that layers of voxels that
/// are parallel to the picture are in the middles of units, and not torn apart by rounding.
typedef struct ewa_volume_slices {
    double unit;  ///< units of the grid
    double start; ///< depth at which slice 0 begins
    uint32_t count;
    bool has_near;       ///< voxels in front of slice 0 are drawn ray by ray
    int32_t point_slice; ///< slices from there on are of points
} ewa_volume_slices;

/// The depth unit of a grid, in its units.
double ewa_volume_depth_unit(const ewa_grid_view *grid, const ewa_volume_options *options);

/// The number of the unit that holds a depth.
static inline double ewa_volume_unit_of(const ewa_grid_view *grid, double unit, double z) {
    return floor((z - grid->origin.z) / unit + 0.5);
}

/// The first depth unit of which all voxels are far enough from the eye to be ellipses on the screen; those
/// of units before it are drawn ray by ray. -infinity for orthographic cameras.
double ewa_volume_first_far_unit(const ewa_grid_view *grid, double unit);

/// All arguments are checked ones.
void ewa_volume_slices_make(ewa_volume_slices *slices, const ewa_voxel_level *level,
                            const ewa_grid_view *grid, const ewa_volume_options *options);

void ewa_volume_view_set(ewa_volume_view *view, const ewa_grid_view *grid, const ewa_volume_slices *slices,
                         const ewa_voxels *voxels, const ewa_camera *camera,
                         const ewa_volume_options *options, const ewa_shading_setup *shading,
                         const ewa_footprint_table *table);

/// Where the pixels of a frame go, and what is behind: surfaces, and a straight background.
void ewa_volume_target_set(ewa_volume_target *target, const ewa_camera *camera, const ewa_frame *frame,
                           const ewa_surface_planes *surface, const float background[4]);

/// The middle of a slice, camera-space depth.
static inline double ewa_slice_middle(const ewa_volume_slices *slices, uint32_t slice) {
    return slices->start + (slice + 0.5) * slices->unit;
}

/// The filters of points by their standard deviations, evenly from 0 to EWA_FILTER_MAX_PX.
void ewa_point_filters_make(ewa_point_filter filters[EWA_FILTER_COUNT]);

/// Which of them is that of a slice: the pixel filter and the projected voxel's mean variance.
uint32_t ewa_point_filter_choose(const ewa_grid_view *grid, double z);

#endif
