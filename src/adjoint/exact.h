// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sums of doubles that no order of their terms changes: whole numbers for each range of exponents.
//
// Based on: U. Kulisch, "Computer Arithmetic and Validity", 2008 (long accumulators).
#ifndef EWA_SRC_ADJOINT_EXACT_H
#define EWA_SRC_ADJOINT_EXACT_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum {
    EWA_EXACT_STEP = 8, ///< binary digits from one part to the next; a part has room for 2^29 terms
    EWA_EXACT_BIAS = 1136,
    EWA_EXACT_PARTS = (1024 + EWA_EXACT_BIAS) / EWA_EXACT_STEP + 2,
};

/// A sum; starts with zeros.
typedef struct ewa_exact_sum {
    int64_t parts[EWA_EXACT_PARTS]; ///< times 2^(EWA_EXACT_STEP i - EWA_EXACT_BIAS)
    bool not_finite; ///< some term was infinite or no number: the sum is no number
} ewa_exact_sum;

/// Adds whole x 2^exponent.
static inline void ewa_exact_add_whole(ewa_exact_sum *sum, int64_t whole, int exponent) {
    const int place = exponent + EWA_EXACT_BIAS;
    sum->parts[place / EWA_EXACT_STEP] += whole * (1 << place % EWA_EXACT_STEP);
}

/// Adds a number, exactly if it is finite.
static inline void ewa_exact_add(ewa_exact_sum *sum, double value) {
    enum { HALF = 26, DIGITS = 52, SCALE = 1075 };
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const int exponent = (int)(bits >> DIGITS & 0x7ff);
    if (exponent == 0x7ff) {
        sum->not_finite = true;
        return;
    }
    const uint64_t digits = bits & ((UINT64_C(1) << DIGITS) - 1), whole = exponent ? digits | UINT64_C(1) << DIGITS : digits;
    const int64_t high = (int64_t)(whole >> HALF), low = (int64_t)(whole & ((1 << HALF) - 1));
    const int last = (exponent ? exponent : 1) - SCALE; // of the last digit
    ewa_exact_add_whole(sum, bits >> 63 ? -low : low, last);
    ewa_exact_add_whole(sum, bits >> 63 ? -high : high, last + HALF);
}

static inline void ewa_exact_join(ewa_exact_sum *sum, const ewa_exact_sum *more) {
    for (int i = 0; i < EWA_EXACT_PARTS; i++) sum->parts[i] += more->parts[i];
    sum->not_finite |= more->not_finite;
}

/// The sum times `sign`, or a negative number if that is negative. All parts but the last become [0, 2^EWA_EXACT_STEP).
static inline double ewa_exact_value_of(const ewa_exact_sum *sum, int64_t sign) {
    int64_t parts[EWA_EXACT_PARTS], carry = 0;
    const int64_t base = 1 << EWA_EXACT_STEP;
    for (int i = 0; i < EWA_EXACT_PARTS; i++) {
        const int64_t whole = sign * sum->parts[i] + carry, rest = (whole % base + base) % base;
        parts[i] = rest;
        carry = (whole - rest) / base;
    }
    if (carry < 0) return -1;
    double value = 0;
    for (int i = EWA_EXACT_PARTS; i-- > 0;)
        if (parts[i]) value += ldexp((double)parts[i], EWA_EXACT_STEP * i - EWA_EXACT_BIAS);
    return value;
}

/// Returns the sum, rounded a few times at its last digit.
static inline double ewa_exact_value(const ewa_exact_sum *sum) {
    if (sum->not_finite) return NAN;
    const double value = ewa_exact_value_of(sum, 1);
    return value < 0 ? -ewa_exact_value_of(sum, -1) : value;
}

#endif
