// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The wide type: sixteen lanes, written four times, so that a kernel's body is written once.
//
// A file that includes this defines WIDE_AVX512, WIDE_AVX2, WIDE_NEON or WIDE_PORTABLE first. Every operation
// is exact or correctly rounded, so that each version gives the same bytes: fma(a, b, c) = a b + c and fnma =
// c - a b round once; min(a, b) is a < b ? a : b and max is a > b ? a : b, so that a NaN on either side gives
// b; comparisons with a NaN are false; wi_from_f truncates and is only for values within int32, wi_store_u8
// for values in [0, 255]; sar is an arithmetic shift. Masks: select(m, a, b) takes a where m is set; keep(m,
// a) is a where set, else 0. Only `static inline` in here: a file compiled for one instruction set must not
// lend code to the others.
#ifndef EWA_SRC_WIDE_H
#define EWA_SRC_WIDE_H

#include <stddef.h>
#include <stdint.h>

#if defined(WIDE_AVX512)
#include "wide/wide_avx512.h"
#include "wide/wide_eight.h"
#elif defined(WIDE_AVX2)
#include "wide/wide_avx2.h"
#include "wide/wide_pack.h"
#include "wide/wide_eight.h"
#elif defined(WIDE_NEON)
#include "wide/wide_neon.h"
#include "wide/wide_pack.h"
#elif defined(WIDE_PORTABLE) && defined(__wasm_simd128__)
#include "wide/wide_wasm.h"
#include "wide/wide_pack.h"
#elif defined(WIDE_PORTABLE)
#include "wide/wide_portable.h"
#include "wide/wide_pack.h"
#else
#error "define WIDE_AVX512, WIDE_AVX2, WIDE_NEON or WIDE_PORTABLE"
#endif

#if !defined(WIDE_FUSED_BY_DOUBLES)
// Chains of fma that sets without it (wide_fused.h) have another way to.

/// x (x a + b) + c, each sum rounded once.
static ALWAYS_INLINE wf wf_fma_twice(wf x, wf a, wf b, wf c) { return wf_fma(x, wf_fma(x, a, b), c); }

/// ((coefficients[0] x + coefficients[1]) x + ...) of `count` >= 1 coefficients of at least 2^-100, each sum rounded once.
static ALWAYS_INLINE wf wf_horner(wf x, const float *coefficients, int count) {
    wf sum = wf_set(coefficients[0]);
    for (int i = 1; i < count; i++) sum = wf_fma(x, sum, wf_set(coefficients[i]));
    return sum;
}

/// a b + c rounded once, for whole numbers c and sums in [2^23, 2^24) and products, |a b| < 2^22, that are not halfway between two
/// whole numbers. Other sums are near it, and grow with c.
static ALWAYS_INLINE wf wf_fma_whole(wf a, wf b, wf c) { return wf_fma(a, b, c); }
#endif

#endif
