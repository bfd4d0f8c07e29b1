// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edits of headers: of words where the input begins with lines of text (PLY, PCD, NRRD, COLMAP, OBJ), of binary fields
// otherwise.
#include "grammar.h"

#include <math.h>
#include <string.h>

enum { WORDS = 512, HEADER_BYTES = 4096 };

static bool is_blank(uint8_t c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Lists words (kind 'w') and lines (kind 'l') of the text that the input begins with.
static void list_words(const fuzz_input *input, fuzz_spans *spans) {
    size_t word = 0, line = 0;
    spans->count = 0;
    for (size_t at = 0; at < input->size_bytes && at < HEADER_BYTES && spans->count < WORDS; at++) {
        const uint8_t c = input->bytes[at];
        if (!is_blank(c) && (c < ' ' || c > '~')) break;
        if (!is_blank(c)) continue;
        if (at > word) fuzz_note(spans, word, at, word, 'w');
        word = at + 1;
        if (c != '\n') continue;
        fuzz_note(spans, line, at + 1, line, 'l');
        line = at + 1;
    }
}

bool fuzz_words_edit(fuzz_input *input) {
    static const char *const words[] = {"nan", "-inf", "", "x", "double", "char", "list", "../../etc/passwd", "0x7fffffff"};
    fuzz_spans spans;
    list_words(input, &spans);
    if (spans.count < 4) return false;
    const fuzz_span *span = &spans.items[fuzz_below(input, (uint32_t)spans.count)];
    const fuzz_span *from = &spans.items[fuzz_below(input, (uint32_t)spans.count)];
    const char *word = fuzz_below(input, 3) ? fuzz_number_word(input) : words[fuzz_below(input, sizeof words / sizeof *words)];
    const uint32_t choice = fuzz_below(input, 6);
    if (span->kind == 'l' && choice == 0)
        fuzz_splice(input, span->begin, span->end, "", 0);
    else if (span->kind == 'l' || choice < 2)
        fuzz_splice(input, span->begin, span->kind == 'l' && choice < 3 ? span->begin : span->end,
                    input->bytes + from->begin, from->end - from->begin);
    else if (choice == 2)
        fuzz_change_number(input, span);
    else
        fuzz_splice(input, span->begin, span->end, word, strlen(word));
    return true;
}

/// A field: where it is and how many bytes it has; 'f' for floating point, 'u' otherwise.
typedef struct field {
    uint32_t at, bytes;
    char kind;
} field;

/// Headers by the bytes that they begin with.
static const struct {
    const char *magic;
    field fields[40];
} formats[] = {
    // "LAS Specification 1.4 - R15", table 3.
    {"LASF", {{4, 2, 'u'},   {6, 2, 'u'},   {24, 1, 'u'},  {25, 1, 'u'},  {94, 2, 'u'},  {96, 4, 'u'},  {100, 4, 'u'},
              {104, 1, 'u'}, {105, 2, 'u'}, {107, 4, 'u'}, {111, 4, 'u'}, {131, 8, 'f'}, {139, 8, 'f'}, {147, 8, 'f'},
              {155, 8, 'f'}, {163, 8, 'f'}, {171, 8, 'f'}, {179, 8, 'f'}, {187, 8, 'f'}, {195, 8, 'f'}, {203, 8, 'f'},
              {211, 8, 'f'}, {219, 8, 'f'}, {227, 8, 'u'}, {235, 8, 'u'}, {243, 4, 'u'}, {247, 8, 'u'}, {255, 8, 'u'},
              // The record that follows: its length, and what a COPC or LAZ file begins it with.
              {393, 2, 'u'}, {395, 2, 'u'}, {429, 8, 'f'}, {453, 8, 'f'}, {461, 8, 'f'}, {469, 8, 'u'}, {477, 8, 'u'}}},
    // ASTM E2807, table 1.
    {"ASTM-E57", {{8, 4, 'u'}, {12, 4, 'u'}, {16, 8, 'u'}, {24, 8, 'u'}, {32, 8, 'u'}, {40, 8, 'u'},
                  // The section of points: its length, where its data and its index are.
                  {56, 8, 'u'}, {64, 8, 'u'}, {72, 8, 'u'}, {80, 1, 'u'}, {82, 2, 'u'}, {84, 2, 'u'}, {86, 2, 'u'}}},
    {"glTF", {{4, 4, 'u'}, {8, 4, 'u'}, {12, 4, 'u'}, {16, 4, 'u'}}},
    {"NGSP", {{4, 4, 'u'}, {8, 4, 'u'}, {12, 1, 'u'}, {13, 1, 'u'}, {14, 1, 'u'}, {15, 1, 'u'}, {16, 4, 'u'}, {20, 4, 'u'}}},
    // NIfTI-1, by the size of its header.
    {"\x5c\x01", {{0, 4, 'u'},  {40, 2, 'u'}, {42, 2, 'u'}, {44, 2, 'u'}, {46, 2, 'u'}, {48, 2, 'u'}, {70, 2, 'u'}, {72, 2, 'u'},
                  {76, 4, 'f'}, {80, 4, 'f'}, {84, 4, 'f'}, {88, 4, 'f'}, {108, 4, 'f'}, {112, 4, 'f'}, {116, 4, 'f'}}},
    {"\x89PNG", {{8, 4, 'u'}, {16, 4, 'u'}, {20, 4, 'u'}, {24, 1, 'u'}, {25, 1, 'u'}, {28, 1, 'u'}}},
};

/// Writes a whole number that readers are known to stumble over, some of them as large as the input.
static void put_whole(fuzz_input *input, size_t at, size_t bytes) {
    const uint64_t size = input->size_bytes, bits = 8 * bytes;
    const uint64_t values[] = {0, 1, 2, 255, 65535, 0x7fffffff, 0x80000000, 0xffffffff, UINT64_MAX, 1ull << (bits - 1),
                               (1ull << (bits - 1)) - 1, size, size - 1, size + 1, size - at, 1ull << fuzz_below(input, 63)};
    uint64_t value = values[fuzz_below(input, sizeof values / sizeof *values)];
    if (fuzz_below(input, 3) == 0) {
        value = 0;
        memcpy(&value, input->bytes + at, bytes);
        value += fuzz_below(input, 9) - 4u;
    }
    const bool turned = fuzz_below(input, 8) == 0;
    for (size_t i = 0; i < bytes; i++) input->bytes[at + (turned ? bytes - 1 - i : i)] = (uint8_t)(value >> (8 * i));
}

static void put_float(fuzz_input *input, size_t at, size_t bytes) {
    static const double values[] = {0, -0.0, 1, -1, 1e-320, 1e-45, 3.5e38, 1e308, NAN, INFINITY, -INFINITY, 0.1, 4294967296.0};
    const double value = values[fuzz_below(input, sizeof values / sizeof *values)];
    const float single = (float)value;
    memcpy(input->bytes + at, bytes == 8 ? (const void *)&value : (const void *)&single, bytes);
}

void fuzz_field_edit(fuzz_input *input) {
    field chosen = {0};
    const bool known = fuzz_below(input, 4) > 0;
    for (size_t i = 0; known && i < sizeof formats / sizeof *formats; i++) {
        const size_t length = strlen(formats[i].magic);
        if (input->size_bytes < length || memcmp(input->bytes, formats[i].magic, length) != 0) continue;
        uint32_t count = 0;
        while (count < 40 && formats[i].fields[count].bytes) count++;
        chosen = formats[i].fields[fuzz_below(input, count)];
    }
    if (!chosen.bytes) {
        // Headers are at the beginning, tables often at the end.
        const uint32_t size = input->size_bytes < 1u << 20 ? (uint32_t)input->size_bytes : 1u << 20;
        const uint32_t bytes = 1u << fuzz_below(input, 4);
        if (size < bytes) return;
        const uint32_t near = size - bytes + 1 < 256 ? size - bytes + 1 : 256;
        const uint32_t place = fuzz_below(input, 4);
        const uint32_t at = place < 2    ? fuzz_below(input, near)
                            : place == 2 ? size - bytes - fuzz_below(input, near)
                                         : fuzz_below(input, size - bytes + 1);
        chosen = (field){at, bytes, bytes >= 4 && fuzz_below(input, 2) ? 'f' : 'u'};
    }
    if ((size_t)chosen.at + chosen.bytes > input->size_bytes) return;
    if (chosen.kind == 'f')
        put_float(input, chosen.at, chosen.bytes);
    else
        put_whole(input, chosen.at, chosen.bytes);
}
