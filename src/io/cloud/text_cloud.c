// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds as tables of text: XYZ, PTS, CSV, TXT, ASC. A sample of lines says what the columns are, a look at all
// lines which types they need and how many decimals there are; then the points are read.
#include "io/cloud/text_parse.h"
#include "io/reader.h"

#include <math.h>
#include <stdio.h>

enum {
    PROBE_BYTES = 1 << 14,
    MAX_ODD_LINES = 8, // before a table
    SAMPLE_ROWS = 1024,
    SAMPLE_PLACES = 8, // of the file, beside its begin
    MAX_DECIMALS = 9,
    MAX_GRID_DIGITS = 18,
};

typedef struct text_state {
    ewa_rows rows;
    ewa_text_table table;
    ewa_text_column columns[EWA_ROWS_MAX_COLUMNS];
    ewa_text_range ranges[EWA_ROWS_MAX_COLUMNS];
    ewa_text_target targets[EWA_ROWS_MAX_COLUMNS];
    bool whole[EWA_ROWS_MAX_COLUMNS];   // only whole numbers in the sample
    bool words[EWA_ROWS_MAX_COLUMNS];   // mostly words in the sample
    double first[EWA_ROWS_MAX_COLUMNS]; // first row of the sample
    size_t attribute_bytes[EWA_ROWS_MAX_COLUMNS];
    uint64_t row_count;
} text_state;

// ---- is it text? -----------------------------------------------------------------------------------------

/// Makes the begin of UTF-16 text plain; what is no ASCII becomes '?'.
static size_t narrow(const uint8_t *bytes, size_t size_bytes, bool big_endian, char *text) {
    size_t length = 0;
    for (size_t i = 2; i + 1 < size_bytes; i += 2) {
        const uint8_t low = bytes[i + big_endian], high = bytes[i + !big_endian];
        text[length++] = (char)(high == 0 && low < 0x80 ? low : '?');
    }
    return length;
}

/// The first lines of a file that may be text; `text` has room for those of wide characters.
static bool look_at_text(const uint8_t *bytes, uint64_t size_bytes, char text[PROBE_BYTES / 2], ewa_cursor *cursor, bool *whole) {
    const size_t looked = size_bytes < PROBE_BYTES ? (size_t)size_bytes : PROBE_BYTES;
    *cursor = (ewa_cursor){(const char *)bytes, (const char *)bytes + looked, 1};
    *whole = looked == size_bytes;
    if (looked >= 2 && (memcmp(bytes, "\xff\xfe", 2) == 0 || memcmp(bytes, "\xfe\xff", 2) == 0))
        *cursor = (ewa_cursor){text, text + narrow(bytes, looked, bytes[0] == 0xfe, text), 1};
    else if (ewa_bytes_mark(bytes, looked))
        cursor->at += 3;
    for (const char *c = cursor->at; c < cursor->end; c++)
        if ((unsigned char)*c < ' ' && !ewa_is_blank(*c) && !ewa_is_line_end(*c)) return false;
    return true;
}

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    char text[PROBE_BYTES / 2];
    ewa_cursor cursor;
    ewa_text_begin begin;
    bool whole;
    return look_at_text(bytes, size_bytes, text, &cursor, &whole) && ewa_text_begin_find(cursor, whole, &begin);
}

ewa_status ewa_text_refuse_odd(ewa_context *context, const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    char text[PROBE_BYTES / 2], quote[EWA_QUOTE_BYTES];
    ewa_cursor cursor;
    ewa_text odd = {NULL, 0};
    bool whole;
    if (!look_at_text(bytes, size_bytes, text, &cursor, &whole)) return EWA_OK;
    uint64_t odd_line = 0;
    for (int skipped = 0; skipped < MAX_ODD_LINES && cursor.at < cursor.end;) {
        ewa_text_begin begin;
        const uint64_t number = cursor.line;
        const ewa_text line = ewa_cursor_rest(&cursor);
        ewa_cursor_step_line(&cursor);
        if (line.length == 0 || ewa_text_is_comment(line)) continue;
        if (skipped++ == 0) odd = line, odd_line = number;
        if (!ewa_text_begin_find(cursor, whole, &begin)) continue;
        ewa_quote(odd, quote);
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: line %llu: %s is neither numbers, as they follow, nor the names of columns, x y z among them",
                        name, (unsigned long long)odd_line, quote);
    }
    return EWA_OK;
}

// ---- what the columns are --------------------------------------------------------------------------------

typedef struct row_sample {
    double *numbers; // SAMPLE_ROWS rows of column_count
    uint32_t row_count, column_count;
    uint32_t word_count[EWA_ROWS_MAX_COLUMNS]; // cells that are no numbers
} row_sample;

/// Takes rows from a place on, at most `maximum` lines; only rows that are right count.
static void sample_lines(const ewa_rows *rows, const ewa_text_layout *layout, const char *at,
                         uint32_t maximum, row_sample *sample) {
    ewa_text cells[EWA_ROWS_MAX_COLUMNS];
    for (uint32_t i = 0; i < maximum && at < rows->text.end && sample->row_count < SAMPLE_ROWS; i++) {
        const char *end = ewa_rows_line_end(rows, at);
        const ewa_text line = {at, (size_t)(end - at)};
        at = end < rows->text.end ? end + 1 : end;
        if (ewa_text_is_comment(line)) continue;
        if (!ewa_text_cells(layout, line, cells)) continue;
        double *numbers = sample->numbers + (size_t)sample->row_count * layout->column_count;
        uint32_t word_count = 0;
        for (uint32_t c = 0; c < layout->column_count; c++)
            if (!ewa_text_cell(layout, cells[c], 0, &numbers[c])) {
                numbers[c] = NAN;
                sample->word_count[c]++;
                word_count++;
            }
        if (word_count > 0 && !layout->words)
            for (uint32_t c = 0; c < layout->column_count; c++) sample->word_count[c] = 0;
        else
            sample->row_count++;
    }
}

static void take_sample(const ewa_rows *rows, const ewa_text_begin *begin, row_sample *sample) {
    const uint32_t share = SAMPLE_ROWS / (2 * SAMPLE_PLACES);
    sample_lines(rows, &begin->layout, begin->data, SAMPLE_ROWS / 2, sample);
    const uint64_t length = (uint64_t)(rows->text.end - begin->data);
    for (uint32_t i = 1; i <= SAMPLE_PLACES; i++) {
        const char *at = begin->data + ewa_split(length, SAMPLE_PLACES + 1, i);
        const char *end = ewa_rows_line_end(rows, at);
        if (end < rows->text.end) sample_lines(rows, &begin->layout, end + 1, share, sample);
    }
}

static ewa_status name_columns(text_state *state, const ewa_text_begin *begin, const row_sample *sample) {
    const ewa_cloud_source *source = state->rows.source;
    const uint32_t count = begin->layout.column_count;
    ewa_status status = EWA_OK;
    if (source->options->columns)
        status = ewa_text_columns_from_options(source, count, state->columns);
    else if (!begin->head.length || !ewa_text_columns_from_head(begin, state->columns))
        ewa_text_columns_from_numbers(sample->numbers, sample->row_count, count, state->columns);
    for (uint32_t c = 0; c < count; c++) {
        char quote[EWA_QUOTE_BYTES];
        state->words[c] = 2 * sample->word_count[c] > sample->row_count;
        if (!state->words[c] || !state->columns[c].name[0]) continue;
        ewa_report(source->context, EWA_SEVERITY_WARNING, "%s: column %u, %s, holds words: it is left out",
                   source->name, c + 1, ewa_quote(state->columns[c].word, quote));
        state->columns[c].name[0] = 0;
    }
    return status == EWA_OK ? ewa_text_columns_finish(source, count, state->columns) : status;
}

// ---- which types they need -------------------------------------------------------------------------------

/// The greatest whole part in a column; more than any integer type holds when there are more than 8 digits.
static double greatest(const ewa_text_range *range) {
    double value = 0;
    if (range->digits > 8) return INFINITY;
    for (int shift = 56; shift >= 0; shift -= 8) {
        const unsigned digit = (range->greatest >> shift & 0xff) - '0';
        if (digit < 10) value = value * 10 + digit;
    }
    return value;
}

static bool is_one_of(const char *name, const char *const *names, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

/// What the fields of LAS are, however many zeros a program writes behind the point.
static bool is_counted(const char *name) {
    static const char *const names[] = {"return_number",       "number_of_returns", "scan_direction_flag",
                                        "edge_of_flight_line", "classification",    "synthetic",
                                        "key_point",           "withheld",          "overlap",
                                        "scanner_channel",     "user_data",         "point_source_id"};
    return is_one_of(name, names, sizeof names / sizeof names[0]);
}

static bool is_float(const char *name) {
    static const char *const names[] = {EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U, EWA_TANGENT_V,
                                        EWA_CLIP0,  EWA_CLIP1,  EWA_BORDER,    "scan_angle"};
    return is_one_of(name, names, sizeof names / sizeof names[0]);
}

static ewa_text_target whole_target(const char *name, const ewa_text_range *range) {
    const double maximum = greatest(range);
    const bool narrow_name = strcmp(name, "intensity") == 0 || strcmp(name, "nir") == 0; // 16 bits in LAS
    ewa_text_target target = {.action = EWA_TEXT_WHOLE, .type = EWA_U32};
    if (range->negative)
        target.type = maximum <= INT16_MAX ? EWA_I16 : EWA_I32;
    else if (maximum <= UINT16_MAX)
        target.type = maximum <= UINT8_MAX && !narrow_name ? EWA_U8 : EWA_U16;
    if (range->digits > 8) target = (ewa_text_target){.action = EWA_TEXT_F64, .type = EWA_F64};
    return target;
}

static ewa_text_target scalar_target(const text_state *state, uint32_t column) {
    const ewa_text_range *range = &state->ranges[column];
    const char *name = state->columns[column].name;
    const bool whole = range->decimals == 0 && !range->unusual;
    const ewa_text_target narrow = {.action = EWA_TEXT_F32, .type = EWA_F32},
                          wide = {.action = EWA_TEXT_F64, .type = EWA_F64};
    if (is_float(name)) return narrow;
    if (strcmp(name, "gps_time") == 0 || range->unusual) return wide;
    if (!range->other && (whole || (is_counted(name) && state->whole[column])))
        return whole_target(name, range);
    // A float gives every number of 6 digits back as it was written.
    const uint32_t digits = greatest(range) > 0 ? range->digits : 0;
    return digits + range->decimals <= 6 ? narrow : wide;
}

/// Colours are of one type: integers as they are, shares of 1 and parts of integers as 16 bits.
static ewa_text_target color_target(const text_state *state, uint32_t column_count) {
    double maximum = 0;
    bool whole = true;
    for (uint32_t c = 0; c < column_count; c++) {
        if (strcmp(state->columns[c].name, EWA_COLOR) != 0) continue;
        maximum = fmax(maximum, greatest(&state->ranges[c]));
        whole = whole && state->ranges[c].decimals == 0 && !state->ranges[c].unusual;
    }
    ewa_text_target target = {
        .action = EWA_TEXT_WHOLE, .type = maximum <= UINT8_MAX ? EWA_U8 : EWA_U16, .missing_is_zero = true};
    if (!whole)
        target = (ewa_text_target){.action = EWA_TEXT_SHARE,
                                   .type = EWA_U16,
                                   .scale = maximum <= 1           ? 65535
                                            : maximum <= UINT8_MAX ? 257
                                                                   : 1};
    return target;
}

int64_t ewa_text_origin(double coordinate) {
    return fabs(coordinate) > 1e4 && fabs(coordinate) < 1e10 ? 1000 * (int64_t)round(coordinate / 1000) : 0;
}

static void place_axis(text_state *state, uint32_t column, ewa_text_target *target, double origin_world[3],
                       ewa_coordinate_grid *grid) {
    static const double steps[MAX_DECIMALS + 1] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
    const uint32_t axis = state->columns[column].component;
    const ewa_text_range *range = &state->ranges[column];
    *target = (ewa_text_target){
        .action = EWA_TEXT_POSITION, .type = EWA_F64, .shift = ewa_text_origin(state->first[column])};
    origin_world[axis] = (double)target->shift;
    if (range->decimals <= MAX_DECIMALS && !range->unusual &&
        range->digits + range->decimals <= MAX_GRID_DIGITS)
        grid->step_world[axis] = steps[range->decimals];
    grid->offset_world[axis] = origin_world[axis]; // near the points, so that few bits are enough in LAS
}

/// Says where the cells of every column go; adds the attributes to the prototype.
static ewa_status lay_out(text_state *state, ewa_cloud *prototype) {
    const uint32_t column_count = state->table.layout.column_count;
    double origin_world[3] = {0};
    ewa_coordinate_grid grid = {{0}, {0}};
    ewa_status status = EWA_OK;
    for (uint32_t c = 0; c < column_count; c++) {
        const ewa_text_column *column = &state->columns[c];
        ewa_text_target *target = &state->targets[c];
        *target = (ewa_text_target){.action = EWA_TEXT_LEAVE};
        if (!column->name[0]) continue;
        if (strcmp(column->name, EWA_POSITION) == 0)
            place_axis(state, c, target, origin_world, &grid);
        else
            *target = strcmp(column->name, EWA_COLOR) == 0 ? color_target(state, column_count)
                                                           : scalar_target(state, c);
    }
    ewa_cloud_set_origin(prototype, origin_world);
    ewa_cloud_set_grid(prototype, &grid);
    for (uint32_t c = 0; c < column_count && status == EWA_OK; c++) {
        if (!state->columns[c].name[0] || ewa_cloud_find(prototype, state->columns[c].name)) continue;
        uint32_t component_count = 0, index = ewa_cloud_attribute_count(prototype);
        for (uint32_t k = c; k < column_count; k++) {
            if (strcmp(state->columns[k].name, state->columns[c].name) != 0) continue;
            state->targets[k].attribute = index;
            state->targets[k].offset_bytes =
                state->columns[k].component * (uint32_t)ewa_type_bytes(state->targets[k].type);
            component_count++;
        }
        status =
            ewa_cloud_add(prototype, state->columns[c].name, state->targets[c].type, component_count, NULL);
        state->attribute_bytes[index] = component_count * ewa_type_bytes(state->targets[c].type);
    }
    return status;
}

// ---- the format ------------------------------------------------------------------------------------------

static ewa_status look(text_state *state, const ewa_text_begin *begin) {
    ewa_context *context = state->rows.source->context;
    const uint32_t column_count = begin->layout.column_count;
    row_sample sample = {.column_count = column_count};
    sample.numbers = ewa_allocate(context, (size_t)SAMPLE_ROWS * column_count, sizeof *sample.numbers);
    if (!sample.numbers) return EWA_ERROR_MEMORY;
    take_sample(&state->rows, begin, &sample);
    const ewa_status status = name_columns(state, begin, &sample);
    for (uint32_t c = 0; c < column_count && sample.row_count > 0; c++) {
        state->first[c] = sample.numbers[c];
        state->whole[c] = true;
        for (uint32_t row = 0; row < sample.row_count; row++) {
            const double value = sample.numbers[(size_t)row * column_count + c];
            state->whole[c] = state->whole[c] && value == floor(value);
        }
    }
    ewa_release(context, sample.numbers, (size_t)SAMPLE_ROWS * column_count, sizeof *sample.numbers);
    return status;
}

static ewa_status read_begin(text_state *state, ewa_cloud *prototype) {
    ewa_rows *rows = &state->rows;
    const ewa_cloud_source *source = rows->source;
    ewa_text_begin begin;
    if (!ewa_text_begin_find(rows->text, true, &begin))
        return ewa_fail(source->context, EWA_ERROR_FORMAT,
                        "%s: the first lines are no table of at least three columns of numbers",
                        source->name);
    state->table = (ewa_text_table){begin.layout, rows->text.at, state->targets, begin.has_count};
    EWA_TRY(look(state, &begin));
    EWA_TRY(ewa_text_scan(rows, &state->table.layout, begin.data, state->ranges, &state->row_count));
    if (begin.has_count && begin.stated_count > state->row_count)
        EWA_TRY(ewa_cloud_damage(
            source, begin.stated_count - state->row_count, "%s: %llu points are announced, %llu lines follow",
            source->name, (unsigned long long)begin.stated_count, (unsigned long long)state->row_count));
    return lay_out(state, prototype);
}

static void close_text(void *data) {
    text_state *state = data;
    if (!state) return;
    ewa_context *context = state->rows.source->context;
    ewa_rows_close(&state->rows);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_text(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                            void **data) {
    text_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_rows_open(&state->rows, source);
    if (status == EWA_OK) status = read_begin(state, prototype);
    if (status != EWA_OK) {
        close_text(state);
        return status;
    }
    state->rows.read_chunk = ewa_text_read_chunk;
    state->rows.format = &state->table;
    state->rows.attribute_count = ewa_cloud_attribute_count(prototype);
    state->rows.attribute_bytes = state->attribute_bytes;
    *point_count = state->row_count;
    *data = state;
    return EWA_OK;
}

static ewa_status read_text(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    text_state *state = data;
    return ewa_rows_read(&state->rows, maximum, sinks, got_count);
}

const ewa_cloud_format ewa_format_text = {EWA_MODEL_TEXT, probe, open_text, read_text, close_text};
