// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sixteen lanes of float, int and mask in plain C; compilers turn the loops into whatever vectors there are
// (NEON on 64-bit Arm). See wide.h for what each operation means.
#include <math.h>
#include <string.h>

typedef struct wf {
    float v[16];
} wf;
typedef struct wi {
    int32_t v[16];
} wi;
typedef struct wm {
    int32_t v[16]; // -1 or 0
} wm;

#define EACH(type, expression)                                                                               \
    type result;                                                                                             \
    for (int i = 0; i < 16; i++) result.v[i] = (expression);                                                 \
    return result

static inline wf wf_set(float a) { EACH(wf, a); }
static inline wf wf_load(const float *p) { EACH(wf, p[i]); }
static inline void wf_store(float *p, wf a) { memcpy(p, a.v, sizeof a.v); }
static inline wf wf_add(wf a, wf b) { EACH(wf, a.v[i] + b.v[i]); }
static inline wf wf_sub(wf a, wf b) { EACH(wf, a.v[i] - b.v[i]); }
static inline wf wf_mul(wf a, wf b) { EACH(wf, a.v[i] * b.v[i]); }
static inline wf wf_div(wf a, wf b) { EACH(wf, a.v[i] / b.v[i]); }
static inline wf wf_sqrt(wf a) { EACH(wf, sqrtf(a.v[i])); }
static inline wf wf_min(wf a, wf b) { EACH(wf, a.v[i] < b.v[i] ? a.v[i] : b.v[i]); }
static inline wf wf_max(wf a, wf b) { EACH(wf, a.v[i] > b.v[i] ? a.v[i] : b.v[i]); }
static inline wf wf_abs(wf a) { EACH(wf, fabsf(a.v[i])); }
static inline wf wf_fma(wf a, wf b, wf c) { EACH(wf, fmaf(a.v[i], b.v[i], c.v[i])); }
static inline wf wf_fnma(wf a, wf b, wf c) { EACH(wf, fmaf(-a.v[i], b.v[i], c.v[i])); }
static inline wf wf_floor(wf a) { EACH(wf, floorf(a.v[i])); }
static inline wf wf_from_i(wi a) { EACH(wf, (float)a.v[i]); }
static inline wi wi_from_f(wf a) { EACH(wi, (int32_t)a.v[i]); }
static inline wf wf_of_bits(wi a) {
    wf result;
    memcpy(result.v, a.v, sizeof a.v);
    return result;
}
static inline wi wi_of_bits(wf a) {
    wi result;
    memcpy(result.v, a.v, sizeof a.v);
    return result;
}
static inline wm wf_lt(wf a, wf b) { EACH(wm, -(int32_t)(a.v[i] < b.v[i])); }
static inline wm wf_le(wf a, wf b) { EACH(wm, -(int32_t)(a.v[i] <= b.v[i])); }
static inline wf wf_select(wm m, wf a, wf b) { EACH(wf, m.v[i] ? a.v[i] : b.v[i]); }
static inline wf wf_keep(wm m, wf a) { EACH(wf, m.v[i] ? a.v[i] : 0.0f); }

static inline wi wi_set(int32_t a) { EACH(wi, a); }
static inline void wi_store(int32_t *p, wi a) { memcpy(p, a.v, sizeof a.v); }
static inline wi wi_load_u16(const uint16_t *p) { EACH(wi, p[i]); }
static inline wi wi_load_i16(const int16_t *p) { EACH(wi, p[i]); }
static inline wi wi_add(wi a, wi b) { EACH(wi, a.v[i] + b.v[i]); }
static inline wi wi_sub(wi a, wi b) { EACH(wi, a.v[i] - b.v[i]); }
static inline wi wi_min(wi a, wi b) { EACH(wi, a.v[i] < b.v[i] ? a.v[i] : b.v[i]); }
static inline wi wi_max(wi a, wi b) { EACH(wi, a.v[i] > b.v[i] ? a.v[i] : b.v[i]); }
static inline wi wi_or(wi a, wi b) { EACH(wi, a.v[i] | b.v[i]); }
static inline wi wi_shl(wi a, int n) { EACH(wi, (int32_t)((uint32_t)a.v[i] << n)); }
static inline wi wi_sar(wi a, int n) { EACH(wi, a.v[i] >> n); }

static inline wm wm_and(wm a, wm b) { EACH(wm, a.v[i] & b.v[i]); }
static inline wm wm_or(wm a, wm b) { EACH(wm, a.v[i] | b.v[i]); }
static inline wm wm_not(wm a) { EACH(wm, ~a.v[i]); }
static inline uint32_t wm_bits(wm a) {
    uint32_t bits = 0;
    for (int i = 0; i < 16; i++) bits |= (uint32_t)(a.v[i] & 1) << i;
    return bits;
}
static inline wm wm_of_bits(uint32_t bits) { EACH(wm, -(int32_t)(bits >> i & 1)); }

/// Transposes a 16x16 matrix in place: afterwards rows[i] lane j is what rows[j] lane i was.
static inline void w_transpose(wf rows[16]) {
    for (int i = 0; i < 16; i++) {
        for (int j = 0; j < i; j++) {
            const float swap = rows[i].v[j];
            rows[i].v[j] = rows[j].v[i];
            rows[j].v[i] = swap;
        }
    }
}

/// Writes a, b, c, d lane by lane: out[4 i .. 4 i + 3] = lane i of each.
static inline void w_store4(float *out, wf a, wf b, wf c, wf d) {
    for (int i = 0; i < 16; i++, out += 4) {
        out[0] = a.v[i];
        out[1] = b.v[i];
        out[2] = c.v[i];
        out[3] = d.v[i];
    }
}

#undef EACH
