// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask as pairs of AVX2 registers. See wide.h for what each operation means.
#include <immintrin.h>

// With the checks of a sanitizer, inlined and unrolled copies take minutes to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALWAYS_INLINE inline
#define UNROLL_COLUMNS
#else
#define ALWAYS_INLINE  inline __attribute__((always_inline))
#define UNROLL_COLUMNS _Pragma("GCC unroll 4")
#endif

typedef struct wf {
    __m256 l, h;
} wf;
typedef struct wi {
    __m256i l, h;
} wi;
typedef struct wm {
    __m256 l, h;
} wm;

/// Sixteens that go through a long chain of steps at once: the registers hold one.
enum { WIDE_TOGETHER = 1 };

#define PAIR(type, low, high) ((type){(low), (high)})
#define UNARY(type, f, a)     PAIR(type, f((a).l), f((a).h))
#define BINARY(type, f, a, b) PAIR(type, f((a).l, (b).l), f((a).h, (b).h))

static inline wf wf_set(float a) { return PAIR(wf, _mm256_set1_ps(a), _mm256_set1_ps(a)); }
static inline wf wf_load(const float *p) { return PAIR(wf, _mm256_loadu_ps(p), _mm256_loadu_ps(p + 8)); }
static inline void wf_store(float *p, wf a) {
    _mm256_storeu_ps(p, a.l);
    _mm256_storeu_ps(p + 8, a.h);
}
static inline wf wf_add(wf a, wf b) { return BINARY(wf, _mm256_add_ps, a, b); }
static inline wf wf_sub(wf a, wf b) { return BINARY(wf, _mm256_sub_ps, a, b); }
static inline wf wf_mul(wf a, wf b) { return BINARY(wf, _mm256_mul_ps, a, b); }
static inline wf wf_div(wf a, wf b) { return BINARY(wf, _mm256_div_ps, a, b); }
static inline wf wf_sqrt(wf a) { return UNARY(wf, _mm256_sqrt_ps, a); }
static inline wf wf_min(wf a, wf b) { return BINARY(wf, _mm256_min_ps, a, b); }
static inline wf wf_max(wf a, wf b) { return BINARY(wf, _mm256_max_ps, a, b); }
static inline wf wf_abs(wf a) {
    const __m256 sign = _mm256_set1_ps(-0.0f);
    return PAIR(wf, _mm256_andnot_ps(sign, a.l), _mm256_andnot_ps(sign, a.h));
}
static inline wf wf_fma(wf a, wf b, wf c) {
    return PAIR(wf, _mm256_fmadd_ps(a.l, b.l, c.l), _mm256_fmadd_ps(a.h, b.h, c.h));
}
static inline wf wf_fnma(wf a, wf b, wf c) {
    return PAIR(wf, _mm256_fnmadd_ps(a.l, b.l, c.l), _mm256_fnmadd_ps(a.h, b.h, c.h));
}
static inline wf wf_floor(wf a) { return UNARY(wf, _mm256_floor_ps, a); }
static inline wf wf_from_i(wi a) { return UNARY(wf, _mm256_cvtepi32_ps, a); }
static inline wi wi_from_f(wf a) { return UNARY(wi, _mm256_cvttps_epi32, a); }
static inline wf wf_of_bits(wi a) { return UNARY(wf, _mm256_castsi256_ps, a); }
static inline wi wi_of_bits(wf a) { return UNARY(wi, _mm256_castps_si256, a); }
static inline wm wf_lt(wf a, wf b) {
    return PAIR(wm, _mm256_cmp_ps(a.l, b.l, _CMP_LT_OQ), _mm256_cmp_ps(a.h, b.h, _CMP_LT_OQ));
}
static inline wm wf_le(wf a, wf b) {
    return PAIR(wm, _mm256_cmp_ps(a.l, b.l, _CMP_LE_OQ), _mm256_cmp_ps(a.h, b.h, _CMP_LE_OQ));
}
static inline wf wf_select(wm m, wf a, wf b) {
    return PAIR(wf, _mm256_blendv_ps(b.l, a.l, m.l), _mm256_blendv_ps(b.h, a.h, m.h));
}
static inline wf wf_keep(wm m, wf a) { return PAIR(wf, _mm256_and_ps(m.l, a.l), _mm256_and_ps(m.h, a.h)); }

static inline wi wi_set(int32_t a) { return PAIR(wi, _mm256_set1_epi32(a), _mm256_set1_epi32(a)); }
static inline wi wi_load(const int32_t *p) {
    return PAIR(wi, _mm256_loadu_si256((const __m256i *)(const void *)p),
                _mm256_loadu_si256((const __m256i *)(const void *)(p + 8)));
}
static inline void wi_store(int32_t *p, wi a) {
    _mm256_storeu_si256((__m256i *)(void *)p, a.l);
    _mm256_storeu_si256((__m256i *)(void *)(p + 8), a.h);
}
/// Of values in [0, 255].
static inline void wi_store_u8(uint8_t *p, wi a) {
    const __m256i words = _mm256_permute4x64_epi64(_mm256_packus_epi32(a.l, a.h), 0xd8);
    _mm_storeu_si128((__m128i *)(void *)p,
                     _mm_packus_epi16(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1)));
}
static inline wi wi_load_u16(const uint16_t *p) {
    return PAIR(wi, _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p)),
                _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)(p + 8))));
}
static inline wi wi_load_i16(const int16_t *p) {
    return PAIR(wi, _mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p)),
                _mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(const void *)(p + 8))));
}
static inline wi wi_add(wi a, wi b) { return BINARY(wi, _mm256_add_epi32, a, b); }
static inline wi wi_sub(wi a, wi b) { return BINARY(wi, _mm256_sub_epi32, a, b); }
static inline wi wi_min(wi a, wi b) { return BINARY(wi, _mm256_min_epi32, a, b); }
static inline wi wi_max(wi a, wi b) { return BINARY(wi, _mm256_max_epi32, a, b); }
static inline wi wi_or(wi a, wi b) { return BINARY(wi, _mm256_or_si256, a, b); }
static inline wi wi_and(wi a, wi b) { return BINARY(wi, _mm256_and_si256, a, b); }
static inline wi wi_shl(wi a, int n) {
    return PAIR(wi, _mm256_slli_epi32(a.l, n), _mm256_slli_epi32(a.h, n));
}
static inline wi wi_sar(wi a, int n) {
    return PAIR(wi, _mm256_srai_epi32(a.l, n), _mm256_srai_epi32(a.h, n));
}

static inline wm wm_and(wm a, wm b) { return BINARY(wm, _mm256_and_ps, a, b); }
static inline wm wm_or(wm a, wm b) { return BINARY(wm, _mm256_or_ps, a, b); }
static inline wm wm_not(wm a) {
    const __m256 ones = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
    return PAIR(wm, _mm256_xor_ps(a.l, ones), _mm256_xor_ps(a.h, ones));
}
static inline uint32_t wm_bits(wm a) {
    return (uint32_t)_mm256_movemask_ps(a.l) | (uint32_t)_mm256_movemask_ps(a.h) << 8;
}
static inline wm wm_of_bits(uint32_t bits) {
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i l = _mm256_and_si256(_mm256_set1_epi32((int)bits), lane);
    const __m256i h = _mm256_and_si256(_mm256_set1_epi32((int)(bits >> 8)), lane);
    return PAIR(wm, _mm256_castsi256_ps(_mm256_cmpeq_epi32(l, lane)),
                _mm256_castsi256_ps(_mm256_cmpeq_epi32(h, lane)));
}

/// p[at] per lane.
static inline wf wf_gather(const float *p, wi at) {
    return PAIR(wf, _mm256_i32gather_ps(p, at.l, 4), _mm256_i32gather_ps(p, at.h, 4));
}

static inline __m256 lookup_half(const float table[16], __m256i index) {
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), index);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table + 8), index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
}

/// table[index mod 16] per lane.
static inline wf wf_lookup(const float table[16], wi index) {
    return PAIR(wf, lookup_half(table, index.l), lookup_half(table, index.h));
}

static inline __m256 lookup32_half(const float table[32], __m256i index) {
    const __m256 low = lookup_half(table, index), high = lookup_half(table + 16, index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 27)));
}

/// table[index mod 32] per lane.
static inline wf wf_lookup32(const float table[32], wi index) {
    return PAIR(wf, lookup32_half(table, index.l), lookup32_half(table, index.h));
}

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) {
    wf result;
    result.l = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + stride), 1);
    result.h = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 2 * stride)),
                                    _mm_loadu_ps(p + 3 * stride), 1);
    return result;
}

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    _mm_storeu_si128((__m128i *)(void *)out, _mm256_castsi256_si128(a.l));
    _mm_storeu_si128((__m128i *)(void *)(out + stride_bytes), _mm256_extracti128_si256(a.l, 1));
    _mm_storeu_si128((__m128i *)(void *)(out + 2 * stride_bytes), _mm256_castsi256_si128(a.h));
    _mm_storeu_si128((__m128i *)(void *)(out + 3 * stride_bytes), _mm256_extracti128_si256(a.h, 1));
}

static inline void transpose_8x8(__m256 r[8]) {
    __m256 t[8];
    for (int i = 0; i < 8; i += 2) {
        t[i] = _mm256_unpacklo_ps(r[i], r[i + 1]);
        t[i + 1] = _mm256_unpackhi_ps(r[i], r[i + 1]);
    }
    for (int i = 0; i < 8; i += 4) {
        r[i] = _mm256_shuffle_ps(t[i], t[i + 2], 0x44);
        r[i + 1] = _mm256_shuffle_ps(t[i], t[i + 2], 0xee);
        r[i + 2] = _mm256_shuffle_ps(t[i + 1], t[i + 3], 0x44);
        r[i + 3] = _mm256_shuffle_ps(t[i + 1], t[i + 3], 0xee);
    }
    for (int i = 0; i < 4; i++) {
        t[i] = _mm256_permute2f128_ps(r[i], r[i + 4], 0x20);
        t[i + 4] = _mm256_permute2f128_ps(r[i], r[i + 4], 0x31);
    }
    for (int i = 0; i < 8; i++) r[i] = t[i];
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
static inline void w_transpose(wf rows[16]) {
    __m256 a[8], b[8], c[8], d[8];
    for (int i = 0; i < 8; i++)
        a[i] = rows[i].l, b[i] = rows[i].h, c[i] = rows[8 + i].l, d[i] = rows[8 + i].h;
    transpose_8x8(a);
    transpose_8x8(b);
    transpose_8x8(c);
    transpose_8x8(d);
    for (int i = 0; i < 8; i++) rows[i] = PAIR(wf, a[i], c[i]), rows[8 + i] = PAIR(wf, b[i], d[i]);
}

static inline void store4_half(float *out, __m256 a, __m256 b, __m256 c, __m256 d) {
    const __m256 ab_l = _mm256_unpacklo_ps(a, b), ab_h = _mm256_unpackhi_ps(a, b);
    const __m256 cd_l = _mm256_unpacklo_ps(c, d), cd_h = _mm256_unpackhi_ps(c, d);
    const __m256 r0 = _mm256_shuffle_ps(ab_l, cd_l, 0x44), r1 = _mm256_shuffle_ps(ab_l, cd_l, 0xee);
    const __m256 r2 = _mm256_shuffle_ps(ab_h, cd_h, 0x44), r3 = _mm256_shuffle_ps(ab_h, cd_h, 0xee);
    _mm256_storeu_ps(out, _mm256_permute2f128_ps(r0, r1, 0x20));
    _mm256_storeu_ps(out + 8, _mm256_permute2f128_ps(r2, r3, 0x20));
    _mm256_storeu_ps(out + 16, _mm256_permute2f128_ps(r0, r1, 0x31));
    _mm256_storeu_ps(out + 24, _mm256_permute2f128_ps(r2, r3, 0x31));
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
static inline void w_store4(float *out, wf a, wf b, wf c, wf d) {
    store4_half(out, a.l, b.l, c.l, d.l);
    store4_half(out + 32, a.h, b.h, c.h, d.h);
}

/// p[0..3] over and over.
static inline wf wf_repeat4(const float *p) {
    const __m256 a = _mm256_broadcast_ps((const __m128 *)(const void *)p);
    return PAIR(wf, a, a);
}

/// p[0] four times, p[1] four times, p[2], p[3].
static inline wf wf_spread4(const float *p) {
    const __m256 a = _mm256_broadcast_ps((const __m128 *)(const void *)p);
    return PAIR(wf, _mm256_permutevar8x32_ps(a, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1)),
                _mm256_permutevar8x32_ps(a, _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3)));
}

/// The pixels of two rows of four, by channel.
static inline void load4_half(const float *p, const float *q, __m256 out[4]) {
    __m256 at[4];
    for (int i = 0; i < 4; i++) at[i] = _mm256_set_m128(_mm_loadu_ps(q + 4 * i), _mm_loadu_ps(p + 4 * i));
    const __m256 ab_l = _mm256_unpacklo_ps(at[0], at[1]), ab_h = _mm256_unpackhi_ps(at[0], at[1]);
    const __m256 cd_l = _mm256_unpacklo_ps(at[2], at[3]), cd_h = _mm256_unpackhi_ps(at[2], at[3]);
    out[0] = _mm256_shuffle_ps(ab_l, cd_l, 0x44);
    out[1] = _mm256_shuffle_ps(ab_l, cd_l, 0xee);
    out[2] = _mm256_shuffle_ps(ab_h, cd_h, 0x44);
    out[3] = _mm256_shuffle_ps(ab_h, cd_h, 0xee);
}

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
static inline void w_load4(const float *p, size_t stride, wf out[4]) {
    __m256 l[4], h[4];
    load4_half(p, p + stride, l);
    load4_half(p + 2 * stride, p + 3 * stride, h);
    for (int c = 0; c < 4; c++) out[c] = PAIR(wf, l[c], h[c]);
}

#undef PAIR
#undef UNARY
#undef BINARY
