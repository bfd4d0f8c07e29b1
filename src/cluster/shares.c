// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Shared tiles on the ranks that have splats in them: the passes over these, in a worker's own planes. What goes from
// surface to surface is which blocks are open, and beyond which keys.
#include "cluster/joint.h"
#include "cluster/pack.h"
#include "surface/tile_runs.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_BLOCK_LANES, ROWS = EWA_MAX_TILE_BLOCKS, WAVE_SHARES = 8 };

/// Marks all blocks of a tile.
static void mark_all(const ewa_tiles *tiles, uint32_t index, uint32_t rows[ROWS]) {
    const ewa_tile_rect rect = ewa_tiles_rect(tiles, index);
    const uint32_t columns = (rect.width_px + EWA_BLOCK_PX - 1) / EWA_BLOCK_PX;
    memset(rows, 0, ROWS * sizeof *rows);
    for (uint32_t y = 0; y < rect.height_px; y += EWA_BLOCK_PX)
        rows[y / EWA_BLOCK_PX] = columns < 32 ? (1u << columns) - 1 : UINT32_MAX;
}

/// Lists the shares that are open, and settles where the keys of shares and parts lie.
static ewa_status place_keys(ewa_joint *joint) {
    ewa_joint_tiles *tiles = &joint->tiles;
    joint->active_count = 0;
    size_t blocks = 0;
    for (uint32_t i = 0; i < tiles->share_count; i++) {
        joint->share_places[i] = blocks;
        if (!tiles->shares[i].open) continue;
        if (!joint->surface) mark_all(&joint->job.tiles, tiles->shares[i].tile, joint->share_rows[i]);
        joint->active[joint->active_count++] = i;
        blocks += ewa_joint_count_blocks(joint->share_rows[i]);
    }
    joint->share_places[tiles->share_count] = blocks;
    ewa_status status = ewa_buffer_reserve(joint->context, &joint->given_keys, blocks, LANES * sizeof(float));
    blocks = 0;
    ewa_joint_kept *kept = joint->kept.data;
    for (uint32_t m = 0; m < tiles->meeting_count && !joint->surface; m++)
        mark_all(&joint->job.tiles, tiles->meetings[m].tile, kept[m].open_rows);
    for (uint32_t p = 0; p < tiles->part_count; p++) {
        const uint32_t m = tiles->parts[p].meeting;
        joint->part_places[p] = blocks;
        if (tiles->meetings[m].open && tiles->parts[p].rank != joint->exchange.rank)
            blocks += ewa_joint_count_blocks(kept[m].open_rows);
    }
    joint->part_places[tiles->part_count] = blocks;
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

/// The desk of a share; NULL: none.
static ewa_joint_desk *desk_of(const ewa_joint *joint, uint32_t share) {
    return share < joint->desk_count ? (ewa_joint_desk *)joint->desks.data + share : NULL;
}

/// Makes a tile ready for a pass, at the share's desk or in the worker's own planes; returns whose.
static ewa_tile_scratch *place_share(ewa_joint *joint, uint32_t share, uint32_t worker, ewa_tile *tile) {
    ewa_joint_desk *desk = desk_of(joint, share);
    ewa_tile_scratch *s = desk ? &desk->scratch : &joint->scratch[worker];
    ewa_tile_planes_bind(&joint->job, s, s->plane_buffer.data);
    ewa_tile_place(&joint->job, s, joint->tiles.shares[share].tile, tile);
    tile->pixels = NULL; // small splats have no sums of their own
    tile->sums.careful = true;
    if (!joint->surface) return s;
    const size_t lanes = (size_t)tile->blocks_per_row * tile->block_rows * LANES;
    memcpy(s->edges.rows, joint->share_rows[share], sizeof joint->share_rows[share]);
    memcpy(s->edges.passed, (const float *)joint->passed.data + share * joint->pixel_lanes,
           lanes * sizeof(float));
    for (size_t i = 0; i < lanes; i++) s->edges.nearest[i] = -INFINITY;
    if (desk && desk->kept && !desk->behind) ewa_tile_keep_behind(&joint->job, tile, s, &desk->lists);
    if (desk) desk->behind = true;
    return s;
}

/// One pass beyond what has passed.
static void draw_behind(const ewa_joint *joint, uint32_t share, const ewa_tile *tile, ewa_tile_scratch *s,
                        ewa_tile_pass what) {
    ewa_joint_desk *desk = desk_of(joint, share);
    ewa_edge_lists none = {.whole = false};
    ewa_tile_draw_behind(&joint->job, tile, s, joint->tiles.shares[share].tile,
                         desk && desk->kept ? &desk->lists : &none, what);
}

/// Finds the nearest of this rank's splats; an ewa_task.
static void find_keys(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const uint32_t share = joint->active[number];
    ewa_joint_desk *desk = desk_of(joint, share);
    ewa_tile tile;
    ewa_tile_scratch *s = place_share(joint, share, worker, &tile);
    if (joint->surface) {
        draw_behind(joint, share, &tile, s, EWA_PASS_EDGE_VISIBILITY);
    } else {
        joint->job.kernels->clear_nearest(&tile);
        const bool kept = ewa_tile_find_nearest(&joint->job, &tile, s, joint->tiles.shares[share].tile);
        if (desk) desk->kept = kept;
    }
    copy_keys(joint->share_rows[share], &tile, joint->surface ? s->edges.nearest : s->nearest,
              (float *)joint->given_keys.data + joint->share_places[share] * LANES, false);
}

/// The keys of a part at its meeting, those of this rank where it gives them.
static float *keys_of_part(const ewa_joint *joint, uint32_t part) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    const uint32_t own = joint->exchange.rank;
    if (tiles->parts[part].rank != own)
        return (float *)joint->taken_keys.data + joint->part_places[part] * LANES;
    // Its parts come in the order of its shares.
    const uint32_t share = tiles->share_first[own] + (part - tiles->own_part_first);
    return (float *)joint->given_keys.data + joint->share_places[share] * LANES;
}

/// Gives each part of a meeting the largest keys of all; an ewa_task.
static void take_largest(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const ewa_joint_meeting *meeting = &joint->tiles.meetings[number];
    if (!meeting->open) return;
    ewa_tile tile;
    ewa_joint_kept *kept = ewa_joint_take(joint, number, worker, &tile);
    const size_t lanes = (size_t)ewa_joint_count_blocks(kept->open_rows) * LANES;
    const uint32_t *parts = joint->tiles.order + meeting->first_part;
    const uint32_t part_count = meeting[1].first_part - meeting->first_part;
    float *largest = keys_of_part(joint, parts[0]);
    for (uint32_t p = 1; p < part_count; p++) {
        const float *other = keys_of_part(joint, parts[p]);
        for (size_t i = 0; i < lanes; i++) largest[i] = other[i] > largest[i] ? other[i] : largest[i];
    }
    for (uint32_t p = 1; p < part_count; p++)
        memcpy(keys_of_part(joint, parts[p]), largest, lanes * sizeof *largest);
    const ewa_tile_scratch *s = &joint->scratch[worker];
    copy_keys(kept->open_rows, &tile, joint->surface ? s->edges.nearest : s->nearest, largest, true);
}

/// What goes from shares to meetings, or back.
static void address_keys(ewa_joint *joint, bool back) {
    const ewa_joint_tiles *tiles = &joint->tiles;
    ewa_mail *mail = &joint->mail;
    for (uint32_t r = 0, part = 0; r < joint->exchange.rank_count; r++) {
        const size_t first = joint->share_places[tiles->share_first[r]],
                     end = joint->share_places[tiles->share_first[r + 1]],
                     first_part = joint->part_places[part];
        while (part < tiles->part_count && tiles->parts[part].rank == r) part++;
        const ewa_parcel shares = {(float *)joint->given_keys.data + first * LANES,
                                   (end - first) * LANES * sizeof(float)};
        const ewa_parcel parts = {(float *)joint->taken_keys.data + first_part * LANES,
                                  (joint->part_places[part] - first_part) * LANES * sizeof(float)};
        mail->given[r] = back ? parts : shares;
        mail->taken[r] = back ? shares : parts;
    }
}

ewa_status ewa_joint_find_nearest(ewa_joint *joint) {
    ewa_status status = place_keys(joint);
    if (status != EWA_OK || joint->whole) return status;
    status = ewa_parallel_stoppable(joint->context, "render", find_keys, joint, joint->active_count);
    if (status != EWA_OK) return status;
    address_keys(joint, false);
    status = ewa_mail_send(&joint->exchange, &joint->mail);
    if (status != EWA_OK) return status;
    ewa_parallel(joint->context, take_largest, joint, joint->tiles.meeting_count);
    address_keys(joint, true);
    return ewa_mail_send(&joint->exchange, &joint->mail);
}

/// Sums this rank's splats that reach the nearest of all, and packs the sums; an ewa_task.
static void gather_sums(void *data, uint32_t number, uint32_t worker) {
    ewa_joint *joint = data;
    const uint32_t share = joint->active[joint->wave_first + number];
    const ewa_joint_desk *desk = desk_of(joint, share);
    ewa_tile tile;
    ewa_tile_scratch *s = place_share(joint, share, worker, &tile);
    float *nearest = joint->surface ? s->edges.nearest : s->nearest;
    const uint32_t blocks = tile.blocks_per_row * tile.block_rows;
    if (joint->whole)
        joint->job.kernels->edge_take_all(&tile, &s->edges);
    else
        copy_keys(joint->share_rows[share], &tile, nearest,
                  (float *)joint->given_keys.data + joint->share_places[share] * LANES, true);
    ewa_tile gathered = tile;
    if (joint->surface) gathered.sums = s->edges.sums, gathered.apart = s->edges.apart;
    joint->job.kernels->clear_sums(&gathered);
    memset(s->visits, 0, sizeof s->visits);
    memset(s->high_rows, 0, sizeof s->high_rows);
    if (joint->surface) {
        ewa_tile_close_pixels(nearest, blocks, -INFINITY, INFINITY);
        draw_behind(joint, share, &tile, s, EWA_PASS_EDGE_ACCUMULATE);
    } else {
        ewa_tile_sum_nearest(&joint->job, &tile, s, joint->tiles.shares[share].tile, desk && desk->kept);
    }
    ewa_joint_set sets[EWA_JOINT_SETS];
    const uint32_t set_count = ewa_joint_sets(&joint->job, s, joint->surface, sets);
    ewa_joint_pack(sets, set_count, &tile, (char *)joint->wave.data + number * joint->wave_bytes);
}

/// Sums and packs all open shares, some at a time, after each other in joint->packed; sets what each rank is given.
static ewa_status pack_shares(ewa_joint *joint) {
    ewa_context *context = joint->context;
    const uint32_t most = WAVE_SHARES * joint->worker_count;
    joint->wave_bytes = ewa_joint_packed_bytes(&joint->job);
    ewa_status status = ewa_buffer_reserve(context, &joint->wave, most, joint->wave_bytes);
    size_t bytes = 0;
    for (uint32_t r = 0; r < joint->exchange.rank_count; r++) joint->mail.given[r] = (ewa_parcel){NULL, 0};
    for (uint32_t first = 0; first < joint->active_count && status == EWA_OK; first += most) {
        const uint32_t left = joint->active_count - first, count = left < most ? left : most;
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
            joint->mail.given[joint->tiles.shares[joint->active[first + i]].owner].size_bytes += size_bytes;
        }
    }
    char *at = joint->packed.data;
    for (uint32_t r = 0; r < joint->exchange.rank_count && bytes; r++) {
        joint->mail.given[r].data = at;
        at += joint->mail.given[r].size_bytes;
    }
    return status;
}

ewa_status ewa_joint_gather(ewa_joint *joint) {
    ewa_context *context = joint->context;
    const ewa_joint_tiles *tiles = &joint->tiles;
    ewa_status status = pack_shares(joint);
    if (status == EWA_OK) status = ewa_mail_send_any(context, &joint->exchange, &joint->mail);
    if (status != EWA_OK) return status;
    joint->mail.taken[joint->exchange.rank] = joint->mail.given[joint->exchange.rank];
    for (uint32_t p = 0; p < tiles->part_count; p++) {
        ewa_parcel *from = &joint->mail.taken[tiles->parts[p].rank];
        if (!tiles->meetings[tiles->parts[p].meeting].open) continue;
        uint32_t size_bytes = 0;
        if (from->size_bytes >= sizeof size_bytes) memcpy(&size_bytes, from->data, sizeof size_bytes);
        if (size_bytes < sizeof size_bytes || size_bytes > from->size_bytes)
            return ewa_fail(context, EWA_ERROR_FORMAT, "render: rank %u has sent %zu bytes too few",
                            tiles->parts[p].rank, size_bytes - from->size_bytes);
        joint->part_sums[p] = from->data;
        *from = (ewa_parcel){(char *)from->data + size_bytes, from->size_bytes - size_bytes};
    }
    return EWA_OK;
}
