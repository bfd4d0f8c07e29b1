// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer: an object whose memory survives, and the order of a frame's stages. Reference: reference.c.
#include "base/base.h"
#include "splat/eye_dome.h"
#include "splat/options.h"
#include "splat/tile.h"

#include <string.h>

/// Large tiles share fewer packets; small ones spread a small picture over the threads, and keep the records
/// of crowded ones in the cache. The threads have no say: tiles round differently.
static uint32_t tile_side_px(const ewa_camera *camera, const ewa_surfels *surfels) {
    enum { LARGE_PX = 1 << 20, CROWD = 12000000 };
    return (uint64_t)camera->width_px * camera->height_px >= LARGE_PX && surfels->count <= CROWD ? 128 : 64;
}

struct ewa_renderer {
    ewa_context *context;
    const ewa_road_kernels *kernels;
    ewa_bins bins;
    ewa_dome_pass dome;
    uint32_t worker_count;
    ewa_tile_scratch *scratch; ///< one per worker
};

ewa_status ewa_renderer_create(ewa_context *context, ewa_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    const uint32_t worker_count = ewa_context_worker_count(context);
    ewa_renderer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->kernels = made->dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_road_kernels);
    made->worker_count = worker_count;
    made->scratch = ewa_allocate_zeroed(context, worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        ewa_renderer_destroy(&made);
        return EWA_ERROR_MEMORY;
    }
    *renderer = made;
    return EWA_OK;
}

void ewa_renderer_destroy(ewa_renderer **renderer) {
    if (!renderer || !*renderer) return;
    ewa_renderer *old = *renderer;
    ewa_context *context = old->context;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_tile_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_bins_free(context, &old->bins);
    ewa_dome_pass_free(context, &old->dome);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

static void gather_stats(const ewa_renderer *renderer, const ewa_surfels *surfels, double start_s,
                         double binned_s, ewa_render_stats *stats) {
    const uint64_t culled = renderer->bins.culled_packet_count * EWA_PACKET_LANES;
    *stats = (ewa_render_stats){.splat_count = surfels->count,
                                .culled_count = culled < surfels->count ? culled : surfels->count,
                                .bin_s = (binned_s - start_s) * renderer->worker_count};
    for (uint32_t i = 0; i < renderer->worker_count; i++) {
        const ewa_tile_scratch *s = &renderer->scratch[i];
        stats->hidden_count += s->hidden_splat_count;
        stats->drawn_count += s->drawn_count;
        stats->fragment_count += s->fragment_count;
        stats->setup_s += s->setup_s;
        stats->visibility_s += s->visibility_s;
        stats->accumulate_s += s->accumulate_s;
        stats->edge_s += s->edge_s;
        stats->resolve_s += s->resolve_s;
    }
    stats->total_s = ewa_now_s() - start_s;
}

/// Tells of colours that cannot be shown: 8-bit pixels hide them.
static void report_broken(const ewa_renderer *renderer, ewa_context *context, const ewa_camera *camera) {
    uint64_t broken = 0;
    for (uint32_t i = 0; i < renderer->worker_count; i++) broken += renderer->scratch[i].broken_pixel_count;
    if (broken)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%llu of %llu pixels have a colour that is infinite or not a number",
                   (unsigned long long)broken, (unsigned long long)camera->width_px * camera->height_px);
}

/// How many surfaces are composited, and whether they are transparent.
static void set_layers(ewa_tile_job *job, const ewa_render_options *options) {
    const bool see_through = options->opacity < 1 || job->surfels->opacities;
    job->resolve.transparent = see_through && options->layers != 1 && options->passes == 3;
    if (job->resolve.transparent) {
        job->layers =
            options->layers == 0 || options->layers > EWA_MAX_LAYERS ? EWA_MAX_LAYERS : options->layers;
        job->merge_last = job->layers == options->layers;
        job->with_opacity = job->surfels->opacities != NULL;
        job->with_normals |= job->with_opacity;
        job->source.opacities = job->surfels->opacities;
    } else {
        job->layers = options->edge_antialiasing && options->passes == 3 ? options->edge_layers : 1;
    }
}

/// Materials that differ from surfel to surfel are summed per pixel.
static void set_materials(ewa_tile_job *job, const ewa_shading_setup *shading) {
    job->with_materials = shading->has_table && job->surfels->materials;
    if (!job->with_materials) return;
    job->with_depth = true;
    job->source.materials = job->surfels->materials;
    for (uint32_t i = 0; i < shading->material_count; i++)
        ewa_material_numbers(&shading->materials[i], job->materials[i]);
    job->view.materials = (const float(*)[EWA_MATERIAL_CHANNELS])job->materials;
}

ewa_status ewa_render(ewa_renderer *renderer, const ewa_surfels *surfels, const ewa_camera *camera,
                      const ewa_render_options *options, const ewa_frame *frame, ewa_render_stats *stats) {
    if (!renderer || !surfels || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = renderer->context;
    const double start_s = ewa_now_s();
    ewa_render_options chosen;
    ewa_status status = ewa_render_options_choose(context, options, &chosen);
    if (status == EWA_OK) status = ewa_camera_check(context, camera);
    if (status != EWA_OK) return status;
    ewa_shading_setup shading;
    ewa_shading_setup_make(&chosen, &shading);
    status = ewa_shading_check_materials(context, &shading, surfels->most_material);
    const bool with_dome = chosen.eye_dome > 0 && (frame->rgba8 || frame->rgba);
    ewa_frame drawn = *frame;
    if (status == EWA_OK && with_dome)
        status = ewa_dome_pass_start(context, &renderer->dome, camera, frame, &chosen, &drawn);
    if (status != EWA_OK) return status;

    ewa_tile_job job = {.kernels = renderer->kernels,
                        .surfels = surfels,
                        .source = {.packets = surfels->packets,
                                   .colors = surfels->bounds.colors,
                                   .clip_masks = chosen.point_size_px > 0 ? NULL : surfels->clip_masks},
                        .bins = &renderer->bins,
                        .with_normals = shading.lit || drawn.normal,
                        .with_depth = drawn.depth != NULL,
                        .count_fragments = stats != NULL,
                        .scratch = renderer->scratch};
    const ewa_placement placement =
        ewa_placement_make(camera, surfels->origin_world, &surfels->extent, surfels->unit);
    status = ewa_view_set(&job.view, surfels, camera, &placement, &chosen, tile_side_px(camera, surfels));
    if (status != EWA_OK) return status;
    ewa_resolve_set(&job.resolve, surfels, camera, &placement, &chosen, &shading, &drawn);
    set_layers(&job, &chosen);
    set_materials(&job, &shading);
    job.channel_count = 4 + (job.with_normals ? 3 : 0) + (job.with_depth ? 1 : 0) +
                        (job.with_materials ? EWA_MATERIAL_CHANNELS : 0) + (job.with_opacity ? 1 : 0);

    status = ewa_bins_fill(context, &renderer->bins, renderer->kernels, &job.view, surfels);
    if (status != EWA_OK) return status;
    job.source.places = renderer->bins.places;
    const double binned_s = ewa_now_s();
    for (uint32_t i = 0; i < renderer->worker_count && status == EWA_OK; i++)
        status = ewa_tile_scratch_reserve(context, &renderer->scratch[i], &job, renderer->bins.lists.largest);
    if (status != EWA_OK) return status;
    ewa_parallel(context, ewa_tile_draw, &job, ewa_tiles_count(&renderer->bins.tiles));
    if (with_dome) ewa_dome_pass_finish(context, &renderer->dome);
    report_broken(renderer, context, camera);
    if (stats) gather_stats(renderer, surfels, start_s, binned_s, stats);
    return EWA_OK;
}
