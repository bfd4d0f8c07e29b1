// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of wide_portable.h and wide_wasm.h: a b + c rounded once, for four floats at a time, where the instruction set has no
// fused multiply-add and fmaf() would be called for every lane; and some chains of these, by fewer calls and conversions.
//
// In double precision the product of two floats is exact, and only the sum is rounded; rounding that to float
// can be wrong in two cases alone: where the rounded sum stands halfway between two floats though the exact
// one does not, and where the float is below the normal numbers, which have fewer digits. Both are seen from
// the bits. There the sum is rounded to odd first: S. Boldo and G. Melquiond, "Emulation of FMA
// and Correctly Rounded Sums: Proved Algorithms Using Rounding to Odd", IEEE Transactions on Computers 57(4),
// 2008.
//
// The second case needs a small c: a product has 48 bits, so that where a sum below 2^-96 is not exact in 53, |c| is at most
// 33/32 of it.
#define WIDE_FUSED_BY_DOUBLES

#include <stdbool.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

typedef float w2f __attribute__((vector_size(8)));
typedef double w2d __attribute__((vector_size(16)));
typedef int64_t w2l __attribute__((vector_size(16)));

static inline w2d w2d_of_low(w4f a) { return __builtin_convertvector(__builtin_shufflevector(a, a, 0, 1), w2d); }
#if defined(__SSE2__)
static inline w2d w2d_of_high(w4f a) { return (w2d)_mm_cvtps_pd(_mm_movehl_ps((__m128)a, (__m128)a)); }
#else
static inline w2d w2d_of_high(w4f a) { return w2d_of_low(__builtin_shufflevector(a, a, 2, 3, 2, 3)); }
#endif

/// The low words of four doubles.
static inline w4i low_words(w2d low, w2d high) { return __builtin_shufflevector((w4i)low, (w4i)high, 0, 2, 4, 6); }

#if defined(__wasm_simd128__)
// Clang takes the numbers of a narrowed vector one by one.
static inline w4f w4f_of(w2d low, w2d high) {
    return (w4f)wasm_i64x2_shuffle(wasm_f32x4_demote_f64x2_zero((v128_t)low), wasm_f32x4_demote_f64x2_zero((v128_t)high), 0, 2);
}

// What is doubtful is told by the signs, which needs the fewest constants: hosts make these anew in every call.
static inline w4i is_halfway(w2d low, w2d high) { return (w4i)wasm_i32x4_abs((v128_t)(low_words(low, high) << 3)); }
static inline w4i is_below_normal(w4f sum) { return (w4i)(((((w4u)sum << 1) - 1) >> 24) - 1); }
static inline bool is_any(w4i doubtful) { return __builtin_expect(wasm_i32x4_bitmask((v128_t)doubtful) != 0, 0); }
#elif defined(__SSE2__)
// GCC 12 takes the numbers of a high half one by one, and clears what a narrowing has cleared.
static inline w4f w4f_of(w2d low, w2d high) {
    return (w4f)_mm_movelh_ps(_mm_cvtpd_ps((__m128d)low), _mm_cvtpd_ps((__m128d)high));
}

// By the signs likewise.
static inline w4i is_halfway(w2d low, w2d high) { return low_words(low, high) << 3 == INT32_MIN; }
static inline w4i is_below_normal(w4f sum) { return (w4i)(((((w4u)sum << 1) - 1) >> 24) - 1); }
static inline bool is_any(w4i doubtful) { return __builtin_expect(_mm_movemask_ps((__m128)doubtful) != 0, 0); }
#else
static inline w4f w4f_of(w2d low, w2d high) {
    const w2f l = __builtin_convertvector(low, w2f), h = __builtin_convertvector(high, w2f);
    return __builtin_shufflevector(l, h, 0, 1, 2, 3);
}

/// Other than 0 in the lanes of sums that are halfway between two floats.
static inline w4i is_halfway(w2d low, w2d high) { return low_words(low, high) << 3 == INT32_MIN; }
/// Likewise of floats below the normal numbers, or the first of these, but not 0.
static inline w4i is_below_normal(w4f sum) { return ((w4u)sum << 1) - 1 < 0x01000000; }
static inline bool is_any(w4i doubtful) {
    const w2l any = (w2l)doubtful;
    return any[0] | any[1];
}
#endif

/// product + c rounded to odd: the exact sum where that is a double, else of the two beside it the one with
/// an odd last bit.
static inline w2d fused_odd(w2d product, w2d c) {
    const w2d sum = product + c, c_part = sum - product;
    const w2d lost = (product - (sum - c_part)) + (c - c_part);
    const w2l inexact = (lost < 0) | (lost > 0), even = ((w2l)sum & 1) - 1;
    const w2l step = (((lost > 0) ^ (sum < 0)) & 2) - 1; // away from 0, or towards it
    return (w2d)((w2l)sum + (inexact & even & step));
}

FUSED w4f w4f_fma(w4f a, w4f b, w4f c) {
    const w2d low_product = w2d_of_low(a) * w2d_of_low(b), high_product = w2d_of_high(a) * w2d_of_high(b);
    const w2d low = low_product + w2d_of_low(c), high = high_product + w2d_of_high(c);
    const w4f sum = w4f_of(low, high);
    if (!is_any(is_halfway(low, high) | is_below_normal(sum))) return sum;
    return w4f_of(fused_odd(low_product, w2d_of_low(c)), fused_odd(high_product, w2d_of_high(c)));
}

FUSED w4f w4f_fma_twice(w4f x, w4f a, w4f b, w4f c) {
    const w2d x_low = w2d_of_low(x), x_high = w2d_of_high(x);
    w2d low = x_low * w2d_of_low(a) + w2d_of_low(b), high = x_high * w2d_of_high(a) + w2d_of_high(b);
    const w4f inner = w4f_of(low, high);
    w4i doubtful = is_halfway(low, high) | is_below_normal(inner);
    low = x_low * w2d_of_low(inner) + w2d_of_low(c), high = x_high * w2d_of_high(inner) + w2d_of_high(c);
    const w4f sum = w4f_of(low, high);
    doubtful |= is_halfway(low, high) | is_below_normal(sum);
    return is_any(doubtful) ? w4f_fma(x, w4f_fma(x, a, b), c) : sum;
}

FUSED w4f w4f_horner(w4f x, const float *coefficients, int count) {
    const w2d x_low = w2d_of_low(x), x_high = w2d_of_high(x);
    w4f sum = {coefficients[0], coefficients[0], coefficients[0], coefficients[0]};
    w4i doubtful = {0};
    for (int i = 1; i < count; i++) {
        const double of = (double)coefficients[i];
        const w2d low = x_low * w2d_of_low(sum) + of, high = x_high * w2d_of_high(sum) + of;
        sum = w4f_of(low, high);
        doubtful |= is_halfway(low, high); // no coefficient is small
    }
    if (!is_any(doubtful)) return sum;
    sum = (w4f){coefficients[0], coefficients[0], coefficients[0], coefficients[0]};
    for (int i = 1; i < count; i++) {
        const float of = coefficients[i];
        sum = w4f_fma(x, sum, (w4f){of, of, of, of});
    }
    return sum;
}

/// Adding 3 2^51 rounds to a whole number, which are its last bits then.
static inline w4f w4f_fma_whole(w4f a, w4f b, w4f c) {
    const w2d low = w2d_of_low(a) * w2d_of_low(b) + 0x1.8p52, high = w2d_of_high(a) * w2d_of_high(b) + 0x1.8p52;
    return c + __builtin_convertvector(low_words(low, high), w4f);
}

static inline wf wf_fma(wf a, wf b, wf c) { QUARTERS(wf, w4f_fma(a.q[n], b.q[n], c.q[n])); }
static inline wf wf_fma_twice(wf x, wf a, wf b, wf c) { QUARTERS(wf, w4f_fma_twice(x.q[n], a.q[n], b.q[n], c.q[n])); }
static inline wf wf_horner(wf x, const float *coefficients, int count) {
    QUARTERS(wf, w4f_horner(x.q[n], coefficients, count));
}
static inline wf wf_fma_whole(wf a, wf b, wf c) { QUARTERS(wf, w4f_fma_whole(a.q[n], b.q[n], c.q[n])); }
static inline w8 w8_fma(w8 a, w8 b, w8 c) { return (w8){w4f_fma(a.l, b.l, c.l), w4f_fma(a.h, b.h, c.h)}; }
