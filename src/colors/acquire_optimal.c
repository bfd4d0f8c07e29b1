// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Optimal colours: the normal equations of the texture's approximation by the kernels (docs/math.md section
// 10).
//
// What is drawn is sum w_k r_k / S, S = sum r_k. Its error, weighted by S^2, is |S f - sum w_k r_k|^2, and is
// least where R w = c with R_kj = <r_k, r_j> and c_k = <r_k, S f> = sum_j R_kj f_kj, f_kj the mean of f under
// the Gaussian r_k r_j. All rows of c being the same means of f as the rows of R add up to, a constant f
// gives that constant. Without S (the paper's equation 10) c_k = <r_k, f>.
//
// A ridge of the kernels' own squares pulls towards the filtered colours e: (R + l D) w = c + l D e. It
// bounds what kernels that are nearly the same, and pairs that were left out, can do. Based on M. Zwicker, H.
// Pfister, J. van Baar, M. Gross, "Surface Splatting", 2001, section 5 and appendix A.
#include "base/base.h"
#include "colors/acquire_stretch.h"
#include "colors/sparse.h"
#include "math/gaussian.h"

#include <string.h>

enum { RIDGE_TRIES = 4 };

/// The texture under a product that is smaller than a kernel's square by more than exp(-this) may as well be
/// that under the kernel.
#define NEAR_EXPONENT 7

/// Kernels on nearly the same place, of which charts say different things (coincident triangles), are held to
/// their filtered colours: by a ridge as large as the difference, times the kernels' closeness to this power.
#define HOLD_POWER 8

/// What may be left of the gradient at the filtered colours.
#define SOLUTION_TOLERANCE 1e-6

typedef struct optimal_job {
    const ewa_acquire_set *set;
    ewa_acquire_grid grid;
    ewa_texture_fit fit;
    uint32_t channel_count;
    double scale; ///< that makes a usual integral one
    double (*colors)[4];
    uint64_t *row_starts;
    uint32_t *columns;
    double *values, *sides, *solution;
    double *diagonal, *mass, *hold; ///< hold: ridge of a row where charts disagree
    uint64_t *overflowed;           ///< by worker: 1 + a point with too many partners
} optimal_job;

static void count_rows(void *data, uint32_t part, uint32_t worker) {
    const optimal_job *job = data;
    const ewa_acquire_stretch range = ewa_acquire_range(job->set, part);
    for (uint32_t i = range.first; i < range.end; i++) {
        const uint32_t count = ewa_acquire_find(&job->grid, i, NULL);
        if (count > EWA_ACQUIRE_MAX_PAIRS) job->overflowed[worker] = 1 + (uint64_t)job->set->order[i];
        job->row_starts[i + 1] = count;
    }
}

static void fill_row(const optimal_job *job, uint32_t row, const uint32_t *others) {
    const ewa_acquire_set *set = job->set;
    const uint64_t start = job->row_starts[row];
    const uint32_t count = (uint32_t)(job->row_starts[row + 1] - start), channels = job->channel_count;
    const ewa_acquire_point *point = &set->points[row];
    double *side = job->sides + (size_t)row * channels, look[4];
    ewa_acquire_pair pair;
    memcpy(job->columns + start, others, count * sizeof *others);
    for (uint32_t c = 0; c < channels; c++) side[c] = 0;
    job->hold[row] = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t other = others[i];
        const ewa_acquire_point *partner = &set->points[other];
        const ewa_acquire_point *a = row <= other ? point : partner, *b = row <= other ? partner : point;
        ewa_acquire_multiply(set, a, b, &pair);
        const double value = job->scale * pair.integral;
        job->values[start + i] = value;
        if (other == row) job->diagonal[row] = value;
        if (job->fit == EWA_FIT_SUM) continue;
        const bool is_near = pair.exponent < NEAR_EXPONENT;
        if (is_near) {
            const double gap = ewa_acquire_look_between(set, a, b, &pair, look);
            if (gap > 0) job->hold[row] += gap * ewa_exp(-HOLD_POWER * pair.exponent);
        }
        for (uint32_t c = 0; c < channels; c++) side[c] += value * (is_near ? look[c] : job->colors[row][c]);
    }
    ewa_acquire_single(point, &pair);
    job->mass[row] = job->scale * pair.integral;
    if (job->fit == EWA_FIT_SUM)
        for (uint32_t c = 0; c < channels; c++) side[c] = job->mass[row] * job->colors[row][c];
}

/// What is no surfel keeps its colour.
static void fill_alone(const optimal_job *job, uint32_t row) {
    job->columns[job->row_starts[row]] = row;
    job->values[job->row_starts[row]] = job->diagonal[row] = 1;
    job->mass[row] = job->hold[row] = 0;
    for (uint32_t c = 0; c < job->channel_count; c++)
        job->sides[(size_t)row * job->channel_count + c] = job->colors[row][c];
}

static void fill_rows(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const optimal_job *job = data;
    const ewa_acquire_stretch range = ewa_acquire_range(job->set, part);
    uint32_t others[EWA_ACQUIRE_MAX_PAIRS];
    for (uint32_t i = range.first; i < range.end; i++) {
        const float *axis = job->set->points[i].axis[0];
        ewa_acquire_find(&job->grid, i, others);
        if (axis[0] != 0 || axis[1] != 0 || axis[2] != 0)
            fill_row(job, i, others);
        else
            fill_alone(job, i);
    }
}

static ewa_status count_pairs(optimal_job *job) {
    ewa_context *context = job->set->context;
    const uint32_t workers = ewa_context_worker_count(context), count = job->set->count;
    job->overflowed = ewa_allocate_zeroed(context, workers, sizeof *job->overflowed);
    if (!job->overflowed) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_acquire_run(job->set, count_rows, job, 0.2, 0.3);
    uint64_t overflowed = 0;
    for (uint32_t w = 0; w < workers; w++)
        overflowed = overflowed > job->overflowed[w] ? overflowed : job->overflowed[w];
    ewa_release(context, job->overflowed, workers, sizeof *job->overflowed);
    if (status == EWA_OK && overflowed)
        status =
            ewa_fail(context, EWA_ERROR_LIMIT,
                     "texture: more than %d kernels overlap that of point %llu: the radii are far larger "
                     "than the spacing",
                     EWA_ACQUIRE_MAX_PAIRS, (unsigned long long)(overflowed - 1));
    job->row_starts[0] = 0;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) job->row_starts[i + 1] += job->row_starts[i];
    return status;
}

/// Adds `more` of each kernel's own square to the matrix, and `held` of what holds it.
static void add_ridge(const optimal_job *job, double more, double held) {
    for (uint32_t row = 0; row < job->set->count; row++) {
        uint64_t k = job->row_starts[row];
        while (job->columns[k] != row) k++;
        job->values[k] += (more + held * job->hold[row]) * job->diagonal[row];
    }
}

/// Takes R e off the sides: what is left to correct, so that a solution is as exact as that is small.
static void subtract_filtered(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const optimal_job *job = data;
    const ewa_acquire_stretch range = ewa_acquire_range(job->set, part);
    for (uint32_t row = range.first; row < range.end; row++) {
        double *side = job->sides + (size_t)row * job->channel_count;
        for (uint64_t k = job->row_starts[row]; k < job->row_starts[row + 1]; k++)
            for (uint32_t c = 0; c < job->channel_count; c++)
                side[c] -= job->values[k] * job->colors[job->columns[k]][c];
    }
}

/// What the sum of all kernels is on the mean, weighted by the kernels.
static double mean_sum(const optimal_job *job) {
    double pairs = 0, mass = 0;
    for (uint64_t k = 0; k < job->row_starts[job->set->count]; k++) pairs += job->values[k];
    for (uint32_t i = 0; i < job->set->count; i++) mass += job->mass[i];
    return mass > 0 ? pairs / mass : 1;
}

static ewa_status solve(optimal_job *job, const ewa_acquire_options *options, ewa_acquire_report *report) {
    ewa_context *context = job->set->context;
    const uint32_t count = job->set->count, channels = job->channel_count;
    const ewa_sparse matrix = {count, job->row_starts, job->columns, job->values};
    ewa_sparse_options how = {.tolerance = SOLUTION_TOLERANCE, .unsolved_severity = EWA_SEVERITY_INFO};
    const double scale = job->fit == EWA_FIT_SUM ? mean_sum(job) : 1;
    ewa_sparse_report solved = {0};
    ewa_status status = EWA_ERROR_NUMERIC;
    double ridge = 0;
    for (int try = 0; try < RIDGE_TRIES && status == EWA_ERROR_NUMERIC; try++) {
        const double next = try ? 10 * ridge : options->ridge;
        if (try) ewa_report(context, EWA_SEVERITY_INFO, "texture: not definite, the ridge becomes %g", next);
        add_ridge(job, next - ridge, try ? 0 : 1);
        ridge = next;
        if (try == RIDGE_TRIES - 1) how.unsolved_severity = EWA_SEVERITY_ERROR;
        status = ewa_sparse_solve(context, &matrix, channels, job->sides, job->solution, &how, &solved);
    }
    EWA_TRY(status);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++)
            job->colors[i][c] = scale * (job->colors[i][c] + job->solution[(size_t)i * channels + c]);
    report->iterations = solved.method == EWA_SPARSE_GRADIENT ? solved.iterations : 0;
    report->gradient = solved.residual;
    report->ridge = ridge;
    return EWA_OK;
}

ewa_status ewa_acquire_optimize(const ewa_acquire_set *set, const ewa_acquire_options *options,
                                uint32_t channel_count, double (*colors)[4], ewa_acquire_report *report) {
    ewa_context *context = set->context;
    const size_t count = set->count;
    optimal_job job = {.set = set, .fit = options->fit, .channel_count = channel_count, .colors = colors};
    job.scale = 1 / (3.141592653589793 * set->usual_sigma_world * set->usual_sigma_world);
    if (!(job.scale < INFINITY)) job.scale = 1;
    uint64_t pairs = 0;
    ewa_status status = ewa_acquire_grid_make(set, &job.grid);
    job.row_starts = ewa_allocate(context, count + 1, sizeof *job.row_starts);
    job.diagonal = ewa_allocate(context, count, sizeof *job.diagonal);
    job.mass = ewa_allocate(context, count, sizeof *job.mass);
    job.hold = ewa_allocate(context, count, sizeof *job.hold);
    job.sides = ewa_allocate(context, count * channel_count, sizeof *job.sides);
    job.solution = ewa_allocate(context, count * channel_count, sizeof *job.solution);
    if (status == EWA_OK &&
        !(job.row_starts && job.diagonal && job.mass && job.hold && job.sides && job.solution))
        status = EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = count_pairs(&job);
    if (status == EWA_OK) {
        pairs = report->pair_count = job.row_starts[count];
        job.columns = ewa_allocate(context, pairs, sizeof *job.columns);
        job.values = ewa_allocate(context, pairs, sizeof *job.values);
        if (!job.columns || !job.values) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK) status = ewa_acquire_run(set, fill_rows, &job, 0.3, 0.95);
    if (status == EWA_OK) status = ewa_acquire_run(set, subtract_filtered, &job, 0.95, 1);
    ewa_acquire_grid_free(&job.grid);
    if (status == EWA_OK) status = solve(&job, options, report);
    ewa_release(context, job.row_starts, count + 1, sizeof *job.row_starts);
    ewa_release(context, job.diagonal, count, sizeof *job.diagonal);
    ewa_release(context, job.mass, count, sizeof *job.mass);
    ewa_release(context, job.hold, count, sizeof *job.hold);
    ewa_release(context, job.sides, count * channel_count, sizeof *job.sides);
    ewa_release(context, job.solution, count * channel_count, sizeof *job.solution);
    ewa_release(context, job.columns, pairs, sizeof *job.columns);
    ewa_release(context, job.values, pairs, sizeof *job.values);
    return status;
}
