// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines and fields of text headers, never beyond the end of the bytes.
#ifndef EWA_SRC_VOLUME_TEXT_H
#define EWA_SRC_VOLUME_TEXT_H

#include "io/number.h"
#include "io/reader.h"

#include <stdio.h>
#include <strings.h>

enum { EWA_LINE_BYTES = 4096 };

/// Copies the next line without its end to `line`, zero-terminated, other zero bytes as '?'. The last line
/// may lack its line feed. False at the end, or when the line is too long (then `reader->failed`).
static inline bool ewa_text_line(ewa_reader *reader, char line[EWA_LINE_BYTES]) {
    const uint64_t left = ewa_reader_left(reader);
    if (!left || reader->failed) return false;
    const uint8_t *from = reader->bytes + reader->at_bytes, *end = memchr(from, '\n', (size_t)left);
    uint64_t length = end ? (uint64_t)(end - from) : left;
    const uint64_t stepped = end ? length + 1 : left;
    if (length >= EWA_LINE_BYTES) {
        reader->failed = true;
        return false;
    }
    for (uint64_t i = 0; i < length; i++) line[i] = from[i] ? (char)from[i] : '?';
    while (length && (line[length - 1] == '\r' || line[length - 1] == ' ')) length--;
    line[length] = 0;
    reader->at_bytes += stepped;
    return true;
}

static inline const char *ewa_text_skip_blanks(const char *text) {
    while (*text == ' ' || *text == '\t') text++;
    return text;
}

/// Reads up to `maximum` numbers separated by blanks; returns how many, or -1 when something else is between.
static inline int ewa_text_numbers(const char *text, int maximum, double *numbers) {
    const char *end = text + strlen(text);
    for (int count = 0;; count++) {
        text = ewa_text_skip_blanks(text);
        if (!*text) return count;
        if (count == maximum) return -1;
        text = ewa_number_read_f64(text, end, &numbers[count]);
        if (!text) return -1;
    }
}

/// The same for whole numbers >= 0.
static inline int ewa_text_counts(const char *text, int maximum, uint64_t *numbers) {
    const char *end = text + strlen(text);
    for (int count = 0;; count++) {
        text = ewa_text_skip_blanks(text);
        if (!*text) return count;
        int64_t number;
        text = count < maximum ? ewa_number_read_i64(text, end, &number) : NULL;
        if (!text || number < 0) return -1;
        numbers[count] = (uint64_t)number;
    }
}

/// A word and what it stands for.
typedef struct ewa_text_word {
    const char *word;
    int value;
} ewa_text_word;

/// Returns the value of a word in any case, or -1.
static inline int ewa_text_find(const ewa_text_word *words, size_t count, const char *text) {
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(words[i].word, text) == 0) return words[i].value;
    return -1;
}

#endif
