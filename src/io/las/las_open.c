// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opens LAS and LAZ: the header says what points there are, the bytes say how many can be there, a look at the
// colours says what type they have.
#include "io/las/las_open.h"
#include "base/base.h"
#include "io/las/copc.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    /// Colours of up to this many points are all looked at; of more, as many in runs spread over the file.
    LOOK_POINTS = 1 << 20,
    LOOK_RUN_POINTS = 1 << 8,
};

bool ewa_las_look(void *user, const uint8_t *records, uint64_t count) {
    ewa_las_color_look *look = user;
    for (uint64_t i = 0; i < count && !look->is_wide; i++, records += look->record_bytes) {
        for (uint32_t c = 0; c < look->color->component_count; c++) {
            const uint16_t value = ewa_las_u16(records + look->color->at_bytes[c]);
            look->any |= value;
            look->is_single = look->is_single || value >> 8 != (value & 255);
        }
        look->is_wide = look->any > 255 && look->is_single;
    }
    return look->is_wide;
}

void ewa_las_colors_choose(const ewa_cloud_source *source, const ewa_las_color_look *look, bool is_all,
                           ewa_las_table *table) {
    ewa_las_column *color = &table->columns[table->color_at];
    if (look->is_wide) return;
    color->type = EWA_U8;
    table->color_shift = look->any > 255 ? 8 : 0;
    if (look->any || !is_all) return;
    ewa_report(source->context, EWA_SEVERITY_INFO, "%s: its colours are all 0 and are left out",
               source->name);
    table->column_count--;
    memmove(color, color + 1, (table->column_count - table->color_at) * sizeof *color);
    table->color_at = table->column_count;
}

/// Looks at the colours and chooses their type, for all points alike.
static ewa_status look_at_colors(ewa_las_file *file) {
    const ewa_las_table *table = &file->table;
    // Parts are read of octrees only, whose points are compressed; who opens them says so of others.
    const bool unread = file->source->ranges && !file->stream;
    if (table->color_at == table->column_count || unread) return EWA_OK;
    ewa_las_color_look look = {.color = &table->columns[table->color_at],
                               .record_bytes = table->record_bytes};
    bool is_all = file->point_count <= LOOK_POINTS;
    if (file->stream) {
        EWA_TRY(ewa_laz_stream_sample(file->stream, ewa_las_look, &look, &is_all));
    } else {
        const uint8_t *records = file->source->bytes + file->header.points_at;
        const uint32_t runs = is_all ? 1 : LOOK_POINTS / LOOK_RUN_POINTS;
        for (uint32_t i = 0; i < runs && !look.is_wide; i++)
            ewa_las_look(&look, records + ewa_split(file->point_count, runs, i) * table->record_bytes,
                         is_all ? file->point_count : LOOK_RUN_POINTS);
    }
    is_all = is_all && file->point_count + file->layout.point_count > 0;
    ewa_las_colors_choose(file->source, &look, is_all, &file->table);
    return EWA_OK;
}

/// Counts the records that are there, which may be fewer than the header says.
static ewa_status count_records(ewa_las_file *file) {
    const ewa_cloud_source *source = file->source;
    const ewa_las_header *header = &file->header;
    const uint64_t left = source->size_bytes - header->points_at, there = left / header->record_bytes;
    const uint64_t said = header->point_count;
    file->point_count = said < there ? said : there;
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
        file->point_count = there;
    }
    return EWA_OK;
}

static ewa_status note_compression(const ewa_las_file *file, ewa_cloud *prototype) {
    const ewa_laz_layout *layout = &file->layout;
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

static ewa_status open_points(ewa_las_file *file, ewa_cloud *prototype) {
    const ewa_cloud_source *source = file->source;
    if (!file->header.compressed) return count_records(file);
    EWA_TRY(ewa_laz_layout_read(source, &file->header, &file->layout));
    EWA_TRY(note_compression(file, prototype));
    EWA_TRY(ewa_copc_note(source, &file->header, prototype));
    return ewa_laz_stream_open(source, &file->layout, &file->stream);
}

ewa_status ewa_las_lay_out(const ewa_las_table *table, const double offset_world[3], ewa_cloud *prototype) {
    double origin_world[3];
    ewa_coordinate_grid grid;
    for (int c = 0; c < 3; c++) {
        grid.step_world[c] = table->scale[c];
        grid.offset_world[c] = offset_world[c];
        origin_world[c] = offset_world[c] + (double)table->first[c] * table->scale[c];
    }
    ewa_cloud_set_origin(prototype, origin_world);
    ewa_cloud_set_grid(prototype, &grid);
    for (uint32_t i = 0; i < table->column_count; i++) {
        const ewa_las_column *column = &table->columns[i];
        EWA_TRY(ewa_cloud_add(prototype, column->name, column->type, column->component_count, NULL));
    }
    return EWA_OK;
}

ewa_status ewa_las_file_open(const ewa_cloud_source *source, ewa_cloud *prototype, ewa_las_file *file) {
    *file = (ewa_las_file){.source = source};
    EWA_TRY(ewa_las_header_read(source, &file->header));
    EWA_TRY(ewa_las_notes(source, &file->header, prototype));
    EWA_TRY(open_points(file, prototype));
    ewa_las_table_make(source, &file->header, &file->table);
    EWA_TRY(look_at_colors(file));
    return ewa_las_lay_out(&file->table, file->header.offset, prototype);
}

void ewa_las_file_close(ewa_las_file *file) {
    ewa_laz_stream_close(file->stream);
    file->stream = NULL;
    if (file->source) ewa_laz_layout_free(file->source->context, &file->layout);
}
