// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask as four vectors of WebAssembly's SIMD each. See wide.h for what each
// operation means.
//
// A fused multiply-add is among the relaxed instructions, which round once or twice as the host likes: a library that has
// them (-mrelaxed-simd) runs only where they round once (base/relaxed.h). Else sums are made exact as in portable C.
#include <math.h>
#include <string.h>
#include <wasm_simd128.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))
// The four vectors of a sixteen do not wait for each other: unrolled copies would only spill them.
#define UNROLL_COLUMNS

/// A value of the type whose quarters are `expression` of n = 0 .. 3.
#define QUARTERS(type, expression)                                                                           \
    type result;                                                                                             \
    _Pragma("clang loop unroll(full)") for (int n = 0; n < 4; n++) result.q[n] = (expression);               \
    return result

#include "wide/wide_vectors.h"

static inline wf wf_set(float a) { QUARTERS(wf, (w4f)wasm_f32x4_splat(a)); }
static inline wf wf_sqrt(wf a) { QUARTERS(wf, (w4f)wasm_f32x4_sqrt((v128_t)a.q[n])); }
static inline wf wf_floor(wf a) { QUARTERS(wf, (w4f)wasm_f32x4_floor((v128_t)a.q[n])); }
static inline wf wf_abs(wf a) { QUARTERS(wf, (w4f)wasm_f32x4_abs((v128_t)a.q[n])); }
// pmin(x, y) is y < x ? y : x, and pmax(x, y) is x < y ? y : x.
static inline wf wf_min(wf a, wf b) { QUARTERS(wf, (w4f)wasm_f32x4_pmin((v128_t)b.q[n], (v128_t)a.q[n])); }
static inline wf wf_max(wf a, wf b) { QUARTERS(wf, (w4f)wasm_f32x4_pmax((v128_t)b.q[n], (v128_t)a.q[n])); }
static inline wf wf_from_i(wi a) { QUARTERS(wf, (w4f)wasm_f32x4_convert_i32x4((v128_t)a.q[n])); }
static inline wi wi_from_f(wf a) { QUARTERS(wi, (w4i)wasm_i32x4_trunc_sat_f32x4((v128_t)a.q[n])); }

#if defined(__wasm_relaxed_simd__)
static inline w4f w4f_fma(w4f a, w4f b, w4f c) {
    return (w4f)wasm_f32x4_relaxed_madd((v128_t)a, (v128_t)b, (v128_t)c);
}
static inline wf wf_fma(wf a, wf b, wf c) { QUARTERS(wf, w4f_fma(a.q[n], b.q[n], c.q[n])); }
static inline wf wf_fnma(wf a, wf b, wf c) {
    QUARTERS(wf, (w4f)wasm_f32x4_relaxed_nmadd((v128_t)a.q[n], (v128_t)b.q[n], (v128_t)c.q[n]));
}
static inline w8 w8_fma(w8 a, w8 b, w8 c) { return (w8){w4f_fma(a.l, b.l, c.l), w4f_fma(a.h, b.h, c.h)}; }
#else
// By the vectors of one quarter: those of sixteen lanes would go through memory.
#define FUSED static __attribute__((noinline, unused))
#include "wide/wide_fused.h"
#undef FUSED

static inline wf wf_fnma(wf a, wf b, wf c) {
    for (int i = 0; i < 4; i++) a.q[i] = -a.q[i];
    return wf_fma(a, b, c);
}
#endif

static inline wi wi_set(int32_t a) { QUARTERS(wi, (w4i)wasm_i32x4_splat(a)); }
/// Of values in [0, 255].
static inline void wi_store_u8(uint8_t *p, wi a) {
    const v128_t l = wasm_i16x8_narrow_i32x4((v128_t)a.q[0], (v128_t)a.q[1]);
    const v128_t h = wasm_i16x8_narrow_i32x4((v128_t)a.q[2], (v128_t)a.q[3]);
    wasm_v128_store(p, wasm_u8x16_narrow_i16x8(l, h));
}
static inline wi wi_load_u16(const uint16_t *p) { QUARTERS(wi, (w4i)wasm_u32x4_load16x4(p + 4 * n)); }
static inline wi wi_load_i16(const int16_t *p) { QUARTERS(wi, (w4i)wasm_i32x4_load16x4(p + 4 * n)); }
static inline wi wi_min(wi a, wi b) { QUARTERS(wi, (w4i)wasm_i32x4_min((v128_t)a.q[n], (v128_t)b.q[n])); }
static inline wi wi_max(wi a, wi b) { QUARTERS(wi, (w4i)wasm_i32x4_max((v128_t)a.q[n], (v128_t)b.q[n])); }
static inline wi wi_shl(wi a, int count) { QUARTERS(wi, (w4i)wasm_i32x4_shl((v128_t)a.q[n], (uint32_t)count)); }
static inline wi wi_sar(wi a, int count) { QUARTERS(wi, (w4i)wasm_i32x4_shr((v128_t)a.q[n], (uint32_t)count)); }

static inline uint32_t wm_bits(wm a) {
    const v128_t l = wasm_i16x8_narrow_i32x4((v128_t)a.q[0], (v128_t)a.q[1]);
    const v128_t h = wasm_i16x8_narrow_i32x4((v128_t)a.q[2], (v128_t)a.q[3]);
    return wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(l, h));
}
static inline wm wm_of_bits(uint32_t bits) {
    const w4i all = (w4i)wasm_i32x4_splat((int32_t)bits);
    QUARTERS(wm, (all & (w4i){1 << 4 * n, 2 << 4 * n, 4 << 4 * n, 8 << 4 * n}) != 0);
}

/// p[at] per lane.
static inline wf wf_gather(const float *p, wi at) {
    QUARTERS(wf, ((w4f){p[at.q[n][0]], p[at.q[n][1]], p[at.q[n][2]], p[at.q[n][3]]}));
}

/// table[index mod count] per lane, for a count that is a power of two.
static inline wf wf_gather_masked(const float *table, wi index, int32_t count) {
    return wf_gather(table, wi_and(index, wi_set(count - 1)));
}
static inline wf wf_lookup(const float table[16], wi index) { return wf_gather_masked(table, index, 16); }
static inline wf wf_lookup32(const float table[32], wi index) { return wf_gather_masked(table, index, 32); }

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) { QUARTERS(wf, w4f_load(p + (size_t)n * stride)); }

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    for (size_t i = 0; i < 4; i++) wasm_v128_store(out + i * stride_bytes, (v128_t)a.q[i]);
}

static inline void transpose_4x4(const w4f in[4], w4f out[4]) {
    const w4f ab_low = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5), ab_high = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7);
    const w4f cd_low = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5), cd_high = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
    out[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    out[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    out[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
static inline void w_transpose(wf rows[16]) {
    wf turned[16];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            const w4f in[4] = {rows[4 * i].q[j], rows[4 * i + 1].q[j], rows[4 * i + 2].q[j], rows[4 * i + 3].q[j]};
            w4f out[4];
            transpose_4x4(in, out);
            for (int k = 0; k < 4; k++) turned[4 * j + k].q[i] = out[k];
        }
    }
    for (int i = 0; i < 16; i++) rows[i] = turned[i];
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
static inline void w_store4(float *out, wf a, wf b, wf c, wf d) {
    for (int i = 0; i < 4; i++) {
        const w4f in[4] = {a.q[i], b.q[i], c.q[i], d.q[i]};
        w4f turned[4];
        transpose_4x4(in, turned);
        memcpy(out + 16 * i, turned, sizeof turned);
    }
}

/// p[0] four times, p[1] four times, p[2], p[3].
static inline wf wf_spread4(const float *p) { QUARTERS(wf, (w4f)wasm_f32x4_splat(p[n])); }

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
static inline void w_load4(const float *p, size_t stride, wf out[4]) {
    for (size_t i = 0; i < 4; i++) {
        const float *row = p + i * stride;
        const w4f in[4] = {w4f_load(row), w4f_load(row + 4), w4f_load(row + 8), w4f_load(row + 12)};
        w4f turned[4];
        transpose_4x4(in, turned);
        for (int c = 0; c < 4; c++) out[c].q[i] = turned[c];
    }
}

static inline w8 w8_set(float a) { return (w8){(w4f)wasm_f32x4_splat(a), (w4f)wasm_f32x4_splat(a)}; }

/// p[0..3], q[0..2], 0; reads q[3].
static inline w8 w8_join(const float *p, const float *q) {
    return (w8){w4f_load(p), (w4f)wasm_f32x4_replace_lane(wasm_v128_load(q), 3, 0)};
}

#undef QUARTERS
