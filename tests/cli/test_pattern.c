// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of cli/base/pattern.c: names of numbered files.
#include "check.h"
#include "cli/base/pattern.h"

#include <string.h>

TEST(test_numbered) {
    static const char *const good[] = {"%d", "a%d.png", "a%04d.png", "a%9d", "%%%d%%", "f%%d_%02d.exr"};
    static const char *const bad[] = {"",      "a.png", "%%d",   "%d%d", "%i",   "%5",  "%s",    "%n",
                                      "a%10d", "a%ld",  "a%-3d", "a%+d", "a% d", "%0d", "%00d",  "%",
                                      "%d%",   "%.3d",  "%1$d",  "%*d",  "%d%s", "%x",  "%012d", "%D"};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        if (!pattern_is_numbered(good[i])) fail_msg("'%s' is refused", good[i]);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        if (pattern_is_numbered(bad[i])) fail_msg("'%s' is accepted", bad[i]);
}

TEST(test_expand) {
    static const struct {
        const char *pattern;
        uint64_t number;
        const char *text;
    } cases[] = {
        {"a%04d.png", 7, "a0007.png"}, {"a%04d.png", 12345, "a12345.png"}, {"%d", 0, "0"}, {"%3d", 5, "  5"},
        {"%%%d%%", 2, "%2%"},          {"x%%d%02d", 3, "x%d03"},
    };
    char text[16];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_true(pattern_expand(cases[i].pattern, cases[i].number, sizeof text, text));
        assert_string_equal(text, cases[i].text);
    }
    // A text of 15 bytes and its end just fit.
    assert_true(pattern_expand("12345678901234%d", 5, sizeof text, text));
    assert_string_equal(text, "123456789012345");
    assert_false(pattern_expand("123456789012345%d", 5, sizeof text, text));
    assert_false(pattern_expand("1234567890%9d", 5, sizeof text, text));
    assert_false(pattern_expand("%d234567890123456", 5, sizeof text, text));
}

int main(void) { return RUN_TESTS(NULL, NULL); }
