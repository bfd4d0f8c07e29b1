// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PTX, the text of terrestrial scanners: for each scan its columns and rows, the scanner's place and axes, a
// matrix that acts on row vectors from the right, then a line x y z intensity [red green blue] for every cell
// of the grid, 0 0 0 where nothing came back.
#include "io/cloud/text_table.h"
#include "io/number.h"
#include "io/reader.h"

#include <math.h>
#include <stdio.h>

enum {
    MIN_LINE_BYTES = 7, // 1 2 3 4
    HEAD_LINES = 10,
    PROBE_BYTES = 1 << 12,
    MAX_SCANS = 65535,
    SCANNER_BYTES = 3 * (EWA_NUMBER_BYTES + 1)
};

/// What stands before the points of a scan.
typedef struct scan {
    uint64_t column_count, row_count;
    double scanner_world[3];
    double matrix[16];      // row vectors: the translation is in the last row
    bool color;             // its lines have colours
    bool still;             // the matrix only adds whole numbers: positions are exact
    double offset_world[3]; // translation less the origin
} scan;

typedef struct ptx_state {
    ewa_rows rows;
    ewa_buffer scans; // of `scan`
    uint32_t scan_count;
    bool color; // some scan has colours
    uint64_t point_count;
    size_t attribute_bytes[4]; // position, intensity, color or scan, scan
    uint32_t color_index, scan_index;
} ptx_state;

/// Takes a line of exactly `count` numbers.
static bool take_numbers(ewa_cursor *cursor, uint32_t count, double *numbers) {
    if (ewa_cursor_numbers(cursor, count, numbers) != count) return false;
    while (cursor->at < cursor->end && ewa_is_blank(*cursor->at)) cursor->at++;
    if (cursor->at < cursor->end && !ewa_is_line_end(*cursor->at)) return false;
    ewa_cursor_step_line(cursor);
    for (uint32_t i = 0; i < count; i++)
        if (!isfinite(numbers[i])) return false;
    return true;
}

/// Takes the lines before the points of a scan; false at the line that is wrong, where `cursor` stays.
static bool take_head(ewa_cursor *cursor, scan *head) {
    static const uint32_t counts[HEAD_LINES] = {1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
    double numbers[HEAD_LINES][4];
    for (int i = 0; i < HEAD_LINES; i++) {
        const ewa_cursor start = *cursor;
        const bool natural = take_numbers(cursor, counts[i], numbers[i]) &&
                             (i > 1 || (numbers[i][0] >= 0 && numbers[i][0] < 0x1p32 &&
                                        numbers[i][0] == floor(numbers[i][0])));
        if (natural) continue;
        *cursor = start;
        return false;
    }
    *head = (scan){.column_count = (uint64_t)numbers[0][0], .row_count = (uint64_t)numbers[1][0]};
    memcpy(head->scanner_world, numbers[2], sizeof head->scanner_world);
    for (int i = 0; i < 4; i++) memcpy(head->matrix + 4 * i, numbers[6 + i], 4 * sizeof(double));
    return true;
}

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    const size_t looked = size_bytes < PROBE_BYTES ? (size_t)size_bytes : PROBE_BYTES;
    ewa_cursor cursor = {(const char *)bytes, (const char *)bytes + looked, 1};
    cursor.at += ewa_bytes_mark(bytes, looked);
    scan head;
    return take_head(&cursor, &head);
}

// ---- the lines of a scan ---------------------------------------------------------------------------------

static bool is_blank_line(const ewa_rows *rows, const char *at) {
    while (at < rows->text.end && *at != rows->line_end && (ewa_is_blank(*at) || ewa_is_line_end(*at))) at++;
    return at == rows->text.end || *at == rows->line_end;
}

/// Cuts the lines of the last scan into chunks; returns how many lines are not there.
static ewa_status cut_lines(ptx_state *state, uint64_t line_count, uint64_t *missing_count) {
    ewa_rows *rows = &state->rows;
    ewa_cursor *text = &rows->text;
    const char *at = text->at;
    ewa_rows_chunk chunk = {at, at, 0, state->scan_count - 1};
    ewa_status status = EWA_OK;
    while (status == EWA_OK && line_count > 0 && at < text->end) {
        const char *end = ewa_rows_line_end(rows, at);
        // What is shorter is no point, and no room is made for it.
        chunk.row_count += end - at >= MIN_LINE_BYTES;
        line_count -= !is_blank_line(rows, at);
        at = end;
        at += at < text->end;
        chunk.end = at;
        if (chunk.end - chunk.at < EWA_ROWS_CHUNK_BYTES && line_count > 0 && at < text->end) continue;
        state->point_count += chunk.row_count;
        status = ewa_rows_add(rows, &chunk);
        chunk = (ewa_rows_chunk){at, at, 0, chunk.part};
    }
    text->at = at;
    *missing_count = line_count;
    return status;
}

/// Where the first point of a scan is; false when it has none.
static bool find_first(const ewa_rows *rows, const scan *s, uint64_t line_count, ewa_cursor text,
                       double first_world[3]) {
    for (; line_count > 0 && text.at < text.end; line_count--) {
        double p[4];
        const uint32_t count = ewa_cursor_numbers(&text, 4, p);
        text.at = ewa_rows_line_end(rows, text.at);
        ewa_cursor_step_line(&text);
        if (count < 4 || (p[0] == 0 && p[1] == 0 && p[2] == 0)) continue;
        for (int i = 0; i < 3; i++)
            first_world[i] =
                p[0] * s->matrix[i] + p[1] * s->matrix[4 + i] + p[2] * s->matrix[8 + i] + s->matrix[12 + i];
        return isfinite(first_world[0]) && isfinite(first_world[1]) && isfinite(first_world[2]);
    }
    return false;
}

// ---- before the points -----------------------------------------------------------------------------------

static ewa_status add_scan(ptx_state *state, const scan *head) {
    ewa_context *context = state->rows.source->context;
    if (state->scan_count == MAX_SCANS)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d scans", state->rows.source->name,
                        MAX_SCANS);
    EWA_TRY(ewa_buffer_grow(context, &state->scans, state->scan_count, state->scan_count + 1, sizeof *head));
    ((scan *)state->scans.data)[state->scan_count++] = *head;
    return EWA_OK;
}

/// Says that the text goes on with something else than a scan.
static ewa_status fail_head(ptx_state *state) {
    ewa_rows *rows = &state->rows;
    char quote[EWA_QUOTE_BYTES];
    ewa_cursor bad = rows->text;
    const unsigned long long line = ewa_rows_line(rows, bad.at);
    const ewa_text rest = ewa_cursor_rest(&bad);
    if (rest.length == 0 && bad.at == bad.end)
        return ewa_cloud_damage(rows->source, 0, "%s: the file ends before the points of scan %u",
                                rows->source->name, state->scan_count + 1);
    return ewa_cloud_damage(rows->source, 0, "%s: line %llu: %s is not what stands before scan %u",
                            rows->source->name, line, ewa_quote(rest, quote), state->scan_count + 1);
}

/// Takes the scans one after another.
static ewa_status take_scans(ptx_state *state, double first_world[3]) {
    ewa_rows *rows = &state->rows;
    const ewa_cloud_source *source = rows->source;
    const ewa_cursor whole = rows->text;
    bool found = false;
    ewa_status status = EWA_OK;
    for (;;) {
        while (rows->text.at < rows->text.end && is_blank_line(rows, rows->text.at)) {
            rows->text.at = ewa_rows_line_end(rows, rows->text.at);
            rows->text.at += rows->text.at < rows->text.end;
        }
        if (rows->text.at == rows->text.end) break;
        scan head;
        if (!take_head(&rows->text, &head)) {
            status = fail_head(state);
            break;
        }
        double p[5];
        ewa_cursor line = rows->text;
        head.color = ewa_cursor_numbers(&line, 5, p) == 5;
        state->color |= head.color;
        const uint64_t line_count = head.column_count * head.row_count; // both are below 2^32
        if (!found) found = find_first(rows, &head, line_count, rows->text, first_world);
        uint64_t missing_count = 0;
        status = add_scan(state, &head);
        if (status == EWA_OK) status = cut_lines(state, line_count, &missing_count);
        if (status == EWA_OK && missing_count > 0)
            status =
                ewa_cloud_damage(source, missing_count,
                                 "%s: the file ends in scan %u, of %llu x %llu points; %llu are not there",
                                 source->name, state->scan_count, (unsigned long long)head.column_count,
                                 (unsigned long long)head.row_count, (unsigned long long)missing_count);
        if (status == EWA_OK)
            status = ewa_progress(source->context, "scan",
                                  (double)(rows->text.at - whole.at) / (double)(whole.end - whole.at));
        if (status != EWA_OK) break;
        if (!rows->owned) ewa_cloud_passed(source, (uint64_t)(rows->text.at - (const char *)source->bytes));
    }
    rows->text = whole;
    return status;
}

/// Relates the matrices to the origin.
static void set_origin(ptx_state *state, const double first_world[3], ewa_cloud *prototype) {
    double origin_world[3];
    for (int i = 0; i < 3; i++) origin_world[i] = (double)ewa_text_origin(first_world[i]);
    ewa_cloud_set_origin(prototype, origin_world);
    for (uint32_t k = 0; k < state->scan_count; k++) {
        scan *s = (scan *)state->scans.data + k;
        s->still = true;
        for (int i = 0; i < 3; i++) {
            const double step = s->matrix[12 + i];
            s->offset_world[i] = step - origin_world[i];
            s->still = s->still && step == floor(step) && fabs(step) < 0x1p50;
            for (int j = 0; j < 3; j++) s->still = s->still && s->matrix[4 * i + j] == (i == j);
        }
    }
}

static ewa_status set_scanners(const ptx_state *state, ewa_cloud *prototype) {
    ewa_context *context = state->rows.source->context;
    char *text = ewa_allocate(context, state->scan_count, SCANNER_BYTES);
    if (!text) return EWA_ERROR_MEMORY;
    size_t length = 0;
    for (uint32_t k = 0; k < state->scan_count; k++)
        for (int i = 0; i < 3; i++) {
            const scan *s = (const scan *)state->scans.data + k;
            length += ewa_number_write_f64(s->scanner_world[i], text + length);
            text[length++] = i < 2 ? ' ' : '\n';
        }
    const ewa_status status = ewa_cloud_set_note(prototype, "scanners", text, length);
    ewa_release(context, text, state->scan_count, SCANNER_BYTES);
    return status;
}

static ewa_status add_attribute(ptx_state *state, ewa_cloud *prototype, const char *name, ewa_type type,
                                uint32_t component_count, uint32_t *index) {
    *index = ewa_cloud_attribute_count(prototype);
    state->attribute_bytes[*index] = component_count * ewa_type_bytes(type);
    return ewa_cloud_add(prototype, name, type, component_count, NULL);
}

// ---- the points ------------------------------------------------------------------------------------------

/// One line of a chunk.
typedef struct reading {
    const char *at, *end;
    ewa_rows_fault fault;
} reading;

/// Takes a number; a shift is subtracted. False at what is none, where the reading stays.
static inline bool take(reading *r, int64_t shift, double *value) {
    while (r->at < r->end && ewa_is_blank(*r->at)) r->at++;
    r->fault = EWA_ROWS_SHORT;
    if (r->at == r->end || ewa_is_line_end(*r->at)) return false;
    const char *after = ewa_number_read_shifted(r->at, r->end, shift, value);
    r->fault = EWA_ROWS_NUMBER;
    if (!after || (after < r->end && !ewa_is_blank(*after) && !ewa_is_line_end(*after))) return false;
    r->at = after;
    return true;
}

/// Takes the cells of a line; `*column` is the one that is damaged.
static bool take_cells(const scan *s, reading *r, double position[3], double *intensity, uint8_t color[3],
                       uint32_t *column) {
    for (*column = 0; *column < 3; ++*column)
        if (!take(r, s->still ? -(int64_t)s->offset_world[*column] : 0, &position[*column])) return false;
    if (!take(r, 0, intensity)) return false;
    for (++*column; s->color && *column < 7; ++*column) {
        double value;
        while (r->at < r->end && ewa_is_blank(*r->at)) r->at++;
        const char *start = r->at;
        if (!take(r, 0, &value)) return false;
        r->fault = EWA_ROWS_RANGE;
        if (!(value >= 0 && value <= 255)) {
            r->at = start;
            return false;
        }
        color[*column - 4] = (uint8_t)(value + 0.5);
    }
    while (r->at < r->end && (ewa_is_blank(*r->at) || *r->at == '\r')) r->at++;
    r->fault = EWA_ROWS_LONG;
    return r->at == r->end || ewa_is_line_end(*r->at);
}

/// Whether nothing came back: 0 0 0 before the matrix.
static bool is_nothing(const scan *s, const double position[3]) {
    for (int i = 0; i < 3; i++)
        if (position[i] != (s->still ? s->offset_world[i] : 0)) return false;
    return true;
}

static void place(const scan *s, double p[3]) {
    if (s->still) return;
    const double x = p[0], y = p[1], z = p[2];
    for (int i = 0; i < 3; i++)
        p[i] = x * s->matrix[i] + y * s->matrix[4 + i] + z * s->matrix[8 + i] + s->offset_world[i];
}

static inline void store(const ewa_cloud_sink *sink, uint64_t index, const void *value, size_t size_bytes) {
    if (sink->to) memcpy(sink->to + index * sink->stride_bytes, value, size_bytes);
}

static void read_chunk(const void *format, const ewa_rows_chunk *chunk, uint64_t maximum,
                       const ewa_cloud_sink *sinks, uint64_t first, ewa_rows_result *result) {
    const ptx_state *state = format;
    const scan *s = (const scan *)state->scans.data + chunk->part;
    reading r = {.at = chunk->at, .end = chunk->end};
    while (r.at < chunk->end) {
        const char *start = r.at;
        double position[3] = {0}, intensity = 0;
        uint8_t color[3] = {255, 255, 255};
        uint32_t column;
        if (is_blank_line(&state->rows, r.at)) {
            r.at = start;
        } else if (!take_cells(s, &r, position, &intensity, color, &column)) {
            if (result->bad_count++ == 0) {
                result->bad_at = r.at;
                result->bad_column = column + 1;
                result->fault = r.fault;
            }
        } else if (!is_nothing(s, position)) {
            place(s, position);
            if (!isfinite(position[0]) || !isfinite(position[1]) || !isfinite(position[2])) {
                result->nowhere_count++;
            } else if (result->point_count == maximum) {
                result->after = start;
                return;
            } else {
                const uint64_t index = first + result->point_count++;
                const float shown = (float)intensity;
                const uint16_t part = (uint16_t)chunk->part;
                store(&sinks[0], index, position, sizeof position);
                store(&sinks[1], index, &shown, sizeof shown);
                if (state->color) store(&sinks[state->color_index], index, color, sizeof color);
                if (state->scan_count > 1) store(&sinks[state->scan_index], index, &part, sizeof part);
            }
        }
        r.at = ewa_rows_line_end(&state->rows, r.at);
        r.at += r.at < chunk->end;
    }
    result->after = chunk->end;
}

// ---- the format ------------------------------------------------------------------------------------------

static void close_ptx(void *data) {
    ptx_state *state = data;
    if (!state) return;
    ewa_context *context = state->rows.source->context;
    ewa_rows_close(&state->rows);
    ewa_buffer_free(context, &state->scans);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status fill_prototype(ptx_state *state, ewa_cloud *prototype) {
    double first_world[3] = {0};
    uint32_t index;
    EWA_TRY(take_scans(state, first_world));
    set_origin(state, first_world, prototype);
    EWA_TRY(add_attribute(state, prototype, EWA_POSITION, EWA_F64, 3, &index));
    EWA_TRY(add_attribute(state, prototype, "intensity", EWA_F32, 1, &index));
    if (state->color) EWA_TRY(add_attribute(state, prototype, EWA_COLOR, EWA_U8, 3, &state->color_index));
    if (state->scan_count > 1)
        EWA_TRY(add_attribute(state, prototype, "scan", EWA_U16, 1, &state->scan_index));
    return set_scanners(state, prototype);
}

static ewa_status open_ptx(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                           void **data) {
    ptx_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_rows_open(&state->rows, source);
    if (status == EWA_OK) status = fill_prototype(state, prototype);
    if (status != EWA_OK) {
        close_ptx(state);
        return status;
    }
    state->rows.read_chunk = read_chunk;
    state->rows.format = state;
    state->rows.attribute_count = ewa_cloud_attribute_count(prototype);
    state->rows.attribute_bytes = state->attribute_bytes;
    *point_count = state->point_count;
    *data = state;
    return EWA_OK;
}

static ewa_status read_ptx(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    ptx_state *state = data;
    return ewa_rows_read(&state->rows, maximum, sinks, got_count);
}

const ewa_cloud_format ewa_format_ptx = {EWA_MODEL_PTX, probe, open_ptx, read_ptx, close_ptx};
