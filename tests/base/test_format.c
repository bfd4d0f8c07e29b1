// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/base/format.c: texts with numbers, beside snprintf(), and where a program has chosen a locale with a comma.
#include <inttypes.h>
#include <locale.h>
#include <math.h>

#include "base/format.h"
#include "base/options.h"
#include "check.h"

/// Writes the same by both.
#define SAME(...)                                                                                                                      \
    do {                                                                                                                               \
        char own[400], other[400];                                                                                                     \
        const int length = ewa_format(own, sizeof own, __VA_ARGS__);                                                                   \
        assert_int_equal(length, snprintf(other, sizeof other, __VA_ARGS__));                                                          \
        assert_string_equal(own, other);                                                                                               \
    } while (0)

TEST(test_as_snprintf) {
    SAME("%s", "");
    SAME("no number, 100 %%, %c%c", 'a', '%');
    SAME("%d %5d %-5d| %05d %+d % d %i", -3, 42, 42, 42, 7, 8, INT32_MIN);
    SAME("%u %x %#X %o %08lx", 4000000000u, 255u, 255u, 8u, 0xabcdeful);
    SAME("%hhd %hd %hhu %hu", 300 - 512, 70000 - 131072, 200u, 60000u);
    SAME("%ld %lld %llu %zu %" PRIu64 " %jd %td", -5L, -1234567890123LL, 12345678901234ULL, (size_t)-1, UINT64_C(1) << 63, (intmax_t)-9, (ptrdiff_t)-4);
    SAME("%g %.3g %10.4f|%-12.2e|%+.0f %G %a", 0.1, 12345.678, -2.5, 1.5e-300, 3.0, 1e30, 0.75);
    SAME("%.17g %f %g %g %g", 3.14159265358979, -1.7976931348623157e308, (double)NAN, (double)INFINITY, -0.0);
    SAME("%*d|%-*d|%.*f|%*.*g|%.*s", 6, 1, 6, 2, 3, 3.14159265358979, 12, 4, 2.718281828, 3, "abcdef");
    SAME("%.80s, %8s|%-8s|%s: %g, allowed is (0, 4]", "a,b", "x", "y", "a,b.c", 2.5);
    SAME("%p", (void *)0x1234);
}

/// Text that does not fit ends where there is no room, and its length is told.
TEST(test_short) {
    for (size_t bytes = 0; bytes < 24; bytes++) {
        char own[32], other[32];
        memset(own, 'x', sizeof own);
        memset(other, 'x', sizeof other);
        assert_int_equal(ewa_format(own, bytes, "size %d, %.4g of %s", 12, 0.25, "all"),
                         snprintf(other, bytes, "size %d, %.4g of %s", 12, 0.25, "all"));
        assert_memory_equal(own, other, sizeof own);
    }
}

/// Chooses a locale whose numbers have commas: one of the system's, else one that is compiled here.
static bool choose_commas(void) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (setlocale(LC_NUMERIC, names[i])) return true;
#ifdef __GLIBC__
    if (system("localedef -i de_DE -f UTF-8 ./de_DE.UTF-8 >/dev/null 2>&1") != 0) return false;
    setenv("LOCPATH", ".", 1);
#endif
    return setlocale(LC_NUMERIC, "de_DE.UTF-8") != NULL;
}

TEST(test_commas) {
    char text[200];
    if (!choose_commas()) skip();
    snprintf(text, sizeof text, "%.1f", 0.5);
    assert_string_equal(text, "0,5");
    assert_int_equal(ewa_format(text, sizeof text, "%s: %g,%8.3f,%.2e|%d", "a,b", 2.5, -1e6, 1.5e-7, 3), 32);
    assert_string_equal(text, "a,b: 2.5,-1000000.000,1.50e-07|3");
    setlocale(LC_NUMERIC, "C");
}

/// What the library says, through a context.
static void keep(void *user, ewa_severity severity, const char *message) {
    (void)severity;
    snprintf(user, 200, "%s", message);
}

TEST(test_messages) {
    char said[200] = "";
    if (!choose_commas()) skip();
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = keep;
    options.message_user = said;
    ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(&options, &context), EWA_OK);
    ewa_surfels_options surfels;
    ewa_surfels_options_init(&surfels, sizeof surfels);
    surfels.cutoff = -1.5;
    assert_int_equal(ewa_options_check(context, &ewa_surfels_options_table, "surfels", &surfels), EWA_ERROR_ARGUMENT);
    setlocale(LC_NUMERIC, "C");
    assert_non_null(strstr(said, "cutoff is -1.5, allowed is "));
    ewa_context_destroy(&context);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
