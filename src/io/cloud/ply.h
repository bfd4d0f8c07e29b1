// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the parts of the PLY reader and writer share: the header, and how properties and attributes
// correspond.
//
// Based on: G. Turk, "The PLY Polygon File Format", Stanford University 1994.
#ifndef EWA_SRC_PLY_H
#define EWA_SRC_PLY_H

#include "io/cloud/format.h"
#include "io/records.h"
#include "io/text.h"

enum {
    EWA_PLY_MAX_ELEMENTS = 64,
    EWA_PLY_MAX_PROPERTIES = 1000, ///< of all elements together
};

/// The bytes of a file and where messages about it go.
typedef struct ewa_ply_source {
    ewa_context *context;
    const char *name; ///< stands for the file in messages
    const uint8_t *bytes;
    uint64_t size_bytes;
} ewa_ply_source;

typedef struct ewa_ply_property {
    ewa_text name;
    ewa_type type;
    ewa_type count_type;   ///< of a list
    bool is_list;          ///< a count, then as many numbers
    uint32_t offset_bytes; ///< of a scalar, in a record without its lists
} ewa_ply_property;

typedef struct ewa_ply_element {
    ewa_text name;
    uint64_t count;
    uint64_t before_count, after_count; ///< records of the file that are no part of a piece
    uint32_t first_property, property_count;
    uint32_t list_count;
    uint32_t record_bytes; ///< scalars only
    uint32_t min_bytes;    ///< of one record in the file: empty lists, or ascii digits and blanks
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

/// The numbers of one list property: those of record i are [first[i], first[i + 1]).
typedef struct ewa_ply_list {
    uint64_t *first;  ///< one more than records
    uint8_t *numbers; ///< of the property's type, in this machine's byte order
    uint64_t count, capacity;
} ewa_ply_list;

typedef struct ewa_ply_sink {
    ewa_ply_stream *streams;
    uint32_t stream_count, stream_capacity;
    ewa_ply_list *lists; ///< by the element's list properties in their order; NULL: stepped over
} ewa_ply_sink;

/// Makes room for `more` numbers of a list and returns it; NULL with `*status`: EWA_ERROR_LIMIT,
/// EWA_ERROR_MEMORY.
uint8_t *ewa_ply_list_add(const ewa_ply_source *source, ewa_ply_list *list, uint64_t more,
                          size_t number_bytes, ewa_status *status);

enum { EWA_PLY_BLOCK_BYTES = 1 << 14 }; ///< records that are moved at a time: they stay in the first cache

/// Returns how many records of that size make a block; at least 2, since a record has at most 8 * 1000 bytes.
/// Records of lists only have none.
static inline uint64_t ewa_ply_block_records(uint32_t record_bytes) {
    return EWA_PLY_BLOCK_BYTES / (record_bytes ? record_bytes : 1);
}

/// Moves `count` records, `record_bytes` apart, to the points from `first` on.
void ewa_ply_sink_put(const ewa_ply_sink *sink, uint64_t first, const uint8_t *records, uint32_t record_bytes,
                      uint64_t count);

/// Steps `*at` over all records of an element, for which min_bytes each are there. Errors:
/// EWA_ERROR_FORMAT.
ewa_status ewa_ply_binary_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, uint64_t *at);
ewa_status ewa_ply_ascii_skip(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t *at);

/// Decodes all records of an element, for which min_bytes each are there, into `sink` and steps `*at` over
/// them. Errors: EWA_ERROR_FORMAT, EWA_CANCELLED.
ewa_status ewa_ply_binary_read(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at);
ewa_status ewa_ply_ascii_read(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, const ewa_ply_sink *sink, uint64_t *at);

/// The element that holds the points, or NULL.
const ewa_ply_element *ewa_ply_vertices(const ewa_ply_header *header);

/// Checks that all records of an element can be there from byte `at` on, before anything is made or walked
/// for them. Errors: EWA_ERROR_FORMAT.
ewa_status ewa_ply_check_size(const ewa_ply_source *source, const ewa_ply_header *header,
                              const ewa_ply_element *element, uint64_t at);

/// Whether numbers of the file have their bytes in the other order than this machine. Ascii ones are decoded
/// to its own.
static inline bool ewa_ply_is_swapped(const ewa_ply_header *header) {
    return header->encoding != EWA_PLY_ASCII &&
           (header->encoding == EWA_PLY_BINARY_BIG_ENDIAN) != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
}

/// Reads the vertices, which begin at byte `*at`, into a cloud, and steps over them.
ewa_status ewa_ply_read_vertices(const ewa_ply_source *source, const ewa_ply_header *header,
                                 const ewa_ply_element *vertices, uint64_t *at, ewa_cloud **cloud);

/// Vertices that are read piece by piece. Zero-initialised means: not open.
typedef struct ewa_ply_points {
    const ewa_ply_source *source;
    const ewa_ply_header *header;
    ewa_ply_element element;
    ewa_ply_column *columns;
    ewa_ply_stream *streams; ///< room for one per property
    uint32_t column_count;
    size_t column_capacity;
    uint64_t read_count, at; ///< records so far, and the byte behind them
} ewa_ply_points;

/// Begins with the vertices at byte `at`; source and header stay until the close. Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_MEMORY.
ewa_status ewa_ply_points_open(const ewa_ply_source *source, const ewa_ply_header *header,
                               const ewa_ply_element *vertices, uint64_t at, ewa_ply_points *points);
void ewa_ply_points_close(ewa_ply_points *points);

/// Adds the attributes of the vertices to a cloud.
ewa_status ewa_ply_points_add(const ewa_ply_points *points, ewa_cloud *cloud);

/// Reads the next vertices, at most `maximum`, into one sink per column; 0 at the end.
ewa_status ewa_ply_points_read(ewa_ply_points *points, uint64_t maximum, const ewa_cloud_sink *sinks,
                               uint64_t *got_count);

/// All records of one element.
typedef struct ewa_ply_table {
    const ewa_ply_element *element;
    uint8_t *records;    ///< record_bytes each, in this machine's byte order
    ewa_ply_list *lists; ///< by list property
} ewa_ply_table;

/// What a file holds beside its vertices.
struct ewa_elements {
    ewa_context *context;
    char *text; ///< of the header, which the names of `header` are in
    size_t text_bytes;
    ewa_ply_header *header;
    ewa_ply_table *tables; ///< by element; that of the vertices is empty
    uint32_t table_count;
};

/// Whether an element holds faces or strips of triangles, and which of its lists their vertices are.
bool ewa_ply_is_faces(const ewa_ply_header *header, const ewa_ply_element *element, bool *strips,
                      uint32_t *vertices_property);

/// How many faces and strips of triangles a file has.
uint64_t ewa_ply_count_faces(const ewa_ply_header *header);

/// Reads a whole file: the vertices as a cloud, everything else as it is. Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED; both are NULL then.
ewa_status ewa_ply_read_all(const ewa_ply_source *source, ewa_cloud **cloud, ewa_elements **elements);

/// Finds the list among an element's ones; NULL when the property is no list.
static inline const ewa_ply_list *ewa_ply_table_list(const ewa_ply_header *header, const ewa_ply_table *table,
                                                     uint32_t property) {
    uint32_t list = 0;
    for (uint32_t i = table->element->first_property; i < property; i++)
        list += header->properties[i].is_list;
    return header->properties[property].is_list ? &table->lists[list] : NULL;
}

/// Number `index` of a list, as a double.
double ewa_ply_list_number(const ewa_ply_list *list, ewa_type type, uint64_t index);

/// The number of a scalar property in a record, as a double.
double ewa_ply_table_number(const ewa_ply_header *header, const ewa_ply_table *table, uint32_t property,
                            uint64_t record);

/// Finds a property of an element by name; false when there is none.
bool ewa_ply_find_property(const ewa_ply_header *header, const ewa_ply_element *element, const char *name,
                           uint32_t *property);

typedef struct ewa_writer ewa_writer;

/// Writes a number of a type, in this machine's byte order, as text into at least EWA_NUMBER_BYTES; returns
/// how many bytes.
size_t ewa_ply_write_number(ewa_type type, const uint8_t *from, char *text);

/// Writes the comments that came with elements, the header of one of them, its records (ply_elements.c).
ewa_status ewa_ply_write_comments(const ewa_elements *elements, ewa_writer *writer);
ewa_status ewa_ply_write_element_header(const ewa_elements *elements, uint32_t table, ewa_writer *writer);
ewa_status ewa_ply_write_element(const ewa_elements *elements, uint32_t table, ewa_ply_encoding encoding,
                                 ewa_writer *writer);

#endif
