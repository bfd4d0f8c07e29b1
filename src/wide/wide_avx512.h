// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask: AVX-512 (F, DQ, BW, VL). See wide.h for what each operation means.
#include <immintrin.h>

// With the checks of a sanitizer, inlined and unrolled copies take minutes to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALWAYS_INLINE inline
#define UNROLL_COLUMNS
#else
#define ALWAYS_INLINE  inline __attribute__((always_inline))
#define UNROLL_COLUMNS _Pragma("GCC unroll 4")
#endif

typedef __m512 wf;
typedef __m512i wi;
typedef __mmask16 wm;

/// Sixteens that go through a long chain of steps at once: a step takes four cycles, two may begin in each.
enum { WIDE_TOGETHER = 4 };

static inline wf wf_set(float a) { return _mm512_set1_ps(a); }
static inline wf wf_load(const float *p) { return _mm512_loadu_ps(p); }
static inline void wf_store(float *p, wf a) { _mm512_storeu_ps(p, a); }
static inline wf wf_add(wf a, wf b) { return _mm512_add_ps(a, b); }
static inline wf wf_sub(wf a, wf b) { return _mm512_sub_ps(a, b); }
static inline wf wf_mul(wf a, wf b) { return _mm512_mul_ps(a, b); }
static inline wf wf_div(wf a, wf b) { return _mm512_div_ps(a, b); }
static inline wf wf_sqrt(wf a) { return _mm512_sqrt_ps(a); }
static inline wf wf_min(wf a, wf b) { return _mm512_min_ps(a, b); }
static inline wf wf_max(wf a, wf b) { return _mm512_max_ps(a, b); }
static inline wf wf_abs(wf a) { return _mm512_abs_ps(a); }
static inline wf wf_fma(wf a, wf b, wf c) { return _mm512_fmadd_ps(a, b, c); }
static inline wf wf_fnma(wf a, wf b, wf c) { return _mm512_fnmadd_ps(a, b, c); }
static inline wf wf_floor(wf a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
static inline wf wf_from_i(wi a) { return _mm512_cvtepi32_ps(a); }
static inline wi wi_from_f(wf a) { return _mm512_cvttps_epi32(a); }
static inline wf wf_of_bits(wi a) { return _mm512_castsi512_ps(a); }
static inline wi wi_of_bits(wf a) { return _mm512_castps_si512(a); }
static inline wm wf_lt(wf a, wf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline wm wf_le(wf a, wf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
static inline wf wf_select(wm m, wf a, wf b) { return _mm512_mask_blend_ps(m, b, a); }
static inline wf wf_keep(wm m, wf a) { return _mm512_maskz_mov_ps(m, a); }

static inline wi wi_set(int32_t a) { return _mm512_set1_epi32(a); }
static inline wi wi_load(const int32_t *p) { return _mm512_loadu_si512(p); }
static inline void wi_store(int32_t *p, wi a) { _mm512_storeu_si512(p, a); }
static inline void wi_store_u8(uint8_t *p, wi a) {
    _mm_storeu_si128((__m128i *)(void *)p, _mm512_cvtepi32_epi8(a));
}
static inline wi wi_load_u16(const uint16_t *p) {
    return _mm512_cvtepu16_epi32(_mm256_loadu_si256((const __m256i *)(const void *)p));
}
static inline wi wi_load_i16(const int16_t *p) {
    return _mm512_cvtepi16_epi32(_mm256_loadu_si256((const __m256i *)(const void *)p));
}
static inline wi wi_add(wi a, wi b) { return _mm512_add_epi32(a, b); }
static inline wi wi_sub(wi a, wi b) { return _mm512_sub_epi32(a, b); }
static inline wi wi_min(wi a, wi b) { return _mm512_min_epi32(a, b); }
static inline wi wi_max(wi a, wi b) { return _mm512_max_epi32(a, b); }
static inline wi wi_or(wi a, wi b) { return _mm512_or_si512(a, b); }
static inline wi wi_and(wi a, wi b) { return _mm512_and_si512(a, b); }
static inline wi wi_shl(wi a, int n) { return _mm512_slli_epi32(a, (unsigned)n); }
static inline wi wi_sar(wi a, int n) { return _mm512_srai_epi32(a, (unsigned)n); }

static inline wm wm_and(wm a, wm b) { return (wm)(a & b); }
static inline wm wm_or(wm a, wm b) { return (wm)(a | b); }
static inline wm wm_not(wm a) { return (wm)~a; }
static inline uint32_t wm_bits(wm a) { return a; }
static inline wm wm_of_bits(uint32_t bits) { return (wm)bits; }

/// p[at] per lane.
static inline wf wf_gather(const float *p, wi at) { return _mm512_i32gather_ps(at, p, 4); }

/// table[index mod 16] per lane.
static inline wf wf_lookup(const float table[16], wi index) {
    return _mm512_permutexvar_ps(index, _mm512_loadu_ps(table));
}

/// table[index mod 32] per lane.
static inline wf wf_lookup32(const float table[32], wi index) {
    return _mm512_permutex2var_ps(_mm512_loadu_ps(table), index, _mm512_loadu_ps(table + 16));
}

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) {
    const __m256 low =
        _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + stride), 1);
    const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 2 * stride)),
                                             _mm_loadu_ps(p + 3 * stride), 1);
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    _mm_storeu_si128((__m128i *)(void *)out, _mm512_castsi512_si128(a));
    _mm_storeu_si128((__m128i *)(void *)(out + stride_bytes), _mm512_extracti32x4_epi32(a, 1));
    _mm_storeu_si128((__m128i *)(void *)(out + 2 * stride_bytes), _mm512_extracti32x4_epi32(a, 2));
    _mm_storeu_si128((__m128i *)(void *)(out + 3 * stride_bytes), _mm512_extracti32x4_epi32(a, 3));
}

/// Writes the lanes where m is set one after another; may write 16 numbers.
static inline void wf_pack(float *p, wm m, wf a) { _mm512_storeu_ps(p, _mm512_maskz_compress_ps(m, a)); }
static inline void wi_pack(int32_t *p, wm m, wi a) {
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(m, a));
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
static inline void w_transpose(wf rows[16]) {
    wf t[16];
    for (int i = 0; i < 16; i += 2) {
        t[i] = _mm512_unpacklo_ps(rows[i], rows[i + 1]);
        t[i + 1] = _mm512_unpackhi_ps(rows[i], rows[i + 1]);
    }
    for (int i = 0; i < 16; i += 4) {
        const __m512d a = _mm512_castps_pd(t[i]), b = _mm512_castps_pd(t[i + 1]);
        const __m512d c = _mm512_castps_pd(t[i + 2]), d = _mm512_castps_pd(t[i + 3]);
        rows[i] = _mm512_castpd_ps(_mm512_unpacklo_pd(a, c));
        rows[i + 1] = _mm512_castpd_ps(_mm512_unpackhi_pd(a, c));
        rows[i + 2] = _mm512_castpd_ps(_mm512_unpacklo_pd(b, d));
        rows[i + 3] = _mm512_castpd_ps(_mm512_unpackhi_pd(b, d));
    }
    // rows[4 g + k] holds, in 128-bit part p, column 4 p + k of the source rows 4 g .. 4 g + 3.
    for (int k = 0; k < 4; k++) {
        const wf a = _mm512_shuffle_f32x4(rows[k], rows[4 + k], 0x88),
                 b = _mm512_shuffle_f32x4(rows[k], rows[4 + k], 0xdd);
        const wf c = _mm512_shuffle_f32x4(rows[8 + k], rows[12 + k], 0x88);
        const wf d = _mm512_shuffle_f32x4(rows[8 + k], rows[12 + k], 0xdd);
        t[k] = _mm512_shuffle_f32x4(a, c, 0x88);
        t[8 + k] = _mm512_shuffle_f32x4(a, c, 0xdd);
        t[4 + k] = _mm512_shuffle_f32x4(b, d, 0x88);
        t[12 + k] = _mm512_shuffle_f32x4(b, d, 0xdd);
    }
    for (int i = 0; i < 16; i++) rows[i] = t[i];
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
static inline void w_store4(float *out, wf a, wf b, wf c, wf d) {
    const wf ab_l = _mm512_unpacklo_ps(a, b), ab_h = _mm512_unpackhi_ps(a, b);
    const wf cd_l = _mm512_unpacklo_ps(c, d), cd_h = _mm512_unpackhi_ps(c, d);
    const wf r0 = _mm512_shuffle_ps(ab_l, cd_l, 0x44), r1 = _mm512_shuffle_ps(ab_l, cd_l, 0xee);
    const wf r2 = _mm512_shuffle_ps(ab_h, cd_h, 0x44), r3 = _mm512_shuffle_ps(ab_h, cd_h, 0xee);
    // rk holds in 128-bit part p the four values of lane 4 p + k.
    const wf s0 = _mm512_shuffle_f32x4(r0, r1, 0x88), s1 = _mm512_shuffle_f32x4(r0, r1, 0xdd);
    const wf s2 = _mm512_shuffle_f32x4(r2, r3, 0x88), s3 = _mm512_shuffle_f32x4(r2, r3, 0xdd);
    _mm512_storeu_ps(out, _mm512_shuffle_f32x4(s0, s2, 0x88));
    _mm512_storeu_ps(out + 16, _mm512_shuffle_f32x4(s1, s3, 0x88));
    _mm512_storeu_ps(out + 32, _mm512_shuffle_f32x4(s0, s2, 0xdd));
    _mm512_storeu_ps(out + 48, _mm512_shuffle_f32x4(s1, s3, 0xdd));
}

/// p[0..3] over and over.
static inline wf wf_repeat4(const float *p) { return _mm512_broadcast_f32x4(_mm_loadu_ps(p)); }

/// p[0] four times, p[1] four times, p[2], p[3].
static inline wf wf_spread4(const float *p) {
    return _mm512_permutexvar_ps(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
                                 wf_repeat4(p));
}

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
static inline void w_load4(const float *p, size_t stride, wf out[4]) {
    const __m512i low = _mm512_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25, 29);
    const __m512i high = _mm512_setr_epi32(2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11, 15, 19, 23, 27, 31);
    const wf a = _mm512_loadu_ps(p), b = _mm512_loadu_ps(p + stride);
    const wf c = _mm512_loadu_ps(p + 2 * stride), d = _mm512_loadu_ps(p + 3 * stride);
    const wf ab_l = _mm512_permutex2var_ps(a, low, b), ab_h = _mm512_permutex2var_ps(a, high, b);
    const wf cd_l = _mm512_permutex2var_ps(c, low, d), cd_h = _mm512_permutex2var_ps(c, high, d);
    out[0] = _mm512_shuffle_f32x4(ab_l, cd_l, 0x44);
    out[1] = _mm512_shuffle_f32x4(ab_l, cd_l, 0xee);
    out[2] = _mm512_shuffle_f32x4(ab_h, cd_h, 0x44);
    out[3] = _mm512_shuffle_f32x4(ab_h, cd_h, 0xee);
}
