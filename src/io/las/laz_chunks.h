// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The chunks of a LAZ file: where they lie, and their records, decoded by all workers.
#ifndef EWA_SRC_LAZ_CHUNKS_H
#define EWA_SRC_LAZ_CHUNKS_H

#include "io/las/las_check.h"
#include "io/las/laz.h"

enum { EWA_LAZ_VLR_ID = 22204 };
#define EWA_LAZ_VLR_USER "laszip encoded"

/// How LASzip packs records.
enum { EWA_LAZ_POINTWISE = 1, EWA_LAZ_CHUNKED = 2, EWA_LAZ_LAYERED = 3 };

/// Number of points of a chunk that says: each has its own.
#define EWA_LAZ_VARIABLE UINT32_MAX

/// What the LASzip record and the table of chunks say.
typedef struct ewa_laz_layout {
    ewa_laz_plan plan;
    ewa_laz_chunk *chunks;
    uint64_t *at_bytes; ///< of each chunk
    uint64_t chunk_count;
    uint64_t point_count; ///< of all chunks
    uint8_t version_major, version_minor;
    uint16_t packing;
    bool variable;
    bool cut; ///< the last chunk is layered and lacks its end
} ewa_laz_layout;

/// Reads the LASzip record and the table of chunks, and checks that all chunks lie within the file. Free with
/// ewa_laz_layout_free(), also after a failure. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED,
/// EWA_ERROR_MEMORY.
ewa_status ewa_laz_layout_read(const ewa_cloud_source *source, const ewa_las_header *header,
                               ewa_laz_layout *layout);
void ewa_laz_layout_free(ewa_context *context, ewa_laz_layout *layout);

/// No point takes less than 1 / 2048 byte: the arithmetic coder's surest symbol costs more.
enum { EWA_LAZ_MAX_POINTS_PER_BYTE = 2048 };

/// Finds the chunks of a file without a table, from byte `first` on, by walking through them; what is not there is damage
/// (ewa_cloud_damage()). `layout` has its plan; chunks of variable sizes have to be layered. Errors: EWA_ERROR_FORMAT,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_laz_layout_rebuild(const ewa_cloud_source *source, uint64_t first, uint64_t point_count,
                                  uint32_t chunk_points, ewa_laz_layout *layout);

/// Decodes chunks in the order of the file.
typedef struct ewa_laz_stream ewa_laz_stream;

/// Begins; `layout` stays the caller's and must outlive the stream. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_laz_stream_open(const ewa_cloud_source *source, const ewa_laz_layout *layout,
                               ewa_laz_stream **stream);

/// Decodes some chunks that are spread over the file and calls `look` for their records, one chunk after the
/// other; they are not decoded again later. Of a file that comes in parts, none after `look` returned true; no points are read of
/// such a stream. Returns whether these are all points. Chunks that are damaged are stepped over. Errors: EWA_ERROR_MEMORY, those of
/// ewa_ranges_need().
ewa_status ewa_laz_stream_sample(ewa_laz_stream *stream,
                                 bool (*look)(void *user, const uint8_t *records, uint64_t count), void *user,
                                 bool *is_all);

/// Reads the next points, at most `maximum`, into sinks as ewa_cloud_format.read(); adds them to what
/// was seen.
ewa_status ewa_laz_stream_read(ewa_laz_stream *stream, const ewa_las_table *table, uint64_t maximum,
                               const ewa_cloud_sink *sinks, uint64_t *got_count, ewa_las_seen *seen);

/// Frees the stream; accepts NULL.
void ewa_laz_stream_close(ewa_laz_stream *stream);

#endif
