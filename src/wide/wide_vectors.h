// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of wide_portable.h and wide_wasm.h: sixteen lanes as four vectors of GCC and Clang, and what the
// operators of these vectors say on every machine. QUARTERS(type, expression) is defined before: it returns a
// value of the type whose quarters are `expression` of n = 0 .. 3.

typedef float w4f __attribute__((vector_size(16)));
typedef int32_t w4i __attribute__((vector_size(16)));
typedef uint32_t w4u __attribute__((vector_size(16))); // for what wraps

typedef struct wf {
    w4f q[4];
} wf;
typedef struct wi {
    w4i q[4];
} wi;
typedef struct wm {
    w4i q[4]; // -1 or 0
} wm;

/// Sixteens that go through a long chain of steps at once: the registers hold one.
enum { WIDE_TOGETHER = 1 };

static inline w4f w4f_load(const float *p) {
    w4f result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline w4f w4f_select(w4i m, w4f a, w4f b) { return (w4f)((m & (w4i)a) | (~m & (w4i)b)); }
static inline w4i w4i_select(w4i m, w4i a, w4i b) { return (m & a) | (~m & b); }

static inline wf wf_load(const float *p) { QUARTERS(wf, w4f_load(p + 4 * n)); }
static inline void wf_store(float *p, wf a) { memcpy(p, &a, sizeof a); }
static inline wf wf_of_bits(wi a) { QUARTERS(wf, (w4f)a.q[n]); }
static inline wi wi_of_bits(wf a) { QUARTERS(wi, (w4i)a.q[n]); }
static inline wf wf_add(wf a, wf b) { QUARTERS(wf, a.q[n] + b.q[n]); }
static inline wf wf_sub(wf a, wf b) { QUARTERS(wf, a.q[n] - b.q[n]); }
static inline wf wf_mul(wf a, wf b) { QUARTERS(wf, a.q[n] * b.q[n]); }
static inline wf wf_div(wf a, wf b) { QUARTERS(wf, a.q[n] / b.q[n]); }
static inline wm wf_lt(wf a, wf b) { QUARTERS(wm, a.q[n] < b.q[n]); }
static inline wm wf_le(wf a, wf b) { QUARTERS(wm, a.q[n] <= b.q[n]); }
static inline wf wf_select(wm m, wf a, wf b) { QUARTERS(wf, w4f_select(m.q[n], a.q[n], b.q[n])); }
static inline wf wf_keep(wm m, wf a) { QUARTERS(wf, (w4f)(m.q[n] & (w4i)a.q[n])); }

static inline wi wi_load(const int32_t *p) {
    wi result;
    memcpy(&result, p, sizeof result);
    return result;
}
static inline void wi_store(int32_t *p, wi a) { memcpy(p, &a, sizeof a); }
static inline wi wi_add(wi a, wi b) { QUARTERS(wi, (w4i)((w4u)a.q[n] + (w4u)b.q[n])); }
static inline wi wi_sub(wi a, wi b) { QUARTERS(wi, (w4i)((w4u)a.q[n] - (w4u)b.q[n])); }
static inline wi wi_or(wi a, wi b) { QUARTERS(wi, a.q[n] | b.q[n]); }
static inline wi wi_and(wi a, wi b) { QUARTERS(wi, a.q[n] & b.q[n]); }

static inline wm wm_and(wm a, wm b) { QUARTERS(wm, a.q[n] & b.q[n]); }
static inline wm wm_or(wm a, wm b) { QUARTERS(wm, a.q[n] | b.q[n]); }
static inline wm wm_not(wm a) { QUARTERS(wm, ~a.q[n]); }

/// p[0..3] over and over.
static inline wf wf_repeat4(const float *p) { QUARTERS(wf, w4f_load(p)); }

/// Eight lanes, for the numbers of one pixel.
typedef struct w8 {
    w4f l, h;
} w8;

static inline w8 w8_load(const float *p) { return (w8){w4f_load(p), w4f_load(p + 4)}; }
static inline void w8_store(float *p, w8 a) { memcpy(p, &a, sizeof a); }
