// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h and of pipeline_add.h: what the passes over a tile's records are made of (docs/math.md section 6).
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
static ALWAYS_INLINE bool box_is_concave(uint32_t box) { return box & EWA_CONCAVE_BIT; }
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
    if (box_is_concave(p->run->records[splat].box)) return;
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

typedef void add_run(const pass *p);

/// What is particular to the sums of a run: those of ewa_add_color and its like.
typedef enum add_kind {
    ADD_WITHOUT_DEPTH,
    ADD_WITH_DEPTH,
    ADD_WITH_HEIGHT, ///< depths of an orthographic camera
    ADD_BEYOND,
    ADD_FINELY, ///< without edge antialiasing; of colours and of normals only
    ADD_KINDS
} add_kind;

/// The second pass over splats of the classes of boxes, by what is added: compile units of their own, because they take
/// the longest (pipeline_add_*_body.h).
extern add_run *const EWA_VERSION(ewa_add_color)[ADD_KINDS], *const EWA_VERSION(ewa_add_normal)[ADD_KINDS],
    *const EWA_VERSION(ewa_add_opacity)[ADD_KINDS], *const EWA_VERSION(ewa_add_material)[ADD_KINDS],
    *const EWA_VERSION(ewa_add_all)[ADD_KINDS];

#endif
