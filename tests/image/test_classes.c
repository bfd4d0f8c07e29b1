// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/image/classes.c.
#include "check.h"

#include <math.h>

TEST(test_names) {
    static const struct {
        uint32_t code;
        const char *name;
    } cases[] = {{0, "never classified"},
                 {2, "ground"},
                 {5, "high vegetation"},
                 {6, "building"},
                 {9, "water"},
                 {11, "road surface"},
                 {17, "bridge deck"},
                 {18, "high noise"},
                 {19, "class 19"},
                 {37, "class 37"},
                 {UINT32_MAX, "class 4294967295"}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char name[EWA_CLASS_NAME_BYTES];
        ewa_class_name(cases[k].code, name);
        assert_string_equal(name, cases[k].name);
    }
}

/// What the classes are called is what they look like.
TEST(test_known_colors) {
    uint8_t ground[3], tree[3], building[3], water[3];
    ewa_class_color(2, ground), ewa_class_color(5, tree), ewa_class_color(6, building),
        ewa_class_color(9, water);
    assert_true(ground[0] > ground[1] && ground[1] > ground[2]);
    assert_true(tree[1] > tree[0] + 50 && tree[1] > tree[2] + 50);
    assert_true(building[0] > building[1] + 80 && building[0] > building[2] + 80);
    assert_true(water[2] > water[0] + 80 && water[2] > water[1] + 80);
}

/// Distance of two colours: in sRGB, weighted as the eye does (redmean).
static double distance(const uint8_t a[3], const uint8_t b[3]) {
    const double red = (a[0] + b[0]) / 2.0, d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt((2 + red / 256) * d[0] * d[0] + 4 * d[1] * d[1] + (2 + (255 - red) / 256) * d[2] * d[2]);
}

/// Known classes are told apart, and so are any twelve codes in a row beyond; of the first 120 no two are alike.
TEST(test_apart) {
    for (uint32_t i = 0; i < 400; i++) {
        for (uint32_t j = i < 19 ? 0 : i < 31 ? 19 : i - 12; j < i; j++) {
            uint8_t a[3], b[3];
            ewa_class_color(i, a), ewa_class_color(j, b);
            if (distance(a, b) < 40) print_error("%u and %u: %g\n", i, j, distance(a, b));
            assert_true(distance(a, b) >= 40);
        }
    }
    for (uint32_t i = 0; i < 120; i++) {
        for (uint32_t j = 0; j < i; j++) {
            uint8_t a[3], b[3];
            ewa_class_color(i, a), ewa_class_color(j, b);
            assert_memory_not_equal(a, b, 3);
        }
    }
    uint8_t last[3];
    ewa_class_color(UINT32_MAX, last);
    assert_true(last[0] > 60 || last[1] > 60 || last[2] > 60);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
