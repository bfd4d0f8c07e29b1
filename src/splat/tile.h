// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile from its packets to its pixels.
#ifndef EWA_SRC_SPLAT_TILE_H
#define EWA_SRC_SPLAT_TILE_H

#include "splat/bin.h"
#include "splat/view.h"

/// A run of a tile whose splats are kept for the second pass.
typedef struct ewa_kept_run {
    ewa_sorted_run sorted;
    uint32_t near_first, near_count;
    uint32_t hit_first, hit_count; ///< splats on edges, in ewa_tile_scratch.hits
} ewa_kept_run;

/// What one worker needs for its tiles; sized once per frame by ewa_tile_scratch_reserve().
typedef struct ewa_tile_scratch {
    ewa_run run;
    ewa_record *records;
    ewa_load *loads;
    uint16_t *order, *hits;
    uint32_t *near_surfels;
    ewa_kept_run *kept;
    size_t record_capacity;
    float *nearest, *sums;
    ewa_edges edges;
    ewa_buffer record_buffer, load_buffer, order_buffer, hit_buffer, near_buffer, kept_buffer, pixel_buffer;
    uint32_t edge_rows[EWA_MAX_TILE_BLOCKS], edge_rows_left[EWA_MAX_TILE_BLOCKS];
    uint64_t drawn_count, fragment_count;
    double setup_s, visibility_s, accumulate_s, edge_s, resolve_s;
} ewa_tile_scratch;

/// What all tiles of a frame share.
typedef struct ewa_tile_job {
    const ewa_road_kernels *kernels;
    const ewa_surfels *surfels;
    const ewa_bins *bins;
    ewa_view view;
    ewa_resolve resolve;
    uint32_t channel_count, edge_layers;
    bool with_normals, with_depth, count_fragments;
    ewa_tile_scratch *const *scratch; ///< [worker]
} ewa_tile_job;

/// Makes room for tiles of `largest_bin` packets; allocates nothing once warm.
ewa_status ewa_tile_scratch_reserve(ewa_context *context, ewa_tile_scratch *scratch, const ewa_tile_job *job,
                                    uint64_t largest_bin);
void ewa_tile_scratch_free(ewa_context *context, ewa_tile_scratch *scratch);

/// Draws tile `tile`; an ewa_task.
void ewa_tile_draw(void *job, uint32_t tile, uint32_t worker);

#endif
