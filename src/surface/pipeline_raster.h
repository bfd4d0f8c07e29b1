// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: the two passes over a tile's records (docs/math.md section 6).
#ifndef EWA_SRC_SURFACE_PIPELINE_RASTER_H
#define EWA_SRC_SURFACE_PIPELINE_RASTER_H

#include "surface/pipeline_payload.h"
#include "surface/pipeline_raycast.h"

/// exp(-s) for s in [0, EWA_EXPONENT_END] within 3.0e-05 relative, squared `doublings` >= 2 times.
static ALWAYS_INLINE wf exponential(wf s, uint32_t doublings) {
    static const float coefficients[] = {0.023368568317f, -0.149394522715f, 0.492818156100f, -0.998891978164f, 0.999970343067f};
    wf e = wf_horner(s, coefficients, sizeof coefficients / sizeof coefficients[0]);
    e = wf_mul(e, e);
    e = wf_mul(e, e);
    for (uint32_t i = 2; i < doublings; i++) e = wf_mul(e, e);
    return e;
}

static ALWAYS_INLINE uint32_t box_column(uint32_t box) { return box & 0x3f; }
static ALWAYS_INLINE bool box_back_facing(uint32_t box) { return box & EWA_BACK_FACING_BIT; }
static ALWAYS_INLINE bool box_steep(uint32_t box) { return box & EWA_STEEP_BIT; }
static ALWAYS_INLINE uint32_t box_row(uint32_t box) { return box >> 8 & 0x3f; }
static ALWAYS_INLINE bool box_hollow(uint32_t box) { return box & EWA_HOLLOW_BIT; }
static ALWAYS_INLINE bool box_clipped(uint32_t box) { return box & EWA_CLIP_BIT; }

/// What the blocks of one column of a record's box share: the terms without dy of s and of a key's plane.
typedef struct column_terms {
    wf quadratic, cross, key;
} column_terms;

/// Of s and of the plane (key, key_x).
static ALWAYS_INLINE column_terms column_start(const ewa_record *r, float key, float key_x, float first_px) {
    const wf dx = wf_add(lanes_x(), wf_set(r->offset_x + first_px));
    return (column_terms){wf_mul(wf_mul(wf_set(r->xx), dx), dx), wf_mul(wf_set(r->xy), dx),
                          wf_fma(wf_set(key_x), dx, wf_set(key))};
}

/// s of a block.
static ALWAYS_INLINE wf block_exponent(const ewa_record *r, const column_terms *c, wf dy) {
    return wf_fma_twice(dy, wf_set(r->yy), c->cross, c->quadratic);
}

/// How the splats of a class test their depth (ewa_record).
typedef enum depth_test { PLAIN, STEEP, WIDE } depth_test;

/// A steep or wide splat's key, from that of its plane.
static ALWAYS_INLINE wf clamped_key(const ewa_record *r, wf key) {
    return wf_min(wf_max(key, wf_set(r->key_low)), wf_set(r->key_high));
}

/// A steep or wide splat's key of z + eps, from its key.
static ALWAYS_INLINE wf bound_key(const ewa_record *r, wf key, bool exact) {
    const wf offset = wf_set(r->bound_offset);
    if (exact) return wf_mul(key, wf_reciprocal(wf_fma(offset, key, wf_set(1))));
    return wf_fma(wf_set(r->bound_scale), key, offset);
}

/// s and key of a splat in one block of its box.
typedef struct block_sample {
    wf exponent, key, dy;
} block_sample;

static ALWAYS_INLINE block_sample sample_block(const ewa_record *r, uint32_t row, uint32_t column) {
    const float first_px = (float)EWA_BLOCK_PX * ((float)column - (float)box_column(r->box));
    const column_terms c = column_start(r, r->key, r->key_x, first_px);
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    for (uint32_t i = box_row(r->box); i < row; i++)
        dy = wf_add(dy, wf_set(EWA_BLOCK_PX)); // as the passes over whole boxes step
    const wf key = wf_fma(wf_set(r->key_y), dy, c.key);
    return (block_sample){block_exponent(r, &c, dy), box_steep(r->box) ? clamped_key(r, key) : key, dy};
}

/// With `beyond`, only where the key is below tile->passed.
static ALWAYS_INLINE void visibility_rows(const ewa_view *view, const ewa_tile *tile, const ewa_record *r,
                                          uint32_t first_column, uint32_t columns, uint32_t rows,
                                          depth_test test, bool beyond) {
    const float plane = test == PLAIN ? r->bound : r->key;
    const float plane_x = test == PLAIN ? r->bound_x : r->key_x;
    const float plane_y = test == PLAIN ? r->bound_y : r->key_y;
    column_terms c[EWA_COLUMN_CLASSES];
    wf keys[EWA_COLUMN_CLASSES];
    UNROLL_COLUMNS
    for (uint32_t i = 0; i < columns; i++) {
        const float first_px = (float)(EWA_BLOCK_PX * (first_column + i));
        c[i] = column_start(r, plane, plane_x, first_px);
        if (beyond) keys[i] = column_start(r, r->key, r->key_x, first_px).key;
    }
    const wf end = wf_set(view->exponent_end);
    const size_t row_floats = (size_t)tile->blocks_per_row * EWA_BLOCK_LANES;
    const size_t first_float =
        box_row(r->box) * row_floats + (size_t)(box_column(r->box) + first_column) * EWA_BLOCK_LANES;
    float *nearest = tile->nearest + first_float;
    const float *passed = beyond ? tile->passed + first_float : NULL;
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    UNROLL_COLUMNS
    for (uint32_t row = 0; row < rows; row++, nearest += row_floats, dy = wf_add(dy, wf_set(EWA_BLOCK_PX))) {
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) {
            float *block = nearest + (size_t)i * EWA_BLOCK_LANES;
            const wf old = wf_load(block);
            wf bound = wf_fma(wf_set(plane_y), dy, c[i].key), key = bound;
            if (test != PLAIN) {
                key = clamped_key(r, bound);
                bound = bound_key(r, key, test == WIDE && !view->orthographic);
            } else if (beyond) {
                key = wf_fma(wf_set(r->key_y), dy, keys[i]);
            }
            wm counts = wf_lt(block_exponent(r, &c[i], dy), end);
            if (beyond) counts = wm_and(counts, wf_lt(key, wf_load(passed + (size_t)i * EWA_BLOCK_LANES)));
            wf_store(block, wf_select(counts, wf_max(bound, old), old));
        }
        if (beyond) passed += row_floats;
    }
}

/// One pass over a run.
typedef struct pass {
    const ewa_view *view;
    const ewa_tile *tile;
    const ewa_sorted_run *run;
} pass;

typedef void splat_rows(const pass *p, uint32_t splat, uint32_t first_column, uint32_t columns, uint32_t rows,
                        depth_test test);

#if defined(WIDE_PORTABLE)
/// Calls `body`, of which a copy for each class would only be code: vectors of four leave no registers for what is the same.
static ALWAYS_INLINE void for_each_splat(const pass *p, splat_rows *body) {
    const uint16_t *first = p->run->class_first, *order = p->run->order;
    uint32_t i = first[0];
    for (; i < first[EWA_STEEP_CLASS]; i++) {
        const uint32_t box = p->run->records[order[i]].box;
        body(p, order[i], 0, ewa_box_columns(box), ewa_box_rows(box), PLAIN);
    }
    for (; i < first[EWA_CLIP_CLASS]; i++) {
        const depth_test test = i < first[EWA_WIDE_CLASS] ? STEEP : WIDE;
        const uint32_t box = p->run->records[order[i]].box, columns = ewa_box_columns(box);
        for (uint32_t column = 0, count; column < columns; column += count) {
            count = columns - column < EWA_COLUMN_CLASSES ? columns - column : EWA_COLUMN_CLASSES;
            body(p, order[i], column, count, ewa_box_rows(box), test);
        }
    }
}
#else
/// Calls `body` with the column count and the test constants in each class and the row count the same along
/// a class, so that its loops are unrolled or predicted.
static ALWAYS_INLINE void for_each_splat(const pass *p, splat_rows *body) {
    const uint16_t *first = p->run->class_first, *order = p->run->order;
    const ewa_record *r = p->run->records;
    UNROLL_COLUMNS
    for (uint32_t columns = 1; columns <= EWA_COLUMN_CLASSES; columns++) {
        const uint16_t *of_rows = first + (columns - 1) * EWA_ROW_CLASSES;
        uint32_t i = of_rows[0];
        if (columns <= 2) { // and rows, unrolled
            for (; i < of_rows[1]; i++) body(p, order[i], 0, columns, 1, PLAIN);
            for (; i < of_rows[2]; i++) body(p, order[i], 0, columns, 2, PLAIN);
        }
        for (; i < of_rows[EWA_ROW_CLASSES]; i++)
            body(p, order[i], 0, columns, ewa_box_rows(r[order[i]].box), PLAIN);
    }
    first += EWA_STEEP_CLASS;
    UNROLL_COLUMNS
    for (uint32_t columns = 1; columns <= EWA_COLUMN_CLASSES; columns++)
        for (uint32_t i = first[(columns - 1) * EWA_ROW_CLASSES]; i < first[columns * EWA_ROW_CLASSES]; i++)
            body(p, order[i], 0, columns, ewa_box_rows(r[order[i]].box), STEEP);
    first += EWA_STEEP_CLASS;
    for (uint32_t i = first[0]; i < first[1]; i++) {
        const uint32_t columns = ewa_box_columns(r[order[i]].box), rows = ewa_box_rows(r[order[i]].box);
        uint32_t column = 0;
        for (; column + 4 <= columns; column += 4) body(p, order[i], column, 4, rows, WIDE);
        for (; column < columns; column++) body(p, order[i], column, 1, rows, WIDE);
    }
}
#endif

static ALWAYS_INLINE void raise_rows(const pass *p, uint32_t splat, uint32_t first_column, uint32_t columns,
                                     uint32_t rows, depth_test test) {
    visibility_rows(p->view, p->tile, &p->run->records[splat], first_column, columns, rows, test, false);
}

static ALWAYS_INLINE void raise_rows_beyond(const pass *p, uint32_t splat, uint32_t first_column,
                                            uint32_t columns, uint32_t rows, depth_test test) {
    if (box_hollow(p->run->records[splat].box)) return;
    visibility_rows(p->view, p->tile, &p->run->records[splat], first_column, columns, rows, test, true);
}

static ALWAYS_INLINE const ewa_clip *clip_of(const ewa_clip *clips, uint32_t record) {
    return clips ? &clips[record] : NULL;
}

/// A raycast splat at a block of its box; `at_lines` is set for one that has clip lines.
static ALWAYS_INLINE ray_sample ray_block(const ewa_view *view, const ewa_tile *tile, const ewa_record *r,
                                          const ray_splat *ray, const ewa_clip *clip, uint32_t row,
                                          uint32_t column, clip_sample *at_lines) {
    const float x_px = (float)EWA_BLOCK_PX * ((float)column - (float)box_column(r->box)) + r->offset_x;
    const float y_px = (float)EWA_BLOCK_PX * ((float)row - (float)box_row(r->box)) + r->offset_y;
    ray_sample sample =
        ray_evaluate(view, r, ray, wf_add(lanes_x(), wf_set(x_px)), wf_add(lanes_y(), wf_set(y_px)));
    if (box_clipped(r->box)) {
        *at_lines = clip_block(tile, clip, row, column);
        sample.exponent =
            wf_select(wf_lt(wf_set(0), at_lines->share), sample.exponent, wf_set(__builtin_inff()));
    }
    return sample;
}

/// Raises the blocks' keys to that of z + eps; all raycast splats are steep or wide.
static ALWAYS_INLINE void ray_raise(const ewa_record *r, const ray_sample *sample, wm counts,
                                    float *nearest) {
    const wf bound = r->bound_scale > 0 ? bound_key(r, sample->key, false) : bound_key(r, sample->key, true);
    const wf old = wf_load(nearest);
    wf_store(nearest, wf_select(counts, wf_max(bound, old), old));
}

/// Where a raycast splat counts in the block whose first number is `at`.
static ALWAYS_INLINE wm ray_counts(const pass *p, const ray_sample *sample, size_t at) {
    const wm within = wf_lt(sample->exponent, wf_set(p->view->exponent_end));
    if (!p->tile->passed) return within;
    return wm_and(within, wf_lt(sample->key, wf_load(p->tile->passed + at)));
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

typedef void clipped_block(const pass *p, uint32_t splat, uint32_t row, uint32_t column, int what);

/// Calls `body` for every block of the splats with clip lines.
static ALWAYS_INLINE void for_each_clipped(const pass *p, clipped_block *body, int what) {
    const uint16_t *first = p->run->class_first + EWA_CLIP_CLASS;
    for (uint32_t i = first[0]; i < first[1]; i++) {
        const uint32_t splat = p->run->order[i], box = p->run->records[splat].box;
        for (uint32_t row = box_row(box); row < box_row(box) + ewa_box_rows(box); row++)
            for (uint32_t column = box_column(box); column < box_column(box) + ewa_box_columns(box); column++)
                body(p, splat, row, column, what);
    }
}

/// Where a splat with clip lines counts in the block whose first number is `at`.
static ALWAYS_INLINE wm clipped_counts(const pass *p, const block_sample *sample, wf share, size_t at) {
    const wm within = wm_and(wf_lt(sample->exponent, wf_set(p->view->exponent_end)), wf_lt(wf_set(0), share));
    if (!p->tile->passed) return within;
    return wm_and(within, wf_lt(sample->key, wf_load(p->tile->passed + at)));
}

/// The key of z + eps of a splat in a block.
static ALWAYS_INLINE wf block_bound(const ewa_view *view, const ewa_record *r, const block_sample *sample,
                                    uint32_t column) {
    if (box_steep(r->box)) return bound_key(r, sample->key, !view->orthographic && !(r->bound_scale > 0));
    const float first_px = (float)EWA_BLOCK_PX * ((float)column - (float)box_column(r->box));
    return wf_fma(wf_set(r->bound_y), sample->dy, column_start(r, r->bound, r->bound_x, first_px).key);
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

/// Adds a splat to what a block has gathered: `weight` is relative to the kernel's peak, without the clip
/// lines; `left` is looked at when it has some.
static ALWAYS_INLINE void add_splat(const ewa_tile *tile, const ewa_record *r, const ewa_clip *clip,
                                    const clip_sample *left, uint32_t row, uint32_t column, wf weight,
                                    const payload *p, wf depth, int what) {
    const bool is_back = box_back_facing(r->box), clipped = box_clipped(r->box);
    if (clipped) {
        add_cut(tile, row, column, clip, left, wf_mul(weight, p->peak));
        weight = wf_mul(weight, left->share);
    }
    float *sums = visit_sums(tile, is_back, row, column);
    if (clipped) // little may be left of it, and be all that the pixel has
        add_channels(sums, sums_for(tile, is_back), tile->channel_count, weight, p, depth, what | ADD_FINE);
    else
        add_channels(sums, sums_for(tile, is_back), tile->channel_count, weight, p, depth, what);
}

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

/// accumulate_rows() for splats that face away, most of which are hidden, and for all where sums are gathered
/// with care; with the same numbers.
static ALWAYS_INLINE void accumulate_few(const pass *p, uint32_t splat, uint32_t first_column,
                                         uint32_t columns, uint32_t rows, depth_test test, int what) {
    const ewa_tile *tile = p->tile;
    const ewa_record *r = &p->run->records[splat];
    const payload add =
        payload_load(p->view, r, &p->run->loads[splat], p->run->opacities, p->run->materials, splat, what);
    const wf end = wf_set(p->view->exponent_end);
    for (uint32_t i = first_column; i < first_column + columns; i++) {
        const column_terms c = column_start(r, r->key, r->key_x, (float)(EWA_BLOCK_PX * i));
        wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
        for (uint32_t k = 0; k < rows; k++, dy = wf_add(dy, wf_set(EWA_BLOCK_PX))) {
            const uint32_t row = box_row(r->box) + k, column = box_column(r->box) + i;
            const size_t at = ((size_t)row * tile->blocks_per_row + column) * EWA_BLOCK_LANES;
            const wf s = block_exponent(r, &c, dy), bound = wf_load(tile->nearest + at);
            wf key = wf_fma(wf_set(r->key_y), dy, c.key);
            if (test != PLAIN) key = clamped_key(r, key);
            wm counts = wm_and(wf_lt(s, end), wf_le(bound, key));
            if (what & BEYOND) counts = wm_and(counts, wf_lt(key, wf_load(tile->passed + at)));
            if (!wm_bits(counts)) continue;
            const bool is_back = box_back_facing(r->box);
            add_channels(visit_sums(tile, is_back, row, column), sums_for(tile, is_back), tile->channel_count,
                         wf_keep(counts, exponential(s, p->view->doublings)), &add,
                         what & ADD_DEPTH ? depth_share(p->view, key, bound, what) : wf_set(0), what);
        }
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
        if ((what) & BEYOND && box_hollow(p->run->records[splat].box)) return;                               \
        if (box_back_facing(p->run->records[splat].box))                                                     \
            name##_back_facing(p, splat, first_column, columns, rows, test);                                 \
        else                                                                                                 \
            accumulate_rows(p, splat, first_column, columns, rows, test, what);                              \
    }                                                                                                        \
    static void name(const pass *p) { for_each_splat(p, name##_rows); }

ACCUMULATE(add_color, 0)
ACCUMULATE(add_color_fine, ADD_FINE)
ACCUMULATE(add_color_depth, ADD_DEPTH)
ACCUMULATE(add_color_height, ADD_DEPTH | ORTHOGRAPHIC)
ACCUMULATE(add_normal, ADD_NORMAL)
ACCUMULATE(add_normal_fine, ADD_NORMAL | ADD_FINE)
ACCUMULATE(add_normal_depth, ADD_NORMAL | ADD_DEPTH)
ACCUMULATE(add_normal_height, ADD_NORMAL | ADD_DEPTH | ORTHOGRAPHIC)
ACCUMULATE(add_opacity, ADD_NORMAL | ADD_OPACITY)
ACCUMULATE(add_opacity_depth, ADD_NORMAL | ADD_OPACITY | ADD_DEPTH)
ACCUMULATE(add_opacity_height, ADD_NORMAL | ADD_OPACITY | ADD_DEPTH | ORTHOGRAPHIC)
ACCUMULATE(add_color_beyond, BEYOND)
ACCUMULATE(add_normal_beyond, ADD_NORMAL | BEYOND)
ACCUMULATE(add_opacity_beyond, ADD_NORMAL | ADD_OPACITY | BEYOND)
ACCUMULATE(add_material, ADD_NORMAL | ADD_MATERIAL)
ACCUMULATE(add_material_depth, ADD_NORMAL | ADD_MATERIAL | ADD_DEPTH)
ACCUMULATE(add_material_height, ADD_NORMAL | ADD_MATERIAL | ADD_DEPTH | ORTHOGRAPHIC)
ACCUMULATE(add_material_beyond, ADD_NORMAL | ADD_MATERIAL | BEYOND)
ACCUMULATE(add_all, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY)
ACCUMULATE(add_all_depth, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY | ADD_DEPTH)
ACCUMULATE(add_all_height, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY | ADD_DEPTH | ORTHOGRAPHIC)
ACCUMULATE(add_all_beyond, ADD_NORMAL | ADD_MATERIAL | ADD_OPACITY | BEYOND)

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
    if (tile->passed && box_hollow(p->run->records[splat].box)) return;
    accumulate_few(p, splat, first_column, columns, rows, test,
                   channels_of(tile) |
                       (tile->passed       ? BEYOND
                        : tile->with_depth ? ADD_DEPTH
                                           : 0) |
                       (p->view->orthographic ? ORTHOGRAPHIC : 0));
}

static void add_carefully(const pass *p) { for_each_splat(p, add_careful_rows); }

#endif
