// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Discs around the gaps of irregular sampling, enlarged until their kernels close these (docs/math.md section 7).
#ifndef EWA_SRC_ESTIMATE_GAPS_H
#define EWA_SRC_ESTIMATE_GAPS_H

#include "estimate/borders.h"
#include "estimate/local.h"

#include "ewa/prepare.h"

/// Steps of a spacing in which corners are noted.
#define GAP_CORNER_STEPS 8192

/// Blocks in whose cells there may be gaps, with the places around them.
typedef struct gap_chunk gap_chunk;

/// What is known of places, by place; lengths are in world units.
typedef struct gap_set {
    ewa_context *context;
    uint32_t place_count, worker_count;
    /// The farthest corner of each cell from its place, in spacings over GAP_CORNER_STEPS; zeros where there is none.
    int16_t (*corner)[3];
    float *radius;      ///< of discs
    gap_chunk **chunks; ///< of each worker, the last one first
    float needed;       ///< that kernels of peak 1 are to add up to
    _Atomic bool failed; ///< memory was missing
} gap_set;

/// Errors: EWA_ERROR_MEMORY. To be freed in any case.
ewa_status ewa_gaps_make(ewa_context *context, uint32_t place_count, gap_set *made);
void ewa_gaps_free(gap_set *set);

/// Notes the corners of a block's cells, those of lanes in `again` (bits) as none yet, and whether there may be gaps in
/// it. Each worker, for any block once, after measure() and size(). Where memory is missing ewa_gaps_close() says so.
void ewa_gaps_note(gap_set *set, const ewa_block *block, const local_surface *surface, uint32_t again, uint32_t worker);

/// Sets where the farthest corner of a place's cell is, as measure() and enclose() say of a lane, by the spacing in the
/// lane's units; 0: nowhere.
void ewa_gaps_set_corner(gap_set *set, uint32_t place, const local_surface *surface, uint32_t lane, double spacing);

/// Sets what is needed by the notes of radii (RADIUS_*), while these are those of all places.
void ewa_gaps_need(gap_set *set, const uint8_t *notes, double cutoff);

/// What gaps are closed by.
typedef struct gap_input {
    const ewa_estimate_options *options;
    const ewa_neighbours *neighbours;
    const local_kernels *kernels;
    const border_set *borders;
    const float *spacing;  ///< by place
    const uint8_t *strewn; ///< by place: of those that are not 0 no disc grows
    float *radius;         ///< by point
} gap_input;

/// Enlarges discs and hands the radii of all places to their points. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_gaps_close(gap_set *set, const gap_input *input);

#endif
