// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// An octree in the making, wherever its regions come from.
#ifndef EWA_SRC_LOD_ASSEMBLE_H
#define EWA_SRC_LOD_ASSEMBLE_H

#include "ewa/lod.h"
#include "lod/region.h"

/// A region, as the order of making them needs it.
typedef struct ewa_lod_region {
    ewa_octree_key key;
    uint64_t point_count;
} ewa_lod_region;

typedef struct ewa_lod_builder ewa_lod_builder;
struct ewa_lod_builder {
    ewa_context *context;
    ewa_region_plan plan;
    const ewa_lod_region *regions; ///< in the order of codes
    uint32_t region_count;
    /// Makes a region, or fetches it from where it was made.
    ewa_status (*get)(ewa_lod_builder *b, uint32_t index, ewa_region_result *result);
    ewa_lod_build_stats stats;
    ewa_spool *blocks; ///< of all pages
    ewa_buffer pages;  ///< ewa_levels_page
    uint32_t page_count;
    ewa_buffer above[EWA_CODE_LEVELS]; ///< records of points of the nodes above all regions
    uint32_t above_counts[EWA_CODE_LEVELS];
};

/// Opens the file's writer and the evaluator of representatives; free the evaluator and abort the writer,
/// also after a failure.
ewa_status ewa_lod_prepare(ewa_lod_builder *b, const char *out, ewa_evaluator *evaluator);

/// Makes the whole file. `b` has a plan, regions and get().
ewa_status ewa_lod_write(ewa_lod_builder *b, const char *out);

#endif
