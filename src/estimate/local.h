// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the neighbourhood of each place of a block says about the surface and its sampling there.
#ifndef EWA_SRC_ESTIMATE_LOCAL_H
#define EWA_SRC_ESTIMATE_LOCAL_H

#include "cloud/neighbours.h"
#include "wide/isa.h"

/// Share of the variance along the normal above which a neighbourhood may be no surface.
#define LOCAL_SURFACE_VARIATION 0.11

/// Per lane of the block; lengths in the block's units.
typedef struct local_surface {
    _Alignas(64) float normal[3][EWA_BLOCK_LANES]; ///< unit; its largest component is positive
    float major[3][EWA_BLOCK_LANES];               ///< unit, tangential: where samples are sparsest
    float aspect[EWA_BLOCK_LANES];  ///< longer over shorter axis of the place's cell, 1 to LOCAL_MAX_ASPECT
    float spacing[EWA_BLOCK_LANES]; ///< 1 / sqrt(samples per area)
    float line_spacing[EWA_BLOCK_LANES]; ///< 1 / (neighbours per length), where thin
    /// How far the place's own cell reaches where it is closed: a disc of this radius covers it ...
    float reach[EWA_BLOCK_LANES];
    float corner[3][EWA_BLOCK_LANES]; ///< where that is, from the place; zeros where the cell is closed nowhere
    /// ... and an ellipse of the above axes whose shorter times longer axis is this squared does.
    float ellipse_reach[EWA_BLOCK_LANES];
    float radius[EWA_BLOCK_LANES];        ///< what size() makes of it
    uint8_t ratio[EWA_BLOCK_LANES];       ///< of radius to spacing, in the steps of local_sizing, rounded up
    float mean_distance[EWA_BLOCK_LANES]; ///< of the neighbours
    float variation[EWA_BLOCK_LANES];     ///< share of the variance along the normal, [0, 1/3]
    float lean[EWA_BLOCK_LANES];          ///< how far off the mean of the neighbours is, by enclose() only
    float median_spacing;                 ///< of the block's places
    uint32_t thin;                        ///< bits of the lanes whose neighbours are almost on a line
    uint32_t degenerate; ///< bits of the lanes without a plane: fewer than 3 places, or on one line
    /// Bits of the lanes whose neighbours do not tell how far the cell reaches: it is open, or they are no
    /// surface.
    uint32_t doubtful;
} local_surface;

enum {
    LOCAL_GRAPH_DEGREE = 8,
    LOCAL_MAX_ASPECT = 4,
    LOCAL_REACH = 1, ///< to be measured beside normal and spacing: reach, median_spacing, doubtful
    LOCAL_SHAPE = 2, ///< major, aspect, ellipse_reach, median_spacing, doubtful
};

/// How radii follow from reaches: ewa_radius() in single precision, for places of a surface.
typedef struct local_sizing {
    float scale;       ///< smallest radius in spacings
    float cover;       ///< radius that covers a reach of 1
    bool gaps_later;   ///< whether gaps are closed afterwards, by what kernels add up to there
    float thin_cover;  ///< the same as cover, where samples lie on a surface and gaps are closed afterwards
    float limit;       ///< in spacings of the place and in median ones
    float ratio_steps; ///< per 1 of radius over spacing
    float max_steps;   ///< at most 255
} local_sizing;

/// The nearest places of each lane other than its own, at most LOCAL_GRAPH_DEGREE, ascending; then
/// UINT32_MAX.
typedef uint32_t local_graph[EWA_BLOCK_LANES][LOCAL_GRAPH_DEGREE];

/// What a border is judged by; in the lane's units.
typedef struct local_sizes {
    _Alignas(64) float around[EWA_BLOCK_LANES]; ///< spacing of the places around
    float farthest[EWA_BLOCK_LANES];            ///< distance of the farthest neighbour
    float radius[EWA_BLOCK_LANES];              ///< of the place's disc
    float limit[EWA_BLOCK_LANES];               ///< of radii that close gaps
    float beyond[EWA_BLOCK_LANES]; ///< spacings from the outermost samples to the surface's end; 0: by how these lie
} local_sizes;

/// Where a surface ends: at a plane across it, so far from the place in a unit direction.
typedef struct local_border {
    _Alignas(64) float direction[3][EWA_BLOCK_LANES];
    float distance[EWA_BLOCK_LANES]; ///< > 0
} local_border;

/// Sixteen places and the discs around them, in one unit and from one origin.
typedef struct local_gaps {
    _Alignas(64) float corner[3][EWA_BLOCK_LANES]; ///< of the cell of each place, where a gap may be
    float reach2[EWA_BLOCK_LANES];                 ///< squared distance of that from the place; 0: there is none
    float radius[EWA_BLOCK_LANES], limit[EWA_BLOCK_LANES];
    uint32_t count; ///< of discs
    float x[EWA_BLOCK_CANDIDATES], y[EWA_BLOCK_CANDIDATES], z[EWA_BLOCK_CANDIDATES];
    /// Their radii; grow() leaves s of their kernels exp(-s distance^2) there.
    float kernel[EWA_BLOCK_CANDIDATES];
} local_gaps;

/// One neighbour of each lane, from its place.
typedef struct local_row {
    _Alignas(64) float x[EWA_BLOCK_LANES];
    float y[EWA_BLOCK_LANES], z[EWA_BLOCK_LANES], distance2[EWA_BLOCK_LANES], value[EWA_BLOCK_LANES];
    uint32_t place[EWA_BLOCK_LANES]; ///< by collect() only
} local_row;

/// A batch of places from any blocks, one per lane, each with its own neighbours, itself included, in units
/// of its block. What a lane gives does not depend on the others.
typedef struct local_batch {
    local_row row[EWA_BLOCK_CANDIDATES];
    double unit_world[EWA_BLOCK_LANES];
    uint32_t place[EWA_BLOCK_LANES];
    uint32_t count[EWA_BLOCK_LANES]; ///< of rows
    uint32_t lane_count;
    uint32_t row_count; ///< that measure() has left
} local_batch;

/// Sixteen places with up to LOCAL_GRAPH_DEGREE neighbours each; places and normals of those that are not there are 0.
typedef struct local_fans {
    _Alignas(64) float own[3][EWA_BLOCK_LANES];           ///< unit normal
    float way[LOCAL_GRAPH_DEGREE][3][EWA_BLOCK_LANES];    ///< to each neighbour, about 1 long at most
    float normal[LOCAL_GRAPH_DEGREE][3][EWA_BLOCK_LANES]; ///< of each, unit
} local_fans;

/// The hot loops, compiled once per instruction set, all with the same results.
typedef struct local_kernels {
    /// All but mean_distance; `reach` up to 2 spacings. Leaves the neighbours of all lanes in the rows of
    /// `batch`, of which nothing else counts.
    void (*measure)(const ewa_block *block, uint32_t wanted, local_batch *batch, local_surface *surface);
    /// Radii after measure() with the same `wanted`; what is at the limit is not doubtful any more if it is a
    /// surface.
    void (*size)(uint32_t wanted, const local_sizing *sizing, local_surface *surface);
    /// Adds lanes of a block (bits) with all their neighbours and the values of these (by place) to a batch,
    /// as many as it has room for; returns those that are left.
    uint32_t (*collect)(const ewa_block *block, uint32_t lanes, const float *values, local_batch *batch);
    /// The median of the values of each lane's neighbours and its own, to 1 / 256 of the ratio of the largest
    /// to the least, in logarithms; and the squared distance of the farthest neighbour.
    void (*median)(local_batch *batch, float around[EWA_BLOCK_LANES], float farthest2[EWA_BLOCK_LANES]);
    /// What measure() tells, by many neighbours: cells are closed up to `limit` (in the lane's units) where
    /// neighbours stand around them, in planes of these normals (NULL: of their own). No median_spacing,
    /// nothing doubtful.
    void (*enclose)(local_batch *batch, uint32_t wanted, const float normal[3][EWA_BLOCK_LANES],
                    const float limit[EWA_BLOCK_LANES], local_surface *surface);
    /// After enclose() of the same batch: finds the lanes (bits) whose discs reach over the end of the surface,
    /// and where that is. Leaves in x of the rows of these how far the neighbours are in its direction; of the
    /// rows nothing but that and `value` counts then.
    uint32_t (*border)(local_batch *batch, const local_surface *surface, const local_sizes *sizes,
                       local_border *border);
    void (*measure_distance)(const ewa_block *block, local_surface *surface); ///< mean_distance only
    /// After measure() of the same block.
    void (*link)(const ewa_block *block, const local_batch *batch, local_graph graph);
    /// The signed curvature of each lane (ewa/cloud.h), per length of its ways, and how far that is to be trusted, 0 to
    /// 1: by the squares of normals that it explains over those that are left.
    void (*curve)(const local_fans *fans, float curvature[EWA_BLOCK_LANES], float trust[EWA_BLOCK_LANES]);
    /// The radii that discs of this cutoff grow to where kernels add up to less than what is needed at the corner.
    void (*grow)(local_gaps *gaps, float needed, float cutoff, float grown[EWA_BLOCK_LANES]);
} local_kernels;

EWA_DECLARE_VERSIONS(const local_kernels, ewa_local_kernels);

#endif
