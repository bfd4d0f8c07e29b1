// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What conjugate gradients ask of a sparse matrix: products with a few vectors at once, so that every row is
// read once for all of them, and the symmetric Gauss-Seidel preconditioner inside of blocks of rows that do
// not see each other, so that blocks are independent tasks.
//
// Based on Y. Saad, "Iterative methods for sparse linear systems", 2003, section 10.2.
#include "colors/sparse_parts.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/// The rows of a block of product = A direction. `count` is a constant where this is inlined.
INLINE void multiply(const ewa_sparse *matrix, uint32_t block, const double *direction, double *product,
                     const uint32_t count) {
    const uint32_t end = ewa_gradient_block_end(matrix->size, block);
    for (uint32_t row = block * EWA_GRADIENT_BLOCK_ROWS; row < end; row++) {
        double sum[EWA_GRADIENT_SIDES] = {0};
        for (uint64_t k = matrix->row_starts[row]; k < matrix->row_starts[row + 1]; k++) {
            const double value = matrix->values[k], *at = direction + (size_t)matrix->columns[k] * count;
            for (uint32_t s = 0; s < count; s++) sum[s] += value * at[s];
        }
        for (uint32_t s = 0; s < count; s++) product[(size_t)row * count + s] = sum[s];
    }
}

static void multiply_block(const void *system, uint32_t block, const double *direction, double *product) {
    const sparse_gradient *job = system;
    switch (job->count) {
    case 1:
        multiply(job->matrix, block, direction, product, 1);
        break;
    case 2:
        multiply(job->matrix, block, direction, product, 2);
        break;
    case 3:
        multiply(job->matrix, block, direction, product, 3);
        break;
    default:
        multiply(job->matrix, block, direction, product, 4);
    }
}

/// z = ((L + D) D^-1 (D + U))^-1 residual with the part of the matrix inside of the block.
INLINE void precondition(const ewa_sparse *matrix, uint32_t block, const double *residual, double *z,
                         const uint32_t count) {
    const uint32_t first_row = block * EWA_GRADIENT_BLOCK_ROWS,
                   end_row = ewa_gradient_block_end(matrix->size, block);
    double diagonal[EWA_GRADIENT_BLOCK_ROWS];
    for (uint32_t row = first_row; row < end_row; row++) {
        uint64_t k = matrix->row_starts[row];
        double sum[EWA_GRADIENT_SIDES];
        for (uint32_t s = 0; s < count; s++) sum[s] = residual[(size_t)row * count + s];
        while (matrix->columns[k] < first_row) k++;
        for (; matrix->columns[k] < row; k++) {
            const double *at = z + (size_t)matrix->columns[k] * count;
            for (uint32_t s = 0; s < count; s++) sum[s] -= matrix->values[k] * at[s];
        }
        const double inverse = diagonal[row - first_row] = 1 / matrix->values[k];
        for (uint32_t s = 0; s < count; s++) z[(size_t)row * count + s] = sum[s] * inverse;
    }
    for (uint32_t row = end_row; row-- > first_row;) {
        double sum[EWA_GRADIENT_SIDES] = {0};
        for (uint64_t k = matrix->row_starts[row + 1]; matrix->columns[k - 1] > row; k--) {
            if (matrix->columns[k - 1] >= end_row) continue;
            const double *at = z + (size_t)matrix->columns[k - 1] * count;
            for (uint32_t s = 0; s < count; s++) sum[s] += matrix->values[k - 1] * at[s];
        }
        for (uint32_t s = 0; s < count; s++) z[(size_t)row * count + s] -= sum[s] * diagonal[row - first_row];
    }
}

static void precondition_block(const void *system, uint32_t block, const double *residual, double *result) {
    const sparse_gradient *job = system;
    switch (job->count) {
    case 1:
        precondition(job->matrix, block, residual, result, 1);
        break;
    case 2:
        precondition(job->matrix, block, residual, result, 2);
        break;
    case 3:
        precondition(job->matrix, block, residual, result, 3);
        break;
    default:
        precondition(job->matrix, block, residual, result, 4);
    }
}

ewa_status ewa_sparse_gradient_run(const sparse_gradient *job, uint32_t *iterations) {
    memcpy(job->residual, job->sides, (size_t)job->matrix->size * job->count * sizeof *job->residual);
    const ewa_conjugate_gradient gradient = {.context = job->context,
                                   .size = job->matrix->size,
                                   .count = job->count,
                                   .solution = job->solution,
                                   .residual = job->residual,
                                   .system = (void *)job,
                                   .multiply = multiply_block,
                                   .precondition = precondition_block,
                                   .tolerance = job->tolerance,
                                   .max_iterations = job->max_iterations,
                                   .unsolved_severity = job->unsolved_severity,
                                   .stage = "solve",
                                   .end = 0.99};
    return ewa_conjugate_gradient_run(&gradient, iterations);
}
