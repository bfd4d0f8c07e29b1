// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/furniture/decimal.c: nice steps and the text of numbers.
#include <math.h>

#include "check.h"
#include "furniture/decimal.h"

/// Texts of the ticks of a range, joined by blanks; "none" without.
static const char *ticks_text(double low, double high, uint32_t maximum) {
    static char all[1024];
    ewa_ticks ticks;
    if (!ewa_ticks_find(low, high, maximum, &ticks)) return "none";
    all[0] = 0;
    for (int64_t k = ticks.first; k <= ticks.last; k++) {
        char text[EWA_DECIMAL_BYTES];
        ewa_decimal_write(ewa_ticks_at(&ticks, k), text);
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", k > ticks.first ? " " : "", text);
    }
    return all;
}

TEST(test_ticks) {
    static const struct {
        double low, high;
        uint32_t maximum;
        const char *text;
    } cases[] = {
        {0, 1, 5, "0.0 0.2 0.4 0.6 0.8 1.0"},
        {1e-6, 1 - 1e-6, 5, "0.2 0.4 0.6 0.8"},
        {0, 10, 5, "0 2 4 6 8 10"},
        {0, 10, 4, "0 5 10"},
        {0, 10, 1, "0 10"},
        {-1, 1, 4, "-1.0 -0.5 0.0 0.5 1.0"},
        {-7.3, -2.1, 6, "-7 -6 -5 -4 -3"},
        {0.1, 0.3, 4, "0.10 0.15 0.20 0.25 0.30"},
        {4200000.5, 4200001, 5, "4200000.5 4200000.6 4200000.7 4200000.8 4200000.9 4200001.0"},
        {4200000.5, 4200001, 1, "4200000.5 4200001.0"},
        {636001.76, 637179.22, 3, "636500 637000"},
        {0, 255, 6, "0 50 100 150 200 250"},
        {0, 2e9, 4, "0 5e8 1e9 1.5e9 2e9"},
        {0, 3e-9, 3, "0 1e-9 2e-9 3e-9"},
        {0, 3e-6, 3, "0.000000 0.000001 0.000002 0.000003"},
        {-1e308, 1e308, 2, "-1e308 0 1e308"},
        {1e-280, 3e-280, 2, "1e-280 2e-280 3e-280"},
        {0, 3e-300, 2, "none"},
        {5, 5, 5, "none"},
        {5, 4, 5, "none"},
        {NAN, 5, 5, "none"},
        {0, NAN, 5, "none"},
        {0, INFINITY, 5, "none"},
        {0, 1, 0, "none"},
        {1e16, 1e16 + 4, 4, "none"},
        {0.41, 0.59, 1, "none"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_string_equal(ticks_text(cases[i].low, cases[i].high, cases[i].maximum), cases[i].text);
}

/// However the range lies: no more steps than asked for, at least a fifth as many less one, all within the range, and
/// no neighbour left out.
TEST(test_tick_properties) {
    check_random random = {5};
    for (int i = 0; i < 20000; i++) {
        const double size = pow(10, check_uniform(&random, -250, 250));
        const double low = size * check_uniform(&random, -1, 1);
        const double high = low + size * pow(10, check_uniform(&random, -7, 1));
        const uint32_t maximum = 2 + (uint32_t)(check_random_u64(&random) % 12);
        ewa_ticks ticks;
        if (!ewa_ticks_find(low, high, maximum, &ticks)) {
            assert_true(maximum < 4);
            continue;
        }
        const double step = ewa_decimal_value(ticks.step),
                     slack = 1e-8 * step + 1e-15 * fmax(fabs(low), fabs(high));
        assert_true(ticks.last - ticks.first <= maximum);
        assert_true((double)(ticks.last - ticks.first) > maximum / 2.5 - 2.001);
        assert_true(ewa_decimal_value(ewa_ticks_at(&ticks, ticks.first)) >= low - slack);
        assert_true(ewa_decimal_value(ewa_ticks_at(&ticks, ticks.last)) <= high + slack);
        assert_true(ewa_decimal_value(ewa_ticks_at(&ticks, ticks.first - 1)) < low);
        assert_true(ewa_decimal_value(ewa_ticks_at(&ticks, ticks.last + 1)) > high);
        assert_true(ticks.step.digits == 1 || ticks.step.digits == 2 || ticks.step.digits == 5);
    }
}

TEST(test_write) {
    static const struct {
        ewa_decimal number;
        const char *text;
    } cases[] = {
        {{0, 0}, "0"},
        {{0, -2}, "0.00"},
        {{0, 9}, "0"},
        {{0, -9}, "0"},
        {{5, -1}, "0.5"},
        {{-5, -3}, "-0.005"},
        {{12345, -2}, "123.45"},
        {{5, 3}, "5000"},
        {{-25, 2}, "-2500"},
        {{5, 7}, "5e7"},
        {{1500, 7}, "1.5e10"},
        {{1, -7}, "1e-7"},
        {{123, -10}, "1.23e-8"},
        {{10, -6}, "0.000010"},
        {{1234567, 6}, "1.234567e12"},
        {{INT64_MIN, 0}, "-9.223372036854775808e18"},
        {{INT64_MAX, -6}, "9223372036854.775807"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[EWA_DECIMAL_BYTES];
        ewa_decimal_write(cases[i].number, text);
        assert_string_equal(text, cases[i].text);
    }
}

TEST(test_near) {
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0, "0"},
        {-0.0, "0"},
        {1, "1"},
        {100, "100"},
        {-2.5, "-2.5"},
        {(double)0.1f, "0.1"},
        {4200000.5, "4200000.5"},
        {37, "37"},
        {1000000, "1000000"},
        {999999999, "1e9"},
        {1e30, "1e30"},
        {1e-30, "1e-30"},
        {-1.0 / 3, "-0.333333"},
        {65535, "65535"},
        {1.7e308, "1.7e308"},
        {5e-324, "5e-324"},
        {1.0 / 3000, "3.3333333e-4"},
        {0.0625, "0.0625"},
        {123456, "123456"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[EWA_DECIMAL_BYTES];
        ewa_decimal_write(ewa_decimal_near(cases[i].value), text);
        assert_string_equal(text, cases[i].text);
    }
}

TEST(test_nice) {
    static const struct {
        double maximum;
        int64_t digits;
        int exponent;
    } cases[] = {{1, 1, 0},     {1.99, 1, 0},    {2, 2, 0},     {4.999, 2, 0},     {5, 5, 0},
                 {9.99, 5, 0},  {10, 1, 1},      {0.1, 1, -1},  {0.07, 5, -2},     {1e22, 1, 22},
                 {1e23, 1, 23}, {3e250, 2, 250}, {1e-5, 1, -5}, {2e-250, 2, -250}, {1.7e308, 1, 308}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ewa_decimal nice;
        assert_true(ewa_decimal_nice(cases[i].maximum, &nice));
        assert_int_equal(nice.digits, cases[i].digits);
        assert_int_equal(nice.exponent, cases[i].exponent);
    }
    static const double bad[] = {0, -1, NAN, INFINITY, -INFINITY, 1e-300};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ewa_decimal nice;
        assert_false(ewa_decimal_nice(bad[i], &nice));
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
