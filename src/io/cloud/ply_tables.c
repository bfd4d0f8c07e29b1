// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a PLY file holds beside its vertices: every element as a table of its numbers and lists, so that faces
// of any kind can be made from it, and all of it written again.
#include "base/base.h"
#include "ewa/io.h"
#include "io/cloud/ply.h"

#include <string.h>

static double number_at(ewa_type type, const uint8_t *bytes) {
    const ewa_move move = {.from_type = type, .to_type = EWA_F64, .component_count = 1};
    double value;
    ewa_move_numbers(&move, (uint8_t *)&value, 0, bytes, 0, 1);
    return value;
}

double ewa_ply_list_number(const ewa_ply_list *list, ewa_type type, uint64_t index) {
    return number_at(type, list->numbers + index * ewa_type_bytes(type));
}

double ewa_ply_table_number(const ewa_ply_header *header, const ewa_ply_table *table, uint32_t property,
                            uint64_t record) {
    const ewa_ply_property *found = &header->properties[property];
    return number_at(found->type,
                     table->records + record * table->element->record_bytes + found->offset_bytes);
}

/// Allocates the records and the places of the lists of an element, for which min_bytes each are there.
static ewa_status make_table(const ewa_ply_source *source, const ewa_ply_element *element,
                             ewa_ply_table *table) {
    uint64_t bytes;
    const uint64_t record_bytes = element->record_bytes + (uint64_t)element->list_count * sizeof(uint64_t);
    if (__builtin_mul_overflow(element->count, record_bytes, &bytes) ||
        bytes > ewa_context_limits(source->context)->max_memory_bytes) {
        char quote[EWA_QUOTE_BYTES];
        return ewa_fail(source->context, EWA_ERROR_LIMIT, "%s: %llu records of %s are over max_memory_bytes",
                        source->name, (unsigned long long)element->count, ewa_quote(element->name, quote));
    }
    table->element = element;
    if (element->property_count == 0) return EWA_OK;
    table->records = ewa_allocate(source->context, element->count, element->record_bytes);
    table->lists = ewa_allocate_zeroed(source->context, element->list_count, sizeof *table->lists);
    if (!table->records || !table->lists) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < element->list_count; i++) {
        table->lists[i].first =
            ewa_allocate(source->context, element->count + 1, sizeof *table->lists[i].first);
        if (!table->lists[i].first) return EWA_ERROR_MEMORY;
        table->lists[i].first[0] = 0;
    }
    return EWA_OK;
}

/// Reads an element into its table.
static ewa_status read_table(const ewa_ply_source *source, const ewa_ply_header *header,
                             const ewa_ply_element *element, uint64_t *at, ewa_ply_table *table) {
    EWA_TRY(ewa_ply_check_size(source, header, element, *at));
    EWA_TRY(make_table(source, element, table));
    if (element->count == 0 || element->property_count == 0) return EWA_OK;
    ewa_ply_sink sink = {.stream_capacity = element->property_count,
                         .lists = element->list_count ? table->lists : NULL};
    sink.streams = ewa_allocate(source->context, sink.stream_capacity, sizeof *sink.streams);
    if (!sink.streams) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ewa_ply_property *property = &header->properties[element->first_property + i];
        if (property->is_list) continue;
        sink.streams[sink.stream_count++] = (ewa_ply_stream){.move = {.from_type = property->type,
                                                                      .to_type = property->type,
                                                                      .component_count = 1,
                                                                      .swap = ewa_ply_is_swapped(header)},
                                                             .from_offset_bytes = property->offset_bytes,
                                                             .to = table->records + property->offset_bytes,
                                                             .to_stride_bytes = element->record_bytes};
    }
    ewa_status status = header->encoding == EWA_PLY_ASCII
                            ? ewa_ply_ascii_read(source, header, element, &sink, at)
                            : ewa_ply_binary_read(source, header, element, &sink, at);
    ewa_release(source->context, sink.streams, sink.stream_capacity, sizeof *sink.streams);
    return status;
}

/// Copies the header's text, so that names outlive the file.
static ewa_status keep_header(const ewa_ply_source *source, ewa_elements *elements) {
    ewa_ply_header *header = elements->header;
    elements->text_bytes = (size_t)header->body_at;
    elements->text = ewa_allocate(source->context, elements->text_bytes, 1);
    elements->tables = ewa_allocate_zeroed(source->context, header->element_count, sizeof *elements->tables);
    elements->table_count = header->element_count;
    if (!elements->text || !elements->tables) return EWA_ERROR_MEMORY;
    const char *old = (const char *)source->bytes;
    memcpy(elements->text, old, elements->text_bytes);
    for (uint32_t i = 0; i < header->element_count; i++) {
        ewa_text *name = &header->elements[i].name;
        name->chars = elements->text + (name->chars - old);
    }
    for (uint32_t i = 0; i < header->property_count; i++) {
        ewa_text *name = &header->properties[i].name;
        name->chars = elements->text + (name->chars - old);
    }
    return EWA_OK;
}

static ewa_status read_elements(const ewa_ply_source *source, ewa_elements *elements, ewa_cloud **cloud) {
    const ewa_ply_header *header = elements->header;
    const ewa_ply_element *vertices = ewa_ply_vertices(header);
    if (!vertices)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the header has no element 'vertex'",
                        source->name);
    uint64_t at = header->body_at;
    for (uint32_t i = 0; i < header->element_count; i++) {
        const ewa_ply_element *element = &header->elements[i];
        elements->tables[i].element = element;
        if (element == vertices)
            EWA_TRY(ewa_ply_read_vertices(source, header, element, &at, cloud));
        else
            EWA_TRY(read_table(source, header, element, &at, &elements->tables[i]));
    }
    return EWA_OK;
}

ewa_status ewa_ply_read_all(const ewa_ply_source *source, ewa_cloud **cloud, ewa_elements **elements) {
    *cloud = NULL;
    *elements = NULL;
    ewa_elements *made = ewa_allocate_zeroed(source->context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = source->context;
    made->header = ewa_allocate(source->context, 1, sizeof *made->header);
    ewa_status status = made->header ? ewa_ply_header_read(source, made->header) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = keep_header(source, made);
    if (status == EWA_OK) status = read_elements(source, made, cloud);
    if (status != EWA_OK) {
        ewa_cloud_destroy(cloud);
        ewa_elements_free(&made);
    }
    *elements = made;
    return status;
}

void ewa_elements_free(ewa_elements **elements) {
    if (!elements || !*elements) return;
    ewa_elements *old = *elements;
    ewa_context *context = old->context;
    for (uint32_t i = 0; old->tables && i < old->table_count; i++) {
        ewa_ply_table *table = &old->tables[i];
        const ewa_ply_element *element = table->element;
        if (!element) continue;
        uint32_t list = 0;
        for (uint32_t k = 0; table->lists && k < element->property_count; k++) {
            const ewa_ply_property *property = &old->header->properties[element->first_property + k];
            if (!property->is_list) continue;
            ewa_release(context, table->lists[list].first, element->count + 1,
                        sizeof *table->lists[list].first);
            ewa_release(context, table->lists[list].numbers, table->lists[list].capacity,
                        ewa_type_bytes(property->type));
            list++;
        }
        ewa_release(context, table->lists, element->list_count, sizeof *table->lists);
        ewa_release(context, table->records, element->count, element->record_bytes);
    }
    ewa_release(context, old->tables, old->table_count, sizeof *old->tables);
    ewa_release(context, old->text, old->text_bytes, 1);
    ewa_release(context, old->header, 1, sizeof *old->header);
    ewa_release(context, old, 1, sizeof *old);
    *elements = NULL;
}

uint64_t ewa_elements_face_count(const ewa_elements *elements) {
    return elements ? ewa_ply_count_faces(elements->header) : 0;
}
