// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a PLY file to a cloud: the header says what the vertices are made of, limits are checked, the cloud
// gets its streams, and the body fills them.
#include "base/base.h"
#include "io/cloud/format.h"
#include "io/cloud/ply.h"
#include "io/number.h"
#include "io/reader.h"

#include <string.h>

const ewa_ply_element *ewa_ply_vertices(const ewa_ply_header *header) {
    for (uint32_t i = 0; i < header->element_count; i++)
        if (header->elements[i].name.length == 6 && memcmp(header->elements[i].name.chars, "vertex", 6) == 0)
            return &header->elements[i];
    return NULL;
}

ewa_status ewa_ply_check_size(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t at) {
    const bool ascii = header->encoding == EWA_PLY_ASCII;
    const uint64_t left = source->size_bytes - at, min_bytes = element->min_bytes;
    // The last number of an ascii file needs no blank after it.
    const uint64_t room = ascii ? left + 1 : left;
    if (min_bytes == 0 || element->count <= room / min_bytes) return EWA_OK;
    uint64_t wanted;
    if (__builtin_mul_overflow(element->count, min_bytes, &wanted)) wanted = UINT64_MAX;
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(source->context, EWA_ERROR_FORMAT,
                    "%s: the file ends in %s %llu of %llu or before: %s%llu bytes wanted from byte %llu on, "
                    "%llu are there, "
                    "%llu are missing",
                    source->name, ewa_quote(element->name, quote), (unsigned long long)(room / min_bytes),
                    (unsigned long long)element->count, ascii || element->list_count ? "at least " : "",
                    (unsigned long long)wanted, (unsigned long long)at, (unsigned long long)left,
                    (unsigned long long)(wanted - left));
}

static ewa_status skip_element(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, uint64_t *at) {
    EWA_TRY(ewa_ply_check_size(source, header, element, *at));
    return header->encoding == EWA_PLY_ASCII ? ewa_ply_ascii_skip(source, header, element, at)
                                             : ewa_ply_binary_skip(source, header, element, at);
}

/// Says what follows the vertices: nothing that the points need, but perhaps a sign of a damaged file.
static void inspect_rest(const ewa_ply_source *source, const ewa_ply_header *header,
                         const ewa_ply_element *vertices, uint64_t at) {
    uint64_t left = source->size_bytes - at;
    bool exact = header->encoding != EWA_PLY_ASCII;
    const ewa_ply_element *end = &header->elements[header->element_count];
    for (const ewa_ply_element *element = vertices + 1; element < end; element++) {
        uint64_t min_bytes;
        // The last number of an ascii file needs no blank after it.
        if (__builtin_mul_overflow(element->count, element->min_bytes, &min_bytes) || min_bytes > left + 1) {
            char quote[EWA_QUOTE_BYTES];
            ewa_report(source->context, EWA_SEVERITY_WARNING,
                       "%s: the file ends within %llu records of %s; the vertices before them are whole",
                       source->name, (unsigned long long)element->count, ewa_quote(element->name, quote));
            return;
        }
        exact = exact && element->list_count == 0;
        left -= min_bytes < left ? min_bytes : left;
    }
    if (exact && left)
        ewa_report(source->context, EWA_SEVERITY_INFO, "%s: %llu bytes follow the last element", source->name,
                   (unsigned long long)left);
}

/// Gives the sink one move for each run of components of a column that lie side by side.
static void add_streams(const ewa_ply_column *column, bool swap, const ewa_cloud_sink *to,
                        ewa_ply_sink *sink) {
    const size_t number_bytes = ewa_type_bytes(column->type);
    for (uint32_t c = 0; c < column->component_count && to->to;) {
        const ewa_ply_property *first = column->sources[c];
        uint32_t run = 1;
        for (; c + run < column->component_count; run++) {
            const ewa_ply_property *next = column->sources[c + run];
            if (next->type != first->type ||
                next->offset_bytes != first->offset_bytes + run * (uint32_t)ewa_type_bytes(first->type))
                break;
        }
        sink->streams[sink->stream_count++] = (ewa_ply_stream){
            .move = {.from_type = first->type, .to_type = column->type, .component_count = run, .swap = swap},
            .from_offset_bytes = first->offset_bytes,
            .to = to->to + c * number_bytes,
            .to_stride_bytes = to->stride_bytes};
        c += run;
    }
}

ewa_status ewa_ply_points_open(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *vertices, uint64_t at, ewa_ply_points *points) {
    *points = (ewa_ply_points){.source = source, .header = header, .element = *vertices, .at = at};
    points->column_capacity = vertices->property_count + (size_t)1; // one more to try a group in
    points->columns = ewa_allocate(source->context, points->column_capacity, sizeof *points->columns);
    points->streams = ewa_allocate(source->context, points->column_capacity, sizeof *points->streams);
    ewa_status status = points->columns && points->streams ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK)
        status = ewa_ply_columns_map(source, header, vertices, points->columns, &points->column_count);
    if (status == EWA_OK) status = ewa_ply_check_size(source, header, vertices, at);
    if (status != EWA_OK) ewa_ply_points_close(points);
    return status;
}

void ewa_ply_points_close(ewa_ply_points *points) {
    if (!points->source) return;
    ewa_context *context = points->source->context;
    ewa_release(context, points->columns, points->column_capacity, sizeof *points->columns);
    ewa_release(context, points->streams, points->column_capacity, sizeof *points->streams);
    *points = (ewa_ply_points){.source = NULL};
}

ewa_status ewa_ply_points_add(const ewa_ply_points *points, ewa_cloud *cloud) {
    for (uint32_t i = 0; i < points->column_count; i++)
        EWA_TRY(ewa_cloud_add(cloud, points->columns[i].attribute, points->columns[i].type,
                              points->columns[i].component_count, NULL));
    return EWA_OK;
}

ewa_status ewa_ply_points_read(ewa_ply_points *points, uint64_t maximum, const ewa_cloud_sink *sinks,
                               uint64_t *got_count) {
    ewa_ply_sink sink = {.streams = points->streams, .stream_capacity = (uint32_t)points->column_capacity};
    for (uint32_t i = 0; i < points->column_count; i++)
        add_streams(&points->columns[i], ewa_ply_is_swapped(points->header), &sinks[i], &sink);
    ewa_ply_element piece = points->element;
    const uint64_t left = points->element.count - points->read_count;
    piece.count = left < maximum ? left : maximum;
    piece.before_count = points->read_count;
    piece.after_count = left - piece.count;
    *got_count = 0;
    if (piece.count == 0) return EWA_OK;
    EWA_TRY(points->header->encoding == EWA_PLY_ASCII
                ? ewa_ply_ascii_read(points->source, points->header, &piece, &sink, &points->at)
                : ewa_ply_binary_read(points->source, points->header, &piece, &sink, &points->at));
    points->read_count += piece.count;
    *got_count = piece.count;
    return EWA_OK;
}

ewa_status ewa_ply_read_vertices(const ewa_ply_source *source, const ewa_ply_header *header,
                                 const ewa_ply_element *vertices, uint64_t *at, ewa_cloud **cloud) {
    ewa_ply_points points;
    ewa_cloud *prototype = NULL, *made = NULL;
    EWA_TRY(ewa_ply_points_open(source, header, vertices, *at, &points));
    ewa_cloud_sink *sinks = ewa_allocate(source->context, points.column_count, sizeof *sinks);
    ewa_status status = sinks ? ewa_cloud_create(source->context, 0, &prototype) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_ply_points_add(&points, prototype);
    if (status == EWA_OK)
        status = ewa_cloud_make_room(source->name, prototype, NULL, vertices->count, &made, sinks);
    uint64_t got_count;
    if (status == EWA_OK) status = ewa_ply_points_read(&points, vertices->count, sinks, &got_count);
    *at = points.at;
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    ewa_cloud_destroy(&prototype);
    ewa_release(source->context, sinks, points.column_count, sizeof *sinks);
    ewa_ply_points_close(&points);
    *cloud = made;
    return status;
}

// ---- the vertices of a file, piece by piece --------------------------------------------------------------

typedef struct ply_state {
    ewa_ply_source source;
    const ewa_cloud_source *file;
    ewa_ply_header *header;
    const ewa_ply_element *vertices;
    ewa_ply_points points;
} ply_state;

static bool probe(const char *name, const uint8_t *bytes, uint64_t size_bytes) {
    (void)name;
    return ewa_bytes_begin(bytes, size_bytes, "ply");
}

static void close_ply(void *state) {
    ply_state *old = state;
    if (!old) return;
    ewa_context *context = old->source.context;
    ewa_ply_points_close(&old->points);
    ewa_release(context, old->header, 1, sizeof *old->header);
    ewa_release(context, old, 1, sizeof *old);
}

/// Reads the header and steps over what stands before the vertices.
static ewa_status open_vertices(ply_state *state) {
    const ewa_ply_source *source = &state->source;
    EWA_TRY(ewa_ply_header_read(source, state->header));
    const ewa_ply_header *header = state->header;
    state->vertices = ewa_ply_vertices(header);
    if (!state->vertices)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the header has no element 'vertex'",
                        source->name);
    uint64_t at = header->body_at;
    for (const ewa_ply_element *element = header->elements; element < state->vertices; element++)
        EWA_TRY(skip_element(source, header, element, &at));
    return ewa_ply_points_open(source, header, state->vertices, at, &state->points);
}

static ewa_status note_faces(const ewa_ply_header *header, ewa_cloud *prototype) {
    const uint64_t count = ewa_ply_count_faces(header);
    char digits[EWA_NUMBER_BYTES];
    return count ? ewa_cloud_set_note(prototype, "file.faces", digits,
                                      ewa_number_write_i64((int64_t)count, digits))
                 : EWA_OK;
}

static ewa_status open_ply(const ewa_cloud_source *file, ewa_cloud *prototype, uint64_t *point_count,
                           void **state) {
    ply_state *made = ewa_allocate_zeroed(file->context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->source = (ewa_ply_source){file->context, file->name, file->bytes, file->size_bytes};
    made->file = file;
    made->header = ewa_allocate(file->context, 1, sizeof *made->header);
    ewa_status status = made->header ? open_vertices(made) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_ply_points_add(&made->points, prototype);
    if (status == EWA_OK) status = note_faces(made->header, prototype);
    if (status == EWA_OK) {
        *point_count = made->vertices->count;
        *state = made;
    } else {
        close_ply(made);
    }
    return status;
}

static ewa_status read_ply(void *state, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count) {
    ply_state *own = state;
    EWA_TRY(ewa_ply_points_read(&own->points, maximum, sinks, got_count));
    ewa_cloud_passed(own->file, own->points.at);
    if (own->points.read_count == own->vertices->count && (*got_count || own->vertices->count == 0))
        inspect_rest(&own->source, own->header, own->vertices, own->points.at);
    return EWA_OK;
}

const ewa_cloud_format ewa_format_ply = {EWA_MODEL_PLY, probe, open_ply, read_ply, close_ply};
