// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Blocks of LZ4: literals, then a copy of what has been unpacked, in turns; the last ones are literals. They are too little
// to need a library for.
//
// Based on: Y. Collet, "LZ4 Block Format Description", revision of 2022.
#include "io/lz4.h"

#include <string.h>

enum { MORE = 15, MIN_COPY = 4 };

/// A length: four bits, and where these are all set bytes behind them until one is not 255. False when bytes lack.
static bool read_length(const uint8_t **at, const uint8_t *end, size_t bits, size_t *length) {
    *length = bits;
    for (uint8_t byte = 255; bits == MORE && byte == 255; *length += byte) {
        if (*at == end) return false;
        byte = *(*at)++;
    }
    return true;
}

bool ewa_lz4_unpack(const uint8_t *from, size_t from_bytes, uint8_t *to, size_t to_bytes) {
    const uint8_t *at = from, *end = from + from_bytes;
    size_t done = 0, length;
    while (at < end) {
        const uint8_t token = *at++;
        if (!read_length(&at, end, token >> 4, &length) || length > (size_t)(end - at) || length > to_bytes - done) return false;
        memcpy(to + done, at, length);
        at += length, done += length;
        if (at == end) break;
        if (end - at < 2) return false;
        const size_t offset = at[0] | (size_t)at[1] << 8;
        at += 2;
        if (!read_length(&at, end, token & MORE, &length) || offset == 0 || offset > done) return false;
        length += MIN_COPY;
        if (length > to_bytes - done) return false;
        for (size_t i = 0; i < length; i++, done++) to[done] = to[done - offset]; // which may overlap
    }
    return done == to_bytes;
}
