// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From clouds to a PLY file: the header names every component of every attribute, the body is made in
// parallel by tasks of a fixed number of points and written in their order, so that the bytes do not depend
// on the threads. The points come in pieces.
#include "base/base.h"
#include "cloud/cloud.h"
#include "io/cloud/format.h"
#include "io/cloud/ply.h"
#include "io/file.h"
#include "io/number.h"

#include <stdio.h>
#include <string.h>

enum {
    TASK_BYTES = 1 << 17, // output per task, small enough that a wave stays in cache until it is written
    ASCII_NUMBER_BYTES = EWA_NUMBER_BYTES + 1, // with the blank
    COUNT_DIGITS = 20,                         // room for a count that comes later
    WAVE_TASKS_PER_WORKER = 4,
};

/// One attribute in the records of the file.
typedef struct field {
    ewa_type type; // in the file
    uint32_t component_count;
    uint32_t offset_bytes; // of the first component
} field;

typedef struct write_job {
    const ewa_cloud_target *target;
    const ewa_cloud *cloud; // the piece
    field *fields;
    uint32_t field_count, property_count;
    uint32_t record_bytes;
    bool ascii, swap;
    bool shifted; // positions are written as world coordinates in doubles
    double origin_world[3];
    ewa_coordinate_grid grid;
    uint64_t point_count, first, end; // of the piece, and those of this wave
    uint64_t put_count;               // of all pieces so far
    uint64_t count_at;                // byte of the file at which the number of points stands
    uint64_t task_points;
    size_t task_capacity_bytes;
    uint8_t *output;      // task_capacity_bytes per task
    size_t *output_bytes; // made by each task
} write_job;

static void shift_positions(const write_job *job, const ewa_attribute *attribute, uint64_t first,
                            uint64_t count, uint8_t *to) {
    enum { BLOCK = 256 };
    double values[3 * BLOCK];
    const ewa_move move = {.from_type = EWA_F64, .to_type = EWA_F64, .component_count = 3, .swap = job->swap};
    while (count) {
        const uint64_t block = count < BLOCK ? count : BLOCK;
        ewa_attribute_read_f64(attribute, first, block, values);
        for (uint64_t i = 0; i < 3 * block; i++)
            values[i] = ewa_grid_world(&job->grid, i % 3, values[i] + job->origin_world[i % 3]);
        ewa_move_numbers(&move, to, job->record_bytes, (const uint8_t *)values, 3 * sizeof *values,
                         (size_t)block);
        to += block * job->record_bytes;
        first += block;
        count -= block;
    }
}

static void make_records(const write_job *job, uint64_t first, uint64_t count, uint8_t *records) {
    for (uint32_t i = 0; i < job->field_count; i++) {
        const field *f = &job->fields[i];
        const ewa_attribute *attribute = ewa_cloud_attribute_at(job->cloud, i);
        uint8_t *to = records + f->offset_bytes;
        if (job->shifted && strcmp(attribute->name, EWA_POSITION) == 0) {
            shift_positions(job, attribute, first, count, to);
            continue;
        }
        const ewa_move move = {.from_type = attribute->type,
                               .to_type = f->type,
                               .component_count = attribute->component_count,
                               .swap = job->swap};
        const uint8_t *from = (const uint8_t *)attribute->data + first * attribute->stride_bytes;
        ewa_move_numbers(&move, to, job->record_bytes, from, attribute->stride_bytes, (size_t)count);
    }
}

static size_t write_lines(const write_job *job, const uint8_t *records, uint64_t count, char *text) {
    const char *start = text;
    for (; count; count--, records += job->record_bytes) {
        for (uint32_t i = 0; i < job->field_count; i++) {
            const field *f = &job->fields[i];
            const size_t number_bytes = ewa_type_bytes(f->type);
            for (uint32_t c = 0; c < f->component_count; c++) {
                text += ewa_ply_write_number(f->type, records + f->offset_bytes + c * number_bytes, text);
                *text++ = ' ';
            }
        }
        text[-1] = '\n';
    }
    return (size_t)(text - start);
}

static void make_output(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const write_job *job = data;
    uint8_t *output = job->output + index * job->task_capacity_bytes;
    uint64_t first = job->first + index * job->task_points;
    const uint64_t end = first + job->task_points < job->end ? first + job->task_points : job->end;
    const uint64_t block = ewa_ply_block_records(job->record_bytes);
    size_t size_bytes = 0;
    while (first < end) {
        const uint64_t count = end - first < block ? end - first : block;
        if (job->ascii) {
            uint8_t records[EWA_PLY_BLOCK_BYTES];
            make_records(job, first, count, records);
            size_bytes += write_lines(job, records, count, (char *)output + size_bytes);
        } else {
            make_records(job, first, count, output + size_bytes);
            size_bytes += count * job->record_bytes;
        }
        first += count;
    }
    job->output_bytes[index] = size_bytes;
}

/// The share of all points that is written.
static double progress_of(const write_job *job) {
    const uint64_t all = job->target->point_count, done = job->put_count - job->point_count + job->end;
    return all == EWA_POINTS_UNKNOWN ? 0 : (double)done / (double)all;
}

/// Writes the points of the piece.
static ewa_status write_body(write_job *job, ewa_writer *writer) {
    ewa_context *context = job->target->context;
    const size_t point_bytes =
        job->ascii ? (size_t)job->property_count * ASCII_NUMBER_BYTES : job->record_bytes;
    job->task_points = TASK_BYTES / point_bytes > 1 ? TASK_BYTES / point_bytes : 1;
    job->task_capacity_bytes = job->task_points * point_bytes;
    const uint32_t wave = WAVE_TASKS_PER_WORKER * ewa_context_worker_count(context);
    job->output = ewa_allocate(context, wave, job->task_capacity_bytes);
    job->output_bytes = ewa_allocate(context, wave, sizeof *job->output_bytes);
    job->first = 0;
    ewa_status status = job->output && job->output_bytes ? EWA_OK : EWA_ERROR_MEMORY;
    while (status == EWA_OK && job->first < job->point_count) {
        const uint64_t left = job->point_count - job->first, maximum = wave * job->task_points;
        const uint64_t count = left < maximum ? left : maximum;
        const uint32_t tasks = (uint32_t)((count + job->task_points - 1) / job->task_points);
        job->end = job->first + count;
        ewa_parallel(context, make_output, job, tasks);
        for (uint32_t i = 0; i < tasks && status == EWA_OK; i++)
            status = ewa_writer_put(writer, job->output + i * job->task_capacity_bytes, job->output_bytes[i]);
        job->first = job->end;
        if (status == EWA_OK) status = ewa_progress(context, "write", progress_of(job));
    }
    ewa_release(context, job->output_bytes, wave, sizeof *job->output_bytes);
    ewa_release(context, job->output, wave, job->task_capacity_bytes);
    return status;
}

/// Lays the attributes out in records and checks that every property has a name of its own.
static ewa_status lay_out(write_job *job) {
    ewa_context *context = job->target->context;
    const char *file_name = job->target->name;
    char(*names)[EWA_PLY_NAME_BYTES] = ewa_allocate(context, EWA_PLY_MAX_PROPERTIES, sizeof *names);
    if (!names) return EWA_ERROR_MEMORY;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < job->field_count && status == EWA_OK; i++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(job->target->prototype, i);
        const bool shifted = job->shifted && strcmp(attribute->name, EWA_POSITION) == 0;
        field *f = &job->fields[i];
        *f = (field){shifted ? EWA_F64 : attribute->type, attribute->component_count, job->record_bytes};
        job->record_bytes += attribute->component_count * (uint32_t)ewa_type_bytes(f->type);
        for (uint32_t c = 0; c < attribute->component_count && status == EWA_OK; c++) {
            if (job->property_count == EWA_PLY_MAX_PROPERTIES) {
                status = ewa_fail(context, EWA_ERROR_LIMIT, "%s: more than %d properties", file_name,
                                  EWA_PLY_MAX_PROPERTIES);
                break;
            }
            char *name = names[job->property_count++];
            ewa_ply_property_name(attribute, c, name);
            for (uint32_t k = 0; k + 1 < job->property_count; k++)
                if (strcmp(names[k], name) == 0)
                    status = ewa_fail(context, EWA_ERROR_ARGUMENT,
                                      "%s: two attributes would become property '%s'", file_name, name);
        }
    }
    ewa_release(context, names, EWA_PLY_MAX_PROPERTIES, sizeof *names);
    return status;
}

/// Writes the head of the vertices; a count that comes later has room for every one.
static ewa_status write_vertex_header(write_job *job, ewa_writer *writer) {
    char line[256];
    const bool known = job->target->point_count != EWA_POINTS_UNKNOWN;
    ewa_status status = ewa_writer_put(writer, "element vertex ", 15);
    job->count_at = ewa_writer_size(writer);
    int length = known ? snprintf(line, sizeof line, "%llu\n", (unsigned long long)job->target->point_count)
                       : snprintf(line, sizeof line, "%-*s\n", COUNT_DIGITS, "0");
    if (status == EWA_OK) status = ewa_writer_put(writer, line, (size_t)length);
    for (uint32_t i = 0; i < job->field_count; i++) {
        const field *f = &job->fields[i];
        for (uint32_t c = 0; c < f->component_count && status == EWA_OK; c++) {
            char name[EWA_PLY_NAME_BYTES];
            ewa_ply_property_name(ewa_cloud_attribute_at(job->target->prototype, i), c, name);
            length = snprintf(line, sizeof line, "property %s %s\n", ewa_type_name(f->type), name);
            status = ewa_writer_put(writer, line, (size_t)length);
        }
    }
    return status;
}

/// Whether a table of the elements, which may be NULL, is to be written with the vertices.
static bool is_other(const ewa_elements *elements, uint32_t table) {
    return elements && elements->tables[table].element != ewa_ply_vertices(elements->header);
}

/// Writes the header: the vertices where they are among the other elements, which may be NULL.
static ewa_status write_header(write_job *job, const ewa_elements *elements, ewa_writer *writer) {
    static const char *const formats[] = {"binary_little_endian", "binary_big_endian", "ascii"};
    char line[64];
    const int length =
        snprintf(line, sizeof line, "ply\nformat %s 1.0\n", formats[job->target->options->ply_encoding]);
    EWA_TRY(ewa_writer_put(writer, line, (size_t)length));
    if (elements) EWA_TRY(ewa_ply_write_comments(elements, writer));
    const uint32_t count = elements ? elements->table_count : 1;
    for (uint32_t i = 0; i < count; i++)
        EWA_TRY(is_other(elements, i) ? ewa_ply_write_element_header(elements, i, writer)
                                      : write_vertex_header(job, writer));
    return ewa_writer_put(writer, "end_header\n", 11);
}

/// Writes the other elements that stand before the vertices, or behind them.
static ewa_status write_others(const write_job *job, bool behind) {
    const ewa_elements *elements = job->target->options->elements;
    bool passed = false;
    for (uint32_t i = 0; elements && i < elements->table_count; i++) {
        const bool other = is_other(elements, i);
        if (other && passed == behind)
            EWA_TRY(
                ewa_ply_write_element(elements, i, job->target->options->ply_encoding, job->target->writer));
        passed |= !other;
    }
    return EWA_OK;
}

static void close_job(void *state) {
    write_job *job = state;
    if (!job) return;
    ewa_context *context = job->target->context;
    ewa_release(context, job->fields, job->field_count, sizeof *job->fields);
    ewa_release(context, job, 1, sizeof *job);
}

static ewa_status open_job(const ewa_cloud_target *target, void **state) {
    ewa_context *context = target->context;
    const ewa_ply_encoding encoding = target->options->ply_encoding;
    write_job *job = ewa_allocate_zeroed(context, 1, sizeof *job);
    if (!job) return EWA_ERROR_MEMORY;
    job->target = target;
    job->field_count = ewa_cloud_attribute_count(target->prototype);
    job->ascii = encoding == EWA_PLY_ASCII;
    job->swap =
        !job->ascii && (encoding == EWA_PLY_BINARY_BIG_ENDIAN) != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
    ewa_cloud_grid(target->prototype, &job->grid);
    ewa_cloud_origin(target->prototype, job->origin_world);
    for (int c = 0; c < 3; c++) job->shifted |= job->origin_world[c] != 0 || job->grid.step_world[c] > 0;
    job->fields = ewa_allocate(context, job->field_count, sizeof *job->fields);
    ewa_status status = job->fields ? lay_out(job) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = write_header(job, target->options->elements, target->writer);
    if (status == EWA_OK) status = write_others(job, false);
    if (status == EWA_OK)
        *state = job;
    else
        close_job(job);
    return status;
}

static ewa_status put_piece(void *state, const ewa_cloud *piece) {
    write_job *job = state;
    job->cloud = piece;
    job->point_count = ewa_cloud_point_count(piece);
    job->put_count += job->point_count;
    return write_body(job, job->target->writer);
}

static ewa_status finish_job(void *state) {
    write_job *job = state;
    const ewa_cloud_target *target = job->target;
    EWA_TRY(write_others(job, true));
    if (target->point_count != EWA_POINTS_UNKNOWN) return EWA_OK;
    char digits[COUNT_DIGITS + 1];
    const int length = snprintf(digits, sizeof digits, "%llu", (unsigned long long)job->put_count);
    return ewa_writer_patch(target->writer, job->count_at, digits, (size_t)length);
}

const ewa_cloud_write_format ewa_write_ply = {
    .suffixes = ".ply", .open = open_job, .put = put_piece, .finish = finish_job, .close = close_job};
