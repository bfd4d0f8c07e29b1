// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One tile of a picture of voxels: blocks in, buckets by depth, pixels out.
//
// Based on: X. Yuan, M. Nguyen, H. Xu, B. Chen, "Hybrid Forward Resampling and Volume Rendering", 2003,
// section 4.1 (splats composited one by one, points summed first) and section 6 (occlusion culling).
#include "volume/tile.h"
#include "volume/near.h"
#include "volume/sort.h"

#include <math.h>
#include <string.h>

static uint32_t ring_size(const ewa_volume_bins *bins) {
    uint32_t size = 2;
    while (size <= bins->longest_span) size *= 2;
    return size;
}

static size_t page_count(const ewa_volume_bins *bins) {
    return bins->max_in_flight / EWA_PAGE_RECORDS + ring_size(bins) + 1;
}

ewa_status ewa_volume_scratch_reserve(ewa_context *context, ewa_volume_scratch *scratch,
                                      const ewa_volume_job *job) {
    const size_t pages = page_count(job->bins), block_floats = EWA_VOLUME_TILE_BLOCKS * (size_t)16;
    const bool has_splats = job->slices->point_slice > 0;
    // Two lists of numbers and keys each, which sorting goes to and fro between.
    const size_t sorted = has_splats ? 2 * pages * EWA_PAGE_RECORDS : 0;
    const struct {
        ewa_buffer *buffer;
        size_t count, size_bytes;
    } wanted[] = {
        {&scratch->sums, (size_t)EWA_SUMS_ROW_BLOCKS * EWA_SUMS_STRIP, sizeof(float)},
        {&scratch->pixels, block_floats * EWA_VOLUME_CHANNELS, sizeof(float)},
        {&scratch->surface, job->view.with_surface ? block_floats : 0, sizeof(float)},
        {&scratch->enter, job->view.with_sections ? block_floats : 0, sizeof(float)},
        {&scratch->ring, ring_size(job->bins), sizeof(ewa_volume_bucket)},
        {&scratch->colors, pages, EWA_PAGE_RECORDS * sizeof(float[4])},
        {&scratch->windows, pages, EWA_PAGE_RECORDS * sizeof(int32_t)},
        {&scratch->splats, has_splats ? pages : 0, EWA_PAGE_RECORDS * sizeof(ewa_splat_place)},
        {&scratch->next, pages, sizeof(uint32_t)},
        {&scratch->free, pages, sizeof(uint32_t)},
        {&scratch->order, sorted, sizeof(uint32_t)},
        {&scratch->keys, sorted, sizeof(uint32_t)},
        {&scratch->near, job->near->count, sizeof(ewa_near_voxel)},
        {&scratch->queue, 1, sizeof(ewa_volume_queue)},
    };
    if (pages >= EWA_NO_PAGE / EWA_PAGE_RECORDS)
        return ewa_fail(context, EWA_ERROR_MEMORY, "volume: %llu voxels in one tile at a time",
                        (unsigned long long)job->bins->max_in_flight);
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        EWA_TRY(ewa_buffer_reserve(context, wanted[i].buffer, wanted[i].count, wanted[i].size_bytes));
    }
    scratch->hidden_count = scratch->splat_count = scratch->point_count = 0;
    scratch->setup_s = scratch->points_s = scratch->splats_s = scratch->resolve_s = 0;
    return EWA_OK;
}

void ewa_volume_scratch_free(ewa_context *context, ewa_volume_scratch *scratch) {
    ewa_buffer *const buffers[] = {&scratch->sums,   &scratch->pixels,  &scratch->surface, &scratch->ring,
                                   &scratch->colors, &scratch->windows, &scratch->splats,  &scratch->next,
                                   &scratch->free,   &scratch->order,   &scratch->keys,    &scratch->near,
                                   &scratch->queue,  &scratch->enter};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) ewa_buffer_free(context, buffers[i]);
    ewa_buffer_free(context, &scratch->lists);
    for (int i = 0; i < 2; i++) ewa_buffer_free(context, &scratch->layers[i]);
}

void ewa_volume_tile_bounds(const ewa_volume_job *job, int32_t x_px, int32_t y_px, bool everything, float *ends, float *begins) {
    const double unit = job->grid->unit_camera;
    for (uint32_t row = 0; row < EWA_VOLUME_TILE_PX; row++)
        for (uint32_t column = 0; column < EWA_VOLUME_TILE_PX; column++) {
            const size_t block = (size_t)(row / 4) * EWA_VOLUME_ROW_BLOCKS + column / 4;
            const size_t at = 16 * block + 4 * (row % 4) + column % 4;
            const uint32_t x = (uint32_t)x_px + column, y = (uint32_t)y_px + row;
            const bool inside = x < job->target.width_px && y < job->target.height_px;
            const size_t pixel = (size_t)y * job->target.width_px + x;
            double end = INFINITY;
            if (inside && job->surface_depth && !everything) end = (double)job->surface_depth[pixel] / unit;
            if (job->sections.count) {
                double enter, leave;
                ewa_ray_sections_range(&job->sections, x + 0.5, y + 0.5, &enter, &leave);
                begins[at] = (float)(enter / unit);
                end = fmin(end, leave / unit);
            }
            ends[at] = (float)end;
        }
}

static void start_tile(const ewa_volume_job *job, ewa_volume_scratch *scratch, uint32_t index,
                       bool everything, ewa_volume_tile *tile) {
    const ewa_tile_rect place = ewa_tiles_rect(&job->bins->tiles, index);
    *tile = (ewa_volume_tile){
        .x_px = (int32_t)place.x_px,
        .y_px = (int32_t)place.y_px,
        .width_px = (int32_t)place.width_px,
        .height_px = (int32_t)place.height_px,
        .sums = scratch->sums.data,
        .pixels = scratch->pixels.data,
        .surface = scratch->surface.data,
        .enter = scratch->enter.data,
        .ring = scratch->ring.data,
        .ring_mask = ring_size(job->bins) - 1,
        .pages = {.colors = scratch->colors.data,
                  .windows = scratch->windows.data,
                  .splats = job->slices->point_slice > 0 ? scratch->splats.data : NULL,
                  .next = scratch->next.data,
                  .free = scratch->free.data},
        .queue = scratch->queue.data,
    };
    memset(tile->queue, 0, sizeof *tile->queue); // lanes that hold no voxel are shaded, too
    memset(tile->sums, 0, (size_t)EWA_SUMS_ROW_BLOCKS * EWA_SUMS_STRIP * sizeof(float));
    memset(tile->ring, 0, ring_size(job->bins) * sizeof *tile->ring);
    tile->pages.free_count = (uint32_t)page_count(job->bins);
    for (uint32_t i = 0; i < tile->pages.free_count; i++)
        tile->pages.free[i] = tile->pages.free_count - 1 - i; // the first ones first: they stay in the cache
    job->kernels->clear(tile);
    if (job->view.with_surface) ewa_volume_tile_bounds(job, tile->x_px, tile->y_px, everything, tile->surface, tile->enter);
    // What lies outside of the picture needs nothing more.
    memset(tile->hidden, 1, sizeof tile->hidden);
    for (uint32_t row = 0; 4 * row < place.height_px; row++)
        for (uint32_t column = 0; 4 * column < place.width_px; column++) {
            tile->hidden[ewa_sums_cell(row, column)] = 0;
            tile->cell_count++;
        }
    tile->visible_count = tile->cell_count;
}

/// The row or column of cells of a place in the tile, or the nearest one.
static uint32_t cell_of(int32_t px) {
    const int32_t last = EWA_VOLUME_TILE_PX - 1;
    return (uint32_t)(px < 0 ? 0 : px > last ? last : px) / 4;
}

/// Of the cells that a block touches: whether something more would show in any, and in all.
static void look_behind(const ewa_volume_tile *tile, const ewa_block_view *view, bool *some_open,
                        bool *all_open) {
    const uint32_t top = cell_of(view->top - tile->y_px), bottom = cell_of(view->bottom - 1 - tile->y_px);
    const uint32_t right = cell_of(view->right - 1 - tile->x_px);
    *some_open = false, *all_open = true;
    for (uint32_t column = cell_of(view->left - tile->x_px); column <= right; column++) {
        const uint8_t *hidden = &tile->hidden[ewa_sums_cell(top, column)];
        *some_open |= memchr(hidden, 0, bottom - top + 1) != NULL;
        *all_open &= !memchr(hidden, 1, bottom - top + 1);
    }
}

/// Hides cells whose surfaces lie wholly in front of voxels at a depth: there 3e-7 of one would show.
static void hide_behind_surface(const ewa_volume_job *job, ewa_volume_tile *tile, float z) {
    const float passed = z - 5 * job->view.depth_deviation;
    for (uint32_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++) {
        bool hidden = true;
        for (int i = 0; i < 16; i++) hidden &= tile->surface[16 * block + i] < passed;
        if (hidden)
            ewa_hide_cell(tile, ewa_sums_cell(block / EWA_VOLUME_ROW_BLOCKS, block % EWA_VOLUME_ROW_BLOCKS));
    }
}

/// Projects a block's voxels into the tile's buckets, those that would show; returns how many would not.
static uint32_t add_block(const ewa_volume_job *job, ewa_volume_tile *tile, const ewa_block_view *view) {
    bool some_open, all_open;
    look_behind(tile, view, &some_open, &all_open);
    if (!some_open) return job->level->blocks[view->block].count;
    ewa_volume_source source = ewa_block_source(job->level, job->grid, view);
    source.some_hidden = !all_open;
    return job->kernels->append(&job->view, &source, tile);
}

/// Splats of one depth unit, by their distances (ewa_grid_distance()).
static void draw_splats(const ewa_volume_job *job, ewa_volume_scratch *scratch, ewa_volume_tile *tile,
                        const ewa_volume_bucket *bucket) {
    const uint32_t end = ewa_bucket_count(bucket);
    uint32_t *numbers = scratch->order.data, *keys = scratch->keys.data, count = 0;
    uint32_t page = bucket->first_page;
    while (count < end) {
        for (uint32_t slot = 0; slot < EWA_PAGE_RECORDS && count < end; slot++, count++) {
            numbers[count] = page * EWA_PAGE_RECORDS + slot;
            keys[count] = ewa_sort_key(tile->pages.splats[numbers[count]].distance);
        }
        page = tile->pages.next[page];
    }
    const uint32_t *order = ewa_sort_by_keys(numbers, keys, count, page_count(job->bins) * EWA_PAGE_RECORDS);
    job->kernels->draw_splats(&job->view, tile, order, count);
    scratch->splat_count += count;
}

static void draw_points(const ewa_volume_job *job, ewa_volume_scratch *scratch, ewa_volume_tile *tile,
                        const ewa_volume_bucket *bucket, double z) {
    const uint32_t filter = ewa_point_filter_choose(job->grid, z);
    job->kernels->sum_points(tile, bucket, &job->filters[filter]);
    job->kernels->composite(&job->view, tile, (float)z);
    scratch->point_count += ewa_bucket_count(bucket);
}

/// The voxels at the eye that rays of the tile meet.
static void draw_near(const ewa_volume_job *job, ewa_volume_scratch *scratch, ewa_volume_tile *tile) {
    ewa_near_voxel *hit = scratch->near.data;
    uint32_t count = 0;
    ewa_ray_cone cone;
    ewa_ray_cone_make(&cone, job->grid, tile->x_px, tile->y_px, tile->x_px + tile->width_px,
                      tile->y_px + tile->height_px);
    for (const ewa_near_voxel *at = job->near->voxels; at < job->near->voxels + job->near->count; at++) {
        const double offset[3] = {(double)at->offset[0], (double)at->offset[1], (double)at->offset[2]};
        if (ewa_ray_cone_hits(&cone, offset, job->grid->cutoff)) hit[count++] = *at;
    }
    job->kernels->draw_near(&job->view, tile, hit, count);
    scratch->splat_count += count;
}

static void empty_bucket(ewa_volume_tile *tile, ewa_volume_bucket *bucket) {
    uint32_t page = bucket->first_page;
    for (; bucket->page_count; bucket->page_count--) {
        tile->pages.free[tile->pages.free_count++] = page;
        page = tile->pages.next[page];
    }
    bucket->next = 0;
}

/// Adds to a stage's time what went by since `*last_s`.
static void take_time(const ewa_volume_job *job, double *last_s, double *stage_s) {
    if (!job->with_times) return;
    const double now_s = ewa_now_s();
    *stage_s += now_s - *last_s;
    *last_s = now_s;
}

/// What takes the tile's layers while it is composited.
typedef struct layer_taker {
    ewa_context *context;
    ewa_buffer *room;
    ewa_volume_layers *layers;
} layer_taker;

/// Takes what the pixels have got; `taker` NULL: nothing does.
static ewa_status take_layers(const ewa_volume_job *job, const ewa_volume_tile *tile, double z,
                              const layer_taker *taker) {
    if (!taker) return EWA_OK;
    const size_t count = taker->layers->count;
    EWA_TRY(ewa_buffer_grow(taker->context, taker->room, count, count + EWA_VOLUME_TILE_BLOCKS,
                            sizeof(ewa_volume_layer)));
    taker->layers->layers = taker->room->data;
    job->kernels->take_layers(tile, (float)z, taker->layers);
    return EWA_OK;
}

/// Composites a tile that is set up, front to back.
static ewa_status composite_tile(const ewa_volume_job *job, ewa_volume_scratch *scratch,
                                 ewa_volume_tile *tile, uint32_t index, double *last_s,
                                 const layer_taker *taker) {
    const ewa_volume_bins *bins = job->bins;
    uint64_t next = bins->by_tile.starts[index];
    const uint64_t end = bins->by_tile.starts[index + 1];
    int32_t last_slice = -1;
    ewa_status status = EWA_OK;
    if (job->near->count) {
        take_time(job, last_s, &scratch->setup_s);
        draw_near(job, scratch, tile);
        take_time(job, last_s, &scratch->splats_s);
        status = take_layers(job, tile, fmax(job->slices->start, 0), taker);
    }
    for (int32_t slice = 0; slice < (int32_t)job->slices->count && status == EWA_OK; slice++) {
        if (slice > last_slice) { // nothing in flight
            if (next == end) break;
            slice = bins->views[bins->by_tile.ids[next]].slice_first;
        }
        for (; next < end && bins->views[bins->by_tile.ids[next]].slice_first <= slice; next++) {
            const ewa_block_view *view = &bins->views[bins->by_tile.ids[next]];
            if (view->slice_last > last_slice) last_slice = view->slice_last;
            scratch->hidden_count += add_block(job, tile, view);
        }
        job->kernels->flush(&job->view, tile);
        take_time(job, last_s, &scratch->setup_s);
        ewa_volume_bucket *bucket = &tile->ring[(uint32_t)slice & tile->ring_mask];
        if (bucket->page_count == 0) continue;
        const double z = ewa_slice_middle(job->slices, (uint32_t)slice);
        if (job->view.with_surface) hide_behind_surface(job, tile, (float)(z - job->slices->unit));
        if (slice < job->view.point_slice) {
            draw_splats(job, scratch, tile, bucket);
            take_time(job, last_s, &scratch->splats_s);
        } else {
            draw_points(job, scratch, tile, bucket, z);
            take_time(job, last_s, &scratch->points_s);
        }
        empty_bucket(tile, bucket);
        status = take_layers(job, tile, z, taker);
        if (tile->visible_count == 0) break;
    }
    for (; next < end; next++)
        scratch->hidden_count += job->level->blocks[bins->views[bins->by_tile.ids[next]].block].count;
    return status;
}

void ewa_volume_tile_draw(void *data, uint32_t index, uint32_t worker) {
    const ewa_volume_job *job = data;
    ewa_volume_scratch *scratch = &job->scratch[worker];
    ewa_volume_tile tile;
    double last_s = job->with_times ? ewa_now_s() : 0;
    start_tile(job, scratch, index, false, &tile);
    (void)composite_tile(job, scratch, &tile, index, &last_s, NULL); // only layers need memory
    job->kernels->resolve(&job->view, &tile, &job->target);
    take_time(job, &last_s, &scratch->resolve_s);
}

ewa_status ewa_volume_tile_layers(ewa_context *context, const ewa_volume_job *job, uint32_t index,
                                  uint32_t worker, bool everything, const ewa_volume_layers **layers) {
    ewa_volume_scratch *scratch = &job->scratch[worker];
    EWA_TRY(ewa_buffer_reserve(context, &scratch->lists, 2, sizeof(ewa_volume_layers)));
    ewa_volume_layers *lists = (ewa_volume_layers *)scratch->lists.data + everything;
    lists->count = 0;
    for (uint32_t block = 0; block < EWA_VOLUME_TILE_BLOCKS; block++) {
        lists->first[block] = EWA_NO_LAYER;
        memset(lists->before[block], 0, 3 * sizeof lists->before[block][0]);
        for (int i = 0; i < 16; i++) lists->before[block][3][i] = 1;
    }
    ewa_volume_tile tile;
    double last_s = job->with_times ? ewa_now_s() : 0;
    start_tile(job, scratch, index, everything, &tile);
    const layer_taker taker = {context, &scratch->layers[everything], lists};
    const uint64_t counts[3] = {scratch->hidden_count, scratch->splat_count, scratch->point_count};
    ewa_status status = composite_tile(job, scratch, &tile, index, &last_s, &taker);
    if (everything) // the same voxels once more
        scratch->hidden_count = counts[0], scratch->splat_count = counts[1], scratch->point_count = counts[2];
    *layers = lists;
    return status;
}
