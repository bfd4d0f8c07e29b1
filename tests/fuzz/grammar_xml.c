// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edits of XML: what was well-formed stays so.
#include "grammar.h"

#include <string.h>

/// What is no number.
static const char *const words[] = {
    "", "nan", "inf", "&#65;", "../../etc/passwd", "0 0 0", "0 4294967295 0 4294967295 0 4294967295",
};
enum { WORDS = sizeof words / sizeof *words, MAX_DEPTH = 64 };

static bool is_name(uint8_t c) { return c > ' ' && !strchr("<>/=\"'", c) && c < 128; }

typedef struct scan {
    const uint8_t *bytes;
    size_t size_bytes, at;
    fuzz_spans *spans;
} scan;

/// Steps behind the next `end`; false when there is none.
static bool skip_to(scan *s, const char *end) {
    const size_t length = strlen(end);
    for (; s->at + length <= s->size_bytes; s->at++)
        if (memcmp(s->bytes + s->at, end, length) == 0) return s->at += length, true;
    return false;
}

/// From behind the name of a start tag to behind its end; values of attributes are noted with kind 'a'.
static bool scan_attributes(scan *s, bool *closed) {
    while (s->at < s->size_bytes && s->bytes[s->at] != '>') {
        const size_t begin = s->at;
        const uint8_t c = s->bytes[s->at++];
        *closed = c == '/';
        if (!is_name(c)) continue;
        while (s->at < s->size_bytes && is_name(s->bytes[s->at])) s->at++;
        if (s->at + 1 >= s->size_bytes || s->bytes[s->at] != '=' || !strchr("\"'", s->bytes[s->at + 1])) return false;
        const char quote[2] = {(char)s->bytes[s->at + 1], 0};
        const size_t value = s->at += 2;
        if (!skip_to(s, quote)) return false;
        fuzz_note(s->spans, value, s->at - 1, begin, 'a');
    }
    return s->at++ < s->size_bytes;
}

size_t fuzz_xml_spans(const fuzz_input *input, size_t begin, fuzz_spans *spans) {
    size_t open[MAX_DEPTH];
    int depth = 0;
    spans->count = 0;
    scan s = {input->bytes, input->size_bytes, begin, spans};
    do {
        const size_t at = s.at;
        if (s.size_bytes - at < 4) return 0;
        if (s.bytes[at] != '<') {
            while (s.at < s.size_bytes && s.bytes[s.at] != '<') s.at++;
            if (depth) fuzz_note(spans, at, s.at, at, 't');
            continue;
        }
        const uint8_t c = s.bytes[++s.at];
        bool closed = false;
        if (c == '?' || c == '!') {
            const bool cdata = s.size_bytes - at > 9 && memcmp(s.bytes + at, "<![CDATA[", 9) == 0;
            if (!skip_to(&s, cdata ? "]]>" : memcmp(s.bytes + at, "<!--", 4) == 0 ? "-->" : ">")) return 0;
        } else if (c == '/') {
            if (!depth || !skip_to(&s, ">")) return 0;
            depth--;
            fuzz_note(spans, open[depth], s.at, open[depth], 'e');
        } else {
            if (!is_name(c) || depth == MAX_DEPTH) return 0;
            while (s.at < s.size_bytes && is_name(s.bytes[s.at])) s.at++;
            if (!scan_attributes(&s, &closed)) return 0;
            if (closed)
                fuzz_note(spans, at, s.at, at, 'e');
            else
                open[depth++] = at;
        }
        if (!depth && c != '?' && c != '!') return s.at;
    } while (s.at < s.size_bytes);
    return 0;
}

static void repeat(fuzz_input *input, const fuzz_span *span) {
    for (size_t count = 1u << fuzz_below(input, 7); count && !input->full; count--)
        fuzz_splice(input, span->end, span->end, input->bytes + span->begin, span->end - span->begin);
}

static void nest(fuzz_input *input, const fuzz_span *span) {
    const size_t depth = 1u << fuzz_below(input, 10);
    for (size_t i = 0; i < depth && !input->full; i++) {
        fuzz_splice(input, span->end + 3 * i, span->end + 3 * i, "</a>", 4);
        fuzz_splice(input, span->begin, span->begin, "<a>", 3);
    }
}

static void copy(fuzz_input *input, const fuzz_spans *spans, const fuzz_span *to) {
    for (int trial = 0; trial < 16; trial++) {
        const fuzz_span *from = &spans->items[fuzz_below(input, (uint32_t)spans->count)];
        if (from == to || (from->kind == 'e') != (to->kind == 'e')) continue;
        fuzz_splice(input, to->begin, to->end, input->bytes + from->begin, from->end - from->begin);
        return;
    }
}

void fuzz_xml_edit(fuzz_input *input, const fuzz_spans *spans) {
    const fuzz_span *span = &spans->items[fuzz_below(input, (uint32_t)spans->count)];
    const uint32_t choice = fuzz_below(input, 8);
    if (choice < 2)
        copy(input, spans, span);
    else if (span->kind == 'e' && choice == 2)
        fuzz_splice(input, span->begin, span->end, "", 0);
    else if (span->kind == 'e' && choice < 5)
        repeat(input, span);
    else if (span->kind == 'e')
        nest(input, span);
    else if (span->kind == 'a' && choice == 2)
        fuzz_splice(input, span->whole_begin, span->end + 1, "", 0);
    else if (choice < 5)
        fuzz_change_number(input, span);
    else {
        const char *word = fuzz_below(input, 3) ? fuzz_number_word(input) : words[fuzz_below(input, WORDS)];
        fuzz_splice(input, span->begin, span->end, word, strlen(word));
    }
}
