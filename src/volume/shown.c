// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Parts of the resident forms, by places: of splats a bit for each, beside what is shared; of voxels copies, since blocks are
// drawn by how many they have.
#include "volume/shown.h"
#include "base/base.h"
#include "volume/classify.h"
#include "volume/splats.h"
#include "volume/voxels.h"

#include <string.h>

enum { LANES = EWA_SPLAT_LANES, PACKETS_PER_TASK = 256, BLOCKS_PER_TASK = 64 };

static void splat_place(const ewa_splats *splats, size_t packet, uint32_t lane, double place_world[3]) {
    for (int c = 0; c < 3; c++)
        place_world[c] = splats->origin_world[c] + splats->unit_world * (double)splats->packets[packet][EWA_SPLAT_PLACE + c][lane];
}

static int32_t splat_code(const ewa_splats *splats, size_t packet, uint32_t lane) {
    return splats->classes ? splats->classes[packet][lane] : -1;
}

typedef struct splats_job {
    const ewa_splats *splats;
    ewa_place_shown *test;
    const void *user;
    uint16_t *lanes;
    size_t count;
} splats_job;

static void show_packets(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const splats_job *job = data;
    const size_t first = (size_t)index * PACKETS_PER_TASK;
    for (size_t p = first; p < first + PACKETS_PER_TASK && p < job->count; p++)
        for (uint32_t lane = 0; lane < LANES; lane++) {
            double place[3];
            splat_place(job->splats, p, lane, place);
            if (job->test(job->user, place, splat_code(job->splats, p, lane))) job->lanes[p] |= (uint16_t)(1u << lane);
        }
}

ewa_status ewa_splats_show(ewa_context *context, const ewa_splats *splats, ewa_place_shown *test, const void *user,
                           ewa_splats **view) {
    *view = NULL;
    const size_t count = ewa_splats_all_packets(splats);
    ewa_splats *made = ewa_allocate(context, 1, sizeof *made);
    uint16_t *lanes = ewa_allocate_zeroed(context, count, sizeof *lanes);
    if (!made || !lanes) {
        ewa_release(context, made, 1, sizeof *made);
        ewa_release(context, lanes, count, sizeof *lanes);
        return EWA_ERROR_MEMORY;
    }
    splats_job job = {splats, test, user, lanes, count};
    ewa_parallel(context, show_packets, &job, (uint32_t)((count + PACKETS_PER_TASK - 1) / PACKETS_PER_TASK));
    *made = *splats;
    made->context = context;
    made->shown_lanes = lanes;
    made->lanes_serial = ewa_serial_next(context);
    *view = made;
    return EWA_OK;
}

void ewa_splats_visit(const ewa_splats *splats, ewa_place_visit *visit, void *user) {
    for (uint32_t i = 0; i < splats->info.splat_count; i++) {
        if (splats->shown_lanes && !(splats->shown_lanes[i / LANES] >> i % LANES & 1)) continue;
        double place[3];
        splat_place(splats, i / LANES, i % LANES, place);
        visit(user, place, splat_code(splats, i / LANES, i % LANES));
    }
}

static void voxel_place(const ewa_voxel_level *level, const ewa_voxel_block *block, uint64_t voxel, double place_world[3]) {
    const uint32_t at = level->places[voxel];
    vec3_store(ewa_volume_place(level->index_to_world, block->place[0] * (double)EWA_BLOCK_SIDE + (at & 7),
                                block->place[1] * (double)EWA_BLOCK_SIDE + (at >> 3 & 7),
                                block->place[2] * (double)EWA_BLOCK_SIDE + (at >> 6)),
               place_world);
}

typedef struct voxels_job {
    const ewa_voxel_level *from;
    ewa_voxel_level *to; ///< its blocks have their numbers of voxels, then their first ones
    ewa_place_shown *test;
    const void *user;
    uint8_t *shown; ///< [voxel of `from`]
} voxels_job;

static void show_blocks(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const voxels_job *job = data;
    const uint64_t first = (uint64_t)index * BLOCKS_PER_TASK;
    for (uint64_t b = first; b < first + BLOCKS_PER_TASK && b < job->from->block_count; b++) {
        const ewa_voxel_block *block = &job->from->blocks[b];
        for (uint64_t v = block->first; v < block->first + block->count; v++) {
            double place[3];
            voxel_place(job->from, block, v, place);
            job->shown[v] = job->test(job->user, place, -1);
        }
    }
}

/// Copies the shown voxels of a block, and measures their box.
static void copy_block(const ewa_voxel_level *from, const uint8_t *shown, const ewa_voxel_block *block, ewa_voxel_level *to,
                       ewa_voxel_block *made) {
    *made = *block;
    made->first = to->voxel_count;
    memset(made->low, EWA_BLOCK_SIDE - 1, sizeof made->low);
    memset(made->high, 0, sizeof made->high);
    for (uint64_t v = block->first; v < block->first + block->count; v++) {
        if (!shown[v]) continue;
        const uint64_t at = to->voxel_count++;
        to->places[at] = from->places[v];
        for (int c = 0; c < 3; c++) to->colors[c][at] = from->colors[c][v];
        to->extinctions[at] = from->extinctions[v];
        to->normals[at] = from->normals[v];
        for (int axis = 0; axis < 3; axis++) {
            const uint8_t place = from->places[v] >> (3 * axis) & 7;
            if (place < made->low[axis]) made->low[axis] = place;
            if (place > made->high[axis]) made->high[axis] = place;
        }
    }
    made->count = (uint16_t)(to->voxel_count - made->first);
}

/// Makes a level of the shown voxels; blocks without any are left out.
static ewa_status show_level(ewa_context *context, const ewa_voxel_level *from, ewa_place_shown *test, const void *user,
                             ewa_voxel_level *to) {
    uint8_t *shown = ewa_allocate(context, from->voxel_count, 1);
    if (!shown) return EWA_ERROR_MEMORY;
    voxels_job job = {from, to, test, user, shown};
    ewa_parallel(context, show_blocks, &job, (uint32_t)((from->block_count + BLOCKS_PER_TASK - 1) / BLOCKS_PER_TASK));
    memcpy(to->index_to_world, from->index_to_world, sizeof to->index_to_world);
    memcpy(to->dims, from->dims, sizeof to->dims);
    for (uint64_t b = 0; b < from->block_count; b++) {
        const uint64_t before = to->voxel_count;
        for (uint64_t v = from->blocks[b].first; v < from->blocks[b].first + from->blocks[b].count; v++) to->voxel_count += shown[v];
        to->block_count += to->voxel_count > before;
    }
    const ewa_status status = ewa_voxel_level_allocate(context, to);
    if (status == EWA_OK) {
        const uint64_t block_count = to->block_count;
        to->voxel_count = 0;
        for (uint64_t b = 0, made = 0; b < from->block_count && made < block_count; b++) {
            copy_block(from, shown, &from->blocks[b], to, &to->blocks[made]);
            made += to->blocks[made].count > 0;
        }
    }
    ewa_release(context, shown, from->voxel_count, 1);
    return status;
}

ewa_status ewa_voxels_show(ewa_context *context, const ewa_voxels *voxels, ewa_place_shown *test, const void *user,
                           ewa_voxels **part) {
    *part = NULL;
    ewa_voxels *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    made->serial = ewa_serial_next(context);
    made->level_count = voxels->level_count;
    made->color_scale = voxels->color_scale;
    made->info = voxels->info;
    ewa_status status = EWA_OK;
    for (uint32_t l = 0; l < made->level_count && status == EWA_OK; l++)
        status = show_level(context, &voxels->levels[l], test, user, &made->levels[l]);
    made->info.occupied_count = made->levels[0].voxel_count;
    *part = made;
    if (status != EWA_OK) ewa_voxels_destroy(part);
    return status;
}

void ewa_voxels_visit(const ewa_voxels *voxels, ewa_place_visit *visit, void *user) {
    const ewa_voxel_level *level = &voxels->levels[0];
    for (uint64_t b = 0; b < level->block_count; b++)
        for (uint64_t v = level->blocks[b].first; v < level->blocks[b].first + level->blocks[b].count; v++) {
            double place[3];
            voxel_place(level, &level->blocks[b], v, place);
            visit(user, place, -1);
        }
}
