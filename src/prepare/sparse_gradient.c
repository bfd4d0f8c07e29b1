// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Preconditioned conjugate gradients for a few right sides at once: every row of the matrix is read once per
// step for all of them.
//
// Based on Y. Saad, "Iterative methods for sparse linear systems", 2003, algorithm 9.1, with the symmetric
// Gauss-Seidel preconditioner (section 10.2) inside of blocks of rows that do not see each other, so that
// blocks are independent tasks and their sums have a fixed order.
#include "prepare/sparse_parts.h"

#include <math.h>
#include <string.h>

typedef struct gradient_state {
    const sparse_gradient *job;
    double *direction, *product, *preconditioned; // [size][count]
    double alpha[SPARSE_SIDES], beta[SPARSE_SIDES];
} gradient_state;

#define INLINE static inline __attribute__((always_inline))

/// product = A direction, and their inner product. `count` is a constant where this is inlined.
INLINE void multiply(const gradient_state *state, uint32_t block, const uint32_t count) {
    const ewa_sparse *matrix = state->job->matrix;
    const double *direction = state->direction;
    double *partial = state->job->partial + (size_t)block * SPARSE_SIDES;
    double inner[SPARSE_SIDES] = {0};
    for (uint32_t row = block * SPARSE_BLOCK_ROWS; row < sparse_block_end(matrix, block); row++) {
        double sum[SPARSE_SIDES] = {0};
        for (uint64_t k = matrix->row_starts[row]; k < matrix->row_starts[row + 1]; k++) {
            const double value = matrix->values[k], *at = direction + (size_t)matrix->columns[k] * count;
            for (uint32_t s = 0; s < count; s++) sum[s] += value * at[s];
        }
        const size_t first = (size_t)row * count;
        for (uint32_t s = 0; s < count; s++) {
            state->product[first + s] = sum[s];
            inner[s] += sum[s] * direction[first + s];
        }
    }
    memcpy(partial, inner, sizeof inner);
}

static void multiply_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    switch (state->job->count) {
    case 1:
        multiply(state, block, 1);
        break;
    case 2:
        multiply(state, block, 2);
        break;
    case 3:
        multiply(state, block, 3);
        break;
    default:
        multiply(state, block, 4);
    }
}

/// preconditioned = ((L + D) D^-1 (D + U))^-1 residual with the part of the matrix inside of the block.
INLINE void precondition(const gradient_state *state, uint32_t block, const uint32_t count) {
    const ewa_sparse *matrix = state->job->matrix;
    const uint32_t first_row = block * SPARSE_BLOCK_ROWS, end_row = sparse_block_end(matrix, block);
    const double *residual = state->job->residual;
    double *z = state->preconditioned, diagonal[SPARSE_BLOCK_ROWS];
    for (uint32_t row = first_row; row < end_row; row++) {
        uint64_t k = matrix->row_starts[row];
        double sum[SPARSE_SIDES];
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
        double sum[SPARSE_SIDES] = {0};
        for (uint64_t k = matrix->row_starts[row + 1]; matrix->columns[k - 1] > row; k--) {
            if (matrix->columns[k - 1] >= end_row) continue;
            const double *at = z + (size_t)matrix->columns[k - 1] * count;
            for (uint32_t s = 0; s < count; s++) sum[s] += matrix->values[k - 1] * at[s];
        }
        for (uint32_t s = 0; s < count; s++) z[(size_t)row * count + s] -= sum[s] * diagonal[row - first_row];
    }
}

/// solution += alpha direction, residual -= alpha product, then the preconditioner; sums of residual *
/// preconditioned and of residual squared.
static void advance_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    const sparse_gradient *job = state->job;
    const uint32_t count = job->count;
    const size_t first = (size_t)block * SPARSE_BLOCK_ROWS, end = sparse_block_end(job->matrix, block);
    double *partial = job->partial + (size_t)block * 2 * SPARSE_SIDES;
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const size_t i = row * count + s;
            job->solution[i] += state->alpha[s] * state->direction[i];
            job->residual[i] -= state->alpha[s] * state->product[i];
        }
    switch (count) {
    case 1:
        precondition(state, block, 1);
        break;
    case 2:
        precondition(state, block, 2);
        break;
    case 3:
        precondition(state, block, 3);
        break;
    default:
        precondition(state, block, 4);
    }
    memset(partial, 0, 2 * SPARSE_SIDES * sizeof *partial);
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const double r = job->residual[row * count + s];
            partial[s] += r * state->preconditioned[row * count + s];
            partial[SPARSE_SIDES + s] += r * r;
        }
}

static void turn_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    const uint32_t count = state->job->count;
    const size_t first = (size_t)block * SPARSE_BLOCK_ROWS, end = sparse_block_end(state->job->matrix, block);
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const size_t i = row * count + s;
            state->direction[i] = state->preconditioned[i] + state->beta[s] * state->direction[i];
        }
}

static ewa_status iterate(ewa_context *context, gradient_state *state, uint32_t *iterations) {
    const sparse_gradient *job = state->job;
    const uint32_t count = job->count, blocks = sparse_block_count(job->matrix);
    const size_t bytes = (size_t)job->matrix->size * count * sizeof(double);
    double old[SPARSE_SIDES] = {0}, goal[SPARSE_SIDES] = {0}, pair[2][SPARSE_SIDES], most_start = 0,
           share = 0;
    memset(job->solution, 0, bytes);
    memset(state->direction, 0, bytes);
    memset(state->product, 0, bytes);
    memcpy(job->residual, job->sides, bytes);
    for (*iterations = 0;; (*iterations)++) {
        // The first pass, with alpha and beta 0, only starts the direction.
        if (*iterations > 0) {
            ewa_parallel(context, multiply_block, state, blocks);
            ewa_sparse_sum(job->partial, blocks, pair[0]);
            for (uint32_t s = 0; s < count; s++) {
                if (old[s] > 0 && !(pair[0][s] > 0))
                    return ewa_sparse_refuse(
                        context, job->unsolved_severity,
                        "solve: the matrix of %u rows is not positive definite (step %u)", job->matrix->size,
                        *iterations);
                state->alpha[s] = old[s] > 0 ? old[s] / pair[0][s] : 0;
            }
        }
        ewa_parallel(context, advance_block, state, blocks);
        memset(pair, 0, sizeof pair);
        for (uint32_t block = 0; block < blocks; block++)
            for (int k = 0; k < 2; k++)
                for (int s = 0; s < SPARSE_SIDES; s++)
                    pair[k][s] += job->partial[((size_t)block * 2 + (size_t)k) * SPARSE_SIDES + (size_t)s];
        double most = 0;
        for (uint32_t s = 0; s < count; s++) {
            if (*iterations == 0) goal[s] = job->tolerance * job->tolerance * pair[1][s];
            const bool done = pair[1][s] <= goal[s];
            state->beta[s] = !done && old[s] > 0 ? pair[0][s] / old[s] : 0;
            old[s] = done ? 0 : pair[0][s];
            if (!done) most = fmax(most, pair[1][s] / goal[s]);
        }
        if (*iterations == 0) most_start = most;
        if (most == 0 || *iterations == job->max_iterations) return EWA_OK;
        ewa_parallel(context, turn_block, state, blocks);
        // Residuals do not shrink in every step.
        if (most < most_start) share = fmax(share, log(most_start / most) / log(most_start));
        const ewa_status status = ewa_progress(context, "solve", 0.99 * share);
        if (status != EWA_OK) return status;
    }
}

ewa_status ewa_sparse_gradient_run(ewa_context *context, const sparse_gradient *job, uint32_t *iterations) {
    const size_t size = (size_t)job->matrix->size * job->count;
    gradient_state state = {.job = job};
    state.direction = ewa_allocate(context, size, sizeof(double));
    state.product = ewa_allocate(context, size, sizeof(double));
    state.preconditioned = ewa_allocate(context, size, sizeof(double));
    ewa_status status = EWA_ERROR_MEMORY;
    if (state.direction && state.product && state.preconditioned)
        status = iterate(context, &state, iterations);
    ewa_release(context, state.preconditioned, size, sizeof(double));
    ewa_release(context, state.product, size, sizeof(double));
    ewa_release(context, state.direction, size, sizeof(double));
    return status;
}
