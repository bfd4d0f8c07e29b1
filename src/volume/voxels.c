// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a volume to its occupied voxels, block by block, and from those to coarser ones.
//
// Based on: M. Levoy, "Efficient Ray Tracing of Volume Data", 1990 (blocks skipped by what their values may
// be; here by smallest and largest value against the transfer function).
#include "volume/voxels.h"
#include "base/base.h"
#include "image/volume.h"
#include "volume/classify.h"
#include "volume/options.h"

#include <math.h>
#include <string.h>

enum { NO_BLOCK = UINT32_MAX };

/// A block's voxels before they are packed, in the order in which they are kept.
typedef struct open_block {
    uint32_t count;
    uint16_t places[EWA_BLOCK_VOXELS];
    ewa_voxel voxels[EWA_BLOCK_VOXELS];
} open_block;

/// All that a level is made from; `fine` is NULL for the first, which comes from the volume.
typedef struct builder {
    const ewa_classifier *classifier;
    double color_scale;
    const ewa_voxel_level *fine;
    const uint32_t *fine_block; ///< [block of the fine level's grid] or NO_BLOCK
    uint32_t fine_grid[3], grid[3];
    uint16_t *counts;   ///< [block of this level's grid]
    uint8_t *skipped;   ///< [block of this level's grid] by its values
    uint32_t *block_of; ///< [block of this level's grid] or NO_BLOCK
    ewa_voxel_level *level;
} builder;

/// The n-th place of a block: neighbours within 4 voxels come at least 8 places apart.
static uint16_t place_of(uint32_t n) {
    const uint32_t i = (n & 1) << 2 | (n >> 3 & 3), j = (n >> 1 & 1) << 2 | (n >> 5 & 3);
    const uint32_t k = (n >> 2 & 1) << 2 | (n >> 7 & 3);
    return (uint16_t)(i | j << 3 | k << 6);
}

static void block_place(const uint32_t grid[3], uint64_t block, uint32_t place[3]) {
    place[0] = (uint32_t)(block % grid[0]);
    place[1] = (uint32_t)(block / grid[0] % grid[1]);
    place[2] = (uint32_t)(block / grid[0] / grid[1]);
}

/// Calls `row` for every row of a block's values.
typedef void block_row(void *data, const float *values, uint32_t count);

static void each_row(const ewa_volume *volume, const uint32_t place[3], block_row *row, void *data) {
    uint32_t first[3], count[3];
    for (int axis = 0; axis < 3; axis++) {
        first[axis] = place[axis] * EWA_BLOCK_SIDE;
        const uint32_t left = volume->dims[axis] - first[axis];
        count[axis] = left < EWA_BLOCK_SIDE ? left : EWA_BLOCK_SIDE;
    }
    float values[EWA_BLOCK_SIDE];
    for (uint32_t k = first[2]; k < first[2] + count[2]; k++)
        for (uint32_t j = first[1]; j < first[1] + count[1]; j++) {
            const uint64_t at = ((uint64_t)k * volume->dims[1] + j) * volume->dims[0] + first[0];
            ewa_volume_read(volume, at, count[0], values);
            row(data, values, count[0]);
        }
}

static void widen_range(void *data, const float *values, uint32_t count) {
    float *range = data;
    for (uint32_t i = 0; i < count; i++) {
        range[0] = values[i] < range[0] ? values[i] : range[0]; // a NaN is no value
        range[1] = values[i] > range[1] ? values[i] : range[1];
    }
}

/// Whether no voxel of a block can be seen, by its smallest and largest value.
static bool is_empty(const builder *b, const uint32_t place[3]) {
    float range[2] = {INFINITY, -INFINITY};
    each_row(b->classifier->volume, place, widen_range, range);
    return !(range[0] <= range[1]) ||
           !ewa_classifier_reaches(b->classifier, (double)range[0], (double)range[1]);
}

static void gather_values(const builder *b, const uint32_t place[3], bool with_normals, open_block *open) {
    const uint32_t *dims = b->classifier->volume->dims;
    open->count = 0;
    for (uint32_t n = 0; n < EWA_BLOCK_VOXELS; n++) {
        const uint16_t at = place_of(n);
        const uint32_t i = place[0] * EWA_BLOCK_SIDE + (at & 7);
        const uint32_t j = place[1] * EWA_BLOCK_SIDE + (at >> 3 & 7);
        const uint32_t k = place[2] * EWA_BLOCK_SIDE + (at >> 6);
        if (i >= dims[0] || j >= dims[1] || k >= dims[2]) continue;
        if (!ewa_classify(b->classifier, i, j, k, with_normals, &open->voxels[open->count])) continue;
        // What the resident float would round to nothing is nothing.
        if ((float)open->voxels[open->count].extinction > 0) open->places[open->count++] = at;
    }
}

static ewa_vec3 unpack_normal(int32_t normal) {
    int32_t v[3];
    for (int c = 0; c < 3; c++) v[c] = (int32_t)((uint32_t)normal << (22 - 10 * c)) >> 22;
    return vec3_make(v[0], v[1], v[2]);
}

/// Means over 2x2x2 finer voxels, weighted by their extinctions.
static void gather_finer(const builder *b, const uint32_t place[3], open_block *open) {
    typedef struct sums {
        double extinction, color[3];
        ewa_vec3 normal;
    } sums;
    sums cells[EWA_BLOCK_VOXELS];
    memset(cells, 0, sizeof cells);
    for (uint32_t part = 0; part < 8; part++) {
        const uint32_t at[3] = {2 * place[0] + (part & 1), 2 * place[1] + (part >> 1 & 1),
                                2 * place[2] + (part >> 2)};
        if (at[0] >= b->fine_grid[0] || at[1] >= b->fine_grid[1] || at[2] >= b->fine_grid[2]) continue;
        const uint32_t index =
            b->fine_block[((size_t)at[2] * b->fine_grid[1] + at[1]) * b->fine_grid[0] + at[0]];
        if (index == NO_BLOCK) continue;
        const ewa_voxel_block *block = &b->fine->blocks[index];
        for (uint64_t v = block->first; v < block->first + block->count; v++) {
            const uint32_t fine = b->fine->places[v];
            const uint32_t i = (part & 1) * 4 + (fine & 7) / 2, j = (part >> 1 & 1) * 4 + (fine >> 3 & 7) / 2;
            const uint32_t k = (part >> 2) * 4 + (fine >> 6) / 2;
            sums *cell = &cells[i | j << 3 | k << 6];
            const double extinction = (double)b->fine->extinctions[v];
            cell->extinction += extinction;
            for (int c = 0; c < 3; c++) cell->color[c] += extinction * b->fine->colors[c][v];
            const ewa_vec3 normal = unpack_normal(b->fine->normals[v]);
            cell->normal = vec3_add(cell->normal, vec3_scale(normal, extinction));
        }
    }
    open->count = 0;
    for (uint32_t n = 0; n < EWA_BLOCK_VOXELS; n++) {
        const uint16_t at = place_of(n);
        const sums *cell = &cells[at];
        if (!((float)(cell->extinction / 8) > 0)) continue;
        ewa_voxel *voxel = &open->voxels[open->count];
        *voxel = (ewa_voxel){.extinction = cell->extinction / 8, .normal_world = cell->normal};
        for (int c = 0; c < 3; c++)
            voxel->color[c] = cell->color[c] / cell->extinction * b->color_scale / 65535;
        if (!vec3_normalize(&voxel->normal_world)) voxel->normal_world = vec3_make(0, 0, 0);
        open->places[open->count++] = at;
    }
}

static void gather(const builder *b, uint64_t block, bool with_normals, open_block *open) {
    uint32_t place[3];
    block_place(b->grid, block, place);
    if (b->fine)
        gather_finer(b, place, open);
    else
        gather_values(b, place, with_normals, open);
}

static void count_row(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const builder *b = data;
    open_block open;
    for (uint64_t block = (uint64_t)index * b->grid[0]; block < ((uint64_t)index + 1) * b->grid[0]; block++) {
        uint32_t place[3];
        block_place(b->grid, block, place);
        b->skipped[block] = !b->fine && is_empty(b, place);
        open.count = 0;
        if (!b->skipped[block]) gather(b, block, false, &open);
        b->counts[block] = (uint16_t)open.count;
    }
}

static int32_t pack_normal(ewa_vec3 n) {
    const double v[3] = {n.x, n.y, n.z};
    uint32_t packed = 0;
    for (int c = 0; c < 3; c++) packed |= ((uint32_t)(int32_t)lrint(511 * v[c]) & 1023) << (10 * c);
    return (int32_t)packed;
}

static void pack(const builder *b, const open_block *open, ewa_voxel_block *block) {
    const ewa_voxel_level *level = b->level;
    memset(block->low, EWA_BLOCK_SIDE - 1, sizeof block->low);
    memset(block->high, 0, sizeof block->high);
    for (uint32_t n = 0; n < open->count; n++) {
        const uint64_t to = block->first + n;
        const ewa_voxel *voxel = &open->voxels[n];
        level->places[to] = open->places[n];
        for (int c = 0; c < 3; c++)
            level->colors[c][to] = (uint16_t)lrint(fmin(voxel->color[c] / b->color_scale, 1) * 65535);
        level->extinctions[to] = (float)fmin(voxel->extinction, 1e18);
        level->normals[to] = pack_normal(voxel->normal_world);
        for (int axis = 0; axis < 3; axis++) {
            const uint8_t at = open->places[n] >> (3 * axis) & 7;
            if (at < block->low[axis]) block->low[axis] = at;
            if (at > block->high[axis]) block->high[axis] = at;
        }
    }
}

static void fill_row(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const builder *b = data;
    open_block open;
    for (uint64_t block = (uint64_t)index * b->grid[0]; block < ((uint64_t)index + 1) * b->grid[0]; block++) {
        if (b->block_of[block] == NO_BLOCK) continue;
        gather(b, block, true, &open);
        pack(b, &open, &b->level->blocks[b->block_of[block]]);
    }
}

ewa_status ewa_voxel_level_allocate(ewa_context *context, ewa_voxel_level *level) {
    const size_t room = level->voxel_count + EWA_STREAM_PADDING;
    level->blocks = ewa_allocate(context, level->block_count, sizeof *level->blocks);
    level->places = ewa_allocate_zeroed(context, room, sizeof *level->places);
    for (int c = 0; c < 3; c++)
        level->colors[c] = ewa_allocate_zeroed(context, room, sizeof *level->colors[c]);
    level->extinctions = ewa_allocate_zeroed(context, room, sizeof *level->extinctions);
    level->normals = ewa_allocate_zeroed(context, room, sizeof *level->normals);
    if (!level->blocks || !level->places || !level->colors[0] || !level->colors[1] || !level->colors[2] ||
        !level->extinctions || !level->normals)
        return EWA_ERROR_MEMORY;
    return EWA_OK;
}

/// Gives every block with voxels its number and its range of voxels.
static ewa_status place_blocks(ewa_context *context, const builder *b, uint64_t grid_count) {
    ewa_voxel_level *level = b->level;
    for (uint64_t block = 0; block < grid_count; block++) {
        b->block_of[block] = b->counts[block] ? (uint32_t)level->block_count++ : NO_BLOCK;
        level->voxel_count += b->counts[block];
    }
    EWA_TRY(ewa_voxel_level_allocate(context, level));
    uint64_t first = 0;
    for (uint64_t block = 0; block < grid_count; block++) {
        if (b->block_of[block] == NO_BLOCK) continue;
        ewa_voxel_block *made = &level->blocks[b->block_of[block]];
        *made = (ewa_voxel_block){.first = first, .count = b->counts[block]};
        block_place(b->grid, block, made->place);
        first += made->count;
    }
    return EWA_OK;
}

/// Builds a level whose dims are set; `*block_of` becomes the caller's, of `*grid_count` numbers.
static ewa_status build(ewa_context *context, builder *b, uint32_t **block_of, uint64_t *grid_count) {
    uint64_t count = 1;
    for (int axis = 0; axis < 3; axis++) {
        b->grid[axis] = (b->level->dims[axis] + EWA_BLOCK_SIDE - 1) / EWA_BLOCK_SIDE;
        count *= b->grid[axis];
    }
    *grid_count = count;
    if (count >= NO_BLOCK)
        return ewa_fail(context, EWA_ERROR_LIMIT, "volume: %llu blocks of 8x8x8 voxels",
                        (unsigned long long)count);
    b->counts = ewa_allocate(context, count, sizeof *b->counts);
    b->skipped = ewa_allocate(context, count, sizeof *b->skipped);
    b->block_of = *block_of = ewa_allocate(context, count, sizeof **block_of);
    ewa_status status = b->counts && b->skipped && b->block_of ? EWA_OK : EWA_ERROR_MEMORY;
    const uint32_t rows = (uint32_t)(count / b->grid[0]);
    if (status == EWA_OK) {
        ewa_parallel(context, count_row, b, rows);
        status = place_blocks(context, b, count);
    }
    if (status == EWA_OK) ewa_parallel(context, fill_row, b, rows);
    ewa_release(context, b->counts, count, sizeof *b->counts);
    if (status != EWA_OK) {
        ewa_release(context, b->skipped, count, sizeof *b->skipped);
        ewa_release(context, *block_of, count, sizeof **block_of);
        b->skipped = NULL;
        *block_of = NULL;
    }
    return status;
}

static double color_scale(const ewa_transfer *transfer) {
    double largest = 1;
    for (uint32_t i = 0; i < transfer->point_count; i++)
        for (int c = 0; c < 3; c++) largest = fmax(largest, (double)transfer->points[i].color[c]);
    return largest;
}

/// The grid of every other voxel's corner: means of two lie half a step further on.
static void halve(const ewa_voxel_level *fine, ewa_voxel_level *coarse) {
    for (int axis = 0; axis < 3; axis++) coarse->dims[axis] = (fine->dims[axis] + 1) / 2;
    const double *m = fine->index_to_world;
    for (int row = 0; row < 3; row++) {
        for (int axis = 0; axis < 3; axis++) coarse->index_to_world[4 * row + axis] = 2 * m[4 * row + axis];
        coarse->index_to_world[4 * row + 3] =
            m[4 * row + 3] + (m[4 * row] + m[4 * row + 1] + m[4 * row + 2]) / 2;
    }
}

static void release_level(ewa_context *context, ewa_voxel_level *level) {
    const size_t room = level->voxel_count + EWA_STREAM_PADDING;
    ewa_release(context, level->blocks, level->block_count, sizeof *level->blocks);
    ewa_release(context, level->places, room, sizeof *level->places);
    for (int c = 0; c < 3; c++) ewa_release(context, level->colors[c], room, sizeof *level->colors[c]);
    ewa_release(context, level->extinctions, room, sizeof *level->extinctions);
    ewa_release(context, level->normals, room, sizeof *level->normals);
}

static ewa_bounds bounds_of(const ewa_voxel_level *level) {
    ewa_bounds bounds = {
        {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, level->voxel_count};
    for (uint64_t b = 0; b < level->block_count; b++) {
        const ewa_voxel_block *block = &level->blocks[b];
        for (uint64_t v = block->first; v < block->first + block->count; v++) {
            const uint32_t at = level->places[v];
            double place[3];
            vec3_store(ewa_volume_place(level->index_to_world, block->place[0] * 8.0 + (at & 7),
                                        block->place[1] * 8.0 + (at >> 3 & 7),
                                        block->place[2] * 8.0 + (at >> 6)),
                       place);
            for (int axis = 0; axis < 3; axis++) {
                bounds.low_world[axis] = fmin(bounds.low_world[axis], place[axis]);
                bounds.high_world[axis] = fmax(bounds.high_world[axis], place[axis]);
            }
        }
    }
    return bounds;
}

static void describe(ewa_voxels *voxels, const ewa_classifier *classifier) {
    ewa_voxels_info *info = &voxels->info;
    const uint32_t *dims = classifier->volume->dims;
    info->voxel_count = (uint64_t)dims[0] * dims[1] * dims[2];
    info->occupied_count = voxels->levels[0].voxel_count;
    info->level_count = voxels->level_count;
    info->spacing_world = classifier->spacing_world;
    info->bounds = bounds_of(&voxels->levels[0]);
    info->resident_bytes = sizeof *voxels;
    for (uint32_t l = 0; l < voxels->level_count; l++) {
        const ewa_voxel_level *level = &voxels->levels[l];
        const size_t voxel_bytes = 4 * sizeof(uint16_t) + sizeof(float) + sizeof(int32_t);
        info->resident_bytes += level->block_count * sizeof *level->blocks +
                                (level->voxel_count + EWA_STREAM_PADDING) * voxel_bytes;
    }
}

static ewa_status build_levels(ewa_context *context, ewa_voxels *voxels, const ewa_classifier *classifier) {
    uint32_t *block_of[EWA_MAX_VOLUME_LEVELS] = {NULL};
    uint64_t grid_count[EWA_MAX_VOLUME_LEVELS] = {0};
    ewa_status status = EWA_OK;
    builder before = {0};
    for (uint32_t l = 0; l < voxels->level_count && status == EWA_OK; l++) {
        ewa_voxel_level *level = &voxels->levels[l];
        builder b = {.classifier = classifier, .color_scale = voxels->color_scale, .level = level};
        if (l > 0) {
            b.fine = level - 1;
            b.fine_block = block_of[l - 1];
            memcpy(b.fine_grid, before.grid, sizeof b.fine_grid);
            halve(b.fine, level);
        }
        status = ewa_progress(context, "voxels", (double)l / voxels->level_count);
        if (status == EWA_OK) status = build(context, &b, &block_of[l], &grid_count[l]);
        if (status == EWA_OK && l == 0) {
            voxels->info.block_count = grid_count[0];
            for (uint64_t i = 0; i < grid_count[0]; i++) voxels->info.skipped_count += b.skipped[i];
        }
        ewa_release(context, b.skipped, grid_count[l], sizeof *b.skipped);
        before = b;
    }
    for (uint32_t l = 0; l < voxels->level_count; l++)
        ewa_release(context, block_of[l], grid_count[l], sizeof **block_of);
    return status;
}

ewa_status ewa_voxels_create(const ewa_volume *volume, const ewa_transfer *transfer,
                             const ewa_voxels_options *options, ewa_voxels **voxels) {
    if (!volume || !volume->context || !transfer || !voxels) return EWA_ERROR_ARGUMENT;
    *voxels = NULL;
    ewa_context *context = volume->context;
    ewa_voxels_options chosen;
    ewa_classifier classifier;
    EWA_TRY(ewa_voxels_options_choose(context, options, &chosen));
    EWA_TRY(ewa_classifier_make(context, volume, transfer, &classifier));
    ewa_voxels *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->serial = ewa_serial_next(context);
    made->level_count = chosen.level_count;
    made->color_scale = color_scale(transfer);
    memcpy(made->levels[0].dims, volume->dims, sizeof made->levels[0].dims);
    memcpy(made->levels[0].index_to_world, volume->index_to_world, sizeof volume->index_to_world);
    ewa_status status = build_levels(context, made, &classifier);
    if (status != EWA_OK) {
        ewa_voxels_destroy(&made);
        return status;
    }
    describe(made, &classifier);
    *voxels = made;
    return EWA_OK;
}

void ewa_voxels_destroy(ewa_voxels **voxels) {
    if (!voxels || !*voxels) return;
    ewa_voxels *old = *voxels;
    for (uint32_t l = 0; l < old->level_count; l++) release_level(old->context, &old->levels[l]);
    ewa_release(old->context, old, 1, sizeof *old);
    *voxels = NULL;
}

void ewa_voxels_describe(const ewa_voxels *voxels, ewa_voxels_info *info) {
    if (voxels && info) *info = voxels->info;
}
