// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer before its back end: a frame is begun, gets its sources, and is finished.
#include "surface/render.h"
#include "base/base.h"
#include "surface/backend.h"
#include "surface/budget.h"
#include "surface/levels.h"
#include "surface/options.h"
#include "surface/packets.h"
#include "surface/pipeline.h"
#include "surface/supersampling.h"

struct ewa_renderer {
    ewa_context *context;
    const ewa_backend *backend;
    void *state; ///< the back end's
    bool begun, parts_are_chosen;
    ewa_render_job job;
    ewa_buffer sources;
    ewa_buffer parts, mixing; ///< of pixels, and of pictures of these (supersampling.h)
    const ewa_surfels *const *parts_of; ///< borrowed: who say into how many parts pixels are divided
    uint32_t parts_of_count;            ///< 0: the sources do
    uint32_t tile_px; ///< 0: chosen
    ewa_budget budget;
};

ewa_status ewa_renderer_create_by(ewa_context *context, const ewa_backend *backend, ewa_renderer **renderer) {
    *renderer = NULL;
    ewa_renderer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->backend = backend;
    ewa_budget_start(&made->budget);
    const ewa_status status = made->backend->create(context, &made->state);
    if (status != EWA_OK) {
        ewa_release(context, made, 1, sizeof *made);
        return status;
    }
    *renderer = made;
    return EWA_OK;
}

ewa_status ewa_renderer_create(ewa_context *context, ewa_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    return ewa_renderer_create_by(context, &ewa_backend_cpu, renderer);
}

void ewa_renderer_destroy(ewa_renderer **renderer) {
    if (!renderer || !*renderer) return;
    ewa_renderer *old = *renderer;
    ewa_context *context = old->context;
    old->backend->destroy(context, old->state);
    ewa_buffer_free(context, &old->sources);
    ewa_buffer_free(context, &old->parts);
    ewa_buffer_free(context, &old->mixing);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

const ewa_backend *ewa_renderer_backend(const ewa_renderer *renderer, ewa_context **context, void **state) {
    *context = renderer->context;
    *state = renderer->state;
    return renderer->backend;
}

void ewa_renderer_set_tile(ewa_renderer *renderer, uint32_t tile_px) { renderer->tile_px = tile_px; }

ewa_status ewa_render_begin(ewa_renderer *renderer, const ewa_camera *camera,
                            const ewa_render_options *options, const ewa_frame *frame) {
    if (!renderer || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_render_job *job = &renderer->job;
    renderer->begun = false;
    *job = (ewa_render_job){.camera = *camera, .frame = *frame, .tile_px = renderer->tile_px};
    EWA_TRY(ewa_render_options_choose(renderer->context, options, &job->options));
    EWA_TRY(ewa_camera_check(renderer->context, camera));
    ewa_shading_setup_make(&job->options, &job->shading);
    job->end_row_px = camera->height_px;
    job->parts = (ewa_division){.count = job->options.supersampling ? job->options.supersampling : 1};
    renderer->parts_are_chosen = false;
    renderer->begun = true;
    return EWA_OK;
}

/// Surfels at the level that the options ask for.
static const ewa_surfels *surfels_at(const ewa_render_job *job, const ewa_surfels *surfels) {
    uint32_t level = job->options.level;
    return ewa_levels_find(surfels, &level);
}

/// What all sources of a frame have in common.
static ewa_status check_source(const ewa_renderer *renderer, const ewa_surfels *surfels) {
    const ewa_render_job *job = &renderer->job;
    if (job->source_count && surfels->cutoff != job->sources[0].surfels->cutoff)
        return ewa_fail(renderer->context, EWA_ERROR_ARGUMENT,
                        "render: surfels with a cutoff of %g beside others with %g", surfels->cutoff,
                        job->sources[0].surfels->cutoff);
    if (job->source_count == UINT32_MAX)
        return ewa_fail(renderer->context, EWA_ERROR_LIMIT, "render: more than %u sources", UINT32_MAX);
    return ewa_shading_check_materials(renderer->context, &job->shading, surfels->max_material);
}

ewa_status ewa_render_add_source(ewa_renderer *renderer, const ewa_surfels *surfels,
                                 const ewa_render_source *how) {
    if (!renderer || !surfels || !how) return EWA_ERROR_ARGUMENT;
    if (!renderer->begun)
        return ewa_fail(renderer->context, EWA_ERROR_ARGUMENT, "render: no frame has been begun");
    if (!(how->weight > 0 && how->weight <= 1))
        return ewa_fail(renderer->context, EWA_ERROR_ARGUMENT, "render: a weight of %g is not in (0, 1]",
                        how->weight);
    ewa_render_job *job = &renderer->job;
    EWA_TRY(check_source(renderer, surfels));
    EWA_TRY(ewa_buffer_grow(renderer->context, &renderer->sources, job->source_count,
                            (size_t)job->source_count + 1, sizeof(ewa_frame_source)));
    ewa_frame_source *sources = renderer->sources.data;
    sources[job->source_count++] =
        (ewa_frame_source){surfels, how->weight, how->hides || job->options.passes == 1};
    job->sources = sources;
    return EWA_OK;
}

ewa_status ewa_render_add_weighted(ewa_renderer *renderer, const ewa_surfels *surfels, double weight) {
    return ewa_render_add_source(renderer, surfels, &(ewa_render_source){weight, true});
}

ewa_status ewa_render_add(ewa_renderer *renderer, const ewa_surfels *surfels) {
    return ewa_render_add_weighted(renderer, surfels, 1);
}

ewa_status ewa_render_set_rows(ewa_renderer *renderer, uint32_t first_px, uint32_t end_px) {
    if (!renderer) return EWA_ERROR_ARGUMENT;
    if (!renderer->begun)
        return ewa_fail(renderer->context, EWA_ERROR_ARGUMENT, "render: no frame has been begun");
    ewa_render_job *job = &renderer->job;
    const uint32_t height_px = job->camera.height_px;
    const bool end_fits = end_px == height_px || (end_px < height_px && end_px % EWA_FIELD_PX == 0);
    if (first_px >= end_px || first_px % EWA_FIELD_PX != 0 || !end_fits)
        return ewa_fail(
            renderer->context, EWA_ERROR_ARGUMENT,
            "render: rows [%u, %u) of %u are no band: they have to begin and end at multiples of %d",
            first_px, end_px, height_px, EWA_FIELD_PX);
    if (job->options.budget_s > 0)
        return ewa_fail(renderer->context, EWA_ERROR_UNSUPPORTED,
                        "render: a frame with a budget of %g s is not drawn in bands", job->options.budget_s);
    renderer->parts_are_chosen = true;
    job->first_row_px = first_px, job->end_row_px = end_px;
    return EWA_OK;
}

/// Pixels that are drawn, of parts where there is supersampling.
static uint64_t pixels_of(const ewa_render_job *job) {
    const uint64_t parts = (uint64_t)job->parts.count * job->parts.count;
    return parts * job->camera.width_px * job->camera.height_px;
}

/// How much there is to draw at each level of detail.
static ewa_budget_work work_of(const ewa_render_job *job) {
    ewa_budget_work work = {.level_count = 1,
                            .pixel_count = pixels_of(job)};
    for (uint32_t i = 0; i < job->source_count; i++)
        for (uint32_t level = 0; level < EWA_MAX_LEVELS; level++) {
            uint32_t found = level;
            work.splat_counts[level] += ewa_levels_find(job->sources[i].surfels, &found)->count;
            if (found >= work.level_count) work.level_count = found + 1;
        }
    return work;
}

/// Takes each source at a level, or its last one; returns the coarsest of them.
static uint32_t take_level(ewa_renderer *renderer, uint32_t level) {
    ewa_frame_source *sources = renderer->sources.data;
    uint32_t coarsest = 0;
    for (uint32_t i = 0; i < renderer->job.source_count; i++) {
        uint32_t found = level;
        sources[i].surfels = ewa_levels_find(sources[i].surfels, &found);
        if (found > coarsest) coarsest = found;
    }
    return coarsest;
}

/// Takes what a frame took into the model of what frames take.
static void learn(ewa_renderer *renderer, const ewa_render_stats *stats) {
    const double pixels_s = stats->edge_s + stats->resolve_s;
    const double sum_s = stats->bin_s + stats->setup_s + stats->visibility_s + stats->accumulate_s + pixels_s;
    const ewa_budget_frame frame = {.level = stats->level,
                                    .splat_count = stats->splat_count,
                                    .culled_count = stats->culled_count,
                                    .pixel_count = pixels_of(&renderer->job),
                                    .total_s = stats->total_s,
                                    .pixel_share = sum_s > 0 ? pixels_s / sum_s : 0};
    ewa_budget_learn(&renderer->budget, &frame);
}

void ewa_renderer_set_parts_of(ewa_renderer *renderer, const ewa_surfels *const *surfels, uint32_t count) {
    renderer->parts_of = surfels;
    renderer->parts_of_count = count;
}

void ewa_render_choose_parts(ewa_renderer *renderer, const ewa_surfels *const *surfels, uint32_t count) {
    ewa_render_job *job = &renderer->job;
    if (!renderer->begun || job->options.supersampling) return;
    if (renderer->parts_of_count) surfels = renderer->parts_of, count = renderer->parts_of_count;
    uint64_t packet_count = 0;
    for (uint32_t i = 0; i < count; i++) packet_count += surfels_at(job, surfels[i])->packet_count;
    ewa_part_areas areas = {.at = {0}};
    for (uint32_t i = 0; i < count; i++)
        ewa_part_areas_add_surfels(&areas, &job->camera, surfels_at(job, surfels[i]), ewa_part_areas_step(packet_count));
    job->parts = ewa_parts_for(ewa_part_areas_octaves(&areas), &job->camera);
    renderer->parts_are_chosen = true;
}

/// Who says into how many parts pixels are divided: a source as it is by now, or another in the sources' place.
static const ewa_surfels *parts_of(const ewa_renderer *renderer, uint32_t i) {
    return renderer->parts_of_count ? renderer->parts_of[i] : renderer->job.sources[i].surfels;
}

/// Chooses by the frame's own surfels; of several processes by those of all.
static ewa_status choose_parts(ewa_renderer *renderer) {
    ewa_render_job *job = &renderer->job;
    if (job->options.supersampling || renderer->parts_are_chosen) return EWA_OK;
    const ewa_backend *backend = renderer->backend;
    const uint32_t count = renderer->parts_of_count ? renderer->parts_of_count : job->source_count;
    int64_t packet_count = 0;
    for (uint32_t i = 0; i < count; i++) packet_count += parts_of(renderer, i)->packet_count;
    if (backend->add) EWA_TRY(backend->add(renderer->state, &packet_count, 1));
    ewa_part_areas areas = {.at = {0}};
    for (uint32_t i = 0; i < count; i++)
        ewa_part_areas_add_surfels(&areas, &job->camera, parts_of(renderer, i), ewa_part_areas_step((uint64_t)packet_count));
    if (backend->add) EWA_TRY(backend->add(renderer->state, areas.at, EWA_PART_PLACES));
    job->parts = ewa_parts_for(ewa_part_areas_octaves(&areas), &job->camera);
    return EWA_OK;
}

ewa_status ewa_render_finish(ewa_renderer *renderer, ewa_render_stats *stats) {
    if (!renderer) return EWA_ERROR_ARGUMENT;
    if (!renderer->begun)
        return ewa_fail(renderer->context, EWA_ERROR_ARGUMENT, "render: no frame has been begun");
    renderer->begun = false;
    ewa_render_job *job = &renderer->job;
    uint32_t level = job->options.level;
    if (job->options.budget_s > 0) {
        EWA_TRY(choose_parts(renderer));
        const ewa_budget_work work = work_of(job);
        level = ewa_budget_choose(&renderer->budget, job->options.budget_s, &work, level);
    }
    level = take_level(renderer, level);
    EWA_TRY(choose_parts(renderer));
    ewa_render_stats took;
    job->count_fragments = stats != NULL;
    if (job->parts.count > 1 || job->parts.finer_share > 0)
        EWA_TRY(ewa_supersampling_draw(renderer->context, renderer->backend, renderer->state, job, &renderer->parts,
                                       &renderer->mixing, &took));
    else
        EWA_TRY(renderer->backend->draw(renderer->state, job, &took));
    took.level = level;
    if (job->end_row_px - job->first_row_px == job->camera.height_px) learn(renderer, &took);
    if (stats) *stats = took;
    return EWA_OK;
}

ewa_status ewa_render(ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_camera *camera,
                      const ewa_render_options *options, const ewa_frame *frame, ewa_render_stats *stats) {
    if (!surfels) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_render_begin(renderer, camera, options, frame));
    EWA_TRY(ewa_render_add(renderer, surfels));
    return ewa_render_finish(renderer, stats);
}
