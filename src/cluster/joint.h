// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of several ranks, as one of them has it.
#ifndef EWA_SRC_CLUSTER_JOINT_H
#define EWA_SRC_CLUSTER_JOINT_H

#include "cluster/exchange.h"
#include "cluster/sources.h"
#include "cluster/tiles.h"
#include "surface/job.h"

/// What a reduction keeps from stage to stage besides its planes.
typedef struct ewa_joint_kept {
    uint32_t edge_rows[EWA_MAX_TILE_BLOCKS]; ///< blocks that had something behind, for the picture
    uint32_t open_rows[EWA_MAX_TILE_BLOCKS]; ///< blocks in which some pixel is still open
    uint32_t back_facing_rows[2][EWA_MAX_TILE_BLOCKS], cut_rows[2][EWA_MAX_TILE_BLOCKS];
    uint32_t finalized_rows[EWA_MAX_TILE_BLOCKS];
    bool layered;
} ewa_joint_kept;

/// Set-up splats of one contribution, kept from pass to pass.
typedef struct ewa_joint_tile_cache {
    ewa_tile_scratch scratch;
    ewa_edge_lists lists;
    bool kept;   ///< the runs of the first pass
    bool behind; ///< and those behind it
} ewa_joint_tile_cache;

/// Memory for tile caches; contributions without one are set up again for each pass.
#define EWA_JOINT_TILE_CACHE_BYTES ((size_t)256 << 20)

/// The state of a joint renderer.
typedef struct ewa_joint {
    ewa_context *context;
    ewa_exchange exchange;
    ewa_job_room room;
    ewa_joint_sources sources;
    ewa_joint_tiles tiles;
    ewa_messages messages;
    ewa_tile_scratch *scratch; ///< [worker]
    uint32_t worker_count;
    ewa_buffer rows, passed, given_keys, taken_keys, places; ///< of contributions sent and received
    ewa_buffer kept, planes, totals;                         ///< of reductions
    ewa_buffer packed, wave, pixels;
    ewa_buffer tile_caches; ///< ewa_joint_tile_cache, which keep their memory: of the first contributions
    uint32_t tile_cache_capacity; ///< tile caches that have been allocated
    uint32_t tile_cache_count;    ///< of the frame
    size_t tile_cache_bytes;      ///< as EWA_JOINT_TILE_CACHE_BYTES
    // Of the frame:
    ewa_tile_job job;
    size_t tile_floats;                                 ///< of all planes of a tile
    size_t pixel_lanes;                                 ///< of one plane of a tile
    uint32_t surface;                                   ///< 0: the first, 1: one behind
    bool whole;                                         ///< all that is left is one surface
    uint32_t (*contribution_rows)[EWA_MAX_TILE_BLOCKS]; ///< [share]: blocks in which some pixel is open
    size_t *contribution_places, *incoming_places;      ///< blocks of those before, of keys
    const void **incoming_sums;                         ///< [incoming]: as packed
    uint32_t wave_first, *active, active_count;         ///< contributions that are open
    size_t wave_bytes;                                  ///< of a contribution
} ewa_joint;

/// Finds the nearest of all ranks' splats in the open blocks of what is shared: on all ranks that have some,
/// and at the owners. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED, those of the exchange.
ewa_status ewa_joint_find_nearest(ewa_joint *joint);

/// Sums the splats of all ranks that reach the nearest, at the owners. Errors: the same.
ewa_status ewa_joint_gather(ewa_joint *joint);

/// Makes the surface of what was gathered, and tells the ranks what is still open. Errors: the same.
ewa_status ewa_joint_finalize(ewa_joint *joint);

/// Binds a worker to the planes of a reduction and restores what it keeps.
ewa_joint_kept *ewa_joint_take(ewa_joint *joint, uint32_t reduction, uint32_t worker, ewa_tile *tile);

/// Draws the tiles that are this rank's alone, or resolves its reductions. Errors: EWA_CANCELLED.
ewa_status ewa_joint_draw_alone(ewa_joint *joint);
ewa_status ewa_joint_resolve(ewa_joint *joint);

/// Brings the pixels of all tiles to the ranks that get the picture. Errors: EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_joint_collect(ewa_joint *joint);

#endif
