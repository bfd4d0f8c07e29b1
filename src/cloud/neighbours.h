// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Exact nearest neighbours of all points of a cloud, a block of 16 at a time.
#ifndef EWA_SRC_CLOUD_NEIGHBOURS_H
#define EWA_SRC_CLOUD_NEIGHBOURS_H

#include "ewa/cloud.h"

enum {
    EWA_BLOCK_LANES = 16,       ///< places that are searched together
    EWA_NEIGHBOURS_MAX = 64,    ///< largest k
    EWA_BLOCK_CANDIDATES = 1024 ///< candidates that one block holds
};

/// The distinct finite positions ("places") of a cloud, in Morton order, under a tree of boxes.
typedef struct ewa_neighbours ewa_neighbours;

/// Builds the tree over `count` positions (three components, any type), which may go away afterwards.
/// Errors: EWA_ERROR_MEMORY. Holds about 25 bytes per point, needs 38 while it is built.
ewa_status ewa_neighbours_create(ewa_context *context, const ewa_attribute *position, uint32_t count,
                                 ewa_neighbours **made);
void ewa_neighbours_destroy(ewa_neighbours **neighbours);

/// Returns the number of distinct finite positions.
uint32_t ewa_neighbours_place_count(const ewa_neighbours *neighbours);

/// Returns the number of points with finite coordinates: those that are at some place.
uint32_t ewa_neighbours_finite_count(const ewa_neighbours *neighbours);

/// Returns the points (indices into the input) at one place, ascending, and how many they are.
const uint32_t *ewa_neighbours_points(const ewa_neighbours *neighbours, uint32_t place, uint32_t *count);

/// Writes the positions of `count` places from `first` on. Not after ewa_neighbours_end_visits().
void ewa_neighbours_positions(const ewa_neighbours *neighbours, uint32_t first, uint32_t count,
                              double (*position)[3]);

/// Returns the coordinates of all places, x, y and z, where single precision holds them; else NULL: they are anchored at
/// boxes. Not after ewa_neighbours_end_visits().
const float *const *ewa_neighbours_offsets(const ewa_neighbours *neighbours);

/// Up to 16 places and all their neighbours. Lanes from lane_count up repeat lane 0. Candidates are in the
/// order of places, each in the neighbourhood of some lane; each lane's own place is among them.
///
/// Lengths are in units of `unit_world`, a power of two near the size of the block. Positions of F32 are
/// otherwise exact, so that squared distances are those that plain float arithmetic gives; others are rounded
/// to 24 bits relative to the block.
typedef struct ewa_block {
    _Alignas(64) float lane_x[EWA_BLOCK_LANES];
    float lane_y[EWA_BLOCK_LANES], lane_z[EWA_BLOCK_LANES];
    float radius2[EWA_BLOCK_LANES]; ///< squared distance of the k-th nearest place: its neighbourhood is all
                                    ///< candidates with distance2 <= radius2, ties included
    float distance2[EWA_BLOCK_CANDIDATES][EWA_BLOCK_LANES]; ///< of each candidate from each lane
    float x[EWA_BLOCK_CANDIDATES + EWA_BLOCK_LANES], y[EWA_BLOCK_CANDIDATES + EWA_BLOCK_LANES],
        z[EWA_BLOCK_CANDIDATES + EWA_BLOCK_LANES];
    uint32_t place[EWA_BLOCK_CANDIDATES + EWA_BLOCK_LANES];
    uint32_t candidate_count;
    uint32_t first_place, lane_count; ///< lane i is place first_place + i
    double unit_world;
} ewa_block;

/// Receives one block; `worker` as in ewa_task. The block is valid during the call.
typedef void ewa_block_visit(void *user, const ewa_block *block, uint32_t worker);

/// Which neighbourhoods to visit.
typedef struct ewa_visit_choice {
    uint32_t neighbour_count; ///< k, the place itself not counted; 1 to EWA_NEIGHBOURS_MAX; less when places
                              ///< are few
    uint32_t sample_step;  ///< 1 for all places; n visits about every n-th block only, the same for every run
    const uint8_t *chosen; ///< NULL for all; else by place: of each block at least the places whose entries
                           ///< are set, and maybe others between them
    const char *stage;     ///< for the progress callback
    uint8_t chosen_bits;   ///< of an entry of `chosen` that count; 0: all
    const float *spacing;  ///< NULL; else by place: of the sampling, which tells how far to look;
                           ///< changes no result
} ewa_visit_choice;

/// Visits neighbourhoods, each once, from all workers.
///
/// A neighbourhood depends on the places alone, not on threads nor instruction sets. Only when more than
/// 1,024 places are equally far does it lose some of them. Errors: EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_neighbours_visit(const ewa_neighbours *neighbours, const ewa_visit_choice *choice,
                                ewa_block_visit *visit, void *user);

/// Gives back the memory that only visits need; places keep their points.
void ewa_neighbours_end_visits(ewa_neighbours *neighbours);

#endif
