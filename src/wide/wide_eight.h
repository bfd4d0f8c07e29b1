// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of wide.h: eight lanes, for the numbers of one pixel; one AVX register whatever the width of the others.
#include <immintrin.h>

typedef __m256 w8;

static inline w8 w8_set(float a) { return _mm256_set1_ps(a); }
static inline w8 w8_load(const float *p) { return _mm256_loadu_ps(p); }
static inline void w8_store(float *p, w8 a) { _mm256_storeu_ps(p, a); }
static inline w8 w8_fma(w8 a, w8 b, w8 c) { return _mm256_fmadd_ps(a, b, c); }

/// p[0..3], q[0..2], 0; reads q[3].
static inline w8 w8_join(const float *p, const float *q) {
    const __m256 both = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(q), 1);
    return _mm256_blend_ps(both, _mm256_setzero_ps(), 0x80);
}
