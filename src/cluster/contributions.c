// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Contributions to shared tiles, on the ranks that have splats in them: the passes over these, in a worker's
// own planes. What is kept from surface to surface is which blocks are open, and beyond which depth keys.
#include "cluster/joint.h"
#include "cluster/pack.h"
#include "surface/tile_runs.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_BLOCK_LANES, ROWS = EWA_MAX_TILE_BLOCKS, WAVE_CONTRIBUTIONS = 8 };

/// Marks all blocks of a tile.
static void mark_all(const ewa_tiles *tiles, uint32_t index, uint32_t rows[ROWS]) {
    const ewa_tile_rect rect = ewa_tiles_rect(tiles, index);
    const uint32_t columns = (rect.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    memset(rows, 0, ROWS * sizeof *rows);
    for (uint32_t y = 0; y < rect.height_px; y += EWA_BLOCK_PX)
        rows[y / EWA_BLOCK_PX] = columns < 32 ? (1u << columns) - 1 : UINT32_MAX;
}

/// Lists the open contributions, and lays out the keys that are sent and received.
static ewa_status place_keys(ewa_joint *joint) {
    ewa_joint_tiles *tiles = &joint->tiles;
    joint->active_count = 0;
    size_t blocks = 0;
    for (uint32_t i = 0; i < tiles->contribution_count; i++) {
        joint->contribution_places[i] = blocks;
        if (!tiles->contributions[i].open) continue;
        if (!joint->surface)
            mark_all(&joint->job.tiles, tiles->contributions[i].tile, joint->contribution_rows[i]);
        joint->active[joint->active_count++] = i;
        blocks += ewa_joint_count_blocks(joint->contribution_rows[i]);
    }
    joint->contribution_places[tiles->contribution_count] = blocks;
    ewa_status status = ewa_buffer_reserve(joint->context, &joint->given_keys, blocks, LANES * sizeof(float));
    blocks = 0;
    ewa_joint_kept *kept = joint->kept.data;
    for (uint32_t m = 0; m < tiles->reduction_count && !joint->surface; m++)
        mark_all(&joint->job.tiles, tiles->reductions[m].tile, kept[m].open_rows);
    for (uint32_t p = 0; p < tiles->incoming_count; p++) {
        const uint32_t m = tiles->incoming[p].reduction;
        joint->incoming_places[p] = blocks;
        if (tiles->reductions[m].open && tiles->incoming[p].rank != joint->exchange.rank)
            blocks += ewa_joint_count_blocks(kept[m].open_rows);
    }
    joint->incoming_places[tiles->incoming_count] = blocks;
    if (status == EWA_OK)
        status = ewa_buffer_reserve(joint->context, &joint->taken_keys, blocks, LANES * sizeof(float));
    return status;
}

/// Copies the marked blocks of a plane to keys that lie after each other, or back.
static void copy_keys(const uint32_t rows[ROWS], const ewa_tile *tile, float *plane, float *keys, bool back) {
    for (uint32_t row = 0; row < tile->block_rows; row++)
        for (uint32_t marked = rows[row]; marked; marked &= marked - 1, keys += LANES) {
            const uint32_t column = (uint32_t)__builtin_ctz(marked);
            float *at = plane + ((size_t)row * tile->blocks_per_row + column) * LANES;
            memcpy(back ? at : keys, back ? keys : at, LANES * sizeof *at);
        }
}

/// The tile cache of a contribution; NULL: none.
static ewa_joint_tile_cache *tile_cache_of(const ewa_joint *joint, uint32_t contribution) {
    return contribution < joint->tile_cache_count
               ? (ewa_joint_tile_cache *)joint->tile_caches.data + contribution
               : NULL;
}

/// Makes a tile ready for a pass, in the contribution's tile cache or in the worker's own planes; returns
/// which.
static ewa_tile_scratch *place_contribution(ewa_joint *joint, uint32_t contribution, uint32_t worker,
                                            ewa_tile *tile) {
    ewa_joint_tile_cache *cache = tile_cache_of(joint, contribution);
    ewa_tile_scratch *s = cache ? &cache->scratch : &joint->scratch[worker];
    ewa_tile_planes_bind(&joint->job, s, s->plane_buffer.data);
    ewa_tile_place(&joint->job, s, joint->tiles.contributions[contribution].tile, tile);
    tile->pixels = NULL; // small splats have no sums of their own
    tile->sums.careful = true;
    if (!joint->surface) return s;
    const size_t lanes = (size_t)tile->blocks_per_row * tile->block_rows * LANES;
    memcpy(s->edges.rows, joint->contribution_rows[contribution],
           sizeof joint->contribution_rows[contribution]);
    memcpy(s->edges.passed, (const float *)joint->passed.data + contribution * joint->pixel_lanes,
           lanes * sizeof(float));
    for (size_t i = 0; i < lanes; i++) s->edges.nearest[i] = -INFINITY;
    if (cache && cache->kept && !cache->behind) ewa_tile_keep_behind(&joint->job, tile, s, &cache->lists);
    if (cache) cache->behind = true;
    return s;
}

/// One pass beyond what has passed.
static void draw_behind(const ewa_joint *joint, uint32_t contribution, const ewa_tile *tile,
                        ewa_tile_scratch *s, ewa_tile_pass what) {
    ewa_joint_tile_cache *cache = tile_cache_of(joint, contribution);
    ewa_edge_lists none = {.whole = false};
    ewa_tile_draw_behind(&joint->job, tile, s, joint->tiles.contributions[contribution].tile,
                         cache && cache->kept ? &cache->lists : &none, what);
}

/// Finds the nearest of this rank's splats; an ewa_task.
static void find_keys(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const uint32_t contribution = joint->active[number];
    ewa_joint_tile_cache *cache = tile_cache_of(joint, contribution);
    ewa_tile tile;
    ewa_tile_scratch *s = place_contribution(joint, contribution, worker, &tile);
    if (joint->surface) {
        draw_behind(joint, contribution, &tile, s, EWA_PASS_EDGE_VISIBILITY);
    } else {
        joint->job.kernels->clear_nearest(&tile);
        const bool kept =
            ewa_tile_find_nearest(&joint->job, &tile, s, joint->tiles.contributions[contribution].tile);
        if (cache) cache->kept = kept;
    }
    copy_keys(joint->contribution_rows[contribution], &tile, joint->surface ? s->edges.nearest : s->nearest,
              (float *)joint->given_keys.data + joint->contribution_places[contribution] * LANES, false);
}

/// The depth keys of an incoming contribution; those of this rank itself lie where it sends from.
static float *keys_of_incoming(const ewa_joint *joint, uint32_t incoming) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    const uint32_t own = joint->exchange.rank;
    if (tiles->incoming[incoming].rank != own)
        return (float *)joint->taken_keys.data + joint->incoming_places[incoming] * LANES;
    // They are in the order of its own contributions.
    const uint32_t contribution = tiles->contribution_first[own] + (incoming - tiles->own_incoming_first);
    return (float *)joint->given_keys.data + joint->contribution_places[contribution] * LANES;
}

/// Reduces the keys of all incoming contributions to their maximum, and stores it back to each; an ewa_task.
static void take_largest(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const ewa_joint_reduction *reduction = &joint->tiles.reductions[number];
    if (!reduction->open) return;
    ewa_tile tile;
    ewa_joint_kept *kept = ewa_joint_take(joint, number, worker, &tile);
    const size_t lanes = (size_t)ewa_joint_count_blocks(kept->open_rows) * LANES;
    const uint32_t *incoming = joint->tiles.order + reduction->first_incoming;
    const uint32_t incoming_count = reduction[1].first_incoming - reduction->first_incoming;
    float *largest = keys_of_incoming(joint, incoming[0]);
    for (uint32_t p = 1; p < incoming_count; p++) {
        const float *other = keys_of_incoming(joint, incoming[p]);
        for (size_t i = 0; i < lanes; i++) largest[i] = other[i] > largest[i] ? other[i] : largest[i];
    }
    for (uint32_t p = 1; p < incoming_count; p++)
        memcpy(keys_of_incoming(joint, incoming[p]), largest, lanes * sizeof *largest);
    const ewa_tile_scratch *s = &joint->scratch[worker];
    copy_keys(kept->open_rows, &tile, joint->surface ? s->edges.nearest : s->nearest, largest, true);
}

/// Addresses the messages from contributions to reductions, or back.
static void address_keys(ewa_joint *joint, bool back) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    ewa_messages *messages = &joint->messages;
    for (uint32_t r = 0, n = 0; r < joint->exchange.rank_count; r++) {
        const size_t first = joint->contribution_places[tiles->contribution_first[r]],
                     end = joint->contribution_places[tiles->contribution_first[r + 1]],
                     first_incoming = joint->incoming_places[n];
        while (n < tiles->incoming_count && tiles->incoming[n].rank == r) n++;
        const ewa_parcel contributions = {(float *)joint->given_keys.data + first * LANES,
                                          (end - first) * LANES * sizeof(float)};
        const ewa_parcel incoming = {(float *)joint->taken_keys.data + first_incoming * LANES,
                                     (joint->incoming_places[n] - first_incoming) * LANES * sizeof(float)};
        messages->given[r] = back ? incoming : contributions;
        messages->taken[r] = back ? contributions : incoming;
    }
}

ewa_status ewa_joint_find_nearest(ewa_joint *joint) {
    EWA_TRY(place_keys(joint));
    if (joint->whole) return EWA_OK;
    EWA_TRY(ewa_parallel_stoppable(joint->context, "render", find_keys, joint, joint->active_count));
    address_keys(joint, false);
    EWA_TRY(ewa_messages_send(&joint->exchange, &joint->messages));
    ewa_parallel(joint->context, take_largest, joint, joint->tiles.reduction_count);
    address_keys(joint, true);
    return ewa_messages_send(&joint->exchange, &joint->messages);
}

/// Sums this rank's splats that reach the nearest of all, and packs the sums; an ewa_task.
static void gather_sums(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const uint32_t contribution = joint->active[joint->wave_first + number];
    const ewa_joint_tile_cache *cache = tile_cache_of(joint, contribution);
    ewa_tile tile;
    ewa_tile_scratch *s = place_contribution(joint, contribution, worker, &tile);
    float *nearest = joint->surface ? s->edges.nearest : s->nearest;
    const uint32_t blocks = tile.blocks_per_row * tile.block_rows;
    if (joint->whole)
        joint->job.kernels->edge_take_all(&tile, &s->edges);
    else
        copy_keys(joint->contribution_rows[contribution], &tile, nearest,
                  (float *)joint->given_keys.data + joint->contribution_places[contribution] * LANES, true);
    ewa_tile gathered = tile;
    if (joint->surface) gathered.sums = s->edges.sums, gathered.side = s->edges.side;
    joint->job.kernels->clear_sums(&gathered);
    memset(s->visits, 0, sizeof s->visits);
    memset(s->high_rows, 0, sizeof s->high_rows);
    if (joint->surface) {
        ewa_tile_close_pixels(nearest, blocks, -INFINITY, INFINITY);
        draw_behind(joint, contribution, &tile, s, EWA_PASS_EDGE_ACCUMULATE);
    } else {
        ewa_tile_sum_nearest(&joint->job, &tile, s, joint->tiles.contributions[contribution].tile,
                             cache && cache->kept);
    }
    ewa_joint_set sets[EWA_JOINT_SETS];
    const uint32_t set_count = ewa_joint_sets(&joint->job, s, joint->surface, sets);
    ewa_joint_pack(sets, set_count, &tile, (char *)joint->wave.data + number * joint->wave_bytes);
}

/// Sums and packs all open contributions, some at a time, after each other in joint->packed; sets what each
/// rank is given.
static ewa_status pack_contributions(ewa_joint *joint) {
    ewa_context *context = joint->context;
    const uint32_t maximum = WAVE_CONTRIBUTIONS * joint->worker_count;
    joint->wave_bytes = ewa_joint_packed_bytes(&joint->job);
    ewa_status status = ewa_buffer_reserve(context, &joint->wave, maximum, joint->wave_bytes);
    size_t bytes = 0;
    for (uint32_t r = 0; r < joint->exchange.rank_count; r++)
        joint->messages.given[r] = (ewa_parcel){NULL, 0};
    for (uint32_t first = 0; first < joint->active_count && status == EWA_OK; first += maximum) {
        const uint32_t left = joint->active_count - first, count = left < maximum ? left : maximum;
        joint->wave_first = first;
        status = ewa_parallel_stoppable(context, "render", gather_sums, joint, count);
        for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
            const char *made = (const char *)joint->wave.data + i * joint->wave_bytes;
            uint32_t size_bytes;
            memcpy(&size_bytes, made, sizeof size_bytes);
            status = ewa_buffer_grow(context, &joint->packed, bytes, bytes + size_bytes, 1);
            if (status != EWA_OK) break;
            memcpy((char *)joint->packed.data + bytes, made, size_bytes);
            bytes += size_bytes;
            joint->messages.given[joint->tiles.contributions[joint->active[first + i]].owner].size_bytes +=
                size_bytes;
        }
    }
    char *at = joint->packed.data;
    for (uint32_t r = 0; r < joint->exchange.rank_count && bytes; r++) {
        joint->messages.given[r].data = at;
        at += joint->messages.given[r].size_bytes;
    }
    return status;
}

ewa_status ewa_joint_gather(ewa_joint *joint) {
    ewa_context *context = joint->context;
    const ewa_joint_tiles *tiles = &joint->tiles;
    EWA_TRY(pack_contributions(joint));
    EWA_TRY(ewa_messages_send_any(context, &joint->exchange, &joint->messages));
    joint->messages.taken[joint->exchange.rank] = joint->messages.given[joint->exchange.rank];
    for (uint32_t p = 0; p < tiles->incoming_count; p++) {
        ewa_parcel *from = &joint->messages.taken[tiles->incoming[p].rank];
        if (!tiles->reductions[tiles->incoming[p].reduction].open) continue;
        uint32_t size_bytes = 0;
        if (from->size_bytes >= sizeof size_bytes) memcpy(&size_bytes, from->data, sizeof size_bytes);
        if (size_bytes < sizeof size_bytes || size_bytes > from->size_bytes)
            return ewa_fail(context, EWA_ERROR_FORMAT, "render: of a contribution of %u bytes rank %u has sent %zu", size_bytes,
                            tiles->incoming[p].rank, from->size_bytes);
        joint->incoming_sums[p] = from->data;
        *from = (ewa_parcel){(char *)from->data + size_bytes, from->size_bytes - size_bytes};
    }
    return EWA_OK;
}
