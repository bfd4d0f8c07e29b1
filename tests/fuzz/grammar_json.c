// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Edits of JSON: what was a text of it stays one.
#include "grammar.h"

#include <string.h>

/// What is no number.
static const char *const words[] = {"null",
                                    "true",
                                    "false",
                                    "\"\"",
                                    "\"NaN\"",
                                    "\"../../etc/passwd\"",
                                    "\"/dev/zero\"",
                                    "\"data:;base64,AAAA\"",
                                    "\"\\u0000\"",
                                    "\"\\ud800\"",
                                    "[]",
                                    "{}",
                                    "[0,0,0]",
                                    "[[]]",
                                    "[null]"};
enum { WORDS = sizeof words / sizeof *words, MAX_DEPTH = 200 };

typedef struct scan {
    const fuzz_input *input;
    fuzz_spans *spans;
    size_t at;
    int depth;
} scan;

static uint8_t next(const scan *s) { return s->at < s->input->size_bytes ? s->input->bytes[s->at] : 0; }

static void skip_blanks(scan *s) {
    while (s->at < s->input->size_bytes && memchr(" \t\r\n", s->input->bytes[s->at], 4)) s->at++;
}

static bool scan_string(scan *s) {
    for (s->at++; s->at < s->input->size_bytes; s->at++) {
        if (s->input->bytes[s->at] == '\\')
            s->at++;
        else if (s->input->bytes[s->at] == '"')
            return s->at++, true;
    }
    return false;
}

/// Kinds: '{', '[', '"', '0' of numbers, 'n' of words.
static bool scan_value(scan *s, size_t whole_begin) {
    const size_t begin = s->at;
    const uint8_t first = next(s);
    char kind = (char)first;
    if (first == '"') {
        if (!scan_string(s)) return false;
    } else if (first == '{' || first == '[') {
        if (++s->depth > MAX_DEPTH) return false;
        const uint8_t last = first == '{' ? '}' : ']';
        s->at++;
        for (skip_blanks(s); next(s) != last; skip_blanks(s)) {
            const size_t member = s->at;
            if (first == '{') {
                if (next(s) != '"' || !scan_string(s)) return false;
                fuzz_note(s->spans, member, s->at, member, 'k');
                skip_blanks(s);
                if (next(s) != ':') return false;
                s->at++;
                skip_blanks(s);
            }
            if (!scan_value(s, member)) return false;
            skip_blanks(s);
            if (next(s) == ',')
                s->at++;
            else if (next(s) != last)
                return false;
        }
        s->at++;
        s->depth--;
    } else {
        while (s->at < s->input->size_bytes && next(s) && strchr("+-.0123456789Eaeflnrstu", next(s))) s->at++;
        if (s->at == begin) return false;
        kind = strchr("-0123456789", (char)first) ? '0' : 'n';
    }
    fuzz_note(s->spans, begin, s->at, whole_begin, kind);
    return true;
}

size_t fuzz_json_spans(const fuzz_input *input, size_t begin, fuzz_spans *spans) {
    spans->count = 0;
    scan s = {.input = input, .spans = spans, .at = begin};
    return (next(&s) == '{' || next(&s) == '[') && scan_value(&s, begin) ? s.at : 0;
}

/// Removes a member or an element with one comma beside it.
static void erase(fuzz_input *input, const fuzz_span *span) {
    size_t begin = span->whole_begin, end = span->end;
    if (end < input->size_bytes && input->bytes[end] == ',')
        end++;
    else if (begin > 0 && input->bytes[begin - 1] == ',')
        begin--;
    fuzz_splice(input, begin, end, "", 0);
}

/// Doubles a member or an element up to 2^6 times.
static void repeat(fuzz_input *input, const fuzz_span *span) {
    const size_t bytes = span->end - span->whole_begin;
    for (size_t count = 1u << fuzz_below(input, 7); count && !input->full; count--) {
        fuzz_splice(input, span->end, span->end, input->bytes + span->whole_begin, bytes);
        fuzz_splice(input, span->end, span->end, ",", 1);
    }
}

/// Puts a value within arrays within arrays.
static void nest(fuzz_input *input, const fuzz_span *span) {
    const size_t depth = 1u << fuzz_below(input, 11);
    for (size_t i = 0; i < depth && !input->full; i++) {
        fuzz_splice(input, span->end + i, span->end + i, "]", 1);
        fuzz_splice(input, span->begin, span->begin, "[", 1);
    }
}

/// Copies another span of the same kind, or of any.
static void copy(fuzz_input *input, const fuzz_spans *spans, const fuzz_span *to) {
    const bool any = to->kind != 'k' && fuzz_below(input, 4) == 0;
    for (int trial = 0; trial < 16; trial++) {
        const fuzz_span *from = &spans->items[fuzz_below(input, (uint32_t)spans->count)];
        if (from == to || (from->kind != to->kind && !(any && from->kind != 'k'))) continue;
        fuzz_splice(input, to->begin, to->end, input->bytes + from->begin, from->end - from->begin);
        return;
    }
}

void fuzz_json_edit(fuzz_input *input, const fuzz_spans *spans) {
    const fuzz_span *span = &spans->items[fuzz_below(input, (uint32_t)spans->count)];
    if (span->kind == 'k') {
        // A key alone can become another one, or go away with its value, which is the next span that begins with it.
        const fuzz_span *value = span;
        while (value < spans->items + spans->count && (value->whole_begin != span->begin || value->kind == 'k')) value++;
        if (value == spans->items + spans->count || fuzz_below(input, 2))
            copy(input, spans, span);
        else
            erase(input, value);
        return;
    }
    switch (fuzz_below(input, 12)) {
    case 0:
    case 1:
        copy(input, spans, span);
        break;
    case 2:
        erase(input, span);
        break;
    case 3:
        repeat(input, span);
        break;
    case 4:
        nest(input, span);
        break;
    case 5:
    case 6:
        fuzz_change_number(input, span);
        break;
    default: {
        const char *word = fuzz_below(input, 3) ? fuzz_number_word(input) : words[fuzz_below(input, WORDS)];
        fuzz_splice(input, span->begin, span->end, word, strlen(word));
    }
    }
}
