// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which blocks of voxels touch which tiles, front to back.
#include "volume/bin.h"

#include <math.h>
#include <string.h>

enum { TASK_BLOCKS = 1024 };

/// How far from the first slice single precision may put a voxel.
static const double EDGE_UNITS = 0.01;

typedef struct bin_job {
    ewa_volume_bins *bins;
    const ewa_voxel_level *level;
    const ewa_grid_view *grid;
    const ewa_volume_slices *slices;
    const ewa_camera *camera;
    ewa_block_view *found; ///< [block]; right = 0: not to be seen
    uint64_t *in_flight;   ///< [worker] the most so far
    uint32_t *expiries;    ///< [worker][slice], all 0 between tiles
} bin_job;

static int32_t clamp_px(double px, uint32_t side_px) {
    return !(px > 0) ? 0 : px >= side_px ? (int32_t)side_px : (int32_t)px;
}

/// The slices of a block's voxels; false where none is to be seen in these.
static bool find_slices(const bin_job *job, const ewa_voxel_block *block, ewa_block_view *view) {
    double low = INFINITY, high = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = EWA_BLOCK_SIDE * (double)block->place[axis] +
                       (corner >> axis & 1 ? block->high[axis] : block->low[axis]);
        const double z = ewa_grid_place(job->grid, at[0], at[1], at[2]).z;
        low = fmin(low, z), high = fmax(high, z);
    }
    const double last = job->slices->count - 1.0;
    const double first_slice = floor((low - job->slices->start) / job->slices->unit);
    const double last_slice = floor((high - job->slices->start) / job->slices->unit);
    view->slice_first = (int32_t)fmin(fmax(first_slice, 0), last);
    view->slice_last = (int32_t)fmin(fmax(last_slice, 0), last);
    // The kernels place voxels in single precision: those at the edge are looked at by both.
    const double edge = job->slices->start + (job->slices->has_near ? EDGE_UNITS * job->slices->unit : 0);
    view->near = job->slices->has_near && low < edge && high > -job->grid->near;
    return low < EWA_FARTHEST && (job->grid->orthographic || high >= 2 * job->slices->start - edge);
}

/// Widens a box by the projections of a block's corners, all `steps` outside of its voxels' centres; false
/// where one reaches the eye.
static bool add_corners(const bin_job *job, const ewa_voxel_block *block, double steps, double box[4]) {
    const ewa_grid_view *grid = job->grid;
    bool in_front = true;
    for (int corner = 0; corner < 8; corner++) {
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = EWA_BLOCK_SIDE * (double)block->place[axis] +
                       (corner >> axis & 1 ? block->high[axis] + steps : block->low[axis] - steps);
        const ewa_vec3 p = ewa_grid_place(grid, at[0], at[1], at[2]);
        in_front &= grid->orthographic || p.z > 0;
        const double inverse = grid->orthographic ? 1 : 1 / p.z;
        const double x = grid->fx_px * p.x * inverse + grid->cx_px;
        const double y = grid->fy_px * p.y * inverse + grid->cy_px;
        box[0] = fmin(box[0], x), box[1] = fmin(box[1], y);
        box[2] = fmax(box[2], x), box[3] = fmax(box[3], y);
    }
    return in_front;
}

/// The box on the screen of a block's voxels with their kernels; the whole picture where they reach the eye.
static void find_box(const bin_job *job, const ewa_voxel_block *block, ewa_block_view *view) {
    enum { POINT_WINDOW_PX = 2, SAFETY_PX = 1 };
    const ewa_grid_view *grid = job->grid;
    const ewa_camera *camera = job->camera;
    double box[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY}, wide[4];
    memcpy(wide, box, sizeof wide);
    bool in_front = add_corners(job, block, 0, box);
    if (view->slice_first >= job->slices->point_slice) {
        for (int side = 0; side < 4; side++) box[side] += (side < 2 ? -1 : 1) * (POINT_WINDOW_PX + 0.01);
    } else {
        in_front &= add_corners(job, block, grid->cutoff * grid->kernel_steps, wide);
        for (int side = 0; side < 4; side++) {
            const double reach = hypot(wide[side] - box[side], grid->cutoff * sqrt(grid->prefilter2_px2));
            box[side] += (side < 2 ? -1 : 1) * fmax(reach + SAFETY_PX, POINT_WINDOW_PX + 0.01);
        }
    }
    const double width = camera->width_px, height = camera->height_px;
    view->left = in_front ? clamp_px(floor(box[0]), camera->width_px) : 0;
    view->top = in_front ? clamp_px(floor(box[1]), camera->height_px) : 0;
    view->right = clamp_px(in_front ? ceil(box[2]) : width, camera->width_px);
    view->bottom = clamp_px(in_front ? ceil(box[3]) : height, camera->height_px);
    if (view->left >= view->right || view->top >= view->bottom) view->right = 0;
}

static void find_blocks(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const bin_job *job = data;
    const uint64_t begin = (uint64_t)index * TASK_BLOCKS;
    for (uint64_t b = begin; b < begin + TASK_BLOCKS && b < job->level->block_count; b++) {
        ewa_block_view *view = &job->found[b];
        view->block = (uint32_t)b;
        const bool ahead = find_slices(job, &job->level->blocks[b], view);
        find_box(job, &job->level->blocks[b], view);
        if (!ahead) view->right = 0;
    }
}

/// Sorts what can be seen by first slice, in the order of the blocks' numbers.
static void sort_blocks(const bin_job *job, ewa_block_view *sorted, uint64_t *starts) {
    ewa_volume_bins *bins = job->bins;
    memset(starts, 0, (job->slices->count + (size_t)1) * sizeof *starts);
    bins->visible_count = bins->culled_voxel_count = bins->longest_span = 0;
    for (uint64_t b = 0; b < job->level->block_count; b++) {
        const ewa_block_view *view = &job->found[b];
        if (view->right == 0) {
            bins->culled_voxel_count += job->level->blocks[b].count;
            continue;
        }
        const uint32_t span = (uint32_t)(view->slice_last - view->slice_first) + 1;
        if (span > bins->longest_span) bins->longest_span = span;
        bins->visible_count++;
        starts[view->slice_first + 1]++;
    }
    for (uint32_t s = 0; s < job->slices->count; s++) starts[s + 1] += starts[s];
    for (uint64_t b = 0; b < job->level->block_count; b++)
        if (job->found[b].right) sorted[starts[job->found[b].slice_first]++] = job->found[b];
    bins->views = sorted;
}

typedef struct tile_range {
    uint32_t left, top, right, bottom;
} tile_range;

static tile_range tiles_of(const ewa_block_view *view) {
    return (tile_range){(uint32_t)view->left / EWA_VOLUME_TILE_PX, (uint32_t)view->top / EWA_VOLUME_TILE_PX,
                        ((uint32_t)view->right - 1) / EWA_VOLUME_TILE_PX,
                        ((uint32_t)view->bottom - 1) / EWA_VOLUME_TILE_PX};
}

/// Counts the blocks of tiles, or, with `list`, lists them.
static void list_tiles(const ewa_volume_bins *bins, uint64_t *numbers, uint32_t *list) {
    for (uint64_t v = 0; v < bins->visible_count; v++) {
        const tile_range range = tiles_of(&bins->views[v]);
        for (uint32_t y = range.top; y <= range.bottom; y++)
            for (uint32_t x = range.left; x <= range.right; x++) {
                uint64_t *number = &numbers[(size_t)y * bins->tiles_x + x];
                if (list) list[*number] = (uint32_t)v;
                (*number)++;
            }
    }
}

/// How many voxels a tile holds at a time: those of blocks whose first slice has come and whose last has not
/// passed.
static void measure_tile(void *data, uint32_t index, uint32_t worker) {
    const bin_job *job = data;
    const ewa_volume_bins *bins = job->bins;
    uint32_t *expiries = job->expiries + (size_t)worker * job->slices->count;
    uint64_t held = 0, most = 0;
    int32_t passed = 0;
    const uint64_t end = bins->tile_first[index + 1];
    for (uint64_t i = bins->tile_first[index]; i < end; i++) {
        const ewa_block_view *view = &bins->views[bins->list[i]];
        for (; passed < view->slice_first; passed++) held -= expiries[passed];
        held += job->level->blocks[view->block].count;
        expiries[view->slice_last] += job->level->blocks[view->block].count;
        if (held > most) most = held;
    }
    for (uint64_t i = bins->tile_first[index]; i < end; i++)
        expiries[bins->views[bins->list[i]].slice_last] = 0;
    if (most > job->in_flight[worker]) job->in_flight[worker] = most;
}

static ewa_status fill_lists(ewa_context *context, bin_job *job) {
    ewa_volume_bins *bins = job->bins;
    const uint32_t tile_count = bins->tiles_x * bins->tiles_y;
    const uint32_t worker_count = ewa_context_worker_count(context);
    ewa_status status = ewa_buffer_reserve(context, &bins->tiles, tile_count + (size_t)1, sizeof(uint64_t));
    const size_t expiry_bytes = (size_t)job->slices->count * sizeof(uint32_t) + sizeof(uint64_t);
    if (status == EWA_OK) status = ewa_buffer_reserve(context, &bins->expiries, worker_count, expiry_bytes);
    if (status != EWA_OK) return status;
    // Counts, then ends, which listing from the first block on turns into beginnings of the next.
    uint64_t *first = bins->tiles.data;
    memset(first, 0, (tile_count + (size_t)1) * sizeof *first);
    list_tiles(bins, first, NULL);
    uint64_t total = 0;
    for (uint32_t t = 0; t <= tile_count; t++) {
        const uint64_t count = first[t];
        first[t] = total;
        total += count;
    }
    status = ewa_buffer_reserve(context, &bins->lists, total, sizeof(uint32_t));
    if (status != EWA_OK) return status;
    list_tiles(bins, first, bins->lists.data);
    for (uint32_t t = tile_count; t > 0; t--) first[t] = first[t - 1];
    first[0] = 0;
    bins->tile_first = first;
    bins->list = bins->lists.data;
    memset(bins->expiries.data, 0, worker_count * expiry_bytes);
    job->in_flight = bins->expiries.data;
    job->expiries = (uint32_t *)(job->in_flight + worker_count);
    ewa_parallel(context, measure_tile, job, tile_count);
    bins->most_in_flight = 0;
    for (uint32_t w = 0; w < worker_count; w++)
        if (job->in_flight[w] > bins->most_in_flight) bins->most_in_flight = job->in_flight[w];
    return EWA_OK;
}

ewa_status ewa_volume_bins_fill(ewa_context *context, ewa_volume_bins *bins, const ewa_voxel_level *level,
                                const ewa_grid_view *grid, const ewa_volume_slices *slices,
                                const ewa_camera *camera) {
    bins->tiles_x = (camera->width_px + EWA_VOLUME_TILE_PX - 1) / EWA_VOLUME_TILE_PX;
    bins->tiles_y = (camera->height_px + EWA_VOLUME_TILE_PX - 1) / EWA_VOLUME_TILE_PX;
    bin_job job = {.bins = bins, .level = level, .grid = grid, .slices = slices, .camera = camera};
    ewa_status status = ewa_buffer_reserve(context, &bins->found, level->block_count, sizeof(ewa_block_view));
    if (status == EWA_OK)
        status = ewa_buffer_reserve(context, &bins->sorted, level->block_count, sizeof(ewa_block_view));
    if (status == EWA_OK)
        status =
            ewa_buffer_reserve(context, &bins->slice_counts, slices->count + (size_t)1, sizeof(uint64_t));
    if (status != EWA_OK) return status;
    job.found = bins->found.data;
    bins->all = job.found;
    ewa_parallel(context, find_blocks, &job,
                 (uint32_t)((level->block_count + TASK_BLOCKS - 1) / TASK_BLOCKS));
    sort_blocks(&job, bins->sorted.data, bins->slice_counts.data);
    return fill_lists(context, &job);
}

void ewa_volume_bins_free(ewa_context *context, ewa_volume_bins *bins) {
    ewa_buffer_free(context, &bins->found);
    ewa_buffer_free(context, &bins->sorted);
    ewa_buffer_free(context, &bins->slice_counts);
    ewa_buffer_free(context, &bins->tiles);
    ewa_buffer_free(context, &bins->lists);
    ewa_buffer_free(context, &bins->expiries);
}
