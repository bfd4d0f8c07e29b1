// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Statistics of all points, gathered in one pass: the root's cube, how many points are in which cell of it,
// and which attributes are constant.
#ifndef EWA_SRC_LOD_STATISTICS_H
#define EWA_SRC_LOD_STATISTICS_H

#include "lod/inputs.h"
#include "lod/lattice.h"

enum { EWA_STATISTICS_CELLS = 1 << 18 }; ///< at most

/// A cell that has points.
typedef struct ewa_statistics_cell {
    uint64_t prefix; ///< of its Morton code, at the statistics' level
    uint64_t point_count;
} ewa_statistics_cell;

/// One attribute beside the positions.
typedef struct ewa_statistics_column {
    uint32_t size_bytes; ///< of a point's numbers
    uint32_t at_bytes;   ///< in a record, unless all are the same
    bool constant;
    bool seen;         ///< `value` is set
    uint8_t value[32]; ///< of the first point
} ewa_statistics_column;

typedef struct ewa_statistics {
    ewa_lattice lattice;
    uint32_t cell_level;        ///< of the cells in the tree
    ewa_statistics_cell *cells; ///< by prefix
    uint32_t cell_count;
    size_t cell_capacity;
    uint64_t point_count, left_out_count;
    int64_t minimum[3], maximum[3]; ///< places of the points
    uint32_t column_count;          ///< attributes of the prototype but the positions, in its order
    ewa_statistics_column *columns;
    uint32_t record_bytes; ///< of a point spooled: place from the root's corner, 3 x 32 bits, and what varies
} ewa_statistics;

/// Reads all points. Free with ewa_statistics_free(), also after a failure.
ewa_status ewa_statistics_make(ewa_inputs *inputs, ewa_statistics *statistics);
void ewa_statistics_free(ewa_context *context, ewa_statistics *statistics);

/// Whether some of `count` points from point `first` on have another number than all others, as the column has it.
bool ewa_statistics_differs(const ewa_statistics_column *column, const ewa_attribute *attribute, uint64_t first, uint64_t count);

/// Whole-number places of `count` points of a piece from point `first` on, 3 each; those that are not finite get
/// EWA_NOWHERE and are counted.
#define EWA_NOWHERE INT64_MIN
uint64_t ewa_statistics_places(const ewa_lattice *lattice, const ewa_cloud *piece, uint64_t first,
                               uint64_t count, int64_t *places);

#endif
