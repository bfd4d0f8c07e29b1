// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Coordinates that are decimals of a few places.
#include "cloud/decimals.h"

#include <math.h>

static const double MAX_PARTS = 1e6, EXACT = 0x1p53;

/// Whether a number is the double nearest to a decimal with that many parts of one.
static bool is_decimal(double number, double parts) {
    const double whole = nearbyint(number * parts);
    return fabs(whole) < EXACT && whole / parts == number;
}

double ewa_decimals_find(const double *numbers, uint64_t count, uint32_t stride) {
    double parts = 1;
    for (uint64_t i = 0; i < count; i++) {
        const double number = numbers[i * stride];
        if (!isfinite(number)) continue;
        while (!is_decimal(number, parts)) {
            parts *= 10;
            if (parts > MAX_PARTS) return 0;
        }
    }
    return parts;
}

double ewa_decimals_subtract(double number, double other, double parts) {
    const double difference = nearbyint(number * parts) - nearbyint(other * parts);
    return parts > 0 && isfinite(difference) ? difference / parts : number - other;
}
