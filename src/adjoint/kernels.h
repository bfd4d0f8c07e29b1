// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The loops over the pixels of splats, eight pixels at a time in double precision, written once in kernels_body.h and
// compiled per instruction set; the same bytes from each. Which splats count where is decided by the very numbers of
// src/reference/splat.c.
#ifndef EWA_SRC_ADJOINT_KERNELS_H
#define EWA_SRC_ADJOINT_KERNELS_H

#include "reference/adjoint_splat.h"
#include "wide/isa.h"

enum {
    EWA_EIGHT_LANES = 8,
    EWA_EIGHT_COLUMNS = 4, ///< a block is 4 x 2 pixels
    EWA_EIGHT_ROWS = 2,
};

/// The planes of a surface in a block: sums of the splats that face the viewer and of those that do not, what clip lines cut
/// of them, and later the cotangents of all these; the depths up to which splats count, and beyond which.
enum {
    EWA_PLANE_WEIGHT = 0, ///< of either side
    EWA_PLANE_COLOR = 1,
    EWA_PLANE_NORMAL = 4,
    EWA_PLANE_Z = 7,
    EWA_PLANE_OPACITY = 8,
    EWA_SIDE_PLANES = 9,
    EWA_PLANE_KEPT = 2 * EWA_SIDE_PLANES,
    EWA_PLANE_WHOLE,
    EWA_PLANE_INWARD,
    EWA_SUM_PLANES = EWA_PLANE_INWARD + 2,
    EWA_PLANE_BOUND = EWA_SUM_PLANES,
    EWA_PLANE_PASSED,
    EWA_PLANES,
};

/// A surface of the pixels of a tile.
typedef struct ewa_adjoint_area {
    const ewa_reference_view *view;
    int32_t x_px, y_px;         ///< of the first block
    uint32_t columns, rows;     ///< of blocks
    double *planes;             ///< [block][EWA_PLANES][EWA_EIGHT_LANES], row by row
    bool transparent;
    bool behind; ///< not the first surface
} ewa_adjoint_area;

/// Loops over splats. Each has a set of blocks, a bit for each that its box touches, row by row: where it may count. What is not in
/// the set is not looked at again. Boxes of more than 64 blocks have all bits, and are looked at as a whole.
typedef struct ewa_adjoint_kernels {
    /// Lowers the bounds to z + eps where splats count beyond what is passed, and makes their sets of blocks; returns the farthest bound
    /// of all pixels.
    double (*find)(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count, uint64_t *blocks);

    /// Adds splats to the sums where they count up to the bounds, one after the other; those blocks are left in the sets.
    void (*sum)(const ewa_adjoint_area *area, const ewa_reference_splat *const *splats, uint32_t count, uint64_t *blocks);

    /// Adds what a splat gets of the planes, which are cotangents by now, to the first `width` of its sums: terms times
    /// `scales`, each rounded to a whole number. Depths only with `with_depth`.
    void (*gather)(const ewa_adjoint_area *area, const ewa_reference_splat *splat, uint64_t blocks, uint32_t width, bool with_depth,
                   const double scales[EWA_MOMENT_COUNT], int64_t sums[EWA_MOMENT_COUNT]);
} ewa_adjoint_kernels;

EWA_DECLARE_VERSIONS(const ewa_adjoint_kernels, ewa_adjoint_kernels);

#endif
