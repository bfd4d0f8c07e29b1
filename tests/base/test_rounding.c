// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the compiler is trusted with: numbers are rounded where they are said to be, with the flags of the library.
#include "check.h"

typedef struct triple {
    double x, y, z;
} triple;

static triple make(double x, double y, double z) { return (triple){x, y, z}; }

/// Three numbers by way of floats, side by side, where the vectorizer of straight code of GCC 12.2 forgets the floats.
/// Seen from outside, so that it is compiled for any numbers.
triple round_stored(float *to, triple from);

__attribute__((noinline)) triple round_stored(float *to, triple from) {
    to[0] = (float)from.x;
    to[1] = (float)from.y;
    to[2] = (float)from.z;
    return make((double)to[0], (double)to[1], (double)to[2]);
}

/// A product that is rounded before the sum.
__attribute__((noinline)) static double add_product(double a, double b, double c) { return a * b + c; }

TEST(test_floats) {
    float stored[3];
    const triple got = round_stored(stored, (triple){0.1, 0.2, 0.3});
    assert_true(got.x == 0.100000001490116119384765625);
    assert_true(got.y == 0.20000000298023223876953125);
    assert_true(got.z == 0.300000011920928955078125);
}

TEST(test_no_contraction) {
    const double a = 1 + 0x1p-30;
    assert_true(add_product(a, a, -1 - 0x1p-29) == 0); // a * a is rounded to 1 + 2^-29
}

int main(void) { return RUN_TESTS(NULL, NULL); }
