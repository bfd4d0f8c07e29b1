// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pieces of text in files: words, lines, numbers, names. Nothing is terminated, nothing is believed.
#ifndef EWA_SRC_TEXT_H
#define EWA_SRC_TEXT_H

#include "ewa/base.h"
#include "ewa/options.h"

#include <string.h>

enum { EWA_QUOTE_BYTES = 48 };

/// A piece of a file's text, not terminated.
typedef struct ewa_text {
    const char *chars;
    size_t length;
} ewa_text;

/// Makes a piece of a file fit for a message: printable, quoted, cut when long. Returns `quote`.
const char *ewa_quote(ewa_text text, char quote[EWA_QUOTE_BYTES]);

/// Says in `problem`, which may be NULL, what is wrong with a text. Returns EWA_ERROR_ARGUMENT.
__attribute__((format(printf, 2, 3))) ewa_status ewa_text_wrong(char problem[EWA_OPTION_TEXT_BYTES], const char *format, ...);

/// Whether a piece is this word.
static inline bool ewa_text_is(ewa_text text, const char *word) {
    return text.length == strlen(word) && memcmp(text.chars, word, text.length) == 0;
}

/// The same without regard to the case of ASCII letters.
bool ewa_text_is_any_case(ewa_text text, const char *word);

/// Whether a piece can be a name: UTF-8 without blanks and control characters.
bool ewa_text_is_name(ewa_text text);

/// A place in text that consists of lines.
typedef struct ewa_cursor {
    const char *at, *end;
    uint64_t line; ///< number of the line, from 1
} ewa_cursor;

/// Text of a file as bytes of UTF-8: the file's own, less a byte order mark, or, of UTF-16, new ones that
/// `*owned` holds with `*owned_bytes` for ewa_release() (else NULL). Errors: EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
ewa_status ewa_text_open(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                         ewa_cursor *cursor, char **owned, size_t *owned_bytes);

static inline bool ewa_is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
static inline bool ewa_is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Steps over one line end, "\r\n" as one.
static inline void ewa_cursor_step_line(ewa_cursor *cursor) {
    if (cursor->at == cursor->end) return;
    const char first = *cursor->at++;
    if (first == '\r' && cursor->at < cursor->end && *cursor->at == '\n') cursor->at++;
    cursor->line++;
}

/// Steps over blanks of this line, also over a backslash and the line end behind it.
static inline void ewa_cursor_skip_blanks(ewa_cursor *cursor) {
    while (cursor->at < cursor->end) {
        if (ewa_is_blank(*cursor->at)) {
            cursor->at++;
        } else if (*cursor->at == '\\' && cursor->at + 1 < cursor->end && ewa_is_line_end(cursor->at[1])) {
            cursor->at++;
            ewa_cursor_step_line(cursor);
        } else {
            break;
        }
    }
}

/// Steps to the begin of the next line; a backslash before a line end goes on with the line.
static inline void ewa_cursor_next_line(ewa_cursor *cursor) {
    bool escaped = false;
    while (cursor->at < cursor->end) {
        if (ewa_is_line_end(*cursor->at)) {
            ewa_cursor_step_line(cursor);
            if (!escaped) return;
            escaped = false;
        } else {
            escaped = *cursor->at++ == '\\';
        }
    }
}

/// Takes the next word of this line; none (length 0) at its end or where a '#' begins a word.
static inline ewa_text ewa_cursor_word(ewa_cursor *cursor) {
    ewa_cursor_skip_blanks(cursor);
    const char *start = cursor->at;
    if (start < cursor->end && *start == '#') return (ewa_text){start, 0};
    while (cursor->at < cursor->end && !ewa_is_blank(*cursor->at) && !ewa_is_line_end(*cursor->at)) {
        if (*cursor->at == '\\' && cursor->at + 1 < cursor->end && ewa_is_line_end(cursor->at[1])) break;
        cursor->at++;
    }
    return (ewa_text){start, (size_t)(cursor->at - start)};
}

/// Takes the next word of this line or a later one, whatever it begins with; none at the end.
static inline ewa_text ewa_cursor_any_word(ewa_cursor *cursor) {
    while (cursor->at < cursor->end && (ewa_is_blank(*cursor->at) || ewa_is_line_end(*cursor->at)))
        if (ewa_is_line_end(*cursor->at))
            ewa_cursor_step_line(cursor);
        else
            cursor->at++;
    const char *start = cursor->at;
    while (cursor->at < cursor->end && !ewa_is_blank(*cursor->at) && !ewa_is_line_end(*cursor->at)) cursor->at++;
    return (ewa_text){start, (size_t)(cursor->at - start)};
}

/// Takes the rest of this line without blanks around it.
static inline ewa_text ewa_cursor_rest(ewa_cursor *cursor) {
    while (cursor->at < cursor->end && ewa_is_blank(*cursor->at)) cursor->at++;
    const char *start = cursor->at;
    while (cursor->at < cursor->end && !ewa_is_line_end(*cursor->at)) cursor->at++;
    const char *last = cursor->at;
    while (last > start && ewa_is_blank(last[-1])) last--;
    return (ewa_text){start, (size_t)(last - start)};
}

/// Reads a word as a number; false, and NaN, when it is none.
bool ewa_text_number(ewa_text word, double *value);

/// Reads a word as an integer; false when it is none.
bool ewa_text_integer(ewa_text word, int64_t *value);

/// Takes up to `maximum` numbers from this line, up to the first word that is none, which stays; returns how
/// many.
uint32_t ewa_cursor_numbers(ewa_cursor *cursor, uint32_t maximum, double *values);

#endif
