// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians on the screen over the wide type: from a covariance in camera space to the exact ellipse of its
// support (docs/math.md section 3), and from a filtered variance to its conic (section 4). ellipse.h is the
// same in double precision.
//
// Based on: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004, section 4.
#ifndef EWA_SRC_WIDE_WIDE_ELLIPSE_H
#define EWA_SRC_WIDE_WIDE_ELLIPSE_H

#include "wide/wide.h"

/// `s` is the covariance sheared so that the Gaussian's centre lies on the axis: 11, 12, 22, 13, 23; `k` is
/// 1 / (z^2 - F^2 s33) > 0. Sets the variance (xx, xy, yy) of the ellipse, and its centre minus the
/// projected one.
static ALWAYS_INLINE void wide_project(const wf s[5], wf k, wf cutoff2, wf variance[3], wf shift[2]) {
    const wf far = wf_mul(cutoff2, k), x = wf_mul(far, s[3]), y = wf_mul(far, s[4]);
    shift[0] = wf_sub(wf_set(0), x);
    shift[1] = wf_sub(wf_set(0), y);
    variance[0] = wf_mul(k, wf_fma(x, s[3], s[0]));
    variance[1] = wf_mul(k, wf_fma(x, s[4], s[1]));
    variance[2] = wf_mul(k, wf_fma(y, s[4], s[2]));
}

/// Sets the conic of a variance: q = xx dx^2 + xy dx dy + yy dy^2 is |W| scale times the squared Mahalanobis
/// distance.
static ALWAYS_INLINE void wide_conic(wf w11, wf w12, wf w22, wf scale, wf conic[3]) {
    conic[0] = wf_mul(w22, scale);
    conic[1] = wf_mul(wf_mul(w12, wf_set(-2)), scale);
    conic[2] = wf_mul(w11, scale);
}

#endif
