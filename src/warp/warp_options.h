// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Checked options and images of warping.
#ifndef EWA_SRC_WARP_OPTIONS_H
#define EWA_SRC_WARP_OPTIONS_H

#include "ewa/warp.h"

/// Copies `given` or the defaults (NULL) into `chosen`. Errors: EWA_ERROR_ARGUMENT with the member.
ewa_status ewa_warp_options_choose(ewa_context *context, const ewa_warp_options *given,
                                   ewa_warp_options *chosen);

/// Checks one image; `number` counts from 0 in messages. Fills in strides of 0. Errors: EWA_ERROR_ARGUMENT,
/// EWA_ERROR_UNSUPPORTED.
ewa_status ewa_depth_image_choose(ewa_context *context, uint32_t number, const ewa_depth_image *given,
                                  ewa_depth_image *chosen);

#endif
