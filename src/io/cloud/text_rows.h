// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points that stand one per line of text: lines are read in chunks, side by side, straight to where the points
// go; what lines without a point leave open is closed afterwards, so that the points are the same for any
// number of threads.
#ifndef EWA_SRC_TEXT_ROWS_H
#define EWA_SRC_TEXT_ROWS_H

#include "base/base.h"
#include "io/cloud/format.h"
#include "io/text.h"

enum { EWA_ROWS_CHUNK_BYTES = 1 << 17, EWA_ROWS_MAX_COLUMNS = 256 };

/// Whole lines of text that one task reads.
typedef struct ewa_rows_chunk {
    const char *at, *end;
    uint64_t row_count; ///< never more points than this come
    uint32_t part;      ///< of the file, as the format counts them
} ewa_rows_chunk;

/// Why a line is no point.
typedef enum ewa_rows_fault {
    EWA_ROWS_NUMBER = 0, ///< a word is no number
    EWA_ROWS_RANGE,      ///< a number that the attribute cannot hold
    EWA_ROWS_SHORT,      ///< the line ends too early
    EWA_ROWS_LONG,       ///< words behind the last column
} ewa_rows_fault;

/// What became of a chunk.
typedef struct ewa_rows_result {
    uint64_t point_count;   ///< points that were read
    uint64_t nowhere_count; ///< lines without a place: left out
    uint64_t bad_count;     ///< lines that are damaged, of which this is the first:
    const char *bad_at;
    uint32_t bad_column; ///< from 1
    ewa_rows_fault fault;
    const char *after; ///< first byte that was not looked at
} ewa_rows_result;

/// Reads lines of a chunk up to the one of point number `maximum` + 1, into the sinks from point `first` on;
/// a sink that is not wanted has `to` NULL. Any thread.
typedef void ewa_rows_read_chunk(const void *format, const ewa_rows_chunk *chunk, uint64_t maximum,
                                 const ewa_cloud_sink *sinks, uint64_t first, ewa_rows_result *result);

/// The lines of a file and how far they are read. Zero-initialise; ewa_rows_close() frees.
typedef struct ewa_rows {
    const ewa_cloud_source *source;
    ewa_cursor text; ///< of the whole file
    char *owned;     ///< text that is not the file's own
    size_t owned_bytes;
    char line_end; ///< byte that ends a line, '\n' or '\r'
    ewa_buffer chunks;
    uint64_t chunk_count, next_chunk;
    ewa_rows_read_chunk *read_chunk;
    const void *format; ///< of read_chunk
    uint32_t attribute_count;
    const size_t *attribute_bytes; ///< of a point
    uint64_t nowhere_count;
    const char *counted_to; ///< lines before this are counted:
    uint64_t counted_lines;
} ewa_rows;

/// Returns the byte that ends the lines of a text: '\r' where the first line has that alone, else '\n'.
char ewa_rows_end_of_lines(ewa_cursor text);

/// Opens the text of a source. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_rows_open(ewa_rows *rows, const ewa_cloud_source *source);
void ewa_rows_close(ewa_rows *rows);

/// Appends a chunk.
ewa_status ewa_rows_add(ewa_rows *rows, const ewa_rows_chunk *chunk);

/// Returns the number of a line, from 1; cheap when places come in the order of the file.
uint64_t ewa_rows_line(ewa_rows *rows, const char *place);

/// Does what ewa_cloud_format.read() has to do.
ewa_status ewa_rows_read(ewa_rows *rows, uint64_t maximum, const ewa_cloud_sink *sinks, uint64_t *got_count);

/// Returns the end of the line at `at`, at most `end`.
static inline const char *ewa_rows_line_end(const ewa_rows *rows, const char *at) {
    const char *found = memchr(at, rows->line_end, (size_t)(rows->text.end - at));
    return found ? found : rows->text.end;
}

#endif
