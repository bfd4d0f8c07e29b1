// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// An open LAS or LAZ file: what comes before its points, read and checked, and the attributes that they get.
#ifndef EWA_SRC_LAS_OPEN_H
#define EWA_SRC_LAS_OPEN_H

#include "io/las/las.h"
#include "io/las/laz_chunks.h"

typedef struct ewa_las_file {
    const ewa_cloud_source *source;
    ewa_las_header header;
    ewa_las_table table;
    uint64_t point_count; ///< of files without compression
    ewa_laz_layout layout;
    ewa_laz_stream *stream; ///< NULL: not compressed
} ewa_las_file;

/// Opens a source and gives the prototype its attributes, origin, grid and notes. Close with
/// ewa_las_file_close(), also after a failure. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_las_file_open(const ewa_cloud_source *source, ewa_cloud *prototype, ewa_las_file *file);
void ewa_las_file_close(ewa_las_file *file);

/// What colours have been so far: many files hold 8-bit colours in their 16 bits, either as they are or with
/// the byte twice.
typedef struct ewa_las_color_look {
    const ewa_las_column *color;
    uint32_t record_bytes;
    uint32_t any;            ///< bits that are set in one of them
    bool is_single, is_wide; ///< one has two bytes that differ; one is neither equal twice nor below 256
} ewa_las_color_look;

/// Looks at the colours of records; `look` is an ewa_las_color_look. Returns whether no others change what they are.
bool ewa_las_look(void *look, const uint8_t *records, uint64_t count);

/// Chooses the type of the colours of a table that has some. Colours of which all were looked at, and which are all 0,
/// are none.
void ewa_las_colors_choose(const ewa_cloud_source *source, const ewa_las_color_look *look, bool is_all,
                           ewa_las_table *table);

/// Gives a prototype the attributes of a table, and origin and grid. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_las_lay_out(const ewa_las_table *table, const double offset_world[3], ewa_cloud *prototype);

#endif
