// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The renderer of Gaussians, and of volumes among them: an object whose memory survives, and the order of a
// frame's stages. Reference: src/reference/gaussian.c.
#include "volume/gaussian_frame.h"
#include "base/allocating.h"
#include "volume/gaussian_backend.h"
#include "volume/gaussian_view.h"
#include "volume/sort.h"
#include "volume/splat_packets.h"

#include <math.h>
#include <string.h>

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
    if (old->backend) old->backend->destroy(context, old->backend_state);
    for (uint32_t i = 0; old->scratch && i < old->worker_count; i++) {
        ewa_gaussian_scratch *s = &old->scratch[i];
        ewa_buffer *const buffers[] = {&s->marks, &s->row_ids, &s->row_marks, &s->block_ids,
                                       &s->hit,   &s->waiting, &s->free,      &s->sort_buffer, &s->solid};
        for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    }
    ewa_release(context, old->scratch, old->worker_count, sizeof *old->scratch);
    ewa_buffer *const buffers[] = {&old->records, &old->keys,  &old->corners, &old->views,
                                   &old->parts,   &old->order, &old->volumes, &old->planes};
    for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    ewa_bin_lists_free(context, &old->by_tile);
    ewa_release(context, old, 1, sizeof *old);
    *renderer = NULL;
}

void ewa_gaussian_renderer_use(ewa_gaussian_renderer *renderer, const ewa_gaussian_backend *backend, void *state) {
    renderer->backend = backend, renderer->backend_state = state;
}

bool ewa_gaussian_renderer_describe(const ewa_gaussian_renderer *renderer, ewa_renderer_info *info, const char **remark) {
    if (renderer->used_backend) renderer->backend->describe(renderer->backend_state, info);
    *remark = renderer->remark;
    return renderer->used_backend;
}

static void store3(ewa_vec3 from, float to[3]) {
    to[0] = (float)from.x, to[1] = (float)from.y, to[2] = (float)from.z;
}

/// The unit of all sets: the largest of theirs; without sets a power of two from the volumes' spacings up.
static double choose_unit(const ewa_mixture *mixture) {
    double unit = 0;
    for (uint32_t i = 0; i < mixture->splats_count; i++) unit = fmax(unit, mixture->splats[i]->unit_world);
    for (uint32_t i = 0; i < mixture->volume_count && !mixture->splats_count; i++) {
        int exponent;
        frexp(mixture->volumes[i].voxels->info.spacing_world, &exponent);
        unit = fmax(unit, ldexp(1, exponent));
    }
    return unit > 0 ? unit : 1;
}

/// The view of a set; NULL: of none.
static void set_view(ewa_gaussian_view *view, const ewa_splats *splats, double unit_world,
                     const ewa_camera *camera, const ewa_gaussian_options *options, const ewa_tiles *tiles) {
    static const double nowhere[3] = {0, 0, 0};
    ewa_gaussian_camera c;
    ewa_gaussian_camera_make(&c, camera, options, splats && splats->info.antialiased, unit_world,
                             splats ? splats->origin_world : nowhere);
    const uint32_t degree = splats ? splats->info.sh_degree : 0;
    const bool flat = splats && splats->flat && options->projection == EWA_PROJECTION_TRAINED &&
                      options->filter == EWA_FILTER_OF_SET;
    *view = (ewa_gaussian_view){.orthographic = c.orthographic,
                                .trained = c.trained && !flat,
                                .by_center = c.by_center,
                                .keep = c.keep && !flat,
                                .flat = flat,
                                .with_surface = options->surface_depth != NULL,
                                .with_sections = options->section_count > 0,
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
                                .dot_px2 = (float)(EWA_GAUSSIAN_DOT * options->prefilter_px2),
                                .log2_min = (float)log2(options->minimum_alpha),
                                .minimum_alpha = (float)options->minimum_alpha,
                                .minimum_transmittance = (float)options->minimum_transmittance,
                                .harmonic_count = splats ? splats->harmonic_count : 0,
                                .sh_degree = options->sh_degree < degree ? options->sh_degree : degree,
                                .set_unit = splats ? (float)(splats->unit_world / unit_world) : 1,
                                .unit_camera = c.unit_camera};
    for (int row = 0; row < 3; row++) store3(mat3_row(&c.turn, row), view->turn[row]);
    store3(c.origin, view->origin);
    store3(c.eye, view->eye);
    store3(c.forward, view->forward);
    for (int i = 0; i < 4; i++) view->slopes[i] = (float)c.slopes[i];
}

ewa_status ewa_gaussian_job_set_views(ewa_gaussian_job *job, const ewa_camera *camera, const ewa_gaussian_options *options,
                                      bool with_depth) {
    const ewa_mixture *mixture = job->mixture;
    const double unit = choose_unit(mixture);
    ewa_buffer *room = &job->renderer->views;
    EWA_TRY(
        ewa_buffer_reserve(job->renderer->context, room, mixture->splats_count, sizeof(ewa_gaussian_view)));
    ewa_gaussian_view *views = room->data;
    const bool normals = job->view.normals;
    set_view(&job->view, NULL, unit, camera, options, &job->tiles);
    job->view.normals = normals;
    job->view.by_nearest = job->solids && !job->solids->dots;
    job->view.expected = with_depth && options->depth == EWA_DEPTH_EXPECTED;
    for (uint32_t i = 0; i < mixture->splats_count; i++) {
        set_view(&views[i], mixture->splats[i], unit, camera, options, &job->tiles);
        if (job->colors && job->colors[i]) views[i].sh_degree = 0;
        views[i].normals = job->view.normals, views[i].by_nearest = job->view.by_nearest;
        job->view.keep |= views[i].keep; // of what none keeps nothing is that faint
        job->view.with_flat |= views[i].flat;
    }
    job->view.with_depth = with_depth;
    return EWA_OK;
}

/// Adds to a stage's time what went by since `*last_s`.
static void take_time(const ewa_gaussian_job *job, double *last_s, double *stage_s) {
    if (!job->with_times) return;
    const double now_s = ewa_now_s();
    *stage_s += now_s - *last_s;
    *last_s = now_s;
}

/// Takes the splats that are not shown out of a packet.
static void leave_lanes(uint32_t lanes, ewa_splat_packet *packet) {
    for (uint32_t lane = 0; lane < EWA_SPLAT_LANES; lane++)
        if (!(lanes >> lane & 1)) (*packet)[EWA_SPLAT_OPACITY][lane] = 0;
}

/// The visible splats of some packets.
static void project_part(void *data, uint32_t index, uint32_t worker) {
    const ewa_gaussian_job *job = data;
    ewa_gaussian_part *part = &job->parts[index];
    const ewa_splats *splats = part->splats;
    double last_s = job->with_times ? ewa_now_s() : 0;
    for (size_t p = part->first_packet; p < part->first_packet + part->packet_count; p++) {
        const uint32_t lanes = ewa_splats_shown(splats, p);
        const ewa_splat_packet *packet = (const ewa_splat_packet *)&splats->packets[p];
        ewa_splat_packet own;
        if (!lanes) continue;
        if (part->colors) {
            ewa_splat_colors_apply(part->colors, (const ewa_splat_packet *)splats->packets, p, &own);
            packet = (const ewa_splat_packet *)&own;
        }
        if (lanes != EWA_SPLAT_ALL_LANES) {
            if (!part->colors) memcpy(own, packet, sizeof own);
            leave_lanes(lanes, &own);
            packet = (const ewa_splat_packet *)&own;
        }
        job->renderer->kernels->project(part->view, packet,
                                        (const int16_t(*)[EWA_SPLAT_LANES]) &
                                            splats->harmonics[p * splats->harmonic_count],
                                        &part->found);
    }
    take_time(job, &last_s, &job->renderer->scratch[worker].project_s);
}

/// The level of a part: the coarsest one whose splats are within the tolerance of those that they stand for where it is nearest.
static uint32_t choose_level(const ewa_gaussian_view *view, const ewa_splat_part *part, double merge_px) {
    double nearest = (double)view->origin[2] - (double)(part->radius * view->set_unit);
    for (int k = 0; k < 3; k++) nearest += (double)view->turn[2][k] * (double)(part->center[k] * view->set_unit);
    const double px_per_unit = fmax((double)view->fx_px, (double)view->fy_px) / (view->orthographic ? 1 : fmax(nearest, 1e-30));
    uint32_t level = 0;
    while (level < EWA_SPLAT_LEVELS && (double)(part->spacing[level] * view->set_unit) * px_per_unit <= merge_px) level++;
    return level;
}

/// Lists the parts of all sets and what is drawn of each; their rooms follow each other.
static ewa_status list_parts(ewa_gaussian_job *job, double merge_px) {
    ewa_gaussian_renderer *renderer = job->renderer;
    const ewa_mixture *mixture = job->mixture;
    uint64_t part_count = 0, splat_count = 0, room = 0;
    for (uint32_t i = 0; i < mixture->splats_count; i++) {
        part_count += (mixture->splats[i]->packet_count + EWA_SPLAT_PART_PACKETS - 1) / EWA_SPLAT_PART_PACKETS;
        splat_count += mixture->splats[i]->info.splat_count;
    }
    if (splat_count > EWA_SPLATS_MAX || part_count > INT32_MAX / (EWA_SPLAT_PART_PACKETS * EWA_SPLAT_LANES))
        return ewa_fail(renderer->context, EWA_ERROR_LIMIT, "gaussians: %llu in %u sets, more than %d together",
                        (unsigned long long)splat_count, mixture->splats_count, EWA_SPLATS_MAX);
    EWA_TRY(ewa_buffer_reserve(renderer->context, &renderer->parts, part_count, sizeof(ewa_gaussian_part)));
    job->parts = renderer->parts.data;
    job->part_count = 0;
    for (uint32_t set = 0; set < mixture->splats_count; set++) {
        const ewa_splats *splats = mixture->splats[set];
        const ewa_gaussian_view *view = (const ewa_gaussian_view *)renderer->views.data + set;
        for (uint32_t packet = 0; packet < splats->packet_count; packet += EWA_SPLAT_PART_PACKETS) {
            const uint32_t number = packet / EWA_SPLAT_PART_PACKETS, left = splats->packet_count - packet;
            const uint32_t level = splats->part_count && merge_px > 0 ? choose_level(view, &splats->parts[number], merge_px) : 0;
            ewa_gaussian_part *part = &job->parts[job->part_count++];
            *part = (ewa_gaussian_part){.splats = splats, .colors = job->colors ? job->colors[set] : NULL, .view = view, .first_packet = packet, .first_slot = (uint32_t)room,
                                    .packet_count = left < EWA_SPLAT_PART_PACKETS ? left : EWA_SPLAT_PART_PACKETS};
            if (level) part->first_packet = ewa_splats_level(splats, number, level, &part->packet_count);
            room += (uint64_t)part->packet_count * EWA_SPLAT_LANES;
        }
    }
    job->room = (size_t)room;
    return EWA_OK;
}

/// Finds what is visible, each part in its own room.
static ewa_status project_all(ewa_gaussian_job *job) {
    ewa_gaussian_renderer *renderer = job->renderer;
    ewa_context *context = renderer->context;
    EWA_TRY(ewa_buffer_reserve(context, &renderer->records, job->room, sizeof(ewa_gaussian_record)));
    EWA_TRY(ewa_buffer_reserve(context, &renderer->keys, job->room, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &renderer->corners, 2 * job->room, sizeof(int32_t)));
    int32_t *corners = renderer->corners.data;
    for (uint32_t i = 0; i < job->part_count; i++) {
        const size_t first = job->parts[i].first_slot;
        job->parts[i].found = (ewa_gaussian_found){.records = (ewa_gaussian_record *)renderer->records.data + first,
                                                   .keys = (uint32_t *)renderer->keys.data + first,
                                                   .first = corners + first,
                                                   .end = corners + job->room + first};
    }
    return ewa_parallel_stoppable(context, "gaussians", project_part, job, job->part_count);
}

/// Orders what is visible by RECORD_ORDER of each, ties as the splats are.
static ewa_status sort_all(ewa_gaussian_job *job) {
    ewa_gaussian_renderer *renderer = job->renderer;
    job->visible_count = 0;
    for (uint32_t i = 0; i < job->part_count; i++) job->visible_count += job->parts[i].found.count;
    const size_t room = job->visible_count;
    EWA_TRY(ewa_buffer_reserve(renderer->context, &renderer->order, 4 * room + 1, sizeof(uint32_t)));
    uint32_t *numbers = renderer->order.data, *keys = numbers + 2 * room, count = 0;
    for (uint32_t i = 0; i < job->part_count; i++) {
        memcpy(keys + count, job->parts[i].found.keys, job->parts[i].found.count * sizeof *keys);
        for (uint32_t k = 0; k < job->parts[i].found.count; k++) numbers[count++] = job->parts[i].first_slot + k;
    }
    job->ids = ewa_sort_by_keys(numbers, keys, count, room);
    return EWA_OK;
}

/// The tiles of splats, front to back.
static uint32_t find_tiles(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                           const ewa_bin_items *items) {
    (void)worker;
    const ewa_gaussian_job *job = data;
    const int32_t *corners = job->renderer->corners.data;
    const size_t room = job->room;
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t id = job->ids[i];
        items->ids[i] = (int32_t)id;
        items->first[i] = corners[id];
        items->end[i] = corners[room + id];
    }
    return count;
}

static ewa_status reserve_scratch(ewa_context *context, ewa_gaussian_scratch *scratch, size_t maximum, bool solid) {
    // Layers of volumes that wait: no more than come at once.
    const size_t room = (maximum + 15) / 16 * 16 + EWA_GAUSSIAN_MAX_AT_ONCE;
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } wanted[] = {
        {&scratch->marks, EWA_GAUSSIAN_ROW_BLOCKS * room, 1},
        {&scratch->row_ids, room + 1, sizeof(uint32_t)}, // one more is written, then overwritten
        {&scratch->row_marks, room + 1, 1},
        {&scratch->block_ids, room + 1, sizeof(uint32_t)},
        {&scratch->hit, room + 1, sizeof(ewa_gaussian_hit)},
        {&scratch->waiting, room, sizeof(uint32_t)},
        {&scratch->free, room + 1, sizeof(uint32_t)},
        {&scratch->sort_buffer, 1, sizeof(ewa_gaussian_sort_buffer)},
        {&scratch->solid, solid, sizeof(ewa_solid_samples)},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        EWA_TRY(ewa_buffer_reserve(context, wanted[i].buffer, wanted[i].count, wanted[i].size_bytes));
    }
    scratch->block_count = scratch->sorted_count = 0;
    return EWA_OK;
}

static void draw_tile(const ewa_gaussian_job *job, uint32_t index, uint32_t worker,
                      const ewa_gaussian_volume *volumes) {
    const ewa_gaussian_renderer *renderer = job->renderer;
    ewa_gaussian_scratch *scratch = &job->renderer->scratch[worker];
    const ewa_tile_rect place = ewa_tiles_rect(&job->tiles, index);
    const uint64_t first = renderer->by_tile.starts[index];
    ewa_gaussian_tile tile = {.x_px = place.x_px,
                              .y_px = place.y_px,
                              .width_px = place.width_px,
                              .height_px = place.height_px,
                              .records = (const ewa_gaussian_record *)renderer->records.data,
                              .ids = renderer->by_tile.ids ? renderer->by_tile.ids + first : NULL,
                              .count = (uint32_t)(renderer->by_tile.starts[index + 1] - first),
                              .marks = scratch->marks.data,
                              .room = (size_t)(renderer->by_tile.largest + 15) / 16 * 16,
                              .row_ids = scratch->row_ids.data,
                              .row_marks = scratch->row_marks.data,
                              .block_ids = scratch->block_ids.data,
                              .hit = scratch->hit.data,
                              .waiting = scratch->waiting.data,
                              .free = scratch->free.data,
                              .sort_buffer = scratch->sort_buffer.data,
                              .sections = &job->sections,
                              .volumes = volumes,
                              .volume_count = job->mixture->volume_count,
                              .first_row = place.y_px % EWA_VOLUME_TILE_PX / 4,
                              .first_column = place.x_px % EWA_VOLUME_TILE_PX / 4};
    if (job->solids) {
        ewa_gaussian_solids_draw(job->solids, &tile, scratch->solid.data);
    } else {
        renderer->kernels->mark(&tile);
        renderer->kernels->draw(&job->view, &tile, &job->target);
    }
    scratch->block_count += tile.block_count;
    scratch->sorted_count += tile.sorted_count;
}

/// Whether surfaces leave a part of some pixel free, so that what is behind them shows.
static bool has_edges(const ewa_gaussian_job *job, const ewa_tile_rect *area) {
    const ewa_surface_planes *surface = &job->target.surface;
    if (!surface->depth) return false;
    for (uint32_t y = area->y_px; y < area->y_px + area->height_px; y++)
        for (uint32_t x = area->x_px; x < area->x_px + area->width_px; x++) {
            const size_t pixel = (size_t)y * job->target.width_px + x;
            if (surface->depth[pixel] < INFINITY && surface->rgba[4 * pixel + 3] < 1) return true;
        }
    return false;
}

/// Makes the layers of the volumes in an area.
static ewa_status make_layers(const ewa_gaussian_job *job, uint32_t index, uint32_t worker,
                              ewa_gaussian_volume *volumes) {
    ewa_context *context = job->renderer->context;
    const ewa_tile_rect area = ewa_tiles_rect(&job->areas, index);
    const bool edges = has_edges(job, &area);
    ewa_status status = EWA_OK;
    for (uint32_t v = 0; v < job->mixture->volume_count && status == EWA_OK; v++) {
        const ewa_volume_frame *frame = &job->volumes[v];
        volumes[v].unit = frame->grid.unit_camera / job->view.unit_camera;
        status = ewa_volume_tile_layers(context, &frame->job, index, worker, false, &volumes[v].ahead);
        volumes[v].all = volumes[v].ahead;
        if (edges && status == EWA_OK)
            status = ewa_volume_tile_layers(context, &frame->job, index, worker, true, &volumes[v].all);
    }
    return status;
}

/// Draws an area: the tiles of Gaussians in a tile of volumes, or one.
static void draw_area(void *data, uint32_t index, uint32_t worker) {
    const ewa_gaussian_job *job = data;
    ewa_gaussian_scratch *scratch = &job->renderer->scratch[worker];
    double last_s = job->with_times ? ewa_now_s() : 0;
    if (!job->mixture->volume_count) {
        draw_tile(job, index, worker, NULL);
    } else if (scratch->status == EWA_OK) {
        enum { SIDE = EWA_VOLUME_TILE_PX / EWA_GAUSSIAN_TILE_PX };
        ewa_gaussian_volume volumes[EWA_MAX_MIXED_VOLUMES];
        scratch->status = make_layers(job, index, worker, volumes);
        const uint32_t top = SIDE * (index / job->areas.columns), left = SIDE * (index % job->areas.columns);
        for (uint32_t row = top; row < top + SIDE && row < job->tiles.rows; row++)
            for (uint32_t column = left; column < left + SIDE && column < job->tiles.columns; column++)
                if (scratch->status == EWA_OK)
                    draw_tile(job, row * job->tiles.columns + column, worker, volumes);
    }
    take_time(job, &last_s, &scratch->draw_s);
}

static void gather_stats(const ewa_gaussian_job *job, double start_s, double bin_s, ewa_gaussian_stats *stats) {
    const ewa_gaussian_renderer *renderer = job->renderer;
    *stats =
        (ewa_gaussian_stats){.visible_count = job->visible_count, .bin_s = bin_s * renderer->worker_count};
    for (uint32_t i = 0; i < job->mixture->splats_count; i++)
        stats->splat_count += job->mixture->splats[i]->info.splat_count;
    for (uint32_t i = 0; i < job->part_count; i++) stats->near_count += job->parts[i].found.near_count;
    stats->tile_count = renderer->by_tile.starts[ewa_tiles_count(&job->tiles)];
    for (uint32_t i = 0; i < renderer->worker_count; i++) {
        const ewa_gaussian_scratch *s = &renderer->scratch[i];
        stats->block_count += s->block_count;
        stats->sorted_count += s->sorted_count;
        stats->project_s += s->project_s;
        stats->draw_s += s->draw_s;
    }
    stats->total_s = ewa_now_s() - start_s;
}

/// Draws the areas. Layers of volumes need memory while they are made, which an allocator of the caller's gives to
/// the calling thread only.
static ewa_status draw_areas(ewa_gaussian_job *job) {
    ewa_context *context = job->renderer->context;
    const uint32_t count = ewa_tiles_count(&job->areas);
    return job->mixture->volume_count
               ? ewa_parallel_allocating_stoppable(context, "gaussians", draw_area, job, count)
               : ewa_parallel_stoppable(context, "gaussians", draw_area, job, count);
}

/// Draws a frame whose parts are listed by the processor.
static ewa_status draw_by_processor(ewa_gaussian_job *job, double start_s, ewa_gaussian_stats *stats) {
    ewa_gaussian_renderer *renderer = job->renderer;
    ewa_context *context = renderer->context;
    for (uint32_t i = 0; i < renderer->worker_count; i++) {
        ewa_gaussian_scratch *scratch = &renderer->scratch[i];
        scratch->project_s = scratch->draw_s = 0;
        scratch->status = EWA_OK;
    }
    EWA_TRY(project_all(job));
    const double projected_s = ewa_now_s();
    EWA_TRY(sort_all(job));
    EWA_TRY(ewa_bin_lists_fill(context, &renderer->by_tile, job->tiles.columns, job->tiles.rows,
                               job->visible_count, find_tiles, job));
    const double binned_s = ewa_now_s();
    for (uint32_t i = 0; i < renderer->worker_count; i++)
        EWA_TRY(reserve_scratch(context, &renderer->scratch[i], renderer->by_tile.largest, job->solids != NULL));
    EWA_TRY(draw_areas(job));
    for (uint32_t i = 0; i < renderer->worker_count; i++) EWA_TRY(renderer->scratch[i].status);
    if (stats) gather_stats(job, start_s, binned_s - projected_s, stats);
    for (uint32_t i = 0; i < job->mixture->volume_count; i++) {
        const ewa_mixed_volume *volume = &job->mixture->volumes[i];
        if (volume->stats) ewa_volume_frame_measure(volume->renderer, &job->volumes[i], volume->stats);
    }
    return EWA_OK;
}

ewa_status ewa_gaussian_job_draw(ewa_gaussian_job *job, double merge_px, ewa_gaussian_stats *stats) {
    ewa_gaussian_renderer *renderer = job->renderer;
    const double start_s = ewa_now_s();
    EWA_TRY(list_parts(job, merge_px));
    renderer->used_backend = false;
    const ewa_gaussian_backend *backend = renderer->backend;
    if (!backend) return draw_by_processor(job, start_s, stats);
    ewa_gaussian_stats own;
    EWA_TRY(backend->draw(renderer->backend_state, job, stats ? stats : &own, &renderer->used_backend, renderer->remark,
                          sizeof renderer->remark));
    if (renderer->used_backend) {
        if (stats) stats->total_s = ewa_now_s() - start_s;
        return EWA_OK;
    }
    EWA_TRY(draw_by_processor(job, start_s, stats));
    backend->learn(renderer->backend_state, ewa_now_s() - start_s);
    return EWA_OK;
}
