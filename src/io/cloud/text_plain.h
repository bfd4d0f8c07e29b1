// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The lines that nearly all lines of a table are: plain numbers, signs and digits and at most one point. Which
// bytes are no digits is found for 64 bytes at once; from one of these to the next, a line falls into cells
// without a look at any digit. Every other line is left to code that looks at each byte.
#ifndef EWA_SRC_TEXT_PLAIN_H
#define EWA_SRC_TEXT_PLAIN_H

#include "io/cloud/text_table.h"

enum { EWA_PLAIN_BLOCK_BYTES = 64, EWA_PLAIN_DIGITS = 8 };

/// A cell: digits from `start` to `point`, and, where `end` is behind that, from `point` + 1 to `end`.
typedef struct ewa_plain_cell {
    const char *start, *point, *end;
    bool negative, with_sign;
} ewa_plain_cell;

/// A walk over the bytes that are no digits.
typedef struct ewa_plain_walk {
    const char *block, *last; ///< last: the last place where a block may begin
    uint64_t bits;            ///< of this block, those that are left, least first
} ewa_plain_walk;

/// The bytes of a block that are no digits, as bits, least first.
static inline uint64_t ewa_plain_find(const char *text) {
    uint64_t bits = 0;
    for (int i = 0; i < EWA_PLAIN_BLOCK_BYTES / 8; i++) {
        uint64_t word;
        memcpy(&word, text + 8 * i, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
        word = __builtin_bswap64(word);
#endif
        word ^= 0x3030303030303030u; // digits become 0 to 9, everything else more
        const uint64_t others = ((word + 0x7676767676767676u) | word) >> 7 & 0x0101010101010101u;
        bits |= (others * 0x0102040810204080u >> 56) << 8 * i;
    }
    return bits;
}

/// Begins a walk at a line. `text_end`: no byte there or behind it is read.
static inline ewa_plain_walk ewa_plain_begin(const char *at, const char *text_end) {
    ewa_plain_walk walk = {.block = at, .last = at - 1};
    if (text_end - at <= EWA_PLAIN_BLOCK_BYTES) return walk;
    walk.last = text_end - EWA_PLAIN_BLOCK_BYTES - 1; // the byte behind a block is looked at
    walk.bits = ewa_plain_find(at);
    return walk;
}

/// Returns the next byte that is no digit, NULL near the end of the text.
static inline const char *ewa_plain_next(ewa_plain_walk *walk) {
    while (walk->bits == 0) {
        if (walk->last - walk->block < EWA_PLAIN_BLOCK_BYTES) return NULL;
        walk->block += EWA_PLAIN_BLOCK_BYTES;
        walk->bits = ewa_plain_find(walk->block);
    }
    const char *found = walk->block + __builtin_ctzll(walk->bits);
    walk->bits &= walk->bits - 1;
    return found;
}

/// Steps over blanks and at most one separator, to the begin of a cell or the end of a line; false at what
/// makes an empty cell, and near the end of the text.
static inline bool ewa_plain_skip(const ewa_text_layout *layout, ewa_plain_walk *walk, const char **at,
                                  bool separated) {
    for (;; ++*at) {
        const ewa_text_class class = (ewa_text_class)layout->classes[(uint8_t) * *at];
        if (class != EWA_TEXT_BLANK && class != EWA_TEXT_SEPARATOR) return true;
        if (class == EWA_TEXT_SEPARATOR && separated) return false;
        separated |= class == EWA_TEXT_SEPARATOR;
        if (!ewa_plain_next(walk)) return false;
    }
}

/// Splits the line at `at`, where the walk is, into the cells of all columns; returns where the next line
/// begins, or NULL when it is not plain.
static inline const char *ewa_plain_split(const ewa_text_layout *layout, ewa_plain_walk *walk, const char *at,
                                          ewa_plain_cell *cells) {
    if (layout->words || walk->last < walk->block || !ewa_plain_skip(layout, walk, &at, true)) return NULL;
    for (uint32_t c = 0; c < layout->column_count; c++) {
        const char *next = ewa_plain_next(walk);
        if (!next) return NULL;
        ewa_text_class class = (ewa_text_class)layout->classes[(uint8_t)*next];
        ewa_plain_cell cell = {.with_sign = class == EWA_TEXT_SIGN};
        if (cell.with_sign) {
            if (next != at || !(next = ewa_plain_next(walk))) return NULL;
            cell.negative = *at++ == '-';
            class = (ewa_text_class)layout->classes[(uint8_t)*next];
        }
        const bool with_point = class == EWA_TEXT_POINT;
        cell.start = at;
        cell.point = next;
        if (with_point) {
            if (!(next = ewa_plain_next(walk))) return NULL;
            class = (ewa_text_class)layout->classes[(uint8_t)*next];
        }
        cell.end = next;
        if (next - at == with_point) return NULL; // no digit
        cells[c] = cell;
        at = next;
        if (class == EWA_TEXT_BLANK || class == EWA_TEXT_SEPARATOR) {
            if ((uint8_t)(*++at - '0') < 10) continue;
            if (!ewa_plain_skip(layout, walk, &at, class == EWA_TEXT_SEPARATOR)) return NULL;
            if (layout->classes[(uint8_t)*at] != EWA_TEXT_LINE_END) continue;
            if (!ewa_plain_next(walk)) return NULL;
        } else if (class != EWA_TEXT_LINE_END) {
            return NULL;
        }
        return c + 1 == layout->column_count ? at + 1 : NULL;
    }
    return NULL; // more than the last column
}

/// Returns the number of up to 8 digits that end at `end`; the 8 bytes before that must be there.
static inline uint64_t ewa_plain_digits(const char *end, size_t count) {
    static const uint64_t masks[EWA_PLAIN_DIGITS + 1] = {
        0, ~0ull << 56, ~0ull << 48, ~0ull << 40, ~0ull << 32, ~0ull << 24, ~0ull << 16, ~0ull << 8, ~0ull};
    uint64_t word;
    memcpy(&word, end - EWA_PLAIN_DIGITS, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    word = (word ^ 0x3030303030303030u) & masks[count];
    word = word * 10 + (word >> 8); // pairs of digits in every other byte
    return ((word & 0x000000ff000000ffu) * 0x000f424000000064u +
            (word >> 16 & 0x000000ff000000ffu) * 0x0000271000000001u) >>
           32;
}

#endif
