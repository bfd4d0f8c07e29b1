// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the neighbourhood of each place of a block says about the surface and its sampling there.
#ifndef EWA_SRC_PREPARE_LOCAL_H
#define EWA_SRC_PREPARE_LOCAL_H

#include "cloud/neighbours.h"

/// Per lane of the block; lengths in the block's units.
typedef struct local_surface {
    _Alignas(64) float normal[3][EWA_BLOCK_LANES]; ///< unit; its largest component is positive
    float major[3][EWA_BLOCK_LANES];               ///< unit, tangential: where samples are sparsest
    float aspect[EWA_BLOCK_LANES];  ///< longer over shorter axis of the place's cell, 1 to LOCAL_MAX_ASPECT
    float spacing[EWA_BLOCK_LANES]; ///< 1 / sqrt(samples per area)
    /// How far the place's own cell reaches, at most 2 spacings (6 with LOCAL_LINES): a disc of this radius
    /// covers it ...
    float reach[EWA_BLOCK_LANES];
    /// ... and an ellipse of the above axes whose shorter times longer axis is this squared does.
    float ellipse_reach[EWA_BLOCK_LANES];
    float mean_distance[EWA_BLOCK_LANES]; ///< of the neighbours
    float variation[EWA_BLOCK_LANES];     ///< share of the variance along the normal, [0, 1/3]
    uint32_t thin;                        ///< bits of the lanes whose neighbours are almost on a line
    uint32_t degenerate; ///< bits of the lanes without a plane: fewer than 3 places, or on one line
} local_surface;

enum {
    LOCAL_GRAPH_DEGREE = 8,
    LOCAL_MAX_ASPECT = 4,
    LOCAL_REACH = 1, ///< to be measured beside normal and spacing: reach
    LOCAL_SHAPE = 2, ///< major, aspect, ellipse_reach
    LOCAL_LINES = 4, ///< lets cells reach further: samples on lines far from each other
};

/// The nearest places of each lane other than its own, at most LOCAL_GRAPH_DEGREE, ascending; then
/// UINT32_MAX.
typedef uint32_t local_graph[EWA_BLOCK_LANES][LOCAL_GRAPH_DEGREE];

/// The hot loops, compiled once per instruction set, all with the same results.
typedef struct local_kernels {
    void (*measure)(const ewa_block *block, uint32_t wanted, local_surface *surface);
    void (*measure_distance)(const ewa_block *block, local_surface *surface); ///< mean_distance only
    void (*link)(const ewa_block *block, local_graph graph);
} local_kernels;

extern const local_kernels ewa_local_kernels_portable;
#if defined(__x86_64__)
extern const local_kernels ewa_local_kernels_avx2, ewa_local_kernels_avx512;
#endif

/// Returns the fastest ones that this machine and the context's mask allow.
const local_kernels *ewa_local_kernels(const ewa_context *context);

#endif
