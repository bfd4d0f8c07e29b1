// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: from sums to pixels (math.md section 7).
//
// Based on: Zwicker, Pfister, van Baar, Gross, "Surface Splatting", 2001, equation 9, sections 4 and 7.
#ifndef EWA_SRC_KERNELS_ROAD_RESOLVE_H
#define EWA_SRC_KERNELS_ROAD_RESOLVE_H

#include "kernels/road_raster.h"

/// x^(1/4) for x >= 0 within 1e-6 relative: x y^3 with y = x^(-1/4) from the bits and two cubic steps; 0
/// gives 0.
static ALWAYS_INLINE wf wf_fourth_root(wf x) {
    wf y = wf_of_bits(wi_sub(wi_set(0x4f58cae5), wi_sar(wi_of_bits(x), 2)));
    for (int i = 0; i < 2; i++) {
        const wf y2 = wf_mul(y, y);
        const wf e = wf_fnma(wf_mul(x, y2), y2, wf_set(1));
        y = wf_fma(wf_mul(y, e), wf_fma(e, wf_set(0.15625f), wf_set(0.25f)), y);
    }
    return wf_mul(wf_mul(x, y), wf_mul(y, y));
}

/// The sRGB curve times 255, rounded to nearest, for values in [0, 1]: a polynomial in x^(1/4) within 0.002
/// of a code.
static inline wi srgb_codes(wf linear) {
    const wf t = wf_fourth_root(linear);
    wf c = wf_fma(t, wf_set(-0.068147173422f), wf_set(0.289532584065f));
    c = wf_fma(t, c, wf_set(-0.577482217966f));
    c = wf_fma(t, c, wf_set(1.255404113825f));
    c = wf_fma(t, c, wf_set(0.162026347951f));
    c = wf_fma(t, c, wf_set(-0.061340224745f));
    const wf curve = wf_select(wf_le(linear, wf_set(0.0031308f)), wf_mul(linear, wf_set(12.92f)), c);
    return wi_from_f(wf_fma(curve, wf_set(255), wf_set(0.5f)));
}

static inline wf wf_clamp01(wf a) { return wf_min(wf_max(a, wf_set(0)), wf_set(1)); }

/// Writes `values` (per lane `stride` floats) to the block's pixels of a plane.
static void store_block(float *plane, uint32_t stride, const ewa_resolve *to, uint32_t x, uint32_t y,
                        uint32_t width, uint32_t height, const float *values) {
    for (uint32_t row = 0; row < height; row++) {
        float *out = plane + ((size_t)(y + row) * to->width_px + x) * stride;
        memcpy(out, values + (size_t)row * EWA_BLOCK_PX * stride, (size_t)width * stride * sizeof(float));
    }
}

static void store_vectors(float *plane, const ewa_resolve *to, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height, const wf v[3]) {
    float lanes[64], packed[48];
    w_store4(lanes, v[0], v[1], v[2], wf_set(0));
    for (int i = 0; i < 16; i++) memcpy(&packed[3 * i], &lanes[4 * i], 3 * sizeof(float));
    store_block(plane, 3, to, x, y, width, height, packed);
}

static inline void scale3(wf v[3], wf by) {
    for (int i = 0; i < 3; i++) v[i] = wf_mul(v[i], by);
}

static inline wf dot3(const wf a[3], const wf b[3]) {
    return wf_fma(a[0], b[0], wf_fma(a[1], b[1], wf_mul(a[2], b[2])));
}

/// The share of light that a pixel returns: ambient + (1 - ambient) max(0, N.L).
static inline wf lambert(const ewa_resolve *to, const wf normal[3], uint32_t x, uint32_t y) {
    wf light[3];
    if (to->headlight && !to->orthographic) {
        const wf px = wf_add(lanes_x(), wf_set((float)x)), py = wf_add(lanes_y(), wf_set((float)y));
        light[0] = wf_negate(wf_fma(px, wf_set(to->ray_x[0]), wf_set(to->ray_x[1])));
        light[1] = wf_negate(wf_fma(py, wf_set(to->ray_y[0]), wf_set(to->ray_y[1])));
        light[2] = wf_set(-1);
        scale3(light, wf_inverse_root(dot3(light, light)));
    } else {
        for (int i = 0; i < 3; i++) light[i] = wf_set(to->light[i]);
    }
    const wf facing = wf_max(dot3(normal, light), wf_set(0));
    return wf_fma(wf_set(1 - to->ambient), facing, wf_set(to->ambient));
}

/// A block's gathered surface.
typedef struct surface {
    wm covered;
    wf weight, inverse_weight, alpha;
    wf color[3], normal[3]; ///< shaded; camera space, unit, 0 where undefined
} surface;

static ALWAYS_INLINE surface gathered_surface(const ewa_tile *tile, const ewa_resolve *to, const float *sums,
                                              uint32_t x, uint32_t y) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf zero = wf_set(0), one = wf_set(1);
    surface s = {.weight = wf_load(sums), .normal = {zero, zero, zero}};
    s.covered = wf_lt(zero, s.weight);
    s.inverse_weight = wf_keep(s.covered, wf_div(one, wf_select(s.covered, s.weight, one)));
    for (int i = 0; i < 3; i++) s.color[i] = wf_mul(wf_load(sums + (1 + i) * LANES), s.inverse_weight);
    s.alpha = wf_keep(s.covered, one);
    if (to->edge_antialiasing) s.alpha = wf_min(one, wf_mul(s.weight, wf_set(to->alpha_scale)));
    if (tile->with_normals) {
        for (int i = 0; i < 3; i++) s.normal[i] = wf_load(sums + (4 + i) * LANES);
        const wf length2 = dot3(s.normal, s.normal);
        scale3(s.normal, wf_keep(wf_lt(zero, length2), wf_inverse_root(length2)));
        if (to->lambert) scale3(s.color, lambert(to, s.normal, x, y));
    }
    return s;
}

/// Writes the surfaces, over the background, as float and 8-bit colour. `behind` is NULL or 4 planes of a
/// block.
static ALWAYS_INLINE void store_color(const ewa_resolve *to, const surface *s, const float *behind,
                                      uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf zero = wf_set(0), one = wf_set(1);
    wf out[4], through = wf_sub(one, s->alpha);
    for (int i = 0; i < 3; i++) out[i] = wf_mul(s->color[i], s->alpha);
    out[3] = s->alpha;
    if (behind) {
        for (int i = 0; i < 4; i++) out[i] = wf_fma(wf_load(behind + i * LANES), through, out[i]);
        through = wf_sub(one, out[3]);
    }
    for (int i = 0; i < 4; i++) out[i] = wf_fma(wf_set(to->background[i]), through, out[i]);
    if (to->rgba) {
        float lanes[64];
        w_store4(lanes, out[0], out[1], out[2], out[3]);
        store_block(to->rgba, 4, to, x, y, width, height, lanes);
    }
    if (!to->rgba8) return;
    const wm visible = wf_lt(zero, out[3]);
    const wf straight = wf_keep(visible, wf_div(one, wf_select(visible, out[3], one)));
    wi codes = wi_shl(wi_from_f(wf_fma(wf_clamp01(out[3]), wf_set(255), wf_set(0.5f))), 24);
    for (int i = 0; i < 3; i++)
        codes = wi_or(codes, wi_shl(srgb_codes(wf_clamp01(wf_mul(out[i], straight))), 8 * i));
    int32_t bytes[16];
    wi_store(bytes, codes);
    uint8_t *out8 = to->rgba8 + ((size_t)y * to->width_px + x) * 4;
    for (uint32_t row = 0; row < height; row++, out8 += (size_t)to->width_px * 4) {
        if (width == EWA_BLOCK_PX)
            memcpy(out8, &bytes[row * EWA_BLOCK_PX], EWA_BLOCK_PX * sizeof *bytes);
        else
            memcpy(out8, &bytes[row * EWA_BLOCK_PX], width * sizeof *bytes);
    }
}

static void resolve_block(const ewa_tile *tile, const ewa_resolve *to, const float *sums, const float *behind,
                          uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    const surface s = gathered_surface(tile, to, sums, x, y);
    if (to->rgba || to->rgba8) store_color(to, &s, behind, x, y, width, height);
    float lanes[16];
    if (to->depth) {
        const wf z = wf_mul(wf_load(sums + (tile->channel_count - 1) * EWA_BLOCK_LANES), s.inverse_weight);
        wf_store(lanes, wf_select(s.covered, z, wf_set(__builtin_inff())));
        store_block(to->depth, 1, to, x, y, width, height, lanes);
    }
    if (to->coverage) {
        wf_store(lanes, to->one_pass ? wf_keep(s.covered, wf_set(1))
                                     : wf_mul(s.weight, wf_set(to->unit_coverage_inverse)));
        store_block(to->coverage, 1, to, x, y, width, height, lanes);
    }
    if (to->normal) {
        wf world[3];
        rotate(to->to_world, s.normal[0], s.normal[1], s.normal[2], world);
        store_vectors(to->normal, to, x, y, width, height, world);
    }
}

static void resolve(const ewa_tile *tile, const ewa_resolve *to, const ewa_edges *edges,
                    const uint32_t *edge_rows) {
    size_t block = 0;
    for (uint32_t row = 0; row < tile->block_rows; row++) {
        const uint32_t y = row * EWA_BLOCK_PX, height = (uint32_t)tile->height_px - y;
        for (uint32_t column = 0; column < tile->blocks_per_row; column++, block++) {
            const uint32_t x = column * EWA_BLOCK_PX, width = (uint32_t)tile->width_px - x;
            const bool marked = edges && edge_rows[row] >> column & 1;
            resolve_block(tile, to, tile->sums + block * tile->channel_count * EWA_BLOCK_LANES,
                          marked ? edges->behind + block * 4 * EWA_BLOCK_LANES : NULL,
                          (uint32_t)tile->x_px + x, (uint32_t)tile->y_px + y,
                          width < EWA_BLOCK_PX ? width : EWA_BLOCK_PX,
                          height < EWA_BLOCK_PX ? height : EWA_BLOCK_PX);
        }
    }
}

#endif
