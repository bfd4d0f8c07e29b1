// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: side accumulators of a surface, allocated block by block where they are needed:
// sums of back-facing splats and of clip-line coverage, and how they are merged at the end (docs/math.md
// sections 6 and 7; semantics.h: facing, clip lines).
#ifndef EWA_SRC_SURFACE_PIPELINE_SIDE_SUMS_H
#define EWA_SRC_SURFACE_PIPELINE_SIDE_SUMS_H

#include "surface/pipeline_clip.h"
#include "surface/pipeline_sums.h"

/// Channels of ewa_side_sums.cut.
enum { CUT_KEPT, CUT_WHOLE, CUT_X, CUT_Y };

/// The depth's channel.
static ALWAYS_INLINE uint32_t depth_channel(const ewa_tile *tile) { return tile->with_normals ? 7 : 4; }

/// visit_block() of sums that are only there in the blocks that `rows` marks; from now on in this one.
static ALWAYS_INLINE float *visit_marked(const ewa_tile *tile, const ewa_sums *of, uint32_t *rows,
                                         uint32_t row, uint32_t column, uint32_t channels) {
    if (!(rows[row] >> column & 1)) clear_block(tile, of, row, column, channels);
    rows[row] |= 1u << column;
    return visit_block(tile, of, row, column, channels);
}

/// Where a splat is summed that counts in a block.
static ALWAYS_INLINE float *visit_sums(const ewa_tile *tile, bool is_back, uint32_t row, uint32_t column) {
    const ewa_side_sums *side = &tile->side;
    if (is_back)
        return visit_marked(tile, &side->is_back, side->back_facing_rows, row, column, tile->channel_count);
    return visit_block(tile, &tile->sums, row, column, tile->channel_count);
}

/// Notes where clip lines cut a splat in a block. `whole` is its weight without them, in units, 0 where it
/// does not count.
static ALWAYS_INLINE void add_cut(const ewa_tile *tile, uint32_t row, uint32_t column, const ewa_clip *clip,
                                  const clip_sample *left, wf whole) {
    const wf zero = wf_set(0), one = wf_set(1);
    const wf off = wf_mul(wf_sub(one, left->share), wf_set((float)(1 / EWA_CUT)));
    const wf cut = wf_mul(wf_min(off, one), whole);
    if (!wm_bits(wf_lt(zero, cut))) return;
    const ewa_side_sums *side = &tile->side;
    float *sums = visit_marked(tile, &side->cut, side->cut_rows, row, column, EWA_CUT_CHANNELS);
    wf decides[2];
    for (int i = 0; i < 2; i++) decides[i] = clip->either ? left->line[i] : wf_sub(one, left->line[i]);
    wf sum = wf_add(decides[0], decides[1]);
    const ewa_clip_line *lines = clip->line;
    wf x = wf_fma(decides[0], wf_set(lines[0].x_inward), wf_mul(decides[1], wf_set(lines[1].x_inward)));
    wf y = wf_fma(decides[0], wf_set(lines[0].y_inward), wf_mul(decides[1], wf_set(lines[1].y_inward)));
    if (clip->count > 2 && clip->either) { // one line beside the others
        const wf off_first = wf_sub(one, left->first);
        const wf share = wf_div(off_first, wf_select(wf_lt(zero, sum), sum, one));
        x = wf_mul(x, share), y = wf_mul(y, share), sum = off_first;
    }
    for (uint32_t i = 2; i < clip->count; i++) {
        const wf decides_too = wf_sub(one, left->line[i]);
        x = wf_fma(decides_too, wf_set(lines[i].x_inward), x);
        y = wf_fma(decides_too, wf_set(lines[i].y_inward), y);
        sum = wf_add(sum, decides_too);
    }
    const wf scaled = wf_div(one, wf_select(wf_lt(zero, sum), sum, one));
    const wf parts[EWA_CUT_CHANNELS] = {[CUT_KEPT] = left->share,
                                        [CUT_WHOLE] = one,
                                        [CUT_X] = wf_mul(scaled, x),
                                        [CUT_Y] = wf_mul(scaled, y)};
    for (int c = 0; c < EWA_CUT_CHANNELS; c++)
        add_product(sums + (size_t)c * EWA_BLOCK_LANES, one, wf_odd_product(cut, parts[c]));
}

/// What sums of splats that face the viewer, of weight `front`, and of those that face away count in the surface's.
static ALWAYS_INLINE void facing_parts(const ewa_resolve *to, wf front, wf back, wf *of_front, wf *of_back) {
    const wf zero = wf_set(0), one = wf_set(1);
    const wm some_front = wf_lt(zero, front), some_back = wf_lt(zero, back);
    const wf share = wf_min(wf_mul(front, wf_set(to->front_scale)), one), all = wf_add(front, back);
    const wf behind = wf_keep(some_back, wf_sub(one, share));
    *of_front = wf_keep(some_front, wf_div(wf_mul(all, wf_sub(one, behind)), wf_select(some_front, front, one)));
    *of_back = wf_div(wf_mul(all, behind), wf_select(some_back, back, one));
}

/// Joins a block's sums, those of the splats that face the viewer, with those of the splats that face away.
/// `merged`: of all surfaces that are left, not of one.
static ALWAYS_INLINE void join_back_facing(const ewa_tile *tile, const ewa_resolve *to, const float *is_back,
                                           float *sums, bool merged) {
    wf of_front = wf_set(1), of_back = wf_set(1);
    if (!merged) facing_parts(to, wf_load(sums), wf_load(is_back), &of_front, &of_back);
    for (uint32_t c = 0; c < tile->channel_count; c++) {
        float *plane = sums + (size_t)c * EWA_BLOCK_LANES;
        const wf other = wf_load(is_back + (size_t)c * EWA_BLOCK_LANES);
        wf_store(plane, wf_fma(of_back, other, wf_mul(of_front, wf_load(plane))));
    }
}

/// Replaces what is noted of a block's clip lines by the share of each pixel that the surface covers, and the
/// mean direction of all its splats.
static ALWAYS_INLINE void cover_cut(const ewa_resolve *to, const float *sums, float *cut) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf zero = wf_set(0), one = wf_set(1), q = wf_load(sums), minimum = wf_set(to->covering);
    const wf whole = wf_load(cut + CUT_WHOLE * LANES), x = wf_load(cut + CUT_X * LANES),
             y = wf_load(cut + CUT_Y * LANES);
    const wf uncut = wf_max(wf_sub(q, wf_load(cut + CUT_KEPT * LANES)), zero);
    const wm some = wf_lt(zero, whole);
    const wf along = wf_div(wf_sqrt(wf_fma(x, x, wf_mul(y, y))), wf_select(some, whole, one));
    const wf slope = wf_set((float)(1 / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE)));
    const wf alone = wf_clamp(wf_mul(wf_sub(along, wf_set((float)EWA_EDGES_OPPOSE)), slope), 0, 1);
    const wf expected = wf_max(wf_fma(alone, whole, uncut), minimum);
    const wf covered = wf_max(wf_mul(uncut, wf_set(to->alpha_scale)), wf_div(q, expected));
    wf_store(cut, wf_min(covered, one));
    const wf per = wf_keep(some, wf_div(one, wf_add(uncut, wf_select(some, whole, one))));
    wf_store(cut + CUT_X * LANES, wf_mul(x, per));
    wf_store(cut + CUT_Y * LANES, wf_mul(y, per));
}

/// The units in channel `channel` of a block whose planes begin at `first`, with what they leave.
static ALWAYS_INLINE wf read_finely(const ewa_sums *of, size_t first, uint32_t channel, bool has_high) {
    const size_t at = first + channel * EWA_BLOCK_LANES;
    const wf units = read_units(of->planes + at, of->high + at, has_high);
    const wf left = read_units(of->planes + at + of->fine, of->high + at + of->fine, has_high);
    return wf_fma(left, wf_set(FINE_UNIT), units);
}

/// Turns a block's sums into floats that begin at 0.
static ALWAYS_INLINE void finalize_planes(const ewa_tile *tile, const ewa_sums *of, uint32_t row,
                                        uint32_t column, uint32_t channels, bool finely) {
    const size_t first = first_number(tile, row, column, channels);
    const bool has_high = of->high_rows[row] >> column & 1;
    for (uint32_t c = 0; c < channels; c++) {
        const size_t at = first + c * EWA_BLOCK_LANES;
        const wf units = finely ? read_finely(of, first, c, has_high)
                                : read_units(of->planes + at, of->high + at, has_high);
        wf_store(of->planes + at, units);
    }
}

/// The mean depth of a block; their weights are finer than those of colours, which no
/// plane that is wanted beside them changes.
static ALWAYS_INLINE wf mean_depth(const ewa_tile *tile, const ewa_sums *of, const ewa_resolve *to,
                                   uint32_t row, uint32_t column) {
    const size_t first = first_number(tile, row, column, tile->channel_count);
    const bool has_high = of->high_rows[row] >> column & 1;
    const wf weight = read_finely(of, first, 0, has_high), zero = wf_set(0);
    const wm some = wf_lt(zero, weight);
    const wf share = wf_keep(some, wf_div(read_finely(of, first, depth_channel(tile), has_high),
                                          wf_select(some, weight, wf_set(1))));
    if (to->orthographic) return wf_mul(share, wf_set(to->depth_per_share));
    // Of the largest that counts.
    const wf nearest = wf_load(tile->nearest + first_number(tile, row, column, 1));
    const wm seen = wf_lt(zero, nearest);
    return wf_keep(seen, wf_div(share, wf_select(seen, nearest, wf_set(1))));
}

/// The sums of a block, or of its splats that face away.
static ALWAYS_INLINE void finalize_sums(const ewa_tile *tile, const ewa_sums *of, const ewa_resolve *to,
                                      uint32_t row, uint32_t column, bool finely) {
    const uint32_t channels = tile->channel_count;
    const wf depth = tile->with_depth ? mean_depth(tile, of, to, row, column) : wf_set(0);
    finalize_planes(tile, of, row, column, channels, finely);
    if (!tile->with_depth) return;
    float *planes = of->planes + first_number(tile, row, column, channels);
    wf_store(planes + depth_channel(tile) * EWA_BLOCK_LANES, wf_mul(depth, wf_load(planes)));
}

/// A block of a surface, when all of it is gathered.
static ALWAYS_INLINE void finalize_block(const ewa_tile *tile, const ewa_resolve *to, uint32_t row,
                                       uint32_t column, bool merged) {
    const ewa_side_sums *side = &tile->side;
    const size_t first = first_number(tile, row, column, tile->channel_count);
    const bool cut = side->cut_rows && side->cut_rows[row] >> column & 1;
    finalize_sums(tile, &tile->sums, to, row, column, tile->with_fine || cut);
    if (side->back_facing_rows[row] >> column & 1) {
        finalize_sums(tile, &side->is_back, to, row, column, tile->with_fine || cut);
        join_back_facing(tile, to, side->is_back.planes + first, tile->sums.planes + first, merged);
    }
    if (cut) {
        finalize_planes(tile, &side->cut, row, column, EWA_CUT_CHANNELS, false);
        if (!merged)
            cover_cut(to, tile->sums.planes + first,
                      side->cut.planes + first_number(tile, row, column, EWA_CUT_CHANNELS));
    }
}

/// The blocks of a row whose sums are not all there is to them; others stay as they are.
static ALWAYS_INLINE uint32_t rows_to_finalize(const ewa_tile *tile, uint32_t row) {
    const ewa_side_sums *side = &tile->side;
    if (tile->with_fine || tile->with_depth) return ~0u;
    return side->back_facing_rows[row] | (side->cut_rows ? side->cut_rows[row] : 0) |
           tile->sums.high_rows[row];
}

/// The finalized planes of a block where clip lines have a say, else NULL: first of all the covered shares.
static ALWAYS_INLINE const float *cut_cover(const ewa_tile *tile, uint32_t row, uint32_t column) {
    const ewa_side_sums *side = &tile->side;
    if (!side->cut_rows || !(side->cut_rows[row] >> column & 1)) return NULL;
    return side->cut.planes +
           ((size_t)row * tile->blocks_per_row + column) * EWA_CUT_CHANNELS * EWA_BLOCK_LANES;
}

#endif
