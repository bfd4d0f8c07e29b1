// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sums of a tile as bytes. A number is what a low word has above its bias and 2^16 times a high one
// (surface/pipeline_sums.h); of most blocks all fit 32 bits, else both words travel.
#include "cluster/pack.h"

#include <string.h>

enum { LANES = EWA_BLOCK_LANES, BIAS_BITS = 0x4b400000, CARRY_SHIFT = 16 };

uint32_t ewa_joint_sets(const ewa_tile_job *job, ewa_tile_scratch *s, uint32_t surface,
                        ewa_joint_set sets[EWA_JOINT_SETS]) {
    const ewa_side_sums *side = surface ? &s->edges.side : &s->side;
    uint32_t count = 0;
    sets[count++] = (ewa_joint_set){surface ? &s->edges.sums : &s->sums, NULL, job->channel_count};
    sets[count++] = (ewa_joint_set){&side->is_back, side->back_facing_rows, job->channel_count};
    if (side->cut_rows) sets[count++] = (ewa_joint_set){&side->cut, side->cut_rows, EWA_CUT_CHANNELS};
    return count;
}

/// Planes of a block, of the units of terms and of what these leave.
static uint32_t plane_count(const ewa_joint_set *set) { return set->channels * (set->of->fine ? 2 : 1); }

/// Numbers of a block's totals: whether there is something, then sums.
static size_t block_numbers(const ewa_joint_set *set) { return 1 + (size_t)plane_count(set) * LANES; }

/// The maximum number of planes of a pixel in all sets.
static size_t max_planes(const ewa_tile_job *job) {
    const size_t words = job->fine_sums || job->with_depth || job->with_clips ? 2 : 1;
    return 2 * words * job->channel_count + (job->with_clips ? words * EWA_CUT_CHANNELS : 0);
}

size_t ewa_joint_packed_bytes(const ewa_tile_job *job) {
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px;
    const size_t head = 1 + (size_t)EWA_JOINT_SETS * 2 * EWA_MAX_TILE_BLOCKS;
    return sizeof(int32_t) * (head + 2 * max_planes(job) * pixels);
}

size_t ewa_joint_total_numbers(const ewa_tile_job *job) {
    const size_t pixels = (size_t)job->tiles.side_px * job->tiles.side_px;
    return EWA_JOINT_SETS * pixels / LANES + max_planes(job) * pixels;
}

/// Where plane `k` of a block is, in low and high words.
static size_t plane_at(const ewa_joint_set *set, uint32_t block, uint32_t k) {
    const size_t at = ((size_t)block * set->channels + k % set->channels) * LANES;
    return at + (k < set->channels ? 0 : set->of->fine);
}

/// Whether a set has something in a block.
static bool has_some(const ewa_joint_set *set, uint32_t row, uint32_t bit, uint32_t block) {
    if (set->rows) return set->rows[row] & bit;
    return set->of->visits[block] || (set->of->high_rows[row] & bit);
}

/// Writes plane `k` of a block as numbers of 32 bits; false where one does not fit.
static bool write_short(const ewa_joint_set *set, uint32_t block, uint32_t k, bool has_high, uint32_t *to) {
    const size_t at = plane_at(set, block, k);
    int32_t low[LANES], high[LANES] = {0};
    memcpy(low, set->of->planes + at, sizeof low);
    if (has_high) memcpy(high, set->of->high + at, sizeof high);
    bool fits = true;
    for (int i = 0; i < LANES; i++) {
        const int64_t number = (int64_t)high[i] * (1 << CARRY_SHIFT) + low[i] - BIAS_BITS;
        fits &= number >= INT32_MIN && number <= INT32_MAX;
        to[i] = (uint32_t)(int32_t)number;
    }
    return fits;
}

/// Writes a block's numbers, as short as they fit; returns where they end, and in `*both` whether words travel.
static uint32_t *write_block(const ewa_joint_set *set, uint32_t block, bool has_high, uint32_t *to,
                             bool *both) {
    const uint32_t planes = plane_count(set);
    *both = false;
    for (uint32_t k = 0; k < planes && !*both; k++)
        *both = !write_short(set, block, k, has_high, to + (size_t)k * LANES);
    if (!*both) return to + (size_t)planes * LANES;
    for (uint32_t k = 0; k < planes; k++, to += LANES)
        memcpy(to, set->of->planes + plane_at(set, block, k), LANES * sizeof *to);
    for (uint32_t k = 0; k < planes; k++, to += LANES)
        memcpy(to, set->of->high + plane_at(set, block, k), LANES * sizeof *to);
    return to;
}

size_t ewa_joint_pack(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile, void *to) {
    uint32_t *const start = to, *next = start + 1;
    const uint32_t columns = tile->blocks_per_row;
    for (uint32_t i = 0; i < set_count; i++) {
        const ewa_joint_set *set = &sets[i];
        uint32_t *some = next, *long_rows = some + tile->block_rows;
        memset(some, 0, 2 * tile->block_rows * sizeof *some);
        next = long_rows + tile->block_rows;
        for (uint32_t block = 0; block < columns * tile->block_rows; block++) {
            const uint32_t row = block / columns, bit = 1u << block % columns;
            if (!has_some(set, row, bit, block)) continue;
            some[row] |= bit;
            bool both;
            next = write_block(set, block, set->of->high_rows[row] & bit, next, &both);
            if (both) long_rows[row] |= bit;
        }
    }
    const size_t bytes = (size_t)(next - start) * sizeof *next;
    *start = (uint32_t)bytes;
    return bytes;
}

void ewa_joint_add(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile, const void *packed,
                   int64_t *totals) {
    const uint32_t *next = (const uint32_t *)packed + 1, columns = tile->blocks_per_row;
    for (uint32_t i = 0; i < set_count; i++) {
        const ewa_joint_set *set = &sets[i];
        const uint32_t *some = next, *long_rows = some + tile->block_rows;
        next = long_rows + tile->block_rows;
        for (uint32_t block = 0; block < columns * tile->block_rows; block++, totals += block_numbers(set)) {
            const uint32_t row = block / columns, bit = 1u << block % columns;
            if (!(some[row] & bit)) continue;
            const size_t count = (size_t)plane_count(set) * LANES;
            int64_t *sums = totals + 1;
            const bool both = long_rows[row] & bit;
            totals[0] = 1;
            for (size_t k = 0; k < count; k++) sums[k] += (int64_t)(int32_t)next[k] - (both ? BIAS_BITS : 0);
            next += count;
            if (!both) continue;
            for (size_t k = 0; k < count; k++) sums[k] += (int64_t)(int32_t)next[k] * (1 << CARRY_SHIFT);
            next += count;
        }
    }
}

/// Writes a plane of totals as low and high words.
static void put_plane(const int64_t *from, float *low, float *high) {
    int32_t bits[LANES], upper[LANES];
    for (int i = 0; i < LANES; i++) {
        const int64_t lower = from[i] & ((1 << CARRY_SHIFT) - 1);
        upper[i] = (int32_t)((from[i] - lower) / (1 << CARRY_SHIFT));
        bits[i] = (int32_t)lower + BIAS_BITS;
    }
    memcpy(low, bits, sizeof bits);
    memcpy(high, upper, sizeof upper);
}

void ewa_joint_put(const ewa_joint_set *sets, uint32_t set_count, const ewa_tile *tile,
                   const int64_t *totals) {
    const uint32_t columns = tile->blocks_per_row;
    for (uint32_t i = 0; i < set_count; i++) {
        const ewa_joint_set *set = &sets[i];
        for (uint32_t block = 0; block < columns * tile->block_rows; block++, totals += block_numbers(set)) {
            const uint32_t row = block / columns, bit = 1u << block % columns;
            if (!totals[0]) continue;
            if (set->rows) set->rows[row] |= bit;
            set->of->high_rows[row] |= bit;
            for (uint32_t k = 0; k < plane_count(set); k++) {
                const size_t at = plane_at(set, block, k);
                put_plane(totals + 1 + (size_t)k * LANES, set->of->planes + at, set->of->high + at);
            }
        }
    }
}
