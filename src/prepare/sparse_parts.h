// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Inside of the sparse solver: up to four right sides go together through either method.
#ifndef EWA_SRC_PREPARE_SPARSE_PARTS_H
#define EWA_SRC_PREPARE_SPARSE_PARTS_H

#include "base/base.h"
#include "prepare/sparse.h"

enum {
    SPARSE_SIDES = 4,         // solved together
    SPARSE_BLOCK_ROWS = 2048, // one task; sums are made per block and added up in order
};

static inline uint32_t sparse_block_count(const ewa_sparse *matrix) {
    return (uint32_t)(((uint64_t)matrix->size + SPARSE_BLOCK_ROWS - 1) / SPARSE_BLOCK_ROWS);
}

static inline uint32_t sparse_block_end(const ewa_sparse *matrix, uint32_t block) {
    const uint64_t end = ((uint64_t)block + 1) * SPARSE_BLOCK_ROWS;
    return end < matrix->size ? (uint32_t)end : matrix->size;
}

/// Reports why there is no solution and returns EWA_ERROR_NUMERIC.
#define ewa_sparse_refuse(context, severity, ...)                                                            \
    (ewa_report(context, severity, __VA_ARGS__), EWA_ERROR_NUMERIC)

/// Adds up [block_count][SPARSE_SIDES] in order.
void ewa_sparse_sum(const double *partial, uint32_t block_count, double sum[SPARSE_SIDES]);

/// Writes b - A x for `count` tightly interleaved sides, and the squares of its and b's lengths. `partial`
/// holds 2 * SPARSE_SIDES numbers per block.
void ewa_sparse_residual(ewa_context *context, const ewa_sparse *matrix, uint32_t count, const double *sides,
                         const double *solution, double *residual, double *partial,
                         double residual2[SPARSE_SIDES], double side2[SPARSE_SIDES]);

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
/// max_iterations are done; tells progress. `residual` (size * count) and `partial` (2 * SPARSE_SIDES per
/// block) are workspace.
typedef struct sparse_gradient {
    const ewa_sparse *matrix;
    uint32_t count;
    const double *sides;
    double *solution, *residual, *partial;
    double tolerance;
    uint32_t max_iterations;
    ewa_severity unsolved_severity;
} sparse_gradient;
ewa_status ewa_sparse_gradient_run(ewa_context *context, const sparse_gradient *job, uint32_t *iterations);

#endif
