// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From clouds to text: a line per point. Coordinates on a decimal grid are written by integers, with exactly
// its decimals; every other number with as few digits as read back the same. Lines are made in parallel by
// tasks of a fixed number of points and written in their order.
#include "base/base.h"
#include "cloud/cloud.h"
#include "image/srgb.h"
#include "io/cloud/format.h"
#include "io/cloud/ply.h"
#include "io/cloud/text_rows.h"
#include "io/file.h"
#include "io/number.h"

#include <math.h>
#include <stdio.h>
#include <strings.h>

enum {
    TASK_BYTES = 1 << 17,
    WAVE_TASKS_PER_WORKER = 4,
    BLOCK_POINTS = 32,
    CELL_BYTES = EWA_NUMBER_BYTES + 1, // with the separator
    COUNT_DIGITS = 20,
    MAX_DECIMALS = 9,
    SHARE_DECIMALS = 6, // tell 65536 shares apart
};

/// How the numbers of a column are written.
typedef enum cell_kind {
    CELL_FIXED, // a coordinate, `decimals` digits behind the point
    CELL_WORLD, // a coordinate of which no decimals are known
    CELL_WHOLE,
    CELL_F32,
    CELL_F64,
    CELL_SHARE, // a colour: `scale` times the number, from 0 to 1 in sRGB
    CELL_LIGHT, // a colour as linear light, written likewise
    CELL_CODE,  // a colour as one of 256 codes: the number times `scale`, rounded
    CELL_LIGHT_CODE,
} cell_kind;

typedef struct column {
    cell_kind kind;
    uint32_t attribute, component;
    uint32_t stride;       // components of the attribute
    uint32_t first_number; // of the attribute's components, in a block of points
    int decimals;
    int64_t origin_parts; // CELL_FIXED: of the origin, in units of the last decimal
    double scale;         // CELL_FIXED: such units of one; colours: see the kinds
    double origin_world;
    char name[EWA_PLY_NAME_BYTES];
} column;

typedef struct text_writer {
    const ewa_cloud_target *target;
    column columns[EWA_ROWS_MAX_COLUMNS];
    uint32_t column_count;
    bool wanted[EWA_ROWS_MAX_COLUMNS];           // by attribute
    uint32_t first_number[EWA_ROWS_MAX_COLUMNS]; // by attribute, in a point of a block
    uint32_t number_count;                       // of a point of a block
    char separator;
    bool pts;
    uint64_t put_count, count_at;
    const ewa_cloud *piece; // that is being written
    uint64_t first, end;    // points of this wave
    uint64_t task_points;
    size_t task_bytes;
    char *output; // task_bytes per task
    size_t *output_bytes;
} text_writer;

// ---- numbers ---------------------------------------------------------------------------------------------

static const int64_t powers_of_10[MAX_DECIMALS + 1] = {1,      10,      100,      1000,      10000,
                                                       100000, 1000000, 10000000, 100000000, 1000000000};

/// Writes parts / 10^decimals.
static size_t write_fixed(int64_t parts, int decimals, char *text) {
    size_t at = 0;
    if (parts < 0) text[at++] = '-';
    const uint64_t magnitude = parts < 0 ? 0 - (uint64_t)parts : (uint64_t)parts;
    const uint64_t unit = (uint64_t)powers_of_10[decimals];
    at += ewa_number_write_i64((int64_t)(magnitude / unit), text + at);
    if (decimals == 0) return at;
    text[at++] = '.';
    uint64_t rest = magnitude % unit;
    for (int i = decimals; i-- > 0; rest /= 10) text[at + (size_t)i] = (char)('0' + rest % 10);
    return at + (size_t)decimals;
}

/// A colour between 0 and 1 from a share; what is no number is 0.
static double clamp(double share) { return share > 0 ? share < 1 ? share : 1 : 0; }

static size_t write_cell(const column *c, double value, char *text) {
    switch (c->kind) {
    case CELL_FIXED: {
        const double parts = nearbyint(value * c->scale);
        if (fabs(parts) < 0x1p53) return write_fixed((int64_t)parts + c->origin_parts, c->decimals, text);
        return ewa_number_write_f64(value + c->origin_world, text);
    }
    case CELL_WORLD:
        return ewa_number_write_f64(value + c->origin_world, text);
    case CELL_WHOLE:
        return ewa_number_write_i64((int64_t)value, text);
    case CELL_F32:
        return ewa_number_write_f32((float)value, text);
    case CELL_F64:
        return ewa_number_write_f64(value, text);
    case CELL_SHARE:
        value = clamp(value * c->scale);
        return write_fixed((int64_t)(value * 1e6 + 0.5), SHARE_DECIMALS, text);
    case CELL_LIGHT:
        value = ewa_srgb_encode(clamp(value));
        return write_fixed((int64_t)(value * 1e6 + 0.5), SHARE_DECIMALS, text);
    case CELL_CODE:
        return ewa_number_write_i64((int64_t)(value * c->scale + 0.5), text);
    case CELL_LIGHT_CODE:
        return ewa_number_write_i64(ewa_srgb8_from_linear((float)value), text);
    }
    return 0;
}

static size_t write_lines(const text_writer *writer, uint64_t first, uint64_t count, double *numbers,
                          char *text) {
    const char *start = text;
    const ewa_attribute *attribute;
    for (uint32_t a = 0; (attribute = ewa_cloud_attribute_at(writer->piece, a)); a++)
        if (writer->wanted[a])
            ewa_attribute_read_f64(attribute, first, count, numbers + writer->first_number[a] * BLOCK_POINTS);
    for (uint64_t i = 0; i < count; i++) {
        for (uint32_t c = 0; c < writer->column_count; c++) {
            const column *cell = &writer->columns[c];
            const double *value = numbers + cell->first_number * BLOCK_POINTS + i * cell->stride;
            text += write_cell(cell, value[cell->component], text);
            *text++ = writer->separator;
        }
        text[-1] = '\n';
    }
    return (size_t)(text - start);
}

static void make_output(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const text_writer *writer = data;
    double numbers[EWA_ROWS_MAX_COLUMNS * BLOCK_POINTS];
    char *output = writer->output + index * writer->task_bytes;
    uint64_t first = writer->first + index * writer->task_points;
    const uint64_t end =
        first + writer->task_points < writer->end ? first + writer->task_points : writer->end;
    size_t size_bytes = 0;
    while (first < end) {
        const uint64_t count = end - first < BLOCK_POINTS ? end - first : BLOCK_POINTS;
        size_bytes += write_lines(writer, first, count, numbers, output + size_bytes);
        first += count;
    }
    writer->output_bytes[index] = size_bytes;
}

static ewa_status put(void *state, const ewa_cloud *piece) {
    text_writer *writer = state;
    const ewa_cloud_target *target = writer->target;
    const uint32_t wave = WAVE_TASKS_PER_WORKER * ewa_context_worker_count(target->context);
    const uint64_t count = ewa_cloud_point_count(piece);
    ewa_status status = EWA_OK;
    writer->piece = piece;
    for (writer->first = 0; writer->first < count && status == EWA_OK; writer->first = writer->end) {
        const uint64_t left = count - writer->first, maximum = wave * writer->task_points;
        writer->end = writer->first + (left < maximum ? left : maximum);
        const uint32_t tasks =
            (uint32_t)((writer->end - writer->first + writer->task_points - 1) / writer->task_points);
        ewa_parallel(target->context, make_output, writer, tasks);
        for (uint32_t i = 0; i < tasks && status == EWA_OK; i++)
            status = ewa_writer_put(target->writer, writer->output + i * writer->task_bytes,
                                    writer->output_bytes[i]);
        const uint64_t all = target->point_count, done = writer->put_count + writer->end;
        if (status == EWA_OK)
            status = ewa_progress(target->context, "write",
                                  all == EWA_POINTS_UNKNOWN ? 0 : (double)done / (double)all);
    }
    writer->put_count += count;
    return status;
}

// ---- columns ---------------------------------------------------------------------------------------------

/// How many decimals coordinates of a grid and an origin have; -1 when more than 9.
static int decimals_of(double step, double offset, double origin) {
    for (int d = 0; d <= MAX_DECIMALS && step > 0; d++) {
        const double unit = (double)powers_of_10[d];
        const double numbers[] = {step * unit, offset * unit, origin * unit};
        bool whole = numbers[0] >= 0.5;
        for (int i = 0; i < 3; i++)
            whole = whole && fabs(numbers[i]) < 0x1p53 &&
                    fabs(numbers[i] - nearbyint(numbers[i])) <= 1e-9 + 1e-15 * fabs(numbers[i]);
        if (whole) return d;
    }
    return -1;
}

static void set_position(const text_writer *writer, const ewa_attribute *attribute, column *c) {
    ewa_coordinate_grid grid;
    double origin_world[3];
    ewa_cloud_grid(writer->target->prototype, &grid);
    ewa_cloud_origin(writer->target->prototype, origin_world);
    c->origin_world = origin_world[c->component];
    c->kind = attribute->type == EWA_F32 && c->origin_world == 0 ? CELL_F32 : CELL_WORLD;
    const int decimals =
        decimals_of(grid.step_world[c->component], grid.offset_world[c->component], c->origin_world);
    if (decimals < 0) return;
    c->kind = CELL_FIXED;
    c->decimals = decimals;
    c->scale = (double)powers_of_10[decimals];
    c->origin_parts = (int64_t)nearbyint(c->origin_world * c->scale);
}

static void set_color(const text_writer *writer, const ewa_attribute *attribute, column *c) {
    if (attribute->type == EWA_F32 || attribute->type == EWA_F64) {
        c->kind = writer->pts ? CELL_LIGHT_CODE : CELL_LIGHT;
    } else if (attribute->type == EWA_U8) {
        c->kind = CELL_WHOLE;
    } else if (attribute->type == EWA_U16) {
        c->kind = writer->pts ? CELL_CODE : CELL_SHARE;
        c->scale = writer->pts ? 255.0 / 65535 : 1.0 / 65535;
    } else {
        c->kind = CELL_WHOLE;
    }
}

/// Names that CloudCompare knows, in its spelling.
static const char *comment_name(const column *c) {
    static const char *const names[][2] = {{"x", "X"},    {"y", "Y"},    {"z", "Z"},   {"nx", "Nx"},
                                           {"ny", "Ny"},  {"nz", "Nz"},  {"red", "R"}, {"green", "G"},
                                           {"blue", "B"}, {"alpha", "A"}};
    static const char *const shares[] = {"Rf", "Gf", "Bf", "Af"};
    if (c->kind == CELL_SHARE || c->kind == CELL_LIGHT) return shares[c->component];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(names[i][0], c->name) == 0) return names[i][1];
    return c->name;
}

static ewa_status add_columns(text_writer *writer, uint32_t index) {
    const ewa_cloud_target *target = writer->target;
    const ewa_attribute *attribute = ewa_cloud_attribute_at(target->prototype, index);
    writer->wanted[index] = true;
    writer->first_number[index] = writer->number_count;
    for (uint32_t k = 0; k < attribute->component_count; k++) {
        if (writer->column_count == EWA_ROWS_MAX_COLUMNS)
            return ewa_fail(target->context, EWA_ERROR_LIMIT, "%s: more than %d columns", target->name,
                            EWA_ROWS_MAX_COLUMNS);
        column *c = &writer->columns[writer->column_count++];
        *c = (column){.kind = CELL_WHOLE, .attribute = index, .component = k};
        c->stride = attribute->component_count;
        c->first_number = writer->number_count;
        if (attribute->type == EWA_F32) c->kind = CELL_F32;
        if (attribute->type == EWA_F64) c->kind = CELL_F64;
        if (strcmp(attribute->name, EWA_POSITION) == 0) set_position(writer, attribute, c);
        if (strcmp(attribute->name, EWA_COLOR) == 0 && attribute->component_count >= 3)
            set_color(writer, attribute, c);
        ewa_ply_property_name(attribute, k, c->name);
        for (char *at = c->name; *at; at++)
            if (*at == ',' || *at == ';' || *at == '"') *at = '_';
        for (uint32_t i = 0; i + 1 < writer->column_count; i++)
            if (strcmp(writer->columns[i].name, c->name) == 0)
                return ewa_fail(target->context, EWA_ERROR_ARGUMENT,
                                "%s: two attributes would become column '%s'", target->name, c->name);
    }
    writer->number_count += attribute->component_count;
    return EWA_OK;
}

/// Chooses the columns: position, normal, colour, then the others in their order; of PTS position, intensity,
/// colour, and no others.
static ewa_status choose_columns(text_writer *writer) {
    static const char *const orders[2][3] = {{EWA_POSITION, EWA_NORMAL, EWA_COLOR},
                                             {EWA_POSITION, "intensity", EWA_COLOR}};
    const ewa_cloud *prototype = writer->target->prototype;
    const uint32_t count = ewa_cloud_attribute_count(prototype);
    if (count > EWA_ROWS_MAX_COLUMNS)
        return ewa_fail(writer->target->context, EWA_ERROR_LIMIT, "%s: more than %d columns",
                        writer->target->name, EWA_ROWS_MAX_COLUMNS);
    ewa_status status = EWA_OK;
    uint32_t chosen = 0;
    for (int k = 0; k < 4; k++)
        for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
            const ewa_attribute *attribute = ewa_cloud_attribute_at(prototype, i);
            const bool fits = k < 3 ? strcmp(attribute->name, orders[writer->pts][k]) == 0 : !writer->pts;
            if (!fits || writer->wanted[i]) continue;
            chosen++;
            status = add_columns(writer, i);
        }
    if (status == EWA_OK && chosen < count)
        ewa_report(writer->target->context, EWA_SEVERITY_WARNING,
                   "%s: PTS has room for intensity and colour: %u other attributes are left out",
                   writer->target->name, count - chosen);
    return status;
}

// ---- the format ------------------------------------------------------------------------------------------

static ewa_status write_count(text_writer *writer) {
    char line[COUNT_DIGITS + 2];
    const uint64_t count = writer->target->point_count;
    writer->count_at = ewa_writer_size(writer->target->writer);
    const int length = count == EWA_POINTS_UNKNOWN
                           ? snprintf(line, sizeof line, "%-*s\n", COUNT_DIGITS, "0")
                           : snprintf(line, sizeof line, "%llu\n", (unsigned long long)count);
    return ewa_writer_put(writer->target->writer, line, (size_t)length);
}

static ewa_status write_head(const text_writer *writer) {
    const bool comma = writer->separator == ',';
    if (!comma && writer->column_count == 3) return EWA_OK;
    if (!comma) EWA_TRY(ewa_writer_put(writer->target->writer, "//", 2));
    for (uint32_t c = 0; c < writer->column_count; c++) {
        const char *name = comma ? writer->columns[c].name : comment_name(&writer->columns[c]);
        EWA_TRY(ewa_writer_put(writer->target->writer, name, strlen(name)));
        const char end = c + 1 < writer->column_count ? writer->separator : '\n';
        EWA_TRY(ewa_writer_put(writer->target->writer, &end, 1));
    }
    return EWA_OK;
}

static void close_text(void *state) {
    text_writer *writer = state;
    if (!writer) return;
    ewa_context *context = writer->target->context;
    const uint32_t wave = WAVE_TASKS_PER_WORKER * ewa_context_worker_count(context);
    ewa_release(context, writer->output_bytes, wave, sizeof *writer->output_bytes);
    ewa_release(context, writer->output, wave, writer->task_bytes);
    ewa_release(context, writer, 1, sizeof *writer);
}

static ewa_status begin(text_writer *writer) {
    const ewa_cloud_target *target = writer->target;
    const char *dot = strrchr(target->name, '.');
    writer->pts = dot && strcasecmp(dot, ".pts") == 0;
    writer->separator = dot && strcasecmp(dot, ".csv") == 0 ? ',' : ' ';
    EWA_TRY(choose_columns(writer));
    const size_t line_bytes = (size_t)writer->column_count * CELL_BYTES;
    const uint32_t wave = WAVE_TASKS_PER_WORKER * ewa_context_worker_count(target->context);
    writer->task_points = TASK_BYTES / line_bytes;
    writer->task_bytes = writer->task_points * line_bytes;
    writer->output = ewa_allocate(target->context, wave, writer->task_bytes);
    writer->output_bytes = ewa_allocate(target->context, wave, sizeof *writer->output_bytes);
    if (!writer->output || !writer->output_bytes) return EWA_ERROR_MEMORY;
    return writer->pts ? write_count(writer) : write_head(writer);
}

static ewa_status open_text(const ewa_cloud_target *target, void **state) {
    text_writer *writer = ewa_allocate_zeroed(target->context, 1, sizeof *writer);
    if (!writer) return EWA_ERROR_MEMORY;
    writer->target = target;
    const ewa_status status = begin(writer);
    if (status == EWA_OK)
        *state = writer;
    else
        close_text(writer);
    return status;
}

static ewa_status finish(void *state) {
    const text_writer *writer = state;
    if (!writer->pts || writer->target->point_count != EWA_POINTS_UNKNOWN) return EWA_OK;
    char digits[COUNT_DIGITS + 1];
    const int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)writer->put_count);
    return ewa_writer_patch(writer->target->writer, writer->count_at, digits, (size_t)length);
}

const ewa_cloud_write_format ewa_write_text = {.suffixes = ".xyz|.txt|.csv|.asc|.pts",
                                               .open = open_text,
                                               .put = put,
                                               .finish = finish,
                                               .close = close_text};
