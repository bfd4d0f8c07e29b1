// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hot loops of the search, written once. A file that includes this defines
//   WIDTH       floats in one vector: 4, 8 or 16
//   KERNELS     name of the table to define
// and is compiled for its instruction set. One lane is one place that searches; lanes never mix and nothing
// is contracted, so every width gives the same bytes.
#include "cloud/neighbours_tree.h"

#include <string.h>

typedef float wide __attribute__((vector_size(4 * WIDTH)));
typedef int32_t wide_int __attribute__((vector_size(4 * WIDTH)));

static inline wide load(const float *from) {
    wide v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline wide_int load_int(const int32_t *from) {
    wide_int v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline wide choose(wide_int mask, wide yes, wide no) {
    return (wide)(((wide_int)yes & mask) | ((wide_int)no & ~mask));
}

static inline bool any(wide_int mask) {
    int32_t sum = 0;
    for (int l = 0; l < WIDTH; l++) sum |= mask[l];
    return sum != 0;
}

static void overlap(const tree_group *group, const tree_query *query, int32_t hit[TREE_ARITY]) {
    double distance2[TREE_ARITY] = {0};
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TREE_ARITY; i++) {
            const double below = group->low[c][i] - query->high[c], above = query->low[c] - group->high[c][i];
            const double larger = below > above ? below : above, gap = larger > 0 ? larger : 0;
            distance2[i] += gap * gap;
        }
    for (int i = 0; i < TREE_ARITY; i++) hit[i] = distance2[i] <= query->radius2;
}

static void gather(const ewa_neighbours *tree, const tree_query *query, uint32_t first, uint32_t count,
                   const double anchor[3], ewa_block *block) {
    float local[3][LEAF_PLACES];
    double distance2[LEAF_PLACES] = {0};
    for (int c = 0; c < 3; c++) {
        const float *offset = &tree->offset[c][first];
        for (int i = 0; i < LEAF_PLACES; i++) {
            const double at = (double)offset[i] + anchor[c];
            const double below = at - query->high[c], above = query->low[c] - at;
            const double larger = below > above ? below : above, gap = larger > 0 ? larger : 0;
            distance2[i] += gap * gap;
            local[c][i] = (float)((at - query->anchor[c]) * query->per_unit);
        }
    }
    uint32_t n = block->candidate_count;
    for (uint32_t i = 0; i < count; i++) {
        block->x[n] = local[0][i];
        block->y[n] = local[1][i];
        block->z[n] = local[2][i];
        block->place[n] = first + i;
        n += distance2[i] <= query->radius2;
    }
    block->candidate_count = n;
}

static void measure(ewa_block *block, float limit2, int32_t within[EWA_BLOCK_LANES]) {
    const uint32_t count = block->candidate_count;
    for (int lane = 0; lane < EWA_BLOCK_LANES; lane += WIDTH) {
        const wide at_x = load(&block->lane_x[lane]), at_y = load(&block->lane_y[lane]);
        const wide at_z = load(&block->lane_z[lane]);
        wide_int inside = {0};
        for (uint32_t i = 0; i < count; i++) {
            const wide dx = block->x[i] - at_x, dy = block->y[i] - at_y, dz = block->z[i] - at_z;
            const wide distance2 = dx * dx + dy * dy + dz * dz;
            inside -= distance2 <= limit2;
            memcpy(&block->distance2[i][lane], &distance2, sizeof distance2);
        }
        memcpy(&within[lane], &inside, sizeof inside);
    }
}

/// Counts the candidates of WIDTH lanes up to `limit2`.
static inline wide_int count_within(const ewa_block *block, int lane, wide limit2) {
    wide_int inside = {0};
    for (uint32_t i = 0; i < block->candidate_count; i++)
        inside -= load(&block->distance2[i][lane]) <= limit2;
    return inside;
}

/// On a surface the number of neighbours grows linearly with the squared distance, so interpolation finds a
/// limit with `rank` candidates below it in a few steps. Ties and the last few go by bisection between
/// distances that occur.
static void select_rank(ewa_block *block, float limit2, const int32_t within[EWA_BLOCK_LANES], int32_t rank) {
    enum { INTERPOLATIONS = 6 };
    for (int lane = 0; lane < EWA_BLOCK_LANES; lane += WIDTH) {
        // Invariant: fewer than `rank` candidates are up to low, at least `rank` up to high.
        wide low = (wide){0} - 1, high = (wide){0} + limit2;
        wide_int low_count = {0}, high_count = load_int(&within[lane]);
        for (int step = 0; step < INTERPOLATIONS && any(high_count != rank); step++) {
            const wide base = choose(low < 0, (wide){0}, low);
            const wide wanted = (float)rank + 0.5f - __builtin_convertvector(low_count, wide);
            wide share = wanted / (__builtin_convertvector(high_count - low_count, wide) + 1.0f);
            share = choose(share < 0.0625f, (wide){0} + 0.0625f, share);
            share = choose(share > 0.9375f, (wide){0} + 0.9375f, share);
            const wide limit = base + (high - base) * share;
            const wide_int count = count_within(block, lane, limit);
            const wide_int open = high_count != rank, enough = open & (count >= rank),
                           few = open & (count < rank);
            high = choose(enough, limit, high);
            high_count = (high_count & ~enough) | (count & enough);
            low = choose(few, limit, low);
            low_count = (low_count & ~few) | (count & few);
        }
        for (;;) {
            // The largest distance up to high and the smallest beyond low: equal when only ties are left.
            wide last = (wide){0} - 1, next = high;
            for (uint32_t i = 0; i < block->candidate_count; i++) {
                const wide distance2 = load(&block->distance2[i][lane]);
                last = choose((distance2 <= high) & (distance2 > last), distance2, last);
                next = choose((distance2 > low) & (distance2 < next), distance2, next);
            }
            high = last;
            const wide_int open = (high_count != rank) & (next != last);
            if (!any(open)) break;
            const wide middle = next + (last - next) * 0.5f;
            const wide limit = choose(middle < last, middle, next);
            const wide_int count = count_within(block, lane, limit);
            const wide_int enough = open & (count >= rank), few = open & (count < rank);
            high = choose(enough, limit, high);
            high_count = (high_count & ~enough) | (count & enough);
            low = choose(few, limit, low);
        }
        memcpy(&block->radius2[lane], &high, sizeof high);
    }
}

const search_kernels KERNELS = {overlap, gather, measure, select_rank};

#undef WIDTH
#undef KERNELS
