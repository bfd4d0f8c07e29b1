// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shared tiles at their owner, which reduces the sums of all ranks: surfaces, what is open behind them,
// pixels. Each reduction has planes of its own, which stay from surface to surface.
#include "cluster/joint.h"
#include "cluster/pack.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_BLOCK_LANES, ROWS = EWA_MAX_TILE_BLOCKS };

ewa_joint_kept *ewa_joint_take(ewa_joint *joint, uint32_t reduction, uint32_t worker, ewa_tile *tile) {
    ewa_tile_scratch *s = &joint->scratch[worker];
    ewa_joint_kept *kept = (ewa_joint_kept *)joint->kept.data + reduction;
    ewa_tile_planes_bind(&joint->job, s, (float *)joint->planes.data + reduction * joint->tile_floats);
    memcpy(s->edges.rows, kept->open_rows, sizeof kept->open_rows);
    memcpy(s->back_facing_rows, kept->back_facing_rows, sizeof kept->back_facing_rows);
    memcpy(s->cut_rows, kept->cut_rows, sizeof kept->cut_rows);
    memcpy(s->finalized_rows, kept->finalized_rows, sizeof kept->finalized_rows);
    ewa_tile_place(&joint->job, s, joint->tiles.reductions[reduction].tile, tile);
    tile->pixels = NULL;
    tile->sums.careful = true;
    return kept;
}

static void leave(const ewa_tile_scratch *s, ewa_joint_kept *kept) {
    memcpy(kept->open_rows, s->edges.rows, sizeof kept->open_rows);
    memcpy(kept->back_facing_rows, s->back_facing_rows, sizeof kept->back_facing_rows);
    memcpy(kept->cut_rows, s->cut_rows, sizeof kept->cut_rows);
    memcpy(kept->finalized_rows, s->finalized_rows, sizeof kept->finalized_rows);
}

/// Closes the blocks of a tile that are not marked.
static void close_unmarked(const ewa_tile *tile, ewa_tile_scratch *s) {
    for (uint32_t block = 0; block < tile->blocks_per_row * tile->block_rows; block++) {
        if (s->edges.rows[block / tile->blocks_per_row] >> block % tile->blocks_per_row & 1) continue;
        for (int i = 0; i < LANES; i++) s->edges.passed[(size_t)block * LANES + (size_t)i] = -INFINITY;
        for (int i = 0; i < LANES; i++) s->edges.nearest[(size_t)block * LANES + (size_t)i] = -INFINITY;
    }
}

/// Adds up the sums of all contributions to a reduction in its planes.
static void put_sums(ewa_joint *joint, const ewa_joint_reduction *reduction, uint32_t worker,
                     const ewa_tile *tile) {
    ewa_tile_scratch *s = &joint->scratch[worker];
    const size_t numbers = ewa_joint_total_numbers(&joint->job);
    int64_t *totals = (int64_t *)joint->totals.data + worker * numbers;
    if (!joint->surface) joint->job.kernels->clear_sums(tile);
    memset(s->visits, 0, sizeof s->visits);
    memset(s->high_rows, 0, sizeof s->high_rows);
    memset(totals, 0, numbers * sizeof *totals);
    ewa_joint_set sets[EWA_JOINT_SETS];
    const uint32_t set_count = ewa_joint_sets(&joint->job, s, joint->surface, sets);
    for (uint32_t p = reduction->first_incoming; p < reduction[1].first_incoming; p++)
        ewa_joint_add(sets, set_count, tile, joint->incoming_sums[joint->tiles.order[p]], totals);
    ewa_joint_put(sets, set_count, tile, totals);
}

/// Makes the surface of what all ranks have gathered; an ewa_task.
static void make_surface(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    ewa_joint_reduction *reduction = &joint->tiles.reductions[number];
    if (!reduction->open) return;
    const ewa_tile_job *job = &joint->job;
    ewa_tile_scratch *s = &joint->scratch[worker];
    ewa_tile tile;
    ewa_joint_kept *kept = ewa_joint_take(joint, number, worker, &tile);
    if (joint->whole) job->kernels->edge_take_all(&tile, &s->edges);
    put_sums(joint, reduction, worker, &tile);
    uint32_t marked = 0;
    if (joint->surface == 0) {
        job->kernels->finalize(&tile, &job->resolve);
        if (job->layers > 1) {
            memset(s->edges.rows, 0, sizeof s->edge_rows_left);
            memset(s->edges.rows, 0xff, tile.block_rows * sizeof *s->edges.rows);
            marked = job->kernels->find_edges(&tile, &job->resolve, &s->edges);
        }
        kept->layered = marked > 0;
        memcpy(kept->edge_rows, s->edges.rows, sizeof kept->edge_rows);
    } else {
        marked = job->kernels->edge_compose(&tile, &job->resolve, &s->edges, joint->whole);
    }
    if (marked) close_unmarked(&tile, s);
    reduction->open = marked > 0;
    leave(s, kept);
}

/// What contributors are sent after a surface: whether the tile is open, in which blocks, and beyond which
/// depth keys in these.
typedef struct tile_update {
    uint32_t open, rows[ROWS];
} tile_update;

/// Where the passed keys of a reduction are.
static const float *passed_of(ewa_joint *joint, uint32_t reduction, ewa_tile *tile) {
    ewa_joint_take(joint, reduction, 0, tile);
    return joint->scratch[0].edges.passed;
}

/// Packs for each rank the updates of its contributions that were open, as `was_open` says of the reductions.
static ewa_status write_updates(ewa_joint *joint, const bool *was_open) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    const ewa_joint_kept *kept = joint->kept.data;
    size_t bytes = 0;
    for (uint32_t r = 0; r < joint->exchange.rank_count; r++)
        joint->messages.given[r] = (ewa_parcel){NULL, 0};
    for (uint32_t p = 0; p < tiles->incoming_count; p++) {
        const uint32_t m = tiles->incoming[p].reduction;
        if (!was_open[m]) continue;
        const bool open = tiles->reductions[m].open;
        const size_t more = sizeof(tile_update) +
                            (open ? ewa_joint_count_blocks(kept[m].open_rows) * LANES * sizeof(float) : 0);
        EWA_TRY(ewa_buffer_grow(joint->context, &joint->packed, bytes, bytes + more, 1));
        char *at = (char *)joint->packed.data + bytes;
        tile_update update = {.open = open};
        if (open) memcpy(update.rows, kept[m].open_rows, sizeof update.rows);
        memcpy(at, &update, sizeof update);
        at += sizeof update;
        ewa_tile tile;
        const float *passed = open ? passed_of(joint, m, &tile) : NULL;
        for (uint32_t row = 0; row < ROWS; row++)
            for (uint32_t left = update.rows[row]; left; left &= left - 1, at += LANES * sizeof *passed)
                memcpy(at,
                       passed + ((size_t)row * tile.blocks_per_row + (uint32_t)__builtin_ctz(left)) * LANES,
                       LANES * sizeof *passed);
        bytes += more;
        joint->messages.given[tiles->incoming[p].rank].size_bytes += more;
    }
    char *at = joint->packed.data;
    for (uint32_t r = 0; r < joint->exchange.rank_count && bytes; r++) {
        joint->messages.given[r].data = at;
        at += joint->messages.given[r].size_bytes;
    }
    return EWA_OK;
}

/// Reads the updates of the contributions that were open.
static ewa_status read_updates(ewa_joint *joint) {
    const ewa_tiles *all = &joint->job.tiles;
    for (uint32_t i = 0; i < joint->active_count; i++) {
        const uint32_t number = joint->active[i];
        ewa_joint_contribution *contribution = &joint->tiles.contributions[number];
        ewa_parcel *from = &joint->messages.taken[contribution->owner];
        tile_update update;
        if (from->size_bytes < sizeof update)
            return ewa_fail(joint->context, EWA_ERROR_FORMAT, "render: rank %u says too little",
                            contribution->owner);
        memcpy(&update, from->data, sizeof update);
        const size_t keys = update.open ? ewa_joint_count_blocks(update.rows) * LANES * sizeof(float) : 0;
        const ewa_tile_rect rect = ewa_tiles_rect(all, contribution->tile);
        const uint32_t columns = (rect.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
        if (from->size_bytes - sizeof update < keys)
            return ewa_fail(joint->context, EWA_ERROR_FORMAT, "render: rank %u says too little",
                            contribution->owner);
        contribution->open = update.open;
        memcpy(joint->contribution_rows[number], update.rows, sizeof update.rows);
        const char *at = (const char *)from->data + sizeof update;
        float *passed = (float *)joint->passed.data + number * joint->pixel_lanes;
        for (size_t k = 0; k < joint->pixel_lanes && update.open; k++) passed[k] = -INFINITY;
        for (uint32_t row = 0; row < ROWS && update.open; row++)
            for (uint32_t left = update.rows[row]; left; left &= left - 1, at += LANES * sizeof *passed)
                memcpy(passed + ((size_t)row * columns + (uint32_t)__builtin_ctz(left)) * LANES, at,
                       LANES * sizeof *passed);
        *from =
            (ewa_parcel){(char *)from->data + sizeof update + keys, from->size_bytes - sizeof update - keys};
    }
    return EWA_OK;
}

ewa_status ewa_joint_finalize(ewa_joint *joint) {
    const uint32_t count = joint->tiles.reduction_count;
    bool *was_open = ewa_allocate(joint->context, count, sizeof *was_open);
    if (!was_open) return EWA_ERROR_MEMORY;
    for (uint32_t m = 0; m < count; m++) was_open[m] = joint->tiles.reductions[m].open;
    ewa_status status = ewa_parallel_stoppable(joint->context, "render", make_surface, joint, count);
    if (status == EWA_OK && joint->job.layers > 1) {
        status = write_updates(joint, was_open);
        if (status == EWA_OK)
            status = ewa_messages_send_any(joint->context, &joint->exchange, &joint->messages);
        joint->messages.taken[joint->exchange.rank] = joint->messages.given[joint->exchange.rank];
        if (status == EWA_OK) status = read_updates(joint);
    }
    ewa_release(joint->context, was_open, count, sizeof *was_open);
    return status;
}

/// Writes the pixels of a reduction; an ewa_task.
static void write_pixels(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    ewa_tile_scratch *s = &joint->scratch[worker];
    ewa_tile tile;
    const ewa_joint_kept *kept = ewa_joint_take(joint, number, worker, &tile);
    s->broken_pixel_count += joint->job.kernels->resolve(&tile, &joint->job.resolve,
                                                         kept->layered ? &s->edges : NULL, kept->edge_rows);
}

ewa_status ewa_joint_resolve(ewa_joint *joint) {
    return ewa_parallel_stoppable(joint->context, "render", write_pixels, joint,
                                  joint->tiles.reduction_count);
}

/// Draws a tile that is this rank's alone; an ewa_task.
static void draw_alone(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    ewa_tile_scratch *s = &joint->scratch[worker];
    ewa_tile_planes_bind(&joint->job, s, s->plane_buffer.data);
    ewa_tile_draw(&joint->job, joint->tiles.alone[number], worker);
}

ewa_status ewa_joint_draw_alone(ewa_joint *joint) {
    return ewa_parallel_stoppable(joint->context, "render", draw_alone, joint, joint->tiles.alone_count);
}
