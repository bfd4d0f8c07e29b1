// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: points, summed over a depth unit, then composited (docs/math.md section 12).
//
// Based on: X. Yuan, M. Nguyen, H. Xu, B. Chen, "Hybrid Forward Resampling and Volume Rendering", 2003,
// section 4.1.
#ifndef EWA_SRC_VOLUME_KERNELS_POINTS_H
#define EWA_SRC_VOLUME_KERNELS_POINTS_H

#include "volume/kernels_append.h"
#include "volume/kernels_over.h"

/// 1 - exp(-t) for t >= 0, within 3e-7 of itself also where t is small: with t = ln 2 (n - f), n whole and f
/// in [-1/2, 1/2], it is (1 - 2^-n) - 2^-n (2^f - 1).
static ALWAYS_INLINE wf absorbed(wf t) {
    const wf bits = wf_min(wf_mul(t, wf_set(1.44269504f)), wf_set(100));
    const wf whole = wf_floor(wf_add(bits, wf_set(0.5f))), f = wf_sub(whole, bits), f2 = wf_mul(f, f);
    // 2^f - 1 = f (a + b f + f^2 (c + d f + f^2 (e + g f))), of ln(2)^k / k!
    const wf low = wf_fma(f, wf_set(2.40226507e-1f), wf_set(6.93147181e-1f));
    const wf middle = wf_fma(f, wf_set(9.61812911e-3f), wf_set(5.55041087e-2f));
    const wf high = wf_fma(f, wf_set(1.54035304e-4f), wf_set(1.33335581e-3f));
    const wf change = wf_mul(f, wf_fma(f2, wf_fma(f2, high, middle), low));
    const wf scale = wf_of_bits(wi_shl(wi_sub(wi_set(127), wi_from_f(whole)), 23));
    return wf_fnma(scale, change, wf_sub(wf_set(1), scale));
}

/// The share of a voxel of depth z that lies in front of a block's opaque surfaces, and within the section planes.
static ALWAYS_INLINE wf share_in_front(const ewa_volume_view *view, const ewa_volume_tile *tile, size_t block,
                                       wf z) {
    const wf deviation = wf_set(view->depth_deviation);
    const wf share = share_ahead(wf_load(tile->surface + 16 * block), z, deviation);
    if (!view->with_sections) return share;
    return wf_max(wf_sub(share, share_ahead(wf_load(tile->enter + 16 * block), z, deviation)), wf_set(0));
}

/// Composites `weight`, the light that is absorbed, of a colour behind a block's pixels.
static ALWAYS_INLINE void absorb(const ewa_volume_view *view, float *pixels, wf weight, const wf color[3],
                                 wf z) {
    const wf through = wf_load(pixels + 48);
    add_light(pixels, weight, color);
    wf rest = wf_sub(through, weight);
    rest = wf_keep(wf_lt(wf_set(0x1p-90f), rest), rest); // the same as 0, and fast
    wf_store(pixels + 48, rest);
    if (view->with_depth) {
        const wf depth = wf_load(pixels + 64);
        wf_store(pixels + 64, note_depth(depth, wf_set(0.5f), through, rest, z));
    }
}

/// Hides a cell in which nothing more would show.
static ALWAYS_INLINE void hide_saturated(const ewa_volume_view *view, ewa_volume_tile *tile, uint32_t cell,
                                         const float *pixels) {
    if (!wm_bits(wf_lt(wf_set(view->minimum_transmittance), wf_load(pixels + 48)))) ewa_hide_cell(tile, cell);
}

static ALWAYS_INLINE void sum_bucket(ewa_volume_tile *tile, const ewa_volume_bucket *bucket,
                                     const ewa_point_filter *filter, bool some_hidden) {
    const float *taps = (*filter)[0];
    float *sums = tile->sums;
    const ewa_volume_pages pages = tile->pages;
    uint32_t page = bucket->first_page;
    for (uint32_t left = ewa_bucket_count(bucket); left;) {
        const uint32_t first = page * EWA_PAGE_RECORDS;
        const uint32_t here = left < EWA_PAGE_RECORDS ? left : EWA_PAGE_RECORDS;
        for (uint32_t number = first; number < first + here; number++) {
            const uint32_t window = (uint32_t)pages.windows[number], begin = window >> 18, cell = begin / 4;
            if (some_hidden && is_window_hidden(tile->hidden + cell)) continue;
            // The window lies in two strips of the sums, or in one, and the other gets nothing. Rows of
            // strips never lie across lines of the cache, and what was stored can be read again at once.
            const float *across = taps + (window & 511), *down = taps + (window >> 9 & 511);
            const wf color = wf_repeat4(pages.colors[number]);
            const wf left_part = wf_mul(color, wf_spread4(across));
            const wf right_part = wf_mul(color, wf_spread4(across + 4));
            float *to = sums + (size_t)begin * 16;
            for (int row = 0; row < 4; row++, to += 16) {
                const wf share = wf_set(down[row]);
                wf_store(to, wf_fma(left_part, share, wf_load(to)));
                wf_store(to + EWA_SUMS_STRIP, wf_fma(right_part, share, wf_load(to + EWA_SUMS_STRIP)));
            }
            memset(tile->touched + cell, 1, 2);
            memset(tile->touched + cell + EWA_SUMS_ROW_BLOCKS, 1, 2);
        }
        left -= here;
        page = pages.next[page];
    }
}

static void sum_points(ewa_volume_tile *tile, const ewa_volume_bucket *bucket,
                       const ewa_point_filter *filter) {
    if (tile->visible_count < tile->cell_count)
        sum_bucket(tile, bucket, filter, true);
    else
        sum_bucket(tile, bucket, filter, false);
}

/// Composites the sums of a cell.
static ALWAYS_INLINE void composite_cell(const ewa_volume_view *view, ewa_volume_tile *tile, uint32_t cell,
                                         const float *sums, wf depth) {
    const uint32_t row = cell % EWA_SUMS_ROW_BLOCKS - 1, column = cell / EWA_SUMS_ROW_BLOCKS - 1;
    const size_t block = row * EWA_VOLUME_ROW_BLOCKS + column;
    float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
    wf sum[4];
    w_load4(sums, 16, sum);
    wf t = sum[3];
    if (view->with_surface) t = wf_mul(t, share_in_front(view, tile, block, depth));
    const wf weight = wf_mul(wf_load(pixels + 48), absorbed(t));
    const wm some = wf_lt(wf_set(1e-30f), sum[3]);
    // The weight goes to the mean colour of what was summed.
    const wf mean = wf_keep(some, wf_div(wf_set(1), wf_select(some, sum[3], wf_set(1))));
    for (int c = 0; c < 3; c++) sum[c] = wf_mul(sum[c], mean);
    absorb(view, pixels, weight, sum, depth);
    hide_saturated(view, tile, cell, pixels);
}

static void composite(const ewa_volume_view *view, ewa_volume_tile *tile, float z) {
    const wf depth = wf_set(z), zero = wf_set(0);
    for (uint32_t first = 0; first < EWA_SUMS_CELL_ROOM; first += 8) {
        uint64_t touched;
        memcpy(&touched, tile->touched + first, sizeof touched);
        if (!touched) continue;
        for (uint32_t cell = first; cell < first + sizeof touched; cell++) {
            if (!tile->touched[cell]) continue;
            float *sums = tile->sums + (size_t)cell * 64;
            if (!tile->hidden[cell]) composite_cell(view, tile, cell, sums, depth);
            for (int i = 0; i < 4; i++) wf_store(sums + 16 * i, zero);
        }
        memset(tile->touched + first, 0, sizeof touched);
    }
}

#endif
