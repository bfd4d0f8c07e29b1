// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: what is gathered beside a surface's sums, block by block where there is some, and what
// it makes of them in the end (docs/math.md sections 6 and 7; semantics.h: facing, clip lines).
#ifndef EWA_SRC_KERNELS_ROAD_APART_H
#define EWA_SRC_KERNELS_ROAD_APART_H

#include "kernels/road_clip.h"

/// Channels of ewa_apart.cut.
enum { CUT_KEPT, CUT_WHOLE, CUT_X, CUT_Y };

/// The planes of a block among those that are only there where `rows` says so; from now on they are.
static ALWAYS_INLINE float *marked_block(float *planes, uint32_t *rows, const ewa_tile *tile, uint32_t row,
                                         uint32_t column, uint32_t channels) {
    float *block = planes + ((size_t)row * tile->blocks_per_row + column) * channels * EWA_BLOCK_LANES;
    if (rows[row] >> column & 1) return block;
    rows[row] |= 1u << column;
    for (uint32_t c = 0; c < channels; c++) wf_store(block + c * EWA_BLOCK_LANES, wf_set(0));
    return block;
}

/// Where a splat is summed that counts in a block.
static ALWAYS_INLINE float *block_sums(const ewa_tile *tile, bool turned, uint32_t row, uint32_t column) {
    if (turned)
        return marked_block(tile->apart.turned, tile->apart.turned_rows, tile, row, column,
                            tile->channel_count);
    return tile->sums + ((size_t)row * tile->blocks_per_row + column) * tile->channel_count * EWA_BLOCK_LANES;
}

static ALWAYS_INLINE void add_plane(float *sums, int channel, wf value) {
    float *plane = sums + (size_t)channel * EWA_BLOCK_LANES;
    wf_store(plane, wf_add(wf_load(plane), value));
}

/// Notes where clip lines cut a splat in a block. `whole` is its weight without them, 0 where it does not
/// count.
static ALWAYS_INLINE void add_cut(const ewa_tile *tile, uint32_t row, uint32_t column, const ewa_clip *clip,
                                  const clip_sample *left, wf whole) {
    const wf zero = wf_set(0), one = wf_set(1);
    const wf off = wf_mul(wf_sub(one, left->share), wf_set((float)(1 / EWA_CUT)));
    const wf cut = wf_mul(wf_min(off, one), whole);
    if (!wm_bits(wf_lt(zero, cut))) return;
    float *sums = marked_block(tile->apart.cut, tile->apart.cut_rows, tile, row, column, EWA_CUT_CHANNELS);
    wf decides[2];
    for (int i = 0; i < 2; i++) decides[i] = clip->either ? left->line[i] : wf_sub(one, left->line[i]);
    const wf sum = wf_add(decides[0], decides[1]);
    const wf scaled = wf_div(cut, wf_select(wf_lt(zero, sum), sum, one));
    const ewa_clip_line *lines = clip->line;
    add_plane(sums, CUT_KEPT, wf_mul(cut, left->share));
    add_plane(sums, CUT_WHOLE, cut);
    add_plane(sums, CUT_X,
              wf_mul(scaled, wf_fma(decides[0], wf_set(lines[0].x_inward),
                                    wf_mul(decides[1], wf_set(lines[1].x_inward)))));
    add_plane(sums, CUT_Y,
              wf_mul(scaled, wf_fma(decides[0], wf_set(lines[0].y_inward),
                                    wf_mul(decides[1], wf_set(lines[1].y_inward)))));
}

/// Joins a block's sums, those of the splats that face the viewer, with those of the splats that face away.
/// `merged`: of all surfaces that are left, not of one.
static ALWAYS_INLINE void join_turned(const ewa_tile *tile, const ewa_resolve *to, const float *turned,
                                      float *sums, bool merged) {
    const wf zero = wf_set(0), one = wf_set(1), front = wf_load(sums), back = wf_load(turned);
    wf shown = one, scale = one;
    if (!merged) {
        shown = wf_max(wf_sub(one, wf_mul(front, wf_set(to->front_scale))), zero);
        const wf mixed = wf_fma(shown, back, front);
        const wm some = wf_lt(zero, mixed);
        scale = wf_keep(some, wf_div(wf_add(front, back), wf_select(some, mixed, one)));
    }
    for (uint32_t c = 0; c < tile->channel_count; c++) {
        float *plane = sums + (size_t)c * EWA_BLOCK_LANES;
        const wf other = wf_load(turned + (size_t)c * EWA_BLOCK_LANES);
        wf_store(plane, wf_mul(scale, wf_fma(shown, other, wf_load(plane))));
    }
}

/// Replaces what is noted of a block's clip lines by the share of each pixel that the surface covers, and the
/// mean direction of all its splats.
static ALWAYS_INLINE void cover_cut(const ewa_resolve *to, const float *sums, float *cut) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf zero = wf_set(0), one = wf_set(1), q = wf_load(sums), least = wf_set(to->covering);
    const wf whole = wf_load(cut + CUT_WHOLE * LANES), x = wf_load(cut + CUT_X * LANES),
             y = wf_load(cut + CUT_Y * LANES);
    const wf uncut = wf_max(wf_sub(q, wf_load(cut + CUT_KEPT * LANES)), zero);
    const wm some = wf_lt(zero, whole);
    const wf along = wf_div(wf_sqrt(wf_fma(x, x, wf_mul(y, y))), wf_select(some, whole, one));
    const wf slope = wf_set((float)(1 / (EWA_EDGES_AGREE - EWA_EDGES_OPPOSE)));
    const wf alone = wf_clamp(wf_mul(wf_sub(along, wf_set((float)EWA_EDGES_OPPOSE)), slope), 0, 1);
    const wf expected = wf_max(wf_fma(alone, whole, uncut), least);
    const wf covered = wf_max(wf_mul(uncut, wf_set(to->alpha_scale)), wf_div(q, expected));
    wf_store(cut, wf_min(covered, one));
    const wf per = wf_keep(some, wf_div(one, wf_add(uncut, wf_select(some, whole, one))));
    wf_store(cut + CUT_X * LANES, wf_mul(x, per));
    wf_store(cut + CUT_Y * LANES, wf_mul(y, per));
}

/// A block of a surface, when all of it is gathered.
static ALWAYS_INLINE void settle_block(const ewa_tile *tile, const ewa_resolve *to, uint32_t row,
                                       uint32_t column, bool merged) {
    const size_t block = (size_t)row * tile->blocks_per_row + column;
    const ewa_apart *apart = &tile->apart;
    float *sums = tile->sums + block * tile->channel_count * EWA_BLOCK_LANES;
    if (apart->turned_rows[row] >> column & 1)
        join_turned(tile, to, apart->turned + block * tile->channel_count * EWA_BLOCK_LANES, sums, merged);
    if (!merged && apart->cut_rows && apart->cut_rows[row] >> column & 1)
        cover_cut(to, sums, apart->cut + block * EWA_CUT_CHANNELS * EWA_BLOCK_LANES);
}

static void settle(const ewa_tile *tile, const ewa_resolve *to) {
    const ewa_apart *apart = &tile->apart;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        uint32_t some = apart->turned_rows[row] | (apart->cut_rows ? apart->cut_rows[row] : 0);
        for (; some; some &= some - 1) settle_block(tile, to, row, (uint32_t)__builtin_ctz(some), false);
    }
}

/// The settled planes of a block where clip lines have a say, else NULL: first of all the covered shares.
static ALWAYS_INLINE const float *cut_cover(const ewa_tile *tile, uint32_t row, uint32_t column) {
    const ewa_apart *apart = &tile->apart;
    if (!apart->cut_rows || !(apart->cut_rows[row] >> column & 1)) return NULL;
    return apart->cut + ((size_t)row * tile->blocks_per_row + column) * EWA_CUT_CHANNELS * EWA_BLOCK_LANES;
}

#endif
