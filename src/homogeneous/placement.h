// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where a camera sees points that lie far from the world's origin, from each other, or from the eye.
//
// world_to_camera takes the world's origin to the camera: p = A w + t. Evaluated as it stands this loses what
// w and t have in common. Here the same map is taken about an anchor near both the eye and the points, whose
// image is computed once with twice the digits: what is left is small where the points are near.
#ifndef EWA_SRC_HOMOGENEOUS_PLACEMENT_H
#define EWA_SRC_HOMOGENEOUS_PLACEMENT_H

#include "ewa/camera.h"
#include "ewa/homogeneous.h"

/// p = linear (w - anchor) + offset, for points w from an origin of their own, in camera space whose unit is
/// `unit` of the camera's: a power of two, so that nothing is rounded by it.
typedef struct ewa_placement {
    ewa_mat3 linear; ///< acts on columns, as world_to_camera does
    ewa_vec3 anchor; ///< the eye, or the point of the box nearest to it
    ewa_vec3 offset;
    double unit;
} ewa_placement;

/// Places a checked camera before points within `box`, both relative to `origin_world`. The unit is near the
/// distance of the box from the eye, and no less than `size_world`, a length in the world. Without a box
/// (NULL, or an empty one) the anchor is the eye and the unit 1. Total; any thread.
ewa_placement ewa_placement_make(const ewa_camera *camera, const double origin_world[3],
                                 const ewa_bounds *box, double size_world);

/// Returns where a point is in camera space.
ewa_vec3 ewa_placement_apply(const ewa_placement *placement, ewa_vec3 point);

/// Writes a plane a x + b y + c z + d of the world, finite and with a normal, as it is for points from
/// `origin_world`: its normal of unit length, and its distance from the origin, computed with twice the
/// digits. Total; any thread.
void ewa_placement_plane(const double plane_world[4], const double origin_world[3], double plane[4]);

#endif
