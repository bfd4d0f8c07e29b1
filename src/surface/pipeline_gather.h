// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: back from a picture to the colours of its splats (docs/math.md section 15), surface by
// surface. A splat's sum over its pixels of its kernel times what the loss changes there is gathered in whole numbers
// of units, lane by lane, which no order of the splats and no tile changes. What the loss changes may be made of what
// other colours show, which are spread over the pixels first.
#ifndef EWA_SRC_SURFACE_PIPELINE_GATHER_H
#define EWA_SRC_SURFACE_PIPELINE_GATHER_H

#include "surface/pipeline_near.h"
#include "surface/pipeline_resolve.h"

/// Of a block's planes: the keys from which on and below which splats count, what the loss changes per unit of the weight
/// of a splat that faces the viewer, and of one that faces away, and what other colours show.
enum { GATHER_BOUND, GATHER_PASSED, GATHER_FRONT, GATHER_BACK = GATHER_FRONT + 3, GATHER_SHOWN = GATHER_BACK + 3 };

/// The planes of a block.
static ALWAYS_INLINE float *gather_planes(const ewa_tile *tile, uint32_t row, uint32_t column) {
    return tile->gather->planes + first_number(tile, row, column, EWA_GATHER_PLANES);
}

/// A block's weights of pixels; 0 outside of the picture.
static ALWAYS_INLINE wf load_weights(const ewa_gather *from, const ewa_resolve *to, const block_place *at) {
    float lanes[EWA_BLOCK_LANES] = {0};
    for (uint32_t y = 0; y < at->height; y++)
        for (uint32_t x = 0; x < at->width; x++)
            lanes[y * EWA_BLOCK_PX + x] =
                from->weights ? from->weights[(size_t)(at->y + y) * to->width_px + at->x + x] : 1;
    return wf_load(lanes);
}

/// The cotangents of a block's colours; 0 outside of the picture. Of other colours they are known when these have been
/// spread: 1 until then.
static ALWAYS_INLINE void load_cotangents(const ewa_gather *from, const ewa_resolve *to, const block_place *at,
                                          wf color[3]) {
    float lanes[3][EWA_BLOCK_LANES] = {{0}};
    if (from->colors || !from->rgba) {
        const wf weight = from->colors ? wf_set(1) : load_weights(from, to, at);
        for (int c = 0; c < 3; c++) color[c] = weight;
        return;
    }
    for (uint32_t y = 0; y < at->height; y++)
        for (uint32_t x = 0; x < at->width; x++)
            for (uint32_t c = 0; c < 3; c++)
                lanes[c][y * EWA_BLOCK_PX + x] =
                    from->rgba[4 * ((size_t)(at->y + y) * to->width_px + at->x + x) + c];
    for (int c = 0; c < 3; c++) color[c] = wf_load(lanes[c]);
}

/// Sets the planes of a block: what the loss changes per unit of a kernel there. `of`: the surface's sums, settled, beside
/// those of its splats that face away; `share`: what the pixel shows of it; `merged`: it is all that is left. Splats count
/// from the key `bound` to below `passed`.
static ALWAYS_INLINE void set_gather_block(const ewa_tile *tile, const ewa_resolve *to, const ewa_side_sums *of,
                                           const block_sums *sums, wf share, bool merged, uint32_t row,
                                           uint32_t column, wf bound, wf passed) {
    enum { LANES = EWA_BLOCK_LANES };
    const ewa_gather *gather = tile->gather;
    const block_place at = place_of(tile, row, column);
    const wf weight = sum_of(sums, 0);
    wf color[3], factor = inverse_weight(sum_of(sums, color_weight(tile)));
    if (to->shading == EWA_PIPELINE_LAMBERT) {
        wf normal[3];
        for (int i = 0; i < 3; i++) normal[i] = sum_of(sums, 4 + (uint32_t)i);
        factor = wf_mul(factor, lambert(to, normal, weight, at.x, at.y));
    }
    factor = wf_mul(factor, share);
    load_cotangents(gather, to, &at, color);
    wf of_front = wf_set(1), of_back = wf_set(1);
    if (of->back_facing_rows[row] >> column & 1 && !merged) {
        const wf back = wf_load(of->is_back.planes + first_number(tile, row, column, tile->channel_count));
        facing_parts(to, wf_max(wf_sub(weight, back), wf_set(0)), back, &of_front, &of_back);
    }
    of_front = wf_mul(of_front, factor), of_back = wf_mul(of_back, factor);
    if (gather->squares) of_front = wf_mul(of_front, of_front), of_back = wf_mul(of_back, of_back);
    float *planes = gather_planes(tile, row, column);
    // Where no source that hides has a surface, nothing is summed.
    const wf never = wf_set(__builtin_inff());
    wf_store(planes + GATHER_BOUND * LANES, wf_select(wf_lt(wf_set(-__builtin_inff()), bound), bound, never));
    wf_store(planes + GATHER_PASSED * LANES, passed);
    for (int c = 0; c < 3; c++) {
        const wf by_color = wf_mul(color[c], wf_set(gather->colors ? 1 : gather->units));
        wf_store(planes + (GATHER_FRONT + c) * LANES, wf_mul(by_color, of_front));
        wf_store(planes + (GATHER_BACK + c) * LANES, wf_mul(by_color, of_back));
        wf_store(planes + (GATHER_SHOWN + c) * LANES, wf_set(0));
    }
    gather->rows[row] |= 1u << column;
}

static void set_gather(const ewa_tile *tile, const ewa_resolve *to) {
    const wf minimum = wf_set(tile->gather->minimum_alpha), all = wf_set(__builtin_inff());
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        tile->gather->rows[row] = 0;
        for (uint32_t column = 0; column < tile->blocks_per_row; column++) {
            const block_sums sums = tile_block(tile, row, column);
            const wf alpha = surface_alpha(tile, to, &sums, cut_cover(tile, row, column));
            wf share = alpha;
            if (tile->gather->filled) share = wf_keep(wf_le(minimum, alpha), wf_set(1));
            if (!wm_bits(wf_lt(wf_set(0), share))) continue;
            const wf bound = wf_load(tile->nearest + first_number(tile, row, column, 1));
            set_gather_block(tile, to, &tile->side, &sums, share, false, row, column, bound, all);
        }
    }
}

/// Where a splat's key counts in a block.
static ALWAYS_INLINE wm gather_counts(const float *planes, wf key) {
    return wm_and(wf_le(wf_load(planes + GATHER_BOUND * EWA_BLOCK_LANES), key),
                  wf_lt(key, wf_load(planes + GATHER_PASSED * EWA_BLOCK_LANES)));
}

/// The planes of the side that a splat shows.
static ALWAYS_INLINE size_t gather_side(bool is_back) {
    return (size_t)(is_back ? GATHER_BACK : GATHER_FRONT) * EWA_BLOCK_LANES;
}

/// A splat of a run on its way through its blocks.
typedef struct gathered_splat {
    const ewa_record *record;
    const ewa_clip *clip; ///< NULL: it has none
    wf peak;              ///< of the kernel that weighs colours
    size_t side;
} gathered_splat;

static ALWAYS_INLINE gathered_splat gather_start(const ewa_sorted_run *run, uint32_t splat) {
    const ewa_record *r = &run->records[splat];
    return (gathered_splat){r, box_clipped(r->box) ? &run->clips[splat] : NULL,
                            wf_set(run->opacities ? run->opacities[splat] : run->loads[splat].peak),
                            gather_side(box_back_facing(r->box))};
}

/// The kernel of a splat in a block, 0 where it does not count; false: nowhere.
static ALWAYS_INLINE bool gather_weight(const ewa_view *view, const ewa_tile *tile, const gathered_splat *splat,
                                        const column_terms *c, wf dy, uint32_t row, uint32_t column, wf *weight) {
    if (!(tile->gather->rows[row] >> column & 1)) return false;
    const ewa_record *r = splat->record;
    const wf s = block_exponent(r, c, dy), plane = wf_fma(wf_set(r->key_y), dy, c->key);
    const wf key = box_steep(r->box) ? clamped_key(r, plane) : plane;
    wm counts = wm_and(wf_lt(s, wf_set(view->exponent_end)), gather_counts(gather_planes(tile, row, column), key));
    wf share = wf_set(1);
    if (splat->clip) {
        share = clip_block(tile, splat->clip, row, column).share;
        counts = wm_and(counts, wf_lt(wf_set(0), share));
    }
    if (!wm_bits(counts)) return false;
    const wf bell = exponential(wf_keep(counts, s), view->doublings);
    *weight = wf_keep(counts, wf_mul(wf_mul(bell, splat->peak), share));
    if (tile->gather->squares) *weight = wf_mul(*weight, *weight);
    return true;
}

/// The kernel of a near surfel in a block, likewise.
static ALWAYS_INLINE bool near_gather_weight(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *r,
                                             uint32_t row, uint32_t column, wf *weight) {
    if (!(tile->gather->rows[row] >> column & 1)) return false;
    const near_sample sample = near_block(view, tile, r, row, column);
    const wm counts =
        wm_and(sample.counts, gather_counts(gather_planes(tile, row, column), key_of_depth(view, sample.z)));
    if (!wm_bits(counts)) return false;
    wf found = wf_mul(wf_keep(counts, sample.weight), wf_set(view->sum_scale));
    if (tile->with_opacity) found = wf_mul(found, wf_set(r->opacity));
    found = wf_mul(found, exponential(wf_keep(counts, sample.exponent), view->doublings));
    *weight = r->clipped ? wf_mul(found, wf_keep(counts, sample.left.share)) : found;
    if (tile->gather->squares) *weight = wf_mul(*weight, *weight);
    return true;
}

/// Whether a splat may count in the surface at hand.
static ALWAYS_INLINE bool is_gathered(const ewa_tile *tile, const ewa_record *r) {
    return !(tile->gather->beyond && box_is_concave(r->box));
}

/// Adds weight x planes, rounded, to sums of whole numbers.
static ALWAYS_INLINE void gather_block(const float *planes, wf weight, wi sums[3]) {
    for (int c = 0; c < 3; c++) {
        const wf whole = wf_fma(weight, wf_load(planes + c * EWA_BLOCK_LANES), wf_set(BIAS));
        sums[c] = wi_add(sums[c], wi_sub(wi_of_bits(whole), wi_set(BIAS_BITS)));
    }
}

/// Adds to a sum of a surfel. Several tiles may do so at a time: whole numbers, in any order.
static ALWAYS_INLINE void add_to_surfel(const ewa_tile *tile, uint32_t surfel, int c, int64_t sum) {
    int64_t *to = &tile->gather->sums[3 * (size_t)surfel + (size_t)c];
    if (!sum) return; // adding 0 in two steps would undo what another tile adds in between
    if (tile->gather->shared[surfel / EWA_PACKET_LANES])
        __atomic_fetch_add(to, sum, __ATOMIC_RELAXED);
    else
        *to += sum;
}

/// Gives a surfel what has been gathered.
static void gather_surfel(const ewa_tile *tile, uint32_t surfel, const wi sums[3]) {
    for (int c = 0; c < 3; c++) {
        int32_t lanes[EWA_BLOCK_LANES];
        wi_store(lanes, sums[c]);
        int64_t sum = 0;
        for (int i = 0; i < EWA_BLOCK_LANES; i++) sum += lanes[i];
        add_to_surfel(tile, surfel, c, sum);
    }
}

/// What has been gathered for up to sixteen surfels of few blocks, whose lanes' sums have room in a lane.
typedef struct gathered_few {
    wf lanes[3][EWA_BLOCK_LANES]; ///< bits of integers
    uint32_t surfels[EWA_BLOCK_LANES], count;
} gathered_few;

enum { FEW_BLOCKS = (1 << 30) / EWA_BLOCK_LANES >> EWA_GATHER_BITS };

static ALWAYS_INLINE void give_few(const ewa_tile *tile, gathered_few *few) {
    for (int c = 0; c < 3; c++) {
        for (uint32_t i = few->count; i < EWA_BLOCK_LANES; i++) few->lanes[c][i] = wf_set(0);
        w_transpose(few->lanes[c]);
        wi sum = wi_of_bits(few->lanes[c][0]);
        for (int i = 1; i < EWA_BLOCK_LANES; i++) sum = wi_add(sum, wi_of_bits(few->lanes[c][i]));
        int32_t sums[EWA_BLOCK_LANES];
        wi_store(sums, sum);
        for (uint32_t i = 0; i < few->count; i++) add_to_surfel(tile, few->surfels[i], c, sums[i]);
    }
    few->count = 0;
}

/// Gives a surfel what has been gathered of so many blocks.
static ALWAYS_INLINE void give_surfel(const ewa_tile *tile, gathered_few *few, uint32_t surfel, uint32_t blocks,
                                      const wi sums[3]) {
    if (blocks > FEW_BLOCKS) {
        gather_surfel(tile, surfel, sums);
        return;
    }
    for (int c = 0; c < 3; c++) few->lanes[c][few->count] = wf_of_bits(sums[c]);
    few->surfels[few->count++] = surfel;
    if (few->count == EWA_BLOCK_LANES) give_few(tile, few);
}

/// Adds a surfel's colour to what a block's pixels show.
static ALWAYS_INLINE void spread_block(const float *color, float *planes, size_t side, wf weight) {
    const wf share = wf_mul(weight, wf_load(planes + side));
    float *shown = planes + GATHER_SHOWN * EWA_BLOCK_LANES;
    for (int c = 0; c < 3; c++, shown += EWA_BLOCK_LANES)
        wf_store(shown, wf_fma(share, wf_set(color[c]), wf_load(shown)));
}

static ALWAYS_INLINE const float *color_of(const ewa_tile *tile, uint32_t surfel) {
    return tile->gather->colors + 4 * (size_t)surfel;
}

/// One pass back over a run.
typedef struct back_pass {
    pass run;
    gathered_few *few; ///< NULL: colours are spread
} back_pass;

/// gather_weight() with its block, column by column of constant count, for cutoffs up to 3.
static ALWAYS_INLINE void back_rows(const pass *p, uint32_t splat, uint32_t first_column, uint32_t columns, uint32_t rows,
                                    depth_test test, bool spreads) {
    const ewa_tile *tile = p->tile;
    const gathered_splat at = gather_start(p->run, splat);
    const ewa_record *r = at.record;
    if (!is_gathered(tile, r)) return;
    column_terms c[EWA_COLUMN_CLASSES];
    UNROLL_COLUMNS
    for (uint32_t i = 0; i < columns; i++)
        c[i] = column_start(r, r->key, r->key_x, (float)(EWA_BLOCK_PX * (first_column + i)));
    const uint32_t surfel = p->run->surfels[splat], column = box_column(r->box) + first_column;
    const wf end = wf_set(p->view->exponent_end);
    const bool squares = tile->gather->squares;
    enum { FLOATS = EWA_GATHER_PLANES * EWA_BLOCK_LANES };
    float *planes = gather_planes(tile, box_row(r->box), column);
    const uint32_t *marks = tile->gather->rows + box_row(r->box);
    const float *color = spreads ? color_of(tile, surfel) : NULL;
    wi sums[3] = {wi_set(0), wi_set(0), wi_set(0)};
    bool any = false;
    wf dy = wf_add(lanes_y(), wf_set(r->offset_y));
    UNROLL_COLUMNS
    for (uint32_t row = 0; row < rows; row++, dy = wf_add(dy, wf_set(EWA_BLOCK_PX))) {
        const uint32_t marked = marks[row] >> column;
        UNROLL_COLUMNS
        for (uint32_t i = 0; i < columns; i++) {
            if (!(marked >> i & 1)) continue;
            float *block = planes + (size_t)i * FLOATS;
            const wf s = block_exponent(r, &c[i], dy), plane = wf_fma(wf_set(r->key_y), dy, c[i].key);
            const wm counts = wm_and(wf_lt(s, end), gather_counts(block, test == PLAIN ? plane : clamped_key(r, plane)));
            if (!wm_bits(counts)) continue;
            wf weight = wf_keep(counts, wf_mul(exponential(s, 2), at.peak));
            if (squares) weight = wf_mul(weight, weight);
            if (spreads)
                spread_block(color, block, at.side, weight);
            else
                gather_block(block + at.side, weight, sums);
            any = true;
        }
        planes += (size_t)tile->blocks_per_row * FLOATS;
    }
    if (any && !spreads) give_surfel(tile, ((const back_pass *)p)->few, surfel, rows * columns, sums);
}

static ALWAYS_INLINE void gather_rows(const pass *p, uint32_t splat, uint32_t first_column, uint32_t columns,
                                      uint32_t rows, depth_test test) {
    back_rows(p, splat, first_column, columns, rows, test, false);
}

static ALWAYS_INLINE void spread_rows(const pass *p, uint32_t splat, uint32_t first_column, uint32_t columns,
                                      uint32_t rows, depth_test test) {
    back_rows(p, splat, first_column, columns, rows, test, true);
}

/// The splats of a run from place `first` of its order on, block by block.
static ALWAYS_INLINE void back_any(const back_pass *p, uint32_t first, bool spreads) {
    const ewa_tile *tile = p->run.tile;
    const ewa_sorted_run *run = p->run.run;
    for (uint32_t i = first; i < run->class_first[EWA_CLASS_COUNT]; i++) {
        const gathered_splat splat = gather_start(run, run->order[i]);
        const ewa_record *r = splat.record;
        const uint32_t surfel = run->surfels[run->order[i]];
        if (!is_gathered(tile, r)) continue;
        wi sums[3] = {wi_set(0), wi_set(0), wi_set(0)};
        bool any = false;
        for (uint32_t k = 0; k < ewa_box_columns(r->box); k++) {
            const uint32_t column = box_column(r->box) + k;
            const column_terms c = column_start(r, r->key, r->key_x, (float)(EWA_BLOCK_PX * k));
            wf dy = wf_add(lanes_y(), wf_set(r->offset_y)), weight;
            for (uint32_t n = 0; n < ewa_box_rows(r->box); n++, dy = wf_add(dy, wf_set(EWA_BLOCK_PX))) {
                const uint32_t row = box_row(r->box) + n;
                if (!gather_weight(p->run.view, tile, &splat, &c, dy, row, column, &weight)) continue;
                float *planes = gather_planes(tile, row, column);
                if (spreads)
                    spread_block(color_of(tile, surfel), planes, splat.side, weight);
                else
                    gather_block(planes + splat.side, weight, sums);
                any = true;
            }
        }
        if (any && !spreads) give_surfel(tile, p->few, surfel, ewa_box_columns(r->box) * ewa_box_rows(r->box), sums);
    }
}

static void gather(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run) {
    static_assert(((int64_t)EWA_MAX_TILE_BLOCKS * EWA_MAX_TILE_BLOCKS << EWA_GATHER_BITS) < INT32_MAX, "lanes have room");
    gathered_few few = {.count = 0};
    const back_pass p = {{view, tile, run}, &few};
    const bool plain = view->doublings == 2;
    if (plain) for_each_splat(&p.run, gather_rows);
    back_any(&p, plain ? run->class_first[EWA_CLIP_CLASS] : 0, false);
    if (few.count) give_few(tile, &few);
}

static void spread(const ewa_view *view, const ewa_tile *tile, const ewa_sorted_run *run) {
    const back_pass p = {{view, tile, run}, NULL};
    const bool plain = view->doublings == 2;
    if (plain) for_each_splat(&p.run, spread_rows);
    back_any(&p, plain ? run->class_first[EWA_CLIP_CLASS] : 0, true);
}

static void near_gather(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const ewa_near_record *r = &records[i];
        const size_t side = gather_side(r->is_back);
        wi sums[3] = {wi_set(0), wi_set(0), wi_set(0)};
        wf weight;
        for (uint32_t row = 0; row < tile->block_rows; row++)
            for (uint32_t column = 0; column < tile->blocks_per_row; column++)
                if (near_gather_weight(view, tile, r, row, column, &weight))
                    gather_block(gather_planes(tile, row, column) + side, weight, sums);
        gather_surfel(tile, r->surfel, sums);
    }
}

static void near_spread(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records, uint32_t count) {
    wf weight;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t row = 0; row < tile->block_rows; row++)
            for (uint32_t column = 0; column < tile->blocks_per_row; column++)
                if (near_gather_weight(view, tile, &records[i], row, column, &weight))
                    spread_block(color_of(tile, records[i].surfel), gather_planes(tile, row, column),
                                 gather_side(records[i].is_back), weight);
}

static void turn_gather(const ewa_tile *tile, const ewa_resolve *to) {
    enum { LANES = EWA_BLOCK_LANES };
    const ewa_gather *gather = tile->gather;
    for (uint32_t row = 0; row < tile->block_rows; row++)
        for (uint32_t left = gather->rows[row]; left; left &= left - 1) {
            const uint32_t column = (uint32_t)__builtin_ctz(left);
            const block_place at = place_of(tile, row, column);
            float *planes = gather_planes(tile, row, column);
            const wm counts = wf_lt(wf_set(0), wf_add(wf_load(planes + GATHER_FRONT * LANES),
                                                      wf_load(planes + GATHER_BACK * LANES)));
            const wf weight = wf_mul(load_weights(gather, to, &at), wf_set(gather->units));
            wf color[4] = {[3] = wf_keep(counts, wf_set(1))};
            for (int c = 0; c < 3; c++) {
                float *front = planes + (GATHER_FRONT + c) * LANES, *back = planes + (GATHER_BACK + c) * LANES;
                color[c] = wf_load(planes + (GATHER_SHOWN + c) * LANES);
                const wf by_color = wf_mul(color[c], weight);
                wf_store(front, wf_mul(wf_load(front), by_color));
                wf_store(back, wf_mul(wf_load(back), by_color));
            }
            if (gather->shown) store_colors(gather->shown, to->width_px, &at, color);
        }
}

#endif
