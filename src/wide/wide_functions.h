// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reciprocals, logarithm, power and arc tangent over the wide type, of exact and correctly rounded operations
// only: the same bytes from every instruction set and every C library. The errors are tested.
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
static ALWAYS_INLINE wf wf_reciprocal(wf x) {
    wf y = wf_of_bits(wi_sub(wi_set(0x7ef311c3), wi_of_bits(x)));
    for (int i = 0; i < 2; i++) {
        const wf e = wf_fnma(x, y, wf_set(1));
        y = wf_fma(y, wf_fma(e, e, e), y);
    }
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

/// log2(x) for normal x > 0 within 2e-7 of max(1, |log2 x|), and within 3e-7 relative near x = 1.
static ALWAYS_INLINE wf wf_log2(wf x) {
    // x = 2^e m with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh((m - 1) / (m + 1)).
    const wi bits = wi_of_bits(x), e = wi_sar(wi_sub(bits, wi_set(0x3f3504f3)), 23);
    const wf m = wf_of_bits(wi_sub(bits, wi_shl(e, 23))), one = wf_set(1);
    const wf s = wf_mul(wf_sub(m, one), wf_reciprocal(wf_add(m, one))), s2 = wf_mul(s, s);
    wf series = wf_fma(s2, wf_set(0.412198583f), wf_set(0.577078016f)); // 2 / (7 ln 2), 2 / (5 ln 2), ...
    series = wf_fma(s2, series, wf_set(0.961796694f));
    series = wf_fma(s2, series, wf_set(2.88539008f));
    return wf_fma(s, series, wf_from_i(e));
}

/// 2^x within 3e-7 relative for x in [-126, 127]; x is clamped to that.
static ALWAYS_INLINE wf wf_exp2(wf x) {
    x = wf_min(wf_max(x, wf_set(-126)), wf_set(127));
    const wf whole = wf_floor(wf_add(x, wf_set(0.5f))), f = wf_sub(x, whole);
    wf series = wf_fma(f, wf_set(1.54035304e-4f), wf_set(1.33335581e-3f)); // ln(2)^k / k!
    series = wf_fma(f, series, wf_set(9.61812911e-3f));
    series = wf_fma(f, series, wf_set(5.55041087e-2f));
    series = wf_fma(f, series, wf_set(2.40226507e-1f));
    series = wf_fma(f, series, wf_set(6.93147181e-1f));
    series = wf_fma(f, series, wf_set(1));
    return wf_mul(series, wf_of_bits(wi_shl(wi_add(wi_from_f(whole), wi_set(127)), 23)));
}

/// x^exponent for x clamped to [0, 1] and exponent in [1, 65536]: within 1e-5 relative where it is above
/// 1e-6.
static ALWAYS_INLINE wf wf_power(wf x, wf exponent) {
    return wf_exp2(wf_mul(exponent, wf_log2(wf_min(wf_max(x, wf_set(0x1p-126f)), wf_set(1)))));
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
