// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Splats at contours, in double precision (docs/math.md section 5, contours).
#ifndef EWA_SRC_REFERENCE_CONTOUR_H
#define EWA_SRC_REFERENCE_CONTOUR_H

#include "reference/splat.h"

/// Sets the members of a made view that contours need: c, S, and whether some surfaces let light through.
void ewa_reference_view_contours(const ewa_render_options *options, bool transparent, ewa_reference_view *view);

/// Moves the projected splat of a surfel away from its contour; sets `moved_px` and `concave`. Any thread.
void ewa_reference_move(const ewa_reference_view *view, const ewa_surfel *surfel, ewa_reference_splat *splat);

#endif
