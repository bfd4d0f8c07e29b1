// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PCD files out, binary or ascii. Colours of 8 bits are packed into one number, as the Point Cloud Library
// has them; all other numbers keep their bits.
#include "base/base.h"
#include "base/format.h"
#include "cloud/cloud.h"
#include "io/cloud/pcd.h"
#include "io/cloud/ply.h"
#include "io/file.h"
#include "io/number.h"
#include "io/records.h"

#include <stdio.h>

enum {
    TASK_POINTS = 4096,
    WAVE_TASKS = 1 << 4,
    NAME_BYTES = EWA_NAME_BYTES + 16,
    COUNT_DIGITS = 20, ///< room for a number of points that only the end knows
};

/// Where the numbers of an attribute lie in a record.
typedef struct field {
    ewa_type type; ///< in the file
    uint32_t component_count;
    uint32_t number_count; ///< in the file: packed colours are one
    uint32_t offset_bytes;
    bool packed, world; ///< colour; position in world units
} field;

typedef struct write_state {
    const ewa_cloud_target *target;
    field fields[EWA_PCD_MAX_COLUMNS];
    uint32_t field_count, record_bytes, number_count;
    double origin_world[3];
    ewa_coordinate_grid grid;
    bool ascii;
    uint64_t width_at_bytes, points_at_bytes; ///< of the header
    uint64_t header_bytes;
    uint64_t written_count;
    uint8_t *output;
    size_t task_bytes; ///< of the output of one task
    const ewa_cloud *piece;
    uint64_t first; ///< point of the wave
    uint64_t got_bytes[WAVE_TASKS];
} write_state;

/// Name of the field that number `number` of an attribute becomes; one field for all when they have none of
/// their own.
static void field_name(const ewa_attribute *attribute, const field *f, uint32_t number,
                       char name[NAME_BYTES]) {
    static const char *const normal[] = {"normal_x", "normal_y", "normal_z"};
    static const char *const color[] = {"red", "green", "blue", "alpha"};
    const bool three = f->component_count == 3;
    if (three && strcmp(attribute->name, EWA_POSITION) == 0)
        snprintf(name, NAME_BYTES, "%c", "xyz"[number]);
    else if (three && strcmp(attribute->name, EWA_NORMAL) == 0)
        snprintf(name, NAME_BYTES, "%s", normal[number]);
    else if (f->packed)
        snprintf(name, NAME_BYTES, "%s", three ? "rgb" : "rgba");
    else if (f->component_count >= 3 && strcmp(attribute->name, EWA_COLOR) == 0)
        snprintf(name, NAME_BYTES, "%s", color[number]);
    else
        snprintf(name, NAME_BYTES, "%s", attribute->name);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == 0x7f) *c = '_';
}

/// Whether all numbers of an attribute are one field.
static bool is_one_field(const ewa_attribute *attribute, const field *f) {
    char first[NAME_BYTES], second[NAME_BYTES];
    if (f->number_count == 1) return true;
    field_name(attribute, f, 0, first);
    field_name(attribute, f, 1, second);
    return strcmp(first, second) == 0;
}

static bool has_origin(const double origin_world[3]) {
    return origin_world[0] != 0 || origin_world[1] != 0 || origin_world[2] != 0;
}

/// Lays the attributes out in records and checks that every field has a name of its own.
static ewa_status lay_out(write_state *state) {
    const ewa_cloud_target *target = state->target;
    ewa_context *context = target->context;
    state->field_count = ewa_cloud_attribute_count(target->prototype);
    if (state->field_count > EWA_PCD_MAX_FIELDS / 4)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d attributes", target->name,
                        EWA_PCD_MAX_FIELDS / 4);
    char(*names)[NAME_BYTES] = ewa_allocate(context, EWA_PCD_MAX_FIELDS, sizeof *names);
    if (!names) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    uint32_t name_count = 0;
    for (uint32_t i = 0; i < state->field_count && status == EWA_OK; i++) {
        const ewa_attribute *a = ewa_cloud_attribute_at(target->prototype, i);
        field *f = &state->fields[i];
        *f = (field){a->type, a->component_count, a->component_count, state->record_bytes, false, false};
        f->packed = a->type == EWA_U8 && a->component_count >= 3 && strcmp(a->name, EWA_COLOR) == 0;
        f->world =
            strcmp(a->name, EWA_POSITION) == 0 && (a->type != EWA_F32 || has_origin(state->origin_world));
        if (f->world) f->type = EWA_F64;
        if (f->packed) {
            f->type = EWA_U32;
            f->number_count = 1;
        }
        state->record_bytes += f->number_count * (uint32_t)ewa_type_bytes(f->type);
        state->number_count += f->number_count;
        const uint32_t count = is_one_field(a, f) ? 1 : f->number_count;
        for (uint32_t c = 0; c < count && status == EWA_OK; c++) {
            char *name = names[name_count++];
            field_name(a, f, c, name);
            bool taken = strcmp(name, "_") == 0;
            for (uint32_t k = 0; k + 1 < name_count; k++) taken |= strcmp(names[k], name) == 0;
            if (taken)
                status = ewa_fail(context, EWA_ERROR_ARGUMENT,
                                  "%s: field '%s' would have the name of another one, or of padding",
                                  target->name, name);
        }
    }
    ewa_release(context, names, EWA_PCD_MAX_FIELDS, sizeof *names);
    return status;
}

static ewa_status put(write_state *state, const char *text, size_t length) {
    state->header_bytes += length;
    return ewa_writer_put(state->target->writer, text, length);
}

/// Writes one line of the header that has a word for each field.
static ewa_status put_line(write_state *state, const char *word) {
    ewa_status status = put(state, word, strlen(word));
    for (uint32_t i = 0; i < state->field_count; i++) {
        const ewa_attribute *a = ewa_cloud_attribute_at(state->target->prototype, i);
        const field *f = &state->fields[i];
        const bool is_float = f->type == EWA_F32 || f->type == EWA_F64;
        const bool is_signed = f->type == EWA_I8 || f->type == EWA_I16 || f->type == EWA_I32;
        const bool one = is_one_field(a, f);
        for (uint32_t c = 0; c < (one ? 1 : f->number_count) && status == EWA_OK; c++) {
            char text[NAME_BYTES + 1], name[NAME_BYTES];
            field_name(a, f, c, name);
            if (*word == 'F') snprintf(text, sizeof text, " %s", name);
            if (*word == 'S') snprintf(text, sizeof text, " %zu", ewa_type_bytes(f->type));
            if (*word == 'T') snprintf(text, sizeof text, " %c", is_float ? 'F' : is_signed ? 'I' : 'U');
            if (*word == 'C') snprintf(text, sizeof text, " %u", one ? f->number_count : 1);
            status = put(state, text, strlen(text));
        }
    }
    return status == EWA_OK ? put(state, "\n", 1) : status;
}

/// The place of the only scanner, if the cloud knows one; else the origin.
static void viewpoint(const ewa_cloud *cloud, char text[128]) {
    const char *note = ewa_cloud_note(cloud, "scanners", NULL);
    double place[3] = {0, 0, 0};
    if (note && !strchr(note, '\n')) {
        ewa_cursor cursor = {note, note + strlen(note), 1};
        if (ewa_cursor_numbers(&cursor, 3, place) != 3) memset(place, 0, sizeof place);
    }
    ewa_format(text, 128, "VIEWPOINT %.17g %.17g %.17g 1 0 0 0\n", place[0], place[1], place[2]);
}

static ewa_status write_header(write_state *state) {
    static const char begin[] = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
    static const char *const words[] = {"FIELDS", "SIZE", "TYPE", "COUNT"};
    ewa_status status = put(state, begin, sizeof begin - 1);
    for (int i = 0; i < 4 && status == EWA_OK; i++) status = put_line(state, words[i]);
    char text[128];
    const uint64_t known = state->target->point_count;
    const int digits = known == EWA_POINTS_UNKNOWN ? COUNT_DIGITS : 1;
    const unsigned long long count = known == EWA_POINTS_UNKNOWN ? 0 : known;
    state->width_at_bytes = state->header_bytes + 6;
    snprintf(text, sizeof text, "WIDTH %-*llu\nHEIGHT 1\n", digits, count);
    if (status == EWA_OK) status = put(state, text, strlen(text));
    viewpoint(state->target->prototype, text);
    if (status == EWA_OK) status = put(state, text, strlen(text));
    state->points_at_bytes = state->header_bytes + 7;
    snprintf(text, sizeof text, "POINTS %-*llu\nDATA %s\n", digits, count, state->ascii ? "ascii" : "binary");
    return status == EWA_OK ? put(state, text, strlen(text)) : status;
}

static void close_file(void *opened) {
    write_state *state = opened;
    if (!state) return;
    ewa_context *context = state->target->context;
    ewa_release(context, state->output, WAVE_TASKS, state->task_bytes);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_file(const ewa_cloud_target *target, void **opened) {
    ewa_context *context = target->context;
    *opened = NULL;
    if (target->options->ply_encoding == EWA_PLY_BINARY_BIG_ENDIAN)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: PCD files are not big-endian", target->name);
    write_state *state = ewa_allocate_zeroed(context, 1, sizeof *state);
    if (!state) return EWA_ERROR_MEMORY;
    state->target = target;
    state->ascii = target->options->ply_encoding == EWA_PLY_ASCII;
    ewa_cloud_origin(target->prototype, state->origin_world);
    ewa_cloud_grid(target->prototype, &state->grid);
    ewa_status status = lay_out(state);
    if (status == EWA_OK) {
        state->task_bytes =
            (size_t)TASK_POINTS *
            (state->record_bytes + (state->ascii ? state->number_count * EWA_NUMBER_BYTES : 0));
        state->output = ewa_allocate(context, WAVE_TASKS, state->task_bytes);
        status = state->output ? write_header(state) : EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK)
        *opened = state;
    else
        close_file(state);
    return status;
}

static void pack(const ewa_attribute *a, const field *f, uint64_t first, uint64_t count, uint8_t *to,
                 uint32_t record_bytes) {
    const uint8_t *from = (const uint8_t *)a->data + first * a->stride_bytes;
    for (uint64_t i = 0; i < count; i++, from += a->stride_bytes, to += record_bytes) {
        const uint32_t alpha = f->component_count == 4 ? from[3] : 0;
        const uint32_t bits = alpha << 24 | (uint32_t)from[0] << 16 | (uint32_t)from[1] << 8 | from[2];
        memcpy(to, &bits, sizeof bits);
    }
}

static void put_world(const write_state *state, const ewa_attribute *a, uint64_t first, uint64_t count,
                      uint8_t *to) {
    for (uint64_t i = 0; i < count; i++, to += state->record_bytes) {
        double place[3];
        ewa_attribute_read_f64(a, first + i, 1, place);
        for (uint32_t c = 0; c < 3; c++)
            place[c] = ewa_grid_world(&state->grid, c, state->origin_world[c] + place[c]);
        memcpy(to, place, sizeof place);
    }
}

/// Makes records, in this machine's byte order for text, else in the file's.
static void make_records(const write_state *state, uint64_t first, uint64_t count, uint8_t *to) {
    const bool swap = !state->ascii && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
    for (uint32_t i = 0; i < state->field_count; i++) {
        const ewa_attribute *a = ewa_cloud_attribute_at(state->piece, i);
        const field *f = &state->fields[i];
        uint8_t *number = to + f->offset_bytes;
        const ewa_move move = {f->type, f->type, f->number_count, swap};
        if (f->packed)
            pack(a, f, first, count, number, state->record_bytes);
        else if (f->world)
            put_world(state, a, first, count, number);
        else
            ewa_move_numbers(&move, number, state->record_bytes,
                             (const uint8_t *)a->data + first * a->stride_bytes, a->stride_bytes, count);
        if (swap && (f->packed || f->world))
            ewa_move_numbers(&move, number, state->record_bytes, number, state->record_bytes, count);
    }
}

static size_t make_text(const write_state *state, uint64_t count, const uint8_t *records, char *text) {
    char *at = text;
    for (uint64_t i = 0; i < count; i++, records += state->record_bytes) {
        for (uint32_t k = 0; k < state->field_count; k++) {
            const field *f = &state->fields[k];
            for (uint32_t c = 0; c < f->number_count; c++) {
                at += ewa_ply_write_number(f->type, records + f->offset_bytes + c * ewa_type_bytes(f->type),
                                           at);
                *at++ = ' ';
            }
        }
        at[-1] = '\n';
    }
    return (size_t)(at - text);
}

static void write_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    write_state *state = data;
    uint8_t *output = state->output + task * state->task_bytes;
    const uint64_t first = state->first + (uint64_t)task * TASK_POINTS;
    const uint64_t left = ewa_cloud_point_count(state->piece) - first;
    const uint64_t count = left < TASK_POINTS ? left : TASK_POINTS;
    uint8_t *records =
        output + (state->ascii ? state->task_bytes - TASK_POINTS * (size_t)state->record_bytes : 0);
    make_records(state, first, count, records);
    state->got_bytes[task] =
        state->ascii ? make_text(state, count, records, (char *)output) : count * state->record_bytes;
}

static ewa_status put_points(void *opened, const ewa_cloud *piece) {
    write_state *state = opened;
    const uint64_t count = ewa_cloud_point_count(piece);
    ewa_status status = EWA_OK;
    state->piece = piece;
    for (state->first = 0; state->first < count && status == EWA_OK;) {
        const uint64_t left = (count - state->first + TASK_POINTS - 1) / TASK_POINTS;
        const uint32_t tasks = left < WAVE_TASKS ? (uint32_t)left : WAVE_TASKS;
        ewa_parallel(state->target->context, write_task, state, tasks);
        for (uint32_t i = 0; i < tasks && status == EWA_OK; i++)
            status = ewa_writer_put(state->target->writer, state->output + i * state->task_bytes,
                                    state->got_bytes[i]);
        state->first += (uint64_t)tasks * TASK_POINTS;
        const double done = state->first < count ? (double)state->first / (double)count : 1;
        if (status == EWA_OK) status = ewa_progress(state->target->context, "write", done);
    }
    state->written_count += count;
    return status;
}

static ewa_status finish(void *opened) {
    write_state *state = opened;
    if (state->target->point_count != EWA_POINTS_UNKNOWN) return EWA_OK;
    char text[COUNT_DIGITS + 1];
    const int length = snprintf(text, sizeof text, "%llu", (unsigned long long)state->written_count);
    EWA_TRY(ewa_writer_patch(state->target->writer, state->width_at_bytes, text, (size_t)length));
    return ewa_writer_patch(state->target->writer, state->points_at_bytes, text, (size_t)length);
}

const ewa_cloud_write_format ewa_write_pcd = {
    .suffixes = ".pcd", .open = open_file, .put = put_points, .finish = finish, .close = close_file};
