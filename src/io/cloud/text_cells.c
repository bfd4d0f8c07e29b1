// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lines of a table into cells, cells into numbers, with all that may stand around them.
#include "io/cloud/text_table.h"
#include "io/number.h"

#include <math.h>

enum { NUMBER_BYTES = 400 };

bool ewa_text_is_comment(ewa_text line) {
    return line.length > 0 && (line.chars[0] == '#' || line.chars[0] == '%' || line.chars[0] == '!' ||
                               (line.length > 1 && line.chars[0] == '/' && line.chars[1] == '/'));
}

void ewa_text_classify(ewa_text_layout *layout) {
    memset(layout->classes, EWA_TEXT_OTHER, sizeof layout->classes);
    static const char blanks[] = " \t\v\f\r\n", signs[] = "+-", exponents[] = "eE";
    for (const char *c = blanks; *c; c++) layout->classes[(uint8_t)*c] = EWA_TEXT_BLANK;
    for (const char *c = signs; *c; c++) layout->classes[(uint8_t)*c] = EWA_TEXT_SIGN;
    for (const char *c = exponents; *c; c++) layout->classes[(uint8_t)*c] = EWA_TEXT_EXPONENT;
    // Around plain numbers quotes say nothing.
    if (!layout->words) layout->classes['"'] = EWA_TEXT_BLANK;
    layout->classes['.'] = EWA_TEXT_POINT;
    if (layout->decimal_comma) layout->classes[','] = EWA_TEXT_POINT;
    if (layout->separator) layout->classes[(uint8_t)layout->separator] = EWA_TEXT_SEPARATOR;
    layout->classes[(uint8_t)layout->line_end] = EWA_TEXT_LINE_END;
}

static ewa_text trim(ewa_text text) {
    while (text.length && ewa_is_blank(*text.chars)) text = (ewa_text){text.chars + 1, text.length - 1};
    while (text.length && (ewa_is_blank(text.chars[text.length - 1]) || text.chars[text.length - 1] == '\r'))
        text.length--;
    return text;
}

uint32_t ewa_text_split(const ewa_text_layout *layout, ewa_text line, ewa_text *words, uint32_t maximum) {
    line = trim(line);
    const char *at = line.chars, *end = at + line.length;
    const bool by_blank = !layout->separator || !layout->words;
    uint32_t count = 0;
    while (at < end) {
        const char *start = at;
        if (*at == '"') {
            const char *quote = memchr(at + 1, '"', (size_t)(end - at - 1));
            at = quote ? quote + 1 : end;
        }
        while (at < end && !(layout->separator && *at == layout->separator) &&
               !(by_blank && ewa_is_blank(*at)))
            at++;
        if (count < maximum) words[count] = trim((ewa_text){start, (size_t)(at - start)});
        count++;
        while (at < end && ewa_is_blank(*at)) at++;
        if (at < end && layout->separator && *at == layout->separator) at++;
        while (at < end && ewa_is_blank(*at)) at++;
    }
    return count;
}

bool ewa_text_cells(const ewa_text_layout *layout, ewa_text line, ewa_text *cells) {
    const uint32_t count = ewa_text_split(layout, line, cells, layout->column_count);
    line = trim(line);
    const bool open = layout->separator && line.length && line.chars[line.length - 1] == layout->separator;
    if (count + 1 == layout->column_count && open) cells[count] = (ewa_text){line.chars, 0};
    return count == layout->column_count || (count + 1 == layout->column_count && open);
}

static ewa_text unquote(ewa_text word) {
    if (word.length >= 2 && word.chars[0] == '"' && word.chars[word.length - 1] == '"')
        return trim((ewa_text){word.chars + 1, word.length - 2});
    return word;
}

static bool read_number(ewa_text word, int64_t shift, double *value) {
    const char *end = word.chars + word.length;
    return word.length && ewa_number_read_shifted(word.chars, end, shift, value) == end;
}

bool ewa_text_cell(const ewa_text_layout *layout, ewa_text word, int64_t shift, double *value) {
    word = unquote(word);
    if (word.length == 0 || ewa_text_is_any_case(word, "na") || ewa_text_is_any_case(word, "null")) {
        *value = NAN;
        return true;
    }
    if (read_number(word, shift, value)) return true;
    char text[NUMBER_BYTES];
    if (!layout->decimal_comma || word.length > sizeof text) return false;
    memcpy(text, word.chars, word.length);
    char *comma = memchr(text, ',', word.length);
    if (!comma) return false;
    *comma = '.';
    return read_number((ewa_text){text, word.length}, shift, value);
}
