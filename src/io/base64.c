// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Bytes as letters: four letters of six bits are three bytes.
#include "io/base64.h"

static int value_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool ewa_base64_decode(const char *letters, size_t length, uint8_t *bytes, size_t *size_bytes) {
    uint32_t bits = 0, count = 0;
    size_t made = 0, at = 0;
    for (; at < length && letters[at] != '='; at++) {
        if (is_space(letters[at])) continue;
        const int value = value_of(letters[at]);
        if (value < 0) return false;
        bits = bits << 6 | (uint32_t)value;
        if (++count % 4) continue;
        bytes[made++] = (uint8_t)(bits >> 16);
        bytes[made++] = (uint8_t)(bits >> 8);
        bytes[made++] = (uint8_t)bits;
    }
    for (; at < length; at++)
        if (letters[at] != '=' && !is_space(letters[at])) return false;
    if (count % 4 == 1) return false;
    if (count % 4 == 2) bytes[made++] = (uint8_t)(bits >> 4);
    if (count % 4 == 3) {
        bytes[made++] = (uint8_t)(bits >> 10);
        bytes[made++] = (uint8_t)(bits >> 2);
    }
    *size_bytes = made;
    return true;
}
