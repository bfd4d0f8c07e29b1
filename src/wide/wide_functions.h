// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reciprocals, logarithm, power and arc tangent over the wide type, of exact and correctly rounded operations
// only: the same bytes from every instruction set and every C library. The errors are tested.
//
// A function that ends in `_each` takes up to WIDE_TOGETHER sixteens through each of its steps: those for one
// wait for each other.
//
// Arc tangent based on: S. Moshier, Cephes Mathematical Library, atanf.c, 1989 (the polynomial).
#ifndef EWA_SRC_WIDE_WIDE_FUNCTIONS_H
#define EWA_SRC_WIDE_WIDE_FUNCTIONS_H

#include "wide/wide.h"

/// a with an odd last digit, for a far above 2^-40 or 0, of which it makes about 2^-40: no denormal number.
static ALWAYS_INLINE wf wf_odd(wf a) {
    return wf_of_bits(wi_or(wi_of_bits(wf_add(a, wf_set(0x1p-40f))), wi_set(1)));
}

/// wf_odd() of a product.
static ALWAYS_INLINE wf wf_odd_product(wf a, wf b) {
    return wf_of_bits(wi_or(wi_of_bits(wf_fma(a, b, wf_set(0x1p-40f))), wi_set(1)));
}

/// 1 / x for normal x > 0 within 1.2e-7 relative: a guess from the bits, two cubic steps. Cheaper than a
/// division, and the same on every machine.
static ALWAYS_INLINE void wf_reciprocal_each(const wf *x, wf *y, const int count) {
    wf e[WIDE_TOGETHER];
    for (int n = 0; n < count; n++) y[n] = wf_of_bits(wi_sub(wi_set(0x7ef311c3), wi_of_bits(x[n])));
    for (int i = 0; i < 2; i++) {
        for (int n = 0; n < count; n++) e[n] = wf_fnma(x[n], y[n], wf_set(1));
        for (int n = 0; n < count; n++) e[n] = wf_fma(e[n], e[n], e[n]);
        for (int n = 0; n < count; n++) y[n] = wf_fma(y[n], e[n], y[n]);
    }
}

static ALWAYS_INLINE wf wf_reciprocal(wf x) {
    wf y;
    wf_reciprocal_each(&x, &y, 1);
    return y;
}

/// 1 / sqrt(x) for normal x > 0 within 1.5e-7 relative, likewise; x = 0 gives a large finite number.
static ALWAYS_INLINE wf wf_inverse_root(wf x) {
    wf y = wf_of_bits(wi_sub(wi_set(0x5f375a86), wi_sar(wi_of_bits(x), 1)));
    for (int i = 0; i < 2; i++) {
        const wf e = wf_fnma(wf_mul(x, y), y, wf_set(1));
        y = wf_fma(wf_mul(y, e), wf_fma(e, wf_set(0.375f), wf_set(0.5f)), y);
    }
    return y;
}

/// log2(x) for normal x > 0 within 2e-7 of max(1, |log2 x|), and within 3e-7 relative near x = 1; in place.
static ALWAYS_INLINE void wf_log2_each(wf *x, const int count) {
    // x = 2^e m with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh((m - 1) / (m + 1)).
    wf e[WIDE_TOGETHER], s[WIDE_TOGETHER], s2[WIDE_TOGETHER], above[WIDE_TOGETHER], inverse[WIDE_TOGETHER],
        series[WIDE_TOGETHER];
    const wf one = wf_set(1);
    for (int n = 0; n < count; n++) {
        const wi bits = wi_of_bits(x[n]), exponent = wi_sar(wi_sub(bits, wi_set(0x3f3504f3)), 23);
        const wf m = wf_of_bits(wi_sub(bits, wi_shl(exponent, 23)));
        e[n] = wf_from_i(exponent), s[n] = wf_sub(m, one), above[n] = wf_add(m, one);
    }
    wf_reciprocal_each(above, inverse, count);
    for (int n = 0; n < count; n++) s[n] = wf_mul(s[n], inverse[n]), s2[n] = wf_mul(s[n], s[n]);
    // 2 / (7 ln 2), 2 / (5 ln 2), ...
    for (int n = 0; n < count; n++) series[n] = wf_fma(s2[n], wf_set(0.412198583f), wf_set(0.577078016f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(s2[n], series[n], wf_set(0.961796694f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(s2[n], series[n], wf_set(2.88539008f));
    for (int n = 0; n < count; n++) x[n] = wf_fma(s[n], series[n], e[n]);
}

static ALWAYS_INLINE wf wf_log2(wf x) {
    wf_log2_each(&x, 1);
    return x;
}

/// 2^x within 3e-7 relative for x in [-126, 127]; x is clamped to that; in place.
static ALWAYS_INLINE void wf_exp2_each(wf *x, const int count) {
    wf f[WIDE_TOGETHER], scale[WIDE_TOGETHER], series[WIDE_TOGETHER];
    for (int n = 0; n < count; n++) {
        const wf clamped = wf_min(wf_max(x[n], wf_set(-126)), wf_set(127));
        const wf whole = wf_floor(wf_add(clamped, wf_set(0.5f)));
        f[n] = wf_sub(clamped, whole);
        scale[n] = wf_of_bits(wi_shl(wi_add(wi_from_f(whole), wi_set(127)), 23));
    }
    // ln(2)^k / k!
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], wf_set(1.54035304e-4f), wf_set(1.33335581e-3f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], series[n], wf_set(9.61812911e-3f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], series[n], wf_set(5.55041087e-2f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], series[n], wf_set(2.40226507e-1f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], series[n], wf_set(6.93147181e-1f));
    for (int n = 0; n < count; n++) series[n] = wf_fma(f[n], series[n], wf_set(1));
    for (int n = 0; n < count; n++) x[n] = wf_mul(series[n], scale[n]);
}

static ALWAYS_INLINE wf wf_exp2(wf x) {
    wf_exp2_each(&x, 1);
    return x;
}

/// x^exponent for x clamped to [0, 1] and exponent in [1, 65536]: within 1e-5 relative where it is above
/// 1e-6; in place.
static ALWAYS_INLINE void wf_power_each(wf *x, wf exponent, const int count) {
    for (int n = 0; n < count; n++) x[n] = wf_min(wf_max(x[n], wf_set(0x1p-126f)), wf_set(1));
    wf_log2_each(x, count);
    for (int n = 0; n < count; n++) x[n] = wf_mul(exponent, x[n]);
    wf_exp2_each(x, count);
}

/// The angle of (x, y) in [-pi, pi], within 3e-7; 0 for (0, 0).
static ALWAYS_INLINE wf wf_atan2(wf y, wf x) {
    const wf zero = wf_set(0), one = wf_set(1), ay = wf_abs(y), ax = wf_abs(x);
    const wf larger = wf_max(ay, ax), smaller = wf_min(ay, ax);
    const wm directed = wf_lt(zero, larger);
    const wf t = wf_keep(directed, wf_div(smaller, wf_select(directed, larger, one)));
    // Beyond tan(pi / 8): atan t = pi / 4 + atan((t - 1) / (t + 1)).
    const wm steep = wf_lt(wf_set(0.414213562f), t);
    const wf r = wf_select(steep, wf_div(wf_sub(t, one), wf_add(t, one)), t), r2 = wf_mul(r, r);
    wf series = wf_fma(r2, wf_set(8.05374449538e-2f), wf_set(-1.38776856032e-1f));
    series = wf_fma(r2, series, wf_set(1.99777106478e-1f));
    series = wf_fma(r2, series, wf_set(-3.33329491539e-1f));
    wf angle = wf_fma(wf_mul(series, r2), r, r);
    angle = wf_add(angle, wf_keep(steep, wf_set(0.785398163f)));
    angle = wf_select(wf_lt(ax, ay), wf_sub(wf_set(1.57079633f), angle), angle);
    angle = wf_select(wf_lt(x, zero), wf_sub(wf_set(3.14159265f), angle), angle);
    return wf_select(wf_lt(y, zero), wf_sub(zero, angle), angle);
}

#endif
