// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sparse solver's front: checks, choice of the method, residuals.
#include "colors/sparse_parts.h"

#include <math.h>
#include <string.h>

static const uint64_t DEFAULT_FACTOR_BYTES = (uint64_t)1 << 30;
static const double DEFAULT_TOLERANCE = 1e-10;
enum {
    SIDES = EWA_GRADIENT_SIDES,
    DEFAULT_ITERATIONS = 5000,
    // AUTO, measured (docs/colors.md): up to so many rows a factor takes milliseconds and is exact; above,
    // the gradient is many times the faster unless it needs more steps than this.
    FACTOR_ROWS = 4096,
    PATIENT_ITERATIONS = 500,
};

typedef struct check_job {
    const ewa_sparse *matrix;
    const double *sides;
    uint32_t side_count;
    uint8_t *bad; // [block_count]
} check_job;

/// What may be wrong with a row; 0 is nothing.
enum { BAD_ORDER = 1, BAD_NUMBER, BAD_DIAGONAL };

static int check_row(const check_job *job, uint32_t row) {
    const ewa_sparse *matrix = job->matrix;
    const uint64_t first = matrix->row_starts[row], end = matrix->row_starts[row + 1];
    if (first > end) return BAD_ORDER;
    bool finite = true, diagonal = false;
    for (uint64_t k = first; k < end; k++) {
        const uint32_t column = matrix->columns[k];
        if (column >= matrix->size || (k > first && column <= matrix->columns[k - 1])) return BAD_ORDER;
        finite = finite && isfinite(matrix->values[k]);
        diagonal = diagonal || (column == row && matrix->values[k] > 0);
    }
    for (uint32_t s = 0; s < job->side_count; s++)
        finite = finite && isfinite(job->sides[(size_t)row * job->side_count + s]);
    return !finite ? BAD_NUMBER : !diagonal ? BAD_DIAGONAL : 0;
}

static void check_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const check_job *job = data;
    int worst = 0;
    for (uint32_t row = block * EWA_GRADIENT_BLOCK_ROWS;
         row < ewa_gradient_block_end(job->matrix->size, block) && !worst; row++)
        worst = check_row(job, row);
    job->bad[block] = (uint8_t)worst;
}

static ewa_status check(ewa_context *context, ewa_severity severity, const check_job *job) {
    const uint32_t blocks = ewa_gradient_blocks(job->matrix->size);
    ewa_parallel(context, check_block, (void *)job, blocks);
    for (uint32_t block = 0; block < blocks; block++) {
        if (!job->bad[block]) continue;
        uint32_t row = block * EWA_GRADIENT_BLOCK_ROWS;
        int what;
        while (!(what = check_row(job, row))) row++;
        if (what == BAD_ORDER)
            return ewa_fail(context, EWA_ERROR_ARGUMENT,
                            "solve: the columns of row %u are not ascending and below %u", row,
                            job->matrix->size);
        if (what == BAD_NUMBER)
            return ewa_sparse_refuse(context, severity, "solve: row %u has a number that is not finite", row);
        return ewa_sparse_refuse(
            context, severity, "solve: the matrix is not positive definite: row %u has no positive diagonal",
            row);
    }
    return EWA_OK;
}

typedef struct residual_job {
    const ewa_sparse *matrix;
    uint32_t count;
    const double *sides, *solution;
    double *residual, *partial;
} residual_job;

static void residual_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    const residual_job *job = data;
    const ewa_sparse *matrix = job->matrix;
    double *partial = job->partial + (size_t)block * 2 * SIDES;
    memset(partial, 0, 2 * SIDES * sizeof *partial);
    for (uint32_t row = block * EWA_GRADIENT_BLOCK_ROWS; row < ewa_gradient_block_end(matrix->size, block);
         row++) {
        const double *b = job->sides + (size_t)row * job->count;
        double rest[SIDES] = {0};
        for (uint32_t s = 0; s < job->count; s++) rest[s] = b[s];
        for (uint64_t k = matrix->row_starts[row]; k < matrix->row_starts[row + 1]; k++)
            for (uint32_t s = 0; s < job->count; s++)
                rest[s] -= matrix->values[k] * job->solution[(size_t)matrix->columns[k] * job->count + s];
        for (uint32_t s = 0; s < job->count; s++) {
            job->residual[(size_t)row * job->count + s] = rest[s];
            partial[s] += rest[s] * rest[s];
            partial[SIDES + s] += b[s] * b[s];
        }
    }
}

/// Writes b - A x for `count` tightly interleaved sides, and the squares of its and b's lengths. `partial`
/// holds 2 * SIDES numbers per block.
static void find_residual(ewa_context *context, const ewa_sparse *matrix, uint32_t count, const double *sides,
                          const double *solution, double *residual, double *partial, double residual2[SIDES],
                          double side2[SIDES]) {
    const uint32_t blocks = ewa_gradient_blocks(matrix->size);
    residual_job job = {matrix, count, sides, solution, residual, partial};
    ewa_parallel(context, residual_block, &job, blocks);
    memset(residual2, 0, SIDES * sizeof *residual2);
    memset(side2, 0, SIDES * sizeof *side2);
    for (uint32_t block = 0; block < blocks; block++)
        for (int s = 0; s < SIDES; s++) {
            residual2[s] += partial[(size_t)block * 2 * SIDES + (size_t)s];
            side2[s] += partial[((size_t)block * 2 + 1) * SIDES + (size_t)s];
        }
}

typedef struct solve_job {
    ewa_context *context;
    const ewa_sparse *matrix;
    ewa_sparse_options options;
    ewa_sparse_report report;
    sparse_factor *factor;               // NULL: gradient
    bool unfit;                          // a factor would be over its limit
    double *sides, *solution, *residual; // of one group, tightly interleaved
    double *partial;                     // [block_count][2 * SIDES]
} solve_job;

static double largest_residual(const double residual2[SIDES], const double side2[SIDES], uint32_t count) {
    double maximum = 0;
    for (uint32_t s = 0; s < count; s++) {
        if (!isfinite(residual2[s])) return INFINITY;
        if (residual2[s] > 0)
            maximum = fmax(maximum, side2[s] > 0 ? sqrt(residual2[s] / side2[s]) : INFINITY);
    }
    return maximum;
}

static ewa_status apply_factor(solve_job *job, uint32_t count) {
    double residual2[SIDES], side2[SIDES];
    EWA_TRY(ewa_sparse_factor_apply(job->factor, count, job->sides, job->solution));
    find_residual(job->context, job->matrix, count, job->sides, job->solution, job->residual, job->partial,
                  residual2, side2);
    EWA_TRY(ewa_sparse_factor_apply(job->factor, count, job->residual, job->residual));
    for (size_t i = 0; i < (size_t)job->matrix->size * count; i++) job->solution[i] += job->residual[i];
    return EWA_OK;
}

/// Makes the factor; job->factor stays NULL where it does not fit.
static ewa_status make_factor(solve_job *job) {
    uint64_t bytes = 0;
    EWA_TRY(ewa_sparse_factor_analyse(job->context, job->matrix, &job->factor, &bytes));
    if (bytes > job->options.max_factor_bytes) {
        ewa_sparse_factor_destroy(&job->factor);
        if (job->options.method == EWA_SPARSE_AUTO) return EWA_OK;
        return ewa_fail(job->context, EWA_ERROR_LIMIT,
                        "solve: the factor of %u rows needs %llu bytes, the limit is %llu", job->matrix->size,
                        (unsigned long long)bytes, (unsigned long long)job->options.max_factor_bytes);
    }
    job->report.factor_bytes = bytes;
    return ewa_sparse_factor_make(job->factor, job->options.unsolved_severity);
}

/// Solves for what is in job->sides by the factor, else by gradients; where those take long, AUTO makes a
/// factor after all.
static ewa_status find_solution(solve_job *job, uint32_t count, uint32_t *iterations) {
    sparse_gradient gradient = {.context = job->context,
                                .matrix = job->matrix,
                                .count = count,
                                .sides = job->sides,
                                .solution = job->solution,
                                .residual = job->residual,
                                .tolerance = job->options.tolerance,
                                .max_iterations = job->options.max_iterations,
                                .unsolved_severity = job->options.unsolved_severity};
    if (job->factor) {
        *iterations = 1;
        return apply_factor(job, count);
    }
    const bool may_change = job->options.method == EWA_SPARSE_AUTO && !job->unfit &&
                            job->matrix->row_starts[job->matrix->size] <= INT32_MAX &&
                            gradient.max_iterations > PATIENT_ITERATIONS;
    if (may_change) gradient.max_iterations = PATIENT_ITERATIONS;
    EWA_TRY(ewa_sparse_gradient_run(&gradient, iterations));
    if (!may_change || *iterations < PATIENT_ITERATIONS) return EWA_OK;
    ewa_status status = make_factor(job);
    job->unfit = !job->factor;
    return status == EWA_OK ? find_solution(job, count, iterations) : status;
}

static ewa_status solve_group(solve_job *job, uint32_t count) {
    double residual2[SIDES], side2[SIDES];
    uint32_t iterations = 0;
    EWA_TRY(find_solution(job, count, &iterations));
    find_residual(job->context, job->matrix, count, job->sides, job->solution, job->residual, job->partial,
                  residual2, side2);
    const double residual = largest_residual(residual2, side2, count);
    // What a recurrence calls converged may, recomputed, be a little off.
    if (!(residual <= 2 * job->options.tolerance))
        return ewa_sparse_refuse(
            job->context, job->options.unsolved_severity,
            "solve: the residual of %u rows is %.3g after %u %s, must be %.3g; the matrix is "
            "singular or nearly so",
            job->matrix->size, residual, iterations, job->factor ? "refinement" : "iterations",
            job->options.tolerance);
    job->report.residual = fmax(job->report.residual, residual);
    if (iterations > job->report.iterations) job->report.iterations = iterations;
    return EWA_OK;
}

static ewa_status solve_groups(solve_job *job, uint32_t side_count, const double *sides, double *solution) {
    const uint32_t size = job->matrix->size;
    for (uint32_t first = 0; first < side_count; first += SIDES) {
        const uint32_t count = side_count - first < SIDES ? side_count - first : SIDES;
        for (size_t i = 0; i < size; i++)
            for (uint32_t s = 0; s < count; s++)
                job->sides[i * count + s] = sides[i * side_count + first + s];
        EWA_TRY(solve_group(job, count));
        for (size_t i = 0; i < size; i++)
            for (uint32_t s = 0; s < count; s++)
                solution[i * side_count + first + s] = job->solution[i * count + s];
    }
    return ewa_progress(job->context, "solve", 1);
}

ewa_status ewa_sparse_solve(ewa_context *context, const ewa_sparse *matrix, uint32_t side_count,
                            const double *sides, double *solution, const ewa_sparse_options *options,
                            ewa_sparse_report *report) {
    solve_job job = {.context = context, .matrix = matrix};
    if (options) job.options = *options;
    if (!(job.options.tolerance > 0)) job.options.tolerance = DEFAULT_TOLERANCE;
    if (!job.options.max_iterations) job.options.max_iterations = DEFAULT_ITERATIONS;
    if (!job.options.max_factor_bytes) job.options.max_factor_bytes = DEFAULT_FACTOR_BYTES;
    const uint32_t size = matrix->size, blocks = ewa_gradient_blocks(matrix->size);
    const uint32_t group = side_count < SIDES ? side_count : SIDES;
    if (report) *report = (ewa_sparse_report){.method = EWA_SPARSE_GRADIENT};
    if (size == 0 || side_count == 0) return EWA_OK;

    uint8_t *bad = ewa_allocate(context, blocks, sizeof *bad);
    job.sides = ewa_allocate(context, (size_t)size * group, sizeof(double));
    job.solution = ewa_allocate(context, (size_t)size * group, sizeof(double));
    job.residual = ewa_allocate(context, (size_t)size * group, sizeof(double));
    job.partial = ewa_allocate(context, (size_t)blocks * 2 * SIDES, sizeof(double));
    ewa_status status = EWA_ERROR_MEMORY;
    if (bad && job.sides && job.solution && job.residual && job.partial)
        status = check(context, job.options.unsolved_severity, &(check_job){matrix, sides, side_count, bad});
    if (status == EWA_OK) status = ewa_progress(context, "solve", 0);
    const ewa_sparse_method method = job.options.method;
    if (status == EWA_OK &&
        (method == EWA_SPARSE_FACTOR || (method == EWA_SPARSE_AUTO && size <= FACTOR_ROWS))) {
        status = make_factor(&job);
        job.unfit = !job.factor;
    }
    if (status == EWA_OK) status = solve_groups(&job, side_count, sides, solution);
    job.report.method = job.factor ? EWA_SPARSE_FACTOR : EWA_SPARSE_GRADIENT;
    if (report && status == EWA_OK) *report = job.report;
    ewa_sparse_factor_destroy(&job.factor);
    ewa_release(context, job.partial, (size_t)blocks * 2 * SIDES, sizeof(double));
    ewa_release(context, job.residual, (size_t)size * group, sizeof(double));
    ewa_release(context, job.solution, (size_t)size * group, sizeof(double));
    ewa_release(context, job.sides, (size_t)size * group, sizeof(double));
    ewa_release(context, bad, blocks, sizeof *bad);
    return status;
}
