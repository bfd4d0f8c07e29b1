// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The back end of threads and vectors: an object whose memory survives, and the order of a frame's stages.
// Reference: src/reference/surface.c.
#include "base/base.h"
#include "surface/backend.h"
#include "surface/eye_dome.h"
#include "surface/tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Large tiles share fewer packets; small ones spread a small picture over the threads, and keep the records
/// of crowded ones in the cache.
static uint32_t tile_side_px(const ewa_camera *camera, uint64_t splat_count) {
    enum { LARGE_PX = 1 << 20, CROWD = 12000000 };
    return (uint64_t)camera->width_px * camera->height_px >= LARGE_PX && splat_count <= CROWD ? 128 : 64;
}

typedef struct cpu_state {
    ewa_context *context;
    const ewa_road_kernels *kernels;
    ewa_dome_pass dome;
    ewa_buffer sources;               ///< ewa_tile_source, whose bins keep their memory
    ewa_buffer order, requests, room; ///< of sources and their bins
    uint32_t source_count;
    uint32_t worker_count;
    ewa_tile_scratch *scratch; ///< one per worker
} cpu_state;

static void destroy(ewa_context *context, void *state) {
    cpu_state *old = state;
    ewa_tile_source *sources = old->sources.data;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++)
        ewa_tile_scratch_free(context, &old->scratch[i]);
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    for (uint32_t i = 0; i < old->source_count; i++) ewa_bins_free(context, &sources[i].bins);
    ewa_buffer *const buffers[] = {&old->sources, &old->order, &old->requests, &old->room};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
    ewa_dome_pass_free(context, &old->dome);
    ewa_release(context, old, 1, sizeof *old);
}

static ewa_status create(ewa_context *context, void **state) {
    const uint32_t worker_count = ewa_context_worker_count(context);
    cpu_state *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->kernels = made->dome.kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_road_kernels);
    made->worker_count = worker_count;
    made->scratch = ewa_allocate_zeroed(context, worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        destroy(context, made);
        return EWA_ERROR_MEMORY;
    }
    *state = made;
    return EWA_OK;
}

/// Room for a frame's sources; those that are new have empty bins.
static ewa_status reserve_sources(cpu_state *cpu, uint32_t count) {
    const uint32_t before = cpu->source_count;
    if (count <= before) return EWA_OK;
    const ewa_status status =
        ewa_buffer_grow(cpu->context, &cpu->sources, before, count, sizeof(ewa_tile_source));
    if (status != EWA_OK) return status;
    ewa_tile_source *sources = cpu->sources.data;
    memset(sources + before, 0, (count - before) * sizeof *sources);
    cpu->source_count = count;
    return EWA_OK;
}

static void gather_stats(const cpu_state *cpu, const ewa_tile_job *job, double start_s, double binned_s,
                         ewa_render_stats *stats) {
    *stats = (ewa_render_stats){.bin_s = (binned_s - start_s) * cpu->worker_count};
    for (uint32_t i = 0; i < job->source_count; i++) {
        const ewa_tile_source *source = &job->sources[i];
        const uint64_t culled =
            (source->surfels->packet_count - source->bins.lists.item_count) * EWA_PACKET_LANES;
        stats->splat_count += source->surfels->count;
        stats->culled_count += culled < source->surfels->count ? culled : source->surfels->count;
    }
    for (uint32_t i = 0; i < cpu->worker_count; i++) {
        const ewa_tile_scratch *s = &cpu->scratch[i];
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
static void report_broken(const cpu_state *cpu, const ewa_camera *camera) {
    uint64_t broken = 0;
    for (uint32_t i = 0; i < cpu->worker_count; i++) broken += cpu->scratch[i].broken_pixel_count;
    if (broken)
        ewa_report(cpu->context, EWA_SEVERITY_WARNING,
                   "%llu of %llu pixels have a colour that is infinite or not a number",
                   (unsigned long long)broken, (unsigned long long)camera->width_px * camera->height_px);
}

/// How many surfaces are composited, and whether they are transparent.
static void set_layers(ewa_tile_job *job, const ewa_render_job *frame, const ewa_render_options *options) {
    bool opacities = false;
    for (uint32_t i = 0; i < frame->source_count; i++) {
        const ewa_surfels *surfels = frame->sources[i].surfels;
        opacities |= surfels->opacities || surfels->with_opacities;
    }
    job->resolve.transparent =
        (options->opacity < 1 || opacities) && options->layers != 1 && options->passes == 3;
    if (!job->resolve.transparent) {
        job->layers = options->edge_antialiasing && options->passes == 3 ? options->edge_layers : 1;
        return;
    }
    job->layers = options->layers == 0 || options->layers > EWA_MAX_LAYERS ? EWA_MAX_LAYERS : options->layers;
    job->merge_last = job->layers == options->layers;
    job->with_opacity = opacities;
    job->with_normals |= opacities;
}

/// Whether the surfels' materials differ.
static bool materials_differ(const ewa_render_job *frame) {
    for (uint32_t i = 0; i < frame->source_count; i++) {
        const ewa_surfels *surfels = frame->sources[i].surfels;
        if (surfels->materials || surfels->with_materials) return true;
        if (surfels->material != frame->sources[0].surfels->material) return true;
    }
    return false;
}

/// Materials that differ from surfel to surfel are summed per pixel.
static void set_materials(ewa_tile_job *job, const ewa_render_job *frame) {
    const ewa_shading_setup *shading = &frame->shading;
    job->with_materials = shading->has_table && materials_differ(frame);
    if (!job->with_materials) return;
    for (uint32_t i = 0; i < shading->material_count; i++)
        ewa_material_numbers(&shading->materials[i], job->materials[i]);
    job->view.materials = (const float(*)[EWA_MATERIAL_CHANNELS])job->materials;
    for (int c = 0; c < EWA_MATERIAL_CHANNELS; c++) { // sums of all have the same units
        float largest = 0;
        for (uint32_t i = 0; i < shading->material_count; i++)
            largest = fmaxf(largest, fabsf(job->materials[i][c]));
        int exponent = 0;
        frexpf(largest, &exponent);
        for (uint32_t i = 0; i < shading->material_count; i++)
            job->materials[i][c] = ldexpf(job->materials[i][c], -exponent);
        job->resolve.material_units[c] = ldexpf(1, exponent);
    }
}

/// What is drawn of a source, beside where it is.
static void set_packets(const ewa_tile_job *job, const ewa_render_options *options, ewa_tile_source *source) {
    const ewa_surfels *surfels = source->surfels;
    source->packets =
        (ewa_packet_source){.packets = surfels->packets,
                            .colors = surfels->bounds.colors,
                            .places = source->bins.places,
                            .opacities = job->with_opacity ? surfels->opacities : NULL,
                            .clip_masks = options->point_size_px > 0 ? NULL : surfels->clip_masks,
                            .materials = job->with_materials ? surfels->materials : NULL,
                            .material = surfels->material};
}

/// A source that has something to draw, and how far away that begins.
typedef struct source_order {
    double depth;
    uint32_t index; ///< in the frame
    bool hides;
} source_order;

/// Sources that hide others come first, from front to back.
static int compare_sources(const void *a, const void *b) {
    const source_order *x = a, *y = b;
    if (x->hides != y->hides) return x->hides ? -1 : 1;
    if (x->depth != y->depth) return x->depth < y->depth ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

/// Orders the sources that have something to draw: what is in front saves looking at what it hides.
static ewa_status order_sources(cpu_state *cpu, ewa_tile_job *job, const ewa_render_job *frame,
                                const ewa_scales *scales) {
    const ewa_status status =
        ewa_buffer_reserve(cpu->context, &cpu->order, frame->source_count, sizeof(source_order));
    if (status != EWA_OK) return status;
    source_order *order = cpu->order.data;
    job->source_count = 0;
    job->all_hide = true;
    for (uint32_t i = 0; i < frame->source_count; i++) {
        const ewa_frame_source *source = &frame->sources[i];
        if (source->surfels->packet_count == 0) continue;
        order[job->source_count++] =
            (source_order){ewa_scales_nearest(scales, source->surfels, &frame->camera), i, source->hides};
        job->all_hide &= source->hides;
    }
    if (job->source_count) qsort(order, job->source_count, sizeof *order, compare_sources);
    return EWA_OK;
}

/// Sets the sources' places before the camera, in units that all of them share, and their views.
static ewa_status set_views(cpu_state *cpu, ewa_tile_job *job, const ewa_render_job *frame,
                            ewa_scales *scales) {
    ewa_tile_source *sources = job->sources;
    ewa_context *context = cpu->context;
    const ewa_camera *camera = &frame->camera;
    *scales = ewa_scales_make(frame->sources, frame->source_count, camera, &frame->options);
    ewa_status status = order_sources(cpu, job, frame, scales);
    if (status == EWA_OK)
        status = ewa_view_set(context, &job->view, NULL, camera, &frame->options, scales, job->tiles.side_px);
    const source_order *order = cpu->order.data;
    for (uint32_t i = 0; i < job->source_count && status == EWA_OK; i++) {
        const ewa_frame_source *source = &frame->sources[order[i].index];
        sources[i].surfels = source->surfels;
        sources[i].hides = source->hides;
        status = ewa_view_set(context, &sources[i].view, source, camera, &frame->options, scales,
                              job->tiles.side_px);
    }
    return status;
}

/// Which tiles see what of each source.
static ewa_status fill_bins(cpu_state *cpu, ewa_tile_job *job) {
    ewa_status status =
        ewa_buffer_reserve(cpu->context, &cpu->requests, job->source_count, sizeof(ewa_bin_request));
    ewa_bin_request *requests = cpu->requests.data;
    for (uint32_t i = 0; i < job->source_count && status == EWA_OK; i++) {
        ewa_tile_source *source = &job->sources[i];
        status = ewa_bins_start(cpu->context, &source->bins, cpu->kernels, &source->view, source->surfels);
        if (status == EWA_OK) requests[i] = ewa_bins_request(&source->bins);
    }
    if (status == EWA_OK)
        status = ewa_bin_lists_fill_all(cpu->context, &cpu->room, requests, job->source_count,
                                        job->tiles.columns, job->tiles.rows);
    if (status != EWA_OK) return status;
    for (uint32_t tile = 0; tile < ewa_tiles_count(&job->tiles); tile++) {
        uint64_t count = 0;
        for (uint32_t i = 0; i < job->source_count; i++) {
            const uint64_t *first = &job->sources[i].bins.lists.starts[tile];
            count += first[1] - first[0];
        }
        if (count > job->largest_bin) job->largest_bin = count;
    }
    return EWA_OK;
}

/// Draws the tiles of the frame's band.
static ewa_status draw_tiles(cpu_state *cpu, ewa_tile_job *job, const ewa_render_job *frame) {
    const uint32_t side_px = job->tiles.side_px, first_row = frame->first_row_px / side_px,
                   end_row = (frame->end_row_px + side_px - 1) / side_px;
    job->first_tile = first_row * job->tiles.columns;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < cpu->worker_count && status == EWA_OK; i++)
        status = ewa_tile_scratch_reserve(cpu->context, &cpu->scratch[i], job);
    if (status != EWA_OK) return status;
    return ewa_parallel_stoppable(cpu->context, "render", ewa_tile_draw, job,
                                  (end_row - first_row) * job->tiles.columns);
}

static ewa_status draw(void *state, const ewa_render_job *frame, ewa_render_stats *stats) {
    cpu_state *cpu = state;
    ewa_context *context = cpu->context;
    const double start_s = ewa_now_s();
    ewa_render_options options = frame->options;
    const bool with_dome = options.eye_dome > 0 && (frame->frame.rgba8 || frame->frame.rgba);
    ewa_frame drawn = frame->frame;
    ewa_status status = reserve_sources(cpu, frame->source_count);
    if (status == EWA_OK && with_dome)
        status = ewa_dome_pass_start(context, &cpu->dome, &frame->camera, &frame->frame, &options, &drawn);
    if (status != EWA_OK) return status;

    uint64_t splat_count = 0;
    for (uint32_t i = 0; i < frame->source_count; i++) splat_count += frame->sources[i].surfels->count;
    const uint32_t side_px = frame->tile_px ? frame->tile_px : tile_side_px(&frame->camera, splat_count);
    ewa_tile_job job = {.kernels = cpu->kernels,
                        .sources = cpu->sources.data,
                        .tiles = ewa_tiles_make(frame->camera.width_px, frame->camera.height_px, side_px),
                        .with_normals = frame->shading.lit || drawn.normal,
                        .with_depth = drawn.depth != NULL,
                        .count_fragments = frame->count_fragments,
                        .scratch = cpu->scratch};
    ewa_scales scales;
    status = set_views(cpu, &job, frame, &scales);
    if (status != EWA_OK) return status;
    ewa_resolve_set(&job.resolve, frame->source_count ? frame->sources[0].surfels->material : 0,
                    &frame->camera, &options, &scales, &frame->shading, &drawn);
    set_layers(&job, frame, &options);
    set_materials(&job, frame);
    job.channel_count = 4 + (job.with_normals ? 3 : 0) + (job.with_depth || job.with_materials ? 1 : 0) +
                        (job.with_materials ? EWA_MATERIAL_CHANNELS : 0) + (job.with_opacity ? 1 : 0);
    // Without antialiasing, pixels show splats whose weight is next to nothing.
    job.fine_sums = scales.fine_colors || !job.resolve.edge_antialiasing;
    job.terms_per_carry = scales.terms_per_carry;
    job.with_small = !job.with_depth && !job.with_materials && !job.fine_sums && !job.resolve.transparent &&
                     !job.view.raycast && job.view.doublings == 2;
    job.resolve.depth_per_share = (float)scales.depth;
    status = fill_bins(cpu, &job);
    if (status != EWA_OK) return status;
    for (uint32_t i = 0; i < frame->source_count; i++)
        job.with_clips |= frame->sources[i].surfels->with_clips && options.point_size_px == 0;
    for (uint32_t i = 0; i < job.source_count; i++) {
        set_packets(&job, &options, &job.sources[i]);
        job.sources[i].view.materials = job.view.materials;
        job.with_clips |= job.sources[i].packets.clip_masks || job.sources[i].view.section_reach > 0;
    }
    const double binned_s = ewa_now_s();
    status = draw_tiles(cpu, &job, frame);
    if (status != EWA_OK) return status;
    if (with_dome && frame->end_row_px == frame->camera.height_px) ewa_dome_pass_finish(context, &cpu->dome);
    report_broken(cpu, &frame->camera);
    gather_stats(cpu, &job, start_s, binned_s, stats);
    return EWA_OK;
}

const ewa_backend ewa_backend_cpu = {"cpu", create, destroy, draw};
