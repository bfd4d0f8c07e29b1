// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options of volumes that came from outside: defaults for NULL, checked, copied.
#ifndef EWA_SRC_VOLUME_OPTIONS_H
#define EWA_SRC_VOLUME_OPTIONS_H

#include "ewa/volume_render.h"
#include "surface/shading.h"
#include "volume/kernels.h"

/// Copies `given` (NULL: the defaults) to `chosen` after checking every member.
/// Errors: EWA_ERROR_ARGUMENT with a message that names the member, its value and its range.
ewa_status ewa_voxels_options_choose(ewa_context *context, const ewa_voxels_options *given,
                                     ewa_voxels_options *chosen);

/// The same for a picture's options.
ewa_status ewa_volume_options_choose(ewa_context *context, const ewa_volume_options *given,
                                     ewa_volume_options *chosen);

/// Fails for planes of surfaces that lack others: depth and rgba without each other, the rest without these.
/// Errors: EWA_ERROR_ARGUMENT.
ewa_status ewa_surface_planes_check(ewa_context *context, const ewa_surface_planes *planes);

/// Lights and the one material of checked options.
void ewa_volume_shading_make(const ewa_volume_options *options, ewa_shading_setup *setup);

#endif
