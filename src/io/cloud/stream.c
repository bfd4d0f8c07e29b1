// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds in and out piece by piece, whatever their format.
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/decimals.h"
#include "io/cloud/format.h"
#include "io/file.h"

#include <math.h>
#include <string.h>
#include <strings.h>

struct ewa_cloud_reader {
    ewa_cloud_source source;
    ewa_cloud_load_options options;
    char *path, *attributes, *columns; // copies
    ewa_file file;
    const ewa_cloud_format *format;
    void *state;
    ewa_cloud *prototype; // of what is wanted
    ewa_cloud *whole;     // prototype of all that the format has
    ewa_cloud_sink *sinks;
    uint64_t max_points, read_count, lost_count;
    bool ended;
};

static char *copy_text(ewa_context *context, const char *text, ewa_status *status) {
    if (!text || *status != EWA_OK) return NULL;
    const size_t bytes = strlen(text) + 1;
    char *copy = ewa_allocate(context, bytes, 1);
    if (copy)
        memcpy(copy, text, bytes);
    else
        *status = EWA_ERROR_MEMORY;
    return copy;
}

static void free_text(ewa_context *context, char *text) {
    if (text) ewa_release(context, text, strlen(text) + 1, 1);
}

/// Opens the points of a source and makes the sinks for them.
static ewa_status open_points(ewa_cloud_reader *reader) {
    ewa_context *context = reader->source.context;
    EWA_TRY(ewa_cloud_create(context, 0, &reader->whole));
    EWA_TRY(reader->format->open(&reader->source, reader->whole, &reader->max_points, &reader->state));
    reader->sinks = ewa_allocate(context, ewa_cloud_attribute_count(reader->whole), sizeof *reader->sinks);
    if (!reader->sinks) return EWA_ERROR_MEMORY;
    return ewa_cloud_make_room(reader->source.name, reader->whole, reader->options.attributes, 0,
                               &reader->prototype, reader->sinks);
}

static void close_points(ewa_cloud_reader *reader) {
    ewa_context *context = reader->source.context;
    if (reader->state) reader->format->close(reader->state);
    if (reader->sinks)
        ewa_release(context, reader->sinks, ewa_cloud_attribute_count(reader->whole), sizeof *reader->sinks);
    ewa_cloud_destroy(&reader->prototype);
    ewa_cloud_destroy(&reader->whole);
}

/// Reads up to `max_points` points into a cloud; NULL at the end.
static ewa_status read_points(ewa_cloud_reader *reader, uint64_t max_points, ewa_cloud **piece) {
    const uint64_t left = reader->max_points - reader->read_count;
    const uint64_t room = left < max_points ? left : max_points;
    const uint32_t attribute_count = ewa_cloud_attribute_count(reader->whole);
    uint64_t count = 0;
    ewa_cloud *made = NULL;
    ewa_status status = ewa_cloud_make_room(reader->source.name, reader->whole, reader->options.attributes,
                                            room, &made, reader->sinks);
    while (status == EWA_OK && count < room) {
        uint64_t got_count = 0;
        // Such as read_ply().
        status = reader->format->read(reader->state, room - count, reader->sinks, &got_count);
        if (got_count == 0) break;
        count += got_count;
        for (uint32_t i = 0; i < attribute_count; i++)
            if (reader->sinks[i].to) reader->sinks[i].to += got_count * reader->sinks[i].stride_bytes;
    }
    if (status != EWA_OK) {
        ewa_cloud_destroy(&made);
        return status;
    }
    reader->read_count += count;
    ewa_cloud_truncate(made, count);
    *piece = made;
    return EWA_OK;
}

void ewa_cloud_settle(ewa_cloud *cloud) {
    enum { FAR_WORLD = 10000, UNIT_WORLD = 1000 };
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    ewa_coordinate_grid grid;
    double origin_world[3];
    ewa_cloud_grid(cloud, &grid);
    ewa_cloud_origin(cloud, origin_world);
    if (!position || position->type != EWA_F64 || position->component_count != 3) return;
    const uint64_t count = ewa_cloud_point_count(cloud);
    double *numbers = position->data;
    for (int c = 0; c < 3; c++) {
        if (grid.step_world[c] > 0 || origin_world[c] != 0 || count == 0) continue;
        const double base_world = floor(numbers[c] / UNIT_WORLD) * UNIT_WORLD;
        if (!(fabs(base_world) >= FAR_WORLD)) continue;
        const double parts = ewa_decimals_find(numbers + c, count, 3);
        if (parts == 0) continue;
        for (uint64_t i = 0; i < count; i++)
            numbers[3 * i + (uint64_t)c] =
                ewa_decimals_subtract(numbers[3 * i + (uint64_t)c], base_world, parts);
        origin_world[c] = base_world;
        grid.step_world[c] = 1 / parts;
        grid.offset_world[c] = 0;
    }
    ewa_cloud_set_origin(cloud, origin_world);
    ewa_cloud_set_grid(cloud, &grid);
}

ewa_status ewa_cloud_read_all(const ewa_cloud_source *source, const ewa_cloud_format *format,
                              ewa_cloud **cloud) {
    ewa_cloud_reader reader = {.source = *source, .options = *source->options, .format = format};
    reader.source.mapped = false; // pages that stay are read again at no cost
    *cloud = NULL;
    ewa_status status = open_points(&reader);
    if (status == EWA_OK) status = read_points(&reader, UINT64_MAX, cloud);
    close_points(&reader);
    return status;
}

static ewa_status open_reader(ewa_cloud_reader *reader, ewa_context *context, const char *path,
                              const ewa_cloud_load_options *options) {
    ewa_cloud_load_options_init(&reader->options, sizeof reader->options);
    ewa_status status = ewa_options_take(context, &ewa_cloud_load_options_table, options, &reader->options);
    reader->path = copy_text(context, path, &status);
    reader->options.attributes = reader->attributes = copy_text(context, reader->options.attributes, &status);
    reader->options.columns = reader->columns = copy_text(context, reader->options.columns, &status);
    if (status == EWA_OK) status = ewa_file_map(context, path, &reader->file);
    EWA_TRY(status);
    const bool stream = strcmp(path, "-") == 0;
    reader->source = (ewa_cloud_source){.context = context,
                                        .name = stream ? "standard input" : reader->path,
                                        .path = stream ? NULL : reader->path,
                                        .bytes = reader->file.bytes,
                                        .size_bytes = reader->file.size_bytes,
                                        .options = &reader->options,
                                        .lost_count = &reader->lost_count,
                                        .mapped = reader->file.mapped};
    reader->format = ewa_cloud_format_of(reader->source.name, reader->source.bytes, reader->source.size_bytes,
                                         EWA_PROBE_ALL, &reader->options);
    if (!reader->format)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: no file of points of a known format",
                        reader->source.name);
    return open_points(reader);
}

ewa_status ewa_cloud_reader_open(ewa_context *context, const char *path,
                                 const ewa_cloud_load_options *options, ewa_cloud_reader **reader) {
    if (!context || !path || !reader) return EWA_ERROR_ARGUMENT;
    *reader = NULL;
    ewa_cloud_reader *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->source.context = context;
    const ewa_status status = open_reader(made, context, path, options);
    if (status == EWA_OK)
        *reader = made;
    else
        ewa_cloud_reader_close(&made);
    return status;
}

const ewa_cloud *ewa_cloud_reader_prototype(const ewa_cloud_reader *reader) { return reader->prototype; }
uint64_t ewa_cloud_reader_maximum_points(const ewa_cloud_reader *reader) { return reader->max_points; }
uint64_t ewa_cloud_reader_lost_count(const ewa_cloud_reader *reader) { return reader->lost_count; }

ewa_status ewa_cloud_reader_next(ewa_cloud_reader *reader, uint64_t max_points, ewa_cloud **piece) {
    if (!reader || !piece || max_points == 0) return EWA_ERROR_ARGUMENT;
    *piece = NULL;
    if (reader->ended || reader->read_count == reader->max_points) return EWA_OK;
    const ewa_status status = read_points(reader, max_points, piece);
    reader->ended = status != EWA_OK || ewa_cloud_point_count(*piece) == 0;
    if (reader->ended) ewa_cloud_destroy(piece);
    return status;
}

void ewa_cloud_reader_close(ewa_cloud_reader **reader) {
    if (!reader || !*reader) return;
    ewa_cloud_reader *old = *reader;
    ewa_context *context = old->source.context;
    close_points(old);
    ewa_file_unmap(context, &old->file);
    free_text(context, old->path);
    free_text(context, old->attributes);
    free_text(context, old->columns);
    ewa_release(context, old, 1, sizeof *old);
    *reader = NULL;
}

struct ewa_cloud_writer {
    ewa_cloud_target target;
    ewa_cloud_save_options options;
    ewa_bounds bounds;
    ewa_cloud *prototype;
    char *name;
    const ewa_cloud_write_format *format;
    void *state;
    uint64_t put_count;
};

/// Finds the format of a path and looks whether it can be written to what is known.
static ewa_status choose_format(ewa_cloud_writer *writer, const char *path) {
    const ewa_cloud_target *target = &writer->target;
    writer->format = ewa_cloud_write_format_of(path);
    static const char octree[] = ".copc.laz";
    const size_t length = strlen(path);
    if (length >= sizeof octree - 1 && strcasecmp(path + length - (sizeof octree - 1), octree) == 0)
        return ewa_fail(target->context, EWA_ERROR_UNSUPPORTED,
                        "%s: a file of that name is an octree (COPC), which ewa_lod_build() makes", path);
    if (!writer->format)
        return ewa_fail(target->context, EWA_ERROR_UNSUPPORTED,
                        "%s: point clouds are written as " EWA_CLOUD_SUFFIXES, path);
    const ewa_attribute *position = ewa_cloud_find(target->prototype, EWA_POSITION);
    if (!position || position->component_count != 3)
        return ewa_fail(target->context, EWA_ERROR_ARGUMENT,
                        "%s: a cloud without positions of three components cannot be written", path);
    if (writer->options.elements && writer->format != &ewa_write_ply)
        return ewa_fail(target->context, EWA_ERROR_UNSUPPORTED, "%s: faces are written as .ply", path);
    return EWA_OK;
}

static ewa_status open_writer(ewa_cloud_writer *writer, const char *path,
                              const ewa_cloud_save_options *options, const ewa_cloud *prototype) {
    ewa_context *context = writer->target.context;
    ewa_cloud_save_options_init(&writer->options, sizeof writer->options);
    ewa_status status = ewa_options_take(context, &ewa_cloud_save_options_table, options, &writer->options);
    writer->name = copy_text(context, strcmp(path, "-") == 0 ? "standard output" : path, &status);
    if (status == EWA_OK) status = ewa_cloud_like(prototype, &writer->prototype);
    EWA_TRY(status);
    writer->target.name = writer->name;
    writer->target.options = &writer->options;
    writer->target.prototype = writer->prototype;
    EWA_TRY(choose_format(writer, path));
    EWA_TRY(ewa_writer_open(context, path, &writer->target.writer));
    if (writer->target.point_count == EWA_POINTS_UNKNOWN && !ewa_writer_can_patch(writer->target.writer))
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: the number of points comes before them and is not known", writer->name);
    return writer->format->open(&writer->target, &writer->state);
}

bool ewa_cloud_writer_needs_bounds(const char *path, const ewa_cloud *prototype) {
    if (!path || !prototype) return false;
    const ewa_cloud_write_format *format = ewa_cloud_write_format_of(path);
    ewa_coordinate_grid grid;
    ewa_cloud_grid(prototype, &grid);
    double origin_world[3];
    ewa_cloud_origin(prototype, origin_world);
    // The grid can stay as it is when what is about the origin has numbers far below 2^31.
    bool has_grid = true;
    for (int c = 0; c < 3; c++)
        has_grid &= grid.step_world[c] > 0 &&
                    fabs(origin_world[c] - grid.offset_world[c]) < 0x1p30 * grid.step_world[c];
    return format && format->needs_bounds && !has_grid;
}

ewa_status ewa_cloud_writer_open(ewa_context *context, const char *path,
                                 const ewa_cloud_save_options *options, const ewa_cloud *prototype,
                                 uint64_t point_count, const ewa_bounds *bounds, ewa_cloud_writer **writer) {
    if (!context || !path || !prototype || !writer) return EWA_ERROR_ARGUMENT;
    *writer = NULL;
    ewa_cloud_writer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    if (bounds) made->bounds = *bounds;
    made->target = (ewa_cloud_target){
        .context = context, .point_count = point_count, .bounds = bounds ? &made->bounds : NULL};
    const ewa_status status = open_writer(made, path, options, prototype);
    if (status == EWA_OK)
        *writer = made;
    else
        ewa_cloud_writer_abort(&made);
    return status;
}

ewa_status ewa_cloud_writer_put(ewa_cloud_writer *writer, const ewa_cloud *piece) {
    if (!writer || !piece) return EWA_ERROR_ARGUMENT;
    if (!ewa_cloud_is_alike(piece, writer->prototype))
        return ewa_fail(writer->target.context, EWA_ERROR_ARGUMENT,
                        "%s: a piece has other attributes than the file", writer->name);
    writer->put_count += ewa_cloud_point_count(piece);
    if (writer->put_count > writer->target.point_count)
        return ewa_fail(writer->target.context, EWA_ERROR_ARGUMENT,
                        "%s: %llu points came, %llu were announced", writer->name,
                        (unsigned long long)writer->put_count,
                        (unsigned long long)writer->target.point_count);
    return writer->format->put(writer->state, piece);
}

ewa_status ewa_cloud_writer_commit(ewa_cloud_writer **writer) {
    if (!writer || !*writer) return EWA_ERROR_ARGUMENT;
    ewa_cloud_writer *done = *writer;
    const uint64_t announced = done->target.point_count;
    ewa_status status = EWA_OK;
    if (announced != EWA_POINTS_UNKNOWN && announced != done->put_count)
        status =
            ewa_fail(done->target.context, EWA_ERROR_ARGUMENT, "%s: %llu points came, %llu were announced",
                     done->name, (unsigned long long)done->put_count, (unsigned long long)announced);
    if (status == EWA_OK) status = done->format->finish(done->state);
    if (status == EWA_OK) status = ewa_writer_commit(&done->target.writer);
    ewa_cloud_writer_abort(writer);
    return status;
}

void ewa_cloud_writer_abort(ewa_cloud_writer **writer) {
    if (!writer || !*writer) return;
    ewa_cloud_writer *old = *writer;
    ewa_context *context = old->target.context;
    if (old->state) old->format->close(old->state);
    ewa_writer_abort(&old->target.writer);
    ewa_cloud_destroy(&old->prototype);
    free_text(context, old->name);
    ewa_release(context, old, 1, sizeof *old);
    *writer = NULL;
}
