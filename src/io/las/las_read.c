// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Reads LAS and LAZ: the header says what points there are, the bytes say how many can be there, tasks of a
// fixed number of records, or of a chunk, fill the sinks.
#include "base/base.h"
#include "cloud/cloud.h"
#include "io/las/copc.h"
#include "io/las/las.h"
#include "io/las/laz_chunks.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    TASK_POINTS = 1 << 14,
    /// Colours of up to this many points are all looked at; of more, as many in runs spread over the file.
    LOOK_POINTS = 1 << 20,
    LOOK_RUN_POINTS = 1 << 8,
};

typedef struct las_state {
    const ewa_cloud_source *source;
    ewa_las_header header;
    ewa_las_table table;
    uint64_t point_count, next_point; ///< of files without compression
    uint64_t above_count;             ///< colours that are more than their type holds
    ewa_laz_layout layout;
    ewa_laz_stream *stream; ///< NULL: not compressed
} las_state;

/// What the colours of a file have been so far.
typedef struct color_look {
    const ewa_las_column *color;
    uint32_t record_bytes;
    uint32_t any;          ///< bits that are set in one of them
    bool doubled, is_wide; ///< all have two equal bytes; one is neither that nor below 256
} color_look;

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return size_bytes >= 4 && memcmp(bytes, "LASF", 4) == 0;
}

static void look_at_colors(void *user, const uint8_t *records, uint64_t count) {
    color_look *look = user;
    for (uint64_t i = 0; i < count && !look->is_wide; i++, records += look->record_bytes) {
        for (uint32_t c = 0; c < look->color->component_count; c++) {
            const uint16_t value = ewa_las_u16(records + look->color->at_bytes[c]);
            look->any |= value;
            look->doubled = look->doubled && value >> 8 == (value & 255);
        }
        look->is_wide = look->any > 255 && !look->doubled;
    }
}

/// Chooses the type of the colours for all points alike: many files hold 8-bit colours in their 16 bits,
/// either as they are or with the byte twice. Colours that are all 0 are none.
static ewa_status choose_colors(las_state *state) {
    ewa_las_table *table = &state->table;
    if (table->color_at == table->column_count) return EWA_OK;
    ewa_las_column *color = &table->columns[table->color_at];
    color_look look = {.color = color, .record_bytes = table->record_bytes, .doubled = true};
    bool is_all = state->point_count <= LOOK_POINTS;
    if (state->stream) {
        const ewa_status status = ewa_laz_stream_sample(state->stream, look_at_colors, &look, &is_all);
        if (status != EWA_OK) return status;
    } else {
        const uint8_t *records = state->source->bytes + state->header.points_at;
        const uint32_t runs = is_all ? 1 : LOOK_POINTS / LOOK_RUN_POINTS;
        for (uint32_t i = 0; i < runs && !look.is_wide; i++)
            look_at_colors(&look, records + ewa_split(state->point_count, runs, i) * table->record_bytes,
                           is_all ? state->point_count : LOOK_RUN_POINTS);
    }
    if (look.is_wide) return EWA_OK;
    color->type = EWA_U8;
    table->color_shift = look.any > 255 ? 8 : 0;
    if (look.any || !is_all || state->point_count + state->layout.point_count == 0) return EWA_OK;
    ewa_report(state->source->context, EWA_SEVERITY_INFO, "%s: its colours are all 0 and are left out",
               state->source->name);
    table->column_count--;
    memmove(color, color + 1, (table->column_count - table->color_at) * sizeof *color);
    table->color_at = table->column_count;
    return EWA_OK;
}

/// Counts the records that are there, which may be fewer than the header says.
static ewa_status count_records(las_state *state) {
    const ewa_cloud_source *source = state->source;
    const ewa_las_header *header = &state->header;
    const uint64_t left = source->size_bytes - header->points_at, there = left / header->record_bytes;
    const uint64_t said = header->point_count;
    state->point_count = said < there ? said : there;
    if (said > there && left == 0) {
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: the header counts %llu points, the file has none", source->name,
                   (unsigned long long)said);
    } else if (said > there) {
        return ewa_cloud_damage(source, said - there,
                                "%s: the file ends in point %llu of %llu: records of %u bytes from byte %llu "
                                "on, %llu bytes are there",
                                source->name, (unsigned long long)there + 1, (unsigned long long)said,
                                header->record_bytes, (unsigned long long)header->points_at,
                                (unsigned long long)left);
    } else if (said == 0 && header->evlr_count == 0 && there && left % header->record_bytes == 0) {
        // Programs that end before their time leave the count that they began with.
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: the header counts no points, %llu are there and are read", source->name,
                   (unsigned long long)there);
        state->point_count = there;
    }
    return EWA_OK;
}

static ewa_status note_compression(const las_state *state, ewa_cloud *prototype) {
    const ewa_laz_layout *layout = &state->layout;
    char text[96];
    snprintf(text, sizeof text, "LASzip %u.%u, %s, %" PRIu64 " chunk%s%s", layout->version_major,
             layout->version_minor,
             layout->packing == EWA_LAZ_POINTWISE ? "pointwise"
             : layout->packing == EWA_LAZ_CHUNKED ? "flat"
                                                  : "layered",
             layout->chunk_count, layout->chunk_count == 1 ? "" : "s",
             layout->variable ? " of their own sizes" : "");
    return ewa_cloud_set_note(prototype, "file.compression", text, strlen(text));
}

static ewa_status open_points(las_state *state, ewa_cloud *prototype) {
    const ewa_cloud_source *source = state->source;
    if (!state->header.compressed) return count_records(state);
    ewa_status status = ewa_laz_layout_read(source, &state->header, &state->layout);
    if (status == EWA_OK) status = note_compression(state, prototype);
    if (status == EWA_OK) status = ewa_copc_note(source, &state->header, prototype);
    return status == EWA_OK ? ewa_laz_stream_open(source, &state->layout, &state->stream) : status;
}

/// Gives the prototype its attributes, origin and grid.
static ewa_status lay_out(const las_state *state, ewa_cloud *prototype) {
    const ewa_las_table *table = &state->table;
    double origin_world[3];
    ewa_coordinate_grid grid;
    for (int c = 0; c < 3; c++) {
        grid.step_world[c] = table->scale[c];
        grid.offset_world[c] = state->header.offset[c];
        origin_world[c] = state->header.offset[c] + (double)table->first[c] * table->scale[c];
    }
    ewa_cloud_set_origin(prototype, origin_world);
    ewa_cloud_set_grid(prototype, &grid);
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < table->column_count && status == EWA_OK; i++) {
        const ewa_las_column *column = &table->columns[i];
        status = ewa_cloud_add(prototype, column->name, column->type, column->component_count, NULL);
    }
    return status;
}

static void close_las(void *data) {
    las_state *state = data;
    if (!state) return;
    ewa_context *context = state->source->context;
    if (state->above_count)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%s: %llu numbers of colours are above 255, which none was of those that were looked at; "
                   "they are read as 255",
                   state->source->name, (unsigned long long)state->above_count);
    ewa_laz_stream_close(state->stream);
    ewa_laz_layout_free(context, &state->layout);
    ewa_release(context, state, 1, sizeof *state);
}

static ewa_status open_las(const ewa_cloud_source *source, ewa_cloud *prototype, uint64_t *point_count,
                           void **state) {
    las_state *made = ewa_allocate_zeroed(source->context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->source = source;
    ewa_status status = ewa_las_header_read(source, &made->header);
    if (status == EWA_OK) status = ewa_las_notes(source, &made->header, prototype);
    if (status == EWA_OK) status = open_points(made, prototype);
    if (status == EWA_OK) ewa_las_table_make(source, &made->header, &made->table);
    if (status == EWA_OK) status = choose_colors(made);
    if (status == EWA_OK) status = lay_out(made, prototype);
    if (status != EWA_OK) {
        close_las(made);
        return status;
    }
    *point_count = made->stream ? made->layout.point_count : made->point_count;
    *state = made;
    return EWA_OK;
}

/// The records of one call, unpacked by tasks.
typedef struct unpack_job {
    const las_state *state;
    const ewa_cloud_sink *sinks;
    const uint8_t *records;
    uint64_t count;
    uint64_t *above_counts; ///< one per task
} unpack_job;

static void unpack_task(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const unpack_job *job = data;
    const ewa_las_table *table = &job->state->table;
    const uint64_t first = (uint64_t)index * TASK_POINTS, left = job->count - first;
    ewa_cloud_sink sinks[EWA_LAS_MAX_COLUMNS];
    for (uint32_t i = 0; i < table->column_count; i++) {
        sinks[i] = job->sinks[i];
        if (sinks[i].to) sinks[i].to += first * sinks[i].stride_bytes;
    }
    job->above_counts[index] = ewa_las_unpack(table, job->records + first * table->record_bytes,
                                              left < TASK_POINTS ? left : TASK_POINTS, sinks);
}

static ewa_status read_plain(las_state *state, uint64_t most, const ewa_cloud_sink *sinks,
                             uint64_t *got_count) {
    ewa_context *context = state->source->context;
    const uint64_t most_at_once = (uint64_t)UINT32_MAX * TASK_POINTS;
    const uint64_t left = state->point_count - state->next_point;
    uint64_t count = left < most ? left : most;
    if (count > most_at_once) count = most_at_once;
    *got_count = count;
    if (count == 0) return EWA_OK;
    const uint64_t at = state->header.points_at + state->next_point * state->table.record_bytes;
    const uint32_t tasks = (uint32_t)((count + TASK_POINTS - 1) / TASK_POINTS);
    unpack_job job = {.state = state, .sinks = sinks, .records = state->source->bytes + at, .count = count};
    job.above_counts = ewa_allocate_zeroed(context, tasks, sizeof *job.above_counts);
    if (!job.above_counts) return EWA_ERROR_MEMORY;
    ewa_parallel(context, unpack_task, &job, tasks);
    for (uint32_t i = 0; i < tasks; i++) state->above_count += job.above_counts[i];
    ewa_release(context, job.above_counts, tasks, sizeof *job.above_counts);
    state->next_point += count;
    ewa_cloud_passed(state->source, at + count * state->table.record_bytes);
    return EWA_OK;
}

static ewa_status read_las(void *data, uint64_t most, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    las_state *state = data;
    if (!state->stream) return read_plain(state, most, sinks, got_count);
    return ewa_laz_stream_read(state->stream, &state->table, most, sinks, got_count, &state->above_count);
}

const ewa_cloud_format ewa_format_las = {
    .format = EWA_MODEL_LAS, .probe = probe, .open = open_las, .read = read_las, .close = close_las};
