// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Proxy sources: surfels that take part in what the sources of a frame agree on (scales, unit coverage) but
// draw nothing. They replace a source where it is not visible, so that it need not be in memory.
#ifndef EWA_SRC_SURFACE_PROXY_H
#define EWA_SRC_SURFACE_PROXY_H

#include "ewa/render.h"

/// Makes a copy without packets, of some hundred bytes for each level of detail. In a frame it has the effect that
/// its original has on the pixels of other sources; the frame's pixels that the original does not touch are the
/// same bytes with either. To be destroyed as any surfels. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_surfels_proxy(const ewa_surfels *surfels, ewa_surfels **proxy);

/// Sets the unit coverage q0, which ewa_surfels_create() estimates, of all levels of detail: finite, > 0. Parts of
/// one surface are to have the same. Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_surfels_set_unit_coverage(ewa_surfels *surfels, double unit_coverage);

/// Measures q0 (docs/math.md section 7) of a cloud as ewa_surfels_create() does, whose errors it has. `options` may be NULL.
ewa_status ewa_surfels_measure_unit_coverage(const ewa_cloud *cloud, const ewa_surfels_options *options,
                                             double *unit_coverage);

#endif
