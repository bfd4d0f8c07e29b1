// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What a LAS file says before its points: the public header, the variable length records, and which numbers
// of a record make up which attribute.
//
// Based on: ASPRS, "LAS Specification 1.4 - R15", 2019, and "LAS Specification 1.5", 2025.
#ifndef EWA_SRC_LAS_H
#define EWA_SRC_LAS_H

#include "io/cloud/format.h"
#include "io/reader.h"

#include <string.h>

enum {
    EWA_LAS_MAX_FORMAT = 10,
    EWA_LAS_MAX_COLUMNS = 512, ///< attributes of one file
    EWA_LAS_RETURNS = 15,
    EWA_LAS_HEAD_BYTES = 227,     ///< of the public header of LAS 1.2
    EWA_LAS_HEAD_14_BYTES = 375,  ///< of LAS 1.4
    EWA_LAS_RECORD_BYTES = 54,    ///< of the head of a variable length record
    EWA_LAS_EXTENDED_BYTES = 60,  ///< of an extended one
    EWA_LAS_EXTRA_BYTES = 192,    ///< of what describes one field of extra bytes
    EWA_LAS_EXTRA_NAME_BYTES = 32 ///< of its name
};

/// Bits of the global encoding.
enum { EWA_LAS_WKT = 1u << 4 };

/// The notes that carry what only LAS has from file to file: records as they stand in the file, and, as
/// decimal text, the bits of the global encoding and the point format.
#define EWA_LAS_NOTE_RECORDS  "las.vlrs"
#define EWA_LAS_NOTE_ENCODING "las.global_encoding"
#define EWA_LAS_NOTE_FORMAT   "las.point_format"

/// Little-endian numbers anywhere in memory.
static inline uint16_t ewa_las_u16(const uint8_t *bytes) { return (uint16_t)(bytes[0] | bytes[1] << 8); }
static inline uint64_t ewa_las_u64(const uint8_t *bytes) {
    return ewa_bytes_u32(bytes) | (uint64_t)ewa_bytes_u32(bytes + 4) << 32;
}
static inline double ewa_las_f64(const uint8_t *bytes) {
    const uint64_t bits = ewa_las_u64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
static inline void ewa_las_put_u16(uint8_t *bytes, uint16_t value) {
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8);
}
static inline void ewa_las_put_u32(uint8_t *bytes, uint32_t value) {
    ewa_las_put_u16(bytes, (uint16_t)value);
    ewa_las_put_u16(bytes + 2, (uint16_t)(value >> 16));
}
static inline void ewa_las_put_u64(uint8_t *bytes, uint64_t value) {
    ewa_las_put_u32(bytes, (uint32_t)value);
    ewa_las_put_u32(bytes + 4, (uint32_t)(value >> 32));
}
static inline void ewa_las_put_f64(uint8_t *bytes, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    ewa_las_put_u64(bytes, bits);
}

/// The public header, checked.
typedef struct ewa_las_header {
    uint8_t version_minor, point_format;
    bool compressed;
    uint16_t global_encoding, day, year;
    uint16_t head_bytes, record_bytes;
    uint32_t vlr_count, evlr_count;
    uint64_t points_at, evlrs_at;
    uint64_t point_count; ///< as it is written, of the two counts the one that is set
    double scale[3], offset[3], low[3], high[3];
    const uint8_t *system, *software; ///< 32 bytes each
} ewa_las_header;

/// Bytes of a record of a point format without extra bytes.
uint16_t ewa_las_format_bytes(uint8_t point_format);

/// Reads and checks the header of a source that begins with "LASF". Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_UNSUPPORTED.
ewa_status ewa_las_header_read(const ewa_cloud_source *source, ewa_las_header *header);

/// A variable length record or an extended one.
typedef struct ewa_las_vlr {
    const uint8_t *head;  ///< as it stands in the file
    const uint8_t *bytes; ///< NULL: longer than what is read of a file that comes in parts
    uint64_t at_bytes, size_bytes;
    uint16_t id;
    bool extended;
} ewa_las_vlr;

/// A walk over the records of a file. Zero-initialise.
typedef struct ewa_las_walk {
    uint64_t at_bytes;
    uint32_t seen_count; ///< of the kind that is walked
    bool extended;       ///< the extended ones have begun
    const char *fault;   ///< why the walk of a kind ended before its last record; NULL: nothing
} ewa_las_walk;

/// Steps to the next record that lies within the file; false after the last.
bool ewa_las_walk_next(const ewa_cloud_source *source, const ewa_las_header *header, ewa_las_walk *walk,
                       ewa_las_vlr *vlr);

/// Whether a record is this one.
bool ewa_las_vlr_is(const ewa_las_vlr *vlr, const char *user, uint16_t id);

/// Finds the first record of that name; false when there is none.
bool ewa_las_find(const ewa_cloud_source *source, const ewa_las_header *header, const char *user, uint16_t id,
                  ewa_las_vlr *vlr);

/// Copies text of a fixed field up to its first zero without blanks at its end; what is no printable ASCII
/// becomes '?'. `to` has room for one byte more than `size_bytes`.
void ewa_las_text(const uint8_t *bytes, size_t size_bytes, char *to);

/// What the records say about the coordinate reference system.
typedef struct ewa_las_crs {
    const uint8_t *wkt;
    uint64_t wkt_bytes;
    const uint8_t *keys, *texts; ///< GeoTIFF
    uint64_t keys_bytes, texts_bytes;
} ewa_las_crs;

/// Takes what a record says, if it is one of these; returns whether it is.
bool ewa_las_crs_take(ewa_las_crs *crs, const ewa_las_vlr *vlr);

enum { EWA_LAS_NAME_BYTES = 256 };

/// Writes the system and its name for people, zero-terminated; the texts are empty when nothing is known.
/// `*text` is released as `*text_bytes` bytes by the caller. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_crs_text(ewa_context *context, const ewa_las_crs *crs, bool prefer_wkt, char **text,
                            size_t *text_bytes, char name[EWA_LAS_NAME_BYTES]);

/// Adds the notes "crs", "crs_name" and "crs_unit", as far as there is something to say. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_crs_note(ewa_context *context, const ewa_las_crs *crs, bool prefer_wkt, ewa_cloud *prototype);

/// Adds the notes of ewa/cloud.h about a file. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_notes(const ewa_cloud_source *source, const ewa_las_header *header, ewa_cloud *prototype);

/// How numbers of a record become those of an attribute.
typedef enum ewa_las_kind {
    EWA_LAS_POSITION, ///< three whole numbers of 32 bits less `first`, times `scale`
    EWA_LAS_BITS,     ///< `mask` bits from bit `shift` of a byte
    EWA_LAS_RANK,     ///< a signed byte of degrees
    EWA_LAS_ANGLE,    ///< 16 bits of 0.006 degrees
    EWA_LAS_COLOR,    ///< 16 bits, of which `color_shift` and more are cut off for 8 bits
    EWA_LAS_PLAIN,    ///< as it is: `type`
    EWA_LAS_WIDE,     ///< 64-bit integers as doubles
    EWA_LAS_SCALED,   ///< raw numbers, times a scale plus an offset, or with a mark for no data
} ewa_las_kind;

/// Types of extra bytes as LAS numbers them.
typedef enum ewa_las_raw {
    EWA_LAS_RAW_BYTES = 0,
    EWA_LAS_U8,
    EWA_LAS_I8,
    EWA_LAS_U16,
    EWA_LAS_I16,
    EWA_LAS_U32,
    EWA_LAS_I32,
    EWA_LAS_U64,
    EWA_LAS_I64,
    EWA_LAS_F32,
    EWA_LAS_F64,
} ewa_las_raw;

/// One attribute of the points of a file.
typedef struct ewa_las_column {
    char name[EWA_NAME_BYTES];
    ewa_las_kind kind;
    ewa_type type;
    uint32_t component_count;
    uint16_t at_bytes[4]; ///< of each component in the record
    uint8_t shift, mask;
    ewa_las_raw raw;
    double scale[4], offset[4], missing[4];
    bool marked; ///< `missing` stands for no data
} ewa_las_column;

/// The attributes of the points of a file and what they are computed with.
typedef struct ewa_las_table {
    uint32_t column_count;
    ewa_las_column columns[EWA_LAS_MAX_COLUMNS];
    uint32_t record_bytes;
    int64_t first[3];     ///< whole numbers of the origin
    double scale[3];      ///< world units a step
    uint32_t color_shift; ///< 8-bit colours are the numbers shifted right by this
    uint32_t color_at;    ///< column of the colours; column_count: none
} ewa_las_table;

/// Fills the table with the attributes of a point format without extra bytes.
void ewa_las_table_begin(uint8_t point_format, ewa_las_table *table);

/// Returns the attribute of that name, NULL when there is none.
ewa_las_column *ewa_las_table_find(ewa_las_table *table, const char *name);

/// Returns the name that component `component` of an attribute of three numbers has among extra bytes, NULL
/// when it has none of its own.
const char *ewa_las_part_name(const char *attribute, uint32_t component);

/// Returns the name that an attribute of one number has among extra bytes.
const char *ewa_las_alias(const char *attribute);

/// Bytes of a number of extra bytes.
uint32_t ewa_las_raw_bytes(ewa_las_raw raw);

/// Gives a column the type of numbers that are taken as they are, those of 64 bits as doubles.
void ewa_las_column_number(ewa_las_raw raw, ewa_las_column *column);

/// Makes fields such as NormalX NormalY NormalZ the one attribute that they are parts of, "alpha" a part of the
/// colour, and gives fields such as "Radius" the name of their attribute.
void ewa_las_table_join(ewa_las_table *table);

/// Fills the table from the header and the record of extra bytes. Errors: none, but what is left out is
/// reported as a warning.
void ewa_las_table_make(const ewa_cloud_source *source, const ewa_las_header *header, ewa_las_table *table);

/// Fills sinks, one per column, from records that lie one after the other. Returns how many colours were
/// above 255 although their type has 8 bits; those become 255.
uint64_t ewa_las_unpack(const ewa_las_table *table, const uint8_t *records, uint64_t count,
                        const ewa_cloud_sink *sinks);

#endif
