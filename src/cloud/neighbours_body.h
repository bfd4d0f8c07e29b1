// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the search, written once. A file that includes this defines KERNELS, the name of the
// table, and what math/wide.h asks for. One lane is one place that searches; lanes never mix, so every
// machine gives the same bytes.
#include "cloud/neighbours_tree.h"
#include "math/wide.h"

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
    uint32_t *place = &block->place[n];
    for (uint32_t left = bits; left; left &= left - 1) *place++ = first + (uint32_t)__builtin_ctz(left);
    block->candidate_count = n + (uint32_t)__builtin_popcount(bits);
}

static wf count_if(wf count, wm condition) { return wf_add(count, wf_keep(condition, wf_set(1))); }

static void measure(ewa_block *block, float limit2, float within[EWA_BLOCK_LANES]) {
    const wf at_x = wf_load(block->lane_x), at_y = wf_load(block->lane_y), at_z = wf_load(block->lane_z);
    const wf limit = wf_set(limit2);
    wf inside = wf_set(0);
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        const wf dx = wf_sub(wf_set(block->x[i]), at_x), dy = wf_sub(wf_set(block->y[i]), at_y);
        const wf dz = wf_sub(wf_set(block->z[i]), at_z);
        const wf distance2 = wf_add(wf_add(wf_mul(dx, dx), wf_mul(dy, dy)), wf_mul(dz, dz));
        inside = count_if(inside, wf_le(distance2, limit));
        wf_store(block->distance2[i], distance2);
    }
    wf_store(within, inside);
}

static wf count_within(const ewa_block *block, wf limit2) {
    wf inside = wf_set(0);
    for (uint32_t i = 0; i < block->candidate_count; i++)
        inside = count_if(inside, wf_le(wf_load(block->distance2[i]), limit2));
    return inside;
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

/// On a surface the number of neighbours grows linearly with the squared distance, so interpolation finds a
/// limit with `rank` candidates below it in a few steps. Ties and the last few go by bisection between
/// distances that occur.
static void select_rank(ewa_block *block, float limit2, const float within[EWA_BLOCK_LANES], int32_t wanted) {
    enum { INTERPOLATIONS = 6 };
    const wf rank = wf_set((float)wanted), zero = wf_set(0), half = wf_set(0.5f);
    bracket b = {wf_set(-1), wf_set(limit2), zero, wf_load(within)};
    for (int step = 0; step < INTERPOLATIONS; step++) {
        const wm open = wf_lt(rank, b.high_count);
        if (!wm_bits(open)) break;
        const wf base = wf_max(b.low, zero);
        const wf above = wf_sub(wf_add(rank, half), b.low_count);
        const wf between = wf_add(wf_sub(b.high_count, b.low_count), wf_set(1));
        // Keeping away from the ends makes sure of progress where the density is far from even.
        const wf share = wf_min(wf_max(wf_div(above, between), wf_set(0.0625f)), wf_set(0.9375f));
        narrow(block, &b, rank, open, wf_add(base, wf_mul(wf_sub(b.high, base), share)));
    }
    for (;;) {
        // The largest distance up to high and the smallest beyond low: equal when only ties are left.
        wf last = wf_set(-1), next = b.high;
        for (uint32_t i = 0; i < block->candidate_count; i++) {
            const wf distance2 = wf_load(block->distance2[i]);
            last = wf_select(wf_le(distance2, b.high), wf_max(last, distance2), last);
            next = wf_select(wf_lt(b.low, distance2), wf_min(next, distance2), next);
        }
        b.high = last;
        const wm open = wm_and(wf_lt(rank, b.high_count), wf_lt(next, last));
        if (!wm_bits(open)) break;
        const wf middle = wf_add(next, wf_mul(wf_sub(last, next), half));
        narrow(block, &b, rank, open, wf_select(wf_lt(middle, last), middle, next));
    }
    wf_store(block->radius2, b.high);
}

const search_kernels KERNELS = {overlap, gather, measure, select_rank};
