// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs of a tile's packets.
#ifndef EWA_SRC_SURFACE_TILE_RUNS_H
#define EWA_SRC_SURFACE_TILE_RUNS_H

#include "base/base.h"
#include "surface/tile.h"

static inline uint64_t ewa_run_count(const ewa_tile_packets *packets) {
    return (packets->count + EWA_RUN_PACKETS - 1) / EWA_RUN_PACKETS;
}

/// Whether the frame is still wanted. What is left of a tile may be left out if not.
static inline bool ewa_tile_goes_on(const ewa_tile_job *job, const ewa_tile_scratch *scratch) {
    return ewa_goes_on(job->context, (uint32_t)(scratch - job->scratch));
}

/// Whether a source takes part in a pass.
static inline bool ewa_takes_part(const ewa_tile_source *source, ewa_tile_pass what) {
    return source->hides || (what != EWA_PASS_VISIBILITY && what != EWA_PASS_EDGE_VISIBILITY);
}

/// Forgets the runs that are kept.
void ewa_tile_drop_runs(ewa_tile_scratch *scratch);

/// Replaces the depth `from` by `to` in so many blocks of a plane like ewa_tile.nearest. Where no source that hides
/// has a surface (-infinity), nothing is to be summed: that is so while the depth is infinite.
void ewa_tile_close_pixels(float *nearest, uint32_t block_count, float from, float to);

/// Sets up runs [first, end) and keeps them behind those that are kept, as many as there is room for; with
/// `draw`, for the first pass. Returns where it stopped.
uint64_t ewa_tile_keep_runs(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                            const ewa_tile_packets *packets, uint64_t first, uint64_t end, bool draw);

/// Second pass, or the one back from it, over the runs that the first pass has kept.
void ewa_tile_walk_kept(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch, ewa_tile_pass what);

/// One pass over runs [first, end), set up for it and forgotten.
void ewa_tile_walk_again(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch,
                         const ewa_tile_packets *packets, uint64_t first, uint64_t end, ewa_tile_pass what);

/// Second pass, or the one back from a surface, over the splats that may be seen; `kept`: over the runs that are kept.
void ewa_tile_walk_shown(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *scratch, bool kept,
                         ewa_tile_pass what);

/// One pass for near surfels.
void ewa_tile_draw_near(const ewa_tile_job *job, const ewa_tile_source *source, const ewa_tile *tile,
                        const ewa_edges *edges, const uint32_t *surfels, uint32_t count, ewa_tile_pass what);

#endif
