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

/// Starts a surface in a block: where `open`, splats beyond the key `done` are wanted, elsewhere none.
static void start_surface(const ewa_tile *tile, const ewa_edges *edges, size_t block, wm open, wf done) {
    const wf never = wf_set(-__builtin_inff());
    float *passed = edges->passed + block * EWA_BLOCK_LANES;
    wf_store(passed, wf_select(open, done, never));
    edges->reach[block] = -__builtin_inff();
    for (int i = 0; i < EWA_BLOCK_LANES; i++)
        if (passed[i] > edges->reach[block]) edges->reach[block] = passed[i];
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
            if (!wm_bits(open)) continue;
            edges->rows[row] |= 1u << column;
            count++;
            start_surface(tile, edges, block, open, wf_load(tile->nearest + block * LANES));
            for (int c = 0; c < 4; c++) wf_store(edges->behind + (block * 4 + (size_t)c) * LANES, zero);
        }
    }
    return count;
}

/// The marked blocks of one row of a splat's box that the splat may lie beyond, a bit each.
static ALWAYS_INLINE uint32_t wanted_blocks(const ewa_tile *tile, const ewa_edges *edges, const ewa_record *r,
                                            uint32_t row) {
    const uint64_t columns = ((uint64_t)1 << box_columns(r->box)) - 1;
    const uint32_t marked = edges->rows[box_row(r->box) + row] & (uint32_t)(columns << box_column(r->box));
    uint32_t wanted = 0;
    for (uint32_t left = marked; left; left &= left - 1) {
        const uint32_t column = (uint32_t)__builtin_ctz(left);
        if (r->key_low < edges->reach[block_at(tile, box_row(r->box) + row, column)]) wanted |= 1u << column;
    }
    return wanted;
}

static uint32_t edge_hits(const ewa_tile *tile, const ewa_edges *edges, const ewa_record *records,
                          const uint16_t *candidates, uint32_t candidate_count, uint16_t *hits) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < candidate_count; i++) {
        const uint16_t splat = candidates[i];
        const ewa_record *r = &records[splat];
        uint32_t wanted = 0;
        for (uint32_t row = 0; row < box_rows(r->box); row++) wanted |= wanted_blocks(tile, edges, r, row);
        hits[count] = splat;
        count += wanted != 0;
    }
    return count;
}

/// One splat in one marked block.
static ALWAYS_INLINE void edge_block(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                                     const ewa_record *r, const ewa_load *load, uint32_t row, uint32_t column,
                                     bool second_pass) {
    const size_t block = block_at(tile, box_row(r->box) + row, column);
    const column_terms c = column_start(r, (float)EWA_BLOCK_PX * ((float)column - (float)box_column(r->box)));
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    for (uint32_t i = 0; i < row; i++)
        dy = wf_add(dy, wf_set(EWA_BLOCK_PX)); // as the passes over whole boxes step
    const wf s = block_exponent(&c, dy, wf_mul(wf_mul(wf_set(r->yy), dy), dy));
    const wf key = block_key(r, &c, wf_mul(wf_set(r->key_y), dy));
    float *nearest = edges->nearest + block * EWA_BLOCK_LANES;
    const wm beyond = wm_and(wf_lt(s, wf_set(view->exponent_end)),
                             wf_lt(key, wf_load(edges->passed + block * EWA_BLOCK_LANES)));
    if (!second_pass) {
        const bool exact = r->bound_scale == 0;
        const wf old = wf_load(nearest);
        wf_store(nearest, wf_select(beyond, wf_max(bound_key(r, key, exact), old), old));
        return;
    }
    const wm counts = wm_and(beyond, wf_le(wf_load(nearest), key));
    if (!wm_bits(counts)) return;
    payload add = {.color = {wf_set(r->red), wf_set(r->green), wf_set(r->blue)}};
    for (int i = 0; i < 3; i++) add.normal[i] = wf_set(load->normal[i]);
    const wf weight = wf_keep(counts, wf_mul(exponential(s, view->doublings), wf_set(load->peak)));
    add_channels(edges->sums + block * tile->channel_count * EWA_BLOCK_LANES, weight, &add, key,
                 tile->with_normals, false, false);
}

static void edge_pass(const ewa_view *view, const ewa_tile *tile, const ewa_edges *edges,
                      const ewa_sorted_run *run, const uint16_t *hits, uint32_t hit_count, bool second_pass) {
    for (uint32_t i = 0; i < hit_count; i++) {
        const ewa_record *r = &run->records[hits[i]];
        for (uint32_t row = 0; row < box_rows(r->box); row++)
            for (uint32_t left = wanted_blocks(tile, edges, r, row); left; left &= left - 1)
                edge_block(view, tile, edges, r, &run->loads[hits[i]], row, (uint32_t)__builtin_ctz(left),
                           second_pass);
    }
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
            const wm open = compose_block(tile, to, edges, row, column);
            if (wm_bits(open)) {
                const size_t block = block_at(tile, row, column);
                start_surface(tile, edges, block, open, wf_load(edges->nearest + block * EWA_BLOCK_LANES));
                count++;
            } else {
                edges->rows[row] &= ~(1u << column);
            }
        }
    }
    return count;
}

#endif
