// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Borders of discs (ewa/cloud.h, "border") as clip lines.
#ifndef EWA_SRC_CLOUD_BORDER_H
#define EWA_SRC_CLOUD_BORDER_H

/// Surfaceness (ewa/cloud.h) below which a point faces the viewer, and has no border.
#define EWA_SURFACE_LIMIT 0.5

/// Sets the clip line (a, b, c), which keeps a u + b v + c >= 0, of a disc with these axes that ends at the plane
/// to.x = to.to through `to`, which is relative to its centre; no line where that is zero.
static inline void ewa_border_line(const double to[3], const double axis_u[3], const double axis_v[3],
                                   double line[3]) {
    line[0] = line[1] = line[2] = 0;
    for (int c = 0; c < 3; c++) line[0] -= to[c] * axis_u[c], line[1] -= to[c] * axis_v[c], line[2] += to[c] * to[c];
}

#endif
