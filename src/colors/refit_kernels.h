// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What every surfel's kernel is worth at the centre of every other: the normalised reconstruction as a sparse
// matrix.
#ifndef EWA_SRC_COLORS_REFIT_KERNELS_H
#define EWA_SRC_COLORS_REFIT_KERNELS_H

#include "edges/solid.h"

/// Rows of a sparse matrix of which only some entries are not zero; columns ascend in each.
typedef struct refit_rows {
    uint64_t *starts; // [count + 1]
    uint32_t *columns;
    float *values;
    uint64_t entry_count; // of `columns` and `values`
} refit_rows;

/// B of B w = c and its transpose. Row i: the weights of the kernels at the centre of surfel i, their sum 1;
/// empty where that centre is not seen (its own clip lines cut it away) or too many kernels meet there.
typedef struct refit_matrix {
    ewa_context *context;
    uint32_t count; // surfels of the solid, in its order
    refit_rows forward, backward;
    uint64_t empty_count;
} refit_matrix;

/// Kernels beyond this many at one place give no equation: radii are then no support of a surface.
enum { REFIT_ROW_MAX = 256 };

/// Builds the matrix. Free with ewa_refit_matrix_free(), also after a failure. Errors: EWA_ERROR_LIMIT (more
/// bytes than the context's max_memory_bytes), EWA_ERROR_MEMORY.
ewa_status ewa_refit_matrix_make(const ewa_solid *solid, double cutoff, refit_matrix *matrix);
void ewa_refit_matrix_free(refit_matrix *matrix);

#endif
