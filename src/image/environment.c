// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Filtering an environment for its lookups: a pyramid whose texels cover the same solid shape everywhere.
//
// A texel of a level stands for a round patch of the sphere as large as the texel is high. Towards the poles
// texels are narrower than that by the sine of the colatitude: each row is averaged along itself by as much,
// so that one footprint, one angle, serves in all directions. Levels halve by areas on the sphere.
//
// Based on: L. Williams, "Pyramidal Parametrics", 1983; the layout is that of the latitude-longitude maps of
// the OpenEXR library.
#include "image/environment.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const float LARGEST = 1e8f;

/// sin(angle) in [0, pi] without the C library's, so that every machine gets the same pictures: the series
/// around pi / 2, within 1e-15.
static double sine(double angle) {
    const double x2 = (angle - PI / 2) * (angle - PI / 2);
    double sum = 1;
    for (int k = 22; k > 0; k -= 2) sum = 1 - x2 / (k * (k - 1)) * sum;
    return sum;
}

/// Of the middle of a row.
static double sine_of_row(const ewa_environment_level *level, uint32_t row) {
    return sine(PI * (row + 0.5) / level->height);
}

static float light_of(float value) {
    return !(value > 0) || !isfinite(value) ? 0 : value < LARGEST ? value : LARGEST;
}

static void copy_image(const ewa_image *image, const ewa_environment_level *level) {
    const size_t count = (size_t)image->width_px * image->height_px;
    for (size_t i = 0; i < count; i++) {
        const float *from = image->pixels + i * image->channel_count;
        for (uint32_t c = 0; c < 3; c++)
            level->texels[3 * i + c] = light_of(from[image->channel_count < 3 ? 0 : c]);
    }
}

/// Adds a level's row from column `from` to `to`, fractions of texels included, to `sum`, times `weight`.
static void add_columns(const ewa_environment_level *level, uint32_t row, double from, double to,
                        double weight, double sum[4]) {
    const float *texels = level->texels + 3 * (size_t)row * level->width;
    for (uint32_t x = (uint32_t)from; x < level->width && x < to; x++) {
        const double share = (fmin(x + 1.0, to) - fmax(x, from)) * weight;
        for (uint32_t c = 0; c < 3; c++) sum[c] += share * (double)texels[3 * (size_t)x + c];
        sum[3] += share;
    }
}

/// Averages `fine` by areas on the sphere into the half as wide and high `coarse`.
static void halve(const ewa_environment_level *fine, const ewa_environment_level *coarse) {
    const double columns = (double)fine->width / coarse->width, rows = (double)fine->height / coarse->height;
    for (uint32_t y = 0; y < coarse->height; y++) {
        const double top = y * rows, bottom = top + rows;
        for (uint32_t x = 0; x < coarse->width; x++) {
            double sum[4] = {0, 0, 0, 0};
            for (uint32_t row = (uint32_t)top; row < fine->height && row < bottom; row++) {
                const double share = fmin(row + 1.0, bottom) - fmax(row, top);
                if (share > 0)
                    add_columns(fine, row, x * columns, (x + 1) * columns, share * sine_of_row(fine, row),
                                sum);
            }
            for (uint32_t c = 0; c < 3; c++)
                coarse->texels[3 * ((size_t)y * coarse->width + x) + c] = (float)(sum[c] / sum[3]);
        }
    }
}

/// The sum of a row's first `end` texels, going around; `sums[k]` is that of the first k.
static double sum_until(const double *sums, uint32_t width, double end) {
    const double turns = floor(end / width), within = end - turns * width, whole = floor(within);
    const uint32_t k = whole < width ? (uint32_t)whole : width - 1;
    return turns * sums[width] + sums[k] + (within - k) * (sums[k + 1] - sums[k]);
}

/// Averages each row along itself over as many texels as the level's texels are high there. `sums` has room
/// for width + 1 numbers.
static void round_texels(const ewa_environment_level *level, double *sums) {
    const uint32_t width = level->width;
    for (uint32_t y = 0; y < level->height; y++) {
        const double wanted = width / (2.0 * level->height * sine_of_row(level, y));
        const double reach = fmin(wanted, width);
        if (reach <= 1) continue;
        float *row = level->texels + 3 * (size_t)y * width;
        for (uint32_t c = 0; c < 3; c++) {
            sums[0] = 0;
            for (uint32_t x = 0; x < width; x++) sums[x + 1] = sums[x] + (double)row[3 * (size_t)x + c];
            for (uint32_t x = 0; x < width; x++) {
                const double middle = x + 0.5;
                const double sum =
                    sum_until(sums, width, middle + reach / 2) - sum_until(sums, width, middle - reach / 2);
                row[3 * (size_t)x + c] = (float)fmax(0, sum / reach);
            }
        }
    }
}

static size_t number_count(const ewa_environment_level *level) {
    return 3 * (size_t)level->width * level->height;
}

/// Sets the sizes of all levels and allocates them.
static ewa_status allocate_levels(ewa_environment *environment, uint32_t width, uint32_t height) {
    for (;;) {
        ewa_environment_level *level = &environment->levels[environment->level_count++];
        *level = (ewa_environment_level){width, height, NULL};
        level->texels = ewa_allocate(environment->context, number_count(level), sizeof *level->texels);
        if (!level->texels) return EWA_ERROR_MEMORY;
        if (width == 1 && height == 1) return EWA_OK;
        width = width / 2 + width % 2, height = height / 2 + height % 2;
    }
}

static ewa_status fill_levels(ewa_environment *environment, const ewa_image *image) {
    const size_t sum_count = (size_t)image->width_px + 1;
    double *sums = ewa_allocate(environment->context, sum_count, sizeof *sums);
    if (!sums) return EWA_ERROR_MEMORY;
    copy_image(image, &environment->levels[0]);
    round_texels(&environment->levels[0], sums);
    for (uint32_t i = 1; i < environment->level_count; i++) {
        halve(&environment->levels[i - 1], &environment->levels[i]);
        round_texels(&environment->levels[i], sums);
    }
    ewa_release(environment->context, sums, sum_count, sizeof *sums);
    return EWA_OK;
}

ewa_status ewa_environment_create(const ewa_image *image, ewa_environment **environment) {
    if (!environment) return EWA_ERROR_ARGUMENT;
    *environment = NULL;
    if (!image || !image->pixels || !image->context || !image->width_px || !image->height_px)
        return EWA_ERROR_ARGUMENT;
    ewa_context *context = image->context;
    if (image->channel_count != 1 && image->channel_count != 3 && image->channel_count != 4)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "environment: an image of %u channels, not 1, 3 or 4",
                        image->channel_count);
    ewa_environment *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->serial = ewa_serial_next(context);
    ewa_status status = allocate_levels(made, image->width_px, image->height_px);
    if (status == EWA_OK) status = fill_levels(made, image);
    if (status == EWA_OK)
        *environment = made;
    else
        ewa_environment_destroy(&made);
    return status;
}

void ewa_environment_destroy(ewa_environment **environment) {
    if (!environment || !*environment) return;
    ewa_environment *old = *environment;
    for (uint32_t i = 0; i < old->level_count; i++)
        ewa_release(old->context, old->levels[i].texels, number_count(&old->levels[i]),
                    sizeof *old->levels[i].texels);
    ewa_release(old->context, old, 1, sizeof *old);
    *environment = NULL;
}
