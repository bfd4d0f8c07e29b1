// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Rings of corners that a text tells one after the other.
#ifndef EWA_SRC_POLYGON_H
#define EWA_SRC_POLYGON_H

#include "base/base.h"
#include "io/text.h"

/// The rings so far. Free the buffers with the context's ewa_buffer_free().
typedef struct ewa_rings {
    ewa_context *context;
    const char *name; ///< stands for the text in messages
    ewa_buffer corners, counts;
    uint64_t corner_count; ///< of all rings, the open one too
    uint32_t ring_count;
    uint32_t open_count; ///< corners of the ring that is not closed
} ewa_rings;

/// Adds a corner to the open ring. Errors: EWA_ERROR_FORMAT (not finite), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_rings_add(ewa_rings *rings, double x, double y);

/// Closes the open ring, if it has corners; the last one is dropped when it is the first again. Errors:
/// EWA_ERROR_FORMAT (fewer than three corners), EWA_ERROR_MEMORY.
ewa_status ewa_rings_close(ewa_rings *rings);

/// Adds the polygons of GeoJSON: of a geometry, a feature, or a collection of these.
ewa_status ewa_rings_read_json(ewa_rings *rings, ewa_text text);

#endif
