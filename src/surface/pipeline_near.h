// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: surfels that touch the eye plane, and broad ones, by pixel rays (docs/math.md
// section 3; semantics.h, near surfels).
#ifndef EWA_SRC_SURFACE_PIPELINE_NEAR_H
#define EWA_SRC_SURFACE_PIPELINE_NEAR_H

#include "surface/pipeline_raster.h"

/// A near surfel at a block's pixels, by pixel rays (semantics.h).
typedef struct near_sample {
    wf exponent; ///< s: exp(-r^2 / 2) = exp(-s)^(2^doublings)
    wf weight;   ///< 1 / (2 pi sqrt|W|)
    wf z;
    wm counts;
    clip_sample left; ///< of one that has clip lines
} near_sample;

static ALWAYS_INLINE wf linear(const float terms[3], wf x, wf y) {
    return wf_fma(wf_set(terms[1]), x, wf_fma(wf_set(terms[2]), y, wf_set(terms[0])));
}

static ALWAYS_INLINE near_sample near_evaluate(const ewa_view *view, const ewa_near_record *r, wf x, wf y) {
    const wf one = wf_set(1), h2 = wf_set(view->prefilter2_px2);
    const wf inverse = wf_div(one, linear(r->w, x, y));
    const wf u = wf_mul(linear(r->u, x, y), inverse), v = wf_mul(linear(r->v, x, y), inverse);
    const wf z = wf_mul(linear(r->z, x, y), inverse);
    const wf ux = wf_mul(wf_fnma(u, wf_set(r->w[1]), wf_set(r->u[1])), inverse);
    const wf uy = wf_mul(wf_fnma(u, wf_set(r->w[2]), wf_set(r->u[2])), inverse);
    const wf vx = wf_mul(wf_fnma(v, wf_set(r->w[1]), wf_set(r->v[1])), inverse);
    const wf vy = wf_mul(wf_fnma(v, wf_set(r->w[2]), wf_set(r->v[2])), inverse);
    const wf w11 = wf_fma(h2, wf_fma(ux, ux, wf_mul(uy, uy)), one);
    const wf w22 = wf_fma(h2, wf_fma(vx, vx, wf_mul(vy, vy)), one);
    const wf w12 = wf_mul(h2, wf_fma(ux, vx, wf_mul(uy, vy)));
    // |I + h^2 (a'a + b'b)| = 1 + h^2 (|a|^2 + |b|^2) + h^4 (a x b)^2, free of cancellation.
    const wf cross = wf_mul(h2, wf_fnma(uy, vx, wf_mul(ux, vy)));
    const wf det = wf_fma(cross, cross, wf_sub(wf_add(w11, w22), one));
    const wf u2 = wf_mul(u, u), v2 = wf_mul(v, v);
    const wf numerator = wf_fma(w22, u2, wf_fma(w11, v2, wf_mul(wf_mul(wf_set(-2), w12), wf_mul(u, v))));
    const wf r2 = wf_div(numerator, det);
    near_sample sample;
    sample.exponent = wf_max(wf_mul(r2, wf_set(view->exponent_scale)), wf_set(0));
    sample.weight = wf_div(wf_set((float)EWA_INVERSE_TWO_PI), wf_sqrt(det));
    const wm inside = wm_and(wf_lt(sample.exponent, wf_set(view->exponent_end)),
                             wf_lt(wf_add(u2, v2), wf_set(4 * view->cutoff2)));
    sample.counts = view->orthographic ? inside : wm_and(inside, wf_lt(wf_set(0), z));
    sample.z = wf_min(wf_max(z, wf_set(r->depth_low)), wf_set(r->depth_high));
    if (r->clipped) {
        sample.left = clip_at(&r->clip, x, y);
        sample.counts = wm_and(sample.counts, wf_lt(wf_set(0), sample.left.share));
    }
    return sample;
}

static ALWAYS_INLINE wf key_of_depth(const ewa_view *view, wf z) {
    return view->orthographic ? wf_negate(z) : wf_div(wf_set(1), z);
}

static ALWAYS_INLINE void near_raise(const ewa_view *view, const ewa_near_record *r,
                                     const near_sample *sample, wm counts, float *nearest) {
    const wf old = wf_load(nearest);
    const wf key = key_of_depth(view, wf_add(sample->z, wf_set(r->tolerance)));
    wf_store(nearest, wf_select(counts, wf_max(key, old), old));
}

/// Adds a near surfel to what a block has gathered; its depth only with `with_depth`.
static ALWAYS_INLINE void near_add(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *r,
                                   const near_sample *sample, wm counts, wf key, wf nearest, uint32_t row,
                                   uint32_t column, bool with_depth) {
    if (!wm_bits(counts)) return;
    // Lanes that do not count may hold anything.
    const wf peak = wf_mul(wf_keep(counts, sample->weight), wf_set(view->sum_scale));
    payload add = {.peak = wf_odd(peak)};
    for (int k = 0; k < 3; k++) {
        add.color[k] = wf_odd_product(peak, wf_set(r->color[k]));
        add.normal[k] = wf_odd_product(peak, wf_set(r->normal[k]));
    }
    add.opacity = wf_odd_product(peak, wf_set(r->opacity));
    for (int k = 0; k < EWA_MATERIAL_CHANNELS; k++)
        add.material[k] = wf_odd_product(peak, wf_set(r->material[k]));
    wf weight = wf_keep(counts, exponential(wf_keep(counts, sample->exponent), view->doublings));
    if (r->clipped) {
        add_cut(tile, row, column, &r->clip, &sample->left, wf_mul(weight, peak));
        weight = wf_mul(weight, wf_keep(counts, sample->left.share));
    }
    const int what = channels_of(tile) | (with_depth ? ADD_DEPTH : 0) |
                     (view->orthographic ? ORTHOGRAPHIC : 0) | (r->clipped ? ADD_FINE : 0);
    add_channels(visit_sums(tile, r->is_back, row, column), sums_for(tile, r->is_back), tile->channel_count,
                 weight, &add, depth_share(view, wf_select(counts, key, wf_set(1)), nearest, what), what);
}

static ALWAYS_INLINE near_sample near_block(const ewa_view *view, const ewa_tile *tile,
                                            const ewa_near_record *r, uint32_t row, uint32_t column) {
    return near_evaluate(view, r, wf_add(lanes_x(), wf_set(column_px(tile, column))),
                         wf_add(lanes_y(), wf_set(row_px(tile, row))));
}

static void near_visibility(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                            uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        float *nearest = tile->nearest;
        for (uint32_t row = 0; row < tile->block_rows; row++) {
            for (uint32_t column = 0; column < tile->blocks_per_row; column++, nearest += EWA_BLOCK_LANES) {
                const near_sample sample = near_block(view, tile, &records[i], row, column);
                near_raise(view, &records[i], &sample, sample.counts, nearest);
            }
        }
    }
}

static void near_accumulate(const ewa_view *view, const ewa_tile *tile, const ewa_near_record *records,
                            uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        const float *nearest = tile->nearest;
        for (uint32_t row = 0; row < tile->block_rows; row++) {
            for (uint32_t column = 0; column < tile->blocks_per_row; column++, nearest += EWA_BLOCK_LANES) {
                const near_sample sample = near_block(view, tile, &records[i], row, column);
                const wf key = key_of_depth(view, sample.z);
                const wm counts = wm_and(sample.counts, wf_le(wf_load(nearest), key));
                near_add(view, tile, &records[i], &sample, counts, key, wf_load(nearest), row, column,
                         tile->with_depth);
            }
        }
    }
}

#endif
