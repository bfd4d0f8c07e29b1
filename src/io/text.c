// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pieces of text in files: quotes for messages, UTF-16, numbers.
//
// UTF-16 by: The Unicode Standard 15.0, section 3.9, table 3-5; UTF-8 by table 3-7 there.
#include "io/text.h"
#include "base/base.h"
#include "base/format.h"
#include "io/number.h"
#include "io/reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

ewa_status ewa_text_wrong(char problem[EWA_OPTION_TEXT_BYTES], const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (problem) ewa_format_list(problem, EWA_OPTION_TEXT_BYTES, format, arguments);
    va_end(arguments);
    return EWA_ERROR_ARGUMENT;
}

const char *ewa_quote(ewa_text text, char quote[EWA_QUOTE_BYTES]) {
    const size_t room = EWA_QUOTE_BYTES - 6; // two quotes, three dots, the zero
    size_t at = 0;
    quote[at++] = '\'';
    for (size_t i = 0; i < text.length && i < room; i++)
        quote[at++] = (char)(text.chars[i] == '\t' ? ' ' : text.chars[i] >= ' ' && text.chars[i] <= '~' ? text.chars[i] : '?');
    if (text.length > room) {
        memcpy(quote + at, "...", 3);
        at += 3;
    }
    quote[at++] = '\'';
    quote[at] = 0;
    return quote;
}

static char lower(char c) { return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

bool ewa_text_is_any_case(ewa_text text, const char *word) {
    if (text.length != strlen(word)) return false;
    for (size_t i = 0; i < text.length; i++)
        if (lower(text.chars[i]) != lower(word[i])) return false;
    return true;
}

bool ewa_text_is_name(ewa_text text) {
    const unsigned char *c = (const unsigned char *)text.chars, *end = c + text.length;
    while (c < end) {
        const unsigned char lead = *c++;
        if (lead <= ' ' || lead == 0x7f || (lead >= 0x80 && lead < 0xc2) || lead > 0xf4) return false;
        const int followers = lead < 0x80 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
        if (end - c < followers) return false;
        if ((lead == 0xe0 && *c < 0xa0) || (lead == 0xed && *c > 0x9f) || (lead == 0xf0 && *c < 0x90) ||
            (lead == 0xf4 && *c > 0x8f))
            return false;
        for (int i = 0; i < followers; i++)
            if ((*c++ & 0xc0) != 0x80) return false;
    }
    return true;
}

bool ewa_text_number(ewa_text word, double *value) {
    const char *end = word.chars + word.length;
    if (word.length && ewa_number_read_f64(word.chars, end, value) == end) return true;
    *value = NAN;
    return false;
}

bool ewa_text_integer(ewa_text word, int64_t *value) {
    const char *end = word.chars + word.length;
    return word.length && ewa_number_read_i64(word.chars, end, value) == end;
}

uint32_t ewa_cursor_numbers(ewa_cursor *cursor, uint32_t maximum, double *values) {
    uint32_t count = 0;
    while (count < maximum) {
        ewa_cursor_skip_blanks(cursor);
        const char *after = ewa_number_read_f64(cursor->at, cursor->end, &values[count]);
        if (!after ||
            (after < cursor->end && !ewa_is_blank(*after) && !ewa_is_line_end(*after) && *after != '\\'))
            break;
        cursor->at = after;
        count++;
    }
    return count;
}

/// Writes a code point as UTF-8; returns how many bytes.
static size_t put_utf8(uint32_t code, char *to) {
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    const int followers = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const uint8_t leads[4] = {0, 0xc0, 0xe0, 0xf0};
    to[0] = (char)(leads[followers] | code >> 6 * followers);
    for (int i = 1; i <= followers; i++) to[i] = (char)(0x80 | (code >> 6 * (followers - i) & 0x3f));
    return (size_t)followers + 1;
}

/// Turns UTF-16 into UTF-8, at most 3 bytes for 2; halves of pairs that stand alone become '?'.
static size_t from_utf16(const uint8_t *bytes, size_t unit_count, bool big_endian, char *to) {
    size_t length = 0;
    for (size_t i = 0; i < unit_count; i++) {
        const uint8_t *b = bytes + 2 * i;
        uint32_t code = big_endian ? (uint32_t)b[0] << 8 | b[1] : (uint32_t)b[1] << 8 | b[0];
        if (code >= 0xd800 && code < 0xe000) {
            const uint8_t *n = b + 2;
            const uint32_t next = i + 1 == unit_count ? 0
                                  : big_endian        ? (uint32_t)n[0] << 8 | n[1]
                                                      : (uint32_t)n[1] << 8 | n[0];
            const bool pair = code < 0xdc00 && next >= 0xdc00 && next < 0xe000;
            code = pair ? 0x10000 + ((code - 0xd800) << 10) + (next - 0xdc00) : '?';
            i += pair;
        }
        length += put_utf8(code, to + length);
    }
    return length;
}

ewa_status ewa_text_open(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                         ewa_cursor *cursor, char **owned, size_t *owned_bytes) {
    *owned = NULL;
    *owned_bytes = 0;
    const bool big = size_bytes >= 2 && bytes[0] == 0xfe && bytes[1] == 0xff,
               little = size_bytes >= 2 && bytes[0] == 0xff && bytes[1] == 0xfe;
    if (!big && !little) {
        const size_t mark = ewa_bytes_mark(bytes, size_bytes);
        const char *text = size_bytes ? (const char *)bytes : "";
        *cursor = (ewa_cursor){text + mark, text + size_bytes, 1};
        return EWA_OK;
    }
    const size_t unit_count = size_bytes / 2 - 1, room = 3 * unit_count;
    EWA_TRY(ewa_memory_check(context, room, "%s: %zu bytes of UTF-16", name, size_bytes));
    char *text = ewa_allocate(context, room, 1);
    if (!text) return EWA_ERROR_MEMORY;
    *owned = text;
    *owned_bytes = room;
    *cursor = (ewa_cursor){text, text + from_utf16(bytes + 2, unit_count, big, text), 1};
    return EWA_OK;
}
