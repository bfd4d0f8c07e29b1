// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask in C with the vector types of GCC and Clang, which become whatever
// vectors there are (NEON on 64-bit Arm, SSE2 on any x86-64). See wide.h for what each operation means.
//
// Without a fused multiply-add in the base instruction set every lane is a call of fmaf(): those operations
// are functions then.
#include <math.h>
#include <string.h>

// Where every operation is many instructions, unrolled copies only cost time to compile.
#define ALWAYS_INLINE inline
#define UNROLL_COLUMNS

typedef float wf __attribute__((vector_size(64)));
typedef int32_t wi __attribute__((vector_size(64)));
typedef int32_t wm __attribute__((vector_size(64)));  // -1 or 0
typedef uint32_t wu __attribute__((vector_size(64))); // for what wraps

/// Sixteens that go through a long chain of steps at once: the registers hold one.
enum { WIDE_TOGETHER = 1 };

#if defined(__FP_FAST_FMAF)
#define FUSED static inline __attribute__((unused))
#else
#define FUSED static __attribute__((noinline, unused))
#endif

#define EACH(type, expression)                                                                               \
    type result;                                                                                             \
    for (int i = 0; i < 16; i++) result[i] = (expression);                                                   \
    return result

static inline wf wf_set(float a) { return (wf){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a}; }
static inline wf wf_load(const float *p) {
    wf result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline void wf_store(float *p, wf a) { memcpy(p, &a, sizeof a); }
static inline wf wf_of_bits(wi a) { return (wf)a; }
static inline wi wi_of_bits(wf a) { return (wi)a; }
static inline wf wf_add(wf a, wf b) { return a + b; }
static inline wf wf_sub(wf a, wf b) { return a - b; }
static inline wf wf_mul(wf a, wf b) { return a * b; }
static inline wf wf_div(wf a, wf b) { return a / b; }
static inline wm wf_lt(wf a, wf b) { return a < b; }
static inline wm wf_le(wf a, wf b) { return a <= b; }
static inline wf wf_select(wm m, wf a, wf b) { return (wf)((m & (wi)a) | (~m & (wi)b)); }
static inline wf wf_keep(wm m, wf a) { return (wf)(m & (wi)a); }
static inline wf wf_min(wf a, wf b) { return wf_select(a < b, a, b); }
static inline wf wf_max(wf a, wf b) { return wf_select(a > b, a, b); }
static inline wf wf_from_i(wi a) { return __builtin_convertvector(a, wf); }
static inline wi wi_from_f(wf a) { return __builtin_convertvector(a, wi); }
FUSED wf wf_fma(wf a, wf b, wf c) { EACH(wf, fmaf(a[i], b[i], c[i])); }
FUSED wf wf_fnma(wf a, wf b, wf c) { EACH(wf, fmaf(-a[i], b[i], c[i])); }
FUSED wf wf_floor(wf a) { EACH(wf, floorf(a[i])); }

static inline wi wi_set(int32_t a) { return (wi){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a}; }
static inline wf wf_abs(wf a) { return (wf)((wi)a & wi_set(0x7fffffff)); }
static inline wi wi_load(const int32_t *p) {
    wi result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline void wi_store(int32_t *p, wi a) { memcpy(p, &a, sizeof a); }
static inline void wi_store_u8(uint8_t *p, wi a) {
    for (int i = 0; i < 16; i++) p[i] = (uint8_t)a[i];
}
FUSED wi wi_load_u16(const uint16_t *p) { EACH(wi, p[i]); }
FUSED wi wi_load_i16(const int16_t *p) { EACH(wi, p[i]); }
static inline wi wi_add(wi a, wi b) { return (wi)((wu)a + (wu)b); }
static inline wi wi_sub(wi a, wi b) { return (wi)((wu)a - (wu)b); }
static inline wi wi_min(wi a, wi b) { return ((a < b) & a) | (~(a < b) & b); }
static inline wi wi_max(wi a, wi b) { return ((a > b) & a) | (~(a > b) & b); }
static inline wi wi_or(wi a, wi b) { return a | b; }
static inline wi wi_and(wi a, wi b) { return a & b; }
static inline wi wi_shl(wi a, int n) { return (wi)((wu)a << n); }
static inline wi wi_sar(wi a, int n) { return a >> n; }

static inline wm wm_and(wm a, wm b) { return a & b; }
static inline wm wm_or(wm a, wm b) { return a | b; }
static inline wm wm_not(wm a) { return ~a; }
FUSED uint32_t wm_bits(wm a) {
    uint32_t bits = 0;
    for (int i = 0; i < 16; i++) bits |= (uint32_t)(a[i] & 1) << i;
    return bits;
}
FUSED wm wm_of_bits(uint32_t bits) { EACH(wm, -(int32_t)(bits >> i & 1)); }
FUSED wf wf_sqrt(wf a) { EACH(wf, sqrtf(a[i])); }

/// p[at] per lane.
FUSED wf wf_gather(const float *p, wi at) { EACH(wf, p[at[i]]); }

/// table[index mod 16] per lane.
FUSED wf wf_lookup(const float table[16], wi index) { EACH(wf, table[index[i] & 15]); }

/// table[index mod 32] per lane.
FUSED wf wf_lookup32(const float table[32], wi index) { EACH(wf, table[index[i] & 31]); }

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) {
    wf result;
    for (size_t i = 0; i < 4; i++) memcpy((char *)&result + 16 * i, p + i * stride, 16);
    return result;
}

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    for (size_t i = 0; i < 4; i++) memcpy(out + i * stride_bytes, (const char *)&a + 16 * i, 16);
}

/// Writes the lanes where m is set one after another; may write 16 numbers.
FUSED void wf_pack(float *p, wm m, wf a) {
    for (int i = 0; i < 16; i++) {
        *p = a[i];
        p -= m[i];
    }
}
FUSED void wi_pack(int32_t *p, wm m, wi a) {
    for (int i = 0; i < 16; i++) {
        *p = a[i];
        p -= m[i];
    }
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
FUSED void w_transpose(wf rows[16]) {
    for (int i = 0; i < 16; i++) {
        for (int j = 0; j < i; j++) {
            const float swap = rows[i][j];
            rows[i][j] = rows[j][i];
            rows[j][i] = swap;
        }
    }
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
FUSED void w_store4(float *out, wf a, wf b, wf c, wf d) {
    for (int i = 0; i < 16; i++, out += 4) {
        out[0] = a[i];
        out[1] = b[i];
        out[2] = c[i];
        out[3] = d[i];
    }
}

/// p[0..3] over and over.
FUSED wf wf_repeat4(const float *p) { EACH(wf, p[i & 3]); }

/// p[0] four times, p[1] four times, p[2], p[3].
FUSED wf wf_spread4(const float *p) { EACH(wf, p[i >> 2]); }

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
FUSED void w_load4(const float *p, size_t stride, wf out[4]) {
    for (size_t c = 0; c < 4; c++)
        for (size_t i = 0; i < 16; i++) out[c][i] = p[(i >> 2) * stride + 4 * (i & 3) + c];
}

/// Eight lanes, for the numbers of one pixel.
typedef float w8 __attribute__((vector_size(32)));

static inline w8 w8_set(float a) { return (w8){a, a, a, a, a, a, a, a}; }
static inline w8 w8_load(const float *p) {
    w8 result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline void w8_store(float *p, w8 a) { memcpy(p, &a, sizeof a); }
FUSED w8 w8_fma(w8 a, w8 b, w8 c) {
    w8 result;
    for (int i = 0; i < 8; i++) result[i] = fmaf(a[i], b[i], c[i]);
    return result;
}

/// p[0..3], q[0..2], 0; reads q[3].
static inline w8 w8_join(const float *p, const float *q) {
    return (w8){p[0], p[1], p[2], p[3], q[0], q[1], q[2], 0};
}

#undef EACH
#undef FUSED
