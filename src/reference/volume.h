// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What ewa_volume_render() is held to.
#ifndef EWA_SRC_REFERENCE_VOLUME_H
#define EWA_SRC_REFERENCE_VOLUME_H

#include "ewa/volume_render.h"

/// All voxels as splats in double precision, one after another, straight from the volume: slow, plain, and
/// the definition of what ewa_volume_render() draws. Method, level and minimum_transmittance of the options
/// are not looked at. Errors: as ewa_voxels_create() and ewa_volume_render().
ewa_status ewa_volume_render_reference(const ewa_volume *volume, const ewa_transfer *transfer,
                                       const ewa_camera *camera, const ewa_volume_options *options,
                                       const ewa_frame *frame);

#endif
