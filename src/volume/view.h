// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera, grid and options in the single-precision form that the kernels read.
#ifndef EWA_SRC_VOLUME_VIEW_H
#define EWA_SRC_VOLUME_VIEW_H

#include "splat/shading.h"
#include "volume/geometry.h"
#include "volume/kernels.h"
#include "volume/voxels.h"

/// Depth units of a frame. Unit number u holds depths from u * unit on.
typedef struct ewa_volume_slices {
    double unit;       ///< camera units
    double first_unit; ///< number of the first one with a voxel
    uint32_t count;
    int32_t point_slice; ///< slices from there on are of points
} ewa_volume_slices;

/// All arguments are checked ones.
void ewa_volume_slices_make(ewa_volume_slices *slices, const ewa_voxel_level *level,
                            const ewa_grid_view *grid, const ewa_volume_options *options);

void ewa_volume_view_set(ewa_volume_view *view, const ewa_grid_view *grid, const ewa_volume_slices *slices,
                         const ewa_voxels *voxels, const ewa_camera *camera,
                         const ewa_volume_options *options, const ewa_shading_setup *shading,
                         const ewa_footprint_table *table);

void ewa_volume_target_set(ewa_volume_target *target, const ewa_camera *camera,
                           const ewa_volume_options *options, const ewa_frame *frame);

/// The middle of a slice, camera-space depth.
static inline double ewa_slice_middle(const ewa_volume_slices *slices, uint32_t slice) {
    return (slices->first_unit + slice + 0.5) * slices->unit;
}

/// The filters of points by their standard deviations, evenly from 0 to EWA_FILTER_MOST_PX.
void ewa_point_filters_make(ewa_point_filter filters[EWA_FILTER_COUNT]);

/// Which of them is that of a slice: the pixel filter and the projected voxel's mean variance.
uint32_t ewa_point_filter_choose(const ewa_grid_view *grid, double z);

#endif
