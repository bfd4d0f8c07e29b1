// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// All points distributed to regions: subtrees whose points fit in memory together, each with the points
// around it that neighbours are searched among.
#ifndef EWA_SRC_LOD_DISTRIBUTION_H
#define EWA_SRC_LOD_DISTRIBUTION_H

#include "io/spool.h"
#include "lod/statistics.h"

/// One of the two streams of a region.
typedef struct ewa_region_stream {
    uint64_t *blocks; ///< places in the spool
    size_t block_count, block_capacity_bytes;
    uint8_t *buffer; ///< what is in no block yet
    uint32_t filled; ///< bytes of it
    uint64_t count;  ///< records
} ewa_region_stream;

/// A subtree.
typedef struct ewa_region {
    ewa_octree_key key;
    uint64_t first_prefix, end_prefix; ///< of the statistics' cells in it
    uint64_t point_count;
    bool wanted;
    ewa_region_stream own;    ///< records of its points
    ewa_region_stream around; ///< places of points beside it
} ewa_region;

typedef struct ewa_distribution {
    ewa_context *context;
    const ewa_statistics *statistics;
    ewa_region *regions; ///< in the order of codes
    uint32_t region_count;
    size_t region_capacity_bytes;
    uint32_t *region_of; ///< [cell of the statistics]
    uint32_t *adjacent_first,
        *adjacent; ///< [cell of the statistics]: other regions that have a cell next to it
    uint32_t adjacent_count;
    size_t adjacent_capacity_bytes;
    ewa_spool *spool;
} ewa_distribution;

/// Divides the statistics' cells into regions of at most `max_points` points and spools the points of all
/// inputs; only those of regions `i` with i mod `subset_count` = `subset`. Free with ewa_distribution_free(),
/// also after a failure. Errors: as ewa_inputs_read(); EWA_ERROR_LIMIT (a cell of too many points),
/// EWA_ERROR_FORMAT (other points than the statistics have).
ewa_status ewa_distribution_make(ewa_inputs *inputs, const ewa_statistics *statistics,
                                 const char *output_path, uint64_t max_points, uint32_t subset,
                                 uint32_t subset_count, ewa_distribution *distribution);
void ewa_distribution_free(ewa_distribution *distribution);

/// Reads a stream, one record after the other, into `records`, which has room for all, and frees it.
ewa_status ewa_distribution_read(ewa_distribution *distribution, ewa_region_stream *stream,
                                 uint32_t record_bytes, uint8_t *records);

enum {
    EWA_AROUND_BYTES = 3 * sizeof(uint32_t)
}; ///< of a record of points around: the place from the root's corner

#endif
