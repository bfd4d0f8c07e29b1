// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of volumes: an object whose memory survives, and the order of a frame's stages. Reference:
// src/reference/volume.c.
#include "base/base.h"
#include "volume/options.h"
#include "volume/tile.h"

struct ewa_volume_renderer {
    ewa_context *context;
    const ewa_volume_kernels *kernels;
    ewa_volume_bins bins;
    ewa_near_list near;
    uint32_t worker_count;
    ewa_point_filter filters[EWA_FILTER_COUNT];
    ewa_footprint_table table;
    ewa_volume_scratch *scratch; ///< one per worker
};

ewa_status ewa_volume_renderer_create(ewa_context *context, ewa_volume_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    const uint32_t worker_count = ewa_context_worker_count(context);
    ewa_volume_renderer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_volume_kernels);
    made->worker_count = worker_count;
    ewa_point_filters_make(made->filters);
    ewa_footprint_table_make(&made->table);
    made->scratch = ewa_allocate_zeroed(context, worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        ewa_volume_renderer_destroy(&made);
        return EWA_ERROR_MEMORY;
    }
    *renderer = made;
    return EWA_OK;
}

void ewa_volume_renderer_destroy(ewa_volume_renderer **renderer) {
    if (!renderer || !*renderer) return;
    ewa_volume_renderer *old = *renderer;
    ewa_context *context = old->context;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_volume_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_volume_bins_free(context, &old->bins);
    ewa_near_list_free(context, &old->near);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

static void gather_stats(const ewa_volume_renderer *renderer, const ewa_voxel_level *level, double start_s,
                         double binned_s, ewa_volume_stats *stats) {
    *stats = (ewa_volume_stats){.voxel_count = level->voxel_count,
                                .culled_count = renderer->bins.culled_voxel_count,
                                .near_count = renderer->near.count,
                                .bin_s = (binned_s - start_s) * renderer->worker_count};
    for (uint32_t i = 0; i < renderer->worker_count; i++) {
        const ewa_volume_scratch *s = &renderer->scratch[i];
        stats->hidden_count += s->hidden_count;
        stats->splat_count += s->splat_count;
        stats->point_count += s->point_count;
        stats->setup_s += s->setup_s;
        stats->points_s += s->points_s;
        stats->splats_s += s->splats_s;
        stats->resolve_s += s->resolve_s;
    }
    const uint64_t drawn = stats->splat_count + stats->point_count;
    if (drawn) stats->point_share = (double)stats->point_count / (double)drawn;
    stats->total_s = ewa_now_s() - start_s;
}

ewa_status ewa_volume_render(ewa_volume_renderer *renderer, const ewa_voxels *voxels,
                             const ewa_camera *camera, const ewa_volume_options *options,
                             const ewa_frame *frame, ewa_volume_stats *stats) {
    if (!renderer || !voxels || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = renderer->context;
    const double start_s = ewa_now_s();
    ewa_volume_options chosen;
    ewa_status status = ewa_volume_options_choose(context, options, &chosen);
    if (status == EWA_OK) status = ewa_camera_check(context, camera);
    if (status == EWA_OK) status = ewa_volume_frame_check(context, frame);
    if (status == EWA_OK && chosen.level >= voxels->level_count)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: level is %u, the voxels have %u levels",
                          chosen.level, voxels->level_count);
    if (status == EWA_OK) status = ewa_progress(context, "volume", 0);
    if (status != EWA_OK) return status;

    const ewa_voxel_level *level = &voxels->levels[chosen.level];
    ewa_grid_view grid;
    ewa_volume_slices slices;
    ewa_shading_setup shading;
    ewa_grid_view_make(&grid, level->index_to_world, voxels->info.spacing_world, camera, &chosen);
    ewa_volume_slices_make(&slices, level, &grid, &chosen);
    ewa_volume_shading_make(&chosen, &shading);
    ewa_volume_job job = {.kernels = renderer->kernels,
                          .level = level,
                          .bins = &renderer->bins,
                          .near = &renderer->near,
                          .grid = &grid,
                          .slices = &slices,
                          .filters = (const ewa_point_filter *)renderer->filters,
                          .surface_depth = chosen.surface_depth,
                          .with_times = stats != NULL,
                          .scratch = renderer->scratch};
    ewa_volume_view_set(&job.view, &grid, &slices, voxels, camera, &chosen, &shading, &renderer->table);
    job.view.with_depth = frame->depth != NULL;
    ewa_volume_target_set(&job.target, camera, frame, chosen.surface_rgba, chosen.background);
    status = ewa_volume_bins_fill(context, &renderer->bins, level, &grid, &slices, camera);
    if (status == EWA_OK)
        status = ewa_near_list_fill(context, &renderer->near, renderer->kernels, &job.view, level, &grid,
                                    &renderer->bins, camera);
    const double binned_s = ewa_now_s();
    for (uint32_t i = 0; i < renderer->worker_count && status == EWA_OK; i++)
        status = ewa_volume_scratch_reserve(context, &renderer->scratch[i], &job);
    if (status != EWA_OK) return status;
    status = ewa_parallel_stoppable(context, "volume", ewa_volume_tile_draw, &job,
                                    ewa_tiles_count(&renderer->bins.tiles));
    if (status == EWA_OK && stats) gather_stats(renderer, level, start_s, binned_s, stats);
    return status;
}
