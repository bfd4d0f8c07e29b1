// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Forward texture mapping, tile by tile: levels, walk, sums, pixels.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3 (docs/math.md
// section 11).
#include "texture/texture.h"

#include <string.h>

enum {
    SUM_PIXELS = EWA_TEXTURE_PITCH * EWA_TEXTURE_PITCH,
    LEVEL_PAIRS = EWA_TEXTURE_MAX_LEVELS * EWA_TEXTURE_MAX_LEVELS,
};

/// Share of the texture that levels have to spare to be worth making.
static const double LEVELS_PAY = 0.5;

/// One worker's memory.
typedef struct workspace {
    float color[4 * SUM_PIXELS];
    float weight[SUM_PIXELS];
    float coverage[EWA_TEXTURE_TILE * EWA_TEXTURE_TILE];
    ewa_texture_block block;
    uint8_t wanted[LEVEL_PAIRS];
    ewa_texture_brush brush;
} workspace;

typedef struct texture_job {
    const ewa_texture_plan *plan;
    workspace *workspaces; ///< one per worker
    ewa_tiles tiles;
} texture_job;

static void choose_brush(const ewa_texture_plan *plan, ewa_texture_brush *brush) {
    const double h = plan->options.prefilter_px, f = plan->options.cutoff, sigma = plan->options.sigma_texels;
    brush->kernels = EWA_CHOOSE(ewa_context_cpu_features(plan->context), ewa_texture_kernels);
    brush->filter = (ewa_texel_filter){.cutoff2 = (float)(f * f),
                                       .prefilter2 = (float)(h * h),
                                       .reach_px = (float)(f * h),
                                       .sigma = (float)sigma,
                                       .determinant = (float)(sigma * sigma * plan->determinant)};
}

/// Finds the levels that a tile needs.
static void measure_tile(void *data, uint32_t index, uint32_t worker) {
    const texture_job *job = data;
    workspace *space = &job->workspaces[worker];
    const ewa_tile_rect tile = ewa_tiles_rect(&job->tiles, index);
    space->brush.wanted = space->wanted;
    ewa_texture_walk(job->plan, &space->brush, tile.x_px, tile.y_px);
    space->brush.wanted = NULL;
}

static void interpolate_tile(const ewa_texture_plan *plan, workspace *space, const ewa_tile_rect *tile) {
    for (uint32_t row = 0; row < tile->height_px; row++) {
        for (uint32_t column = 0; column < tile->width_px; column++) {
            const size_t at = (size_t)(row + 1) * EWA_TEXTURE_PITCH + column + 1;
            if (!ewa_texture_interpolate(plan, tile->x_px + column, tile->y_px + row, space->color + 4 * at))
                continue;
            if (plan->with_alpha) space->weight[at] = 1;
        }
    }
}

static void write_tile(const ewa_texture_plan *plan, workspace *space, const ewa_tile_rect *tile) {
    const bool inside = ewa_texture_covers(plan, tile->x_px, tile->y_px, tile->width_px, tile->height_px);
    for (uint32_t row = 0; !inside && row < tile->height_px; row++)
        for (uint32_t column = 0; column < tile->width_px; column++)
            space->coverage[row * EWA_TEXTURE_TILE + column] =
                (float)ewa_texture_coverage(plan, tile->x_px + column, tile->y_px + row);
    space->brush.kernels->resolve(&plan->target, plan->options.background, tile, &space->brush.sums,
                                  inside ? NULL : space->coverage);
}

static void draw_tile(void *data, uint32_t index, uint32_t worker) {
    const texture_job *job = data;
    const ewa_texture_plan *plan = job->plan;
    const ewa_tile_rect tile = ewa_tiles_rect(&job->tiles, index);
    workspace *space = &job->workspaces[worker];
    memset(space->color, 0, sizeof space->color);
    if (plan->with_alpha) memset(space->weight, 0, sizeof space->weight);
    if (plan->options.method == EWA_TEXTURE_BILINEAR)
        interpolate_tile(plan, space, &tile);
    else
        ewa_texture_walk(plan, &space->brush, tile.x_px, tile.y_px);
    write_tile(plan, space, &tile);
}

/// Measures, makes the levels, draws.
static ewa_status draw_all(ewa_texture_plan *plan, texture_job *job, ewa_texture_stats *stats) {
    const uint32_t tile_count = ewa_tiles_count(&job->tiles);
    const uint32_t worker_count = ewa_context_worker_count(plan->context);
    const ewa_texture_method method = plan->options.method;
    ewa_status status = EWA_OK;
    if (method == EWA_TEXTURE_HYBRID || method == EWA_TEXTURE_POINT) {
        const double started_s = ewa_now_s();
        EWA_TRY(ewa_parallel_stoppable(plan->context, "levels", measure_tile, job, tile_count));
        uint8_t *wanted = job->workspaces[0].wanted;
        double spared = 0;
        for (uint32_t k = 0; k < worker_count; k++) {
            spared += job->workspaces[k].brush.spared_texels;
            for (uint32_t i = 0; i < LEVEL_PAIRS; i++) wanted[i] |= job->workspaces[k].wanted[i];
        }
        // To make levels is to read the texture about once.
        const double texel_count = (double)plan->source.width_px * plan->source.height_px;
        plan->flat = !plan->options.repeat && spared < LEVELS_PAY * texel_count;
        if (!plan->flat) status = ewa_texture_levels_make(plan, wanted, stats);
        stats->levels_s = ewa_now_s() - started_s;
    }
    EWA_TRY(status);
    EWA_TRY(ewa_parallel_stoppable(plan->context, "texture", draw_tile, job, tile_count));
    for (uint32_t k = 0; k < worker_count; k++) {
        const ewa_texture_counts *counts = &job->workspaces[k].brush.counts;
        stats->splat_count += counts->splat_count;
        stats->point_count += counts->point_count;
        stats->texel_count += counts->texel_count;
        stats->point_texel_count += counts->point_texel_count;
    }
    return EWA_OK;
}

ewa_status ewa_texture_map(ewa_context *context, const ewa_texture_source *source, const ewa_mat3 *map,
                           const ewa_texture_options *options, const ewa_texture_target *target,
                           ewa_texture_stats *stats) {
    const double started_s = ewa_now_s();
    ewa_texture_plan plan;
    EWA_TRY(ewa_texture_plan_make(context, source, map, options, target, &plan));
    plan.flat = plan.options.method == EWA_TEXTURE_SPLAT;
    const uint32_t worker_count = ewa_context_worker_count(context);
    workspace *workspaces = ewa_allocate(context, worker_count, sizeof *workspaces);
    if (!workspaces) return EWA_ERROR_MEMORY;
    for (uint32_t k = 0; k < worker_count; k++) {
        workspace *space = &workspaces[k];
        memset(space->wanted, 0, sizeof space->wanted);
        memset(&space->block, 0, sizeof space->block);
        memset(space->coverage, 0, sizeof space->coverage);
        memset(&space->brush, 0, sizeof space->brush);
        choose_brush(&plan, &space->brush);
        space->brush.sums = (ewa_texture_sums){space->color, plan.with_alpha ? space->weight : NULL};
        space->brush.block = &space->block;
    }
    texture_job job = {&plan, workspaces,
                       ewa_tiles_make(target->width_px, target->height_px, EWA_TEXTURE_TILE)};
    ewa_texture_stats counted = {0};
    ewa_status status = draw_all(&plan, &job, &counted);
    ewa_texture_levels_free(&plan);
    ewa_release(context, workspaces, worker_count, sizeof *workspaces);
    counted.total_s = ewa_now_s() - started_s;
    if (stats) *stats = counted;
    return status;
}
