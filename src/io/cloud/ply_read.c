// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a PLY file to a cloud: the header says what the vertices are made of, limits are checked, the cloud
// gets its streams, and the body fills them.
#include "base/base.h"
#include "io/cloud/ply.h"

#include <string.h>

const ewa_ply_element *ewa_ply_vertices(const ewa_ply_header *header) {
    for (uint32_t i = 0; i < header->element_count; i++)
        if (header->elements[i].name.length == 6 && memcmp(header->elements[i].name.chars, "vertex", 6) == 0)
            return &header->elements[i];
    return NULL;
}

static ewa_status check_limits(const ewa_ply_source *source, const ewa_ply_element *vertices,
                               const ewa_ply_column *columns, uint32_t column_count) {
    const ewa_limits *limits = ewa_context_limits(source->context);
    if (vertices->count > limits->max_points)
        return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: %llu points are over the limit of %llu",
                        source->name, (unsigned long long)vertices->count,
                        (unsigned long long)limits->max_points);
    uint64_t point_bytes = 0, total;
    for (uint32_t i = 0; i < column_count; i++)
        point_bytes += columns[i].component_count * ewa_type_bytes(columns[i].type);
    if (__builtin_mul_overflow(point_bytes, vertices->count, &total) || total > limits->max_memory_bytes)
        return ewa_fail(source->context, EWA_ERROR_LIMIT,
                        "%s: %llu points of %llu bytes are over the limit of %llu bytes", source->name,
                        (unsigned long long)vertices->count, (unsigned long long)point_bytes,
                        (unsigned long long)limits->max_memory_bytes);
    return EWA_OK;
}

ewa_status ewa_ply_check_size(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t at) {
    const bool ascii = header->encoding == EWA_PLY_ASCII;
    const uint64_t left = source->size_bytes - at, least_bytes = element->least_bytes;
    // The last number of an ascii file needs no blank after it.
    const uint64_t room = ascii ? left + 1 : left;
    if (least_bytes == 0 || element->count <= room / least_bytes) return EWA_OK;
    uint64_t wanted;
    if (__builtin_mul_overflow(element->count, least_bytes, &wanted)) wanted = UINT64_MAX;
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(source->context, EWA_ERROR_FORMAT,
                    "%s: the file ends in %s %llu of %llu or before: %s%llu bytes wanted from byte %llu on, "
                    "%llu are there, "
                    "%llu are missing",
                    source->name, ewa_quote(element->name, quote), (unsigned long long)(room / least_bytes),
                    (unsigned long long)element->count, ascii || element->list_count ? "at least " : "",
                    (unsigned long long)wanted, (unsigned long long)at, (unsigned long long)left,
                    (unsigned long long)(wanted - left));
}

static ewa_status skip_element(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, uint64_t *at) {
    const ewa_status status = ewa_ply_check_size(source, header, element, *at);
    if (status != EWA_OK) return status;
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
        uint64_t least_bytes;
        // The last number of an ascii file needs no blank after it.
        if (__builtin_mul_overflow(element->count, element->least_bytes, &least_bytes) ||
            least_bytes > left + 1) {
            char quote[EWA_QUOTE_BYTES];
            ewa_report(source->context, EWA_SEVERITY_WARNING,
                       "%s: the file ends within %llu records of %s; the vertices before them are whole",
                       source->name, (unsigned long long)element->count, ewa_quote(element->name, quote));
            return;
        }
        exact = exact && element->list_count == 0;
        left -= least_bytes < left ? least_bytes : left;
    }
    if (exact && left)
        ewa_report(source->context, EWA_SEVERITY_INFO, "%s: %llu bytes follow the last element", source->name,
                   (unsigned long long)left);
}

/// Gives the cloud a stream for a column and the sink one move for each run of components that lie side by
/// side.
static ewa_status add_stream(ewa_cloud *cloud, const ewa_ply_column *column, bool swap, ewa_ply_sink *sink) {
    void *data;
    const ewa_status status =
        ewa_cloud_add(cloud, column->attribute, column->type, column->component_count, &data);
    if (status != EWA_OK) return status;
    const size_t number_bytes = ewa_type_bytes(column->type);
    for (uint32_t c = 0; c < column->component_count;) {
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
            .to = (uint8_t *)data + c * number_bytes,
            .to_stride_bytes = column->component_count * number_bytes};
        c += run;
    }
    return EWA_OK;
}

/// Makes the cloud and fills it from byte `*at` on, which steps over the records.
static ewa_status fill_cloud(const ewa_ply_source *source, const ewa_ply_header *header,
                             const ewa_ply_element *vertices, const ewa_ply_column *columns,
                             uint32_t column_count, uint64_t *at, ewa_cloud **cloud) {
    ewa_ply_sink sink = {.stream_capacity = vertices->property_count};
    sink.streams = ewa_allocate(source->context, sink.stream_capacity, sizeof *sink.streams);
    if (!sink.streams) return EWA_ERROR_MEMORY;
    const bool ascii = header->encoding == EWA_PLY_ASCII;
    ewa_cloud *made = NULL;
    ewa_status status = ewa_cloud_create(source->context, vertices->count, &made);
    for (uint32_t i = 0; i < column_count && status == EWA_OK; i++)
        status = add_stream(made, &columns[i], ewa_ply_is_swapped(header), &sink);
    if (status == EWA_OK)
        status = ascii ? ewa_ply_ascii_read(source, header, vertices, &sink, at)
                       : ewa_ply_binary_read(source, header, vertices, &sink, at);
    ewa_release(source->context, sink.streams, sink.stream_capacity, sizeof *sink.streams);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *cloud = made;
    return status;
}

ewa_status ewa_ply_read_vertices(const ewa_ply_source *source, const ewa_ply_header *header,
                                 const ewa_ply_element *vertices, uint64_t *at, ewa_cloud **cloud) {
    const size_t column_capacity = vertices->property_count + (size_t)1; // one more to try a group in
    ewa_ply_column *columns = ewa_allocate(source->context, column_capacity, sizeof *columns);
    if (!columns) return EWA_ERROR_MEMORY;
    uint32_t column_count = 0;
    ewa_status status = ewa_ply_columns_map(source, header, vertices, columns, &column_count);
    if (status == EWA_OK) status = check_limits(source, vertices, columns, column_count);
    if (status == EWA_OK) status = ewa_ply_check_size(source, header, vertices, *at);
    if (status == EWA_OK) status = fill_cloud(source, header, vertices, columns, column_count, at, cloud);
    ewa_release(source->context, columns, column_capacity, sizeof *columns);
    return status;
}

static ewa_status read_body(const ewa_ply_source *source, const ewa_ply_header *header, ewa_cloud **cloud) {
    const ewa_ply_element *vertices = ewa_ply_vertices(header);
    if (!vertices)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the header has no element 'vertex'",
                        source->name);
    uint64_t at = header->body_at;
    ewa_status status = EWA_OK;
    for (const ewa_ply_element *element = header->elements; element < vertices && status == EWA_OK; element++)
        status = skip_element(source, header, element, &at);
    if (status == EWA_OK) status = ewa_ply_read_vertices(source, header, vertices, &at, cloud);
    if (status == EWA_OK) inspect_rest(source, header, vertices, at);
    return status;
}

ewa_status ewa_ply_read(const ewa_ply_source *source, ewa_cloud **cloud) {
    ewa_ply_header *header = ewa_allocate(source->context, 1, sizeof *header);
    if (!header) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_ply_header_read(source, header);
    if (status == EWA_OK) status = read_body(source, header, cloud);
    ewa_release(source->context, header, 1, sizeof *header);
    return status;
}
