// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The definition of forward texture mapping: one texel after another, in double precision, without tiles and
// levels.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3 (docs/math.md
// section 11).
#include "texture/texture.h"

#include <math.h>

enum { SUM_COUNT = 5 }; // weight, and weight times red, green, blue, alpha

/// First and last pixel, of `count`, whose centre is within `half_px` of a place.
static void pixel_range(double center_px, double half_px, uint32_t count, int64_t range[2]) {
    const double first = ceil(center_px - half_px - 0.5), last = floor(center_px + half_px - 0.5);
    range[0] = first > 0 ? (int64_t)fmin(first, count) : 0;
    range[1] = last < count ? (int64_t)fmax(last, -1) : (int64_t)count - 1;
}

/// Adds one texel to the sums of all pixels that it reaches.
static void add_texel(const ewa_texture_plan *plan, uint32_t column, uint32_t row, double *sums) {
    const double u = column + 0.5, v = row + 0.5;
    const ewa_texture_method method = plan->options.method;
    const bool as_point =
        method == EWA_TEXTURE_POINT || (method == EWA_TEXTURE_HYBRID && ewa_texel_is_minified(plan, u, v));
    ewa_texel_kernel kernel;
    if (!ewa_texel_place(plan, u, v, as_point, &kernel)) return;
    int64_t x_range[2], y_range[2];
    pixel_range(kernel.center_px[0], kernel.half_px[0], plan->target.width_px, x_range);
    pixel_range(kernel.center_px[1], kernel.half_px[1], plan->target.height_px, y_range);
    float color[4];
    ewa_texel_read(&plan->source, column, row, color);
    for (int64_t y = y_range[0]; y <= y_range[1]; y++) {
        for (int64_t x = x_range[0]; x <= x_range[1]; x++) {
            const double weight = ewa_texel_weight(plan, &kernel, (double)x + 0.5, (double)y + 0.5);
            double *sum = sums + SUM_COUNT * ((size_t)y * plan->target.width_px + (size_t)x);
            sum[0] += weight;
            for (int c = 0; c < 4; c++) sum[1 + c] += weight * color[c];
        }
    }
}

static void resolve(const ewa_texture_plan *plan, const double *sums) {
    for (uint32_t y = 0; y < plan->target.height_px; y++) {
        for (uint32_t x = 0; x < plan->target.width_px; x++, sums += SUM_COUNT) {
            float color[4] = {0};
            const bool covered = sums[0] > 0;
            for (int c = 0; c < 4 && covered; c++) color[c] = (float)(sums[1 + c] / sums[0]);
            ewa_texture_put(plan, x, y, color, covered ? (float)ewa_texture_coverage(plan, x, y) : 0);
        }
    }
}

static void interpolate(const ewa_texture_plan *plan) {
    for (uint32_t y = 0; y < plan->target.height_px; y++) {
        for (uint32_t x = 0; x < plan->target.width_px; x++) {
            float color[4] = {0};
            const bool covered = ewa_texture_interpolate(plan, x, y, color);
            ewa_texture_put(plan, x, y, color, covered ? (float)ewa_texture_coverage(plan, x, y) : 0);
        }
    }
}

ewa_status ewa_texture_map_reference(ewa_context *context, const ewa_texture_source *source,
                                     const ewa_mat3 *map, const ewa_texture_options *options,
                                     const ewa_texture_target *target) {
    ewa_texture_plan plan;
    EWA_TRY(ewa_texture_plan_make(context, source, map, options, target, &plan));
    if (plan.options.repeat)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: the reference does not repeat textures");
    if (plan.options.method == EWA_TEXTURE_BILINEAR) {
        interpolate(&plan);
        return EWA_OK;
    }
    const size_t pixel_count = (size_t)target->width_px * target->height_px;
    double *sums = ewa_allocate_zeroed(context, pixel_count, SUM_COUNT * sizeof *sums);
    if (!sums) return EWA_ERROR_MEMORY;
    for (uint32_t row = 0; row < source->height_px; row++)
        for (uint32_t column = 0; column < source->width_px; column++) add_texel(&plan, column, row, sums);
    resolve(&plan, sums);
    ewa_release(context, sums, pixel_count, SUM_COUNT * sizeof *sums);
    return EWA_OK;
}
