// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One region of the tree made: its nodes' points in the form of the file, what represents the points of its
// nodes, and what it gives to the nodes above it.
#ifndef EWA_SRC_LOD_REGION_H
#define EWA_SRC_LOD_REGION_H

#include "io/levels.h"
#include "lod/distribution.h"
#include "lod/representative.h"

/// What all regions are made by.
typedef struct ewa_region_plan {
    ewa_context *context;
    const ewa_statistics *statistics;
    const ewa_cloud *inputs;         ///< prototype of the points that are read
    ewa_cloud *output;               ///< prototype of those that are written
    bool makes_normals, makes_radii, makes_curvatures; ///< they are estimated; borders with radii
    uint32_t record_bytes;           ///< of a point with what is estimated behind it
    uint32_t normal_at_bytes, radius_at_bytes, curvature_at_bytes, border_at_bytes;
    ewa_octree_writer *writer; ///< encodes nodes
    ewa_evaluator *evaluator;
    ewa_level_attribute attributes[EWA_LEVELS_MAX_ATTRIBUTES]; ///< that representatives have
    uint32_t attribute_count, attribute_means;                 ///< whose numbers are means: a bit each
    uint32_t attribute_code;                                  ///< whose codes representatives do not mix; UINT32_MAX: none's
    uint32_t leaf_count; ///< pages that are not divided, of the region so far
    double estimate_s, merge_s, encode_s;
} ewa_region_plan;

/// Makes the prototype of the output; `attributes` as in ewa_lod_build_options. Free with ewa_region_plan_free(), also after a
/// failure. Errors: EWA_ERROR_ARGUMENT (attributes), EWA_ERROR_MEMORY.
ewa_status ewa_region_plan_make(ewa_context *context, const ewa_statistics *statistics,
                                const ewa_cloud *inputs, const char *attributes, ewa_region_plan *plan);
void ewa_region_plan_free(ewa_region_plan *plan);

/// Points as records, in the order of their codes.
typedef struct ewa_region_points {
    uint32_t count;
    uint64_t *codes;
    uint8_t *records;
    size_t capacity; ///< points that there is room for
} ewa_region_points;

/// What becomes of a region, or of the nodes above all regions.
typedef struct ewa_region_result {
    ewa_buffer chunks; ///< ewa_octree_chunk
    uint32_t chunk_count;
    ewa_buffer pages; ///< ewa_levels_page, whose blocks lie in `blocks`
    uint32_t page_count;
    ewa_buffer blocks;
    size_t blocks_bytes;
    ewa_buffer above[EWA_CODE_LEVELS]; ///< [level]: records of points for the nodes above
    uint32_t above_counts[EWA_CODE_LEVELS];
    ewa_representatives representatives; ///< of the region's node
} ewa_region_result;

void ewa_region_result_free(ewa_context *context, ewa_region_result *result);

/// Makes a region of a distribution.
ewa_status ewa_region_make(ewa_region_plan *plan, ewa_distribution *distribution, ewa_region *region,
                           ewa_region_result *result);

/// Makes the page of a node from those of its children, 8 at most: what represents it replaces
/// `*representatives`, and its block and entry are added to the result.
ewa_status ewa_region_page(ewa_region_plan *plan, const ewa_octree_key *key, uint64_t point_count,
                           const ewa_representatives *children, uint32_t child_count,
                           ewa_region_result *result, ewa_representatives *representatives);

/// Encodes points, which are records in the order of their codes, as the nodes of a level.
ewa_status ewa_region_encode(ewa_region_plan *plan, const uint8_t *records, uint32_t count, uint32_t level,
                             ewa_region_result *result);

#endif
