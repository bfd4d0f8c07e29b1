// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Preconditioned conjugate gradients.
//
// Based on Y. Saad, "Iterative methods for sparse linear systems", 2003, algorithm 9.1.
#include "colors/gradient.h"

#include <math.h>
#include <string.h>

enum { SIDES = EWA_GRADIENT_SIDES };

typedef struct gradient_state {
    const ewa_conjugate_gradient *job;
    double *direction, *product, *preconditioned; // [size][count]
    double *partial;                              // [block][2][SIDES]
    double alpha[SIDES], beta[SIDES];
} gradient_state;

/// product = A direction, and sums of direction * product.
static void multiply_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    const uint32_t count = state->job->count;
    const size_t end = ewa_gradient_block_end(state->job->size, block);
    double sum[2][SIDES] = {{0}};
    state->job->multiply(state->job->system, block, state->direction, state->product);
    for (size_t row = (size_t)block * EWA_GRADIENT_BLOCK_ROWS; row < end; row++)
        for (uint32_t s = 0; s < count; s++)
            sum[0][s] += state->product[row * count + s] * state->direction[row * count + s];
    memcpy(state->partial + (size_t)block * 2 * SIDES, sum, sizeof sum);
}

/// solution += alpha direction, residual -= alpha product. `count` is a constant where this is inlined.
static inline __attribute__((always_inline)) void advance(const gradient_state *state, size_t first,
                                                          size_t end, const uint32_t count) {
    double *solution = state->job->solution, *residual = state->job->residual;
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const size_t i = row * count + s;
            solution[i] += state->alpha[s] * state->direction[i];
            residual[i] -= state->alpha[s] * state->product[i];
        }
}

/// A step, then the preconditioner; sums of residual * preconditioned and of residual squared.
static void advance_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    const ewa_conjugate_gradient *job = state->job;
    const uint32_t count = job->count;
    const size_t first = (size_t)block * EWA_GRADIENT_BLOCK_ROWS,
                 end = ewa_gradient_block_end(job->size, block);
    double sum[2][SIDES] = {{0}};
    if (count == 3) // colours
        advance(state, first, end, 3);
    else
        advance(state, first, end, count);
    if (job->precondition) job->precondition(job->system, block, job->residual, state->preconditioned);
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const double r = job->residual[row * count + s];
            sum[0][s] += r * state->preconditioned[row * count + s];
            sum[1][s] += r * r;
        }
    memcpy(state->partial + (size_t)block * 2 * SIDES, sum, sizeof sum);
}

static void turn_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const gradient_state *state = data;
    const uint32_t count = state->job->count;
    const size_t first = (size_t)block * EWA_GRADIENT_BLOCK_ROWS,
                 end = ewa_gradient_block_end(state->job->size, block);
    for (size_t row = first; row < end; row++)
        for (uint32_t s = 0; s < count; s++) {
            const size_t i = row * count + s;
            state->direction[i] = state->preconditioned[i] + state->beta[s] * state->direction[i];
        }
}

/// Runs a task over all blocks and adds up what it measured, in order.
static void run_blocks(gradient_state *state, ewa_task *task, double sum[2][SIDES]) {
    const uint32_t blocks = ewa_gradient_blocks(state->job->size);
    ewa_parallel(state->job->context, task, state, blocks);
    memset(sum, 0, 2 * SIDES * sizeof sum[0][0]);
    for (uint32_t block = 0; block < blocks; block++)
        for (size_t k = 0; k < 2; k++)
            for (size_t s = 0; s < SIDES; s++)
                sum[k][s] += state->partial[((size_t)block * 2 + k) * SIDES + s];
}

static ewa_status iterate(gradient_state *state, uint32_t *iterations) {
    const ewa_conjugate_gradient *job = state->job;
    const uint32_t count = job->count;
    const size_t bytes = (size_t)job->size * count * sizeof(double);
    double old[SIDES] = {0}, goal[SIDES] = {0}, sum[2][SIDES], max_start = 0, share = 0;
    memset(job->solution, 0, bytes);
    memset(state->direction, 0, bytes);
    memset(state->product, 0, bytes);
    for (*iterations = 0;; (*iterations)++) {
        // The first pass, with alpha and beta 0, only starts the direction.
        if (*iterations > 0) {
            if (job->prepare) job->prepare(job->system, state->direction);
            run_blocks(state, multiply_block, sum);
            for (uint32_t s = 0; s < count; s++) {
                if (old[s] > 0 && !(sum[0][s] > 0)) {
                    ewa_report(job->context, job->unsolved_severity,
                               "%s: the matrix of %u rows is not positive definite (step %u)", job->stage,
                               job->size, *iterations);
                    return EWA_ERROR_NUMERIC;
                }
                state->alpha[s] = old[s] > 0 ? old[s] / sum[0][s] : 0;
            }
        }
        run_blocks(state, advance_block, sum);
        double maximum = 0; // of the squared residuals over their goals
        for (uint32_t s = 0; s < count; s++) {
            if (*iterations == 0) goal[s] = job->tolerance * job->tolerance * sum[1][s];
            const bool done = sum[1][s] <= goal[s];
            state->beta[s] = !done && old[s] > 0 ? sum[0][s] / old[s] : 0;
            old[s] = done ? 0 : sum[0][s];
            if (!done) maximum = fmax(maximum, sum[1][s] / goal[s]);
        }
        if (*iterations == 0) max_start = maximum;
        if (maximum == 0 || *iterations == job->max_iterations) return EWA_OK;
        ewa_parallel(job->context, turn_block, state, ewa_gradient_blocks(job->size));
        // Residuals do not shrink in every step.
        if (maximum < max_start) share = fmax(share, log(max_start / maximum) / log(max_start));
        if (!job->silent) EWA_TRY(ewa_progress(job->context, job->stage, job->begin + (job->end - job->begin) * share));
    }
}

ewa_status ewa_conjugate_gradient_run(const ewa_conjugate_gradient *job, uint32_t *iterations) {
    const size_t size = (size_t)job->size * job->count,
                 partial_count = (size_t)ewa_gradient_blocks(job->size) * 2 * SIDES;
    double *own = job->precondition ? ewa_allocate(job->context, size, sizeof *own) : NULL;
    gradient_state state = {.job = job, .preconditioned = job->precondition ? own : job->residual};
    state.direction = ewa_allocate(job->context, size, sizeof *state.direction);
    state.product = ewa_allocate(job->context, size, sizeof *state.product);
    state.partial = ewa_allocate(job->context, partial_count, sizeof *state.partial);
    const bool made = state.preconditioned && state.direction && state.product && state.partial;
    const ewa_status status = made ? iterate(&state, iterations) : EWA_ERROR_MEMORY;
    ewa_release(job->context, state.partial, partial_count, sizeof *state.partial);
    ewa_release(job->context, state.product, size, sizeof *state.product);
    ewa_release(job->context, state.direction, size, sizeof *state.direction);
    ewa_release(job->context, own, size, sizeof *own);
    return status;
}
