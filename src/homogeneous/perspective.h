// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The planes of a view volume.
#ifndef EWA_SRC_HOMOGENEOUS_PERSPECTIVE_H
#define EWA_SRC_HOMOGENEOUS_PERSPECTIVE_H

#include "ewa/homogeneous.h"

/// Gives the planes of the view volume in the space that `map` takes to clip space, in the order of
/// ewa_clip_plane: the clip planes pulled back, sums and differences of the map's columns. (a, b, c) has
/// length 1 and points inwards, so that the incidence product with [x y z 1] is the signed distance; a plane
/// at infinity is (0, 0, 0, 1 or -1). Errors: EWA_ERROR_NUMERIC when a plane vanishes.
ewa_status ewa_frustum_planes(const ewa_mat4 *map, ewa_vec4 planes[6]);

#endif
