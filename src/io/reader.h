// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A cursor over untrusted bytes: every step is checked against the end in 64 bits, and the first step too far
// sticks, so that a parser may take several steps and ask once.
#ifndef EWA_SRC_READER_H
#define EWA_SRC_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// A number, lowest byte first, anywhere in memory.
static inline uint32_t ewa_bytes_u32(const uint8_t *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/// How many bytes of UTF-8's byte order mark a text begins with: 0 or 3.
static inline uint32_t ewa_bytes_mark(const void *text, uint64_t size_bytes) {
    return size_bytes >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

/// Whether a text begins with a word, perhaps behind a byte order mark.
static inline bool ewa_bytes_begin(const void *text, uint64_t size_bytes, const char *word) {
    const uint32_t mark = ewa_bytes_mark(text, size_bytes);
    const size_t length = strlen(word);
    return size_bytes >= mark + length && memcmp((const char *)text + mark, word, length) == 0;
}

typedef struct ewa_reader {
    const uint8_t *bytes;
    uint64_t size_bytes;
    uint64_t at_bytes; ///< never beyond size_bytes
    bool failed;       ///< something beyond the end was asked for
} ewa_reader;

static inline uint64_t ewa_reader_left(const ewa_reader *reader) {
    return reader->size_bytes - reader->at_bytes;
}

/// Returns the next `size_bytes` bytes and steps over them, or NULL from the first failure on.
static inline const uint8_t *ewa_reader_take(ewa_reader *reader, uint64_t size_bytes) {
    if (reader->failed || size_bytes > ewa_reader_left(reader)) {
        reader->failed = true;
        return NULL;
    }
    const uint8_t *taken = reader->bytes + reader->at_bytes;
    reader->at_bytes += size_bytes;
    return taken;
}

/// Returns the bytes before the next `line_end` and steps over both; fails when no `line_end` follows.
static inline const uint8_t *ewa_reader_take_line(ewa_reader *reader, uint8_t line_end,
                                                  uint64_t *length_bytes) {
    const uint8_t *line = reader->bytes + reader->at_bytes;
    const uint8_t *end = reader->failed ? NULL : memchr(line, line_end, (size_t)ewa_reader_left(reader));
    if (!end) {
        reader->failed = true;
        return NULL;
    }
    *length_bytes = (uint64_t)(end - line);
    reader->at_bytes += *length_bytes + 1;
    return line;
}

#endif
