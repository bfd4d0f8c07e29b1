// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask as four NEON registers each (64-bit Arm). See wide.h for what each
// operation means.
#include <arm_neon.h>

// With the checks of a sanitizer, inlined copies take minutes to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALWAYS_INLINE inline
#else
#define ALWAYS_INLINE inline __attribute__((always_inline))
#endif
// The four registers of a sixteen do not wait for each other: unrolled copies would only spill them.
#define UNROLL_COLUMNS

typedef struct wf {
    float32x4_t q[4];
} wf;
typedef struct wi {
    int32x4_t q[4];
} wi;
typedef struct wm {
    uint32x4_t q[4];
} wm;

/// Sixteens that go through a long chain of steps at once: the registers hold one.
enum { WIDE_TOGETHER = 1 };

#define NULLARY(type, value)  ((type){{(value), (value), (value), (value)}})
#define UNARY(type, f, a)     ((type){{f((a).q[0]), f((a).q[1]), f((a).q[2]), f((a).q[3])}})
#define BINARY(type, f, a, b)                                                                                \
    ((type){{f((a).q[0], (b).q[0]), f((a).q[1], (b).q[1]), f((a).q[2], (b).q[2]), f((a).q[3], (b).q[3])}})
#define TERNARY(type, f, a, b, c)                                                                            \
    ((type){{f((a).q[0], (b).q[0], (c).q[0]), f((a).q[1], (b).q[1], (c).q[1]),                               \
             f((a).q[2], (b).q[2], (c).q[2]), f((a).q[3], (b).q[3], (c).q[3])}})

static inline wf wf_set(float a) { return NULLARY(wf, vdupq_n_f32(a)); }
static inline wf wf_load(const float *p) {
    return (wf){{vld1q_f32(p), vld1q_f32(p + 4), vld1q_f32(p + 8), vld1q_f32(p + 12)}};
}
static inline void wf_store(float *p, wf a) {
    for (int i = 0; i < 4; i++) vst1q_f32(p + 4 * i, a.q[i]);
}
static inline wf wf_add(wf a, wf b) { return BINARY(wf, vaddq_f32, a, b); }
static inline wf wf_sub(wf a, wf b) { return BINARY(wf, vsubq_f32, a, b); }
static inline wf wf_mul(wf a, wf b) { return BINARY(wf, vmulq_f32, a, b); }
static inline wf wf_div(wf a, wf b) { return BINARY(wf, vdivq_f32, a, b); }
static inline wf wf_sqrt(wf a) { return UNARY(wf, vsqrtq_f32, a); }
static inline wf wf_abs(wf a) { return UNARY(wf, vabsq_f32, a); }
static inline wf wf_fma(wf a, wf b, wf c) { return TERNARY(wf, vfmaq_f32, c, a, b); }
static inline wf wf_fnma(wf a, wf b, wf c) { return TERNARY(wf, vfmsq_f32, c, a, b); }
static inline wf wf_floor(wf a) { return UNARY(wf, vrndmq_f32, a); }
static inline wf wf_from_i(wi a) { return UNARY(wf, vcvtq_f32_s32, a); }
static inline wi wi_from_f(wf a) { return UNARY(wi, vcvtq_s32_f32, a); }
static inline wf wf_of_bits(wi a) { return UNARY(wf, vreinterpretq_f32_s32, a); }
static inline wi wi_of_bits(wf a) { return UNARY(wi, vreinterpretq_s32_f32, a); }
static inline wm wf_lt(wf a, wf b) { return BINARY(wm, vcltq_f32, a, b); }
static inline wm wf_le(wf a, wf b) { return BINARY(wm, vcleq_f32, a, b); }
static inline wf wf_select(wm m, wf a, wf b) { return TERNARY(wf, vbslq_f32, m, a, b); }
static inline wf wf_keep(wm m, wf a) { return wf_select(m, a, wf_set(0)); }
// NEON's own minimum and maximum give NaN where either is.
static inline wf wf_min(wf a, wf b) { return wf_select(wf_lt(a, b), a, b); }
static inline wf wf_max(wf a, wf b) { return wf_select(wf_lt(b, a), a, b); }

static inline wi wi_set(int32_t a) { return NULLARY(wi, vdupq_n_s32(a)); }
static inline wi wi_load(const int32_t *p) {
    return (wi){{vld1q_s32(p), vld1q_s32(p + 4), vld1q_s32(p + 8), vld1q_s32(p + 12)}};
}
static inline void wi_store(int32_t *p, wi a) {
    for (int i = 0; i < 4; i++) vst1q_s32(p + 4 * i, a.q[i]);
}
/// Of values in [0, 255].
static inline void wi_store_u8(uint8_t *p, wi a) {
    const int16x8_t l = vcombine_s16(vmovn_s32(a.q[0]), vmovn_s32(a.q[1]));
    const int16x8_t h = vcombine_s16(vmovn_s32(a.q[2]), vmovn_s32(a.q[3]));
    vst1q_u8(p, vreinterpretq_u8_s8(vcombine_s8(vmovn_s16(l), vmovn_s16(h))));
}
static inline wi wi_load_u16(const uint16_t *p) {
    wi result;
    for (int i = 0; i < 4; i++) result.q[i] = vreinterpretq_s32_u32(vmovl_u16(vld1_u16(p + 4 * i)));
    return result;
}
static inline wi wi_load_i16(const int16_t *p) {
    wi result;
    for (int i = 0; i < 4; i++) result.q[i] = vmovl_s16(vld1_s16(p + 4 * i));
    return result;
}
static inline wi wi_add(wi a, wi b) { return BINARY(wi, vaddq_s32, a, b); }
static inline wi wi_sub(wi a, wi b) { return BINARY(wi, vsubq_s32, a, b); }
static inline wi wi_min(wi a, wi b) { return BINARY(wi, vminq_s32, a, b); }
static inline wi wi_max(wi a, wi b) { return BINARY(wi, vmaxq_s32, a, b); }
static inline wi wi_or(wi a, wi b) { return BINARY(wi, vorrq_s32, a, b); }
static inline wi wi_and(wi a, wi b) { return BINARY(wi, vandq_s32, a, b); }
static inline wi wi_shl(wi a, int n) { return BINARY(wi, vshlq_s32, a, wi_set(n)); }
static inline wi wi_sar(wi a, int n) { return BINARY(wi, vshlq_s32, a, wi_set(-n)); }

static inline wm wm_and(wm a, wm b) { return BINARY(wm, vandq_u32, a, b); }
static inline wm wm_or(wm a, wm b) { return BINARY(wm, vorrq_u32, a, b); }
static inline wm wm_not(wm a) { return UNARY(wm, vmvnq_u32, a); }

/// One bit a lane, at the lane's place.
static inline wm lane_bits(void) {
    return (wm){{(uint32x4_t){1u << 0, 1u << 1, 1u << 2, 1u << 3}, (uint32x4_t){1u << 4, 1u << 5, 1u << 6, 1u << 7},
                 (uint32x4_t){1u << 8, 1u << 9, 1u << 10, 1u << 11},
                 (uint32x4_t){1u << 12, 1u << 13, 1u << 14, 1u << 15}}};
}
static inline uint32_t wm_bits(wm a) {
    const wm bits = wm_and(a, lane_bits());
    return vaddvq_u32(vorrq_u32(vorrq_u32(bits.q[0], bits.q[1]), vorrq_u32(bits.q[2], bits.q[3])));
}
static inline wm wm_of_bits(uint32_t bits) {
    const wm lane = lane_bits(), all = NULLARY(wm, vdupq_n_u32(bits));
    return BINARY(wm, vtstq_u32, all, lane);
}

/// p[at] per lane.
static inline wf wf_gather(const float *p, wi at) {
    int32_t index[16];
    float lanes[16];
    wi_store(index, at);
    for (int i = 0; i < 16; i++) lanes[i] = p[index[i]];
    return wf_load(lanes);
}

/// The places of the four bytes of table[index mod count] for a count that is a power of two, up to 64.
static inline uint8x16_t bytes_of(int32x4_t index, int32_t count) {
    const int32x4_t first = vandq_s32(index, vdupq_n_s32(count - 1));
    return vreinterpretq_u8_s32(vmlaq_s32(vdupq_n_s32(0x03020100), first, vdupq_n_s32(0x04040404)));
}

static inline uint8x16x4_t sixteen_of(const float *table) {
    return (uint8x16x4_t){{vreinterpretq_u8_f32(vld1q_f32(table)), vreinterpretq_u8_f32(vld1q_f32(table + 4)),
                           vreinterpretq_u8_f32(vld1q_f32(table + 8)), vreinterpretq_u8_f32(vld1q_f32(table + 12))}};
}

/// table[index mod 16] per lane.
static inline wf wf_lookup(const float table[16], wi index) {
    const uint8x16x4_t all = sixteen_of(table);
    wf result;
    for (int i = 0; i < 4; i++)
        result.q[i] = vreinterpretq_f32_u8(vqtbl4q_u8(all, bytes_of(index.q[i], 16)));
    return result;
}

/// table[index mod 32] per lane.
static inline wf wf_lookup32(const float table[32], wi index) {
    const uint8x16x4_t low = sixteen_of(table), high = sixteen_of(table + 16);
    wf result;
    for (int i = 0; i < 4; i++) {
        const uint8x16_t at = bytes_of(index.q[i], 32);
        // Places outside of the table: the first lookup gives 0 there, the second leaves what is.
        const uint8x16_t found = vqtbx4q_u8(vqtbl4q_u8(low, at), high, vsubq_u8(at, vdupq_n_u8(64)));
        result.q[i] = vreinterpretq_f32_u8(found);
    }
    return result;
}

/// Lanes 4 i .. 4 i + 3 from p + i stride numbers.
static inline wf wf_load_rows(const float *p, size_t stride) {
    return (wf){{vld1q_f32(p), vld1q_f32(p + stride), vld1q_f32(p + 2 * stride), vld1q_f32(p + 3 * stride)}};
}

/// Writes lanes 4 i .. 4 i + 3 to out + i stride_bytes.
static inline void wi_store_rows(uint8_t *out, size_t stride_bytes, wi a) {
    for (size_t i = 0; i < 4; i++) vst1q_u8(out + i * stride_bytes, vreinterpretq_u8_s32(a.q[i]));
}

static inline void transpose_4x4(const float32x4_t in[4], float32x4_t out[4]) {
    const float32x4x2_t ab = vtrnq_f32(in[0], in[1]), cd = vtrnq_f32(in[2], in[3]);
    out[0] = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));
    out[1] = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));
    out[2] = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));
    out[3] = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));
}

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
static inline void w_transpose(wf rows[16]) {
    wf turned[16];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            const float32x4_t in[4] = {rows[4 * i].q[j], rows[4 * i + 1].q[j], rows[4 * i + 2].q[j],
                                       rows[4 * i + 3].q[j]};
            float32x4_t out[4];
            transpose_4x4(in, out);
            for (int k = 0; k < 4; k++) turned[4 * j + k].q[i] = out[k];
        }
    }
    for (int i = 0; i < 16; i++) rows[i] = turned[i];
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
static inline void w_store4(float *out, wf a, wf b, wf c, wf d) {
    for (int i = 0; i < 4; i++)
        vst4q_f32(out + 16 * i, ((float32x4x4_t){{a.q[i], b.q[i], c.q[i], d.q[i]}}));
}

/// p[0..3] over and over.
static inline wf wf_repeat4(const float *p) { return NULLARY(wf, vld1q_f32(p)); }

/// p[0] four times, p[1] four times, p[2], p[3].
static inline wf wf_spread4(const float *p) {
    return (wf){{vdupq_n_f32(p[0]), vdupq_n_f32(p[1]), vdupq_n_f32(p[2]), vdupq_n_f32(p[3])}};
}

/// What w_store4() wrote, from four rows of 16 numbers: lane 4 i + j of out[c] = p[i stride + 4 j + c].
static inline void w_load4(const float *p, size_t stride, wf out[4]) {
    for (size_t i = 0; i < 4; i++) {
        const float32x4x4_t row = vld4q_f32(p + i * stride);
        for (int c = 0; c < 4; c++) out[c].q[i] = row.val[c];
    }
}

/// Eight lanes, for the numbers of one pixel.
typedef struct w8 {
    float32x4_t l, h;
} w8;

static inline w8 w8_set(float a) { return (w8){vdupq_n_f32(a), vdupq_n_f32(a)}; }
static inline w8 w8_load(const float *p) { return (w8){vld1q_f32(p), vld1q_f32(p + 4)}; }
static inline void w8_store(float *p, w8 a) {
    vst1q_f32(p, a.l);
    vst1q_f32(p + 4, a.h);
}
static inline w8 w8_fma(w8 a, w8 b, w8 c) { return (w8){vfmaq_f32(c.l, a.l, b.l), vfmaq_f32(c.h, a.h, b.h)}; }

/// p[0..3], q[0..2], 0; reads q[3].
static inline w8 w8_join(const float *p, const float *q) {
    return (w8){vld1q_f32(p), vsetq_lane_f32(0, vld1q_f32(q), 3)};
}

#undef NULLARY
#undef UNARY
#undef BINARY
#undef TERNARY
