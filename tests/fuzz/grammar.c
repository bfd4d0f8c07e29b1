// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which edit an input gets: the texts in it are found by trying, so that one mutator does for every format.
#include "grammar.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t fuzz_below(fuzz_input *input, uint32_t limit) {
    // Vigna, "An experimental exploration of Marsaglia's xorshift generators, scrambled" (2016): splitmix64.
    uint64_t z = input->random += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (uint32_t)((z ^ z >> 31) % limit);
}

void fuzz_splice(fuzz_input *input, size_t begin, size_t end, const void *with, size_t with_bytes) {
    if (input->full || end > input->size_bytes || begin > end) return;
    uint8_t *copy = malloc(with_bytes + 1);
    input->full = !copy || with_bytes > input->room_bytes - (input->size_bytes - (end - begin));
    if (!input->full) {
        memcpy(copy, with, with_bytes);
        memmove(input->bytes + begin + with_bytes, input->bytes + end, input->size_bytes - end);
        memcpy(input->bytes + begin, copy, with_bytes);
        input->size_bytes += with_bytes - (end - begin);
    }
    free(copy);
}

const char *fuzz_number_word(fuzz_input *input) {
    static const char *const words[] = {
        "0",          "-1",          "1",          "2",          "3",                "255",
        "65536",      "2147483647",  "2147483648", "4294967295", "9007199254740993", "18446744073709551615",
        "0.5",        "-2147483648", "1e308",      "-1e308",     "1e999",            "3.5e38",
        "4294967296", "1e-320",      "1e-45",      "1000000",    "-0",               "18446744073709551616",
    };
    return words[fuzz_below(input, sizeof words / sizeof *words)];
}

void fuzz_change_number(fuzz_input *input, const fuzz_span *span) {
    char text[64];
    const size_t length = span->end - span->begin < 63 ? span->end - span->begin : 63;
    memcpy(text, input->bytes + span->begin, length);
    text[length] = 0;
    const double value = strtod(text, NULL);
    const double near[] = {value + 1, value - 1, 2 * value, 0.5 * value, -value, value + 256, 1e9 * value, 4294967295.0 - value};
    snprintf(text, sizeof text, "%.17g", near[fuzz_below(input, sizeof near / sizeof *near)]);
    fuzz_splice(input, span->begin, span->end, text, strlen(text));
}

void fuzz_note(fuzz_spans *spans, size_t begin, size_t end, size_t whole_begin, char kind) {
    if (spans->count < FUZZ_SPANS) spans->items[spans->count++] = (fuzz_span){begin, end, whole_begin, kind};
}

/// Edits one of the texts of JSON or XML that an input has; false when it has none.
static bool edit_tree(fuzz_input *input) {
    enum { TEXTS = 16 };
    size_t begins[TEXTS];
    uint32_t count = 0;
    fuzz_spans *spans = malloc(sizeof *spans);
    for (size_t at = 0; spans && at < input->size_bytes && count < TEXTS;) {
        const uint8_t c = input->bytes[at];
        const size_t end = c == '<'               ? fuzz_xml_spans(input, at, spans)
                           : c == '{' || c == '[' ? fuzz_json_spans(input, at, spans)
                                                  : 0;
        if (end) begins[count++] = at;
        at = end ? end : at + 1;
    }
    if (count) {
        const size_t begin = begins[fuzz_below(input, count)];
        const bool xml = input->bytes[begin] == '<';
        const size_t end = xml ? fuzz_xml_spans(input, begin, spans) : fuzz_json_spans(input, begin, spans);
        const size_t old_bytes = input->size_bytes;
        if (xml)
            fuzz_xml_edit(input, spans);
        else
            fuzz_json_edit(input, spans);
        fuzz_fit_lengths(input, begin, end, end + input->size_bytes - old_bytes);
    }
    free(spans);
    return count > 0;
}

static void edit(fuzz_input *input) {
    // A tree in binary has more to edit than the header around it; text that is no tree has words only.
    if (fuzz_below(input, 8) && edit_tree(input)) return;
    if (fuzz_below(input, 8) && fuzz_words_edit(input)) return;
    fuzz_field_edit(input);
}

bool fuzz_grammar_edit(uint8_t *bytes, size_t *size_bytes, size_t room_bytes, uint64_t seed) {
    fuzz_input input = {.bytes = malloc(room_bytes + 1), .size_bytes = *size_bytes, .room_bytes = room_bytes, .random = seed}, plain;
    if (!input.bytes || *size_bytes > room_bytes) return free(input.bytes), false;
    memcpy(input.bytes, bytes, *size_bytes);
    // Mostly one edit; what takes two, such as a count and the missing view of it, would wait for the corpus otherwise.
    for (uint32_t edits = 1 + fuzz_below(&input, 3) / 2 * (1 + fuzz_below(&input, 3)); edits && !input.full; edits--) {
        if (fuzz_e57_open(&input, &plain)) {
            edit(&plain);
            input.random = plain.random;
            fuzz_e57_close(&input, &plain);
        } else {
            edit(&input);
        }
    }
    const bool changed = !input.full && (input.size_bytes != *size_bytes || memcmp(input.bytes, bytes, *size_bytes) != 0);
    if (changed) {
        memcpy(bytes, input.bytes, input.size_bytes);
        *size_bytes = input.size_bytes;
    }
    free(input.bytes);
    return changed;
}
