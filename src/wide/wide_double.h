// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of double, for the few sums that need them. As in wide.h every operation is correctly
// rounded: fma(a, b, c) = a b + c and fnma = c - a b round once.
#ifndef EWA_SRC_WIDE_WIDE_DOUBLE_H
#define EWA_SRC_WIDE_WIDE_DOUBLE_H

#include "wide/wide.h"

// What each instruction set has: a vector, how many of them are sixteen lanes, what is done with one, and the
// ways from sixteen floats and back.
#if defined(WIDE_AVX512)

typedef __m512d wd_part;
enum { WD_PARTS = 2 };
#define OPERATION           static inline
#define PART_SET            _mm512_set1_pd
#define PART_LOAD           _mm512_loadu_pd
#define PART_STORE          _mm512_storeu_pd
#define PART_ADD            _mm512_add_pd
#define PART_SUB            _mm512_sub_pd
#define PART_FMA(a, b, c)   _mm512_fmadd_pd(a, b, c)
#define PART_FNMA(a, b, c)  _mm512_fnmadd_pd(a, b, c)

static inline wd_part wd_part_from_f(wf a, int i) {
    return _mm512_cvtps_pd(i ? _mm512_extractf32x8_ps(a, 1) : _mm512_castps512_ps256(a));
}
static inline wf wf_from_parts(const wd_part part[WD_PARTS]) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(part[0])), _mm512_cvtpd_ps(part[1]), 1);
}

#elif defined(WIDE_AVX2)

typedef __m256d wd_part;
enum { WD_PARTS = 4 };
#define OPERATION           static inline
#define PART_SET            _mm256_set1_pd
#define PART_LOAD           _mm256_loadu_pd
#define PART_STORE          _mm256_storeu_pd
#define PART_ADD            _mm256_add_pd
#define PART_SUB            _mm256_sub_pd
#define PART_FMA(a, b, c)   _mm256_fmadd_pd(a, b, c)
#define PART_FNMA(a, b, c)  _mm256_fnmadd_pd(a, b, c)

static inline wd_part wd_part_from_f(wf a, int i) {
    const __m256 half = i < 2 ? a.l : a.h;
    return _mm256_cvtps_pd(i & 1 ? _mm256_extractf128_ps(half, 1) : _mm256_castps256_ps128(half));
}
static inline wf wf_from_parts(const wd_part part[WD_PARTS]) {
    return (wf){_mm256_set_m128(_mm256_cvtpd_ps(part[1]), _mm256_cvtpd_ps(part[0])),
                _mm256_set_m128(_mm256_cvtpd_ps(part[3]), _mm256_cvtpd_ps(part[2]))};
}

#elif defined(WIDE_NEON)

typedef float64x2_t wd_part;
enum { WD_PARTS = 8 };
#define OPERATION           static inline
#define PART_SET            vdupq_n_f64
#define PART_LOAD           vld1q_f64
#define PART_STORE          vst1q_f64
#define PART_ADD            vaddq_f64
#define PART_SUB            vsubq_f64
#define PART_FMA(a, b, c)   vfmaq_f64(c, a, b)
#define PART_FNMA(a, b, c)  vfmsq_f64(c, a, b)

static inline wd_part wd_part_from_f(wf a, int i) {
    return i & 1 ? vcvt_high_f64_f32(a.q[i / 2]) : vcvt_f64_f32(vget_low_f32(a.q[i / 2]));
}
static inline wf wf_from_parts(const wd_part part[WD_PARTS]) {
    wf result;
    for (int i = 0; i < 4; i++) result.q[i] = vcvt_high_f32_f64(vcvt_f32_f64(part[2 * i]), part[2 * i + 1]);
    return result;
}

#elif defined(__wasm_relaxed_simd__)

typedef v128_t wd_part;
enum { WD_PARTS = 8 };
#define OPERATION           static inline
#define PART_SET            wasm_f64x2_splat
#define PART_LOAD           wasm_v128_load
#define PART_STORE          wasm_v128_store
#define PART_ADD            wasm_f64x2_add
#define PART_SUB            wasm_f64x2_sub
#define PART_FMA(a, b, c)   wasm_f64x2_relaxed_madd(a, b, c)
#define PART_FNMA(a, b, c)  wasm_f64x2_relaxed_nmadd(a, b, c)

static inline wd_part wd_part_from_f(wf a, int i) {
    const v128_t four = (v128_t)a.q[i / 2];
    return wasm_f64x2_promote_low_f32x4(i & 1 ? wasm_i64x2_shuffle(four, four, 1, 1) : four);
}
static inline wf wf_from_parts(const wd_part part[WD_PARTS]) {
    wf result;
    for (int i = 0; i < 4; i++)
        result.q[i] = (w4f)wasm_i64x2_shuffle(wasm_f32x4_demote_f64x2_zero(part[2 * i]),
                                              wasm_f32x4_demote_f64x2_zero(part[2 * i + 1]), 0, 2);
    return result;
}

#else

typedef double wd_part;
enum { WD_PARTS = 16 };
#define OPERATION           static __attribute__((noinline, unused))
#define PART_SET(a)         (a)
#define PART_LOAD(p)        (*(p))
#define PART_STORE(p, a)    (*(p) = (a))
#define PART_ADD(a, b)      ((a) + (b))
#define PART_SUB(a, b)      ((a) - (b))
#define PART_FMA(a, b, c)   fma(a, b, c)
#define PART_FNMA(a, b, c)  fma(-(a), b, c)

static inline wd_part wd_part_from_f(wf a, int i) { return (double)a.q[i >> 2][i & 3]; }
static inline wf wf_from_parts(const wd_part part[WD_PARTS]) {
    wf result;
    for (int i = 0; i < WD_PARTS; i++) result.q[i >> 2][i & 3] = (float)part[i];
    return result;
}

#endif

typedef struct wd {
    wd_part part[WD_PARTS];
} wd;

#define PART_LANES          (16 / WD_PARTS)
#define EACH_PART(expression)                                                                                \
    wd result;                                                                                               \
    for (int i = 0; i < WD_PARTS; i++) result.part[i] = (expression);                                        \
    return result

OPERATION wd wd_set(double a) { EACH_PART(PART_SET(a)); }
OPERATION wd wd_load(const double *p) { EACH_PART(PART_LOAD(p + PART_LANES * i)); }
OPERATION void wd_store(double *p, wd a) {
    for (int i = 0; i < WD_PARTS; i++) PART_STORE(p + PART_LANES * i, a.part[i]);
}
OPERATION wd wd_add(wd a, wd b) { EACH_PART(PART_ADD(a.part[i], b.part[i])); }
OPERATION wd wd_sub(wd a, wd b) { EACH_PART(PART_SUB(a.part[i], b.part[i])); }
OPERATION wd wd_fma(wd a, wd b, wd c) { EACH_PART(PART_FMA(a.part[i], b.part[i], c.part[i])); }
OPERATION wd wd_fnma(wd a, wd b, wd c) { EACH_PART(PART_FNMA(a.part[i], b.part[i], c.part[i])); }
OPERATION wd wd_from_f(wf a) { EACH_PART(wd_part_from_f(a, i)); }
OPERATION wf wf_from_d(wd a) { return wf_from_parts(a.part); }

#undef OPERATION
#undef PART_SET
#undef PART_LOAD
#undef PART_STORE
#undef PART_ADD
#undef PART_SUB
#undef PART_FMA
#undef PART_FNMA
#undef PART_LANES
#undef EACH_PART

#endif
