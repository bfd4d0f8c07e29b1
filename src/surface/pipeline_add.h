// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of the bodies pipeline_add_*_body.h, one for each set of channels: the second pass over splats, with a loop for each
// class of boxes (docs/math.md section 6). Reference: src/reference/surface.c; the same bytes as accumulate_few().
#ifndef EWA_SRC_SURFACE_PIPELINE_ADD_H
#define EWA_SRC_SURFACE_PIPELINE_ADD_H

#include "surface/pipeline_raster.h"

static ALWAYS_INLINE void accumulate_rows(const pass *p, uint32_t splat, uint32_t first_column,
                                          uint32_t columns, uint32_t rows, depth_test test, int what) {
    const ewa_view *view = p->view;
    const ewa_tile *tile = p->tile;
    const ewa_record *r = &p->run->records[splat];
    const uint32_t channels =
        what & BEYOND
            ? tile->channel_count
            : 4 + (what & ADD_NORMAL ? 3u : 0) + (what & (ADD_DEPTH | ADD_MATERIAL) ? 1u : 0) +
                  (what & ADD_MATERIAL ? EWA_MATERIAL_CHANNELS + 0u : 0) + (what & ADD_OPACITY ? 1u : 0);
    column_terms c[EWA_COLUMN_CLASSES];
    UNROLL_COLUMNS
    for (uint32_t i = 0; i < columns; i++)
        c[i] = column_start(r, r->key, r->key_x, (float)(EWA_BLOCK_PX * (first_column + i)));
    const payload add =
        payload_load(view, r, &p->run->loads[splat], p->run->opacities, p->run->materials, splat, what);
    const wf end = wf_set(view->exponent_end);
    const size_t row_blocks = tile->blocks_per_row;
    const size_t first_block = box_row(r->box) * row_blocks + box_column(r->box) + first_column;
    const float *nearest = tile->nearest + first_block * EWA_BLOCK_LANES;
    const float *passed = what & BEYOND ? tile->passed + first_block * EWA_BLOCK_LANES : NULL;
    float *sums = tile->sums.planes + first_block * channels * EWA_BLOCK_LANES;
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    UNROLL_COLUMNS
    for (uint32_t row = 0; row < rows; row++) {
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) {
            const wf s = block_exponent(r, &c[i], dy), bound = wf_load(nearest + (size_t)i * EWA_BLOCK_LANES);
            wf key = wf_fma(wf_set(r->key_y), dy, c[i].key);
            if (test != PLAIN) key = clamped_key(r, key);
            wm counts = wm_and(wf_lt(s, end), wf_le(bound, key));
            if (what & BEYOND) {
                counts = wm_and(counts, wf_lt(key, wf_load(passed + (size_t)i * EWA_BLOCK_LANES)));
                if (!wm_bits(counts)) continue; // most splats are of other surfaces
            }
            const wf weight = wf_keep(counts, exponential(s, 2));
            const wf depth = what & ADD_DEPTH ? depth_share(view, key, bound, what) : wf_set(0);
            float *block = sums + (size_t)i * channels * EWA_BLOCK_LANES;
            if (what & BEYOND)
                block = visit_block(tile, &tile->sums, box_row(r->box) + row,
                                    box_column(r->box) + first_column + i, channels);
            else if (what & (ADD_DEPTH | ADD_FINE))
                tile->sums.visits[first_block + row * row_blocks + i]++;
            add_channels(block, &tile->sums, channels, weight, &add, depth, what);
        }
        nearest += row_blocks * EWA_BLOCK_LANES;
        if (what & BEYOND) passed += row_blocks * EWA_BLOCK_LANES;
        sums += row_blocks * channels * EWA_BLOCK_LANES;
        dy = wf_add(dy, wf_set(EWA_BLOCK_PX));
    }
}

/// The accumulation for one set of channels. Splats that face away are not worth a body for each class.
#define ACCUMULATE(name, what)                                                                               \
    static __attribute__((noinline)) void name##_back_facing(const pass *p, uint32_t splat,                  \
                                                             uint32_t first_column, uint32_t columns,        \
                                                             uint32_t rows, depth_test test) {               \
        accumulate_few(p, splat, first_column, columns, rows, test, what);                                   \
    }                                                                                                        \
    static ALWAYS_INLINE void name##_rows(const pass *p, uint32_t splat, uint32_t first_column,              \
                                          uint32_t columns, uint32_t rows, depth_test test) {                \
        if ((what) & BEYOND && box_is_concave(p->run->records[splat].box)) return;                               \
        if (box_back_facing(p->run->records[splat].box))                                                     \
            name##_back_facing(p, splat, first_column, columns, rows, test);                                 \
        else                                                                                                 \
            accumulate_rows(p, splat, first_column, columns, rows, test, what);                              \
    }                                                                                                        \
    static void name(const pass *p) { for_each_splat(p, name##_rows); }

/// The table of pipeline_raster.h for one set of channels.
#define ADD_SET(name, what)                                                                                  \
    ACCUMULATE(name, what)                                                                                   \
    ACCUMULATE(name##_depth, (what) | ADD_DEPTH)                                                             \
    ACCUMULATE(name##_height, (what) | ADD_DEPTH | ORTHOGRAPHIC)                                             \
    ACCUMULATE(name##_beyond, (what) | BEYOND)

#endif
