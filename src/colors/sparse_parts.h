// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Inside of the sparse solver: up to EWA_GRADIENT_SIDES right sides go together through either method.
#ifndef EWA_SRC_COLORS_SPARSE_PARTS_H
#define EWA_SRC_COLORS_SPARSE_PARTS_H

#include "colors/gradient.h"
#include "colors/sparse.h"

/// Reports why there is no solution and returns EWA_ERROR_NUMERIC.
#define ewa_sparse_refuse(context, severity, ...)                                                            \
    (ewa_report(context, severity, __VA_ARGS__), EWA_ERROR_NUMERIC)

/// A Cholesky factor.
typedef struct sparse_factor sparse_factor;

/// Orders and counts, without numbers; `*factor_bytes` is what ewa_sparse_factor_make() will need. The caller
/// destroys `*factor`. Errors: EWA_ERROR_MEMORY, EWA_ERROR_LIMIT (more than 2^31 - 1 rows or entries).
ewa_status ewa_sparse_factor_analyse(ewa_context *context, const ewa_sparse *matrix, sparse_factor **factor,
                                     uint64_t *factor_bytes);

/// Computes the numbers; tells progress.
ewa_status ewa_sparse_factor_make(sparse_factor *factor, ewa_severity unsolved_severity);

/// Writes A^-1 b for `count` tightly interleaved sides.
ewa_status ewa_sparse_factor_apply(sparse_factor *factor, uint32_t count, const double *sides,
                                   double *solution);
void ewa_sparse_factor_destroy(sparse_factor **factor);

/// Solves for `count` tightly interleaved sides by conjugate gradients until every |r| <= tolerance |b| or
/// max_iterations are done; tells progress. `residual` (size * count) is workspace.
typedef struct sparse_gradient {
    ewa_context *context;
    const ewa_sparse *matrix;
    uint32_t count;
    const double *sides;
    double *solution, *residual;
    double tolerance;
    uint32_t max_iterations;
    ewa_severity unsolved_severity;
} sparse_gradient;
ewa_status ewa_sparse_gradient_run(const sparse_gradient *job, uint32_t *iterations);

#endif
