// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Body of the kernels that add texels to the sums of a tile, for the instruction set that the including file
// chose (wide/wide.h). Sixteen texels are projected at once, and
// added one by one.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3; Zwicker et al.,
// "Perspective Accurate Splatting", 2004, section 4 (docs/math.md sections 3, 4, 11).
#include "texture/texture.h"
#include "texture/texture_resolve.h"
#include "wide/wide_ellipse.h"

#include <string.h>

/// Neighbours in a row are four apart in time, so that no sum is needed while it is still being written.
#define LANE_ORDER(k) (4 * ((k) % 4) + (k) / 4)

typedef float f4 __attribute__((vector_size(16)));

static ALWAYS_INLINE f4 f4_load(const float *p) {
    f4 a;
    memcpy(&a, p, sizeof a);
    return a;
}

static ALWAYS_INLINE void f4_store(float *p, f4 a) { memcpy(p, &a, sizeof a); }

/// Sixteen texels of a row, projected.
typedef struct texels {
    wf x, y, w, inverse_w;
    wm seen;
} texels;

static ALWAYS_INLINE texels project(const ewa_texture_block *block, uint32_t row, uint32_t first) {
    static const float lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const wf at = wf_add(wf_load(lanes), wf_set((float)first));
    const float *start = block->row_start[row];
    texels t;
    t.w = wf_fma(at, wf_set(block->step_u[2]), wf_set(start[2]));
    t.seen = wm_and(wf_lt(wf_set(0), t.w), wf_lt(at, wf_set((float)block->width)));
    t.inverse_w = wf_div(wf_set(1), wf_select(t.seen, t.w, wf_set(1)));
    t.x = wf_mul(wf_fma(at, wf_set(block->step_u[0]), wf_set(start[0])), t.inverse_w);
    t.y = wf_mul(wf_fma(at, wf_set(block->step_u[1]), wf_set(start[1])), t.inverse_w);
    return t;
}

/// exp2 for x in [-60, 0].
static ALWAYS_INLINE wf exp2_small(wf x) {
    const wf whole = wf_floor(wf_add(x, wf_set(0.5f))), f = wf_sub(x, whole);
    wf series = wf_fma(f, wf_set(1.33335581e-3f), wf_set(9.61812911e-3f)); // ln(2)^k / k!
    series = wf_fma(f, series, wf_set(5.55041087e-2f));
    series = wf_fma(f, series, wf_set(2.40226507e-1f));
    series = wf_fma(f, series, wf_set(6.93147181e-1f));
    series = wf_fma(f, series, wf_set(1));
    return wf_of_bits(wi_add(wi_of_bits(series), wi_shl(wi_from_f(whole), 23)));
}

static const float HALF_LOG2_E = 0.721347520f;

/// Sixteen filtered ellipses, ready to be added: weight = amplitude 2^(xx dx^2 + xy dx dy + yy dy^2).
typedef struct ellipses {
    float x[16], y[16], xx[16], xy[16], yy[16], amplitude[16];
    int32_t x_low[16], x_high[16], y_low[16], y_high[16];
} ellipses;

/// Stores what `ellipses` needs; returns the lanes that touch the tile.
static ALWAYS_INLINE uint32_t place(ellipses *e, wm seen, wf x, wf y, wf half_x, wf half_y) {
    const wf half = wf_set(0.5f), zero = wf_set(0), last = wf_set(EWA_TEXTURE_TILE - 1),
             end = wf_set(EWA_TEXTURE_TILE);
    // Clamped before the conversion; a ceiling is a floor of the negative.
    const wf x_low = wf_sub(zero, wf_floor(wf_sub(wf_add(half_x, half), x)));
    const wf y_low = wf_sub(zero, wf_floor(wf_sub(wf_add(half_y, half), y)));
    const wf x_high = wf_floor(wf_sub(wf_add(x, half_x), half)),
             y_high = wf_floor(wf_sub(wf_add(y, half_y), half));
    const wf x0 = wf_min(wf_max(x_low, zero), end), x1 = wf_max(wf_min(x_high, last), wf_set(-1));
    const wf y0 = wf_min(wf_max(y_low, zero), end), y1 = wf_max(wf_min(y_high, last), wf_set(-1));
    wf_store(e->x, x);
    wf_store(e->y, y);
    wi_store(e->x_low, wi_from_f(x0));
    wi_store(e->x_high, wi_from_f(x1));
    wi_store(e->y_low, wi_from_f(y0));
    wi_store(e->y_high, wi_from_f(y1));
    return wm_bits(wm_and(seen, wm_and(wf_le(x0, x1), wf_le(y0, y1))));
}

/// Adds the texels of `hits`, in blocks of 4 x 4 pixels.
static ALWAYS_INLINE void add_ellipses(const ewa_texel_filter *filter, const ellipses *e, uint32_t hits,
                                       float (*colors)[4], const ewa_texture_sums *sums) {
    static const float column[16] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                     0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    static const float line[16] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                   2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};
    const wf limit = wf_set(-HALF_LOG2_E * filter->cutoff2);
    for (int k = 0; k < 16; k++) {
        const int i = LANE_ORDER(k);
        if (!(hits >> i & 1)) continue;
        const wf color = wf_repeat4(colors[i]);
        const wf xx = wf_set(e->xx[i]), xy = wf_set(e->xy[i]), yy = wf_set(e->yy[i]);
        for (int32_t y = e->y_low[i]; y <= e->y_high[i]; y += 4) {
            const wf dy = wf_add(wf_load(line), wf_set((float)y - e->y[i]));
            const wf yy_term = wf_mul(wf_mul(yy, dy), dy), xy_term = wf_mul(xy, dy);
            for (int32_t x = e->x_low[i]; x <= e->x_high[i]; x += 4) {
                const wf dx = wf_add(wf_load(column), wf_set((float)x - e->x[i]));
                const wf exponent = wf_fma(wf_fma(xx, dx, xy_term), dx, yy_term);
                const wm inside = wf_lt(limit, exponent);
                const wf weight = wf_keep(
                    inside, wf_mul(exp2_small(wf_max(exponent, wf_set(-60))), wf_set(e->amplitude[i])));
                const size_t at = (size_t)(y + 1) * EWA_TEXTURE_PITCH + (size_t)x + 1;
                float weights[16];
                wf_store(weights, weight);
                const int rows = e->y_high[i] - y < 3 ? e->y_high[i] - y + 1 : 4;
                for (int r = 0; r < rows; r++) {
                    float *to = sums->color + 4 * (at + (size_t)r * EWA_TEXTURE_PITCH);
                    wf_store(to, wf_fma(wf_spread4(weights + 4 * r), color, wf_load(to)));
                }
                if (!sums->weight) continue;
                for (int r = 0; r < 4; r++) {
                    float *sum = sums->weight + at + (size_t)r * EWA_TEXTURE_PITCH;
                    f4_store(sum, f4_load(sum) + f4_load(weights + 4 * r));
                }
            }
        }
    }
}

/// Points whose filter reaches one pixel at most: two by two pixels.
static ALWAYS_INLINE uint32_t add_small_points(const ewa_texel_filter *filter, const texels *t, wf amplitude,
                                               float (*colors)[4], const ewa_texture_sums *sums) {
    const wf half = wf_set(0.5f), one = wf_set(1), low = wf_set(-1), end = wf_set(EWA_TEXTURE_TILE);
    const wf x = wf_sub(t->x, half), y = wf_sub(t->y, half);
    const wm inside_x = wm_and(wf_le(low, x), wf_lt(x, end)), inside_y = wm_and(wf_le(low, y), wf_lt(y, end));
    const wm touched = wm_and(t->seen, wm_and(inside_x, inside_y));
    const uint32_t hits = wm_bits(touched);
    if (!hits) return 0;
    const wf left = wf_floor(x), top = wf_floor(y);
    const wf dx0 = wf_sub(x, left), dx1 = wf_sub(one, dx0), dy0 = wf_sub(y, top), dy1 = wf_sub(one, dy0);
    const wf xx[2] = {wf_mul(dx0, dx0), wf_mul(dx1, dx1)}, yy[2] = {wf_mul(dy0, dy0), wf_mul(dy1, dy1)};
    const wf scale = wf_set(-HALF_LOG2_E / filter->prefilter2),
             reach2 = wf_set(filter->reach_px * filter->reach_px);
    const wf kx[2] = {exp2_small(wf_max(wf_mul(scale, xx[0]), wf_set(-60))),
                      exp2_small(wf_max(wf_mul(scale, xx[1]), wf_set(-60)))};
    float weights[4][16];
    for (int j = 0; j < 2; j++) {
        const wf ky = wf_mul(amplitude, exp2_small(wf_max(wf_mul(scale, yy[j]), wf_set(-60))));
        for (int i = 0; i < 2; i++)
            wf_store(weights[2 * j + i], wf_keep(wf_lt(wf_add(xx[i], yy[j]), reach2), wf_mul(kx[i], ky)));
    }
    int32_t places[16];
    const wf place = wf_fma(wf_add(top, one), wf_set(EWA_TEXTURE_PITCH), wf_add(left, one));
    wi_store(places, wi_from_f(wf_keep(touched, place)));
    for (int k = 0; k < 16; k++) {
        const int i = LANE_ORDER(k);
        if (!(hits >> i & 1)) continue;
        const f4 color = f4_load(colors[i]);
        for (int tap = 0; tap < 4; tap++) {
            const size_t at = (size_t)places[i] + (tap & 1) + (tap & 2 ? EWA_TEXTURE_PITCH : 0);
            float *to = sums->color + 4 * at;
            const float weight = weights[tap][i];
            f4_store(to, f4_load(to) + (f4){weight, weight, weight, weight} * color);
            if (sums->weight) sums->weight[at] += weight;
        }
    }
    return hits;
}

static uint32_t points(const ewa_texel_filter *filter, const ewa_texture_block *block,
                       const ewa_texture_sums *sums) {
    const bool small = filter->reach_px <= 1;
    const float conic = -HALF_LOG2_E / filter->prefilter2;
    uint32_t drawn = 0;
    for (uint32_t row = 0; row < block->height; row++) {
        for (uint32_t first = 0; first < block->width; first += 16) {
            float(*colors)[4] = (float(*)[4])(uintptr_t)&block->colors[row][first];
            const texels t = project(block, row, first);
            const wf amplitude = wf_mul(wf_set(block->area_scale / filter->prefilter2),
                                        wf_mul(wf_mul(t.inverse_w, t.inverse_w), t.inverse_w));
            uint32_t hits;
            if (small) {
                hits = add_small_points(filter, &t, amplitude, colors, sums);
            } else {
                ellipses e;
                const wf reach = wf_set(filter->reach_px);
                hits = place(&e, t.seen, t.x, t.y, reach, reach);
                wf_store(e.xx, wf_set(conic));
                wf_store(e.xy, wf_set(0));
                wf_store(e.yy, wf_set(conic));
                wf_store(e.amplitude, amplitude);
                add_ellipses(filter, &e, hits, colors, sums);
            }
            drawn += (uint32_t)__builtin_popcount(hits);
        }
    }
    return drawn;
}

/// The ellipses of sixteen texels: ewa_texel_place() in single precision.
static ALWAYS_INLINE uint32_t splat_ellipses(const ewa_texel_filter *filter, const ewa_texture_block *block,
                                             const texels *t, ellipses *e) {
    const wf sigma = wf_set(filter->sigma), cutoff2 = wf_set(filter->cutoff2),
             h2 = wf_set(filter->prefilter2);
    const float *steps[2] = {block->step_u, block->step_v};
    wf tangents[2][3];
    for (int i = 0; i < 2; i++) {
        tangents[i][2] = wf_mul(sigma, wf_set(steps[i][2]));
        tangents[i][0] = wf_fnma(t->x, tangents[i][2], wf_mul(sigma, wf_set(steps[i][0])));
        tangents[i][1] = wf_fnma(t->y, tangents[i][2], wf_mul(sigma, wf_set(steps[i][1])));
    }
    wf s[5]; // xx, xy, yy, xw, yw
    static const int first[5] = {0, 0, 1, 0, 1}, second[5] = {0, 1, 1, 2, 2};
    for (int k = 0; k < 5; k++)
        s[k] = wf_fma(tangents[0][first[k]], tangents[0][second[k]],
                      wf_mul(tangents[1][first[k]], tangents[1][second[k]]));
    const wf ww = wf_fma(tangents[0][2], tangents[0][2], wf_mul(tangents[1][2], tangents[1][2]));
    const wf room = wf_fnma(cutoff2, ww, wf_mul(t->w, t->w)), zero = wf_set(0), one = wf_set(1);
    const wm ellipse = wm_and(t->seen, wf_lt(zero, room));
    const wf k = wf_div(one, wf_select(ellipse, room, one));
    wf variance[3], shift[2], conic[3];
    wide_project(s, k, cutoff2, variance, shift);
    const wf xx = wf_add(variance[0], h2), xy = variance[1], yy = wf_add(variance[2], h2);
    const wf filtered = wf_fnma(xy, xy, wf_mul(xx, yy));
    const wm sound = wm_and(ellipse, wf_lt(zero, filtered));
    const wf inverse = wf_div(one, wf_select(sound, filtered, one));
    wide_conic(xx, xy, yy, wf_mul(inverse, wf_set(-HALF_LOG2_E)), conic);
    wf_store(e->xx, conic[0]);
    wf_store(e->xy, conic[1]);
    wf_store(e->yy, conic[2]);
    wf_store(e->amplitude, wf_mul(wf_mul(wf_set(block->area_scale), k), wf_sqrt(wf_mul(k, inverse))));
    const wf cutoff = wf_sqrt(cutoff2);
    return place(e, sound, wf_add(t->x, shift[0]), wf_add(t->y, shift[1]), wf_mul(cutoff, wf_sqrt(xx)),
                 wf_mul(cutoff, wf_sqrt(yy)));
}

static uint32_t splats(const ewa_texel_filter *filter, const ewa_texture_block *block,
                       const ewa_texture_sums *sums) {
    uint32_t drawn = 0;
    for (uint32_t row = 0; row < block->height; row++) {
        for (uint32_t first = 0; first < block->width; first += 16) {
            const texels t = project(block, row, first);
            ellipses e;
            const uint32_t hits = splat_ellipses(filter, block, &t, &e);
            if (!hits) continue;
            add_ellipses(filter, &e, hits, (float(*)[4])(uintptr_t)&block->colors[row][first], sums);
            drawn += (uint32_t)__builtin_popcount(hits);
        }
    }
    return drawn;
}

const ewa_texture_kernels EWA_VERSION(ewa_texture_kernels) = {points, splats, resolve};
