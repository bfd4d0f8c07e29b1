// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Decimal numbers for scales. Powers of ten by multiplication: those of libm are not the same everywhere.
#include "furniture/decimal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// Exponents from here on, and numbers of places behind the point up to there, are written out.
enum { MAX_PLACES = 6, MAX_ZEROS = 6, MAX_WHOLE_DIGITS = 12 };

/// Multiples of a step up to here are exact, with digits to spare for the rounding of the ends.
static const double MAX_MULTIPLE = 1e14;
static const double MIN_NICE = 1e-290;
/// Numbers from here on are rounded rather than written with a power of ten.
static const double MIN_PLAIN = 0.01;
/// Shares of a step by which an end may miss a tick, and of a multiple of it, for rounding.
static const double TICK_SLACK = 1e-9, MULTIPLE_SLACK = 1e-15;

/// value * 10^exponent; powers up to 10^22 are exact, and dividing by them is more so than multiplying by inverses.
static double scale10(double value, int exponent) {
    for (; exponent > 22; exponent -= 22) value *= 1e22;
    for (; exponent < -22; exponent += 22) value /= 1e22;
    double power = 1;
    for (int i = exponent < 0 ? -exponent : exponent; i > 0; i--) power *= 10;
    return exponent < 0 ? value / power : value * power;
}

/// The e with 10^e <= value < 10^(e + 1), for a positive finite value, but for rounding.
static int find_exponent(double value) {
    int binary;
    frexp(value, &binary);
    int exponent = (int)floor((binary - 1) * 0.30102999566398120);
    while (scale10(value, -exponent) >= 10) exponent++;
    while (scale10(value, -exponent) < 1) exponent--;
    return exponent;
}

double ewa_decimal_value(ewa_decimal number) { return scale10((double)number.digits, number.exponent); }

void ewa_decimal_write(ewa_decimal number, char text[EWA_DECIMAL_BYTES]) {
    char digits[24];
    const char *sign = number.digits < 0 ? "-" : "";
    const uint64_t size = number.digits < 0 ? 0 - (uint64_t)number.digits : (uint64_t)number.digits;
    const int length = snprintf(digits, sizeof digits, "%" PRIu64, size), exponent = number.exponent;
    const bool whole = exponent >= 0 && exponent <= MAX_ZEROS && length + exponent <= MAX_WHOLE_DIGITS;
    if (size == 0 && exponent >= 0) {
        snprintf(text, EWA_DECIMAL_BYTES, "0");
    } else if (whole) {
        snprintf(text, EWA_DECIMAL_BYTES, "%s%s%.*s", sign, digits, exponent, "000000");
    } else if (exponent < 0 && exponent >= -MAX_PLACES) {
        const int places = -exponent, lead = length > places ? length - places : 0;
        snprintf(text, EWA_DECIMAL_BYTES, "%s%.*s.%.*s%s", sign, lead ? lead : 1, lead ? digits : "0",
                 lead ? 0 : places - length, "000000", digits + lead);
    } else if (size == 0) {
        snprintf(text, EWA_DECIMAL_BYTES, "0");
    } else {
        int last = length;
        while (last > 1 && digits[last - 1] == '0') last--;
        snprintf(text, EWA_DECIMAL_BYTES, "%s%c%s%.*se%d", sign, digits[0], last > 1 ? "." : "", last - 1,
                 digits + 1, exponent + length - 1);
    }
}

ewa_decimal ewa_decimal_near(double value) {
    ewa_decimal number = {0, 0};
    if (value == 0) return number;
    const double size = fabs(value);
    const int exponent = find_exponent(size);
    for (int places = 0; places <= 9; places++) {
        number.exponent = exponent - places;
        number.digits = (int64_t)floor(scale10(size, -number.exponent) + 0.5);
        const bool enough = size >= MIN_PLAIN && number.exponent == -MAX_PLACES;
        if (enough || fabs(ewa_decimal_value(number) - size) <= 0x1p-24 * size) break;
    }
    // 9.9999999e5 rounds up to 10e5.
    for (; number.digits % 10 == 0; number.exponent++) number.digits /= 10;
    // Whole numbers that can be written out are, with what they end in.
    for (; number.exponent > 0 && number.exponent <= MAX_ZEROS; number.exponent--) number.digits *= 10;
    if (value < 0) number.digits = -number.digits;
    return number;
}

bool ewa_decimal_nice(double maximum, ewa_decimal *nice) {
    if (!(maximum >= MIN_NICE) || isinf(maximum)) return false;
    const int exponent = find_exponent(maximum);
    const double lead = scale10(maximum, -exponent);
    *nice = (ewa_decimal){lead >= 5 ? 5 : lead >= 2 ? 2 : 1, exponent};
    return true;
}

bool ewa_ticks_find(double low, double high, uint32_t maximum, ewa_ticks *ticks) {
    if (!isfinite(low) || !isfinite(high) || !(low < high) || maximum < 1) return false;
    ewa_decimal step;
    const double minimum = high / maximum - low / maximum; // the difference alone might be infinite
    if (!ewa_decimal_nice(minimum * (1 - TICK_SLACK), &step)) return false;
    // The next one up.
    step = step.digits == 1   ? (ewa_decimal){2, step.exponent}
           : step.digits == 2 ? (ewa_decimal){5, step.exponent}
                              : (ewa_decimal){1, step.exponent + 1};
    const double first = scale10(low, -step.exponent) / (double)step.digits;
    const double last = scale10(high, -step.exponent) / (double)step.digits;
    if (!(fabs(first) <= MAX_MULTIPLE && fabs(last) <= MAX_MULTIPLE)) return false;
    *ticks = (ewa_ticks){step, (int64_t)ceil(first - TICK_SLACK - MULTIPLE_SLACK * fabs(first)),
                         (int64_t)floor(last + TICK_SLACK + MULTIPLE_SLACK * fabs(last))};
    return ticks->first <= ticks->last;
}

ewa_decimal ewa_ticks_at(const ewa_ticks *ticks, int64_t index) {
    return (ewa_decimal){ticks->step.digits * index, ticks->step.exponent};
}
