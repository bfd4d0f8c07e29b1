// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// WebAssembly's relaxed multiply-add rounds once on some hosts and twice on others. A library that has it gives the bytes of all
// others on the former only, and refuses the latter, where the one without is to be loaded.
#ifndef EWA_SRC_BASE_RELAXED_H
#define EWA_SRC_BASE_RELAXED_H

#include <stdbool.h>

#if defined(__wasm_relaxed_simd__)
#include <wasm_simd128.h>

/// Returns whether the host's multiply-add rounds once, of floats and of doubles.
static inline bool ewa_relaxed_rounds_once(void) {
    // (1 + e)^2 - (1 + 2 e) is e^2, which is lost where the product is rounded.
    volatile float e = 0x1p-13f;
    volatile double f = 0x1p-30;
    const v128_t a = wasm_f32x4_splat(1 + e), b = wasm_f64x2_splat(1 + f);
    const v128_t single = wasm_f32x4_relaxed_madd(a, a, wasm_f32x4_splat(-(1 + 2 * e)));
    const v128_t twice = wasm_f64x2_relaxed_madd(b, b, wasm_f64x2_splat(-(1 + 2 * f)));
    return wasm_f32x4_extract_lane(single, 0) == e * e && wasm_f64x2_extract_lane(twice, 0) == f * f;
}
#else
static inline bool ewa_relaxed_rounds_once(void) { return true; }
#endif

#endif
