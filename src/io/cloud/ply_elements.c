// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Writing elements beside the vertices as they were read: their comments, properties, numbers and lists, in
// any encoding.
#include "base/base.h"
#include "io/cloud/ply.h"
#include "io/file.h"
#include "io/number.h"

#include <stdio.h>

size_t ewa_ply_write_number(ewa_type type, const uint8_t *from, char *text) {
    if (type == EWA_F32) {
        float value;
        memcpy(&value, from, sizeof value);
        return ewa_number_write_f32(value, text);
    }
    double value;
    const ewa_move move = {.from_type = type, .to_type = EWA_F64, .component_count = 1};
    ewa_move_numbers(&move, (uint8_t *)&value, 0, from, 0, 1);
    return type == EWA_F64 ? ewa_number_write_f64(value, text) : ewa_number_write_i64((int64_t)value, text);
}

static ewa_status put_text(ewa_writer *writer, ewa_text text) {
    return ewa_writer_put(writer, text.chars, text.length);
}

ewa_status ewa_ply_write_comments(const ewa_elements *elements, ewa_writer *writer) {
    const char *end = elements->text + elements->text_bytes;
    ewa_cursor cursor = {elements->text, end, 1};
    ewa_status status = EWA_OK;
    while (cursor.at < end && status == EWA_OK) {
        ewa_cursor peek = cursor;
        const ewa_text word = ewa_cursor_word(&peek), line = ewa_cursor_rest(&cursor);
        if (ewa_text_is(word, "comment") || ewa_text_is(word, "obj_info")) {
            status = put_text(writer, line);
            if (status == EWA_OK) status = ewa_writer_put(writer, "\n", 1);
        }
        ewa_cursor_step_line(&cursor);
    }
    return status;
}

ewa_status ewa_ply_write_element_header(const ewa_elements *elements, uint32_t table, ewa_writer *writer) {
    const ewa_ply_element *element = elements->tables[table].element;
    char line[64];
    EWA_TRY(ewa_writer_put(writer, "element ", 8));
    EWA_TRY(put_text(writer, element->name));
    int length = snprintf(line, sizeof line, " %llu\n", (unsigned long long)element->count);
    EWA_TRY(ewa_writer_put(writer, line, (size_t)length));
    for (uint32_t i = 0; i < element->property_count; i++) {
        const ewa_ply_property *property = &elements->header->properties[element->first_property + i];
        length = property->is_list
                     ? snprintf(line, sizeof line, "property list %s %s ",
                                ewa_type_name(property->count_type), ewa_type_name(property->type))
                     : snprintf(line, sizeof line, "property %s ", ewa_type_name(property->type));
        EWA_TRY(ewa_writer_put(writer, line, (size_t)length));
        EWA_TRY(put_text(writer, property->name));
        EWA_TRY(ewa_writer_put(writer, "\n", 1));
    }
    return EWA_OK;
}

/// Where numbers go, in which form.
typedef struct number_sink {
    ewa_writer *writer;
    bool ascii, swap;
    bool inside; ///< a number stands on the line
} number_sink;

/// Writes one number of a type.
static ewa_status put_number(number_sink *sink, ewa_type type, const uint8_t *from) {
    if (sink->ascii) {
        char text[EWA_NUMBER_BYTES + 1];
        text[0] = ' ';
        const size_t length = 1 + ewa_ply_write_number(type, from, text + 1), skip = !sink->inside;
        sink->inside = true;
        return ewa_writer_put(sink->writer, text + skip, length - skip);
    }
    uint8_t bytes[8];
    const ewa_move move = {.from_type = type, .to_type = type, .component_count = 1, .swap = sink->swap};
    ewa_move_numbers(&move, bytes, 0, from, 0, 1);
    return ewa_writer_put(sink->writer, bytes, ewa_type_bytes(type));
}

/// Writes the length of a list, which came from a number of that type.
static ewa_status put_length(number_sink *sink, ewa_type type, uint64_t length) {
    uint8_t bytes[8] = {0};
    const uint8_t u8 = (uint8_t)length;
    const uint16_t u16 = (uint16_t)length;
    const uint32_t u32 = (uint32_t)length;
    const size_t size = ewa_type_bytes(type);
    memcpy(bytes, size == 1 ? (const void *)&u8 : size == 2 ? (const void *)&u16 : (const void *)&u32, size);
    return put_number(sink, type, bytes);
}

ewa_status ewa_ply_write_element(const ewa_elements *elements, uint32_t table_index,
                                 ewa_ply_encoding encoding, ewa_writer *writer) {
    const ewa_ply_table *table = &elements->tables[table_index];
    const ewa_ply_element *element = table->element;
    number_sink sink = {.writer = writer, .ascii = encoding == EWA_PLY_ASCII};
    sink.swap =
        !sink.ascii && (encoding == EWA_PLY_BINARY_BIG_ENDIAN) != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
    ewa_status status = EWA_OK;
    if (element->property_count == 0) return EWA_OK;
    for (uint64_t r = 0; r < element->count && status == EWA_OK; r++) {
        const ewa_ply_list *list = table->lists;
        for (uint32_t i = 0; i < element->property_count && status == EWA_OK; i++) {
            const ewa_ply_property *property = &elements->header->properties[element->first_property + i];
            if (!property->is_list) {
                status = put_number(&sink, property->type,
                                    table->records + r * element->record_bytes + property->offset_bytes);
                continue;
            }
            const size_t number_bytes = ewa_type_bytes(property->type);
            status = put_length(&sink, property->count_type, list->first[r + 1] - list->first[r]);
            for (uint64_t k = list->first[r]; k < list->first[r + 1] && status == EWA_OK; k++)
                status = put_number(&sink, property->type, list->numbers + k * number_bytes);
            list++;
        }
        if (sink.ascii && status == EWA_OK) status = ewa_writer_put(writer, "\n", 1);
        sink.inside = false;
        if (r % 65536 == 65535 && status == EWA_OK)
            status = ewa_progress(elements->context, "write", (double)r / (double)element->count);
    }
    return status;
}
