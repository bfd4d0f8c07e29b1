// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A band of a frame on its way to the device: which packets are in which of its fields, and what the host is asked for:
// surfels that are drawn by pixel rays, clip lines, lists of work.
#ifndef EWA_SRC_GL_BAND_H
#define EWA_SRC_GL_BAND_H

#include "gl/scene.h"
#include "surface/tile.h"

/// Pairs that one dispatch sets up: of one page of a source.
typedef struct ewa_gl_batch {
    uint32_t source, page, first_pair, pair_count;
} ewa_gl_batch;

/// Some splats of a tile, or some near surfels of its field.
typedef struct ewa_gl_unit {
    uint32_t tile, first, end, near;
} ewa_gl_unit;

/// A packet in a field, as the set-up reads it; of its page, and of the whole source.
typedef struct ewa_gl_pair {
    uint32_t packet, field;
} ewa_gl_pair;

/// A band of rows, and its memory, which survives it. Zero-initialise.
typedef struct ewa_gl_band {
    uint32_t first_row_px, end_row_px;           ///< in the picture, from a multiple of EWA_FIELD_PX
    uint32_t width_px, height_px;                ///< whole blocks
    uint32_t tile_px, tiles_per_row, tile_count; ///< of work
    ewa_buffer batches, pairs, places, words, ids, units, starts, nears, near_starts, clips, clipped, masks,
        counts;
    uint32_t batch_count, pair_count, unit_count, near_count, clip_count;
    uint64_t list_count;
} ewa_gl_band;

/// How many pairs the rows of fields [first, end) have.
uint64_t ewa_gl_band_pairs(const ewa_tile_job *job, uint32_t first_field_row, uint32_t end_field_row);

/// Sets the band's place and lists its pairs, with what the set-up reads of each; `page_packets[source]` is how many packets
/// a page of it has. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_band_start(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job,
                             uint32_t first_row_px, uint32_t end_row_px, uint32_t tile_px,
                             const uint32_t *page_packets);

/// Makes the near records and clip lines that band->masks ask for, after the set-up. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_band_answer(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job);

/// Makes units of at most `maximum` splats of the tiles, whose counts are band->counts, and sets where their
/// lists start.
/// Errors: EWA_ERROR_MEMORY.
ewa_status ewa_gl_band_divide(ewa_context *context, ewa_gl_band *band, const ewa_tile_job *job,
                              uint32_t maximum);

void ewa_gl_band_free(ewa_context *context, ewa_gl_band *band);

#endif
