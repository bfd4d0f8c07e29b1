// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Conjugate gradients for a few right sides at once, for any symmetric positive definite map.
#ifndef EWA_SRC_COLORS_GRADIENT_H
#define EWA_SRC_COLORS_GRADIENT_H

#include "base/base.h"

enum {
    EWA_GRADIENT_SIDES = 4,         ///< most right sides that go together
    EWA_GRADIENT_BLOCK_ROWS = 2048, ///< one task; sums are made per block and added up in order
};

static inline uint32_t ewa_gradient_blocks(uint32_t size) {
    return (uint32_t)(((uint64_t)size + EWA_GRADIENT_BLOCK_ROWS - 1) / EWA_GRADIENT_BLOCK_ROWS);
}

static inline uint32_t ewa_gradient_block_end(uint32_t size, uint32_t block) {
    const uint64_t end = ((uint64_t)block + 1) * EWA_GRADIENT_BLOCK_ROWS;
    return end < size ? (uint32_t)end : size;
}

/// A system A x = b with `count` right sides; vectors hold size * count numbers, those of one row together.
typedef struct ewa_conjugate_gradient {
    ewa_context *context;
    uint32_t size, count;
    double *solution, *residual; ///< b comes in `residual`; x and b - A x go out
    void *system;                ///< for the functions
    /// Called before the blocks of a product, for what they share; NULL: nothing.
    void (*prepare)(void *system, const double *direction);
    /// The rows of a block: product = A direction.
    void (*multiply)(const void *system, uint32_t block, const double *direction, double *product);
    /// The rows of a block: result = M^-1 residual, for a symmetric M near A; NULL: M = 1.
    void (*precondition)(const void *system, uint32_t block, const double *residual, double *result);
    double tolerance; ///< ends when every |b - A x| <= tolerance |b|,
    uint32_t max_iterations;
    ewa_severity unsolved_severity; ///< of the message with EWA_ERROR_NUMERIC
    const char *stage;              ///< of the progress, which goes from `begin` to `end`
    double begin, end;
    bool silent; ///< `prepare` tells the progress
} ewa_conjugate_gradient;

/// Solves; `*iterations` gets the steps. Does not depend on the number of threads. Errors: EWA_ERROR_NUMERIC
/// (a map that is not positive definite), EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_conjugate_gradient_run(const ewa_conjugate_gradient *job, uint32_t *iterations);

#endif
