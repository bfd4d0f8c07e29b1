// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The stated errors of src/wide/wide_functions.h, in plain C; that every instruction set gives the same bytes
// is tested on pictures.
#define WIDE_PORTABLE
#include "tests/check.h"
#include "wide/wide_functions.h"

#include <math.h>
#include <string.h>

static float first_lane(wf v) {
    float lanes[16];
    wf_store(lanes, v);
    for (int i = 1; i < 16; i++) assert_true(lanes[i] == lanes[0]);
    return lanes[0];
}

static float float_of_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

TEST(test_log2) {
    for (uint32_t bits = 0x00800000; bits < 0x7f800000; bits += 4999) {
        const float x = float_of_bits(bits);
        const double exact = log2((double)x), error = fabs((double)first_lane(wf_log2(wf_set(x))) - exact);
        assert_true(error <= 2e-7 * fmax(1, fabs(exact)));
    }
    for (uint32_t bits = 0x3f400000; bits < 0x3fa00000; bits += 997) {
        const float x = float_of_bits(bits);
        const double exact = log2((double)x);
        assert_true(fabs((double)first_lane(wf_log2(wf_set(x))) - exact) <= 3e-7 * fabs(exact));
    }
    assert_true(first_lane(wf_log2(wf_set(1))) == 0);
}

TEST(test_exp2) {
    for (double x = -126; x <= 127; x += 0.00217) {
        const double exact = exp2((double)(float)x);
        assert_true(fabs((double)first_lane(wf_exp2(wf_set((float)x))) / exact - 1) < 3e-7);
    }
    for (int e = -126; e <= 127; e++) assert_true(first_lane(wf_exp2(wf_set((float)e))) == ldexpf(1, e));
    assert_true(first_lane(wf_exp2(wf_set(-1e30f))) == 0x1p-126f);
    assert_true(first_lane(wf_exp2(wf_set(1e30f))) == 0x1p127f);
}

/// Of as many sixteens as go together, whose others hold something else.
static float power_of(float x, float exponent) {
    wf values[WIDE_TOGETHER];
    for (int n = 0; n < WIDE_TOGETHER; n++) values[n] = wf_set(n == WIDE_TOGETHER - 1 ? x : 0.7f);
    wf_power_each(values, wf_set(exponent), WIDE_TOGETHER);
    return first_lane(values[WIDE_TOGETHER - 1]);
}

TEST(test_power) {
    static const float exponents[] = {1, 1.5f, 32, 200, 5000, 65536};
    for (size_t k = 0; k < sizeof exponents / sizeof exponents[0]; k++) {
        for (uint32_t bits = 0x30000000; bits <= 0x3f800000; bits += 3001) {
            const float x = float_of_bits(bits);
            const double exact = pow((double)x, (double)exponents[k]);
            const double power = (double)power_of(x, exponents[k]);
            if (exact > 1e-6)
                assert_true(fabs(power / exact - 1) < 1e-5);
            else
                assert_true(power >= 0 && power < 1.01e-6);
        }
        assert_true(power_of(1, exponents[k]) == 1);
        assert_true(power_of(2, exponents[k]) == 1);
        assert_true(power_of(0, exponents[k]) < 1e-37f);
    }
}

TEST(test_atan2) {
    for (double angle = -3.1415; angle < 3.1415; angle += 0.000217)
        for (double length = 1e-20; length < 1e25; length *= 1e20) {
            const float x = (float)(length * cos(angle)), y = (float)(length * sin(angle));
            const double found = (double)first_lane(wf_atan2(wf_set(y), wf_set(x)));
            assert_true(fabs(found - atan2((double)y, (double)x)) < 3e-7);
        }
    static const float axes[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int i = 0; i < 4; i++) {
        const double found = (double)first_lane(wf_atan2(wf_set(axes[i][1]), wf_set(axes[i][0])));
        assert_true(fabs(found - atan2((double)axes[i][1], (double)axes[i][0])) < 3e-7);
    }
    assert_true(first_lane(wf_atan2(wf_set(0), wf_set(0))) == 0);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
