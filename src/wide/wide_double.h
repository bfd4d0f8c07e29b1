// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of double, for the few sums that need them. As in wide.h every operation is correctly
// rounded: fma(a, b, c) = a b + c and fnma = c - a b round once.
#ifndef EWA_SRC_WIDE_WIDE_DOUBLE_H
#define EWA_SRC_WIDE_WIDE_DOUBLE_H

#include "wide/wide.h"

#if defined(WIDE_AVX512)

typedef struct wd {
    __m512d l, h;
} wd;

static inline wd wd_set(double a) { return (wd){_mm512_set1_pd(a), _mm512_set1_pd(a)}; }
static inline wd wd_load(const double *p) { return (wd){_mm512_loadu_pd(p), _mm512_loadu_pd(p + 8)}; }
static inline void wd_store(double *p, wd a) {
    _mm512_storeu_pd(p, a.l);
    _mm512_storeu_pd(p + 8, a.h);
}
static inline wd wd_add(wd a, wd b) { return (wd){_mm512_add_pd(a.l, b.l), _mm512_add_pd(a.h, b.h)}; }
static inline wd wd_sub(wd a, wd b) { return (wd){_mm512_sub_pd(a.l, b.l), _mm512_sub_pd(a.h, b.h)}; }
static inline wd wd_fma(wd a, wd b, wd c) {
    return (wd){_mm512_fmadd_pd(a.l, b.l, c.l), _mm512_fmadd_pd(a.h, b.h, c.h)};
}
static inline wd wd_fnma(wd a, wd b, wd c) {
    return (wd){_mm512_fnmadd_pd(a.l, b.l, c.l), _mm512_fnmadd_pd(a.h, b.h, c.h)};
}
static inline wd wd_from_f(wf a) {
    return (wd){_mm512_cvtps_pd(_mm512_castps512_ps256(a)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(a, 1))};
}
static inline wf wf_from_d(wd a) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(a.l)), _mm512_cvtpd_ps(a.h), 1);
}

#elif defined(WIDE_AVX2)

typedef struct wd {
    __m256d part[4];
} wd;

#define EACH_PART(expression)                                                                                \
    wd result;                                                                                               \
    for (int i = 0; i < 4; i++) result.part[i] = (expression);                                               \
    return result

static inline wd wd_set(double a) { EACH_PART(_mm256_set1_pd(a)); }
static inline wd wd_load(const double *p) { EACH_PART(_mm256_loadu_pd(p + 4 * i)); }
static inline void wd_store(double *p, wd a) {
    for (int i = 0; i < 4; i++) _mm256_storeu_pd(p + 4 * i, a.part[i]);
}
static inline wd wd_add(wd a, wd b) { EACH_PART(_mm256_add_pd(a.part[i], b.part[i])); }
static inline wd wd_sub(wd a, wd b) { EACH_PART(_mm256_sub_pd(a.part[i], b.part[i])); }
static inline wd wd_fma(wd a, wd b, wd c) { EACH_PART(_mm256_fmadd_pd(a.part[i], b.part[i], c.part[i])); }
static inline wd wd_fnma(wd a, wd b, wd c) { EACH_PART(_mm256_fnmadd_pd(a.part[i], b.part[i], c.part[i])); }
static inline wd wd_from_f(wf a) {
    return (wd){{_mm256_cvtps_pd(_mm256_castps256_ps128(a.l)), _mm256_cvtps_pd(_mm256_extractf128_ps(a.l, 1)),
                 _mm256_cvtps_pd(_mm256_castps256_ps128(a.h)),
                 _mm256_cvtps_pd(_mm256_extractf128_ps(a.h, 1))}};
}
static inline wf wf_from_d(wd a) {
    __m128 quarter[4];
    for (int i = 0; i < 4; i++) quarter[i] = _mm256_cvtpd_ps(a.part[i]);
    return (wf){_mm256_set_m128(quarter[1], quarter[0]), _mm256_set_m128(quarter[3], quarter[2])};
}

#undef EACH_PART

#elif defined(WIDE_NEON)

typedef struct wd {
    float64x2_t part[8];
} wd;

#define EACH_PART(expression)                                                                                \
    wd result;                                                                                               \
    for (int i = 0; i < 8; i++) result.part[i] = (expression);                                               \
    return result

static inline wd wd_set(double a) { EACH_PART(vdupq_n_f64(a)); }
static inline wd wd_load(const double *p) { EACH_PART(vld1q_f64(p + 2 * i)); }
static inline void wd_store(double *p, wd a) {
    for (int i = 0; i < 8; i++) vst1q_f64(p + 2 * i, a.part[i]);
}
static inline wd wd_add(wd a, wd b) { EACH_PART(vaddq_f64(a.part[i], b.part[i])); }
static inline wd wd_sub(wd a, wd b) { EACH_PART(vsubq_f64(a.part[i], b.part[i])); }
static inline wd wd_fma(wd a, wd b, wd c) { EACH_PART(vfmaq_f64(c.part[i], a.part[i], b.part[i])); }
static inline wd wd_fnma(wd a, wd b, wd c) { EACH_PART(vfmsq_f64(c.part[i], a.part[i], b.part[i])); }
static inline wd wd_from_f(wf a) {
    EACH_PART(i % 2 ? vcvt_high_f64_f32(a.q[i / 2]) : vcvt_f64_f32(vget_low_f32(a.q[i / 2])));
}
static inline wf wf_from_d(wd a) {
    wf result;
    for (int i = 0; i < 4; i++) result.q[i] = vcvt_high_f32_f64(vcvt_f32_f64(a.part[2 * i]), a.part[2 * i + 1]);
    return result;
}

#undef EACH_PART

#else

typedef struct wd {
    double lane[16];
} wd;

#define EACH_LANE(expression)                                                                                \
    wd result;                                                                                               \
    for (int i = 0; i < 16; i++) result.lane[i] = (expression);                                              \
    return result
#define CALLED static __attribute__((noinline, unused))

CALLED wd wd_set(double a) { EACH_LANE(a); }
static inline wd wd_load(const double *p) {
    wd result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline void wd_store(double *p, wd a) { memcpy(p, &a, sizeof a); }
static inline wd wd_add(wd a, wd b) { EACH_LANE(a.lane[i] + b.lane[i]); }
static inline wd wd_sub(wd a, wd b) { EACH_LANE(a.lane[i] - b.lane[i]); }
CALLED wd wd_fma(wd a, wd b, wd c) { EACH_LANE(fma(a.lane[i], b.lane[i], c.lane[i])); }
CALLED wd wd_fnma(wd a, wd b, wd c) { EACH_LANE(fma(-a.lane[i], b.lane[i], c.lane[i])); }
CALLED wd wd_from_f(wf a) { EACH_LANE((double)a.q[i >> 2][i & 3]); }
CALLED wf wf_from_d(wd a) {
    wf result;
    for (int i = 0; i < 16; i++) result.q[i >> 2][i & 3] = (float)a.lane[i];
    return result;
}

#undef CALLED
#undef EACH_LANE

#endif
#endif
