// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How near a picture is to the true one: PSNR and the structural similarity, in what a screen shows.
//
// Based on: Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", 2004, equation 13; window and edges as 3DGS reports it, where nothing lies beyond a picture.
#include "base/base.h"
#include "ewa/photos.h"
#include "image/srgb.h"
#include "math/gaussian.h"

#include <math.h>

enum { RADIUS = 5, TAPS = 2 * RADIUS + 1, MOMENTS = 5 };

static const double SIGMA_PX = 1.5, MEANS = 0.01 * 0.01, VARIANCES = 0.03 * 0.03;

typedef struct quality_job {
    const ewa_image *image, *reference;
    uint32_t width_px, height_px;
    float *shown[2]; ///< [3][height][width] display values; 0 where nothing is compared
    bool *counts;    ///< [height][width]
    double taps[TAPS];
    double *columns; ///< [worker][MOMENTS][width]
    double *rows;    ///< [height][2]: sums of squares of differences and of similarities
} quality_job;

static float display_of(const ewa_image *image, size_t pixel, uint32_t channel) {
    const float *at = image->pixels + pixel * image->channel_count;
    return ewa_srgb_from_linear(at[image->channel_count < 3 ? 0 : channel]);
}

/// Display values of a row, and which of its pixels count.
static void show_row(void *data, uint32_t y, uint32_t worker) {
    (void)worker;
    const quality_job *job = data;
    const size_t size = (size_t)job->width_px * job->height_px;
    for (uint32_t x = 0; x < job->width_px; x++) {
        const size_t pixel = (size_t)y * job->width_px + x;
        const ewa_image *reference = job->reference;
        bool counts = reference->channel_count != 4 || reference->pixels[4 * pixel + 3] > 0.999f;
        for (uint32_t c = 0; c < reference->channel_count; c++)
            counts = counts && isfinite(reference->pixels[pixel * reference->channel_count + c]);
        job->counts[pixel] = counts;
        for (uint32_t c = 0; c < 3; c++) {
            job->shown[0][c * size + pixel] = counts ? display_of(job->image, pixel, c) : 0;
            job->shown[1][c * size + pixel] = counts ? display_of(reference, pixel, c) : 0;
        }
    }
}

/// Of a row and a channel the moments under the window's columns.
static void sum_columns(const quality_job *job, uint32_t channel, uint32_t y, double *columns) {
    const size_t size = (size_t)job->width_px * job->height_px;
    for (size_t i = 0; i < (size_t)MOMENTS * job->width_px; i++) columns[i] = 0;
    for (int k = 0; k < TAPS; k++) {
        const int64_t row = (int64_t)y + k - RADIUS;
        if (row < 0 || row >= job->height_px) continue;
        const float *a = job->shown[0] + channel * size + (size_t)row * job->width_px;
        const float *b = job->shown[1] + channel * size + (size_t)row * job->width_px;
        for (uint32_t x = 0; x < job->width_px; x++) {
            const double p = (double)a[x], q = (double)b[x], weight = job->taps[k];
            double *to = columns + (size_t)MOMENTS * x;
            to[0] += weight * p, to[1] += weight * q;
            to[2] += weight * p * p, to[3] += weight * q * q, to[4] += weight * p * q;
        }
    }
}

static double similarity_at(const quality_job *job, const double *columns, uint32_t x) {
    double m[MOMENTS] = {0};
    for (int k = 0; k < TAPS; k++) {
        const int64_t column = (int64_t)x + k - RADIUS;
        if (column < 0 || column >= job->width_px) continue;
        for (int i = 0; i < MOMENTS; i++) m[i] += job->taps[k] * columns[MOMENTS * column + i];
    }
    const double both = m[0] * m[1], squares = m[0] * m[0] + m[1] * m[1];
    return (2 * both + MEANS) * (2 * (m[4] - both) + VARIANCES) /
           ((squares + MEANS) * (m[2] + m[3] - squares + VARIANCES));
}

static void compare_row(void *data, uint32_t y, uint32_t worker) {
    const quality_job *job = data;
    const size_t size = (size_t)job->width_px * job->height_px;
    double *columns = job->columns + (size_t)worker * MOMENTS * job->width_px, sums[2] = {0, 0};
    for (uint32_t c = 0; c < 3; c++) {
        sum_columns(job, c, y, columns);
        for (uint32_t x = 0; x < job->width_px; x++) {
            const size_t pixel = (size_t)y * job->width_px + x;
            if (!job->counts[pixel]) continue;
            const double off = (double)job->shown[0][c * size + pixel] - (double)job->shown[1][c * size + pixel];
            sums[0] += off * off;
            sums[1] += similarity_at(job, columns, x);
        }
    }
    job->rows[2 * (size_t)y] = sums[0], job->rows[2 * (size_t)y + 1] = sums[1];
}

/// With the memory.
static ewa_status compare(ewa_context *context, quality_job *job, ewa_image_quality *quality) {
    double whole = 0, sums[2] = {0, 0};
    for (int k = 0; k < TAPS; k++) {
        job->taps[k] = ewa_exp(-0.5 * (k - RADIUS) * (k - RADIUS) / (SIGMA_PX * SIGMA_PX));
        whole += job->taps[k];
    }
    for (int k = 0; k < TAPS; k++) job->taps[k] /= whole;
    EWA_TRY(ewa_parallel_within(context, "compare", 0, 0.2, show_row, job, job->height_px));
    EWA_TRY(ewa_parallel_within(context, "compare", 0.2, 1, compare_row, job, job->height_px));
    const size_t size = (size_t)job->width_px * job->height_px;
    *quality = (ewa_image_quality){.psnr_db = NAN, .ssim = NAN};
    for (size_t i = 0; i < size; i++) quality->pixel_count += job->counts[i];
    for (size_t y = 0; y < job->height_px; y++) sums[0] += job->rows[2 * y], sums[1] += job->rows[2 * y + 1];
    if (!quality->pixel_count) return EWA_OK;
    const double numbers = 3 * (double)quality->pixel_count;
    quality->mean_squared_error = sums[0] / numbers;
    quality->psnr_db = -10 * log10(quality->mean_squared_error);
    quality->ssim = sums[1] / numbers;
    return EWA_OK;
}

ewa_status ewa_image_compare(const ewa_image *image, const ewa_image *reference, ewa_image_quality *quality) {
    if (!image || !reference || !quality || !image->context || !image->pixels || !reference->pixels) return EWA_ERROR_ARGUMENT;
    ewa_context *context = image->context;
    *quality = (ewa_image_quality){.psnr_db = NAN, .ssim = NAN};
    const ewa_image *const both[2] = {image, reference};
    for (int i = 0; i < 2; i++)
        if (both[i]->channel_count != 1 && both[i]->channel_count != 3 && both[i]->channel_count != 4)
            return ewa_fail(context, EWA_ERROR_ARGUMENT, "pictures of %u channels are not compared; 1, 3 or 4 are",
                            both[i]->channel_count);
    if (image->width_px != reference->width_px || image->height_px != reference->height_px)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "a picture of %u x %u pixels is not compared with one of %u x %u",
                        image->width_px, image->height_px, reference->width_px, reference->height_px);
    quality_job job = {.image = image, .reference = reference, .width_px = image->width_px, .height_px = image->height_px};
    const size_t size = (size_t)job.width_px * job.height_px;
    const size_t columns = (size_t)ewa_context_worker_count(context) * MOMENTS * job.width_px;
    for (int i = 0; i < 2; i++) job.shown[i] = ewa_allocate(context, 3 * size, sizeof *job.shown[i]);
    job.counts = ewa_allocate(context, size, sizeof *job.counts);
    job.columns = ewa_allocate(context, columns, sizeof *job.columns);
    job.rows = ewa_allocate(context, 2 * (size_t)job.height_px, sizeof *job.rows);
    const bool room = job.shown[0] && job.shown[1] && job.counts && job.columns && job.rows;
    const ewa_status status = room ? compare(context, &job, quality) : EWA_ERROR_MEMORY;
    for (int i = 0; i < 2; i++) ewa_release(context, job.shown[i], 3 * size, sizeof *job.shown[i]);
    ewa_release(context, job.counts, size, sizeof *job.counts);
    ewa_release(context, job.columns, columns, sizeof *job.columns);
    ewa_release(context, job.rows, 2 * (size_t)job.height_px, sizeof *job.rows);
    return status;
}
