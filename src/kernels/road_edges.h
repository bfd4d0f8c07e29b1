// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: what lies behind antialiased edges. The surfaces behind the first one are gathered in
// the few blocks that hold a partly covered pixel, one surface after another (semantics.h, edge layers).
#ifndef EWA_SRC_KERNELS_ROAD_EDGES_H
#define EWA_SRC_KERNELS_ROAD_EDGES_H

#include "kernels/road_resolve.h"

static size_t block_at(const ewa_tile *tile, uint32_t row, uint32_t column) {
    return (size_t)row * tile->blocks_per_row + column;
}

static float largest_lane(wf v) {
    float lanes[EWA_BLOCK_LANES];
    wf_store(lanes, v);
    float largest = lanes[0];
    for (int i = 1; i < EWA_BLOCK_LANES; i++) largest = lanes[i] > largest ? lanes[i] : largest;
    return largest;
}

/// Starts a surface in a block: where `open`, splats beyond the key `done` are wanted, elsewhere none.
static void start_surface(const ewa_tile *tile, const ewa_edges *edges, size_t block, wm open, wf done) {
    const wf never = wf_set(-__builtin_inff()), passed = wf_select(open, done, never);
    wf_store(edges->passed + block * EWA_BLOCK_LANES, passed);
    edges->reach[block] = largest_lane(passed);
    wf_store(edges->nearest + block * EWA_BLOCK_LANES, never);
    float *sums = edges->sums + block * tile->channel_count * EWA_BLOCK_LANES;
    for (uint32_t c = 0; c < tile->channel_count; c++) wf_store(sums + c * EWA_BLOCK_LANES, wf_set(0));
}

static uint32_t find_edges(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges) {
    enum { LANES = EWA_BLOCK_LANES };
    uint32_t count = 0;
    const wf scale = wf_set(to->alpha_scale), one = wf_set(1), zero = wf_set(0);
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        edges->rows[row] = 0;
        for (uint32_t column = 0; column < tile->blocks_per_row; column++) {
            const size_t block = block_at(tile, row, column);
            const wf q = wf_load(tile->sums + block * tile->channel_count * LANES);
            const wm open = wm_and(wf_lt(zero, q), wf_lt(wf_mul(q, scale), one));
            edges->reach[block] = -__builtin_inff();
            if (!wm_bits(open)) continue;
            edges->rows[row] |= 1u << column;
            count++;
            start_surface(tile, edges, block, open, wf_load(tile->nearest + block * LANES));
            for (int c = 0; c < 4; c++) wf_store(edges->behind + (block * 4 + (size_t)c) * LANES, zero);
        }
    }
    return count;
}

/// s and key of a splat in one block of its box.
typedef struct block_sample {
    wf exponent, key;
} block_sample;

static ALWAYS_INLINE block_sample sample_block(const ewa_record *r, uint32_t row, uint32_t column) {
    const column_terms c = column_start(r, (float)EWA_BLOCK_PX * ((float)column - (float)box_column(r->box)));
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    for (uint32_t i = box_row(r->box); i < row; i++)
        dy = wf_add(dy, wf_set(EWA_BLOCK_PX)); // as the passes over whole boxes step
    return (block_sample){block_exponent(&c, dy, wf_mul(wf_mul(wf_set(r->yy), dy), dy)),
                          block_key(r, &c, wf_mul(wf_set(r->key_y), dy))};
}

static void edge_raise(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                       uint32_t column, const ewa_edge_splats *splats) {
    const size_t at = block_at(tile, row, column) * EWA_BLOCK_LANES;
    const wf passed = wf_load(edges->passed + at), end = wf_set(view->exponent_end);
    wf nearest = wf_load(edges->nearest + at);
    for (uint32_t i = 0; i < splats->count; i++) {
        const ewa_record *r = &splats->records[splats->indices[i]];
        const block_sample sample = sample_block(r, row, column);
        const wm beyond = wm_and(wf_lt(sample.exponent, end), wf_lt(sample.key, passed));
        const wf bound = bound_key(r, sample.key, r->bound_scale == 0);
        nearest = wf_select(beyond, wf_max(bound, nearest), nearest);
    }
    wf_store(edges->nearest + at, nearest);
}

static ALWAYS_INLINE void edge_sum(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                                   uint32_t row, uint32_t column, const ewa_edge_splats *splats,
                                   bool with_normals) {
    const size_t block = block_at(tile, row, column), at = block * EWA_BLOCK_LANES;
    const wf passed = wf_load(edges->passed + at), nearest = wf_load(edges->nearest + at);
    const wf end = wf_set(view->exponent_end), never = wf_set(-__builtin_inff());
    const wf behind_all = wf_set(__builtin_inff());
    // Splats that are nowhere as near as what counts.
    const float least_key =
        -largest_lane(wf_sub(wf_set(0), wf_select(wf_lt(never, nearest), nearest, behind_all)));
    float *sums = edges->sums + at * tile->channel_count;
    for (uint32_t i = 0; i < splats->count; i++) {
        const uint32_t index = splats->indices[i];
        const ewa_record *r = &splats->records[index];
        if (r->key_high < least_key) continue;
        const block_sample sample = sample_block(r, row, column);
        const wm beyond = wm_and(wf_lt(sample.exponent, end), wf_lt(sample.key, passed));
        const wm counts = wm_and(beyond, wf_le(nearest, sample.key));
        if (!wm_bits(counts)) continue;
        const ewa_load *load = &splats->loads[index];
        payload add = {.color = {wf_set(r->red), wf_set(r->green), wf_set(r->blue)}};
        for (int k = 0; k < 3; k++) add.normal[k] = wf_set(load->normal[k]);
        const wf weight =
            wf_keep(counts, wf_mul(exponential(sample.exponent, view->doublings), wf_set(load->peak)));
        add_channels(sums, weight, &add, sample.key, with_normals, false, false);
    }
}

static void edge_pass(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges, uint32_t row,
                      uint32_t column, const ewa_edge_splats *splats, bool second_pass) {
    if (!second_pass)
        edge_raise(view, tile, edges, row, column, splats);
    else if (tile->with_normals)
        edge_sum(view, tile, edges, row, column, splats, true);
    else
        edge_sum(view, tile, edges, row, column, splats, false);
}

static void edge_near_pass(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                           const ewa_near_record *records, uint32_t count, bool second_pass) {
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t row = 0; row < tile->block_rows; row++) {
            for (uint32_t marked = edges->rows[row]; marked; marked &= marked - 1) {
                const uint32_t column = (uint32_t)__builtin_ctz(marked);
                const size_t block = block_at(tile, row, column);
                const near_sample sample = near_block(view, &records[i], row, column);
                const wf key = wf_div(wf_set(1), sample.z);
                float *nearest = edges->nearest + block * EWA_BLOCK_LANES;
                wm counts =
                    wm_and(sample.counts, wf_lt(key, wf_load(edges->passed + block * EWA_BLOCK_LANES)));
                if (!second_pass) {
                    near_raise(&records[i], &sample, counts, nearest);
                    continue;
                }
                counts = wm_and(counts, wf_le(wf_load(nearest), key));
                near_add(view, &records[i], &sample, counts, key,
                         edges->sums + block * tile->channel_count * EWA_BLOCK_LANES, tile->with_normals,
                         false);
            }
        }
    }
}

/// Composites one block's gathered surface under what is in front of it; returns the pixels that stay open.
static wm compose_block(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges, uint32_t row,
                        uint32_t column) {
    enum { LANES = EWA_BLOCK_LANES };
    const size_t block = block_at(tile, row, column);
    const float *sums = edges->sums + block * tile->channel_count * LANES;
    const wf scale = color_scale(tile, to, sums, (uint32_t)tile->x_px + column * EWA_BLOCK_PX,
                                 (uint32_t)tile->y_px + row * EWA_BLOCK_PX);
    const surface found = gathered_surface(to, sums, scale);
    float *behind = edges->behind + block * 4 * LANES;
    const wf covered = wf_load(behind + 3 * LANES);
    const wf share = wf_mul(wf_sub(wf_set(1), covered), found.alpha);
    for (int c = 0; c < 3; c++)
        wf_store(behind + c * LANES, wf_fma(found.color[c], share, wf_load(behind + c * LANES)));
    const wf total = wf_add(covered, share);
    wf_store(behind + 3 * LANES, total);
    return wm_and(wf_lt(wf_set(0), wf_load(sums)), wf_lt(total, wf_set(1)));
}

static uint32_t edge_compose(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges) {
    uint32_t count = 0;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        for (uint32_t marked = edges->rows[row]; marked; marked &= marked - 1) {
            const uint32_t column = (uint32_t)__builtin_ctz(marked);
            const size_t block = block_at(tile, row, column);
            const wm open = compose_block(tile, to, edges, row, column);
            if (wm_bits(open)) {
                start_surface(tile, edges, block, open, wf_load(edges->nearest + block * EWA_BLOCK_LANES));
                count++;
            } else {
                edges->rows[row] &= ~(1u << column);
                edges->reach[block] = -__builtin_inff();
            }
        }
    }
    return count;
}

#endif
