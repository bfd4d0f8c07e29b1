// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A camera's view of the voxels of one grid, in double precision: what all of them share.
#ifndef EWA_SRC_VOLUME_GEOMETRY_H
#define EWA_SRC_VOLUME_GEOMETRY_H

#include "ewa/volume_render.h"
#include "math/vec.h"

/// Camera-space form of a grid. Camera units are world units times `scale`.
typedef struct ewa_grid_view {
    bool orthographic;
    double fx_px, fy_px, cx_px, cy_px;
    double scale;           ///< camera units per world unit
    ewa_mat3 axes;          ///< rows: steps along i, j, k in camera space
    ewa_vec3 origin;        ///< voxel 0, 0, 0 in camera space
    ewa_mat3 covariance;    ///< Sigma of every voxel
    ewa_mat3 inverse;       ///< Sigma^-1
    double kernel_steps;    ///< standard deviation of a voxel in steps of the grid
    double depth_sigma;     ///< sqrt(Sigma33)
    double mean_variance;   ///< a third of Sigma's trace
    double longest_step;    ///< in camera units
    double near;            ///< perspective: voxels up to there are not drawn
    double cutoff, cutoff2; ///< F, F^2
    double prefilter2_px2;  ///< h^2
    double whole;           ///< 1 / (1 - exp(-F^2 / 2)): makes up for what the cutoff leaves out
    double point_mass;      ///< integral over the screen, px^2, of a voxel's optical depth per extinction:
                            ///< orthographic; perspective: times |p| / pz^3
    double splat_peak;      ///< optical depth through a voxel's middle per extinction, times
                            ///< sqrt(p Sigma^-1 p) / |p| (orthographic: p = 0 0 1)
} ewa_grid_view;

/// `index_to_world` of the grid is invertible, camera and options are checked.
void ewa_grid_view_make(ewa_grid_view *view, const double index_to_world[12], const ewa_camera *camera,
                        const ewa_volume_options *options);

/// Camera space of an index.
static inline ewa_vec3 ewa_grid_place(const ewa_grid_view *view, double i, double j, double k) {
    return vec3_add(view->origin, vec3_mul_mat3(vec3_make(i, j, k), &view->axes));
}

#endif
