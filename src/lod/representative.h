// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Level-of-detail representatives: surfels that represent several finer ones, how they are merged, and how
// large their error is.
#ifndef EWA_SRC_LOD_REPRESENTATIVE_H
#define EWA_SRC_LOD_REPRESENTATIVE_H

#include "base/base.h"
#include "ewa/render.h"
#include "lod/lattice.h"

/// A surfel that takes part in merging: a point, or a representative of several.
typedef struct ewa_representative {
    uint64_t code;      ///< Morton code of a place in its cell
    double at_world[3]; ///< from the root's corner
    float normal[3];
    float radius_world; ///< that keeps the area of what it represents
    float color[3];     ///< linear, mean of what it represents
    float alpha;
    float curvature; ///< signed, 1 / world unit; 0: none is known
    float shown[3]; ///< linear, sharper than the mean (ewa_representatives_evaluate())
} ewa_representative;

/// Surfels in the order of their codes.
typedef struct ewa_representatives {
    ewa_representative *items;
    uint32_t count;
    size_t capacity_bytes;
    float radius_scale;  ///< of radii when they are drawn
    float unit_coverage; ///< what their kernels sum up to, at a scale of 1; 0: not known yet
    double *numbers;     ///< [count][number_count], of their attributes
    uint32_t number_count;
    size_t numbers_capacity_bytes;
} ewa_representatives;

void ewa_representatives_free(ewa_context *context, ewa_representatives *representatives);

/// Makes room for `count` surfels with `number_count` numbers each; what was there is lost. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_representatives_reserve(ewa_context *context, ewa_representatives *representatives, uint32_t count,
                                       uint32_t number_count);

/// Makes one surfel, or several where there are several sheets, for all of `fine` in each cell of `cell_level`: areas are
/// added, after radii of more than three times the median in the cell are cut to that; everything else is a mean by
/// area, but of numbers only those whose bit of `means` is set: others are that of most area. Surfels whose numbers `code_index` differ are not
/// merged, unless there are too many of these in a cell; UINT32_MAX: all are. `merged` is zero-initialised or used before. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_representatives_merge(ewa_context *context, const ewa_representatives *fine, uint32_t cell_level,
                                     uint32_t means, uint32_t code_index, ewa_representatives *merged);

/// Working memory of ewa_representatives_evaluate(), kept from call to call.
typedef struct ewa_evaluator {
    ewa_context *context;
    ewa_renderer *renderer;
    bool lit;           ///< there are no colours: light tells the surfels apart
    ewa_buffer grid;    ///< cells of a node: first surfel in each
    ewa_buffer blurred; ///< colours of the neighbourhood
    ewa_buffer chosen;  ///< surfels of a window, as streams
    ewa_buffer pictures;
} ewa_evaluator;

ewa_status ewa_evaluator_make(ewa_context *context, bool lit, ewa_evaluator *evaluator);
void ewa_evaluator_free(ewa_evaluator *evaluator);

/// Measures what the kernels of surfels sum up to where they cover (q0 of docs/math.md section 7). Errors: EWA_ERROR_MEMORY.
ewa_status ewa_representatives_cover(ewa_evaluator *evaluator, const ewa_representatives *representatives,
                                     float *unit_coverage);

/// Chooses how the surfels of a node are drawn, with radii as they are or narrower and colours as they are or
/// sharpened, by comparing pictures of a part of it with those of its children: sets `merged`'s radius_scale
/// and unit_coverage and its items' shown colours. `*error` is the root of the mean square of what remains,
/// in 1/255 of the range of sRGB, where the surfels are half a pixel apart. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_representatives_evaluate(ewa_evaluator *evaluator, const ewa_representatives *children,
                                        uint32_t child_count, const ewa_octree_key *key, double side_world,
                                        ewa_representatives *merged, float *error);

#endif
