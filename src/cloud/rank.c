// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Numbers by their rank: medians, percentiles.
#include "ewa/select.h"

#include <stdint.h>
#include <string.h>

/// Integers in the order of the numbers.
static uint64_t ordered_bits(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits >> 63 ? ~bits : bits | (uint64_t)1 << 63;
}

// Digit by digit from the top, only what shares the digits so far stays. Linear whatever the numbers.
double ewa_rank_select(double *numbers, size_t count, size_t rank) {
    enum { DIGIT_BITS = 11, BUCKETS = 1 << DIGIT_BITS };
    for (int shift = 64; count > 1 && shift > 0;) {
        const int low = shift > DIGIT_BITS ? shift - DIGIT_BITS : 0;
        size_t sizes[BUCKETS] = {0};
        for (size_t i = 0; i < count; i++) sizes[ordered_bits(numbers[i]) >> low & (BUCKETS - 1)]++;
        size_t bucket = 0;
        for (; rank >= sizes[bucket]; bucket++) rank -= sizes[bucket];
        size_t kept = 0;
        for (size_t i = 0; i < count; i++)
            if ((ordered_bits(numbers[i]) >> low & (BUCKETS - 1)) == bucket) numbers[kept++] = numbers[i];
        count = kept;
        shift = low;
    }
    return numbers[0];
}
