// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// E57, the exchange format of terrestrial scanners: pages with checksums, an XML part that says what there is,
// and packets of bits with the points.
//
// By: ASTM E2807-11, "Standard Specification for 3D Imaging Data Exchange".
#ifndef EWA_SRC_E57_H
#define EWA_SRC_E57_H

#include "base/base.h"
#include "io/cloud/format.h"

enum {
    EWA_E57_MAX_FIELDS = 256, ///< of one scan
    EWA_E57_MAX_SCANS = 65535,
    EWA_E57_CHECKSUM_BYTES = 4, ///< at the end of each page
};

/// The pages of a file: what is between their checksums is one run of bytes, its places called logical.
typedef struct ewa_e57_pages {
    const ewa_cloud_source *source;
    const uint8_t *bytes;
    uint64_t page_bytes, payload_bytes; ///< with and without checksum
    uint64_t page_count;
    uint8_t *damaged; ///< by page: 1
    uint64_t damaged_count;
} ewa_e57_pages;

/// The CRC-32C (Castagnoli) of bytes, by the instruction of CPUs that have it (`hardware`) or by tables.
uint32_t ewa_e57_checksum(const uint8_t *bytes, size_t size_bytes, bool hardware);

/// Checks every page; a damaged one is told by ewa_cloud_damage(). Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_e57_pages_open(const ewa_cloud_source *source, uint64_t page_bytes, uint64_t size_bytes,
                              ewa_e57_pages *pages);
void ewa_e57_pages_close(ewa_e57_pages *pages);

/// Turns a place in the file into a logical one; false when it lies in a checksum or beyond the end.
bool ewa_e57_logical(const ewa_e57_pages *pages, uint64_t physical, uint64_t *logical);

/// Copies bytes from a logical place; false when the file has not so many. `*damaged` becomes true when one
/// of their pages is damaged.
bool ewa_e57_copy(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes, uint8_t *to,
                  bool *damaged);

/// The piece of a page from a logical place on: at most `size_bytes` bytes, `*piece_bytes` of them.
const uint8_t *ewa_e57_piece(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes,
                             uint64_t *piece_bytes);

/// A whole number of 1 to 8 bytes, the lowest first.
static inline uint64_t ewa_e57_read_le(const uint8_t *bytes, int size) {
    uint64_t value = 0;
    for (int i = 0; i < size; i++) value |= (uint64_t)bytes[i] << 8 * i;
    return value;
}

typedef enum ewa_e57_kind { EWA_E57_INTEGER, EWA_E57_SCALED, EWA_E57_FLOAT } ewa_e57_kind;

/// What the reader gives a meaning to; every other field keeps its name.
typedef enum ewa_e57_role {
    EWA_E57_X, ///< cartesian
    EWA_E57_Y,
    EWA_E57_Z,
    EWA_E57_RANGE, ///< spherical
    EWA_E57_AZIMUTH,
    EWA_E57_ELEVATION,
    EWA_E57_CARTESIAN_INVALID,
    EWA_E57_SPHERICAL_INVALID,
    EWA_E57_RED,
    EWA_E57_GREEN,
    EWA_E57_BLUE,
    EWA_E57_COLOR_INVALID,
    EWA_E57_INTENSITY,
    EWA_E57_INTENSITY_INVALID,
    EWA_E57_TIME,
    EWA_E57_TIME_INVALID,
    EWA_E57_RETURN_INDEX,
    EWA_E57_RETURN_COUNT,
    EWA_E57_ROW,
    EWA_E57_COLUMN,
    EWA_E57_NORMAL_X,
    EWA_E57_NORMAL_Y,
    EWA_E57_NORMAL_Z,
    EWA_E57_ROLES,
    EWA_E57_OTHER = EWA_E57_ROLES,
} ewa_e57_role;

/// One field of a scan's points.
typedef struct ewa_e57_field {
    char name[EWA_NAME_BYTES];
    ewa_e57_role role;
    ewa_e57_kind kind;
    bool single;              ///< float of 32 bits
    uint32_t bits;            ///< of one number; 0: it is always the minimum
    int64_t minimum, maximum; ///< of integers, before scale and offset
    double scale, offset;     ///< of scaled ones
    double low, high;         ///< of numbers; infinite: not said
} ewa_e57_field;

/// Limits of what a scanner measures; NaN: not said.
typedef struct ewa_e57_limits {
    double low, high;
} ewa_e57_limits;

/// One Data3D.
typedef struct ewa_e57_scan {
    uint64_t file_offset; ///< of the points
    uint64_t record_count;
    uint32_t first_field, field_count;
    bool has_points, has_pose;
    double rotation[4]; ///< quaternion w x y z
    double translation_world[3];
    ewa_e57_limits color[3], intensity;
} ewa_e57_scan;

/// What the XML part says.
typedef struct ewa_e57_contents {
    ewa_buffer scans, fields; ///< of ewa_e57_scan, ewa_e57_field
    uint32_t scan_count, field_count;
    uint64_t image_count;
    ewa_buffer guid, library, crs; ///< text
    size_t guid_bytes, library_bytes, crs_bytes;
} ewa_e57_contents;

static inline ewa_e57_scan *ewa_e57_scan_at(const ewa_e57_contents *contents, uint32_t index) {
    return (ewa_e57_scan *)contents->scans.data + index;
}

static inline ewa_e57_field *ewa_e57_fields_of(const ewa_e57_contents *contents, const ewa_e57_scan *scan) {
    return contents->fields.data ? (ewa_e57_field *)contents->fields.data + scan->first_field : NULL;
}

/// Reads the XML part: `size_bytes` bytes from a logical place. Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_e57_xml_read(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes,
                            ewa_e57_contents *contents);
void ewa_e57_contents_free(ewa_context *context, ewa_e57_contents *contents);

/// Records of a scan that lie in damaged pages: from `first` up to before `end`.
typedef struct ewa_e57_gap {
    uint64_t first, end;
} ewa_e57_gap;

/// The bits of one field, from record `record` of the stream on.
typedef struct ewa_e57_stream {
    ewa_buffer buffer;
    uint64_t byte_count; ///< held; 8 more can be read
    uint64_t first_bit;  ///< of the first record
    uint64_t taken_bits; ///< before the first byte held, of the whole field
} ewa_e57_stream;

/// The points of one scan that are being read.
typedef struct ewa_e57_streams {
    const ewa_e57_pages *pages;
    const ewa_e57_field *fields;
    uint32_t field_count, scan_number; ///< from 1
    uint64_t at, end;                  ///< logical places: of the next packet, behind the last
    uint64_t record, record_count;     ///< that comes next; of the scan
    uint64_t held_count;               ///< records at hand from there on
    ewa_e57_stream streams[EWA_E57_MAX_FIELDS];
    ewa_buffer packet, gaps;
    uint32_t gap_count;
} ewa_e57_streams;

/// Begins with a scan. `*record_count` gets how many of its points can be there; that some cannot is told
/// unless `quiet`. Errors: EWA_ERROR_FORMAT.
ewa_status ewa_e57_streams_open(const ewa_e57_pages *pages, const ewa_e57_contents *contents, uint32_t scan,
                                bool quiet, ewa_e57_streams *streams, uint64_t *record_count);

/// Steps over `held_count` records and gets the next at hand, about `maximum`; none at the end. Errors:
/// EWA_ERROR_FORMAT, EWA_ERROR_MEMORY.
ewa_status ewa_e57_streams_next(ewa_e57_streams *streams, uint64_t maximum);

/// Ends with a scan; the memory stays for the next one.
void ewa_e57_streams_free(ewa_context *context, ewa_e57_streams *streams);

/// Numbers of `count` records from record `first` of those at hand, as they are meant, plus `shift`, which is
/// added to the offset of scaled numbers: both may be large and their sum small.
void ewa_e57_numbers(const ewa_e57_streams *streams, uint32_t field, uint64_t first, uint32_t count,
                     double shift, double *numbers);

/// One attribute that the points get.
typedef struct ewa_e57_column {
    char name[EWA_NAME_BYTES];
    ewa_e57_role role; ///< of the first component
    ewa_type type;
    uint32_t component_count;
    double low, high; ///< of whole numbers
    bool is_float, is_double;
    bool lacking; ///< some scan has none
} ewa_e57_column;

enum { EWA_E57_MAX_COLUMNS = 512, EWA_E57_CHUNK_RECORDS = 1024 };

typedef struct ewa_e57_columns {
    ewa_e57_column columns[EWA_E57_MAX_COLUMNS];
    uint32_t count;
    double origin_world[3];
    ewa_coordinate_grid grid;
} ewa_e57_columns;

/// Which attributes the points of all scans together have. Errors: EWA_ERROR_FORMAT, EWA_ERROR_LIMIT.
ewa_status ewa_e57_columns_map(const ewa_cloud_source *source, const ewa_e57_contents *contents,
                               ewa_e57_columns *columns);

/// The field of a scan that has a role; -1: none.
int ewa_e57_find(const ewa_e57_contents *contents, const ewa_e57_scan *scan, ewa_e57_role role);

/// Whether a scan has coordinates, and whether these are spherical.
bool ewa_e57_has_place(const ewa_e57_contents *contents, const ewa_e57_scan *scan, bool *spherical);

/// What the colours of a scan count from and to; 255 or 65535 when they are to stay as they are.
ewa_e57_limits ewa_e57_color_range(const ewa_e57_contents *contents, const ewa_e57_scan *scan, int component);

/// How the points of one scan become attributes.
typedef struct ewa_e57_plan {
    const ewa_e57_columns *columns;
    const ewa_e57_scan *scan;
    uint32_t scan_index;
    int fields[EWA_E57_ROLES];              ///< -1: none
    int column_fields[EWA_E57_MAX_COLUMNS]; ///< of columns without a role
    bool spherical, may_drop;
    double turn[9], shift[3]; ///< position = turn * place + shift, from the origin
    bool moved;               ///< turn and shift are more than nothing
    double color_low[3], color_factor[3];
} ewa_e57_plan;

void ewa_e57_plan_make(const ewa_e57_contents *contents, const ewa_e57_columns *columns, uint32_t scan,
                       ewa_e57_plan *plan);

/// Lists which of the records at hand, from `first` up to before `end`, at most EWA_E57_CHUNK_RECORDS, are
/// points with a place; returns how many. `*lost_count` gets how many lie in damaged pages.
uint32_t ewa_e57_list(const ewa_e57_plan *plan, const ewa_e57_streams *streams, uint64_t first, uint64_t end,
                      uint16_t kept[EWA_E57_CHUNK_RECORDS], uint64_t *lost_count);

/// Moves the listed records to the sinks, behind the `to` points there.
void ewa_e57_move(const ewa_e57_plan *plan, const ewa_e57_streams *streams, uint64_t first,
                  const uint16_t *kept, uint32_t kept_count, const ewa_cloud_sink *sinks, uint64_t to);

#endif
