// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: from sums to pixels (docs/math.md section 7).
//
// Based on: Zwicker, Pfister, van Baar, Gross, "Surface Splatting", 2001, equation 9, sections 4 and 7.
#ifndef EWA_SRC_SURFACE_PIPELINE_RESOLVE_H
#define EWA_SRC_SURFACE_PIPELINE_RESOLVE_H

#include "surface/pipeline_shade.h"
#include "wide/pixels.h"

static void store_vectors(float *plane, const ewa_resolve *to, const block_place *at, const wf v[3]) {
    float lanes[64], packed[48];
    w_store4(lanes, v[0], v[1], v[2], wf_set(0));
    for (int i = 0; i < 16; i++) memcpy(&packed[3 * i], &lanes[4 * i], 3 * sizeof(float));
    store_block(plane, 3, to->width_px, at, packed);
}

/// A block's gathered surface: straight colour, shaded.
typedef struct surface {
    wf alpha, color[3];
} surface;

/// Covered share times opacity; `cover`: of cut_cover().
static ALWAYS_INLINE wf surface_alpha(const ewa_tile *tile, const ewa_resolve *to, const block_sums *sums,
                                      const float *cover) {
    const wf weight = sum_of(sums, 0), one = wf_set(1);
    wf coverage = wf_keep(wf_lt(wf_set(0), weight), one);
    if (to->edge_antialiasing)
        coverage = cover ? wf_load(cover) : wf_min(one, wf_mul(weight, wf_set(to->alpha_scale)));
    if (!to->transparent) return coverage;
    wf opacity = wf_set(to->opacity);
    if (tile->with_opacity)
        opacity = wf_mul(opacity, wf_mul(sum_of(sums, tile->channel_count - 1), inverse_weight(weight)));
    return wf_mul(coverage, opacity);
}

/// `shade` is that of shade_block(), `cover` that of cut_cover().
static ALWAYS_INLINE surface gathered_surface(const ewa_tile *tile, const ewa_resolve *to,
                                              const block_sums *sums, const float *shade,
                                              const float *cover) {
    surface s = {.alpha = surface_alpha(tile, to, sums, cover)};
    if (shades_by_factor(to)) {
        const wf factor = wf_load(shade);
        for (int i = 0; i < 3; i++) s.color[i] = wf_mul(sum_of(sums, 1 + (uint32_t)i), factor);
    } else {
        for (int i = 0; i < 3; i++) s.color[i] = wf_load(shade + i * EWA_BLOCK_LANES);
    }
    return s;
}

/// Premultiplied colour and alpha of the surface over `behind` (NULL or 4 planes of a block) and the
/// background.
static ALWAYS_INLINE void composite(const ewa_resolve *to, const surface *s, const float *behind, wf out[4]) {
    const wf one = wf_set(1);
    for (int i = 0; i < 3; i++) out[i] = s->color[i];
    out[3] = s->alpha;
    wf through = wf_sub(one, s->alpha);
    if (!wm_bits(wf_lt(s->alpha, one))) return;
    for (int i = 0; i < 3; i++) out[i] = wf_mul(out[i], s->alpha);
    if (behind) {
        for (int i = 0; i < 4; i++) out[i] = wf_fma(wf_load(behind + i * EWA_BLOCK_LANES), through, out[i]);
        through = wf_sub(one, out[3]);
    }
    for (int i = 0; i < 4; i++) out[i] = wf_fma(wf_set(to->background[i]), through, out[i]);
}

/// Writes the planes other than 8-bit colour.
static void store_planes(const ewa_tile *tile, const ewa_resolve *to, const block_sums *sums,
                         const wf color[4], const block_place *at) {
    float lanes[16];
    if (to->rgba) store_colors(to->rgba, to->width_px, at, color);
    const wf weight = sum_of(sums, 0), zero = wf_set(0);
    const wm covered = wf_lt(zero, weight);
    if (to->depth) {
        const wf depths = sum_of(sums, depth_channel(tile));
        const wf z = wf_mul(wf_mul(depths, inverse_weight(weight)), wf_set(to->depth_unit));
        wf_store(lanes, wf_select(covered, z, wf_set(__builtin_inff())));
        store_block(to->depth, 1, to->width_px, at, lanes);
    }
    if (to->coverage) {
        wf_store(lanes, to->one_pass ? wf_keep(covered, wf_set(1))
                                     : wf_mul(weight, wf_set(to->unit_coverage_inverse)));
        store_block(to->coverage, 1, to->width_px, at, lanes);
    }
    if (to->normal) {
        wf unit[3], world[3];
        for (int i = 0; i < 3; i++) unit[i] = sum_of(sums, 4 + (uint32_t)i);
        const wf length2 = dot3(unit, unit);
        scale3(unit, wf_keep(wf_lt(zero, length2), wf_inverse_root(length2)));
        rotate(to->to_world, unit[0], unit[1], unit[2], world);
        store_vectors(to->normal, to, at, world);
    }
}

static ALWAYS_INLINE block_place place_of(const ewa_tile *tile, uint32_t row, uint32_t column) {
    return place_block(tile->x_px, tile->y_px, tile->width_px, tile->height_px, row, column);
}

/// How many of a block's pixels have a colour that is infinite or no number.
static inline uint32_t count_broken(const block_place *at, const wf color[4]) {
    const wf largest = wf_set(0x1.fffffep127f);
    wm whole = wf_le(wf_abs(color[0]), largest);
    for (int i = 1; i < 4; i++) whole = wm_and(whole, wf_le(wf_abs(color[i]), largest));
    const uint32_t broken = wm_bits(wm_not(whole));
    uint32_t count = 0;
    for (uint32_t row = 0; broken && row < at->height; row++)
        count += (uint32_t)__builtin_popcount(broken >> row * EWA_BLOCK_PX & ((1u << at->width) - 1));
    return count;
}

static uint32_t resolve(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges,
                        const uint32_t *edge_rows) {
    const bool planes = to->rgba || to->depth || to->coverage || to->normal;
    const ewa_resolve at_hand = *to; // bytes that are written to pixels cannot change this
    const ewa_tile in_tile = *tile;
    wf empty[4];
    for (int i = 0; i < 4; i++) empty[i] = wf_set(to->background[i]);
    const wi empty_codes = color_codes(empty);
    const float *behind = edges ? edges->behind : NULL;
    float shades[EWA_MAX_TILE_BLOCKS * EWA_SHADE_FLOATS];
    uint32_t broken_count = 0;
    for (uint32_t row = 0; row < in_tile.block_rows; row++) {
        // Long chains of operations: a row's worth of each at a time keeps the processor busy.
        for (uint32_t column = 0; column < in_tile.blocks_per_row; column++) {
            const block_place at = place_of(&in_tile, row, column);
            const block_sums sums = tile_block(&in_tile, row, column);
            shade_block(&in_tile, &at_hand, &sums, at.x, at.y, shades + (size_t)column * EWA_SHADE_FLOATS);
        }
        const uint32_t marked = edges ? edge_rows[row] : 0;
        for (uint32_t column = 0; column < in_tile.blocks_per_row; column++) {
            const block_place at = place_of(&in_tile, row, column);
            const block_sums sums = tile_block(&in_tile, row, column);
            if (!planes && !wm_bits(wf_lt(wf_set(0), sum_of(&sums, 0)))) {
                store_codes(at_hand.rgba8, at_hand.width_px, &at, empty_codes);
            } else {
                const surface s =
                    gathered_surface(&in_tile, &at_hand, &sums, shades + (size_t)column * EWA_SHADE_FLOATS,
                                     cut_cover(&in_tile, row, column));
                wf color[4];
                composite(&at_hand, &s, marked >> column & 1 ? behind : NULL, color);
                broken_count += count_broken(&at, color);
                if (at_hand.rgba8) store_codes(at_hand.rgba8, at_hand.width_px, &at, color_codes(color));
                if (planes) store_planes(tile, to, &sums, color, &at);
            }
            if (edges) behind += 4 * EWA_BLOCK_LANES;
        }
    }
    return broken_count;
}

#endif
