// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Options that came from outside: defaults for NULL, checked, copied.
#ifndef EWA_SRC_SPLAT_OPTIONS_H
#define EWA_SRC_SPLAT_OPTIONS_H

#include "ewa/render.h"

/// Copies `given` (NULL: the defaults) to `chosen` after checking every member.
/// Errors: EWA_ERROR_ARGUMENT with a message that names the member, its value and its range.
ewa_status ewa_surfels_options_choose(ewa_context *context, const ewa_surfels_options *given,
                                      ewa_surfels_options *chosen);

/// The same for a picture's options.
ewa_status ewa_render_options_choose(ewa_context *context, const ewa_render_options *given,
                                     ewa_render_options *chosen);

/// Fails unless low <= value <= high (or low < value, when `open`); a NaN is never within.
/// Errors: EWA_ERROR_ARGUMENT, as those below.
ewa_status ewa_option_check_range(ewa_context *context, const char *member, double value, double low,
                                  bool open, double high);

/// Fails unless `value` is one of an enumeration that starts at 0.
ewa_status ewa_option_check_choice(ewa_context *context, const char *member, int value, int last);

/// Fails unless a struct says that it has the size that it should have.
ewa_status ewa_option_check_size(ewa_context *context, const char *type, size_t given, size_t wanted);

/// Fails for lights that are too many, not finite or too bright.
ewa_status ewa_option_check_lights(ewa_context *context, const ewa_light *lights, uint32_t light_count);

/// Fails for a background that is no straight colour.
ewa_status ewa_option_check_background(ewa_context *context, const float background[4]);

#endif
