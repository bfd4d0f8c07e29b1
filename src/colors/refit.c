// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours of points as coefficients of their kernels: the picture blends kernels, divided by their sum, so
// that it shows at a point a mean of the colours around. What is solved here is B w = c with B the weights of
// that mean (refit_kernels.c) and c the colours, in the sense of
//     min |B w - c|^2 + damping |w - c|^2,
// by conjugate gradients on the normal equations for x = w - c, (B'B + damping) x = B'(c - B c). B'B is never
// formed; B is well conditioned (docs/colors.md), and where points almost coincide the damping keeps their
// coefficients near their colours.
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "colors/gradient.h"
#include "colors/refit_kernels.h"
#include "homogeneous/vec.h"

#include <math.h>
#include <string.h>

enum {
    CHANNELS = 3,
    BLOCK_ROWS = EWA_GRADIENT_BLOCK_ROWS,
    MAX_STEPS = 400,
};

// By measurement (docs/colors.md). Interpolation: the error at the points is below a hundredth of what it was
// where points keep their distance; where they almost coincide no coefficient grows beyond about 30 times its
// error. Fit: noise of the colours is not made stronger.
static const double INTERPOLATE_DAMPING = 3e-4;
static const double FIT_DAMPING = 0.1;
// The gradient, relative to the first, at which the steps end.
static const double TOLERANCE = 1e-4;

typedef struct refit_job {
    ewa_context *context;
    const ewa_cloud *cloud;
    ewa_solid solid;
    refit_matrix matrix;
    double damping;
    double *color;             // [count][CHANNELS]: c
    double *change, *gradient; // x = w - c, in the end w; and what is left of the normal equations
    double *image;             // B times a vector
    double *partial;           // [block_count]
    const double *from;        // what is multiplied
    uint32_t block_count;
} refit_job;

static uint32_t block_end(const refit_job *job, uint32_t block) {
    return ewa_gradient_block_end(job->matrix.count, block);
}

/// Row `row` of a matrix times a vector.
static inline void multiply_row(const refit_rows *rows, uint32_t row, const double *vector,
                                double sum[CHANNELS]) {
    for (int c = 0; c < CHANNELS; c++) sum[c] = 0;
    for (uint64_t e = rows->starts[row]; e < rows->starts[row + 1]; e++) {
        const double weight = (double)rows->values[e], *at = vector + (size_t)rows->columns[e] * CHANNELS;
        for (int c = 0; c < CHANNELS; c++) sum[c] += weight * at[c];
    }
}

/// image = c - B from where there is an equation; sums of its squares.
static void rest_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    refit_job *job = data;
    double sum[CHANNELS];
    job->partial[block] = 0;
    for (uint32_t row = block * BLOCK_ROWS; row < block_end(job, block); row++) {
        const bool given = job->matrix.forward.starts[row] < job->matrix.forward.starts[row + 1];
        multiply_row(&job->matrix.forward, row, job->from, sum);
        for (int c = 0; c < CHANNELS; c++) {
            const size_t i = (size_t)row * CHANNELS + (size_t)c;
            job->image[i] = given ? job->color[i] - sum[c] : 0;
            job->partial[block] += job->image[i] * job->image[i];
        }
    }
}

/// image = B from.
static void image_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    refit_job *job = data;
    for (uint32_t row = block * BLOCK_ROWS; row < block_end(job, block); row++)
        multiply_row(&job->matrix.forward, row, job->from, job->image + (size_t)row * CHANNELS);
}

/// The rows of a block: product = B' image + damping direction, `direction` NULL for 0.
static void back_rows(const void *system, uint32_t block, const double *direction, double *product) {
    const refit_job *job = system;
    for (uint32_t row = block * BLOCK_ROWS; row < block_end(job, block); row++) {
        const size_t first = (size_t)row * CHANNELS;
        multiply_row(&job->matrix.backward, row, job->image, product + first);
        for (size_t i = first; direction && i < first + CHANNELS; i++)
            product[i] += job->damping * direction[i];
    }
}

static void start_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    refit_job *job = data;
    back_rows(job, block, NULL, job->gradient);
}

static void make_image(void *system, const double *direction) {
    refit_job *job = system;
    job->from = direction;
    ewa_parallel(job->context, image_block, job, job->block_count);
}

/// Leaves c - B w in `image`; returns the root of its mean square over the rows with an equation.
static double find_rest(refit_job *job, const double *coefficients) {
    job->from = coefficients;
    ewa_parallel(job->context, rest_block, job, job->block_count);
    double sum = 0;
    for (uint32_t block = 0; block < job->block_count; block++) sum += job->partial[block];
    const uint64_t rows = job->matrix.count - job->matrix.empty_count;
    return rows ? sqrt(sum / (CHANNELS * (double)rows)) : 0;
}

static ewa_status solve(refit_job *job, ewa_refit_report *report) {
    report->before_rms = find_rest(job, job->color);
    ewa_parallel(job->context, start_block, job, job->block_count);
    const ewa_conjugate_gradient system = {.context = job->context,
                                 .size = job->matrix.count,
                                 .count = CHANNELS,
                                 .solution = job->change,
                                 .residual = job->gradient,
                                 .system = job,
                                 .prepare = make_image,
                                 .multiply = back_rows,
                                 .tolerance = TOLERANCE,
                                 .max_iterations = MAX_STEPS,
                                 .stage = "refit",
                                 .begin = 0.3,
                                 .end = 1};
    EWA_TRY(ewa_conjugate_gradient_run(&system, &report->iteration_count));
    for (size_t i = 0; i < (size_t)job->matrix.count * CHANNELS; i++) job->change[i] += job->color[i];
    report->after_rms = find_rest(job, job->change);
    return ewa_progress(job->context, "refit", 1);
}

static void read_block(void *data, uint32_t block, uint32_t worker) {
    (void)worker;
    refit_job *job = data;
    const ewa_attribute *color = ewa_cloud_find(job->cloud, EWA_COLOR);
    ewa_color_table table;
    ewa_color_table_make(&table);
    for (uint32_t row = block * BLOCK_ROWS; row < block_end(job, block); row++) {
        double value[4];
        ewa_attribute_read_f64(color, job->solid.surfels[row].point, 1, value);
        ewa_color_decode(&table, color, value, job->color + (size_t)row * CHANNELS);
    }
}

/// Allocates and fills the vectors of the solver; two more are changed in place.
static ewa_status open_vectors(refit_job *job) {
    const size_t count = (size_t)job->matrix.count * CHANNELS;
    job->block_count = ewa_gradient_blocks(job->matrix.count);
    double **const vectors[] = {&job->color, &job->change, &job->gradient, &job->image};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        if (!(*vectors[k] = ewa_allocate_zeroed(job->context, count, sizeof(double))))
            return EWA_ERROR_MEMORY;
    job->partial = ewa_allocate(job->context, job->block_count, sizeof *job->partial);
    if (!job->partial) return EWA_ERROR_MEMORY;
    ewa_parallel(job->context, read_block, job, job->block_count);
    return EWA_OK;
}

static void close_vectors(refit_job *job) {
    const size_t count = (size_t)job->matrix.count * CHANNELS;
    double *const vectors[] = {job->color, job->change, job->gradient, job->image};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        ewa_release(job->context, vectors[k], count, sizeof(double));
    ewa_release(job->context, job->partial, job->block_count, sizeof *job->partial);
}

/// Replaces the colours: all points get their linear colour, surfels their coefficients.
static ewa_status write_colors(ewa_cloud *cloud, const refit_job *job, ewa_refit_report *report) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    const uint32_t components = color->component_count;
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    float *linear = ewa_allocate(job->context, point_count * components, sizeof *linear), *stream;
    if (!linear) return EWA_ERROR_MEMORY;
    ewa_color_table table;
    ewa_color_table_make(&table);
    for (uint64_t i = 0; i < point_count; i++) {
        double value[4], rgb[3];
        ewa_attribute_read_f64(color, i, 1, value);
        ewa_color_decode(&table, color, value, rgb);
        for (int c = 0; c < CHANNELS; c++) linear[i * components + (uint64_t)c] = (float)rgb[c];
        if (components == 4) linear[4 * i + 3] = (float)ewa_color_alpha(color, value);
    }
    for (uint32_t row = 0; row < job->matrix.count; row++) {
        float *to = linear + (size_t)job->solid.surfels[row].point * components;
        for (int c = 0; c < CHANNELS; c++) {
            const size_t i = (size_t)row * CHANNELS + (size_t)c;
            to[c] = (float)job->change[i];
            report->low = to[c] < report->low ? to[c] : report->low;
            report->high = to[c] > report->high ? to[c] : report->high;
        }
    }
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, components, (void **)&stream);
    if (status == EWA_OK) memcpy(stream, linear, point_count * components * sizeof *stream);
    ewa_release(job->context, linear, point_count * components, sizeof *linear);
    return status;
}

#define AT(member) offsetof(ewa_refit_options, member)

static const ewa_option option_rows[] = {
    {"goal", EWA_OPTION_CHOICE, AT(goal), .words = "interpolate|fit",
     .help = "the picture has each point's colour at the point, or nearly, for noisy or aliased colours"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels will end where the cloud is drawn"},
};

const ewa_option_table ewa_refit_options_table = EWA_OPTION_TABLE(ewa_refit_options, option_rows);

void ewa_refit_options_init(ewa_refit_options *options, size_t struct_size) {
    ewa_options_init(&ewa_refit_options_table, options, struct_size);
}

static ewa_status check_colors(const ewa_cloud *cloud) {
    const ewa_attribute *color = ewa_cloud_find(cloud, EWA_COLOR);
    if (color && color->component_count >= 3) return EWA_OK;
    return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                    "refit: the cloud has no 'color' of 3 or 4 components");
}

ewa_status ewa_cloud_refit_colors(ewa_cloud *cloud, const ewa_refit_options *options,
                                  ewa_refit_report *report) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_refit_options chosen;
    ewa_refit_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(ewa_cloud_context(cloud), &ewa_refit_options_table, options, &chosen));
    EWA_TRY(check_colors(cloud));
    ewa_refit_report made = {.low = INFINITY, .high = -INFINITY};
    refit_job job = {.context = ewa_cloud_context(cloud),
                     .cloud = cloud,
                     .damping = chosen.goal == EWA_REFIT_FIT ? FIT_DAMPING : INTERPOLATE_DAMPING};
    double origin_world[3];
    ewa_cloud_origin(cloud, origin_world);
    EWA_TRY(ewa_progress(job.context, "refit", 0));
    ewa_status status = ewa_solid_open(cloud, "refit", origin_world, chosen.cutoff, &job.solid);
    if (status == EWA_OK) status = ewa_progress(job.context, "refit", 0.1);
    if (status == EWA_OK) status = ewa_refit_matrix_make(&job.solid, chosen.cutoff, &job.matrix);
    if (status == EWA_OK) status = ewa_progress(job.context, "refit", 0.3);
    if (status == EWA_OK) status = open_vectors(&job);
    if (status == EWA_OK) status = solve(&job, &made);
    if (status == EWA_OK) {
        made.surfel_count = job.matrix.count;
        made.left_out_count = job.matrix.empty_count;
        status = write_colors(cloud, &job, &made);
    }
    if (status == EWA_OK && report) *report = made;
    close_vectors(&job);
    ewa_refit_matrix_free(&job.matrix);
    ewa_solid_close(&job.solid);
    return status;
}
