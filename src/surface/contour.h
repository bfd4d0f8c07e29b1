// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How far splats at contours move (semantics.h, contours).
#ifndef EWA_SRC_SURFACE_CONTOUR_H
#define EWA_SRC_SURFACE_CONTOUR_H

#include "ewa/render.h"

/// Returns c, the way of a splat at its contour over its size across it, by checked options for a camera that is
/// orthographic or not. 0: splats stay where they are.
double ewa_contour_shift(const ewa_render_options *options, bool orthographic);

/// Returns S, the square of the sine between plane and ray from which on no splat moves.
double ewa_contour_sine2(double cutoff, double shift);

#endif
