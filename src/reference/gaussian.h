// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ewa_gaussian_render() is held to.
#ifndef EWA_SRC_REFERENCE_GAUSSIAN_H
#define EWA_SRC_REFERENCE_GAUSSIAN_H

#include "ewa/gaussian_render.h"

/// All Gaussians in double precision, pixel by pixel, straight from the set: slow, plain, and the definition
/// of what ewa_gaussian_render() draws. minimum_transmittance of the options is not looked at. Errors: as
/// ewa_gaussian_render().
ewa_status ewa_gaussian_render_reference(const ewa_gaussians *gaussians, const ewa_camera *camera,
                                         const ewa_gaussian_options *options, const ewa_frame *frame);

#endif
