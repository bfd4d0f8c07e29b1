// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Base64 (RFC 4648).
#include "io/mesh/base64.h"

/// The six bits of a digit, or -1.
static int bits_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

size_t ewa_base64_read(const char *text, size_t text_bytes, size_t skipped_bytes, uint8_t *to, size_t room,
                       size_t *used_bytes) {
    size_t done = 0, i = 0;
    uint32_t held = 0;
    int held_bits = 0;
    for (; i < text_bytes && done < room; i++) {
        const char c = text[i];
        if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
        if (c == '=' && held_bits < 6) { // what is left is filling
            held_bits = 0;
            continue;
        }
        const int bits = bits_of(c);
        if (bits < 0) break;
        held = held << 6 | (uint32_t)bits;
        held_bits += 6;
        if (held_bits < 8) continue;
        held_bits -= 8;
        const uint8_t byte = (uint8_t)(held >> held_bits);
        if (skipped_bytes)
            skipped_bytes--;
        else
            to[done++] = byte;
    }
    // A digit alone is no byte.
    if (used_bytes) *used_bytes = i == text_bytes && held_bits == 6 ? i - 1 : i;
    return done;
}
