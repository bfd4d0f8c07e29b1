// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tables of numbers as text: how a line falls into columns, what the columns are, what is in them.
#ifndef EWA_SRC_TEXT_TABLE_H
#define EWA_SRC_TEXT_TABLE_H

#include "io/cloud/text_rows.h"

enum { EWA_TEXT_SAMPLE_LINES = 128 };

/// What a byte is to a line of a table.
typedef enum ewa_text_class {
    EWA_TEXT_OTHER = 0, ///< of a number or a word
    EWA_TEXT_BLANK,
    EWA_TEXT_SEPARATOR,
    EWA_TEXT_LINE_END,
    EWA_TEXT_POINT, ///< decimal point or comma
    EWA_TEXT_SIGN,
    EWA_TEXT_EXPONENT, ///< the letter e
} ewa_text_class;

/// How lines fall into columns. Blanks separate as well, and around a separator they count for nothing; but
/// where columns hold words, and there is a separator, blanks are part of them.
typedef struct ewa_text_layout {
    char separator;     ///< ',' or ';'; 0: blanks
    bool decimal_comma; ///< numbers may be written 1,5
    bool words;         ///< there are columns of words
    char line_end;
    uint32_t column_count;
    uint8_t classes[256]; ///< ewa_text_class of a byte
} ewa_text_layout;

/// What a column is: a component of an attribute. An empty name: it is left out.
typedef struct ewa_text_column {
    char name[EWA_NAME_BYTES];
    uint32_t component;
    ewa_text word; ///< what the head calls it; length 0: nothing
} ewa_text_column;

/// What stands in a column, of all lines.
typedef struct ewa_text_range {
    uint64_t greatest; ///< the characters before the decimal point of the greatest magnitude, at most 8, as a
                       ///< number of bytes
    uint32_t digits;   ///< most characters before the point
    uint32_t decimals; ///< most characters behind the point
    bool negative;
    bool unusual; ///< numbers with exponents or in quotes, which are not measured
    bool other;   ///< words, unusual numbers, or nothing
} ewa_text_range;

/// What the begin of a file says about its table.
typedef struct ewa_text_begin {
    ewa_text_layout layout;
    ewa_text head; ///< line with names; length 0: there is none
    bool head_is_comment;
    bool has_count; ///< a line with the number of points stands before them
    uint64_t stated_count;
    const char *data; ///< first line of numbers
} ewa_text_begin;

/// Finds out how the lines of a text fall into columns, by its first ones, up to EWA_TEXT_SAMPLE_LINES; false
/// when it is no table of numbers. `text_ends`: the text is whole, its last line too.
bool ewa_text_begin_find(ewa_cursor text, bool text_ends, ewa_text_begin *begin);

/// Fails with the first line of a text that keeps it from being a table, where it would be one without some of its first
/// lines; EWA_OK: it would not. Errors: EWA_ERROR_FORMAT.
ewa_status ewa_text_refuse_odd(ewa_context *context, const char *name, const uint8_t *bytes, uint64_t size_bytes);

/// Whether a head names x, y and z.
bool ewa_text_head_has_place(ewa_text head);

/// Whether a line begins with what makes it a comment: '#', '//', '%', '!'.
bool ewa_text_is_comment(ewa_text line);

/// Splits a line into its words; returns how many there are, of which the first `maximum` are kept.
uint32_t ewa_text_split(const ewa_text_layout *layout, ewa_text line, ewa_text *words, uint32_t maximum);

/// Splits a line into the cells of all columns, of which the last may be missing behind a separator; false when
/// it has more or fewer.
bool ewa_text_cells(const ewa_text_layout *layout, ewa_text line, ewa_text *cells);

/// Reads a word as a number less `shift`, also in quotes and with a decimal comma; what is missing (nothing, "NA", "null")
/// is NaN. False when it is none.
bool ewa_text_cell(const ewa_text_layout *layout, ewa_text word, int64_t shift, double *value);

/// Fills the classes of a layout, whose other members are set.
void ewa_text_classify(ewa_text_layout *layout);

/// Names the columns as the head of a file does; false when it says nothing about columns.
bool ewa_text_columns_from_head(const ewa_text_begin *begin, ewa_text_column *columns);

/// Names the columns as options->columns does. Errors: EWA_ERROR_ARGUMENT (too many).
ewa_status ewa_text_columns_from_options(const ewa_cloud_source *source, uint32_t column_count,
                                         ewa_text_column *columns);

/// Names the columns by a sample of `row_count` rows of numbers.
void ewa_text_columns_from_numbers(const double *sample, uint32_t row_count, uint32_t column_count,
                                   ewa_text_column *columns);

/// Makes scalars of colours and normals of which components are missing, and gives every column a name of its
/// own. Errors: EWA_ERROR_FORMAT when there are no x, y, z, or a component is there twice.
ewa_status ewa_text_columns_finish(const ewa_cloud_source *source, uint32_t column_count,
                                   ewa_text_column *columns);

/// Returns a whole number of thousands near a large coordinate, else 0, which positions are relative to: so
/// that the same shape elsewhere on the map has the same positions.
int64_t ewa_text_origin(double coordinate);

/// Looks at all lines from `at` on: adds their chunks to `rows` and measures the columns, one range each.
/// Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_text_scan(ewa_rows *rows, const ewa_text_layout *layout, const char *at,
                         ewa_text_range *ranges, uint64_t *row_count);

#endif
