// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: the two passes over a tile's records, each splat by the loops that suit it
// (docs/math.md section 6).
#ifndef EWA_SRC_SURFACE_PIPELINE_PASSES_H
#define EWA_SRC_SURFACE_PIPELINE_PASSES_H

#include "surface/pipeline_small.h"

/// Calls `body` for each small splat, as one of blocks.
static void each_small(const pass *p, splat_rows *body) {
    const uint16_t *first = p->run->class_first;
    for (uint32_t i = first[EWA_SMALL_CLASS]; i < first[EWA_CLASS_COUNT]; i++) {
        const ewa_record *r = &p->run->records[p->run->order[i]];
        const bool exact = box_steep(r->box) && !p->view->orthographic && !(r->bound_scale > 0);
        body(p, p->run->order[i], 0, ewa_box_columns(r->box), ewa_box_rows(r->box),
             exact               ? WIDE
             : box_steep(r->box) ? STEEP
                                 : PLAIN);
    }
}

static void ray_visibility(const pass *p) {
    for (uint32_t i = 0; i < p->run->class_first[EWA_CLASS_COUNT]; i++) {
        const ewa_record *r = &p->run->records[p->run->order[i]];
        const ray_splat ray = ray_start(p->view, r, p->run->loads[p->run->order[i]].peak);
        for (uint32_t row = box_row(r->box); row < box_row(r->box) + ewa_box_rows(r->box); row++) {
            const size_t first = (size_t)row * p->tile->blocks_per_row;
            for (uint32_t k = 0; k < ewa_box_columns(r->box); k++) {
                const uint32_t column = box_column(r->box) + k;
                clip_sample left;
                const ray_sample sample = ray_block(
                    p->view, p->tile, r, &ray, clip_of(p->run->clips, p->run->order[i]), row, column, &left);
                const wm counts = ray_counts(p, &sample, (first + column) * EWA_BLOCK_LANES);
                ray_raise(r, &sample, counts, p->tile->nearest + (first + column) * EWA_BLOCK_LANES);
            }
        }
    }
}

static void clipped_raise(const pass *p, uint32_t splat, uint32_t row, uint32_t column, int what) {
    (void)what;
    const ewa_record *r = &p->run->records[splat];
    const size_t at = ((size_t)row * p->tile->blocks_per_row + column) * EWA_BLOCK_LANES;
    const block_sample sample = sample_block(r, row, column);
    const wf share = clip_block(p->tile, &p->run->clips[splat], row, column).share;
    const wf old = wf_load(p->tile->nearest + at), bound = block_bound(p->view, r, &sample, column);
    wf_store(p->tile->nearest + at,
             wf_select(clipped_counts(p, &sample, share, at), wf_max(bound, old), old));
}

static void visibility(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run) {
    const pass p = {view, tile, run};
    if (view->raycast)
        ray_visibility(&p);
    else if (tile->passed)
        for_each_splat(&p, raise_rows_beyond);
    else
        for_each_splat(&p, raise_rows);
    if (view->raycast) return;
    for_each_clipped(&p, clipped_raise, 0);
    if (tile->passed)
        each_small(&p, raise_rows_beyond);
    else
        for_each_small(&p, small_visibility);
}

static void clear_nearest(const ewa_tile *tile) {
    const size_t floats = (size_t)tile->blocks_per_row * tile->block_rows * EWA_BLOCK_LANES;
    for (size_t i = 0; i < floats; i += EWA_BLOCK_LANES)
        wf_store(tile->nearest + i, wf_set(-__builtin_inff()));
}

static void clear_sums(const ewa_tile *tile) {
    const size_t blocks = (size_t)tile->blocks_per_row * tile->block_rows;
    const bool only_small = tile->only_small && !tile->sums.careful;
    const ewa_side_sums *side = &tile->side;
    memset(side->back_facing_rows, 0, tile->block_rows * sizeof *side->back_facing_rows);
    if (side->cut_rows) memset(side->cut_rows, 0, tile->block_rows * sizeof *side->cut_rows);
    const size_t floats = only_small ? 0 : blocks * tile->channel_count * EWA_BLOCK_LANES;
    for (size_t i = 0; i < floats; i += EWA_BLOCK_LANES) wf_store(tile->sums.planes + i, wf_set(BIAS));
    for (size_t i = 0; i < floats && tile->sums.fine; i += EWA_BLOCK_LANES)
        wf_store(tile->sums.planes + tile->sums.fine + i, wf_set(BIAS));
    for (size_t i = 0; i < blocks * EWA_PIXEL_FLOATS && tile->pixels; i++)
        wf_store(tile->pixels + i * EWA_BLOCK_LANES, wf_set(BIAS));
    memset(tile->sums.visits, 0, blocks * sizeof *tile->sums.visits);
    memset(tile->sums.high_rows, 0, tile->block_rows * sizeof *tile->sums.high_rows);
    // Only small splats tell.
    memset(tile->beyond_rows, only_small ? 0 : 0xff, tile->block_rows * sizeof *tile->beyond_rows);
}

static void ray_accumulate(const pass *p) {
    const ewa_view *view = p->view;
    const ewa_tile *tile = p->tile;
    const int what = channels_of(tile) | (tile->with_depth && !tile->passed ? ADD_DEPTH : 0);
    for (uint32_t i = 0; i < p->run->class_first[EWA_CLASS_COUNT]; i++) {
        const ewa_record *r = &p->run->records[p->run->order[i]];
        const ewa_load *load = &p->run->loads[p->run->order[i]];
        const ray_splat ray = ray_start(view, r, load->peak);
        const payload add =
            payload_load(view, r, load, p->run->opacities, p->run->materials, p->run->order[i], what);
        for (uint32_t row = box_row(r->box); row < box_row(r->box) + ewa_box_rows(r->box); row++) {
            for (uint32_t k = 0; k < ewa_box_columns(r->box); k++) {
                const uint32_t column = box_column(r->box) + k;
                const size_t block = (size_t)row * tile->blocks_per_row + column;
                const ewa_clip *clip = clip_of(p->run->clips, p->run->order[i]);
                clip_sample left;
                const ray_sample sample = ray_block(view, tile, r, &ray, clip, row, column, &left);
                const wf bound = wf_load(tile->nearest + block * EWA_BLOCK_LANES);
                const wm counts =
                    wm_and(ray_counts(p, &sample, block * EWA_BLOCK_LANES), wf_le(bound, sample.key));
                if (!wm_bits(counts)) continue;
                const payload gained = payload_times(&add, wf_keep(counts, sample.gain), what);
                const wf bell = exponential(wf_keep(counts, sample.exponent), view->doublings);
                add_splat(tile, r, clip, &left, row, column, wf_keep(counts, bell), &gained,
                          depth_share(view, wf_select(counts, sample.key, wf_set(1)), bound, what), what);
            }
        }
    }
}

static void clipped_add(const pass *p, uint32_t splat, uint32_t row, uint32_t column, int what) {
    const ewa_tile *tile = p->tile;
    const ewa_record *r = &p->run->records[splat];
    const size_t block = (size_t)row * tile->blocks_per_row + column, at = block * EWA_BLOCK_LANES;
    const block_sample sample = sample_block(r, row, column);
    const ewa_clip *clip = &p->run->clips[splat];
    const clip_sample left = clip_block(tile, clip, row, column);
    const wf bound = wf_load(tile->nearest + at);
    const wm counts = wm_and(clipped_counts(p, &sample, left.share, at), wf_le(bound, sample.key));
    if (!wm_bits(counts)) return;
    const payload add =
        payload_load(p->view, r, &p->run->loads[splat], p->run->opacities, p->run->materials, splat, what);
    add_splat(tile, r, clip, &left, row, column,
              wf_keep(counts, exponential(sample.exponent, p->view->doublings)), &add,
              depth_share(p->view, sample.key, bound, what), what);
}

/// Sums of many splats are rare, so are most fine ones, and cutoffs beyond 3, which need more than two
/// doublings: one body for all that goes with them.
static __attribute__((noinline)) void add_careful_rows(const pass *p, uint32_t splat, uint32_t first_column,
                                                       uint32_t columns, uint32_t rows, depth_test test) {
    const ewa_tile *tile = p->tile;
    if (tile->passed && box_is_concave(p->run->records[splat].box)) return;
    accumulate_few(p, splat, first_column, columns, rows, test,
                   channels_of(tile) |
                       (tile->passed       ? BEYOND
                        : tile->with_depth ? ADD_DEPTH
                                           : 0) |
                       (p->view->orthographic ? ORTHOGRAPHIC : 0));
}

static void add_carefully(const pass *p) { for_each_splat(p, add_careful_rows); }

static void accumulate(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run) {
    static add_run *const *const sets[] = {EWA_VERSION(ewa_add_color), EWA_VERSION(ewa_add_normal),
                                           EWA_VERSION(ewa_add_opacity), EWA_VERSION(ewa_add_material),
                                           EWA_VERSION(ewa_add_all)};
    const pass p = {view, tile, run};
    if (view->raycast) {
        ray_accumulate(&p);
        return;
    }
    const int channels = tile->with_materials ? (tile->with_opacity ? 4 : 3)
                         : tile->with_opacity ? 2
                         : tile->with_normals ? 1
                                              : 0;
    const add_kind kind = tile->passed         ? ADD_BEYOND
                          : !tile->with_depth  ? ADD_WITHOUT_DEPTH
                          : view->orthographic ? ADD_WITH_HEIGHT
                                               : ADD_WITH_DEPTH;
    const bool plain = view->doublings == 2 && !tile->sums.careful;
    if (plain && tile->with_fine && kind == ADD_WITHOUT_DEPTH && sets[channels][ADD_FINELY])
        sets[channels][ADD_FINELY](&p);
    else if (tile->with_fine || !(plain || (tile->passed && view->doublings == 2)))
        add_carefully(&p);
    else
        sets[channels][kind](&p);
    for_each_clipped(&p, clipped_add,
                     channels_of(tile) | (tile->with_depth && !tile->passed ? ADD_DEPTH : 0) |
                         (view->orthographic ? ORTHOGRAPHIC : 0));
    if (tile->passed || tile->sums.careful)
        each_small(&p, add_careful_rows);
    else
        for_each_small(&p, small_accumulate);
}

static bool finalize(const ewa_tile *tile, const ewa_resolve *to) {
    if (tile->pixels && !tile->sums.careful) gather_pixels(tile);
    const uint32_t whole_row = ~0u >> (32 - tile->blocks_per_row);
    for (uint32_t row = 0; row < tile->block_rows && !tile->sums.careful; row++)
        for (uint32_t column = 0; column < tile->blocks_per_row; column++)
            if (is_beyond(tile, &tile->sums, row, column, tile->channel_count)) return false;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        tile->finalized_rows[row] = rows_to_finalize(tile, row) & whole_row;
        for (uint32_t left = tile->finalized_rows[row]; left; left &= left - 1)
            finalize_block(tile, to, row, (uint32_t)__builtin_ctz(left), false);
    }
    return true;
}

#endif
