// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the kernels that give points their place on the Z-order curve: each does the same
// operations in the same order as the others, so all give the same codes.
#ifndef EWA_SRC_CLOUD_CELLS_H
#define EWA_SRC_CLOUD_CELLS_H

#include "wide/isa.h"

#include <stdint.h>

enum {
    EWA_GRID_AXIS_BITS = 21, ///< 2^21 cells along an axis
    EWA_CELL_BLOCK = 256,
};

/// Code of points with a coordinate that is not finite: after all others.
#define EWA_NOT_FINITE UINT64_MAX

/// A grid of cubic cells; works on half coordinates, so that no difference overflows.
typedef struct ewa_grid {
    double half_low[3];
    double cells_per_half_unit;
} ewa_grid;

/// Codes the cells of up to EWA_CELL_BLOCK points of three numbers each: bit 3 i + c of a code is bit i of
/// the cell along axis c. Points beside the grid are in its outermost cells.
typedef void ewa_code_cells(const ewa_grid *grid, const double *points, uint32_t count, uint64_t *codes);

EWA_DECLARE_VERSIONS(ewa_code_cells, ewa_code_cells);

#endif
