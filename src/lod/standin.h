// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels that stand for others: what they are, how they are made, and how good they are.
#ifndef EWA_SRC_LOD_STANDIN_H
#define EWA_SRC_LOD_STANDIN_H

#include "base/base.h"
#include "ewa/render.h"
#include "lod/lattice.h"

/// A surfel that takes part in merging, a point or what stands for some.
typedef struct ewa_standin {
    uint64_t code;      ///< Morton code of a place in its cell
    double at_world[3]; ///< from the root's corner
    float normal[3];
    float radius_world; ///< that keeps the area of what it stands for
    float color[3];     ///< linear, mean of what it stands for
    float alpha;
    float shown[3]; ///< linear, sharper than the mean (ewa_standins_judge())
} ewa_standin;

/// Surfels in the order of their codes.
typedef struct ewa_standins {
    ewa_standin *items;
    uint32_t count;
    size_t capacity_bytes;
    float radius_scale;  ///< of radii when they are drawn
    float unit_coverage; ///< what their kernels sum up to, at a scale of 1; 0: not known yet
} ewa_standins;

void ewa_standins_free(ewa_context *context, ewa_standins *standins);

/// Makes one surfel, or several where there are several sheets, for all of `fine` in each cell of `cell_level`: areas are
/// added, after radii of more than three times the median in the cell are cut to that; everything else is a mean by
/// area. `merged` is zero-initialised or used before. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_standins_merge(ewa_context *context, const ewa_standin *fine, uint32_t count,
                              uint32_t cell_level, ewa_standins *merged);

/// What ewa_standins_judge() works with; all of it is kept from call to call.
typedef struct ewa_judge {
    ewa_context *context;
    ewa_renderer *renderer;
    bool lit;           ///< there are no colours: light tells the surfels apart
    ewa_buffer grid;    ///< cells of a cube: first surfel in each
    ewa_buffer blurred; ///< colours of the neighbourhood
    ewa_buffer chosen;  ///< surfels of a window, as streams
    ewa_buffer pictures;
} ewa_judge;

ewa_status ewa_judge_make(ewa_context *context, bool lit, ewa_judge *judge);
void ewa_judge_free(ewa_judge *judge);

/// Measures what the kernels of surfels sum up to where they cover (q0 of docs/math.md section 7). Errors: EWA_ERROR_MEMORY.
ewa_status ewa_standins_cover(ewa_judge *judge, const ewa_standins *standins, float *unit_coverage);

/// Chooses how the surfels of a cube are drawn, radii as they are or narrower and colours as they are or sharpened, by
/// pictures of a part of it beside those of its parts: sets `merged`'s radius_scale and unit_coverage and its items'
/// shown colours. `*error` is the root of the mean square of what remains, in 1/255 of the range of sRGB, where the surfels
/// are half a pixel apart. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_standins_judge(ewa_judge *judge, const ewa_standins *parts, uint32_t part_count,
                              const ewa_octree_key *key, double side_world, ewa_standins *merged,
                              float *error);

#endif
