// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How text falls into columns, found out by trying what is usual on the first lines: the way that makes the
// most of them rows of equally many numbers is it.
#include "io/cloud/text_table.h"

/// A line of the sample under one layout.
typedef struct sample_line {
    ewa_text text;
    uint32_t word_count;
    uint32_t cell_count;   // of words that are numbers or missing ones
    uint32_t number_count; // of words that are numbers
} sample_line;

static sample_line measure(const ewa_text_layout *layout, ewa_text text) {
    ewa_text words[EWA_ROWS_MAX_COLUMNS];
    sample_line line = {text, ewa_text_split(layout, text, words, EWA_ROWS_MAX_COLUMNS), 0, 0};
    for (uint32_t i = 0; i < line.word_count && i < EWA_ROWS_MAX_COLUMNS; i++) {
        double value;
        const bool cell = ewa_text_cell(layout, words[i], 0, &value);
        line.cell_count += cell;
        line.number_count += cell && words[i].length > 0;
    }
    return line;
}

typedef struct first_lines {
    ewa_text lines[EWA_TEXT_SAMPLE_LINES]; // neither blank nor comments
    ewa_text comment;                      // the last one before the first of the lines
    uint32_t count;
} first_lines;

static void take_sample(ewa_cursor text, bool text_ends, first_lines *sample) {
    sample->count = 0;
    sample->comment = (ewa_text){text.at, 0};
    while (text.at < text.end && sample->count < EWA_TEXT_SAMPLE_LINES) {
        const ewa_text line = ewa_cursor_rest(&text);
        if (text.at == text.end && !text_ends) return; // not the whole line
        if (ewa_text_is_comment(line)) {
            if (sample->count == 0) sample->comment = line;
        } else if (line.length > 0) {
            sample->lines[sample->count++] = line;
        }
        ewa_cursor_step_line(&text);
    }
}

/// Whether a line can be a row of a table: numbers, or, where there are columns of words, three of them.
static bool can_be_row(const sample_line *line, bool words) {
    return line->number_count >= 3 && line->word_count <= EWA_ROWS_MAX_COLUMNS &&
           (words || line->cell_count == line->word_count);
}

static bool is_row(const sample_line *line, const ewa_text_layout *layout) {
    ewa_text cells[EWA_ROWS_MAX_COLUMNS];
    return can_be_row(line, layout->words) && ewa_text_cells(layout, line->text, cells);
}

/// Counts the sampled lines that are rows under a layout, of the number of columns that most of them have.
static uint32_t try_layout(const first_lines *sample, ewa_text_layout *layout, sample_line *lines) {
    uint32_t votes[EWA_ROWS_MAX_COLUMNS + 1] = {0};
    for (uint32_t i = 0; i < sample->count; i++) {
        lines[i] = measure(layout, sample->lines[i]);
        if (can_be_row(&lines[i], layout->words)) votes[lines[i].word_count]++;
    }
    layout->column_count = 3;
    for (uint32_t i = 4; i <= EWA_ROWS_MAX_COLUMNS; i++)
        if (votes[i] > votes[layout->column_count]) layout->column_count = i;
    return votes[layout->column_count];
}

/// Whether a line names columns: words, or x, y and z among what may be numbers, for a name can be "nan".
static bool is_head(const sample_line *line) {
    return line->word_count >= 3 && (line->number_count == 0 || ewa_text_head_has_place(line->text));
}

/// Takes what stands before the rows: the number of points and a head, each at most once.
static bool take_begin(const first_lines *sample, const sample_line *lines, ewa_text_begin *begin) {
    const ewa_text_layout *layout = &begin->layout;
    uint32_t i = 0, row_count = 0;
    begin->head = sample->comment;
    begin->head_is_comment = true;
    for (; i < sample->count && (!is_row(&lines[i], layout) || is_head(&lines[i])); i++) {
        int64_t count;
        if (!begin->has_count && ewa_text_integer(sample->lines[i], &count) && count >= 0) {
            begin->has_count = true;
            begin->stated_count = (uint64_t)count;
        } else if (begin->head_is_comment && is_head(&lines[i])) {
            begin->head = sample->lines[i];
            begin->head_is_comment = false;
        } else {
            return false;
        }
    }
    if (i == sample->count) return false;
    // Words in columns that nobody names make no table: the lines of many other formats look like that.
    if (layout->words && (begin->head_is_comment || !ewa_text_head_has_place(begin->head))) return false;
    begin->data = sample->lines[i].chars;
    for (uint32_t k = i; k < sample->count; k++) row_count += is_row(&lines[k], layout);
    return 4 * (uint64_t)row_count >= 3 * (uint64_t)(sample->count - i);
}

bool ewa_text_begin_find(ewa_cursor text, bool text_ends, ewa_text_begin *begin) {
    // In this order: of ways that fit equally well the first is meant. 1,2 3,4 5,6 are three numbers, not
    // six.
    static const struct {
        char separator;
        bool decimal_comma, words;
    } ways[] = {{0, false, false}, {0, true, false},   {',', false, false}, {';', true, false},
                {0, false, true},  {',', false, true}, {';', true, true}};
    first_lines sample;
    sample_line lines[EWA_TEXT_SAMPLE_LINES];
    take_sample(text, text_ends, &sample);
    uint32_t max_rows = 0;
    size_t best = 0;
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        if (ways[i].words && 2 * max_rows >= sample.count) break; // then words are damage
        ewa_text_layout layout = {ways[i].separator, ways[i].decimal_comma, ways[i].words, 0, 0, {0}};
        const uint32_t rows = try_layout(&sample, &layout, lines);
        if (rows <= max_rows) continue;
        max_rows = rows;
        best = i;
    }
    if (max_rows == 0) return false;
    *begin = (ewa_text_begin){.layout = {.separator = ways[best].separator,
                                         .decimal_comma = ways[best].decimal_comma,
                                         .words = ways[best].words,
                                         .line_end = ewa_rows_end_of_lines(text)}};
    try_layout(&sample, &begin->layout, lines);
    ewa_text_classify(&begin->layout);
    return take_begin(&sample, lines, begin);
}
