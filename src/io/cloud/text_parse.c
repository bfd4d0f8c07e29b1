// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The loop that most of the time goes into: cells to numbers, by the fast path for plain numbers, and by
// ewa_text_cell() for what is quoted, missing or written with a comma.
#include "io/cloud/text_parse.h"
#include "io/cloud/text_plain.h"
#include "io/number.h"

#include <math.h>

/// Where the numbers of a column go, for the point being read.
typedef struct place {
    uint8_t *to;
    size_t stride_bytes;
} place;

/// Why a line is no point, beside the faults.
typedef enum line_kind {
    LINE_POINT,
    LINE_NOWHERE, // a place is not finite
    LINE_EMPTY,   // blank, a comment, a count
    LINE_BAD,
} line_kind;

typedef struct reading {
    const char *at, *end; // end: of the chunk
    const char *cell;     // that is damaged
    uint32_t column;
    ewa_rows_fault fault;
} reading;

static inline ewa_text_class class_at(const ewa_text_layout *layout, const char *at, const char *end) {
    return at == end ? EWA_TEXT_LINE_END : (ewa_text_class)layout->classes[(uint8_t)*at];
}

static inline const char *skip_blanks(const ewa_text_layout *layout, const char *at, const char *end) {
    while (class_at(layout, at, end) == EWA_TEXT_BLANK) at++;
    return at;
}

/// Whether a cell ends here. Where cells hold words, blanks are part of them.
static inline bool ends_cell(const ewa_text_layout *layout, const char *at, const char *end) {
    const ewa_text_class class = class_at(layout, at, end);
    if (class == EWA_TEXT_BLANK && layout->words && layout->separator)
        return ends_cell(layout, skip_blanks(layout, at, end), end);
    return class == EWA_TEXT_BLANK || class == EWA_TEXT_SEPARATOR || class == EWA_TEXT_LINE_END;
}

/// Takes a cell whatever is in it.
static ewa_text take_cell(const ewa_text_layout *layout, const char *at, const char *end) {
    const char *start = at;
    if (at < end && *at == '"')
        for (at++; class_at(layout, at, end) != EWA_TEXT_LINE_END; at++)
            if (*at == '"') break;
    const bool by_blank = !layout->separator || !layout->words;
    for (;; at++) {
        const ewa_text_class class = class_at(layout, at, end);
        if (class == EWA_TEXT_LINE_END || class == EWA_TEXT_SEPARATOR) break;
        if (class == EWA_TEXT_BLANK && by_blank) break;
    }
    while (at > start && layout->classes[(uint8_t)at[-1]] == EWA_TEXT_BLANK) at--;
    return (ewa_text){start, (size_t)(at - start)};
}

/// The number in a cell that is not written plainly, less `shift`; NULL when there is none.
static const char *read_odd(const ewa_text_layout *layout, const char *at, const char *end, int64_t shift,
                            double *value) {
    const ewa_text cell = take_cell(layout, at, end);
    return ewa_text_cell(layout, cell, shift, value) ? cell.chars + cell.length : NULL;
}

static inline const char *read_plain(const ewa_text_layout *layout, const char *at, const char *end,
                                     double *value) {
    const char *after = ewa_number_read_f64(at, end, value);
    if (after && ends_cell(layout, after, end)) return after;
    return read_odd(layout, at, end, 0, value);
}

#define STORE(type)                                                                                          \
    {                                                                                                        \
        const type narrow = (type)number;                                                                    \
        if (narrow != number) return false;                                                                  \
        memcpy(to, &narrow, sizeof narrow);                                                                  \
        return true;                                                                                         \
    }

static inline bool store_whole(ewa_type type, int64_t number, uint8_t *to) {
    switch (type) {
    case EWA_U8:
        STORE(uint8_t)
    case EWA_I16:
        STORE(int16_t)
    case EWA_U16:
        STORE(uint16_t)
    case EWA_I32:
        STORE(int32_t)
    default:
        STORE(uint32_t)
    }
}

/// Reads a whole number, also one written like 2.000; `*fits` says whether its type holds it.
static inline const char *read_whole(const ewa_text_layout *layout, const ewa_text_target *target,
                                     const char *at, const char *end, uint8_t *to, bool *fits) {
    int64_t number;
    const char *after = ewa_number_read_i64(at, end, &number);
    if (!after || !ends_cell(layout, after, end)) {
        double value;
        after = read_plain(layout, at, end, &value);
        if (!after) return NULL;
        if (target->missing_is_zero && isnan(value)) value = 0;
        *fits = value >= -0x1p31 && value < 0x1p32 && value == floor(value);
        if (!*fits) return after;
        number = (int64_t)value;
    }
    *fits = store_whole(target->type, number, to);
    return after;
}

/// Reads the cell of a column into `to`; NULL when it is damaged. What is nowhere sets `*nowhere`.
static inline const char *read_cell(const ewa_text_layout *layout, const ewa_text_target *target,
                                    reading *line, uint8_t *to, bool *nowhere) {
    const char *at = line->at, *end = line->end, *after = NULL;
    double value;
    line->fault = EWA_ROWS_NUMBER;
    switch (target->action) {
    case EWA_TEXT_LEAVE: {
        const ewa_text cell = take_cell(layout, at, end);
        return cell.chars + cell.length;
    }
    case EWA_TEXT_POSITION:
        after = ewa_number_read_shifted(at, end, target->shift, &value);
        if (!after || !ends_cell(layout, after, end))
            after = read_odd(layout, at, end, target->shift, &value);
        if (!after) return NULL;
        *nowhere |= !isfinite(value);
        memcpy(to, &value, sizeof value);
        return after;
    case EWA_TEXT_F64:
        after = read_plain(layout, at, end, &value);
        if (after) memcpy(to, &value, sizeof value);
        return after;
    case EWA_TEXT_F32: {
        float number;
        after = ewa_number_read_f32(at, end, &number);
        if (!after || !ends_cell(layout, after, end)) {
            after = read_odd(layout, at, end, 0, &value);
            if (!after) return NULL;
            number = (float)value;
        }
        memcpy(to, &number, sizeof number);
        return after;
    }
    case EWA_TEXT_SHARE: {
        after = read_plain(layout, at, end, &value);
        if (!after) return NULL;
        value = value * target->scale + 0.5;
        const uint16_t number = value >= 65535 ? 65535 : value > 0 ? (uint16_t)value : 0;
        memcpy(to, &number, sizeof number);
        return after;
    }
    case EWA_TEXT_WHOLE: {
        bool fits = true;
        after = read_whole(layout, target, at, end, to, &fits);
        if (after && !fits) {
            line->fault = EWA_ROWS_RANGE;
            return NULL;
        }
        return after;
    }
    }
    return after;
}

/// Whether a line is a comment, or says how many points follow.
static bool is_remark(const ewa_text_table *table, const char *at, const char *end) {
    if (ewa_text_is_comment((ewa_text){at, (size_t)(end - at)})) return true;
    if (!table->counts) return false;
    int64_t count;
    const char *after = ewa_number_read_i64(at, end, &count);
    return after && count >= 0 &&
           class_at(&table->layout, skip_blanks(&table->layout, after, end), end) == EWA_TEXT_LINE_END;
}

/// Reads the cells of a line; the line's `at` is behind the last one that was read.
static inline line_kind read_cells(const ewa_text_table *table, reading *line, const place *places) {
    const ewa_text_layout *layout = &table->layout;
    bool nowhere = false, separated = false;
    for (uint32_t c = 0; c < layout->column_count; c++) {
        line->column = c;
        line->cell = line->at;
        if (class_at(layout, line->at, line->end) == EWA_TEXT_LINE_END &&
            !(separated && c + 1 == layout->column_count)) {
            line->fault = EWA_ROWS_SHORT;
            return LINE_BAD;
        }
        line->at = read_cell(layout, &table->targets[c], line, places[c].to, &nowhere);
        if (!line->at) return LINE_BAD;
        line->at = skip_blanks(layout, line->at, line->end);
        separated = class_at(layout, line->at, line->end) == EWA_TEXT_SEPARATOR;
        if (separated) line->at = skip_blanks(layout, line->at + 1, line->end);
    }
    if (class_at(layout, line->at, line->end) != EWA_TEXT_LINE_END) {
        line->column = layout->column_count;
        line->cell = line->at;
        line->fault = EWA_ROWS_LONG;
        return LINE_BAD;
    }
    return nowhere ? LINE_NOWHERE : LINE_POINT;
}

static line_kind read_line(const ewa_text_table *table, reading *line, const place *places) {
    line->at = skip_blanks(&table->layout, line->at, line->end);
    if (class_at(&table->layout, line->at, line->end) == EWA_TEXT_LINE_END ||
        is_remark(table, line->at, line->end))
        return LINE_EMPTY;
    return read_cells(table, line, places);
}

// ---- lines of plain numbers ------------------------------------------------------------------------------

/// Takes the digits of a cell together and returns how many stand behind the point; -1 when these are too many
/// for exact arithmetic.
static inline int take_digits(const ewa_plain_cell *cell, int64_t *digits) {
    static const int64_t powers_of_10[EWA_PLAIN_DIGITS + 1] = {1,      10,      100,      1000,     10000,
                                                               100000, 1000000, 10000000, 100000000};
    const size_t before = (size_t)(cell->point - cell->start);
    const size_t behind = (size_t)(cell->end - cell->point) - (cell->end > cell->point);
    if (before > EWA_PLAIN_DIGITS || behind > EWA_PLAIN_DIGITS) return -1;
    *digits = (int64_t)ewa_plain_digits(cell->point, before) * powers_of_10[behind] +
              (int64_t)ewa_plain_digits(cell->end, behind);
    if (cell->negative) *digits = -*digits;
    return (int)behind;
}

/// The cell of a column where exact arithmetic on doubles or floats gives the nearest number; false elsewhere.
static inline bool read_plain_cell(const ewa_text_target *target, const ewa_plain_cell *cell, uint8_t *to) {
    static const double powers_of_10[EWA_PLAIN_DIGITS + 1] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
    int64_t digits;
    if (target->action == EWA_TEXT_LEAVE) return true;
    const int behind = take_digits(cell, &digits);
    if (behind < 0) return false;
    switch (target->action) {
    case EWA_TEXT_POSITION:
        digits -= target->shift * (int64_t)powers_of_10[behind];
        __attribute__((fallthrough));
    case EWA_TEXT_F64: {
        if (digits > (int64_t)1 << 53 || digits < -((int64_t)1 << 53)) return false;
        const double value = (double)digits / powers_of_10[behind];
        memcpy(to, &value, sizeof value);
        return digits != 0 || !cell->negative; // minus zero
    }
    case EWA_TEXT_F32: {
        if (digits > 1 << 24 || digits < -(1 << 24)) return false;
        const float value = (float)digits / (float)powers_of_10[behind];
        memcpy(to, &value, sizeof value);
        return digits != 0 || !cell->negative;
    }
    case EWA_TEXT_WHOLE:
        return behind == 0 && store_whole(target->type, digits, to);
    default:
        return false;
    }
}

/// Reads a line that has been split; a cell that wants more care gets it.
static line_kind read_plain_line(const ewa_text_table *table, reading *line, const ewa_plain_cell *cells,
                                 const place *places) {
    bool nowhere = false;
    for (uint32_t c = 0; c < table->layout.column_count; c++) {
        if (read_plain_cell(&table->targets[c], &cells[c], places[c].to)) continue;
        line->column = c;
        line->cell = line->at = cells[c].start - cells[c].with_sign;
        if (!read_cell(&table->layout, &table->targets[c], line, places[c].to, &nowhere)) return LINE_BAD;
    }
    return nowhere ? LINE_NOWHERE : LINE_POINT;
}

static const char *next_line(const ewa_text_layout *layout, const char *at, const char *end) {
    if (at < end && *at != layout->line_end) at = memchr(at, layout->line_end, (size_t)(end - at));
    return at && at < end ? at + 1 : end;
}

void ewa_text_read_chunk(const void *format, const ewa_rows_chunk *chunk, uint64_t maximum,
                         const ewa_cloud_sink *sinks, uint64_t first, ewa_rows_result *result) {
    const ewa_text_table *table = format;
    const uint32_t column_count = table->layout.column_count;
    place places[EWA_ROWS_MAX_COLUMNS];
    uint8_t unwanted[8];
    for (uint32_t c = 0; c < column_count; c++) {
        const ewa_text_target *target = &table->targets[c];
        const ewa_cloud_sink *sink = &sinks[target->attribute];
        places[c] = (place){unwanted, 0};
        if (target->action != EWA_TEXT_LEAVE && sink->to && maximum > 0)
            places[c] =
                (place){sink->to + first * sink->stride_bytes + target->offset_bytes, sink->stride_bytes};
    }
    reading line = {.at = chunk->at, .end = chunk->end};
    ewa_plain_cell cells[EWA_ROWS_MAX_COLUMNS];
    ewa_plain_walk walk = ewa_plain_begin(chunk->at, chunk->end);
    while (line.at < chunk->end) {
        const char *start = line.at;
        // Digits are taken by 8 bytes that end with the last one.
        const char *next = start - table->text >= EWA_PLAIN_DIGITS
                               ? ewa_plain_split(&table->layout, &walk, start, cells)
                               : NULL;
        const line_kind kind =
            next ? read_plain_line(table, &line, cells, places) : read_line(table, &line, places);
        if (kind == LINE_POINT) {
            if (result->point_count == maximum) {
                result->after = start;
                return;
            }
            result->point_count++;
            for (uint32_t c = 0; c < column_count; c++) places[c].to += places[c].stride_bytes;
            // The point behind the last that there is room for is read for its faults alone.
            if (result->point_count == maximum)
                for (uint32_t c = 0; c < column_count; c++) places[c] = (place){unwanted, 0};
        } else if (kind == LINE_BAD) {
            if (result->bad_count++ == 0) {
                result->bad_at = line.cell;
                result->bad_column = line.column + 1;
                result->fault = line.fault;
            }
            line.at = line.cell;
        }
        result->nowhere_count += kind == LINE_NOWHERE;
        if (!next) {
            next = next_line(&table->layout, line.at, chunk->end);
            walk = ewa_plain_begin(next, chunk->end);
        }
        line.at = next;
    }
    result->after = chunk->end;
}
