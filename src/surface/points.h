// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What becomes of surfels when each point is a disc of the same size on the screen (semantics.h, points).
#ifndef EWA_SRC_SURFACE_POINTS_H
#define EWA_SRC_SURFACE_POINTS_H

#include "ewa/render.h"

/// The kernel of every point.
typedef struct ewa_point_profile {
    double sigma_px;
    double cutoff;        ///< F
    double unit_coverage; ///< q0
} ewa_point_profile;

/// Returns the profile for checked options with point_size_px > 0.
ewa_point_profile ewa_point_profile_make(const ewa_render_options *options);

#endif
