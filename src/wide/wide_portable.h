// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask as four vectors of GCC and Clang, which become whatever vectors there
// are (SSE2 on any x86-64). See wide.h for what each operation means.
//
// Without a fused multiply-add in the base instruction set (wide_fused.h) what takes many instructions is a
// function.
#include <math.h>
#include <string.h>

// Where every operation is many instructions, unrolled copies only cost time to compile.
#define ALWAYS_INLINE inline
#define UNROLL_COLUMNS

#if defined(__FP_FAST_FMAF)
#define FUSED static inline __attribute__((unused))
#else
#define FUSED static __attribute__((noinline, unused))
#endif

#define QUARTER(i, expression)                                                                               \
    {                                                                                                        \
        enum { n = i };                                                                                      \
        result.q[i] = (expression);                                                                          \
    }
/// A value of the type whose quarters are `expression` of n = 0 .. 3.
#define QUARTERS(type, expression)                                                                           \
    type result;                                                                                             \
    QUARTER(0, expression)                                                                                   \
    QUARTER(1, expression)                                                                                   \
    QUARTER(2, expression)                                                                                   \
    QUARTER(3, expression)                                                                                   \
    return result
/// Likewise of lanes, of i = 0 .. 15, by a plain array: compilers make vectors of such a loop where there is
/// an instruction.
#define LANES(type, number, expression)                                                                      \
    number lane[16];                                                                                         \
    for (int i = 0; i < 16; i++) lane[i] = (expression);                                                     \
    type result;                                                                                             \
    memcpy(&result, lane, sizeof result);                                                                    \
    return result
/// Lane i.
#define LANE(a, i) (a).q[(i) >> 2][(i)&3]

#include "wide/wide_vectors.h"

static inline wf wf_set(float a) { QUARTERS(wf, ((w4f){a, a, a, a})); }
static inline wf wf_min(wf a, wf b) { QUARTERS(wf, w4f_select(a.q[n] < b.q[n], a.q[n], b.q[n])); }
static inline wf wf_max(wf a, wf b) { QUARTERS(wf, w4f_select(a.q[n] > b.q[n], a.q[n], b.q[n])); }
static inline wf wf_abs(wf a) { QUARTERS(wf, (w4f)((w4i)a.q[n] & 0x7fffffff)); }
static inline wf wf_from_i(wi a) { QUARTERS(wf, __builtin_convertvector(a.q[n], w4f)); }
static inline wi wi_from_f(wf a) { QUARTERS(wi, __builtin_convertvector(a.q[n], w4i)); }
#if defined(__FP_FAST_FMAF)
FUSED wf wf_fma(wf a, wf b, wf c) {
    float x[16], y[16], z[16];
    wf_store(x, a), wf_store(y, b), wf_store(z, c);
    LANES(wf, float, fmaf(x[i], y[i], z[i]));
}
FUSED wf wf_floor(wf a) { LANES(wf, float, floorf(LANE(a, i))); }
static inline w8 w8_fma(w8 a, w8 b, w8 c) {
    const wf sum = wf_fma((wf){{a.l, a.h}}, (wf){{b.l, b.h}}, (wf){{c.l, c.h}});
    return (w8){sum.q[0], sum.q[1]};
}
#else
#include "wide/wide_fused.h"

/// From 2^23 on floats are whole numbers. A floor of 0 keeps its sign.
static inline w4f w4f_floor(w4f a) {
    const w4i sign = (w4i)a & INT32_MIN, bits = (w4i)a & 0x7fffffff, fraction = bits < 0x4b000000;
    const w4f cut = __builtin_convertvector(__builtin_convertvector((w4f)((w4i)a & fraction), w4i), w4f);
    const w4f down = cut - (w4f)((cut > a) & (w4i)(w4f){1, 1, 1, 1});
    return w4f_select(fraction, (w4f)((w4i)down | sign), a);
}
static inline wf wf_floor(wf a) { QUARTERS(wf, w4f_floor(a.q[n])); }
#endif
static inline wf wf_fnma(wf a, wf b, wf c) {
    for (int i = 0; i < 4; i++) a.q[i] = -a.q[i];
    return wf_fma(a, b, c);
}

static inline wi wi_set(int32_t a) { QUARTERS(wi, ((w4i){a, a, a, a})); }
static inline void wi_store_u8(uint8_t *p, wi a) {
    for (int i = 0; i < 16; i++) p[i] = (uint8_t)LANE(a, i);
}
FUSED wi wi_load_u16(const uint16_t *p) { LANES(wi, int32_t, p[i]); }
FUSED wi wi_load_i16(const int16_t *p) { LANES(wi, int32_t, p[i]); }
static inline wi wi_min(wi a, wi b) { QUARTERS(wi, w4i_select(a.q[n] < b.q[n], a.q[n], b.q[n])); }
static inline wi wi_max(wi a, wi b) { QUARTERS(wi, w4i_select(a.q[n] > b.q[n], a.q[n], b.q[n])); }
static inline wi wi_shl(wi a, int count) { QUARTERS(wi, (w4i)((w4u)a.q[n] << count)); }
static inline wi wi_sar(wi a, int count) { QUARTERS(wi, a.q[n] >> count); }

static inline uint32_t wm_bits(wm a) {
    const w4i all = (a.q[0] & (w4i){1, 2, 4, 8}) | (a.q[1] & (w4i){16, 32, 64, 128}) |
                   (a.q[2] & (w4i){256, 512, 1024, 2048}) | (a.q[3] & (w4i){4096, 8192, 16384, 32768});
    return (uint32_t)(all[0] | all[1] | all[2] | all[3]);
}
static inline wm wm_of_bits(uint32_t bits) {
    const int32_t b = (int32_t)bits;
    QUARTERS(wm, ((w4i){b, b, b, b} & (w4i){1 << 4 * n, 2 << 4 * n, 4 << 4 * n, 8 << 4 * n}) != 0);
}
FUSED wf wf_sqrt(wf a) { LANES(wf, float, sqrtf(LANE(a, i))); }

/// p[at] per lane.
FUSED wf wf_gather(const float *p, wi at) { LANES(wf, float, p[LANE(at, i)]); }

/// table[index mod 16] per lane.
FUSED wf wf_lookup(const float table[16], wi index) { LANES(wf, float, table[LANE(index, i) & 15]); }

/// table[index mod 32] per lane.
FUSED wf wf_lookup32(const float table[32], wi index) { LANES(wf, float, table[LANE(index, i) & 31]); }

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) { QUARTERS(wf, w4f_load(p + n * stride)); }

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    for (size_t i = 0; i < 4; i++) memcpy(out + i * stride_bytes, &a.q[i], 16);
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
FUSED void w_transpose(wf rows[16]) {
    for (int i = 0; i < 16; i++) {
        for (int j = 0; j < i; j++) {
            const float swap = LANE(rows[i], j);
            LANE(rows[i], j) = LANE(rows[j], i);
            LANE(rows[j], i) = swap;
        }
    }
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
FUSED void w_store4(float *out, wf a, wf b, wf c, wf d) {
    for (int i = 0; i < 16; i++, out += 4) {
        out[0] = LANE(a, i);
        out[1] = LANE(b, i);
        out[2] = LANE(c, i);
        out[3] = LANE(d, i);
    }
}

/// p[0] four times, p[1] four times, p[2], p[3].
static inline wf wf_spread4(const float *p) { QUARTERS(wf, ((w4f){p[n], p[n], p[n], p[n]})); }

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
FUSED void w_load4(const float *p, size_t stride, wf out[4]) {
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < 16; i++) LANE(out[c], i) = p[(size_t)(i >> 2) * stride + (size_t)(4 * (i & 3) + c)];
}

static inline w8 w8_set(float a) { return (w8){(w4f){a, a, a, a}, (w4f){a, a, a, a}}; }

/// p[0..3], q[0..2], 0; reads q[3].
static inline w8 w8_join(const float *p, const float *q) {
    return (w8){w4f_load(p), (w4f){q[0], q[1], q[2], 0}};
}

#undef QUARTER
#undef QUARTERS
#undef LANE
#undef LANES
#undef FUSED
