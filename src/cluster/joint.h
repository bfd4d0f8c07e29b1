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

/// What a meeting keeps from stage to stage beside its planes.
typedef struct ewa_joint_kept {
    uint32_t edge_rows[EWA_MAX_TILE_BLOCKS]; ///< blocks that had something behind, for the picture
    uint32_t open_rows[EWA_MAX_TILE_BLOCKS]; ///< blocks in which some pixel is still open
    uint32_t turned_rows[2][EWA_MAX_TILE_BLOCKS], cut_rows[2][EWA_MAX_TILE_BLOCKS];
    uint32_t settled_rows[EWA_MAX_TILE_BLOCKS];
    bool layered;
} ewa_joint_kept;

/// Where a share keeps its splats from pass to pass.
typedef struct ewa_joint_desk {
    ewa_tile_scratch scratch;
    ewa_edge_lists lists;
    bool kept;   ///< the runs of the first pass
    bool behind; ///< and those behind it
} ewa_joint_desk;

/// Memory for desks; what finds no room is set up anew for each pass.
#define EWA_JOINT_DESK_BYTES ((size_t)256 << 20)

/// The state of a joint renderer.
typedef struct ewa_joint {
    ewa_context *context;
    ewa_exchange exchange;
    ewa_job_room room;
    ewa_joint_sources sources;
    ewa_joint_tiles tiles;
    ewa_mail mail;
    ewa_tile_scratch *scratch; ///< [worker]
    uint32_t worker_count;
    ewa_buffer rows, passed, given_keys, taken_keys, places; ///< of shares and parts
    ewa_buffer kept, planes, totals;                         ///< of meetings
    ewa_buffer packed, wave, pixels;
    ewa_buffer desks;    ///< ewa_joint_desk, which keep their memory: of the first shares
    uint32_t desk_room;  ///< desks that have been used
    uint32_t desk_count; ///< of the frame
    size_t desk_bytes;   ///< as EWA_JOINT_DESK_BYTES
    // Of the frame:
    ewa_tile_job job;
    size_t tile_floats;                          ///< of all planes of a tile
    size_t pixel_lanes;                          ///< of one plane of a tile
    uint32_t surface;                            ///< 0: the first, 1: one behind
    bool whole;                                  ///< all that is left is one surface
    uint32_t (*share_rows)[EWA_MAX_TILE_BLOCKS]; ///< [share]: blocks in which some pixel is open
    size_t *share_places, *part_places;          ///< blocks of those before, of keys
    const void **part_sums;                      ///< [part]: as packed
    uint32_t wave_first, *active, active_count;  ///< shares that are open
    size_t wave_bytes;                           ///< of a share
} ewa_joint;

/// Finds the nearest of all ranks' splats in the open blocks of what is shared: on all ranks that have some, and
/// at the meetings. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED, those of the exchange.
ewa_status ewa_joint_find_nearest(ewa_joint *joint);

/// Sums the splats of all ranks that reach the nearest, at the meetings. Errors: the same.
ewa_status ewa_joint_gather(ewa_joint *joint);

/// Makes the surface of what was gathered, and tells the ranks what is still open. Errors: the same.
ewa_status ewa_joint_settle(ewa_joint *joint);

/// Points a worker at the planes of a meeting and brings what it keeps.
ewa_joint_kept *ewa_joint_take(ewa_joint *joint, uint32_t meeting, uint32_t worker, ewa_tile *tile);

/// Draws the tiles that are this rank's alone, or resolves its meetings. Errors: EWA_CANCELLED.
ewa_status ewa_joint_draw_alone(ewa_joint *joint);
ewa_status ewa_joint_resolve(ewa_joint *joint);

/// Brings the pixels of all tiles to the ranks that get the picture. Errors: EWA_ERROR_MEMORY, those of the exchange.
ewa_status ewa_joint_collect(ewa_joint *joint);

#endif
