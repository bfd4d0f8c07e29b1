// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the search, written once. One lane is one place that searches; lanes never mix, so every
// machine gives the same bytes. No section of docs/math.md is about it.
#include "cloud/neighbours_tree.h"
#include "wide/wide.h"

#include <math.h>

enum {
    ROWS = 4, // distances of so many candidates at a time keep the adders busy
    TOP = 4,  // distances that are told apart one by one
};

static wi wi_of_lanes(void) {
    static const uint16_t lanes[EWA_BLOCK_LANES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return wi_load_u16(lanes);
}

static wf gap2(wf low, wf high, wf at) {
    const wf outside = wf_max(wf_max(wf_sub(low, at), wf_sub(at, high)), wf_set(0));
    return wf_mul(outside, outside);
}

static uint32_t overlap(const tree_group *restrict group, const tree_query *restrict query) {
    double distance2[TREE_ARITY];
    for (int i = 0; i < TREE_ARITY; i++) {
        double sum = 0;
        for (int c = 0; c < 3; c++) {
            const double below = group->low[c][i] - query->high[c], above = query->low[c] - group->high[c][i];
            const double larger = below > above ? below : above, gap = larger > 0 ? larger : 0;
            sum += gap * gap;
        }
        distance2[i] = sum;
    }
    uint32_t near = 0;
    for (int i = 0; i < TREE_ARITY; i++) near |= (uint32_t)(distance2[i] <= query->radius2) << i;
    return near;
}

static void gather(const ewa_neighbours *tree, const tree_query *query, uint32_t first, uint32_t count,
                   const float shift[3], ewa_block *block) {
    wf at[3], distance2 = wf_set(0);
    for (int c = 0; c < 3; c++) {
        at[c] = wf_add(wf_mul(wf_load(&tree->offset[c][first]), wf_set(query->per_unit)), wf_set(shift[c]));
        distance2 = wf_add(distance2, gap2(wf_set(query->local_low[c]), wf_set(query->local_high[c]), at[c]));
    }
    const uint32_t valid = (1u << count) - 1;
    const uint32_t bits = wm_bits(wf_le(distance2, wf_set(query->local_radius2))) & valid;
    const wm near = wm_of_bits(bits);
    const uint32_t n = block->candidate_count;
    wf_pack(&block->x[n], near, at[0]);
    wf_pack(&block->y[n], near, at[1]);
    wf_pack(&block->z[n], near, at[2]);
    // Place numbers up to 2^32 - 2 are the same bits when signed.
    wi_pack((int32_t *)&block->place[n], near, wi_add(wi_set((int32_t)first), wi_of_lanes()));
    block->candidate_count = n + (uint32_t)__builtin_popcount(bits);
}

static wf count_if(wf count, wm condition) { return wf_add(count, wf_keep(condition, wf_set(1))); }

/// Rows of distances after the last candidate that no limit reaches, so that loops may take them by fours.
static void pad(ewa_block *block) {
    for (uint32_t i = block->candidate_count; i % ROWS; i++) wf_store(block->distance2[i], wf_set(INFINITY));
}

static void measure(ewa_block *block, float limit2, float within[EWA_BLOCK_LANES]) {
    const wf at_x = wf_load(block->lane_x), at_y = wf_load(block->lane_y), at_z = wf_load(block->lane_z);
    const wf limit = wf_set(limit2);
    wf inside[2] = {wf_set(0), wf_set(0)};
    // One more candidate, far away, makes their number even.
    const uint32_t n = block->candidate_count;
    block->x[n] = block->y[n] = block->z[n] = INFINITY;
    for (uint32_t i = 0; i < n; i += 2) {
        for (uint32_t k = 0; k < 2; k++) {
            const wf dx = wf_sub(wf_set(block->x[i + k]), at_x), dy = wf_sub(wf_set(block->y[i + k]), at_y);
            const wf dz = wf_sub(wf_set(block->z[i + k]), at_z);
            const wf distance2 = wf_add(wf_add(wf_mul(dx, dx), wf_mul(dy, dy)), wf_mul(dz, dz));
            inside[k] = count_if(inside[k], wf_le(distance2, limit));
            wf_store(block->distance2[i + k], distance2);
        }
    }
    wf_store(within, wf_add(inside[0], inside[1]));
    pad(block);
}
_Static_assert(EWA_BLOCK_CANDIDATES % ROWS == 0, "the last rows are padding too");

static wf count_within(const ewa_block *block, wf limit2) {
    wf inside[ROWS] = {wf_set(0), wf_set(0), wf_set(0), wf_set(0)};
    for (uint32_t i = 0; i < block->candidate_count; i += ROWS)
        for (uint32_t k = 0; k < ROWS; k++)
            inside[k] = count_if(inside[k], wf_le(wf_load(block->distance2[i + k]), limit2));
    return wf_add(wf_add(inside[0], inside[1]), wf_add(inside[2], inside[3]));
}

/// Drops the candidates that are in no lane's neighbourhood: whoever visits goes through the others several
/// times.
static void drop_others(ewa_block *block, wf radius2) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        const wf distance2 = wf_load(block->distance2[i]);
        wf_store(block->distance2[kept], distance2);
        block->x[kept] = block->x[i];
        block->y[kept] = block->y[i];
        block->z[kept] = block->z[i];
        block->place[kept] = block->place[i];
        kept += wm_bits(wf_le(distance2, radius2)) != 0;
    }
    block->candidate_count = kept;
}

/// Fewer than `rank` candidates are up to low, at least `rank` up to high, in every lane.
typedef struct bracket {
    wf low, high, low_count, high_count;
} bracket;

/// Moves one side of the lanes in `open` to `limit`.
static void narrow(const ewa_block *block, bracket *b, wf rank, wm open, wf limit) {
    const wf count = count_within(block, limit);
    const wm few = wm_and(open, wf_lt(count, rank)), enough = wm_and(open, wf_le(rank, count));
    b->high = wf_select(enough, limit, b->high);
    b->high_count = wf_select(enough, count, b->high_count);
    b->low = wf_select(few, limit, b->low);
    b->low_count = wf_select(few, count, b->low_count);
}

/// The rank-th smallest is among the largest few up to high, of which at most TOP are above it; ties count as
/// often as they are there.
static wf select_top(const ewa_block *block, const bracket *b, wf rank) {
    wf top[TOP];
    for (int t = 0; t < TOP; t++) top[t] = wf_set(-1);
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        const wf distance2 = wf_load(block->distance2[i]);
        wf next = wf_select(wf_le(distance2, b->high), distance2, wf_set(-1));
        for (int t = 0; t < TOP; t++) {
            const wf larger = wf_max(top[t], next);
            next = wf_min(top[t], next);
            top[t] = larger;
        }
    }
    const wf above = wf_sub(b->high_count, rank);
    wf found = top[0];
    for (int t = 1; t < TOP; t++) found = wf_select(wf_le(wf_set((float)t), above), top[t], found);
    return found;
}

/// On a surface the number of neighbours grows linearly with the squared distance, so interpolation finds a
/// limit with `rank` candidates below it, or a few more, in a few steps. Where it does not, bisection between
/// distances that occur does.
static void select_rank(ewa_block *block, float limit2, const float within[EWA_BLOCK_LANES], int32_t wanted) {
    enum { INTERPOLATIONS = 6 };
    const wf rank = wf_set((float)wanted), zero = wf_set(0), half = wf_set(0.5f);
    const wf few_more = wf_set((float)(wanted + TOP - 1)), aim = wf_set((float)wanted + 0.5f * TOP);
    bracket b = {wf_set(-1), wf_set(limit2), zero, wf_load(within)};
    for (int step = 0; step < INTERPOLATIONS; step++) {
        const wm open = wf_lt(few_more, b.high_count);
        if (!wm_bits(open)) break;
        const wf base = wf_max(b.low, zero);
        const wf above = wf_sub(aim, b.low_count);
        const wf between = wf_add(wf_sub(b.high_count, b.low_count), wf_set(1));
        // Keeping away from the ends makes sure of progress where the density is far from even.
        const wf share = wf_min(wf_max(wf_div(above, between), wf_set(0.0625f)), wf_set(0.9375f));
        narrow(block, &b, rank, open, wf_add(base, wf_mul(wf_sub(b.high, base), share)));
    }
    while (wm_bits(wf_lt(few_more, b.high_count))) {
        // The largest distance up to high and the smallest beyond low: equal when only ties are left.
        wf largest[2] = {wf_set(0), wf_set(0)}, smallest[2] = {b.high, b.high};
        for (uint32_t i = 0; i < block->candidate_count; i += ROWS) {
            for (uint32_t k = 0; k < ROWS; k++) {
                const wf distance2 = wf_load(block->distance2[i + k]);
                largest[k % 2] = wf_max(largest[k % 2], wf_keep(wf_le(distance2, b.high), distance2));
                smallest[k % 2] =
                    wf_min(smallest[k % 2], wf_select(wf_lt(b.low, distance2), distance2, b.high));
            }
        }
        const wf last = wf_max(largest[0], largest[1]), next = wf_min(smallest[0], smallest[1]);
        b.high = last;
        const wm open = wm_and(wf_lt(few_more, b.high_count), wf_lt(next, last));
        if (!wm_bits(open)) break;
        const wf middle = wf_add(next, wf_mul(wf_sub(last, next), half));
        narrow(block, &b, rank, open, wf_select(wf_lt(middle, last), middle, next));
    }
    const wf radius2 = select_top(block, &b, rank);
    wf_store(block->radius2, radius2);
    drop_others(block, radius2);
}

const search_kernels EWA_VERSION(ewa_search_kernels) = {overlap, gather, measure, select_rank};
