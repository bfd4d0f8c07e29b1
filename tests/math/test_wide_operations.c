// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Each operation of src/wide, in every version that this machine runs, against one lane of plain C.
#include "tests/check.h"
#include "math/wide_operations.h"

#include <math.h>

static uint64_t seed = 88172645463325252u;

static uint32_t next(void) {
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (uint32_t)(seed >> 16);
}

static float of_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Of any size, with few or all digits; now and then denormal, zero, infinite or NaN.
static float any_float(void) {
    const uint32_t bits = next();
    switch (next() % 8) {
    case 0: return of_bits(bits & 0x80ffffff);
    case 1: return of_bits(bits & 0xfff00000);
    case 2: return of_bits((bits & 0x80ff0000) | 0x3f000000);
    case 3: return of_bits(bits);
    default: return of_bits((bits & 0x807fffff) | (100 + (bits >> 8) % 56) << 23);
    }
}

/// Near what cancels a b, and beside halves of its last digit: where a second rounding shows.
static float against(float a, float b) {
    uint32_t bits;
    const float product = a * b;
    memcpy(&bits, &product, sizeof bits);
    return of_bits((bits ^ 0x80000000 ^ (next() & 3)) + ((next() % 26) << 23) * (next() & 1));
}

/// At most 1, of few digits, so that products end in halves of halves.
static float any_share(void) { return ldexpf((float)(next() % 9), -3); }

/// Factors whose product is less than half of the least denormal number by what a double loses beside a larger one, and denormal
/// numbers to add it to: now of the first sum of two, now of the second.
static void fill_small(wide_input *in, int n) {
    const bool first = next() % 2;
    const float off = 0x1p-23f * (float)(1 + next() % 7), under = ldexpf(1 - off, -75);
    in->a[n] = ldexpf(1 + off, -75);
    in->b[n] = first ? under : 0;
    in->c[n] = first ? of_bits(next() % 0x800000) : under;
    in->k[n] = of_bits(next() % 0x800000);
}

static void fill(wide_input *in) {
    for (int n = 0; n < 16; n++) {
        in->a[n] = any_float(), in->b[n] = any_float();
        in->c[n] = next() % 2 ? any_float() : against(in->a[n], in->b[n]);
        in->k[n] = next() % 2 ? any_float() : against(in->a[n], fmaf(in->a[n], in->b[n], in->c[n]));
        if (next() % 8 == 0) fill_small(in, n);
        in->share[n] = next() % 4 ? of_bits(0x3f800000 - next() % 0x08000000) : any_share();
        in->odd[n] = of_bits((next() & 0x807ffffe) | 1 | (110 + next() % 36) << 23);
        in->sum[n] = 0x1.8p23f + (float)(int32_t)(next() % 0x600000) - 0x1.8p21f;
        in->whole[n] = ldexpf((float)(int32_t)next(), -(int)(next() % 31));
        if (fabsf(in->whole[n]) > 0x1.fffffep30f) in->whole[n] = 1.5f;
        in->i[n] = (int32_t)next(), in->j[n] = (int32_t)next(), in->at[n] = (int32_t)(next() & 255);
        in->u16[n] = (uint16_t)next();
        in->d[n] = (double)any_float() * (1 + 0x1p-30 * next()), in->e[n] = (double)any_float() * 1.1;
        in->f[n] = next() % 2 ? any_float() : -in->d[n] * in->e[n];
    }
    for (int n = 0; n < 5; n++) in->coefficients[n] = of_bits((next() & 0x80ffffff) | (uint32_t)(100 + next() % 50) << 23);
    for (int n = 0; n < 256; n++) in->table[n] = any_float();
    in->bits = next() & 0xffff, in->shift = (int)(next() % 31);
}

static void hold_float(const char *what, float got, float wanted) {
    if (memcmp(&got, &wanted, sizeof got) && !(isnan(got) && isnan(wanted)))
        fail_msg("%s: %a instead of %a", what, (double)got, (double)wanted);
}
static void hold_double(const char *what, double got, double wanted) {
    if (memcmp(&got, &wanted, sizeof got) && !(isnan(got) && isnan(wanted)))
        fail_msg("%s: %a instead of %a", what, got, wanted);
}

#define HOLD(name, wanted)        hold_float(#name, out->name[n], wanted)
#define HOLD_DOUBLE(name, wanted) hold_double(#name, out->name[n], wanted)

/// a b + c rounded once. fmaf() of musl and of zig's compiler rounds sums below the normal numbers twice.
static float fused(float a, float b, float c) {
    const double product = (double)a * (double)b, sum = product + (double)c, part = sum - product;
    const double lost = (product - (sum - part)) + ((double)c - part);
    uint64_t bits;
    double odd = sum;
    memcpy(&bits, &sum, sizeof bits);
    if ((lost < 0 || lost > 0) && !(bits & 1)) {
        bits += (lost > 0) == (sum > 0) ? 1 : UINT64_MAX;
        memcpy(&odd, &bits, sizeof odd);
    }
#ifdef __GLIBC__ // whose fmaf() is right
    const float result = (float)odd, wanted = fmaf(a, b, c);
    assert_true(memcmp(&result, &wanted, sizeof wanted) == 0 || (isnan(result) && isnan(wanted)));
#endif
    return (float)odd;
}

static void hold_floats(const wide_input *in, const wide_output *out, int n) {
    const float a = in->a[n], b = in->b[n], c = in->c[n];
    const int at = in->at[n];
    const bool given = in->bits >> n & 1;
    HOLD(add, a + b), HOLD(sub, a - b), HOLD(mul, a * b), HOLD(div, a / b);
    HOLD(sqrt, sqrtf(a)), HOLD(abs, fabsf(a)), HOLD(floor, floorf(a));
    HOLD(min, a < b ? a : b), HOLD(max, a > b ? a : b);
    HOLD(fma, fused(a, b, c)), HOLD(fnma, fused(-a, b, c));
    HOLD(fma_twice, fused(a, fused(a, b, c), in->k[n])), HOLD(fma_whole, fused(in->share[n], in->odd[n], in->sum[n]));
    float horner = in->coefficients[0];
    for (int m = 1; m < 5; m++) horner = fused(a, horner, in->coefficients[m]);
    HOLD(horner, horner);
    HOLD(select, given ? a : b), HOLD(keep, given ? a : 0), HOLD(from_i, (float)in->i[n]);
    HOLD(gather, in->table[at]), HOLD(lookup, in->table[at & 15]), HOLD(lookup32, in->table[at & 31]);
    HOLD(rows, in->table[20 * (n / 4) + n % 4]);
    HOLD(repeat4, in->table[n % 4]), HOLD(spread4, in->table[n / 4]);
    for (int m = 0; m < 16; m++) hold_float("transposed", out->transposed[16 * n + m], in->table[16 * m + n]);
    const float four[4] = {a, b, c, 7};
    for (int m = 0; m < 4; m++) {
        hold_float("store4", out->store4[4 * n + m], four[m]);
        hold_float("load4", out->load4[16 * m + n], in->table[24 * (n / 4) + 4 * (n % 4) + m]);
    }
    if (n < 8) HOLD(eight, fused(a, in->b[0], c)), HOLD(joined, n < 4 ? a : n < 7 ? in->b[n - 4] : 0);
    HOLD_DOUBLE(double_fma, fma(in->d[n], in->e[n], in->f[n]));
    HOLD_DOUBLE(double_fnma, fma(-in->d[n], in->e[n], in->f[n]));
    HOLD_DOUBLE(double_add, in->d[n] + in->e[0]), HOLD_DOUBLE(double_sub, in->d[n] - in->e[n]);
    HOLD_DOUBLE(widened, (double)a), HOLD(narrowed, (float)in->d[n]);
}

static void hold_integers(const wide_input *in, const wide_output *out, int n) {
    const int32_t i = in->i[n], j = in->j[n];
    const bool given = in->bits >> n & 1, less = in->a[n] < in->b[n];
    assert_int_equal(out->int_of[n], (int32_t)in->whole[n]);
    assert_int_equal(out->wi_add[n], (int32_t)((uint32_t)i + (uint32_t)j));
    assert_int_equal(out->wi_sub[n], (int32_t)((uint32_t)i - (uint32_t)j));
    assert_int_equal(out->wi_min[n], i < j ? i : j);
    assert_int_equal(out->wi_max[n], i > j ? i : j);
    assert_int_equal(out->wi_or[n], i | j);
    assert_int_equal(out->wi_and[n], i & j);
    assert_int_equal(out->wi_shl[n], (int32_t)((uint32_t)i << in->shift));
    assert_int_equal(out->wi_sar[n], (int32_t)((int64_t)i >> in->shift));
    assert_int_equal(out->from_u16[n], in->u16[n]);
    assert_int_equal(out->from_i16[n], (int16_t)in->u16[n]);
    assert_int_equal(out->int_rows[16 * (n / 4) + n % 4], i);
    assert_int_equal(out->u8[n], in->at[n]);
    assert_int_equal(out->less >> n & 1, less);
    assert_int_equal(out->less_equal >> n & 1, in->a[n] <= in->b[n]);
    assert_int_equal(out->bits >> n & 1, given);
    assert_int_equal(out->both >> n & 1, less && given);
    assert_int_equal(out->either >> n & 1, less || given);
    assert_int_equal(out->neither >> n & 1, !less && !given);
}

static void hold_version(wide_operations *operate) {
    static wide_input in;
    static wide_output out;
    for (int round = 0; round < 20000; round++) {
        fill(&in);
        operate(&in, &out);
        for (int n = 0; n < 16; n++) hold_floats(&in, &out, n), hold_integers(&in, &out, n);
        for (int n = 0, packed = 0; n < 16; n++) {
            if (!(in.bits >> n & 1)) continue;
            hold_float("packed", out.packed[packed], in.a[n]);
            assert_int_equal(out.wi_packed[packed++], in.i[n]);
        }
    }
}

TEST_ON(test_versions, 1) {
    const uint32_t features = ewa_context_cpu_features(context);
    hold_version(wide_operate_portable);
#if defined(__x86_64__)
    if (features & EWA_CPU_AVX2) hold_version(wide_operate_avx2);
    if (features & EWA_CPU_AVX512) hold_version(wide_operate_avx512);
#elif defined(__aarch64__)
    if (features & EWA_CPU_NEON) hold_version(wide_operate_neon);
#endif
}

int main(void) { return RUN_TESTS(NULL, NULL); }
