// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the set-up of a band asks the host for, because it takes double precision: records of surfels that are drawn by pixel
// rays, and clip lines.
#ifndef EWA_SRC_GL_HOST_RECORDS_H
#define EWA_SRC_GL_HOST_RECORDS_H

#include "gl/scene.h"
#include "surface/tile.h"

/// What the host made for a band, and its memory, which survives the band. Zero-initialise.
typedef struct ewa_gl_host_records {
    ewa_buffer requests; ///< ewa_gl_host_request: near surfels, then those with clip lines
    ewa_buffer nears;    ///< ewa_gl_near, by field
    ewa_buffer ranges;   ///< [field of the band]: first, end of its nears
    ewa_buffer clips;    ///< ewa_gl_clip, in the order of the requests
    uint32_t near_count, clip_count, field_count;
} ewa_gl_host_records;

/// Makes room for requests. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_host_records_reserve(ewa_context *context, ewa_gl_host_records *host_records, uint32_t near_count,
                                       uint32_t clip_count);

/// Makes what is requested of a band that begins at a row of fields. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_host_records_make(ewa_context *context, ewa_gl_host_records *host_records, const ewa_tile_job *job,
                                    uint32_t first_field_row, uint32_t field_rows);

void ewa_gl_host_records_free(ewa_context *context, ewa_gl_host_records *host_records);

#endif
