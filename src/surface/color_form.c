// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Forms of colour codes.
//
// A set of one even step loses dark colours beside bright ones; plain half floats lose the even steps that
// ordinary colours have. The float of 1 + v, whose bits grow with v without a break, has both: even steps
// below 1, relative ones above. How many octaves it spans is all that a packet has to say.
#include "surface/color_form.h"
#include "surface/packet.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/// Largest relative error of a colour's number.
static const double PRECISION = 0x1p-11;

/// Of a unit: a step of it is a normal float.
enum { MIN_EXPONENT = -110 };

static uint32_t exponent_bits(uint16_t form) { return form >> 8 & 15; }
static bool is_signed(uint16_t form) { return form & EWA_COLOR_SIGN; }
static double unit_of(uint16_t form) { return ldexp(1, (form & 255) - 128); }

/// Whether codes are even steps that include 1.
static bool is_even(uint16_t form) { return !is_signed(form) && exponent_bits(form) == 0; }

/// Bits behind the point of a code, which counts octaves of 1 + v.
static int mantissa_bits(uint16_t form) { return (is_signed(form) ? 15 : 16) - (int)exponent_bits(form); }

static uint32_t largest_code(uint16_t form) { return is_signed(form) ? 0x7fff : 0xffff; }

double ewa_color_decode_code(uint16_t form, uint16_t code) {
    if (is_even(form)) return code * unit_of(form) / 65535;
    const double octaves = ldexp(code & largest_code(form), -mantissa_bits(form)), whole = floor(octaves);
    const double value = unit_of(form) * (ldexp(1 + (octaves - whole), (int)whole) - 1);
    return is_signed(form) && code & EWA_COLOR_SIGN ? -value : value;
}

double ewa_color_form_limit(uint16_t form) {
    return is_even(form) ? unit_of(form) : unit_of(form) * ldexp(1, 1 << exponent_bits(form));
}

bool ewa_color_form_is_even(uint16_t form) { return is_even(form); }

/// A form with the smallest unit whose largest code reaches `high` > 0.
static uint16_t form_for(double high, uint32_t bits, bool with_sign) {
    const uint16_t plain = (uint16_t)(bits << 8 | (with_sign ? EWA_COLOR_SIGN : 0) | EWA_COLOR_FORM_UNIT);
    const double reach = ewa_color_decode_code(plain, (uint16_t)largest_code(plain));
    int exponent = 0;
    const double part = frexp(high / reach, &exponent); // high / reach = part 2^exponent, part in [1/2, 1)
    if (part == 0.5) exponent--;
    exponent = exponent < MIN_EXPONENT ? MIN_EXPONENT : exponent;
    return (uint16_t)((plain & ~255) | (exponent + 128));
}

/// |number|, at most the limit; 0 for NaN.
static inline double size_of(double number) {
    const double size = fabs(number);
    return size > 0 ? (size < EWA_COLOR_LIMIT ? size : EWA_COLOR_LIMIT) : 0;
}

uint16_t ewa_color_form_choose(const double (*colors_linear)[3], uint32_t count) {
    double low = EWA_COLOR_LIMIT, high = 0;
    bool with_sign = false;
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const double size = size_of(colors_linear[i][c]);
            low = size > 0 && size < low ? size : low;
            high = size > high ? size : high;
            with_sign |= colors_linear[i][c] < 0;
        }
    if (high == 0) return EWA_COLOR_FORM_UNIT;
    uint16_t form = 0;
    for (uint32_t bits = 0; bits <= EWA_COLOR_EXPONENT_BITS; bits++) {
        form = form_for(high, bits, with_sign);
        // Half of the step at zero, which is no larger at `low` as long as that is below the unit.
        const double error = 0.5 * ewa_color_decode_code(form, 1);
        if (error <= PRECISION * low) break;
    }
    return form;
}

/// The code of a number >= 0 in units of the form that are no even steps: bits of the double 1 + size.
static uint32_t code_octaves(double size, int shift) {
    const double shifted = 1 + size, one = 1;
    uint64_t bits, bits_of_one;
    memcpy(&bits, &shifted, sizeof bits);
    memcpy(&bits_of_one, &one, sizeof bits_of_one);
    return (uint32_t)((bits - bits_of_one + (UINT64_C(1) << (shift - 1))) >> shift);
}

void ewa_color_encode(uint16_t form, const double (*colors_linear)[3], uint32_t count,
                      uint16_t *const channels[3]) {
    enum { DOUBLE_BITS = 52 };
    const double per_unit = 1 / unit_of(form);
    const uint32_t maximum = largest_code(form);
    const int shift = DOUBLE_BITS - mantissa_bits(form);
    const bool even = is_even(form);
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const double number = colors_linear[i][c], size = size_of(number) * per_unit;
            uint32_t code = even ? ewa_color_unit_code(size < 1 ? size : 1) : code_octaves(size, shift);
            code = code < maximum ? code : maximum;
            if (number < 0) code = is_signed(form) ? code | EWA_COLOR_SIGN : 0;
            channels[c][i] = (uint16_t)code;
        }
}
