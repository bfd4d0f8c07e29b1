// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Chunks of LAZ: raw LAS point records in, compressed bytes out, and back. A chunk stands for itself, so
// that chunks can be coded by several threads and a damaged one costs only its own points.
//
// Based on: M. Isenburg, "LASzip: lossless compression of LiDAR data", PE&RS 79(2) 2013; rapidlasso, "LAZ
// Specification 1.4".
#ifndef EWA_SRC_LAZ_H
#define EWA_SRC_LAZ_H

#include "base/base.h"

enum {
    EWA_LAZ_MAX_ITEMS = 16,
    EWA_LAZ_MAX_RECORD_BYTES = 65535,
    EWA_LAZ_MAX_EXTRA_BYTES = 8192, ///< of one item BYTE or BYTE14: each has models of its own, of a kilobyte
};

/// Types of items as LASzip numbers them.
typedef enum ewa_laz_item_type {
    EWA_LAZ_BYTE = 0,
    EWA_LAZ_POINT10 = 6,
    EWA_LAZ_GPSTIME11 = 7,
    EWA_LAZ_RGB12 = 8,
    EWA_LAZ_WAVEPACKET13 = 9,
    EWA_LAZ_POINT14 = 10,
    EWA_LAZ_RGB14 = 11,
    EWA_LAZ_RGBNIR14 = 12,
    EWA_LAZ_WAVEPACKET14 = 13,
    EWA_LAZ_BYTE14 = 14,
} ewa_laz_item_type;

/// One part of a record.
typedef struct ewa_laz_item {
    uint16_t type;       ///< ewa_laz_item_type
    uint16_t size_bytes; ///< in the raw record
    uint16_t version;    ///< 1, 2 (flat items), 3, 4 (layered items)
} ewa_laz_item;

/// How the records of a file are coded.
typedef struct ewa_laz_plan {
    uint32_t item_count;
    ewa_laz_item items[EWA_LAZ_MAX_ITEMS];
    uint32_t record_bytes; ///< sum of the items
    bool layered;          ///< items of version 3 and 4
} ewa_laz_plan;

/// Checks the items that a file names and completes the plan; returns NULL, or what is wrong, a text that
/// stays.
const char *ewa_laz_plan_check(ewa_laz_plan *plan);

/// Fills the plan by which the points of a format are written: items of version 2 for the formats 0 to 5, 3
/// for 6 to 10, and bytes that are left over.
void ewa_laz_plan_make(uint8_t point_format, uint32_t record_bytes, ewa_laz_plan *plan);

/// What cut chunks may lack.
typedef enum ewa_laz_field {
    EWA_LAZ_FIELD_CLASSIFICATION,
    EWA_LAZ_FIELD_FLAGS,
    EWA_LAZ_FIELD_INTENSITY,
    EWA_LAZ_FIELD_ANGLE,
    EWA_LAZ_FIELD_USER,
    EWA_LAZ_FIELD_SOURCE,
    EWA_LAZ_FIELD_TIME,
    EWA_LAZ_FIELD_COLOR,
    EWA_LAZ_FIELD_INFRARED,
    EWA_LAZ_FIELD_WAVE,
    EWA_LAZ_FIELD_EXTRA,
    EWA_LAZ_FIELD_COUNT,
} ewa_laz_field;

/// What a chunk came to.
typedef struct ewa_laz_result {
    uint64_t point_count; ///< of the records that were decoded before the fault; all of them without one
    const char *fault;    ///< what is wrong, a text that stays; NULL: nothing
    uint64_t used_bytes;  ///< of a flat chunk, up to the end of its last point
    uint64_t poor_count;  ///< of a cut layered chunk: points that lack fields
    uint32_t lost_fields; ///< which, a bit for each ewa_laz_field
} ewa_laz_result;

/// Decodes the `point_count` records of one chunk, whose bytes are [bytes, bytes + size_bytes), into
/// `records`, one after the other. Reads nothing beyond the bytes. Any thread; `memory` is the worker's own,
/// kept from chunk to chunk, zero-initialised before the first and given to ewa_laz_memory_free() at the end.
/// Errors: EWA_ERROR_MEMORY; what is wrong with the bytes is in `*result`.
typedef struct ewa_laz_memory ewa_laz_memory;
ewa_status ewa_laz_decode(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *bytes,
                          uint64_t size_bytes, uint64_t point_count, uint8_t *records,
                          ewa_laz_memory **memory, ewa_laz_result *result);

/// The same for what is there of a layered chunk whose end is missing: as many points as have positions. What else is
/// missing of them becomes 0; the result says what and of how many points.
ewa_status ewa_laz_decode_cut(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *bytes,
                              uint64_t size_bytes, uint64_t point_count, uint8_t *records,
                              ewa_laz_memory **memory, ewa_laz_result *result);

/// Encodes `point_count` records as one chunk, appended to `to` from byte `*at_bytes` on, which steps behind
/// it, by a plan of ewa_laz_plan_make(). The same bytes as LASzip gives for the same records. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_laz_encode(ewa_context *context, const ewa_laz_plan *plan, const uint8_t *records,
                          uint64_t point_count, ewa_buffer *to, size_t *at_bytes, ewa_laz_memory **memory);

void ewa_laz_memory_free(ewa_context *context, ewa_laz_memory **memory);

/// One chunk of a file.
typedef struct ewa_laz_chunk {
    uint64_t point_count, size_bytes;
} ewa_laz_chunk;

/// Decodes the table of `chunk_count` chunks that stands behind its head of 8 bytes; `variable`: with a
/// number of points each, else only sizes are set. Returns NULL, or what is wrong.
const char *ewa_laz_table_decode(const uint8_t *bytes, uint64_t size_bytes, uint32_t chunk_count,
                                 bool variable, ewa_laz_chunk *chunks);

/// Encodes that table, head included, appended like a chunk. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_laz_table_encode(ewa_context *context, const ewa_laz_chunk *chunks, uint32_t chunk_count,
                                bool variable, ewa_buffer *to, size_t *at_bytes);

#endif
