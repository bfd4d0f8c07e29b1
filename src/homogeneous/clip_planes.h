// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The six planes of clip space, in the order of ewa_clip_plane, pointing inwards for positive w. The
// incidence product with a point is its boundary coordinate: one sum or difference of two numbers, exact but
// for that rounding.
#ifndef EWA_SRC_HOMOGENEOUS_CLIP_PLANES_H
#define EWA_SRC_HOMOGENEOUS_CLIP_PLANES_H

#include "homogeneous/vec.h"

static const ewa_vec4 clip_planes[6] = {
    [EWA_CLIP_LEFT] = {1, 0, 0, 1}, [EWA_CLIP_RIGHT] = {-1, 0, 0, 1}, [EWA_CLIP_BOTTOM] = {0, 1, 0, 1},
    [EWA_CLIP_TOP] = {0, -1, 0, 1}, [EWA_CLIP_NEAR] = {0, 0, 1, 0},   [EWA_CLIP_FAR] = {0, 0, -1, 1},
};

static inline double boundary_coordinate(ewa_vec4 point, int plane) {
    return vec4_dot(point, clip_planes[plane]);
}

#endif
