// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Axes across a normal.
//
// Based on: T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
#ifndef EWA_SRC_HOMOGENEOUS_FRAME_H
#define EWA_SRC_HOMOGENEOUS_FRAME_H

#include "homogeneous/vec.h"

/// Two unit vectors with axis[0] x axis[1] = n, which is of unit length.
static inline void ewa_frame_of(ewa_vec3 n, ewa_vec3 axis[2]) {
    const double sign = copysign(1, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    axis[0] = vec3_make(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    axis[1] = vec3_make(b, sign + n.y * n.y * a, -n.y);
}

#endif
