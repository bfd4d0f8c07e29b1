// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: sums that no order of their terms changes (docs/math.md section 6; semantics.h,
// sums).
//
// From 2^23 to 2^24 floats are whole numbers. A sum that begins in the middle, at BIAS, and stays within is
// one of whole numbers: adding w p to it with one rounding adds w p rounded to a whole number, whatever is
// there already, since all factors p have an odd last digit (wf_odd()), so that w p is never halfway between
// two. Units are chosen so that a term is small against 2^22, which few sums reach. Where one does, as its
// plane of weights tells in the end, the tile is summed again with care: terms are counted, and what has
// gathered is carried on to integers in time.
//
// Where pixels show splats of next to no weight, or colours far from the largest, what the units of terms
// leave is summed likewise, in units of its own ("fine"); and so it is of depths and of the weights that
// they are divided by.
#ifndef EWA_SRC_SURFACE_PIPELINE_SUMS_H
#define EWA_SRC_SURFACE_PIPELINE_SUMS_H

#include "surface/pipeline_camera.h"

#include <assert.h>

static const float BIAS = 0x1.8p23f;
enum {
    BIAS_BITS = 0x4b400000,
    CARRY_SHIFT = 16,
    CARRY_MASK = (1 << CARRY_SHIFT) - 1,
    MAX_UNITS = EWA_SUM_UNITS - (1 << 16),
    FINE_SHIFT = 12,                           ///< what a term's unit leaves has up to half of so many bits
    MAX_FINE_VISITS = MAX_UNITS >> FINE_SHIFT, ///< where nothing is carried
};

/// A unit of what terms' units leave, over one of those.
static const float FINE_UNIT = 1.0f / (1 << FINE_SHIFT);

/// Where a block's numbers begin.
static ALWAYS_INLINE size_t first_number(const ewa_tile *tile, uint32_t row, uint32_t column,
                                         uint32_t channels) {
    return ((size_t)row * tile->blocks_per_row + column) * channels * EWA_BLOCK_LANES;
}

/// Adds weight x factor, of units; weight is at most 1, factor odd or 0.
static ALWAYS_INLINE void add_product(float *plane, wf weight, wf factor) {
    wf_store(plane, wf_fma_whole(weight, factor, wf_load(plane)));
}

/// The same with what the rounding leaves, `fine` numbers further on.
static ALWAYS_INLINE void add_product_finely(float *plane, size_t fine, wf weight, wf factor) {
    const wf before = wf_load(plane), after = wf_fma(weight, factor, before);
    wf_store(plane, after);
    const wf left = wf_odd(wf_fma(weight, factor, wf_sub(before, after)));
    add_product(plane + fine, wf_set(1 / FINE_UNIT), left);
}

/// Leaves CARRY_SHIFT bits of a plane and carries the others on.
static ALWAYS_INLINE void carry_plane(float *low, float *high, bool has_high) {
    const wi units = wi_sub(wi_of_bits(wf_load(low)), wi_set(BIAS_BITS)),
             carried = wi_sar(units, CARRY_SHIFT);
    wf_store(high, wf_of_bits(has_high ? wi_add(wi_of_bits(wf_load(high)), carried) : carried));
    wf_store(low, wf_of_bits(wi_add(wi_and(units, wi_set(CARRY_MASK)), wi_set(BIAS_BITS))));
}

static __attribute__((noinline)) void carry_block(const ewa_tile *tile, const ewa_sums *of, uint32_t row,
                                                  uint32_t column, uint32_t channels) {
    const bool has_high = of->high_rows[row] >> column & 1;
    const size_t first = first_number(tile, row, column, channels);
    for (uint32_t c = 0; c < channels; c++) {
        const size_t at = first + c * EWA_BLOCK_LANES;
        carry_plane(of->planes + at, of->high + at, has_high);
        if (of->fine) carry_plane(of->planes + at + of->fine, of->high + at + of->fine, has_high);
    }
    of->high_rows[row] |= 1u << column;
    of->visits[row * tile->blocks_per_row + column] = 0;
}

/// A block's sums, for a term in each, which is counted if terms are.
static ALWAYS_INLINE float *visit_block(const ewa_tile *tile, const ewa_sums *of, uint32_t row,
                                        uint32_t column, uint32_t channels) {
    static_assert(EWA_TERMS_PER_CARRY * EWA_MAX_TERM_UNITS + CARRY_MASK < MAX_UNITS, "sums stay in range");
    static_assert(MAX_FINE_VISITS >= EWA_TERMS_PER_CARRY * EWA_MAX_ROOM, "and what units leave");
    uint32_t *visits = of->visits + row * tile->blocks_per_row + column;
    if (of->careful && *visits == of->max_visits) carry_block(tile, of, row, column, channels);
    if (of->careful || of->fine) ++*visits;
    return of->planes + first_number(tile, row, column, channels);
}

/// Whether a sum of a block that was not gathered with care may have left its range; none is larger than
/// that of its weights, but for what terms are rounded by.
static ALWAYS_INLINE bool is_beyond(const ewa_tile *tile, const ewa_sums *of, uint32_t row, uint32_t column,
                                    uint32_t channels) {
    if (of->fine && of->visits[row * tile->blocks_per_row + column] > MAX_FINE_VISITS) return true;
    const wf weights = wf_load(of->planes + first_number(tile, row, column, channels));
    return wm_bits(wf_lt(wf_set(BIAS + (float)MAX_UNITS), weights)) != 0;
}

/// Starts a block's sums over.
static ALWAYS_INLINE void clear_block(const ewa_tile *tile, const ewa_sums *of, uint32_t row, uint32_t column,
                                      uint32_t channels) {
    float *planes = of->planes + first_number(tile, row, column, channels);
    for (uint32_t c = 0; c < channels; c++) wf_store(planes + c * EWA_BLOCK_LANES, wf_set(BIAS));
    for (uint32_t c = 0; c < channels && of->fine; c++)
        wf_store(planes + of->fine + c * EWA_BLOCK_LANES, wf_set(BIAS));
    of->visits[row * tile->blocks_per_row + column] = 0;
    of->high_rows[row] &= ~(1u << column);
}

/// The number of units in a plane, rounded once from what is there and what has been carried.
static ALWAYS_INLINE wf read_units(const float *low, const float *high, bool has_high) {
    if (!has_high) return wf_sub(wf_load(low), wf_set(BIAS));
    const wi units = wi_sub(wi_of_bits(wf_load(low)), wi_set(BIAS_BITS));
    const wi upper = wi_add(wi_of_bits(wf_load(high)), wi_sar(units, CARRY_SHIFT));
    return wf_fma(wf_from_i(upper), wf_set(1 << CARRY_SHIFT), wf_from_i(wi_and(units, wi_set(CARRY_MASK))));
}

/// The sums of a block, in units: finalized ones begin at 0, others still at BIAS.
typedef struct block_sums {
    const float *planes;
    float origin;
} block_sums;

/// The sums of a tile's block.
static ALWAYS_INLINE block_sums tile_block(const ewa_tile *tile, uint32_t row, uint32_t column) {
    const bool finalized = tile->finalized_rows[row] >> column & 1;
    return (block_sums){tile->sums.planes + first_number(tile, row, column, tile->channel_count),
                        finalized ? 0 : BIAS};
}

static ALWAYS_INLINE wf sum_of(const block_sums *sums, uint32_t channel) {
    return wf_sub(wf_load(sums->planes + (size_t)channel * EWA_BLOCK_LANES), wf_set(sums->origin));
}

#endif
