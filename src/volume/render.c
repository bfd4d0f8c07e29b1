// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of volumes: an object whose memory survives, and the order of a frame's stages. Reference:
// src/reference/volume.c.
#include "volume/render.h"
#include "base/base.h"
#include "volume/backend.h"
#include "volume/options.h"

struct ewa_volume_renderer {
    ewa_context *context;
    const ewa_volume_kernels *kernels;
    ewa_volume_bins bins;
    ewa_near_list near;
    uint32_t worker_count;
    ewa_point_filter filters[EWA_FILTER_COUNT];
    ewa_footprint_table table;
    ewa_volume_scratch *scratch; ///< one per worker
    const ewa_volume_backend *backend; ///< NULL: none
    void *backend_state;
    bool used_backend; ///< for the last frame
    ewa_volume_stats device_stats; ///< what it counted then
    char remark[160];  ///< why it was, or was not
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
    if (old->backend) old->backend->destroy(context, old->backend_state);
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_volume_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_volume_bins_free(context, &old->bins);
    ewa_near_list_free(context, &old->near);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

void ewa_volume_renderer_use(ewa_volume_renderer *renderer, const ewa_volume_backend *backend, void *state) {
    renderer->backend = backend, renderer->backend_state = state;
}

bool ewa_volume_renderer_describe(const ewa_volume_renderer *renderer, ewa_renderer_info *info, const char **remark) {
    *remark = renderer->remark;
    if (renderer->used_backend) renderer->backend->describe(renderer->backend_state, info);
    return renderer->used_backend;
}

void ewa_volume_frame_measure(const ewa_volume_renderer *renderer, const ewa_volume_frame *frame,
                              ewa_volume_stats *stats) {
    *stats = (ewa_volume_stats){.voxel_count = frame->job.level->voxel_count,
                                .culled_count = renderer->bins.culled_voxel_count,
                                .near_count = renderer->near.count,
                                .bin_s = (frame->binned_s - frame->start_s) * renderer->worker_count};
    for (uint32_t i = 0; i < renderer->worker_count && !renderer->used_backend; i++) {
        const ewa_volume_scratch *s = &renderer->scratch[i];
        stats->hidden_count += s->hidden_count;
        stats->splat_count += s->splat_count;
        stats->point_count += s->point_count;
        stats->setup_s += s->setup_s;
        stats->points_s += s->points_s;
        stats->splats_s += s->splats_s;
        stats->resolve_s += s->resolve_s;
    }
    if (renderer->used_backend) {
        const ewa_volume_stats *s = &renderer->device_stats;
        stats->splat_count = s->splat_count, stats->point_count = s->point_count;
        stats->setup_s = s->setup_s, stats->points_s = s->points_s, stats->splats_s = s->splats_s;
    }
    const uint64_t drawn = stats->splat_count + stats->point_count;
    if (drawn) stats->point_share = (double)stats->point_count / (double)drawn;
    stats->total_s = ewa_now_s() - frame->start_s;
}

const ewa_context *ewa_volume_renderer_context(const ewa_volume_renderer *renderer) {
    return renderer->context;
}

ewa_status ewa_volume_level_check(ewa_context *context, const ewa_voxels *voxels,
                                  const ewa_volume_options *options) {
    if (options->level < voxels->level_count) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_ARGUMENT, "volume: level is %u, the voxels have %u levels",
                    options->level, voxels->level_count);
}

ewa_status ewa_volume_frame_make(ewa_volume_renderer *renderer, const ewa_voxels *voxels,
                                 const ewa_camera *camera, const ewa_volume_options *options, bool with_times,
                                 ewa_volume_frame *frame) {
    ewa_context *context = renderer->context;
    const ewa_voxel_level *level = &voxels->levels[options->level];
    frame->start_s = ewa_now_s();
    renderer->used_backend = false;
    ewa_grid_view_make(&frame->grid, level->index_to_world, voxels->info.spacing_world, camera, options);
    ewa_volume_slices_make(&frame->slices, level, &frame->grid, options);
    ewa_volume_shading_make(options, &frame->shading);
    frame->job = (ewa_volume_job){.kernels = renderer->kernels,
                                  .level = level,
                                  .bins = &renderer->bins,
                                  .near = &renderer->near,
                                  .grid = &frame->grid,
                                  .slices = &frame->slices,
                                  .filters = (const ewa_point_filter *)renderer->filters,
                                  .surface_depth = options->surface_depth,
                                  .with_times = with_times,
                                  .scratch = renderer->scratch};
    ewa_ray_sections_make(&frame->job.sections, camera, (const double(*)[4])options->section_planes,
                          options->section_count);
    ewa_volume_view_set(&frame->job.view, &frame->grid, &frame->slices, voxels, camera, options,
                        &frame->shading, &renderer->table);
    ewa_status status =
        ewa_volume_bins_fill(context, &renderer->bins, level, &frame->grid, &frame->slices, camera);
    if (status == EWA_OK)
        status = ewa_near_list_fill(context, &renderer->near, renderer->kernels, &frame->job.view, level,
                                    &frame->grid, &renderer->bins, camera);
    frame->binned_s = ewa_now_s();
    return status;
}

ewa_status ewa_volume_frame_reserve(ewa_volume_renderer *renderer, const ewa_volume_frame *frame) {
    for (uint32_t i = 0; i < renderer->worker_count; i++)
        EWA_TRY(ewa_volume_scratch_reserve(renderer->context, &renderer->scratch[i], &frame->job));
    return EWA_OK;
}

/// Draws a frame that is set up, by the back end or the processor.
static ewa_status draw_frame(ewa_volume_renderer *renderer, const ewa_voxels *voxels, ewa_volume_frame *frame) {
    const ewa_volume_backend *backend = renderer->backend;
    if (backend)
        EWA_TRY(backend->draw(renderer->backend_state, voxels, frame, &renderer->device_stats, &renderer->used_backend, renderer->remark,
                              sizeof renderer->remark));
    if (renderer->used_backend) return EWA_OK;
    const double start_s = ewa_now_s();
    EWA_TRY(ewa_volume_frame_reserve(renderer, frame));
    EWA_TRY(ewa_parallel_stoppable(renderer->context, "volume", ewa_volume_tile_draw, &frame->job,
                                   ewa_tiles_count(&renderer->bins.tiles)));
    if (backend) backend->learn(renderer->backend_state, ewa_now_s() - start_s);
    return EWA_OK;
}

ewa_status ewa_volume_render(ewa_volume_renderer *renderer, const ewa_voxels *voxels,
                             const ewa_camera *camera, const ewa_volume_options *options,
                             const ewa_frame *frame, ewa_volume_stats *stats) {
    if (!renderer || !voxels || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = renderer->context;
    ewa_volume_options chosen;
    EWA_TRY(ewa_volume_options_choose(context, options, &chosen));
    EWA_TRY(ewa_camera_check(context, camera));
    EWA_TRY(ewa_volume_level_check(context, voxels, &chosen));
    EWA_TRY(ewa_progress(context, "volume", 0));

    ewa_volume_frame drawn;
    EWA_TRY(ewa_volume_frame_make(renderer, voxels, camera, &chosen, stats != NULL, &drawn));
    ewa_volume_job *job = &drawn.job;
    job->view.with_depth = frame->depth || frame->normal;
    const ewa_surface_planes surface = EWA_SURFACE_PLANES_OF(&chosen);
    ewa_volume_target_set(&job->target, camera, frame, &surface, chosen.background);
    EWA_TRY(draw_frame(renderer, voxels, &drawn));
    if (stats) ewa_volume_frame_measure(renderer, &drawn, stats);
    return EWA_OK;
}
