// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A camera's view of the voxels of one grid, in double precision: what all of them share.
#ifndef EWA_SRC_VOLUME_GEOMETRY_H
#define EWA_SRC_VOLUME_GEOMETRY_H

#include "ewa/volume_render.h"
#include "homogeneous/vec.h"

/// Beyond so many units a voxel is not drawn: it is far below any pixel, and squares stay within floats.
#define EWA_FARTHEST 1e17

/// Camera-space form of a grid, in units of its own: the shortest spacing of the volume, so that neither the
/// world's scale nor the camera's matters to any number that is squared.
typedef struct ewa_grid_view {
    bool orthographic;
    double fx_px, fy_px, cx_px, cy_px; ///< orthographic: pixels per unit
    double unit_camera;                ///< a unit in camera space, as depth planes have it
    double scale;                      ///< camera space over world: the length of world_to_camera's rows
    ewa_mat3 axes;                     ///< rows: steps along i, j, k in camera space
    ewa_vec3 origin;                   ///< voxel 0, 0, 0 in camera space
    ewa_mat3 covariance;               ///< Sigma of every voxel
    ewa_mat3 inverse;                  ///< Sigma^-1
    ewa_mat3 to_steps;                 ///< row vectors of camera space to steps along i, j, k
    ewa_vec3 eye_steps;                ///< perspective: the index at which the eye is
    double kernel_steps;               ///< standard deviation of a voxel in steps of the grid
    double bend; ///< orthographic: how fast the order within a depth unit falls off the axis, 1 / length
    double depth_sigma;   ///< sqrt(Sigma33)
    double mean_variance; ///< a third of Sigma's trace
    double longest_step;
    double near;            ///< perspective: how far a voxel's kernel reaches along the axis; 0: orthographic
    double cutoff, cutoff2; ///< F, F^2
    double prefilter2_px2;  ///< h^2
    double whole;           ///< 1 / (1 - exp(-F^2 / 2)): makes up for what the cutoff leaves out
    double point_mass;      ///< integral over the screen, px^2, of a voxel's optical depth per extinction:
                            ///< orthographic; perspective: times |p| / pz^3
    double splat_peak;      ///< optical depth through a voxel's middle per extinction, times
                            ///< sqrt(p Sigma^-1 p) / |p| (orthographic: p = 0 0 1)
} ewa_grid_view;

/// `index_to_world` of the grid is invertible, camera and options are checked; `spacing_world` is the unit.
void ewa_grid_view_make(ewa_grid_view *view, const double index_to_world[12], double spacing_world,
                        const ewa_camera *camera, const ewa_volume_options *options);

/// What splats of one depth unit are sorted by: the distance from the eye. By depth alone, whole layers of
/// voxels that overlap would change places at once whenever a diagonal of the grid turns through the
/// picture's plane; so they do it one after another, each when its own ray is there. For an orthographic
/// camera the distance is that from an eye which would see the picture under 40 degrees, but for its fourth
/// order.
static inline double ewa_grid_distance(const ewa_grid_view *view, ewa_vec3 p) {
    return view->orthographic ? p.z + view->bend * (p.x * p.x + p.y * p.y) : vec3_length(p);
}

/// Camera space of an index.
static inline ewa_vec3 ewa_grid_place(const ewa_grid_view *view, double i, double j, double k) {
    return vec3_add(view->origin, vec3_mul_mat3(vec3_make(i, j, k), &view->axes));
}

#endif
