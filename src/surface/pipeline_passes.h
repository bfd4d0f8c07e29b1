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

static void accumulate(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run) {
    typedef void add_run(const pass *p);
    static add_run *const sets[5][4] = {
        {add_color, add_color_depth, add_color_height, add_color_beyond},
        {add_normal, add_normal_depth, add_normal_height, add_normal_beyond},
        {add_opacity, add_opacity_depth, add_opacity_height, add_opacity_beyond},
        {add_material, add_material_depth, add_material_height, add_material_beyond},
        {add_all, add_all_depth, add_all_height, add_all_beyond},
    };
    static add_run *const fine_sets[2] = {add_color_fine, add_normal_fine}; // as without edge antialiasing
    const pass p = {view, tile, run};
    if (view->raycast) {
        ray_accumulate(&p);
        return;
    }
    const int channels = tile->with_materials ? (tile->with_opacity ? 4 : 3)
                         : tile->with_opacity ? 2
                         : tile->with_normals ? 1
                                              : 0;
    const int kind = tile->passed ? 3 : !tile->with_depth ? 0 : view->orthographic ? 2 : 1;
    const bool plain = view->doublings == 2 && !tile->sums.careful;
    if (plain && tile->with_fine && kind == 0 && channels < 2)
        fine_sets[channels](&p);
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

/// settle() with what small splats have added.
static bool settle_all(const ewa_tile *tile, const ewa_resolve *to) {
    if (tile->pixels && !tile->sums.careful) gather_pixels(tile);
    return settle(tile, to);
}

#endif
