// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The operations and functions of src/wide (wide.h, wide_functions.h, shine.h, pixels.h) for one lane: each exact or correctly
// rounded, whatever the device does by itself. FUSED, DIVIDES and ROOTS say what it can.

#define INF uintBitsToFloat(0x7f800000u)

float wf_add(float a, float b) { precise float r = a + b; return r; }
float wf_sub(float a, float b) { precise float r = a - b; return r; }
float wf_mul(float a, float b) { precise float r = a * b; return r; }

#if DIVIDES
float wf_div(float a, float b) { precise float r = a / b; return r; }
#else
// Rounding the double quotient once more changes nothing: it has more than twice as many digits.
float wf_div(float a, float b) { precise double r = double(a) / double(b); return float(r); }
#endif

#if ROOTS
float wf_sqrt(float a) { precise float r = sqrt(a); return r; }
#else
float wf_sqrt(float a) { precise double r = sqrt(double(a)); return float(r); }
#endif

// The sum of two doubles, rounded to odd, so that rounding it once more is as if it had been rounded once.
double odd_sum(double a, double b) {
    precise double s = a + b;
    precise double q = s - a;
    precise double e = (a - (s - q)) + (b - q);
    uvec2 w = unpackDouble2x32(s);
    if ((e > 0.0LF || e < 0.0LF) && (w.x & 1u) == 0u) {
        if ((e > 0.0LF) == (s > 0.0LF)) {
            w.x |= 1u;
        } else {
            w.y -= w.x == 0u ? 1u : 0u;
            w.x -= 1u;
        }
        s = packDouble2x32(w);
    }
    return s;
}

#if FUSED
float wf_fma(float a, float b, float c) { precise float r = fma(a, b, c); return r; }
#else
// The product is exact in double precision. Based on: S. Boldo, G. Melquiond, "Emulation of FMA and Correctly Rounded Sums: Proved
// Algorithms Using Rounding to Odd", 2008.
float wf_fma(float a, float b, float c) {
    precise double p = double(a) * double(b);
    return float(odd_sum(p, double(c)));
}
#endif

// a b + c of doubles, rounded once; the same paper's algorithm, with Dekker's product.
double wd_fma(double a, double b, double c) {
    precise double far_a = a * 134217729.0LF, far_b = b * 134217729.0LF;
    precise double a_high = far_a - (far_a - a), b_high = far_b - (far_b - b);
    precise double a_low = a - a_high, b_low = b - b_high;
    precise double product = a * b;
    precise double product_low = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    precise double low_sum = c + product_low;
    precise double q = low_sum - c;
    precise double low_rest = (c - (low_sum - q)) + (product_low - q);
    precise double sum = product + low_sum;
    precise double t = sum - product;
    precise double rest = (product - (sum - t)) + (low_sum - t);
    precise double result = sum + odd_sum(low_rest, rest);
    return result;
}

// A quotient of doubles, correctly rounded where it is normal: the rest of a nearly right one is exact, and its quotient is smaller
// than a last place. No quotient of two doubles is as near to the middle of two others as what that is rounded by.
double wd_div(double a, double b) {
    precise double q = a / b;
#if !DOUBLE_QUOTIENTS
    if (abs(q) < double(LARGEST) && abs(b) < double(LARGEST)) {
        precise double rest = wd_fma(-q, b, a), more = rest / b, sum = q + more;
        q = sum;
    }
#endif
    return q;
}

float wf_fnma(float a, float b, float c) { return wf_fma(-a, b, c); }
float wf_min(float a, float b) { return a < b ? a : b; }
float wf_max(float a, float b) { return a > b ? a : b; }
float wf_clamp(float a, float low, float high) { return wf_min(wf_max(a, low), high); }
float wf_keep(bool m, float a) { return m ? a : 0.0; }
float wf_abs(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0x7fffffffu); }
float wf_negate(float a) { return uintBitsToFloat(floatBitsToUint(a) ^ 0x80000000u); }
float wf_of_bits(int a) { return intBitsToFloat(a); }
int wi_of_bits(float a) { return floatBitsToInt(a); }

float wf_odd(float a) { return uintBitsToFloat(floatBitsToUint(wf_add(a, TINY)) | 1u); }
float wf_odd_product(float a, float b) { return uintBitsToFloat(floatBitsToUint(wf_fma(a, b, TINY)) | 1u); }

float wf_reciprocal(float x) {
    float y = wf_of_bits(0x7ef311c3 - wi_of_bits(x));
    for (int i = 0; i < 2; i++) {
        float e = wf_fnma(x, y, 1.0);
        e = wf_fma(e, e, e);
        y = wf_fma(y, e, y);
    }
    return y;
}

float wf_inverse_root(float x) {
    float y = wf_of_bits(0x5f375a86 - (wi_of_bits(x) >> 1));
    for (int i = 0; i < 2; i++) {
        float e = wf_fnma(wf_mul(x, y), y, 1.0);
        y = wf_fma(wf_mul(y, e), wf_fma(e, 0.375, 0.5), y);
    }
    return y;
}

float wf_log2(float x) {
    int bits = wi_of_bits(x), exponent = (bits - 0x3f3504f3) >> 23;
    float m = wf_of_bits(bits - (exponent << 23));
    float above = wf_add(m, 1.0), s = wf_mul(wf_sub(m, 1.0), wf_reciprocal(above)), s2 = wf_mul(s, s);
    float series = wf_fma(s2, 0.412198583, 0.577078016);
    series = wf_fma(s2, series, 0.961796694);
    series = wf_fma(s2, series, 2.88539008);
    return wf_fma(s, series, float(exponent));
}

float wf_exp2(float x) {
    float clamped = wf_min(wf_max(x, -126.0), 127.0);
    float whole = floor(wf_add(clamped, 0.5)), f = wf_sub(clamped, whole);
    float scale = wf_of_bits((int(whole) + 127) << 23);
    float series = wf_fma(f, 1.54035304e-4, 1.33335581e-3);
    series = wf_fma(f, series, 9.61812911e-3);
    series = wf_fma(f, series, 5.55041087e-2);
    series = wf_fma(f, series, 2.40226507e-1);
    series = wf_fma(f, series, 6.93147181e-1);
    series = wf_fma(f, series, 1.0);
    return wf_mul(series, scale);
}

float wf_power(float x, float exponent) {
    x = wf_min(wf_max(x, MIN_NORMAL), 1.0);
    return wf_exp2(wf_mul(exponent, wf_log2(x)));
}

float wf_atan2(float y, float x) {
    float ay = wf_abs(y), ax = wf_abs(x), larger = wf_max(ay, ax), smaller = wf_min(ay, ax);
    bool directed = 0.0 < larger;
    float t = wf_keep(directed, wf_div(smaller, directed ? larger : 1.0));
    bool steep = 0.414213562 < t;
    float r = steep ? wf_div(wf_sub(t, 1.0), wf_add(t, 1.0)) : t, r2 = wf_mul(r, r);
    float series = wf_fma(r2, 8.05374449538e-2, -1.38776856032e-1);
    series = wf_fma(r2, series, 1.99777106478e-1);
    series = wf_fma(r2, series, -3.33329491539e-1);
    float angle = wf_fma(wf_mul(series, r2), r, r);
    angle = wf_add(angle, wf_keep(steep, 0.785398163));
    angle = ax < ay ? wf_sub(1.57079633, angle) : angle;
    angle = x < 0.0 ? wf_sub(3.14159265, angle) : angle;
    return y < 0.0 ? wf_sub(0.0, angle) : angle;
}

float dot3(vec3 a, vec3 b) { return wf_fma(a.x, b.x, wf_fma(a.y, b.y, wf_mul(a.z, b.z))); }
vec3 scale3(vec3 v, float by) { return vec3(wf_mul(v.x, by), wf_mul(v.y, by), wf_mul(v.z, by)); }

// Rows of a rotation times a vector.
vec3 rotate(float m[9], vec3 v) {
    vec3 r;
    for (int i = 0; i < 3; i++)
        r[i] = wf_fma(m[3 * i], v.x, wf_fma(m[3 * i + 1], v.y, wf_mul(m[3 * i + 2], v.z)));
    return r;
}

// exp(-s), pipeline_raster.h.
float exponential(float s, uint doublings) {
    float e = wf_fma(s, 0.023368568317, -0.149394522715);
    e = wf_fma(s, e, 0.492818156100);
    e = wf_fma(s, e, -0.998891978164);
    e = wf_fma(s, e, 0.999970343067);
    for (uint i = 0u; i < doublings; i++) e = wf_mul(e, e);
    return e;
}
