// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Text with numbers, the same in every locale: conversions are done one by one, so that the decimal point of each number can be told
// from what stands beside it. There is no portable way to ask for another locale in one thread.
#include "base/format.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { CONVERSION_BYTES = 64 };

/// Text that is being written; what does not fit is counted.
typedef struct writer {
    char *text;
    size_t bytes, length;
} writer;

static char *rest_of(const writer *to) { return to->length < to->bytes ? to->text + to->length : NULL; }
static size_t room_of(const writer *to) { return to->length < to->bytes ? to->bytes - to->length : 0; }

static void count(writer *to, int length) { to->length += length > 0 ? (size_t)length : 0; }

static void write_plain(writer *to, const char *from, size_t length) {
    const size_t room = room_of(to), fits = room ? (length < room ? length : room - 1) : 0;
    if (room) {
        memcpy(rest_of(to), from, fits);
        rest_of(to)[fits] = 0;
    }
    to->length += length;
}

/// Writes a number by a conversion with a point for whatever stands for it.
static void write_real(writer *to, const char *conversion, double value) {
    enum { NUMBER_BYTES = 512 }; // the largest double has 309 digits before its point
    char number[NUMBER_BYTES];
    const int length = snprintf(number, sizeof number, conversion, value);
    if (length < 0 || length >= NUMBER_BYTES) return;
    size_t kept = 0;
    bool point = false;
    for (int i = 0; i < length; i++) {
        const bool plain = strchr("0123456789+-eExXabcdfABCDFpPinfINFty ", number[i]) != NULL;
        if (plain)
            number[kept++] = number[i];
        else if (!point)
            number[kept++] = '.';
        point = !plain;
    }
    write_plain(to, number, kept);
}

/// The parts of a conversion.
typedef struct conversion {
    char spec[CONVERSION_BYTES]; ///< "%", flags, width and precision
    size_t length;
    char size[3], letter;
} conversion;

/// Adds "12" or, of "*", the argument to a conversion. The text behind it.
static const char *add_number(const char *at, va_list *arguments, conversion *to) {
    if (*at == '*') {
        const int number = va_arg(*arguments, int);
        to->length += (size_t)snprintf(to->spec + to->length, sizeof to->spec - to->length, "%d", number);
        return at + 1;
    }
    while (*at >= '0' && *at <= '9' && to->length < CONVERSION_BYTES / 2) to->spec[to->length++] = *at++;
    return at;
}

/// Reads the conversion behind a percent sign; the text behind it, NULL where there is none.
static const char *read_conversion(const char *at, va_list *arguments, conversion *found) {
    *found = (conversion){.spec = "%", .length = 1};
    while (*at && strchr("-+ #0", *at) && found->length < CONVERSION_BYTES / 4) found->spec[found->length++] = *at++;
    at = add_number(at, arguments, found);
    if (*at == '.') {
        found->spec[found->length++] = *at++;
        at = add_number(at, arguments, found);
    }
    for (size_t n = 0; *at && strchr("hlzjt", *at) && n < 2; n++) found->size[n] = *at++;
    found->letter = *at;
    return *at ? at + 1 : NULL;
}

static intmax_t read_signed(const char *size, va_list *arguments) {
    if (strcmp(size, "ll") == 0) return va_arg(*arguments, long long);
    if (strcmp(size, "l") == 0) return va_arg(*arguments, long);
    if (strcmp(size, "z") == 0 || strcmp(size, "t") == 0) return va_arg(*arguments, ptrdiff_t);
    if (strcmp(size, "j") == 0) return va_arg(*arguments, intmax_t);
    const int number = va_arg(*arguments, int);
    return strcmp(size, "hh") == 0 ? (signed char)number : strcmp(size, "h") == 0 ? (short)number : number;
}

static uintmax_t read_unsigned(const char *size, va_list *arguments) {
    if (strcmp(size, "ll") == 0) return va_arg(*arguments, unsigned long long);
    if (strcmp(size, "l") == 0) return va_arg(*arguments, unsigned long);
    if (strcmp(size, "z") == 0 || strcmp(size, "t") == 0) return va_arg(*arguments, size_t);
    if (strcmp(size, "j") == 0) return va_arg(*arguments, uintmax_t);
    const unsigned number = va_arg(*arguments, unsigned);
    return strcmp(size, "hh") == 0 ? (unsigned char)number : strcmp(size, "h") == 0 ? (unsigned short)number : number;
}

/// Writes what a conversion says; false: it is none of those that are known.
static bool convert(writer *to, conversion *of, va_list *arguments) {
    char *end = of->spec + of->length;
    const char letter[2] = {of->letter, 0};
    if (of->letter == '%') {
        write_plain(to, "%", 1);
    } else if (strchr("di", of->letter)) {
        snprintf(end, sizeof of->spec - of->length, "j%s", letter);
        count(to, snprintf(rest_of(to), room_of(to), of->spec, read_signed(of->size, arguments)));
    } else if (strchr("uxXo", of->letter)) {
        snprintf(end, sizeof of->spec - of->length, "j%s", letter);
        count(to, snprintf(rest_of(to), room_of(to), of->spec, read_unsigned(of->size, arguments)));
    } else if (strchr("fFeEgGaA", of->letter)) {
        memcpy(end, letter, sizeof letter);
        write_real(to, of->spec, va_arg(*arguments, double));
    } else if (of->letter == 's') {
        memcpy(end, letter, sizeof letter);
        count(to, snprintf(rest_of(to), room_of(to), of->spec, va_arg(*arguments, const char *)));
    } else if (of->letter == 'c') {
        memcpy(end, letter, sizeof letter);
        count(to, snprintf(rest_of(to), room_of(to), of->spec, va_arg(*arguments, int)));
    } else if (of->letter == 'p') {
        memcpy(end, letter, sizeof letter);
        count(to, snprintf(rest_of(to), room_of(to), of->spec, va_arg(*arguments, void *)));
    } else {
        return false;
    }
    return true;
}

int ewa_format_list(char *text, size_t text_bytes, const char *format, va_list given) {
    va_list arguments;
    va_copy(arguments, given);
    writer to = {text, text_bytes, 0};
    conversion found;
    if (text_bytes) text[0] = 0;
    for (const char *at = format; at && *at;) {
        const size_t plain = strcspn(at, "%");
        write_plain(&to, at, plain);
        at += plain;
        if (!*at) break;
        at = read_conversion(at + 1, &arguments, &found);
        if (at && !convert(&to, &found, &arguments)) break;
    }
    va_end(arguments);
    return to.length < INT_MAX ? (int)to.length : INT_MAX;
}

int ewa_format(char *text, size_t text_bytes, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = ewa_format_list(text, text_bytes, format, arguments);
    va_end(arguments);
    return length;
}
