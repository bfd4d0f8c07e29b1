// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/number.c: known answers, the C library as judge, bounds, other locales.
#include "check.h"
#include "io/number.h"

#include <locale.h>
#include <math.h>
#include <string.h>

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint32_t bits_of_f32(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Reads from memory that ends exactly where the text does, so that a sanitizer sees one byte too many.
static double read_f64(const char *text, size_t *length) {
    const size_t size = strlen(text);
    OWNED(check_free) char *exact = malloc(size ? size : 1);
    memcpy(exact, text, size);
    double value = 12345;
    const char *after = ewa_number_read_f64(exact, exact + size, &value);
    *length = after ? (size_t)(after - exact) : 0;
    return value;
}

static float read_f32(const char *text, size_t *length) {
    const size_t size = strlen(text);
    OWNED(check_free) char *exact = malloc(size ? size : 1);
    memcpy(exact, text, size);
    float value = 12345;
    const char *after = ewa_number_read_f32(exact, exact + size, &value);
    *length = after ? (size_t)(after - exact) : 0;
    return value;
}

/// Both readers against the C library, bit by bit.
static void assert_like_library(const char *text) {
    size_t length;
    const double wide = read_f64(text, &length);
    if (length != strlen(text) || bits_of(wide) != bits_of(strtod(text, NULL)))
        fail_msg("'%s' read as %.17g (%zu characters), expected %.17g", text, wide, length,
                 strtod(text, NULL));
    const float narrow = read_f32(text, &length);
    if (length != strlen(text) || bits_of_f32(narrow) != bits_of_f32(strtof(text, NULL)))
        fail_msg("'%s' read as float %.9g, expected %.9g", text, narrow, strtof(text, NULL));
}

TEST(test_plain_numbers) {
    static const char *const texts[] = {
        "0",
        "-0",
        "+0",
        "1",
        "-1",
        "+7",
        "10",
        "0.5",
        ".5",
        "5.",
        "-.25",
        "00012",
        "0.1",
        "1e0",
        "1E5",
        "1e+5",
        "1.5e-7",
        "123456789",
        "12345678",
        "1234567",
        "12345678.12345678",
        "0.0000000000000000000000000012345",
        "100000000000000000000000000000000",
        "9007199254740993",
        "9007199254740992.5",
        "18446744073709551615",
        "18446744073709551616",
        "0.30000000000000004",
        "-0.0378297",
        "1e22",
        "1e23",
        "1e-22",
        "1e-23",
        "1e27",
        "1e28",
        "1e-27",
        "1e-28",
        "9999999999999999999e27",
        "3.4028235e38",
        "3.4028236e38",
        "16777217",
        "000000000000000000000000000000000000001.5",
        "0e99999999999",
        "0.000e-99999999999",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) assert_like_library(texts[i]);
}

TEST(test_edges_of_the_formats) {
    static const char *const texts[] = {
        // around the largest and least double, the normal limit, and halves between neighbours
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "1.7976931348623159e308",
        "1e309",
        "1e999999999999",
        "2.2250738585072014e-308",
        "2.2250738585072011e-308",
        "2.2250738585072012e-308",
        "4.9406564584124654e-324",
        "2.4703282292062327e-324",
        "2.4703282292062328e-324",
        "2e-324",
        "1e-400",
        "1e-999999999999",
        // the same for float
        "1.17549435e-38",
        "1.17549421e-38",
        "1.1754943e-38",
        "1.40129846e-45",
        "7.0064923216240853e-46",
        "7.0064923216240854e-46",
        "7e-46",
        "3.40282356779733e38",
        "3.40282356779733661637539395458142568447e38",
        "3.40282356779733661637539395458142568448e38",
        // midway between two floats, and a hair to either side of it, where rounding twice would err
        "1.00000005960464477539062500000000000000000000000000",
        "1.00000005960464477539062500000000000000000000000001",
        "1.00000005960464477539062499999999999999999999999999",
        "16777217.0000000000000000000000000000000000001",
        // V. Paxson's hard cases and their kin
        "9214843084008499e-22",
        "7.3177701707893310e15",
        "5e-324",
        "69e267",
        "999e-26",
        "7861e-34",
        "75569e-254",
        "928609e-261",
        "9210917e80",
        "84863171e114",
        "653777767e273",
        "5232604057e-298",
        "27235667517e-109",
        "8899e-326",
        "6250e-332",
        "2.50000000000000000000000000000001e-1",
        "8.5",
        "1797693134862315807937289714053034150799341327100378269361737789804449682927647509466490179775872070"
        "96330286"
        "4166928879109465555478519404026306574886715058206819089020007083836762738548458177115317644757302700"
        "69855571"
        "366959622842914819860834936475292719074168444365510704342711559699508093042880",
        "1797693134862315807937289714053034150799341327100378269361737789804449682927647509466490179775872070"
        "96330286"
        "4166928879109465555478519404026306574886715058206819089020007083836762738548458177115317644757302700"
        "69855571"
        "366959622842914819860834936475292719074168444365510704342711559699508093042879",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) assert_like_library(texts[i]);
}

TEST(test_random_decimals) {
    check_random random = {1};
    char text[1100];
    for (int i = 0; i < 60000; i++) {
        const int digits = 1 + (int)(check_random_u64(&random) % (i % 100 == 0 ? 1000 : 24));
        const int point = (int)(check_random_u64(&random) % ((uint64_t)digits + 1));
        int at = 0;
        if (check_random_u64(&random) % 2) text[at++] = '-';
        for (int k = 0; k < digits; k++) {
            if (k == point) text[at++] = '.';
            text[at++] = (char)('0' + check_random_u64(&random) % 10);
        }
        text[at] = 0;
        if (i % 3) {
            const int range = i % 2 ? 60 : 700;
            sprintf(text + at, "e%d", (int)(check_random_u64(&random) % (uint64_t)range) - range / 2);
        }
        assert_like_library(text);
    }
}

TEST(test_decimals_near_halves) {
    // Exact decimal expansions of midpoints between neighbours, and those with the last digit changed.
    check_random random = {2};
    char text[1200];
    for (int i = 0; i < 3000; i++) {
        double value;
        uint64_t bits = check_random_u64(&random) & INT64_MAX;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value)) continue;
        const float narrow = (float)ldexp(1 + check_uniform(&random, 0, 1), (int)(bits % 200) - 100);
        snprintf(text, sizeof text, "%.*e", 760, value);
        assert_like_library(text);
        snprintf(text, sizeof text, "%.60e", (narrow + (double)nextafterf(narrow, INFINITY)) / 2);
        assert_like_library(text);
        text[50]++;
        if (text[50] <= '9') assert_like_library(text);
        // Few enough digits for one operation in double, whose result then is the midpoint that the text is
        // not.
        const float near = (float)ldexp(1 + check_uniform(&random, 0, 1), (int)(bits % 40) - 20);
        snprintf(text, sizeof text, "%.15e", (near + (double)nextafterf(near, INFINITY)) / 2);
        assert_like_library(text);
    }
}

TEST(test_words) {
    static const struct {
        const char *text;
        int kind; // 0 NaN, else the sign of infinity
    } words[] = {
        {"nan", 0},     {"NaN", 0},        {"-nan", 0},    {"-nan(ind)", 0}, {"nan(snan)", 0},
        {"1.#QNAN", 0}, {"1.#QNAN0", 0},   {"-1.#IND", 0}, {"-1.#IND00", 0}, {"inf", 1},
        {"+inf", 1},    {"-inf", -1},      {"INF", 1},     {"Infinity", 1},  {"-infinity", -1},
        {"1.#INF", 1},  {"-1.#INF00", -1},
    };
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        size_t length, length_f32;
        const double value = read_f64(words[i].text, &length);
        const float narrow = read_f32(words[i].text, &length_f32);
        assert_int_equal(length, strlen(words[i].text));
        assert_int_equal(length_f32, strlen(words[i].text));
        if (words[i].kind == 0)
            assert_true(isnan(value) && isnan(narrow));
        else
            assert_true(value == words[i].kind * (double)INFINITY && narrow == words[i].kind * INFINITY);
    }
}

TEST(test_what_is_no_number) {
    static const char *const texts[] = {"",    "-",   "+",  ".",  "-.", "e5",  ".e5", "abc",
                                        "--1", "+-1", "na", "in", " 1", "1.#", "#"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        size_t length;
        read_f64(texts[i], &length);
        assert_int_equal(length, 0);
        read_f32(texts[i], &length);
        assert_int_equal(length, 0);
    }
    static const struct {
        const char *text;
        size_t length;
        double value;
    } prefixes[] = {{"1e", 1, 1},   {"1e+", 1, 1}, {"2x", 1, 2},  {"3.5.5", 3, 3.5},
                    {"0x10", 1, 0}, {"1,5", 1, 1}, {"4 5", 1, 4}, {"12345678 9", 8, 12345678}};
    for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; i++) {
        size_t length;
        assert_true(read_f64(prefixes[i].text, &length) == prefixes[i].value);
        assert_int_equal(length, prefixes[i].length);
    }
}

TEST(test_integers) {
    static const struct {
        const char *text;
        int64_t value;
        size_t length;
    } cases[] = {{"0", 0, 1},
                 {"-0", 0, 2},
                 {"255", 255, 3},
                 {"-128", -128, 4},
                 {"+5", 5, 2},
                 {"4294967295", 4294967295, 10},
                 {"12345678", 12345678, 8},
                 {"999999999999999999", 999999999999999999, 18},
                 {"7.5", 7, 1},
                 {"1e3", 1, 1},
                 {"9999999999999999999", 0, 0},
                 {"", 0, 0},
                 {"-", 0, 0},
                 {"x", 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int64_t value = 0;
        const char *after = ewa_number_read_i64(cases[i].text, cases[i].text + strlen(cases[i].text), &value);
        assert_int_equal(after ? (size_t)(after - cases[i].text) : 0, cases[i].length);
        assert_true(value == cases[i].value);
        if (!after || after[0]) continue;
        char text[EWA_NUMBER_BYTES + 1];
        const size_t length = ewa_number_write_i64(value, text);
        text[length] = 0;
        assert_true(strtoll(text, NULL, 10) == value && length <= cases[i].length);
    }
}

TEST(test_written_text) {
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0"},
                 {-0.0, "-0"},
                 {1, "1"},
                 {-1.5, "-1.5"},
                 {0.1, "0.1"},
                 {0.3, "0.3"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {1e16, "10000000000000000"},
                 {1e17, "1e17"},
                 {123456, "123456"},
                 {1e-5, "0.00001"},
                 {1e-6, "1e-6"},
                 {1.7976931348623157e308, "1.7976931348623157e308"},
                 {4.9406564584124654e-324, "4.94065645841247e-324"},
                 {INFINITY, "inf"},
                 {-INFINITY, "-inf"},
                 {NAN, "nan"},
                 {-NAN, "nan"},
                 {9.9999999999999995e22, "1e23"},
                 {431234.56789, "431234.56789"},
                 {99999999999999.99, "99999999999999.98"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[EWA_NUMBER_BYTES + 1];
        text[ewa_number_write_f64(cases[i].value, text)] = 0;
        assert_string_equal(text, cases[i].text);
    }
    static const struct {
        float value;
        const char *text;
    } narrow[] = {{0.1f, "0.1"},
                  {3.1415927f, "3.1415927"},
                  {16777216, "16777216"},
                  {1e-45f, "1.4013e-45"},
                  {3.4028235e38f, "3.4028235e38"},
                  {-0.0378297f, "-0.0378297"},
                  {0.333333343f, "0.33333334"}};
    for (size_t i = 0; i < sizeof narrow / sizeof narrow[0]; i++) {
        char text[EWA_NUMBER_BYTES + 1];
        text[ewa_number_write_f32(narrow[i].value, text)] = 0;
        assert_string_equal(text, narrow[i].text);
    }
}

TEST(test_written_numbers_read_back) {
    check_random random = {3};
    for (int i = 0; i < 100000; i++) {
        uint64_t bits = check_random_u64(&random);
        if (i % 4 == 0) bits &= 0x800fffffffffffff; // denormal
        if (i % 4 == 1) bits = (bits & 0x800fffffffffffff) | (uint64_t)(1023 - 30 + bits % 60) << 52;
        double value;
        memcpy(&value, &bits, sizeof value);
        char text[EWA_NUMBER_BYTES + 1];
        size_t length = ewa_number_write_f64(value, text);
        assert_true(length <= EWA_NUMBER_BYTES);
        text[length] = 0;
        if (isnan(value))
            assert_string_equal(text, "nan");
        else if (bits_of(strtod(text, NULL)) != bits)
            fail_msg("%.17g written as '%s'", value, text);

        uint32_t narrow_bits = (uint32_t)(bits >> 32);
        if (i % 4 == 0) narrow_bits &= 0x807fffff;
        if (i % 4 == 1) narrow_bits = (narrow_bits & 0x807fffff) | (127 - 20 + narrow_bits % 40) << 23;
        float narrow;
        memcpy(&narrow, &narrow_bits, sizeof narrow);
        length = ewa_number_write_f32(narrow, text);
        text[length] = 0;
        if (isnan(narrow))
            assert_string_equal(text, "nan");
        else if (bits_of_f32(strtof(text, NULL)) != narrow_bits)
            fail_msg("%.9g written as '%s'", narrow, text);
    }
}

TEST(test_locale_changes_nothing) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8",
                                        "ru_RU.UTF-8"};
    bool found = false;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !found; i++)
        found = setlocale(LC_ALL, names[i]) && localeconv()->decimal_point[0] == ',';
    size_t length;
    const double value = read_f64("2.5", &length);
    char text[EWA_NUMBER_BYTES + 1];
    text[ewa_number_write_f64(2.5, text)] = 0;
    setlocale(LC_ALL, "C");
    assert_true(value == 2.5 && length == 3);
    assert_string_equal(text, "2.5");
    if (!found) skip();
}

int main(void) { return RUN_TESTS(NULL, NULL); }
