// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h (docs/math.md section 15): eight lanes of double. Sums, products and quotients are rounded one by one, never fused, so that
// lanes are the numbers that scalar code gets, whatever the instruction set.
#ifndef EWA_SRC_ADJOINT_EIGHT_H
#define EWA_SRC_ADJOINT_EIGHT_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#if defined(WIDE_AVX512) || defined(WIDE_AVX2)
#include <immintrin.h>
#endif

#if defined(WIDE_AVX512)
enum { PART_LANES = 8 };
#elif defined(WIDE_AVX2)
enum { PART_LANES = 4 };
#else
enum { PART_LANES = 2 };
#endif
enum { LANES = 8, PARTS = LANES / PART_LANES };

typedef double d_part __attribute__((vector_size(PART_LANES * sizeof(double))));
typedef int64_t m_part __attribute__((vector_size(PART_LANES * sizeof(int64_t))));
/// One anywhere in memory. Copies by memcpy() go by sixteen bytes, for which wider reads of them have to wait.
typedef double stored_part __attribute__((vector_size(PART_LANES * sizeof(double)), aligned(sizeof(double))));

typedef struct d8 {
    d_part part[PARTS];
} d8;

/// All bits of a lane, or none.
typedef struct m8 {
    m_part part[PARTS];
} m8;

#define EIGHT static inline __attribute__((always_inline))
#define EACH(type, expression)                                                                               \
    type result;                                                                                             \
    for (int i = 0; i < PARTS; i++) result.part[i] = (expression);                                           \
    return result

EIGHT d8 d8_set(double a) { EACH(d8, a - (d_part){0}); }
EIGHT d8 d8_load(const double *from) { EACH(d8, *(const stored_part *)(from + i * PART_LANES)); }
EIGHT void d8_store(double *to, d8 a) {
    for (int i = 0; i < PARTS; i++) *(stored_part *)(to + i * PART_LANES) = a.part[i];
}
EIGHT d8 d8_add(d8 a, d8 b) { EACH(d8, a.part[i] + b.part[i]); }
EIGHT d8 d8_sub(d8 a, d8 b) { EACH(d8, a.part[i] - b.part[i]); }
EIGHT d8 d8_mul(d8 a, d8 b) { EACH(d8, a.part[i] * b.part[i]); }
EIGHT d8 d8_div(d8 a, d8 b) { EACH(d8, a.part[i] / b.part[i]); }
EIGHT m8 d8_lt(d8 a, d8 b) { EACH(m8, a.part[i] < b.part[i]); }
EIGHT m8 d8_le(d8 a, d8 b) { EACH(m8, a.part[i] <= b.part[i]); }
EIGHT m8 m8_and(m8 a, m8 b) { EACH(m8, a.part[i] & b.part[i]); }
EIGHT d8 d8_select(m8 m, d8 a, d8 b) {
    EACH(d8, (d_part)((m.part[i] & (m_part)a.part[i]) | (~m.part[i] & (m_part)b.part[i])));
}
/// a where m is set, else 0.
EIGHT d8 d8_keep(m8 m, d8 a) { EACH(d8, (d_part)(m.part[i] & (m_part)a.part[i])); }
EIGHT d8 d8_min(d8 a, d8 b) { return d8_select(d8_lt(b, a), b, a); }
EIGHT d8 d8_max(d8 a, d8 b) { return d8_select(d8_lt(a, b), b, a); }

/// The sum of the lanes, of halves that are added to each other.
EIGHT double d8_total(d8 a) {
    double half[LANES / 2], lanes[LANES];
    d8_store(lanes, a);
    for (int i = 0; i < LANES / 2; i++) half[i] = lanes[i] + lanes[i + LANES / 2];
    return (half[0] + half[2]) + (half[1] + half[3]);
}

EIGHT bool m8_any(m8 a) {
#if defined(WIDE_AVX512)
    return _mm512_movepi64_mask((__m512i)a.part[0]) != 0;
#elif defined(WIDE_AVX2)
    return _mm256_movemask_pd((__m256d)(a.part[0] | a.part[1])) != 0;
#else
    const m_part all = a.part[0] | a.part[1] | a.part[2] | a.part[3];
    return (all[0] | all[1]) != 0;
#endif
}

/// From 2^52 to 2^53 doubles are whole numbers. A sum that begins in the middle, here, and stays within is one of whole
/// numbers: what is added is rounded to one, and no order of the terms changes it, unless one is halfway between two.
static const double WHOLE = 0x1.8p52;

/// a with an odd last digit: not halfway between two whole numbers, if below 2^51.
EIGHT d8 d8_odd(d8 a) { EACH(d8, (d_part)((m_part)a.part[i] | 1)); }

/// exp(x) within 1e-11 relative for x in [-700, 0].
EIGHT d8 d8_exp(d8 x) {
    static const double factors[11] = {1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120,
                                       1.0 / 24,      1.0 / 6,      1.0 / 2,     1,          1};
    const d8 biased = d8_add(d8_mul(x, d8_set(1.4426950408889634)), d8_set(WHOLE)), whole = d8_sub(biased, d8_set(WHOLE));
    const d8 rest = d8_sub(d8_sub(x, d8_mul(whole, d8_set(0x1.62e42feep-1))), d8_mul(whole, d8_set(0x1.a39ef35793c76p-33)));
    d8 series = d8_set(factors[0]);
    for (int k = 1; k < 11; k++) series = d8_add(d8_set(factors[k]), d8_mul(rest, series));
    d8 power; // the last digits of `biased` are those of the whole number
    for (int i = 0; i < PARTS; i++) power.part[i] = (d_part)(((m_part)biased.part[i] + 1023) << 52);
    return d8_mul(series, power);
}

#undef EACH

#endif
