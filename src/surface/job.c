// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame before it is drawn: what its sources, options and camera are to tiles, for every back end.
#include "surface/job.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Room for a frame's sources; those that are new have empty bins.
static ewa_status reserve_sources(ewa_context *context, ewa_job_room *room, uint32_t count) {
    const uint32_t before = room->source_count;
    if (count <= before) return EWA_OK;
    EWA_TRY(ewa_buffer_grow(context, &room->sources, before, count, sizeof(ewa_tile_source)));
    ewa_tile_source *sources = room->sources.data;
    memset(sources + before, 0, (count - before) * sizeof *sources);
    room->source_count = count;
    return EWA_OK;
}

/// How many surfaces are composited, and whether they are transparent.
static void set_layers(ewa_tile_job *job, const ewa_scales *scales, const ewa_render_options *options) {
    job->resolve.transparent = scales->transparent;
    if (!job->resolve.transparent) {
        job->layers = options->edge_antialiasing && options->passes == 3 ? options->edge_layers : 1;
        job->merge_last = job->layers > 1;
        return;
    }
    job->layers = options->layers == 0 || options->layers > EWA_MAX_LAYERS ? EWA_MAX_LAYERS : options->layers;
    job->merge_last = job->layers == options->layers;
    job->with_opacity = scales->opacities;
    job->with_normals |= scales->opacities;
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
                            .opacities = job->with_opacity ? surfels->opacities : NULL,
                            .clip_masks = options->point_size_px > 0 ? NULL : surfels->clip_masks,
                            .curvatures = source->view.contour_shift > 0 ? surfels->curvatures : NULL,
                            .materials = job->with_materials ? surfels->materials : NULL,
                            .material = surfels->material,
                            .billboards = surfels->billboards};
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
static ewa_status order_sources(ewa_context *context, ewa_job_room *room, ewa_tile_job *job,
                                const ewa_render_job *frame, const ewa_scales *scales) {
    EWA_TRY(ewa_buffer_reserve(context, &room->order, frame->source_count, sizeof(source_order)));
    source_order *order = room->order.data;
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
static ewa_status set_views(ewa_context *context, ewa_job_room *room, ewa_tile_job *job,
                            const ewa_render_job *frame, ewa_scales *scales) {
    ewa_tile_source *sources = job->sources;
    const ewa_camera *camera = &frame->camera;
    *scales = ewa_scales_make(frame->sources, frame->source_count, camera, &frame->options);
    EWA_TRY(order_sources(context, room, job, frame, scales));
    EWA_TRY(ewa_view_set(context, &job->view, NULL, camera, &frame->options, scales, job->tiles.side_px));
    const source_order *order = room->order.data;
    for (uint32_t i = 0; i < job->source_count; i++) {
        const ewa_frame_source *source = &frame->sources[order[i].index];
        sources[i].surfels = source->surfels;
        sources[i].hides = source->hides;
        EWA_TRY(ewa_view_set(context, &sources[i].view, source, camera, &frame->options, scales,
                             job->tiles.side_px));
    }
    return EWA_OK;
}

/// Which tiles see what of each source.
static ewa_status fill_bins(ewa_context *context, ewa_job_room *room, ewa_tile_job *job) {
    EWA_TRY(ewa_buffer_reserve(context, &room->requests, job->source_count, sizeof(ewa_bin_request)));
    ewa_bin_request *requests = room->requests.data;
    for (uint32_t i = 0; i < job->source_count; i++) {
        ewa_tile_source *source = &job->sources[i];
        EWA_TRY(ewa_bins_start(context, &source->bins, job->kernels, &source->view, source->surfels));
        requests[i] = ewa_bins_request(&source->bins);
    }
    EWA_TRY(ewa_bin_lists_fill_all(context, &room->bins, requests, job->source_count, job->tiles.columns,
                                   job->tiles.rows));
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

/// Marks the packets that several tiles have.
static void mark_shared(const ewa_tile_job *job, uint8_t *shared) {
    const ewa_bin_lists *lists = &job->sources[0].bins.lists;
    memset(shared, 0, job->sources[0].surfels->packet_count);
    for (uint64_t i = 0; i < lists->starts[ewa_tiles_count(&job->tiles)]; i++)
        shared[lists->ids[i]] = (uint8_t)(shared[lists->ids[i]] < 2 ? shared[lists->ids[i]] + 1 : 2);
    for (uint32_t i = 0; i < job->sources[0].surfels->packet_count; i++) shared[i] = shared[i] > 1;
}

/// What of the frame's shape and options the tiles read.
static void set_channels(ewa_tile_job *job, const ewa_render_job *frame, const ewa_render_options *options,
                         const ewa_scales *scales, const ewa_frame *drawn) {
    ewa_resolve_set(&job->resolve, frame->source_count ? frame->sources[0].surfels->material : 0,
                    &frame->camera, options, scales, &frame->shading, drawn);
    set_layers(job, scales, options);
    set_materials(job, frame);
    job->channel_count = 4 + (job->with_normals ? 3 : 0) + (job->with_depth || job->with_materials ? 1 : 0) +
                         (job->with_materials ? EWA_MATERIAL_CHANNELS : 0) + (job->with_opacity ? 1 : 0);
    // Without antialiasing, pixels show splats whose weight is next to nothing.
    job->fine_sums = scales->fine_colors || !job->resolve.edge_antialiasing;
    job->terms_per_carry = scales->terms_per_carry;
    job->with_small = !job->with_depth && !job->with_materials && !job->fine_sums &&
                      !job->resolve.transparent && !job->view.raycast && job->view.doublings == 2;
    job->resolve.depth_per_share = (float)scales->depth;
}

ewa_status ewa_tile_job_make(ewa_context *context, ewa_job_room *room, const ewa_render_job *frame,
                             uint32_t side_px, ewa_tile_job *job) {
    ewa_render_options options = frame->options;
    ewa_frame drawn = frame->frame;
    ewa_status status = reserve_sources(context, room, frame->source_count);
    room->with_eye_dome = options.eye_dome > 0 && (drawn.rgba8 || drawn.rgba);
    if (status == EWA_OK && room->with_eye_dome)
        status = ewa_eye_dome_pass_start(context, &room->eye_dome, &frame->camera, &frame->frame, &options,
                                         &drawn);
    EWA_TRY(status);
    *job = (ewa_tile_job){.context = context,
                          .kernels = room->eye_dome.kernels,
                          .sources = room->sources.data,
                          .tiles = ewa_tiles_make(frame->camera.width_px, frame->camera.height_px, side_px),
                          .with_normals = frame->shading.lit || drawn.normal,
                          .with_depth = drawn.depth != NULL,
                          .count_fragments = frame->count_fragments,
                          .gather = frame->gather};
    ewa_scales scales;
    EWA_TRY(set_views(context, room, job, frame, &scales));
    set_channels(job, frame, &options, &scales, &drawn);
    for (uint32_t i = 0; i < frame->source_count; i++)
        job->with_clips |= frame->sources[i].surfels->with_clips && options.point_size_px == 0;
    for (uint32_t i = 0; i < job->source_count; i++) {
        set_packets(job, &options, &job->sources[i]);
        job->sources[i].view.materials = job->view.materials;
        job->with_clips |= job->sources[i].packets.clip_masks || job->sources[i].view.section_reach > 0;
    }
    return EWA_OK;
}

ewa_status ewa_tile_job_bin(ewa_context *context, ewa_job_room *room, ewa_tile_job *job) {
    EWA_TRY(fill_bins(context, room, job));
    for (uint32_t i = 0; i < job->source_count; i++) job->sources[i].packets.places = job->sources[i].bins.places;
    if (job->gather && job->gather->shared && job->source_count) mark_shared(job, job->gather->shared);
    return EWA_OK;
}

void ewa_job_finish(ewa_context *context, ewa_job_room *room, const ewa_render_job *frame,
                    uint64_t broken_pixel_count) {
    const ewa_camera *camera = &frame->camera;
    if (room->with_eye_dome && frame->end_row_px == camera->height_px)
        ewa_eye_dome_pass_finish(context, &room->eye_dome);
    if (broken_pixel_count)
        ewa_report(context, EWA_SEVERITY_WARNING,
                   "%llu of %llu pixels have a colour that is infinite or not a number",
                   (unsigned long long)broken_pixel_count,
                   (unsigned long long)camera->width_px * camera->height_px);
}

void ewa_job_count(const ewa_tile_job *job, uint32_t worker_count, ewa_render_stats *stats) {
    for (uint32_t i = 0; i < job->source_count; i++) {
        const ewa_tile_source *source = &job->sources[i];
        const uint64_t culled =
            (source->surfels->packet_count - source->bins.lists.item_count) * EWA_PACKET_LANES;
        stats->splat_count += source->surfels->count;
        stats->culled_count += culled < source->surfels->count ? culled : source->surfels->count;
    }
    for (uint32_t i = 0; i < worker_count; i++) {
        const ewa_tile_scratch *s = &job->scratch[i];
        stats->hidden_count += s->hidden_splat_count;
        stats->drawn_count += s->drawn_count;
        stats->fragment_count += s->fragment_count;
        stats->setup_s += s->setup_s;
        stats->visibility_s += s->visibility_s;
        stats->accumulate_s += s->accumulate_s;
        stats->edge_s += s->edge_s;
        stats->resolve_s += s->resolve_s;
    }
}

void ewa_render_stats_add(ewa_render_stats *sum, const ewa_render_stats *more) {
    if (more->splat_count > sum->splat_count) sum->splat_count = more->splat_count;
    if (more->level > sum->level) sum->level = more->level;
    sum->culled_count += more->culled_count;
    sum->hidden_count += more->hidden_count;
    sum->drawn_count += more->drawn_count;
    sum->fragment_count += more->fragment_count;
    sum->bin_s += more->bin_s;
    sum->setup_s += more->setup_s;
    sum->visibility_s += more->visibility_s;
    sum->accumulate_s += more->accumulate_s;
    sum->edge_s += more->edge_s;
    sum->resolve_s += more->resolve_s;
    sum->total_s += more->total_s;
}

void ewa_job_room_free(ewa_context *context, ewa_job_room *room) {
    ewa_tile_source *sources = room->sources.data;
    for (uint32_t i = 0; i < room->source_count; i++) ewa_bins_free(context, &sources[i].bins);
    ewa_buffer *const buffers[] = {&room->sources, &room->order, &room->requests, &room->bins};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
    ewa_eye_dome_pass_free(context, &room->eye_dome);
}
