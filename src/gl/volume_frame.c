// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A frame of a volume as the device sees it.
#include "gl/volume_frame.h"

#include <string.h>

const char *ewa_gl_volume_refuse(const ewa_gl *device, const ewa_volume_frame *frame) {
    const ewa_volume_job *job = &frame->job;
    if (job->surface_depth) return "surfaces in a volume are drawn by the CPU";
    if (!job->view.exact && !job->view.orthographic) return "the footprints of the paper are drawn by the CPU";
    if (job->bins->longest_span > EWA_GL_MAX_SPAN || job->slices->count > device->facts.group_count)
        return "grids of very flat voxels are drawn by the CPU";
    if (job->level->voxel_count * 4 * sizeof(uint32_t) > device->facts.storage_bytes) return "voxels that do not fit the device's buffers are drawn by the CPU";
    return NULL;
}

static void set_view(ewa_gl_volume_view *to, const ewa_gl *device, const ewa_volume_frame *frame) {
    const ewa_volume_view *v = &frame->job.view;
    *to = (ewa_gl_volume_view){.orthographic = v->orthographic,
                               .lit = v->lit,
                               .highlights = v->highlights,
                               .with_depth = v->with_depth,
                               .has_near = v->has_near,
                               .mark_splats = v->mark_splats,
                               .with_sections = v->with_sections,
                               .point_slice = v->point_slice,
                               .longest_span = frame->job.bins->longest_span,
                               .group_limit = device->facts.group_count,
                               .fx_px = v->fx_px,
                               .fy_px = v->fy_px,
                               .cx_px = v->cx_px,
                               .cy_px = v->cy_px,
                               .focal_px = v->fx_px > v->fy_px ? v->fx_px : v->fy_px,
                               .unit_inverse = v->unit_inverse,
                               .unit_offset = v->unit_offset,
                               .color_scale = v->color_scale,
                               .point_mass = v->point_mass,
                               .splat_peak = v->splat_peak,
                               .density = v->density,
                               .bend = v->bend,
                               .cutoff = v->cutoff,
                               .cutoff2 = v->cutoff2,
                               .prefilter2_px2 = v->prefilter2_px2,
                               .reach = v->reach,
                               .splat_margin_px = v->cutoff * __builtin_sqrtf(v->prefilter2_px2) + 1,
                               .minimum_transmittance = v->minimum_transmittance,
                               .depth_deviation = v->depth_deviation,
                               .ambient = v->ambient,
                               .diffuse = v->diffuse,
                               .specular = v->specular,
                               .shininess = v->shininess,
                               .flat_share = v->ambient + v->diffuse,
                               .light_count = v->light_count};
    memcpy(to->axes, v->axes, sizeof to->axes);
    memcpy(to->to_deviations, v->to_deviations, sizeof to->to_deviations);
    memcpy(to->marked_color, v->marked_color, sizeof to->marked_color);
    memcpy(to->covariance, v->covariance, sizeof to->covariance);
    memcpy(to->inverse, v->inverse, sizeof to->inverse);
    memcpy(to->to_world, v->to_world, sizeof to->to_world);
    memcpy(to->toward_viewer, v->toward_viewer, sizeof to->toward_viewer);
    memcpy(to->background, frame->job.target.background, sizeof to->background);
    memcpy(to->unit_camera, &v->unit_camera, sizeof to->unit_camera);
    to->picture_px[0] = frame->job.target.width_px, to->picture_px[1] = frame->job.target.height_px;
    for (uint32_t i = 0; i < v->light_count; i++) {
        to->lights[i].headlight = v->lights[i].headlight;
        memcpy(to->lights[i].toward, v->lights[i].toward, sizeof to->lights[i].toward);
        memcpy(to->lights[i].color, v->lights[i].color, sizeof to->lights[i].color);
    }
}

/// The pixels of a tile that a block may touch, one more on each side, a byte each.
static uint32_t box_of(const ewa_block_view *block, const ewa_tile_rect *tile) {
    const int32_t last = EWA_VOLUME_TILE_PX - 1;
    const int32_t sides[4] = {block->left - (int32_t)tile->x_px - 1, block->top - (int32_t)tile->y_px - 1,
                              block->right - (int32_t)tile->x_px, block->bottom - (int32_t)tile->y_px};
    uint32_t box = 0;
    for (int i = 0; i < 4; i++) box |= (uint32_t)(sides[i] < 0 ? 0 : sides[i] > last ? last : sides[i]) << 8 * i;
    return box;
}

/// What a tile adds to its part.
typedef struct tile_needs {
    uint64_t records, runs, buckets, turns;
    int32_t first_unit, last_unit;
} tile_needs;

/// A turn of the loops of volume_draw.glsl for each record and what goes with it, at most: 24 more for each batch of 64 and each unit of a
/// block, one for each unit that a block is waited for in a batch of 64, and a few for each unit.
static tile_needs measure_tile(const ewa_volume_job *job, uint64_t first, uint64_t end) {
    enum { RUN_TURNS = 32, UNIT_TURNS = 16, BATCH = 64, BATCH_TURNS = 2 };
    const ewa_volume_bins *bins = job->bins;
    tile_needs needs = {.first_unit = 0, .last_unit = -1};
    for (uint64_t i = first; i < end; i++) {
        const ewa_block_view *view = &bins->views[bins->by_tile.ids[i]];
        const uint32_t span = (uint32_t)(view->slice_last - view->slice_first) + 1, count = job->level->blocks[view->block].count;
        if (i == first) needs.first_unit = view->slice_first;
        if (view->slice_last > needs.last_unit) needs.last_unit = view->slice_last;
        needs.records += count, needs.runs += span + 1;
        needs.turns += BATCH_TURNS * (uint64_t)count + (RUN_TURNS + 1) * (uint64_t)span + bins->longest_span / BATCH + 2;
    }
    const int32_t end_unit = needs.last_unit + 1 < job->view.point_slice ? needs.last_unit + 1 : job->view.point_slice;
    if (end > first && end_unit > needs.first_unit) needs.buckets = (uint64_t)(end_unit - needs.first_unit) + 1;
    needs.turns += UNIT_TURNS * (uint64_t)(needs.last_unit - needs.first_unit + 1) + job->near->count;
    return needs;
}

/// How many records, and how many tiles, buffers hold.
typedef struct part_room {
    uint64_t records, tiles, words;
} part_room;

static void add_pairs(const ewa_volume_frame *frame, uint32_t index, const ewa_tile_rect *rect, ewa_gl_volume_part *part,
                      ewa_gl_volume_pair *pairs) {
    const ewa_volume_job *job = &frame->job;
    const ewa_volume_bins *bins = job->bins;
    for (uint64_t i = bins->by_tile.starts[index]; i < bins->by_tile.starts[index + 1]; i++) {
        const ewa_block_view *view = &bins->views[bins->by_tile.ids[i]];
        const ewa_volume_source source = ewa_block_source(job->level, job->grid, view);
        ewa_gl_volume_pair *pair = &pairs[part->end_pair++];
        *pair = (ewa_gl_volume_pair){.slice_first = view->slice_first,
                                     .slice_last = view->slice_last,
                                     .first_voxel = (uint32_t)job->level->blocks[view->block].first,
                                     .count = source.count,
                                     .first_record = part->records,
                                     .first_run = part->runs,
                                     .tile = index,
                                     .box = box_of(view, rect)};
        memcpy(pair->origin, source.origin, sizeof pair->origin);
        part->records += source.count;
        part->runs += (uint32_t)(view->slice_last - view->slice_first) + 2;
    }
}

/// Lists the voxels at the eye that the processor draws in a tile (src/volume/tile.c).
static ewa_status add_near(ewa_context *context, ewa_gl_volume_lists *lists, const ewa_volume_job *job, const ewa_tile_rect *rect) {
    const ewa_near_list *from = job->near;
    if (!from->count) return EWA_OK;
    EWA_TRY(ewa_buffer_grow(context, &lists->nears, lists->near_count, (size_t)lists->near_count + from->count, sizeof(ewa_gl_volume_near)));
    ewa_gl_volume_near *nears = lists->nears.data;
    ewa_ray_cone cone;
    ewa_ray_cone_make(&cone, job->grid, rect->x_px, rect->y_px, rect->x_px + rect->width_px, rect->y_px + rect->height_px);
    for (const ewa_near_voxel *at = from->voxels; at < from->voxels + from->count; at++) {
        const double offset[3] = {(double)at->offset[0], (double)at->offset[1], (double)at->offset[2]};
        if (!ewa_ray_cone_hits(&cone, offset, job->grid->cutoff)) continue;
        nears[lists->near_count++] = (ewa_gl_volume_near){{at->offset[0], at->offset[1], at->offset[2]}, at->square,
                                                          {at->color[0], at->color[1], at->color[2]},    at->extinction,
                                                          at->z};
    }
    return EWA_OK;
}

/// Whether a part has room for a tile more.
static bool has_room(const ewa_gl_volume_part *part, const tile_needs *needs, const part_room *room) {
    return part->records + needs->records <= room->records && part->end_tile - part->first_tile < room->tiles &&
           part->runs + needs->runs <= room->words && part->buckets + needs->buckets <= room->words;
}

static ewa_status list_tiles(ewa_gl *device, ewa_gl_volume_lists *lists, const ewa_volume_frame *frame) {
    const ewa_volume_job *job = &frame->job;
    const uint64_t bytes = device->facts.storage_bytes, words = bytes / sizeof(uint32_t);
    const part_room room = {.records = words / lists->record_words,
                            .tiles = words / (EWA_GL_STATE_WORDS * EWA_GL_TILE_PIXELS),
                            .words = words};
    ewa_gl_volume_part *part = NULL;
    for (uint32_t t = 0; t < lists->tile_count; t++) {
        const ewa_tile_rect rect = ewa_tiles_rect(&job->bins->tiles, t);
        const tile_needs needs = measure_tile(job, job->bins->by_tile.starts[t], job->bins->by_tile.starts[t + 1]);
        if (!part || !has_room(part, &needs, &room)) {
            EWA_TRY(ewa_buffer_grow(device->context, &lists->parts, lists->part_count, (size_t)lists->part_count + 1, sizeof *part));
            const uint32_t pairs = part ? part->end_pair : 0;
            part = (ewa_gl_volume_part *)lists->parts.data + lists->part_count++;
            *part = (ewa_gl_volume_part){.first_tile = t, .end_tile = t, .first_pair = pairs, .end_pair = pairs};
            if (!has_room(part, &needs, &room))
                return ewa_fail(device->context, EWA_ERROR_LIMIT, "OpenGL: %llu voxels in a tile of %d pixels are more than %s holds",
                                (unsigned long long)needs.records, EWA_GL_TILE_PIXELS, device->facts.renderer);
        }
        const uint32_t unit_count = needs.buckets ? (uint32_t)needs.buckets - 1 : 0;
        if (unit_count > part->most_units) part->most_units = unit_count;
        if (needs.turns > part->most_turns) part->most_turns = needs.turns;
        ewa_gl_volume_tile *tile = (ewa_gl_volume_tile *)lists->tiles.data + t;
        *tile = (ewa_gl_volume_tile){.x_px = (int32_t)rect.x_px,
                                     .y_px = (int32_t)rect.y_px,
                                     .width_px = (int32_t)rect.width_px,
                                     .height_px = (int32_t)rect.height_px,
                                     .first_pair = part->end_pair,
                                     .first_record = part->records,
                                     .first_bucket = part->buckets,
                                     .first_unit = needs.first_unit,
                                     .last_unit = needs.last_unit,
                                     .first_near = lists->near_count};
        add_pairs(frame, t, &rect, part, lists->pairs.data);
        EWA_TRY(add_near(device->context, lists, job, &rect));
        tile->end_pair = part->end_pair, tile->end_near = lists->near_count;
        part->buckets += (uint32_t)needs.buckets;
        part->end_tile = t + 1;
    }
    return EWA_OK;
}

typedef struct bounds_job {
    const ewa_volume_job *job;
    float *bounds;
} bounds_job;

static void list_units(ewa_gl_volume_lists *lists, const ewa_volume_frame *frame) {
    ewa_gl_volume_unit *units = lists->units.data;
    for (uint32_t i = 0; i < lists->unit_count; i++) {
        const double z = ewa_slice_middle(&frame->slices, i);
        // Surfaces that are that far ahead of a unit hide it (src/volume/tile.c).
        const float passed = (float)(z - frame->slices.unit) - 5 * frame->job.view.depth_deviation;
        units[i] = (ewa_gl_volume_unit){ewa_point_filter_choose(&frame->grid, z), (float)z, passed};
    }
}

/// Where section planes bound the rays of a tile (an ewa_task).
static void bound_tile(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const bounds_job *bounds = data;
    const ewa_tile_rect rect = ewa_tiles_rect(&bounds->job->bins->tiles, index);
    float *ends = bounds->bounds + (size_t)index * EWA_GL_BOUND_WORDS * EWA_GL_TILE_PIXELS;
    ewa_volume_tile_bounds(bounds->job, (int32_t)rect.x_px, (int32_t)rect.y_px, false, ends, ends + EWA_GL_TILE_PIXELS);
}

static ewa_status list_bounds(ewa_context *context, ewa_gl_volume_lists *lists, const ewa_volume_job *job) {
    lists->bound_count = job->view.with_sections ? (size_t)lists->tile_count * EWA_GL_BOUND_WORDS * EWA_GL_TILE_PIXELS : 0;
    if (!lists->bound_count) return EWA_OK;
    EWA_TRY(ewa_buffer_reserve(context, &lists->bounds, lists->bound_count, sizeof(float)));
    bounds_job bounds = {job, lists->bounds.data};
    ewa_parallel(context, bound_tile, &bounds, lists->tile_count);
    return EWA_OK;
}

ewa_status ewa_gl_volume_lists_fill(ewa_gl *device, ewa_gl_volume_lists *lists, const ewa_volume_frame *frame) {
    ewa_context *context = device->context;
    const ewa_volume_job *job = &frame->job;
    const uint64_t pair_count = job->bins->by_tile.starts[ewa_tiles_count(&job->bins->tiles)];
    if (pair_count * sizeof(ewa_gl_volume_pair) > device->facts.storage_bytes)
        return ewa_fail(context, EWA_ERROR_LIMIT, "OpenGL: %llu blocks in tiles are more than %s holds", (unsigned long long)pair_count,
                        device->facts.renderer);
    lists->pair_count = (uint32_t)pair_count, lists->tile_count = ewa_tiles_count(&job->bins->tiles);
    lists->unit_count = frame->slices.count, lists->near_count = lists->part_count = 0;
    lists->record_words = job->view.point_slice > 0 ? EWA_GL_SPLAT_WORDS : EWA_GL_POINT_WORDS;
    EWA_TRY(ewa_buffer_reserve(context, &lists->pairs, lists->pair_count, sizeof(ewa_gl_volume_pair)));
    EWA_TRY(ewa_buffer_reserve(context, &lists->tiles, lists->tile_count, sizeof(ewa_gl_volume_tile)));
    EWA_TRY(ewa_buffer_reserve(context, &lists->units, lists->unit_count, sizeof(ewa_gl_volume_unit)));
    EWA_TRY(list_tiles(device, lists, frame));
    EWA_TRY(list_bounds(context, lists, job));
    list_units(lists, frame);
    set_view(&lists->view, device, frame);
    lists->view.record_words = lists->record_words;
    lists->view.bounds_at = lists->unit_count * (uint32_t)(sizeof(ewa_gl_volume_unit) / sizeof(uint32_t));
    return EWA_OK;
}

void ewa_gl_volume_lists_free(ewa_context *context, ewa_gl_volume_lists *lists) {
    ewa_buffer *const buffers[] = {&lists->pairs, &lists->tiles, &lists->units, &lists->nears, &lists->parts, &lists->bounds};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}
