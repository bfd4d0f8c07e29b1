// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ewa_render() is held to.
#ifndef EWA_SRC_REFERENCE_SURFACE_H
#define EWA_SRC_REFERENCE_SURFACE_H

#include "ewa/render.h"

/// The same picture in double precision, one splat after another, straight from the cloud: slow, plain, and
/// the definition of what ewa_render() draws. `unit_coverage` is q0, as ewa_surfels_describe() gives it.
ewa_status ewa_render_reference(const ewa_cloud *cloud, const ewa_surfels_options *surfels_options,
                                double unit_coverage, const ewa_camera *camera,
                                const ewa_render_options *options, const ewa_frame *frame);

#endif
