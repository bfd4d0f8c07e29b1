// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sizes of memory and files as people write them.
#include "cli/base/bytes.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char letters[] = "KMGTP";

bool bytes_read(const char *text, uint64_t *bytes) {
    char *end;
    if (!isdigit((unsigned char)text[0]) && text[0] != '.') return false;
    if (text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) return false;
    double number = strtod(text, &end);
    if (end == text) return false;
    const char *letter = *end ? strchr(letters, toupper((unsigned char)*end)) : NULL;
    if (letter) {
        number = ldexp(number, 10 * (int)(letter - letters + 1));
        end++;
        if (*end == 'i' && end[1]) end++;
    }
    if (*end == 'B') end++;
    if (*end || !(number < 0x1p63)) return false;
    *bytes = (uint64_t)number;
    return true;
}

void bytes_write(uint64_t bytes, char text[BYTES_TEXT_BYTES]) {
    int steps = 0;
    while (bytes && bytes % 1024 == 0 && letters[steps]) bytes /= 1024, steps++;
    const char letter[2] = {steps ? letters[steps - 1] : '\0', '\0'};
    snprintf(text, BYTES_TEXT_BYTES, "%" PRIu64 "%s", bytes, letter);
}
