// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PCD, the files of the Point Cloud Library: what header, columns, text and packed data have in common.
//
// By: Point Cloud Library, "The PCD (Point Cloud Data) file format", versions .5 to .7.
#ifndef EWA_SRC_PCD_H
#define EWA_SRC_PCD_H

#include "io/cloud/format.h"
#include "io/text.h"

enum {
    EWA_PCD_MAX_FIELDS = 512,
    EWA_PCD_MAX_COLUMNS = 1024,
    EWA_PCD_MAX_RECORD_BYTES = 1 << 20,
};

typedef enum ewa_pcd_data {
    EWA_PCD_ASCII,
    EWA_PCD_BINARY,
    EWA_PCD_COMPRESSED, ///< one field after the other, packed by LZF
} ewa_pcd_data;

/// One field: `count` numbers per point.
typedef struct ewa_pcd_field {
    ewa_text name;
    char kind; ///< F float, I signed, U unsigned
    uint32_t size_bytes, count;
    bool padding; ///< bytes that mean nothing
    /// Number e of point i is at base_bytes + e * size_bytes + i * stride_bytes of the records.
    uint64_t base_bytes, stride_bytes;
} ewa_pcd_field;

typedef struct ewa_pcd_header {
    ewa_text version;
    ewa_pcd_field fields[EWA_PCD_MAX_FIELDS];
    uint32_t field_count;
    uint64_t width, height, point_count;
    double viewpoint[7]; ///< place x y z, rotation w x y z
    ewa_pcd_data data;
    uint64_t data_at_bytes;
    uint64_t data_line;    ///< number of the first line of data, from 1
    uint32_t value_count;  ///< numbers per point, padding included
    uint32_t record_bytes; ///< of one point
} ewa_pcd_header;

/// Reads and checks the header. Errors: EWA_ERROR_FORMAT, EWA_ERROR_LIMIT.
ewa_status ewa_pcd_header_read(const ewa_cloud_source *source, ewa_pcd_header *header);

/// Places the fields in records of one point each, one after the other.
void ewa_pcd_lay_out(ewa_pcd_header *header);

/// Where the numbers of one attribute come from.
typedef struct ewa_pcd_column {
    char attribute[EWA_NAME_BYTES];
    ewa_type type;
    uint32_t component_count;
    bool packed; ///< colour as 0xAARRGGBB
    const ewa_pcd_field *sources[4];
    uint32_t elements[4]; ///< which number of the field
} ewa_pcd_column;

/// The attributes that the fields become; the first is the position. Errors: EWA_ERROR_FORMAT (no position),
/// EWA_ERROR_LIMIT.
ewa_status ewa_pcd_columns_map(const ewa_cloud_source *source, const ewa_pcd_header *header,
                               ewa_pcd_column columns[EWA_PCD_MAX_COLUMNS], uint32_t *column_count);

/// Records at hand and what becomes of them.
typedef struct ewa_pcd_records {
    const uint8_t *bytes;
    const ewa_pcd_column *columns;
    uint32_t column_count;
    bool all_finite; ///< known: every position is
} ewa_pcd_records;

/// Counts the points from `first` up to before `end` whose position is finite.
uint64_t ewa_pcd_count(const ewa_pcd_records *records, uint64_t first, uint64_t end);

/// Moves the points from `first` up to before `end` whose position is finite to the sinks, at most `maximum`,
/// behind the `to` points there; returns the point to go on with. `*moved` gets how many were.
uint64_t ewa_pcd_move(const ewa_pcd_records *records, uint64_t first, uint64_t end,
                      const ewa_cloud_sink *sinks, uint64_t to, uint64_t maximum, uint64_t *moved);

/// What colours mean that the header does not say.
typedef struct ewa_pcd_colors {
    uint8_t alpha_bits;   ///< all that are set in any packed alpha
    uint16_t number_bits; ///< the same of 16-bit colours
} ewa_pcd_colors;

/// Adds what the colours of the points from `first` up to before `end` show.
void ewa_pcd_look(const ewa_pcd_records *records, uint64_t first, uint64_t end, ewa_pcd_colors *colors);

/// Whether the columns have colours that ewa_pcd_look() looks at.
bool ewa_pcd_needs_look(const ewa_pcd_column *columns, uint32_t column_count);

/// Leaves out alpha that is 0 everywhere, as PCL writes it when nobody set it; makes 16-bit colours that are
/// all below 256, and not all 0, colours of 8 bits.
void ewa_pcd_settle(const ewa_pcd_colors *colors, ewa_pcd_column *columns, uint32_t column_count);

/// Unpacks LZF to exactly `to_bytes` bytes; false when the bytes are not that. Reads and writes nothing
/// beyond.
bool ewa_lzf_unpack(const uint8_t *from, uint64_t from_bytes, uint8_t *to, uint64_t to_bytes);

enum { EWA_LZF_MAX = 88 }; ///< bytes that one of LZF can become, at most: 3 become 264

/// Text that is being read.
typedef struct ewa_pcd_text ewa_pcd_text;

/// Begins to read text. Where single precision would lose digits of the coordinates, the position's fields and
/// its column become doubles. `*invalid_count` gets how many points have a position that is not finite.
/// Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_pcd_text_open(const ewa_cloud_source *source, ewa_pcd_header *header, ewa_pcd_column *columns,
                             uint32_t column_count, ewa_pcd_text **text, uint64_t *invalid_count);

/// As read() of ewa_cloud_format.
ewa_status ewa_pcd_text_read(ewa_pcd_text *text, uint64_t maximum, const ewa_cloud_sink *sinks,
                             uint64_t *got_count);

/// Frees the text and sets `*text` to NULL; accepts a pointer to NULL.
void ewa_pcd_text_close(ewa_pcd_text **text);

#endif
