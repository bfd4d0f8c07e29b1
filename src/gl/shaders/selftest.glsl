// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What src/gl/selftest.c compares with the processor, for numbers that are hard to round. After wide.glsl. NATIVE 1: the
// device's own operations; 0: those of wide.glsl as they are to be used.

layout(local_size_x = 64) in;

// a, b, c of a b + c; n / m; x > 0; an exponent; a number in [0, 1].
struct Numbers { float a, b, c, n, m, x, e, s; };

layout(std430, binding = 0) readonly buffer Inputs { Numbers inputs[]; };
layout(std430, binding = 1) writeonly buffer Results { uint results[]; };

const double PER_2_30 = 9.31322574615478515625e-10LF;

void main() {
    uint i = gl_GlobalInvocationID.x, at = i * 10u;
    Numbers v = inputs[i];
#if NATIVE
    precise float fused = fma(v.a, v.b, v.c), quotient = v.n / v.m, root = sqrt(v.x), product = v.a * v.b,
                  both = product + v.c;
    precise double wide_product = double(v.a) * double(v.b), wide = wide_product + double(v.c);
    results[at] = floatBitsToUint(fused);
    results[at + 1u] = floatBitsToUint(quotient);
    results[at + 2u] = floatBitsToUint(root);
    results[at + 3u] = floatBitsToUint(both);
    precise double factor = double(v.b) + double(v.n) * PER_2_30, long_product = double(v.a) * factor;
    results[at + 4u] = floatBitsToUint(float(long_product));
    results[at + 5u] = unpackDouble2x32(wide).x;
    results[at + 6u] = unpackDouble2x32(wide).y;
    precise double divisor = double(v.a) + double(v.m) * PER_2_30, wide_quotient = factor / divisor;
    results[at + 7u] = unpackDouble2x32(wide_quotient).x;
    results[at + 8u] = unpackDouble2x32(wide_quotient).y;
    precise float small = v.s * MIN_NORMAL;
    results[at + 9u] = floatBitsToUint(small);
#else
    results[at] = floatBitsToUint(wf_fma(v.a, v.b, v.c));
    results[at + 1u] = floatBitsToUint(wf_div(v.n, v.m));
    results[at + 2u] = floatBitsToUint(wf_sqrt(v.x));
    results[at + 3u] = floatBitsToUint(wf_reciprocal(v.x));
    results[at + 4u] = floatBitsToUint(wf_inverse_root(v.x));
    results[at + 5u] = floatBitsToUint(wf_log2(v.x));
    results[at + 6u] = floatBitsToUint(wf_exp2(v.e));
    results[at + 7u] = floatBitsToUint(wf_odd_product(v.s, v.s));
    precise double a = double(v.a) + double(v.n) * PER_2_30, b = double(v.b) + double(v.m) * PER_2_30;
    precise double left = -(a * b), other = double(v.c) + double(v.x) * PER_2_30;
    if ((i & 3u) == 2u) { // half-way between two numbers, but for next to nothing
        a = 1.0LF + PER_2_30;
        b = 1.0LF - PER_2_30;
        other = 9007199254740992.0LF + 2.0LF * double(floor(v.s * 1048576.0));
    }
    double result = (i & 7u) == 5u ? wd_div(other, b) : wd_fma(a, b, (i & 1u) != 0u ? left : other);
    uvec2 bits = unpackDouble2x32(result);
    results[at + 8u] = bits.x;
    results[at + 9u] = bits.y;
#endif
}
