// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// All points put aside by regions: cubes of the tree whose points fit in memory together, each with the points around it that
// neighbours are looked for among.
#ifndef EWA_SRC_LOD_SPREAD_H
#define EWA_SRC_LOD_SPREAD_H

#include "io/spool.h"
#include "lod/survey.h"

/// One of the two streams of a region.
typedef struct ewa_spread_stream {
    uint64_t *blocks; ///< places in the spool
    size_t block_count, block_capacity_bytes;
    uint8_t *buffer; ///< what is in no block yet
    uint32_t filled; ///< bytes of it
    uint64_t count;  ///< records
} ewa_spread_stream;

/// A cube of the tree.
typedef struct ewa_region {
    ewa_octree_key key;
    uint64_t first_prefix, end_prefix; ///< of the survey's cells in it
    uint64_t point_count;
    bool wanted;
    ewa_spread_stream own;    ///< records of its points
    ewa_spread_stream around; ///< places of points beside it
} ewa_region;

typedef struct ewa_spread {
    ewa_context *context;
    const ewa_survey *survey;
    ewa_region *regions; ///< in the order of codes
    uint32_t region_count;
    size_t region_capacity_bytes;
    uint32_t *region_of;             ///< [cell of the survey]
    uint32_t *beside_first, *beside; ///< [cell of the survey]: other regions that have a cell next to it
    uint32_t beside_count;
    size_t beside_capacity_bytes;
    ewa_spool *spool;
} ewa_spread;

/// Divides the survey's cells into regions of at most `most_points` points and puts the points of all inputs aside;
/// only those of regions `i` with i mod `subset_count` = `subset`. Free with ewa_spread_free(), also after a failure. Errors:
/// as ewa_inputs_read(); EWA_ERROR_LIMIT (a cell of too many points), EWA_ERROR_FORMAT (other points than the survey saw).
ewa_status ewa_spread_make(const ewa_inputs *inputs, const ewa_survey *survey, const char *beside,
                           uint64_t most_points, uint32_t subset, uint32_t subset_count, ewa_spread *spread);
void ewa_spread_free(ewa_spread *spread);

/// Reads a stream, one record after the other, into `records`, which has room for all, and frees it.
ewa_status ewa_spread_read(ewa_spread *spread, ewa_spread_stream *stream, uint32_t record_bytes,
                           uint8_t *records);

enum {
    EWA_AROUND_BYTES = 3 * sizeof(uint32_t)
}; ///< of a record of points around: the place from the root's corner

#endif
