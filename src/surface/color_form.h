// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen bits for a colour's number, of a form that each packet chooses for its own colours
// (src/surface/packet.h).
#ifndef EWA_SRC_SURFACE_COLOR_FORM_H
#define EWA_SRC_SURFACE_COLOR_FORM_H

#include "cloud/color.h"

#include <stdint.h>

enum {
    EWA_COLOR_FORM_UNIT = 128,   ///< [0, 1] in 65535 even steps: what 8-bit colours have
    EWA_COLOR_EXPONENT_BITS = 5, ///< the largest k
};

/// The code of a number of [0, 1] in EWA_COLOR_FORM_UNIT.
static inline uint16_t ewa_color_unit_code(double light) { return (uint16_t)(light * 65535 + 0.5); }

/// Chooses the form for `count` colours, linear light of any sign up to EWA_COLOR_LIMIT: the one with the
/// finest steps at the largest number among those that keep the smallest number but zero within 2^-11 of
/// itself, if that is above 2^-32 of the largest. Any thread.
uint16_t ewa_color_form_choose(const double (*colors_linear)[3], uint32_t count);

/// Codes `count` colours, 1 to 16, in a form that was chosen for them; `channels` are the codes of red, green
/// and blue.
void ewa_color_encode(uint16_t form, const double (*colors_linear)[3], uint32_t count,
                      uint16_t *const channels[3]);

/// A power of two that no number in the form is beyond; up to that of the largest there is.
double ewa_color_form_limit(uint16_t form);

/// Whether codes of the form are even steps from 0 on.
bool ewa_color_form_is_even(uint16_t form);

/// The number that a code stands for, as the kernels have it but in double precision.
double ewa_color_decode_code(uint16_t form, uint16_t code);

#endif
