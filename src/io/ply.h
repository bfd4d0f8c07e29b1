// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the parts of the PLY reader and writer share: the header, and how properties and attributes
// correspond.
//
// Based on: G. Turk, "The PLY Polygon File Format", Stanford University 1994.
#ifndef EWA_SRC_PLY_H
#define EWA_SRC_PLY_H

#include "ewa/io.h"
#include "io/records.h"

enum {
    EWA_PLY_MAX_ELEMENTS = 64,
    EWA_PLY_MAX_PROPERTIES = 1000, ///< of all elements together
    EWA_PLY_QUOTE_BYTES = 48,
};

/// The bytes of a file and where messages about it go.
typedef struct ewa_ply_source {
    ewa_context *context;
    const char *name; ///< stands for the file in messages
    const uint8_t *bytes;
    uint64_t size_bytes;
} ewa_ply_source;

/// A piece of the file's text, not terminated.
typedef struct ewa_ply_text {
    const char *chars;
    size_t length;
} ewa_ply_text;

typedef struct ewa_ply_property {
    ewa_ply_text name;
    ewa_type type;
    ewa_type count_type;   ///< of a list
    bool is_list;          ///< a count, then as many numbers
    uint32_t offset_bytes; ///< of a scalar, in a record without its lists
} ewa_ply_property;

typedef struct ewa_ply_element {
    ewa_ply_text name;
    uint64_t count;
    uint32_t first_property, property_count;
    uint32_t list_count;
    uint32_t record_bytes; ///< scalars only
    uint32_t least_bytes;  ///< of one record in the file: empty lists, or ascii digits and blanks
} ewa_ply_element;

typedef struct ewa_ply_header {
    ewa_ply_encoding encoding;
    char line_end;       ///< '\n', also when '\r' stands before it, or a lone '\r'
    uint64_t line_count; ///< of the header
    uint64_t body_at;    ///< first byte after the header
    uint32_t element_count, property_count;
    ewa_ply_element elements[EWA_PLY_MAX_ELEMENTS];
    ewa_ply_property properties[EWA_PLY_MAX_PROPERTIES];
} ewa_ply_header;

/// Reads and checks the header. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT.
ewa_status ewa_ply_header_read(const ewa_ply_source *source, ewa_ply_header *header);

/// Hands over the lines of a header that was read, but for the first and the last.
void ewa_ply_header_lines(const ewa_ply_source *source, const ewa_ply_header *header, ewa_line_callback *line,
                          void *user);

/// Makes a piece of the file fit for a message: printable, quoted, cut when long. Returns `quote`.
const char *ewa_ply_quote(ewa_ply_text text, char quote[EWA_PLY_QUOTE_BYTES]);

/// One attribute of the cloud and the properties that fill it.
typedef struct ewa_ply_column {
    char attribute[EWA_NAME_BYTES];
    ewa_type type;
    uint32_t component_count;
    const ewa_ply_property *sources[4];
} ewa_ply_column;

/// Groups the scalars of an element to attributes as ewa/cloud.h names them; every other scalar is one of its
/// own. `columns` has room for one more than the element has properties. A scalar that no attribute can hold
/// is left out with a warning. Errors: EWA_ERROR_FORMAT when a coordinate is missing.
ewa_status ewa_ply_columns_map(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, ewa_ply_column *columns,
                               uint32_t *column_count);

enum { EWA_PLY_NAME_BYTES = EWA_NAME_BYTES + 8 };

/// Writes the property name of one component of an attribute; blanks, which a name cannot have, become '_'.
void ewa_ply_property_name(const ewa_attribute *attribute, uint32_t component, char name[EWA_PLY_NAME_BYTES]);

/// Where decoded records go: the streams of a cloud.
typedef struct ewa_ply_stream {
    ewa_move move;
    uint32_t from_offset_bytes; ///< in a record without its lists
    uint8_t *to;                ///< of the first point
    size_t to_stride_bytes;
} ewa_ply_stream;

typedef struct ewa_ply_sink {
    ewa_ply_stream *streams;
    uint32_t stream_count, stream_capacity;
} ewa_ply_sink;

enum { EWA_PLY_BLOCK_BYTES = 1 << 14 }; ///< records that are moved at a time: they stay in the first cache

/// Returns how many records of that size make a block; at least 2, since a record has at most 8 * 1000 bytes.
static inline uint64_t ewa_ply_block_records(uint32_t record_bytes) {
    return EWA_PLY_BLOCK_BYTES / record_bytes;
}

/// Moves `count` records, `record_bytes` apart, to the points from `first` on.
void ewa_ply_sink_put(const ewa_ply_sink *sink, uint64_t first, const uint8_t *records, uint32_t record_bytes,
                      uint64_t count);

/// Steps `*at` over all records of an element, for which least_bytes each are there. Errors:
/// EWA_ERROR_FORMAT.
ewa_status ewa_ply_binary_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, uint64_t *at);
ewa_status ewa_ply_ascii_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t *at);

/// Decodes all records of an element, for which least_bytes each are there, into `sink` and steps `*at` over
/// them. Errors: EWA_ERROR_FORMAT, EWA_CANCELLED.
ewa_status ewa_ply_binary_read(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at);
ewa_status ewa_ply_ascii_read(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at);

/// Reads a whole file into a cloud of the vertices.
ewa_status ewa_ply_read(const ewa_ply_source *source, ewa_cloud **cloud);

typedef struct ewa_writer ewa_writer;

/// Writes a cloud as the vertices of a file. Errors: EWA_ERROR_ARGUMENT (no position, a property name twice),
/// EWA_ERROR_LIMIT (more properties than the reader takes), EWA_ERROR_IO, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_ply_write(const ewa_cloud *cloud, ewa_ply_encoding encoding, const char *name,
                         ewa_writer *writer);

#endif
