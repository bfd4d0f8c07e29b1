// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/srgb: tables and curve against pow().
#include "check.h"
#include "image/srgb.h"

#include <math.h>

static double encode_by_pow(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static double decode_by_pow(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

TEST(test_thresholds_are_where_the_code_changes) {
    for (int code = 1; code < 256; code++) {
        const float threshold = ewa_srgb_threshold[code], before = nextafterf(threshold, 0);
        const double exact = decode_by_pow((code - 0.5) / 255);
        assert_true(threshold >= exact * (1 - 1e-14) && before < exact * (1 + 1e-14));
        assert_int_equal(ewa_srgb8_from_linear(threshold), code);
        assert_int_equal(ewa_srgb8_from_linear(before), code - 1);
    }
}

TEST(test_eight_bits_everywhere) {
    union {
        uint32_t bits;
        float value;
    } x;
    for (x.bits = 0; x.bits <= 0x3f800000; x.bits += 997) {
        const double exact = 255 * encode_by_pow(x.value), code = ewa_srgb8_from_linear(x.value);
        if (fabs(exact - code) > 0.5 + 1e-9)
            fail_msg("%.9g gives %g, not %.12g", (double)x.value, code, exact);
    }
    for (x.bits = EWA_SRGB_FIRST_BITS; x.bits < 0x3f800000; x.bits += 1u << EWA_SRGB_BUCKET_SHIFT) {
        assert_int_equal(ewa_srgb8_from_linear(x.value), (int)floor(255 * encode_by_pow(x.value) + 0.5));
        const float before = nextafterf(x.value, 0);
        assert_int_equal(ewa_srgb8_from_linear(before), (int)floor(255 * encode_by_pow(before) + 0.5));
    }
}

TEST(test_outside_is_clamped) {
    assert_int_equal(ewa_srgb8_from_linear(NAN), 0);
    assert_int_equal(ewa_srgb8_from_linear(-INFINITY), 0);
    assert_int_equal(ewa_srgb8_from_linear(-0.0f), 0);
    assert_int_equal(ewa_srgb8_from_linear(1.0f), 255);
    assert_int_equal(ewa_srgb8_from_linear(INFINITY), 255);
    assert_true(ewa_srgb_from_linear(-1) == 0 && ewa_srgb_from_linear(2) == 1 &&
                ewa_srgb_from_linear(NAN) == 0);
    assert_true(ewa_linear_from_srgb(-1) == 0 && ewa_linear_from_srgb(2) == 1 &&
                ewa_linear_from_srgb(NAN) == 0);
}

TEST(test_codes_survive_the_round_trip) {
    for (int code = 0; code < 256; code++) {
        assert_int_equal(ewa_srgb8_from_linear(ewa_srgb_decoded[code]), code);
        assert_true(ewa_srgb_decoded[code] == (float)decode_by_pow(code / 255.0));
        assert_true(ewa_srgb_decoded[code] == (float)ewa_srgb_decode(code / 255.0));
    }
}

TEST(test_curve_matches_pow) {
    for (int i = 0; i <= 1000000; i++) {
        const double x = i / 1e6;
        if (fabs(ewa_srgb_encode(x) - encode_by_pow(x)) > 1e-15) fail_msg("encode(%.6f)", x);
        if (fabs(ewa_srgb_decode(x) - decode_by_pow(x)) > 1e-15) fail_msg("decode(%.6f)", x);
    }
    // Known values: middle grey 0.5 is 0.735357; code 128 is 0.215861.
    assert_true(fabs((double)ewa_srgb_from_linear(0.5f) - 0.7353569) < 1e-6);
    assert_true(fabs((double)ewa_linear_from_srgb(128 / 255.0f) - 0.2158605) < 1e-6);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
