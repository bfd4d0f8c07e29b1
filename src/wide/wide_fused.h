// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of wide_portable.h: a b + c rounded once, for sixteen floats at a time, where the instruction set has
// no fused multiply-add and fmaf() would be called for every lane.
//
// In double precision the product of two floats is exact, and only the sum is rounded; rounding that to float
// can be wrong in two cases alone: where the rounded sum stands halfway between two floats though the exact
// one does not, and where the float is below the normal numbers, which have fewer digits. Both are seen from
// the bits of the sum. There the sum is rounded to odd first: S. Boldo and G. Melquiond, "Emulation of FMA
// and Correctly Rounded Sums: Proved Algorithms Using Rounding to Odd", IEEE Transactions on Computers 57(4),
// 2008.
typedef float w2f __attribute__((vector_size(8)));
typedef double w2d __attribute__((vector_size(16)));
typedef int64_t w2l __attribute__((vector_size(16)));

static inline w2d w2d_of_low(w4f a) { return __builtin_convertvector(__builtin_shufflevector(a, a, 0, 1), w2d); }
static inline w2d w2d_of_high(w4f a) {
    // By the low half of a full vector: GCC 12 takes the numbers of a high half one by one.
    return w2d_of_low(__builtin_shufflevector(a, a, 2, 3, 2, 3));
}
static inline w4f w4f_of(w2d low, w2d high) {
    const w2f l = __builtin_convertvector(low, w2f), h = __builtin_convertvector(high, w2f);
    return __builtin_shufflevector(l, h, 0, 1, 2, 3);
}

/// Other than 0 in the lanes where the sums cannot simply be rounded to float.
static inline w4i fused_doubtful(w2d low, w2d high) {
    const w4i last = __builtin_shufflevector((w4i)low, (w4i)high, 0, 2, 4, 6) & 0x1fffffff;
    const w4i first = __builtin_shufflevector((w4i)low, (w4i)high, 1, 3, 5, 7) & 0x7fffffff;
    return (last == 0x10000000) | ((first > 0) & (first < 0x38100000)); // below 2^-126, but not 0
}

/// product + c rounded to odd: the exact sum where that is a double, else of the two beside it the one with
/// an odd last bit.
static inline w2d fused_odd(w2d product, w2d c) {
    const w2d sum = product + c, c_part = sum - product;
    const w2d lost = (product - (sum - c_part)) + (c - c_part);
    const w2l inexact = (lost < 0) | (lost > 0), even = ((w2l)sum & 1) - 1;
    const w2l step = (((lost > 0) ^ (sum < 0)) & 2) - 1; // away from 0, or towards it
    return (w2d)((w2l)sum + (inexact & even & step));
}

static __attribute__((noinline, unused, cold)) wf fused_slowly(wf a, wf b, wf c) {
    wf result;
    for (int i = 0; i < 4; i++) {
        result.q[i] = w4f_of(fused_odd(w2d_of_low(a.q[i]) * w2d_of_low(b.q[i]), w2d_of_low(c.q[i])),
                            fused_odd(w2d_of_high(a.q[i]) * w2d_of_high(b.q[i]), w2d_of_high(c.q[i])));
    }
    return result;
}

FUSED wf wf_fma(wf a, wf b, wf c) {
    wf result;
    w4i doubtful = {0};
    for (int i = 0; i < 4; i++) {
        const w2d low = w2d_of_low(a.q[i]) * w2d_of_low(b.q[i]) + w2d_of_low(c.q[i]);
        const w2d high = w2d_of_high(a.q[i]) * w2d_of_high(b.q[i]) + w2d_of_high(c.q[i]);
        doubtful |= fused_doubtful(low, high);
        result.q[i] = w4f_of(low, high);
    }
    const w2l any = (w2l)doubtful;
    return any[0] | any[1] ? fused_slowly(a, b, c) : result;
}
