// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options that came from outside: defaults for NULL, checked, copied.
#ifndef EWA_SRC_SURFACE_OPTIONS_H
#define EWA_SRC_SURFACE_OPTIONS_H

#include "ewa/render.h"

/// Copies `given` (NULL: the defaults) to `chosen` after checking every member.
/// Errors: EWA_ERROR_ARGUMENT with a message that names the member, its value and its range.
ewa_status ewa_surfels_options_choose(ewa_context *context, const ewa_surfels_options *given,
                                      ewa_surfels_options *chosen);

/// The same for a picture's options.
ewa_status ewa_render_options_choose(ewa_context *context, const ewa_render_options *given,
                                     ewa_render_options *chosen);

/// Fails for lights that are not finite or too bright. Errors: EWA_ERROR_ARGUMENT, as those below.
ewa_status ewa_option_check_lights(ewa_context *context, const ewa_light *lights, uint32_t light_count);

/// Fails for a background whose alpha is above 1.
ewa_status ewa_option_check_background(ewa_context *context, const float background[4]);

/// Fails for section planes that are not finite or have no normal.
ewa_status ewa_option_check_sections(ewa_context *context, const double planes[][4], uint32_t count);

#endif
