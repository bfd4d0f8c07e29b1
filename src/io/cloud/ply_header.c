// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The header of a PLY file: lines of words up to "end_header".
//
// Based on: G. Turk, "The PLY Polygon File Format", Stanford University 1994. Beyond it, as files in
// circulation have it: obj_info, blank lines, line ends of all three kinds, types with and without their size
// in the name.
#include "base/base.h"
#include "base/format.h"
#include "io/cloud/ply.h"
#include "io/reader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
    MAX_WORDS = 6,          // one more than the longest line has, to notice a surplus
    SHOWN_LINE_BYTES = 512, // longer lines are cut when they are handed over
};

static ewa_status fail_line(const ewa_ply_source *source, const ewa_ply_header *header, ewa_status status,
                            const char *format, ...) __attribute__((format(printf, 4, 5)));

static ewa_status fail_line(const ewa_ply_source *source, const ewa_ply_header *header, ewa_status status,
                            const char *format, ...) {
    char reason[256];
    va_list arguments;
    va_start(arguments, format);
    ewa_format_list(reason, sizeof reason, format, arguments);
    va_end(arguments);
    return ewa_fail(source->context, status, "%s: line %llu: %s", source->name,
                    (unsigned long long)header->line_count, reason);
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

static bool same(ewa_text a, ewa_text b) {
    return a.length == b.length && memcmp(a.chars, b.chars, a.length) == 0;
}

static uint32_t split(ewa_text line, ewa_text words[MAX_WORDS]) {
    uint32_t count = 0;
    const char *at = line.chars, *end = line.chars + line.length;
    while (count < MAX_WORDS) {
        while (at < end && is_blank(*at)) at++;
        if (at == end) break;
        const char *word = at;
        while (at < end && !is_blank(*at)) at++;
        words[count++] = (ewa_text){word, (size_t)(at - word)};
    }
    return count;
}

static bool find_type(ewa_text word, ewa_type *type) {
    static const struct {
        const char *name;
        ewa_type type;
    } names[] = {
        {"float", EWA_F32}, {"float32", EWA_F32}, {"double", EWA_F64}, {"float64", EWA_F64},
        {"char", EWA_I8},   {"int8", EWA_I8},     {"uchar", EWA_U8},   {"uint8", EWA_U8},
        {"short", EWA_I16}, {"int16", EWA_I16},   {"ushort", EWA_U16}, {"uint16", EWA_U16},
        {"int", EWA_I32},   {"int32", EWA_I32},   {"uint", EWA_U32},   {"uint32", EWA_U32},
        {"bool", EWA_U8}, // no type of the format, but pyntcloud writes it
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (!ewa_text_is(word, names[i].name)) continue;
        *type = names[i].type;
        return true;
    }
    return false;
}

static ewa_status read_format(const ewa_ply_source *source, ewa_ply_header *header, const ewa_text *words,
                              uint32_t word_count, bool *known) {
    static const char *const names[] = {"binary_little_endian", "binary_big_endian", "ascii"};
    char quote[EWA_QUOTE_BYTES];
    if (*known) return fail_line(source, header, EWA_ERROR_FORMAT, "a second format");
    if (word_count != 3)
        return fail_line(source, header, EWA_ERROR_FORMAT, "'format' wants an encoding and a version");
    if (!ewa_text_is(words[2], "1.0"))
        return fail_line(source, header, EWA_ERROR_UNSUPPORTED, "version %s; 1.0 is read",
                         ewa_quote(words[2], quote));
    for (int i = 0; i < 3; i++) {
        if (!ewa_text_is(words[1], names[i])) continue;
        header->encoding = (ewa_ply_encoding)i;
        *known = true;
        return EWA_OK;
    }
    return fail_line(source, header, EWA_ERROR_UNSUPPORTED, "encoding %s", ewa_quote(words[1], quote));
}

static ewa_status read_element(const ewa_ply_source *source, ewa_ply_header *header, const ewa_text *words,
                               uint32_t word_count) {
    char quote[EWA_QUOTE_BYTES];
    if (word_count != 3)
        return fail_line(source, header, EWA_ERROR_FORMAT, "'element' wants a name and a count");
    if (header->element_count == EWA_PLY_MAX_ELEMENTS)
        return fail_line(source, header, EWA_ERROR_LIMIT, "more than %d elements", EWA_PLY_MAX_ELEMENTS);
    for (uint32_t i = 0; i < header->element_count; i++)
        if (same(header->elements[i].name, words[1]))
            return fail_line(source, header, EWA_ERROR_FORMAT, "element %s a second time",
                             ewa_quote(words[1], quote));
    uint64_t count = 0;
    for (size_t i = 0; i < words[2].length; i++) {
        const unsigned digit = (unsigned char)(words[2].chars[i] - '0');
        if (digit > 9 || __builtin_mul_overflow(count, 10, &count) ||
            __builtin_add_overflow(count, digit, &count))
            return fail_line(source, header, EWA_ERROR_FORMAT, "%s is no count", ewa_quote(words[2], quote));
    }
    header->elements[header->element_count++] =
        (ewa_ply_element){.name = words[1], .count = count, .first_property = header->property_count};
    return EWA_OK;
}

static ewa_status read_property(const ewa_ply_source *source, ewa_ply_header *header, const ewa_text *words,
                                uint32_t word_count) {
    char quote[EWA_QUOTE_BYTES];
    const bool is_list = word_count > 1 && ewa_text_is(words[1], "list");
    if (word_count != (is_list ? 5 : 3))
        return fail_line(source, header, EWA_ERROR_FORMAT,
                         "'property' wants a type and a name, or list, two types "
                         "and a name");
    if (header->element_count == 0)
        return fail_line(source, header, EWA_ERROR_FORMAT, "a property before any element");
    if (header->property_count == EWA_PLY_MAX_PROPERTIES)
        return fail_line(source, header, EWA_ERROR_LIMIT, "more than %d properties", EWA_PLY_MAX_PROPERTIES);
    ewa_ply_property property = {.name = words[word_count - 1], .is_list = is_list};
    if (!find_type(words[word_count - 2], &property.type))
        return fail_line(source, header, EWA_ERROR_FORMAT, "unknown type %s",
                         ewa_quote(words[word_count - 2], quote));
    if (is_list && (!find_type(words[2], &property.count_type) || property.count_type == EWA_F32 ||
                    property.count_type == EWA_F64))
        return fail_line(source, header, EWA_ERROR_FORMAT, "a list cannot be counted by %s",
                         ewa_quote(words[2], quote));
    ewa_ply_element *element = &header->elements[header->element_count - 1];
    for (uint32_t i = element->first_property; i < header->property_count; i++)
        if (same(header->properties[i].name, property.name))
            return fail_line(source, header, EWA_ERROR_FORMAT, "property %s a second time",
                             ewa_quote(property.name, quote));
    if (is_list) {
        element->list_count++;
        element->min_bytes += (uint32_t)ewa_type_bytes(property.count_type);
    } else {
        property.offset_bytes = element->record_bytes;
        element->record_bytes += (uint32_t)ewa_type_bytes(property.type);
        element->min_bytes += (uint32_t)ewa_type_bytes(property.type);
    }
    element->property_count++;
    header->properties[header->property_count++] = property;
    return EWA_OK;
}

/// Takes "ply", perhaps behind a byte order mark, and learns how lines end. The kind matters after end_header: there, a line feed behind a lone
/// carriage return may be data.
static bool read_magic(ewa_reader *reader, char *line_end) {
    ewa_reader_take(reader, ewa_bytes_mark(reader->bytes, reader->size_bytes));
    const uint8_t *magic = ewa_reader_take(reader, 3);
    if (!magic || memcmp(magic, "ply", 3) != 0) return false;
    const uint8_t *c;
    do {
        c = ewa_reader_take(reader, 1);
    } while (c && (*c == ' ' || *c == '\t'));
    if (!c || (*c != '\n' && *c != '\r')) return false;
    *line_end = '\n';
    if (*c == '\n') return true;
    if (ewa_reader_left(reader) && reader->bytes[reader->at_bytes] == '\n')
        reader->at_bytes++;
    else
        *line_end = '\r';
    return true;
}

/// Takes a line, also a last one without an end; false when nothing is left.
static bool take_line(ewa_reader *reader, char line_end, ewa_text *line) {
    uint64_t length = ewa_reader_left(reader);
    line->chars = (const char *)reader->bytes + reader->at_bytes;
    if (length == 0) return false;
    if (!ewa_reader_take_line(reader, (uint8_t)line_end, &length)) reader->at_bytes = reader->size_bytes;
    line->length = (size_t)length;
    return true;
}

ewa_status ewa_ply_header_read(const ewa_ply_source *source, ewa_ply_header *header) {
    header->element_count = header->property_count = 0;
    header->line_count = 1;
    ewa_reader reader = {.bytes = source->bytes, .size_bytes = source->size_bytes};
    if (!read_magic(&reader, &header->line_end))
        return fail_line(source, header, EWA_ERROR_FORMAT, "a PLY file begins with a line 'ply'");
    bool format_known = false;
    for (;;) {
        ewa_text line, words[MAX_WORDS];
        uint64_t length = ewa_reader_left(&reader);
        if (length == 0)
            return fail_line(source, header, EWA_ERROR_FORMAT, "the file ends before 'end_header'");
        header->line_count++;
        line.chars = (const char *)reader.bytes + reader.at_bytes;
        if (!ewa_reader_take_line(&reader, (uint8_t)header->line_end, &length))
            reader.at_bytes = reader.size_bytes;
        line.length = (size_t)length;
        const uint32_t word_count = split(line, words);
        // Blender 2.4 begins its remark with "Created" alone.
        if (word_count == 0 || ewa_text_is(words[0], "comment") || ewa_text_is(words[0], "obj_info") ||
            ewa_text_is(words[0], "Created"))
            continue;
        if (ewa_text_is(words[0], "end_header")) break;
        if (ewa_text_is(words[0], "format")) {
            EWA_TRY(read_format(source, header, words, word_count, &format_known));
        } else if (ewa_text_is(words[0], "element")) {
            EWA_TRY(read_element(source, header, words, word_count));
        } else if (ewa_text_is(words[0], "property")) {
            EWA_TRY(read_property(source, header, words, word_count));
        } else {
            char quote[EWA_QUOTE_BYTES];
            return fail_line(source, header, EWA_ERROR_FORMAT, "unknown word %s", ewa_quote(words[0], quote));
        }
    }
    if (!format_known) return fail_line(source, header, EWA_ERROR_FORMAT, "the header has no 'format'");
    header->body_at = reader.at_bytes;
    if (header->encoding == EWA_PLY_ASCII) // a digit and a blank for each number
        for (uint32_t i = 0; i < header->element_count; i++)
            header->elements[i].min_bytes = 2 * header->elements[i].property_count;
    return EWA_OK;
}

void ewa_ply_header_lines(const ewa_ply_source *source, const ewa_ply_header *header, ewa_line_callback *line,
                          void *user) {
    ewa_reader reader = {.bytes = source->bytes, .size_bytes = source->size_bytes};
    ewa_text text;
    take_line(&reader, header->line_end, &text);
    for (uint64_t i = 3; i <= header->line_count && take_line(&reader, header->line_end, &text); i++) {
        char shown[SHOWN_LINE_BYTES];
        size_t length = 0;
        while (text.length && is_blank(text.chars[text.length - 1])) text.length--;
        for (size_t k = 0; k < text.length && length + 1 < sizeof shown; k++) {
            const char c = text.chars[k];
            shown[length++] = (char)(c >= ' ' && c <= '~' ? c : c == '\t' ? ' ' : '?');
        }
        shown[length] = 0;
        line(user, shown);
    }
}

bool ewa_ply_find_property(const ewa_ply_header *header, const ewa_ply_element *element, const char *name,
                           uint32_t *property) {
    for (uint32_t i = 0; i < element->property_count; i++)
        if (ewa_text_is(header->properties[element->first_property + i].name, name)) {
            *property = element->first_property + i;
            return true;
        }
    return false;
}

bool ewa_ply_is_faces(const ewa_ply_header *header, const ewa_ply_element *element, bool *strips,
                      uint32_t *vertices_property) {
    *strips = ewa_text_is(element->name, "tristrips");
    if (element->count == 0 || (!*strips && !ewa_text_is(element->name, "face"))) return false;
    return (ewa_ply_find_property(header, element, "vertex_indices", vertices_property) ||
            ewa_ply_find_property(header, element, "vertex_index", vertices_property)) &&
           header->properties[*vertices_property].is_list;
}

uint64_t ewa_ply_count_faces(const ewa_ply_header *header) {
    bool strips;
    uint32_t property;
    uint64_t count = 0;
    for (uint32_t i = 0; i < header->element_count; i++)
        if (ewa_ply_is_faces(header, &header->elements[i], &strips, &property))
            count += header->elements[i].count;
    return count;
}
