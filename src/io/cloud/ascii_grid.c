// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ASCII grids of heights (.asc): a head of names and numbers, then a number for each cell, rows from the north,
// columns from the west. A cell with a height is a point in its middle.
//
// Based on: Esri, "Esri ASCII raster format"; GDAL, "AAIGrid" (dx and dy for cells that are not square).
#include "base/base.h"
#include "io/cloud/height_grid.h"
#include "io/cloud/text_table.h"
#include "io/reader.h"
#include "io/text.h"

#include <math.h>

enum { KEYS = 11, MAX_SIDE = 1 << 30 };

/// Names of the head, in their order here.
enum { COLUMNS, ROWS, X_CORNER, X_CENTER, Y_CORNER, Y_CENTER, CELL, DX, DY, NO_DATA, NO_DATA_TOO };

static const char *const keys[KEYS] = {"ncols",     "nrows",        "xllcorner",   "xllcenter",
                                       "yllcorner", "yllcenter",    "cellsize",    "dx",
                                       "dy",        "nodata_value", "nodata-value"};

/// How many cells are looked at for the unit of heights.
enum { LOOK_CELLS = 1 << 20 };

typedef struct grid_state {
    const ewa_cloud_source *source;
    char *owned;
    size_t owned_bytes;
    ewa_cursor text;
    ewa_height_grid grid;
    uint64_t cell; ///< the next one
} grid_state;

static int find_key(ewa_text word) {
    for (int k = 0; k < KEYS; k++)
        if (ewa_text_is_any_case(word, keys[k])) return k;
    return KEYS;
}

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    ewa_cursor cursor = {(const char *)bytes, (const char *)bytes + (size_bytes < 64 ? size_bytes : 64), 1};
    cursor.at += ewa_bytes_mark(bytes, size_bytes);
    double value;
    const int key = find_key(ewa_cursor_any_word(&cursor));
    return (key == COLUMNS || key == ROWS) && ewa_text_number(ewa_cursor_any_word(&cursor), &value);
}

/// Takes the names and numbers of the head; `given[k]` says which there are.
static ewa_status take_head(grid_state *state, double values[KEYS], bool given[KEYS]) {
    const ewa_cloud_source *source = state->source;
    for (;;) {
        ewa_cursor next = state->text;
        const ewa_text word = ewa_cursor_any_word(&next);
        double value;
        if (!word.length || ewa_text_number(word, &value)) return EWA_OK;
        const int key = find_key(word);
        char quote[EWA_QUOTE_BYTES];
        const unsigned long long line = next.line;
        if (key == KEYS)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: line %llu: %s is no name of an ASCII grid's head", source->name, line,
                            ewa_quote(word, quote));
        const ewa_text number = ewa_cursor_any_word(&next);
        if (!ewa_text_number(number, &values[key]))
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: line %llu: %s of %s is no number",
                            source->name, line, ewa_quote(number, quote), keys[key]);
        given[key] = true;
        state->text = next;
    }
}

/// Where the cells of an axis are; false when the head does not say so.
static bool place_axis(const double values[KEYS], const bool given[KEYS], int axis, uint64_t count,
                       double *step, double *low_world) {
    const int corner = axis ? Y_CORNER : X_CORNER, center = axis ? Y_CENTER : X_CENTER, own = axis ? DY : DX;
    if (!given[own] && !given[CELL]) return false;
    *step = values[given[own] ? own : CELL];
    if (!given[corner] && !given[center]) return false;
    *low_world = given[center] ? values[center] : values[corner] + 0.5 * *step;
    return *step > 0 && isfinite(*low_world + *step * (double)count);
}

/// How much neighbouring cells differ on the average, of the first ones.
static double mean_step(const grid_state *state) {
    ewa_cursor text = state->text;
    double before = NAN, height, sum = 0, count = 0;
    for (uint64_t cell = 0; cell < LOOK_CELLS; cell++) {
        const ewa_text word = ewa_cursor_any_word(&text);
        if (!word.length) break;
        if (cell % state->grid.columns == 0) before = NAN;
        ewa_text_number(word, &height);
        if (!ewa_height_is(&state->grid, height)) height = NAN;
        if (isfinite(height - before)) {
            sum += fabs(height - before);
            count++;
        }
        before = height;
    }
    return count ? sum / count : 0;
}

static ewa_status read_head(grid_state *state) {
    const ewa_cloud_source *source = state->source;
    ewa_height_grid *grid = &state->grid;
    double values[KEYS] = {0}, low_world[2], step[2];
    bool given[KEYS] = {false};
    EWA_TRY(take_head(state, values, given));
    for (int k = COLUMNS; k <= ROWS; k++)
        if (!given[k] || !(values[k] >= 1 && values[k] <= MAX_SIDE) || values[k] != floor(values[k]))
            return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: %s of the ASCII grid is %g, not 1 to %d",
                            source->name, keys[k], values[k], MAX_SIDE);
    grid->columns = (uint64_t)values[COLUMNS];
    grid->rows = (uint64_t)values[ROWS];
    if (!place_axis(values, given, 0, grid->columns, &step[0], &low_world[0]) ||
        !place_axis(values, given, 1, grid->rows, &step[1], &low_world[1]))
        return ewa_fail(
            source->context, EWA_ERROR_FORMAT,
            "%s: the ASCII grid does not say where its cells are: xllcorner, yllcorner and cellsize",
            source->name);
    grid->to_world[0] = step[0];
    grid->to_world[2] = low_world[0];
    grid->to_world[4] = -step[1];
    grid->to_world[5] = low_world[1] + step[1] * (double)(grid->rows - 1);
    grid->has_no_data = given[NO_DATA] || given[NO_DATA_TOO];
    grid->no_data = values[given[NO_DATA] ? NO_DATA : NO_DATA_TOO];
    grid->is_degrees = ewa_height_grid_fits_degrees(grid) && ewa_height_grid_is_too_steep(grid, mean_step(state));
    return EWA_OK;
}

static void close_grid(void *data) {
    grid_state *state = data;
    if (!state) return;
    ewa_context *context = state->source->context;
    ewa_release(context, state->owned, state->owned_bytes, 1);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_grid(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                            void **data) {
    grid_state *state = ewa_allocate_zeroed(source->context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    state->source = source;
    ewa_status status =
        ewa_text_open(source->context, source->name, source->bytes, (size_t)source->size_bytes, &state->text,
                      &state->owned, &state->owned_bytes);
    if (status == EWA_OK) status = read_head(state);
    if (status == EWA_OK) status = ewa_height_grid_settle(source, &state->grid, prototype);
    if (status != EWA_OK) {
        close_grid(state);
        return status;
    }
    // A number takes a letter and a blank.
    const uint64_t cells = state->grid.columns * state->grid.rows,
                   room = (uint64_t)(state->text.end - state->text.at) / 2 + 1;
    *point_count = cells < room ? cells : room;
    *data = state;
    return EWA_OK;
}

/// Takes the height of the next cell; NaN where there is none.
static ewa_status take_height(grid_state *state, double *height) {
    const ewa_cloud_source *source = state->source;
    const uint64_t cells = state->grid.columns * state->grid.rows, row = state->cell / state->grid.columns + 1;
    const ewa_text word = ewa_cursor_any_word(&state->text);
    char quote[EWA_QUOTE_BYTES];
    *height = NAN;
    if (!word.length) {
        const uint64_t lost = cells - state->cell;
        state->cell = cells;
        return ewa_cloud_damage(source, lost, "%s: the file ends in row %llu of %llu", source->name,
                                (unsigned long long)row, (unsigned long long)state->grid.rows);
    }
    state->cell++;
    if (!ewa_text_number(word, height))
        return ewa_cloud_damage(source, 1, "%s: line %llu, row %llu: %s is no number", source->name,
                                (unsigned long long)state->text.line, (unsigned long long)row,
                                ewa_quote(word, quote));
    if (!ewa_height_is(&state->grid, *height)) *height = NAN;
    return EWA_OK;
}

static ewa_status read_grid(void *data, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    grid_state *state = data;
    const uint64_t columns = state->grid.columns, cells = columns * state->grid.rows;
    uint64_t got = 0;
    while (got < maximum && state->cell < cells) {
        const uint64_t column = state->cell % columns, row = state->cell / columns;
        double height;
        EWA_TRY(take_height(state, &height));
        if (isnan(height)) continue;
        if (sinks[0].to)
            ewa_height_grid_place(&state->grid, column, row, height, sinks[0].to + got * sinks[0].stride_bytes);
        got++;
    }
    *got_count = got;
    if (!state->owned)
        ewa_cloud_passed(state->source, (uint64_t)(state->text.at - (const char *)state->source->bytes));
    return ewa_progress(state->source->context, "read", (double)state->cell / (double)cells);
}

const ewa_cloud_format ewa_format_grid = {EWA_MODEL_GRID, probe, open_grid, read_grid, close_grid};
