// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians on the screen in double precision: from a covariance in camera space to the exact ellipse of its
// support (docs/math.md section 3).
#ifndef EWA_SRC_MATH_ELLIPSE_H
#define EWA_SRC_MATH_ELLIPSE_H

/// wide_project() in double precision: the dual conic F^2 Sigma - p'p, sheared, without cancellation.
static inline void ewa_ellipse_project(const double s[5], double k, double cutoff2, double variance[3],
                                       double shift[2]) {
    const double x = k * cutoff2 * s[3], y = k * cutoff2 * s[4];
    shift[0] = -x, shift[1] = -y;
    variance[0] = k * (s[0] + x * s[3]);
    variance[1] = k * (s[1] + x * s[4]);
    variance[2] = k * (s[2] + y * s[4]);
}

#endif
