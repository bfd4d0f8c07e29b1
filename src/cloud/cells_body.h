// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Body of the kernels that code cells: plain loops that the compiler turns into vectors of whatever
// instruction set the including file is compiled for. No section of docs/math.md is about them.
//
// Based on G. M. Morton, "A computer oriented geodetic data base and a new technique in file sequencing",
// 1966.
#include "cloud/cells.h"

/// Puts two zero bits before each of the low 21 bits.
static inline uint64_t spread_bits(uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    v = (v | v << 2) & 0x1249249249249249u;
    return v;
}

void EWA_VERSION(ewa_code_cells)(const ewa_grid *grid, const double *points, uint32_t count,
                                 uint64_t *codes) {
    const double last = (1 << EWA_GRID_AXIS_BITS) - 1, scale = grid->cells_per_half_unit;
    double coordinates[3][EWA_CELL_BLOCK];
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) coordinates[c][i] = points[3 * i + c];
    uint64_t unbounded = 0;
    for (uint32_t i = 0; i < count; i++) codes[i] = 0;
    for (int c = 0; c < 3; c++) {
        const double half_low = grid->half_low[c];
        for (uint32_t i = 0; i < count; i++) {
            const double at = coordinates[c][i];
            double cell = (0.5 * at - half_low) * scale;
            cell = cell > 0 ? cell : 0;
            cell = cell < last ? cell : last;
            codes[i] |= spread_bits((uint64_t)(int32_t)cell) << c;
            unbounded |= at - at != 0;
        }
    }
    if (!unbounded) return;
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            if (coordinates[c][i] - coordinates[c][i] != 0) codes[i] = EWA_NOT_FINITE;
}
