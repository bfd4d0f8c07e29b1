// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sparse symmetric positive definite systems with a few right sides: colours as coefficients of kernels.
#ifndef EWA_SRC_COLORS_SPARSE_H
#define EWA_SRC_COLORS_SPARSE_H

#include "ewa/base.h"

/// A symmetric matrix by rows, both halves stored: row i has the entries [row_starts[i], row_starts[i + 1]),
/// their columns ascending. Only the caller can see to the symmetry.
typedef struct ewa_sparse {
    uint32_t size;
    const uint64_t *row_starts; ///< size + 1, the first is 0
    const uint32_t *columns;
    const double *values;
} ewa_sparse;

typedef enum ewa_sparse_method {
    EWA_SPARSE_AUTO = 0, ///< a factor of few rows or where the gradient takes long and it fits, else gradient
    EWA_SPARSE_FACTOR, ///< Cholesky factor: one cost for any conditioning, memory grows faster than the size
    EWA_SPARSE_GRADIENT, ///< conjugate gradient: no memory to speak of, steps grow with the conditioning
} ewa_sparse_method;

typedef struct ewa_sparse_options {
    ewa_sparse_method method;
    double tolerance;               ///< largest |b - A x| / |b| that is a solution; 0: 1e-10
    uint32_t max_iterations;        ///< of the gradient; 0: 5000
    uint64_t max_factor_bytes;      ///< of the factor's numbers and indices; 0: 1 GiB
    ewa_severity unsolved_severity; ///< of the message with EWA_ERROR_NUMERIC; 0: an error
} ewa_sparse_options;

/// What was done.
typedef struct ewa_sparse_report {
    ewa_sparse_method method; ///< FACTOR or GRADIENT
    uint32_t iterations;      ///< of the gradient, the most of any right side; factor: refinements
    double residual;          ///< largest |b - A x| / |b| over the right sides
    uint64_t factor_bytes;    ///< 0: no factor
} ewa_sparse_report;

/// Solves A x = b for `side_count` right sides at once. `sides` and `solution` hold size * side_count
/// numbers, those of one row together; they must not overlap. `options` and `report` may be NULL.
///
/// The result does not depend on the number of threads. The factor's memory comes from malloc() and not from
/// the context's allocator (see sparse_factor.c). Progress stage: "solve", begun
/// anew for every four right sides and where the method changes. Errors: EWA_ERROR_ARGUMENT (rows
/// or columns out of order), EWA_ERROR_NUMERIC (a number that is not finite, a matrix that is not positive
/// definite, a residual over the tolerance), EWA_ERROR_LIMIT (method FACTOR, factor over max_factor_bytes),
/// EWA_ERROR_MEMORY, EWA_CANCELLED; `solution` then holds nothing of use.
ewa_status ewa_sparse_solve(ewa_context *context, const ewa_sparse *matrix, uint32_t side_count,
                            const double *sides, double *solution, const ewa_sparse_options *options,
                            ewa_sparse_report *report);

#endif
