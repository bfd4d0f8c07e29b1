// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which blocks of voxels touch which tiles, front to back.
#include "volume/bin.h"

#include <math.h>
#include <string.h>

/// How far from the first slice single precision may put a voxel.
static const double EDGE_UNITS = 0.01;

/// Slices are bins in rows of so many.
enum { MAX_COLUMNS = 1 << 15 };

/// What a worker found out.
typedef struct bin_facts {
    uint64_t visible_voxel_count, max_in_flight;
    uint32_t longest_span;
} bin_facts;

typedef struct bin_job {
    const ewa_voxel_level *level;
    const ewa_grid_view *grid;
    const ewa_volume_slices *slices;
    const ewa_camera *camera;
    ewa_block_view *views; ///< [block]; right = 0: not to be seen
    ewa_volume_bins *bins;
    uint32_t slice_columns;
    bin_facts *facts;   ///< [worker]
    uint32_t *expiries; ///< [worker][slice], all 0 between tiles
} bin_job;

static double lesser(double a, double b) { return a < b ? a : b; }

static double greater(double a, double b) { return a > b ? a : b; }

/// The whole part of a number within [0, most].
static int32_t clamp_whole(double a, double maximum) { return !(a > 0) ? 0 : (int32_t)lesser(a, maximum); }

/// A block's voxels as a box in camera space.
typedef struct block_corners {
    ewa_vec3 low, ways[3]; ///< from the low to the high side along i, j, k
} block_corners;

/// The box whose sides are `steps` outside of the voxels' centres.
static block_corners find_corners(const ewa_grid_view *grid, const ewa_voxel_block *block, double steps) {
    double low[3];
    block_corners corners;
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = EWA_BLOCK_SIDE * (double)block->place[axis] + block->low[axis] - steps;
        const double way = block->high[axis] - block->low[axis] + 2 * steps;
        corners.ways[axis] = vec3_scale(mat3_row(&grid->axes, axis), way);
    }
    corners.low = ewa_grid_place(grid, low[0], low[1], low[2]);
    return corners;
}

/// The slices of a block's voxels; false where none is to be seen in these.
static bool find_slices(const bin_job *job, const block_corners *corners, ewa_block_view *view) {
    double low = corners->low.z, high = low;
    for (int axis = 0; axis < 3; axis++) {
        low += lesser(corners->ways[axis].z, 0);
        high += greater(corners->ways[axis].z, 0);
    }
    const double last = job->slices->count - 1.0;
    view->slice_first = clamp_whole((low - job->slices->start) / job->slices->unit, last);
    view->slice_last = clamp_whole((high - job->slices->start) / job->slices->unit, last);
    // The kernels place voxels in single precision: those at the edge are looked at by both.
    const double edge = job->slices->start + (job->slices->has_near ? EDGE_UNITS * job->slices->unit : 0);
    view->near = job->slices->has_near && low < edge && high > -job->grid->near;
    return low < EWA_FARTHEST && (job->grid->orthographic || high >= 2 * job->slices->start - edge);
}

/// The box of the projections of a block's corners; false where one reaches the eye.
static bool project_corners(const ewa_grid_view *grid, const block_corners *corners, double box[4]) {
    bool in_front = true;
    box[0] = box[1] = INFINITY, box[2] = box[3] = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        ewa_vec3 p = corners->low;
        for (int axis = 0; axis < 3; axis++)
            if (corner >> axis & 1) p = vec3_add(p, corners->ways[axis]);
        in_front &= grid->orthographic || p.z > 0;
        const double inverse = grid->orthographic ? 1 : 1 / p.z;
        const double x = grid->fx_px * p.x * inverse + grid->cx_px;
        const double y = grid->fy_px * p.y * inverse + grid->cy_px;
        box[0] = lesser(box[0], x), box[1] = lesser(box[1], y);
        box[2] = greater(box[2], x), box[3] = greater(box[3], y);
    }
    return in_front;
}

/// The box on the screen of a block's voxels with their kernels; the whole picture where they reach the eye.
static void find_box(const bin_job *job, const ewa_voxel_block *block, const block_corners *corners,
                     ewa_block_view *view) {
    enum { POINT_WINDOW_PX = 2, SAFETY_PX = 1 };
    const ewa_grid_view *grid = job->grid;
    const ewa_camera *camera = job->camera;
    double box[4];
    bool in_front = project_corners(grid, corners, box);
    if (view->slice_first >= job->slices->point_slice) {
        for (int side = 0; side < 4; side++) box[side] += (side < 2 ? -1 : 1) * (POINT_WINDOW_PX + 0.01);
    } else {
        double wide[4];
        const block_corners around = find_corners(grid, block, grid->cutoff * grid->kernel_steps);
        in_front &= project_corners(grid, &around, wide);
        const double filter2_px2 = grid->cutoff2 * grid->prefilter2_px2;
        for (int side = 0; side < 4; side++) {
            const double kernel_px = wide[side] - box[side];
            const double reach = sqrt(kernel_px * kernel_px + filter2_px2);
            box[side] += (side < 2 ? -1 : 1) * greater(reach + SAFETY_PX, POINT_WINDOW_PX + 0.01);
        }
    }
    const double width = camera->width_px, height = camera->height_px;
    view->left = in_front ? clamp_whole(box[0], width) : 0;
    view->top = in_front ? clamp_whole(box[1], height) : 0;
    view->right = in_front ? clamp_whole(box[2] + 1, width) : (int32_t)camera->width_px;
    view->bottom = in_front ? clamp_whole(box[3] + 1, height) : (int32_t)camera->height_px;
    if (view->left >= view->right || view->top >= view->bottom) view->right = 0;
}

/// Blocks that are to be seen, at their first slices.
static uint32_t find_blocks(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                            const ewa_bin_items *items) {
    const bin_job *job = data;
    bin_facts *facts = &job->facts[worker];
    uint32_t next = first;
    for (uint32_t b = first; b < first + count; b++) {
        ewa_block_view *view = &job->views[b];
        view->block = b;
        const ewa_voxel_block *block = &job->level->blocks[b];
        const block_corners corners = find_corners(job->grid, block, 0);
        const bool ahead = find_slices(job, &corners, view);
        find_box(job, block, &corners, view);
        if (!ahead) view->right = 0;
        if (view->right == 0) continue;
        const uint32_t span = (uint32_t)(view->slice_last - view->slice_first) + 1;
        if (span > facts->longest_span) facts->longest_span = span;
        facts->visible_voxel_count += block->count;
        const uint32_t slice = (uint32_t)view->slice_first;
        items->ids[next] = (int32_t)b;
        items->first[next] = (int32_t)(slice % job->slice_columns | slice / job->slice_columns << 16);
        items->end[next] = items->first[next] + 0x10001;
        next++;
    }
    return next - first;
}

/// The tiles of blocks, front to back.
static uint32_t find_tiles(const void *data, uint32_t worker, uint32_t first, uint32_t count,
                           const ewa_bin_items *items) {
    (void)worker;
    const bin_job *job = data;
    const int32_t side = EWA_VOLUME_TILE_PX;
    for (uint32_t i = first; i < first + count; i++) {
        const ewa_block_view *view = &job->views[job->bins->by_slice.ids[i]];
        items->ids[i] = (int32_t)view->block;
        items->first[i] = view->left / side | view->top / side << 16;
        items->end[i] = ((view->right - 1) / side + 1) | ((view->bottom - 1) / side + 1) << 16;
    }
    return count;
}

/// How many voxels a tile holds at a time: those of blocks whose first slice has come and whose last has not
/// passed.
static void measure_tile(void *data, uint32_t index, uint32_t worker) {
    const bin_job *job = data;
    const ewa_volume_bins *bins = job->bins;
    uint32_t *expiries = job->expiries + (size_t)worker * job->slices->count;
    uint64_t held = 0, maximum = 0;
    int32_t passed = 0;
    const uint64_t end = bins->by_tile.starts[index + 1];
    for (uint64_t i = bins->by_tile.starts[index]; i < end; i++) {
        const ewa_block_view *view = &bins->views[bins->by_tile.ids[i]];
        for (; passed < view->slice_first; passed++) held -= expiries[passed];
        held += job->level->blocks[view->block].count;
        expiries[view->slice_last] += job->level->blocks[view->block].count;
        if (held > maximum) maximum = held;
    }
    for (uint64_t i = bins->by_tile.starts[index]; i < end; i++)
        expiries[bins->views[bins->by_tile.ids[i]].slice_last] = 0;
    if (maximum > job->facts[worker].max_in_flight) job->facts[worker].max_in_flight = maximum;
}

ewa_status ewa_volume_bins_fill(ewa_context *context, ewa_volume_bins *bins, const ewa_voxel_level *level,
                                const ewa_grid_view *grid, const ewa_volume_slices *slices,
                                const ewa_camera *camera) {
    const uint32_t worker_count = ewa_context_worker_count(context);
    const size_t worker_bytes = sizeof(bin_facts) + slices->count * sizeof(uint32_t);
    EWA_TRY(ewa_buffer_reserve(context, &bins->found, level->block_count, sizeof(ewa_block_view)));
    EWA_TRY(ewa_buffer_reserve(context, &bins->workers, worker_count, worker_bytes));
    memset(bins->workers.data, 0, worker_count * worker_bytes);
    bin_job job = {.level = level,
                   .grid = grid,
                   .slices = slices,
                   .camera = camera,
                   .views = bins->found.data,
                   .bins = bins,
                   .slice_columns = slices->count < MAX_COLUMNS ? slices->count : MAX_COLUMNS,
                   .facts = bins->workers.data};
    job.expiries = (uint32_t *)(job.facts + worker_count);
    bins->views = job.views;
    bins->tiles = ewa_tiles_make(camera->width_px, camera->height_px, EWA_VOLUME_TILE_PX);
    EWA_TRY(ewa_bin_lists_fill(context, &bins->by_slice, job.slice_columns,
                               (slices->count + job.slice_columns - 1) / job.slice_columns,
                               (uint32_t)level->block_count, find_blocks, &job));
    EWA_TRY(ewa_bin_lists_fill(context, &bins->by_tile, bins->tiles.columns, bins->tiles.rows,
                               (uint32_t)bins->by_slice.item_count, find_tiles, &job));
    ewa_parallel(context, measure_tile, &job, ewa_tiles_count(&bins->tiles));
    bins->culled_voxel_count = level->voxel_count;
    bins->longest_span = 0, bins->max_in_flight = 0;
    for (const bin_facts *facts = job.facts; facts < job.facts + worker_count; facts++) {
        bins->culled_voxel_count -= facts->visible_voxel_count;
        if (facts->longest_span > bins->longest_span) bins->longest_span = facts->longest_span;
        if (facts->max_in_flight > bins->max_in_flight) bins->max_in_flight = facts->max_in_flight;
    }
    return EWA_OK;
}

void ewa_volume_bins_free(ewa_context *context, ewa_volume_bins *bins) {
    ewa_buffer_free(context, &bins->found);
    ewa_buffer_free(context, &bins->workers);
    ewa_bin_lists_free(context, &bins->by_slice);
    ewa_bin_lists_free(context, &bins->by_tile);
}
