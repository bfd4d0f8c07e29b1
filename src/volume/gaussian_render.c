// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of Gaussians: an object whose memory survives, and the order of a frame's stages. Reference:
// src/reference/gaussian.c.
#include "base/base.h"
#include "road/bin.h"
#include "road/tiles.h"
#include "volume/gaussian_kernels.h"
#include "volume/gaussian_view.h"
#include "volume/sort.h"
#include "volume/view.h"

#include <math.h>
#include <string.h>

/// What a worker needs; survives from frame to frame.
typedef struct gaussian_scratch {
    ewa_buffer marks, row_ids, row_marks, block_ids, met, waiting, free, desk;
    uint64_t block_count, sorted_count;
    double project_s, draw_s;
} gaussian_scratch;

struct ewa_gaussian_renderer {
    ewa_context *context;
    const ewa_gaussian_kernels *kernels;
    uint32_t worker_count;
    ewa_buffer records, keys, corners, parts, order;
    ewa_bin_lists by_tile;
    gaussian_scratch *scratch; ///< one per worker
};

enum { PACKETS_PER_PART = 256, PART_ROOM = PACKETS_PER_PART * EWA_SPLAT_LANES };

/// A frame; nothing of it changes while its tiles are drawn, but the workers' scratches.
typedef struct gaussian_job {
    ewa_gaussian_renderer *renderer;
    const ewa_splats *splats;
    ewa_gaussian_view view;
    ewa_volume_target target;
    ewa_tiles tiles;
    const float *surface_depth;
    bool with_times;
    uint32_t part_count, visible_count;
    ewa_gaussian_found *parts;
    uint32_t *ids; ///< [visible_count] front to back
} gaussian_job;

ewa_status ewa_gaussian_renderer_create(ewa_context *context, ewa_gaussian_renderer **renderer) {
    if (!context || !renderer) return EWA_ERROR_ARGUMENT;
    *renderer = NULL;
    ewa_gaussian_renderer *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_gaussian_kernels);
    made->worker_count = ewa_context_worker_count(context);
    made->scratch = ewa_allocate_zeroed(context, made->worker_count, sizeof *made->scratch);
    if (!made->scratch) {
        ewa_gaussian_renderer_destroy(&made);
        return EWA_ERROR_MEMORY;
    }
    *renderer = made;
    return EWA_OK;
}

void ewa_gaussian_renderer_destroy(ewa_gaussian_renderer **renderer) {
    if (!renderer || !*renderer) return;
    ewa_gaussian_renderer *old = *renderer;
    ewa_context *context = old->context;
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++) {
        gaussian_scratch *s = &old->scratch[i];
        ewa_buffer *const buffers[] = {&s->marks, &s->row_ids, &s->row_marks, &s->block_ids,
                                       &s->met,   &s->waiting, &s->free,      &s->desk};
        for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    }
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_buffer *const buffers[] = {&old->records, &old->keys, &old->corners, &old->parts, &old->order};
    for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    ewa_bin_lists_free(context, &old->by_tile);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

static void store3(ewa_vec3 from, float to[3]) {
    to[0] = (float)from.x, to[1] = (float)from.y, to[2] = (float)from.z;
}

static void set_view(ewa_gaussian_view *view, const ewa_splats *splats, const ewa_camera *camera,
                     const ewa_gaussian_options *options, const ewa_tiles *tiles) {
    ewa_gaussian_camera c;
    ewa_gaussian_camera_make(&c, camera, options, splats->info.antialiased, splats->unit_world,
                             splats->origin_world);
    const uint32_t degree = splats->info.sh_degree;
    *view = (ewa_gaussian_view){.orthographic = c.orthographic,
                                .trained = c.trained,
                                .keep = c.keep,
                                .with_surface = options->surface_depth != NULL,
                                .fx_px = (float)c.fx_px,
                                .fy_px = (float)c.fy_px,
                                .cx_px = (float)c.cx_px,
                                .cy_px = (float)c.cy_px,
                                .width_px = (float)camera->width_px,
                                .height_px = (float)camera->height_px,
                                .last_column = (float)(tiles->columns - 1),
                                .last_row = (float)(tiles->rows - 1),
                                .near = (float)c.near,
                                .cutoff2 = (float)(options->cutoff * options->cutoff),
                                .prefilter_px2 = (float)options->prefilter_px2,
                                .log2_least = (float)log2(options->least_alpha),
                                .least_alpha = (float)options->least_alpha,
                                .least_transmittance = (float)options->least_transmittance,
                                .harmonic_count = splats->harmonic_count,
                                .sh_degree = options->sh_degree < degree ? options->sh_degree : degree,
                                .unit_camera = c.unit_camera};
    for (int row = 0; row < 3; row++) store3(mat3_row(&c.turn, row), view->turn[row]);
    store3(c.origin, view->origin);
    store3(c.eye, view->eye);
    store3(c.forward, view->forward);
    for (int i = 0; i < 4; i++) view->slopes[i] = (float)c.slopes[i];
}

/// Adds to a stage's time what went by since `*last_s`.
static void take_time(const gaussian_job *job, double *last_s, double *stage_s) {
    if (!job->with_times) return;
    const double now_s = ewa_now_s();
    *stage_s += now_s - *last_s;
    *last_s = now_s;
}

/// The visible splats of some packets.
static void project_part(void *data, uint32_t index, uint32_t worker) {
    const gaussian_job *job = data;
    const ewa_splats *splats = job->splats;
    double last_s = job->with_times ? ewa_now_s() : 0;
    const uint32_t first = index * PACKETS_PER_PART;
    uint32_t end = first + PACKETS_PER_PART;
    if (end > splats->packet_count) end = splats->packet_count;
    for (uint32_t p = first; p < end; p++)
        job->renderer->kernels->project(&job->view, (const ewa_splat_packet *)&splats->packets[p],
                                        (const int16_t(*)[EWA_SPLAT_LANES]) &
                                            splats->harmonics[(size_t)p * splats->harmonic_count],
                                        &job->parts[index]);
    take_time(job, &last_s, &job->renderer->scratch[worker].project_s);
}

/// Finds what is visible, each part in its own room.
static ewa_status project_all(gaussian_job *job) {
    ewa_gaussian_renderer *renderer = job->renderer;
    ewa_context *context = renderer->context;
    job->part_count = (job->splats->packet_count + PACKETS_PER_PART - 1) / PACKETS_PER_PART;
    const size_t room = (size_t)job->part_count * PART_ROOM;
    ewa_status status = ewa_buffer_reserve(context, &renderer->records, room, sizeof(ewa_gaussian_record));
    if (status == EWA_OK) status = ewa_buffer_reserve(context, &renderer->keys, room, sizeof(uint32_t));
    if (status == EWA_OK) status = ewa_buffer_reserve(context, &renderer->corners, 2 * room, sizeof(int32_t));
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &renderer->parts, job->part_count, sizeof(ewa_gaussian_found));
    if (status != EWA_OK) return status;
    job->parts = renderer->parts.data;
    for (uint32_t i = 0; i < job->part_count; i++) {
        const size_t first = (size_t)i * PART_ROOM;
        int32_t *corners = renderer->corners.data;
        job->parts[i] = (ewa_gaussian_found){.records = (ewa_gaussian_record *)renderer->records.data + first,
                                             .keys = (uint32_t *)renderer->keys.data + first,
                                             .first = corners + first,
                                             .end = corners + room + first};
    }
    return ewa_parallel_stoppable(context, "gaussians", project_part, job, job->part_count);
}

/// Orders what is visible by the least depth of each, ties as the splats are.
static ewa_status sort_all(gaussian_job *job) {
    ewa_gaussian_renderer *renderer = job->renderer;
    job->visible_count = 0;
    for (uint32_t i = 0; i < job->part_count; i++) job->visible_count += job->parts[i].count;
    const size_t room = job->visible_count;
    const ewa_status status =
        ewa_buffer_reserve(renderer->context, &renderer->order, 4 * room, sizeof(uint32_t));
    if (status != EWA_OK) return status;
    uint32_t *numbers = renderer->order.data, *keys = numbers + 2 * room, count = 0;
    for (uint32_t i = 0; i < job->part_count; i++) {
        memcpy(keys + count, job->parts[i].keys, job->parts[i].count * sizeof *keys);
        for (uint32_t k = 0; k < job->parts[i].count; k++) numbers[count++] = i * PART_ROOM + k;
    }
    job->ids = ewa_sort_by_keys(numbers, keys, count, room);
    return EWA_OK;
}

/// The tiles of splats, front to back.
static uint32_t find_tiles(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                           const ewa_bin_items *items) {
    (void)worker;
    const gaussian_job *job = data;
    const int32_t *corners = job->renderer->corners.data;
    const size_t room = (size_t)job->part_count * PART_ROOM;
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t id = job->ids[i];
        items->ids[i] = (int32_t)id;
        items->first[i] = corners[id];
        items->end[i] = corners[room + id];
    }
    return count;
}

static ewa_status reserve_scratch(ewa_context *context, gaussian_scratch *scratch, size_t most) {
    const size_t room = (most + 15) / 16 * 16;
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } wanted[] = {
        {&scratch->marks, EWA_GAUSSIAN_ROW_BLOCKS * room, 1},
        {&scratch->row_ids, room + 1, sizeof(uint32_t)}, // one more is written, then overwritten
        {&scratch->row_marks, room + 1, 1},
        {&scratch->block_ids, room + 1, sizeof(uint32_t)},
        {&scratch->met, room + 1, sizeof(ewa_gaussian_met)},
        {&scratch->waiting, room, sizeof(uint32_t)},
        {&scratch->free, room + 1, sizeof(uint32_t)},
        {&scratch->desk, 1, sizeof(ewa_gaussian_desk)},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        const ewa_status status =
            ewa_buffer_reserve(context, wanted[i].buffer, wanted[i].count, wanted[i].size_bytes);
        if (status != EWA_OK) return status;
    }
    scratch->block_count = scratch->sorted_count = 0;
    return EWA_OK;
}

static void draw_tile(void *data, uint32_t index, uint32_t worker) {
    const gaussian_job *job = data;
    const ewa_gaussian_renderer *renderer = job->renderer;
    gaussian_scratch *scratch = &job->renderer->scratch[worker];
    double last_s = job->with_times ? ewa_now_s() : 0;
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    const uint64_t first = renderer->by_tile.starts[index];
    ewa_gaussian_tile tile = {.x_px = place.x_px,
                              .y_px = place.y_px,
                              .width_px = place.width_px,
                              .height_px = place.height_px,
                              .records = (const ewa_gaussian_record *)renderer->records.data,
                              .ids = renderer->by_tile.ids + first,
                              .count = (uint32_t)(renderer->by_tile.starts[index + 1] - first),
                              .marks = scratch->marks.data,
                              .room = (size_t)(renderer->by_tile.largest + 15) / 16 * 16,
                              .row_ids = scratch->row_ids.data,
                              .row_marks = scratch->row_marks.data,
                              .block_ids = scratch->block_ids.data,
                              .met = scratch->met.data,
                              .waiting = scratch->waiting.data,
                              .free = scratch->free.data,
                              .desk = scratch->desk.data,
                              .surface_depth = job->surface_depth};
    renderer->kernels->mark(&tile);
    renderer->kernels->draw(&job->view, &tile, &job->target);
    scratch->block_count += tile.block_count;
    scratch->sorted_count += tile.sorted_count;
    take_time(job, &last_s, &scratch->draw_s);
}

static void gather_stats(const gaussian_job *job, double start_s, double bin_s, ewa_gaussian_stats *stats) {
    const ewa_gaussian_renderer *renderer = job->renderer;
    *stats = (ewa_gaussian_stats){.splat_count = job->splats->info.splat_count,
                                  .visible_count = job->visible_count,
                                  .bin_s = bin_s * renderer->worker_count};
    for (uint32_t i = 0; i < job->part_count; i++) stats->near_count += job->parts[i].near_count;
    stats->tile_count = renderer->by_tile.starts[ewa_tiles_count(&job->tiles)];
    for (uint32_t i = 0; i < renderer->worker_count; i++) {
        const gaussian_scratch *s = &renderer->scratch[i];
        stats->block_count += s->block_count;
        stats->sorted_count += s->sorted_count;
        stats->project_s += s->project_s;
        stats->draw_s += s->draw_s;
    }
    stats->total_s = ewa_now_s() - start_s;
}

ewa_status ewa_gaussian_render(ewa_gaussian_renderer *renderer, const ewa_splats *splats,
                               const ewa_camera *camera, const ewa_gaussian_options *options,
                               const ewa_frame *frame, ewa_gaussian_stats *stats) {
    if (!renderer || !splats || !camera || !frame) return EWA_ERROR_ARGUMENT;
    ewa_context *context = renderer->context;
    const double start_s = ewa_now_s();
    ewa_gaussian_options chosen;
    ewa_status status = ewa_gaussian_options_choose(context, options, &chosen);
    if (status == EWA_OK) status = ewa_camera_check(context, camera);
    if (status == EWA_OK) status = ewa_gaussian_frame_check(context, frame);
    if (status == EWA_OK) status = ewa_progress(context, "gaussians", 0);
    if (status != EWA_OK) return status;

    gaussian_job job = {.renderer = renderer,
                        .splats = splats,
                        .tiles = ewa_tiles_make(camera->width_px, camera->height_px, EWA_GAUSSIAN_TILE_PX),
                        .surface_depth = chosen.surface_depth,
                        .with_times = stats != NULL};
    set_view(&job.view, splats, camera, &chosen, &job.tiles);
    job.view.with_depth = frame->depth != NULL;
    ewa_volume_target_set(&job.target, camera, frame, chosen.surface_rgba, chosen.background);
    for (uint32_t i = 0; i < renderer->worker_count; i++)
        renderer->scratch[i].project_s = renderer->scratch[i].draw_s = 0;
    status = project_all(&job);
    const double projected_s = ewa_now_s();
    if (status == EWA_OK) status = sort_all(&job);
    if (status == EWA_OK)
        status = ewa_bin_lists_fill(context, &renderer->by_tile, job.tiles.columns, job.tiles.rows,
                                    job.visible_count, find_tiles, &job);
    const double binned_s = ewa_now_s();
    for (uint32_t i = 0; i < renderer->worker_count && status == EWA_OK; i++)
        status = reserve_scratch(context, &renderer->scratch[i], renderer->by_tile.largest);
    if (status == EWA_OK)
        status = ewa_parallel_stoppable(context, "gaussians", draw_tile, &job, ewa_tiles_count(&job.tiles));
    if (status == EWA_OK && stats) gather_stats(&job, start_s, binned_s - projected_s, stats);
    return status;
}
