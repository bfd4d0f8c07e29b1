// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: voxels at the eye, ray by ray. Their kernels reach to or behind the eye, where
// there is no ellipse, and what is behind it does not count (docs/math.md section 12).
//
// In standard deviations along i, j, k every kernel is the same ball. A ray of direction g, |g| = 1, passes a
// voxel at d after t = d g at the distance m, m^2 = d^2 - t^2; of its Gaussian the share Phi(t) lies ahead of
// the eye.
#ifndef EWA_SRC_VOLUME_KERNELS_NEAR_H
#define EWA_SRC_VOLUME_KERNELS_NEAR_H

#include "volume/kernels_points.h"

static uint32_t append_near(const ewa_volume_view *view, const ewa_volume_source *source,
                            ewa_near_voxel *voxels) {
    uint32_t added = 0;
    for (uint32_t first = 0; first < source->count; first += 16) {
        const uint32_t left = source->count - first;
        voxel_lanes v = place_voxels(view, source, first);
        const wf zero = wf_set(0);
        const wf density = wf_mul(wf_load(source->extinctions + first), wf_set(view->density));
        const wm near = wm_and(wf_lt(v.unit, zero), wf_lt(wf_set(-view->near), v.z));
        const uint32_t bits =
            wm_bits(wm_and(near, wf_lt(zero, density))) & (left < 16 ? (1u << left) - 1 : 0xffff);
        if (!bits) continue;
        // A voxel beside the eye has no slopes: its direction instead.
        const wf distance = wf_sqrt(dot3(v.place, v.place)), shrink = wf_max(distance, wf_set(1e-6f));
        v.x = wf_div(v.place[0], shrink), v.y = wf_div(v.place[1], shrink);
        v.ahead = wf_div(v.place[2], shrink), v.length = wf_set(1);
        lit_lanes lit = {wi_load(source->normals + first), v.x, v.y, v.ahead, v.length, {zero, zero, zero}};
        load_colors(view, source, first, lit.color);
        if (view->mark_splats) mark_colors(view, wm_of_bits(0xffff), lit.color);
        if (view->lit) shade_each(view, &lit, 1);
        wf d[3];
        const wf deviation = wf_set(view->deviations_per_step);
        for (int c = 0; c < 3; c++) d[c] = wf_mul(wf_add(v.steps[c], wf_set(source->from_eye[c])), deviation);
        float fields[10][16], units[16];
        for (int c = 0; c < 3; c++) {
            wf_store(fields[c], d[c]);
            wf_store(fields[4 + c], lit.color[c]);
        }
        wf_store(fields[3], dot3(d, d));
        wf_store(fields[7], wf_min(density, wf_set(1e18f)));
        wf_store(fields[8], v.z);
        wf_store(fields[9], distance);
        wf_store(units, wf_max(v.unit, wf_set(-1e6f)));
        for (uint32_t rest = bits; rest; rest &= rest - 1) {
            const int lane = __builtin_ctz(rest);
            ewa_near_voxel *to = &voxels[added++];
            for (int c = 0; c < 3; c++) to->offset[c] = fields[c][lane], to->color[c] = fields[4 + c][lane];
            to->square = fields[3][lane];
            to->extinction = fields[7][lane];
            to->z = fields[8][lane];
            to->distance = fields[9][lane];
            to->slice = (int32_t)units[lane];
        }
    }
    return added;
}

/// Rays of a block of 4x4 pixels: directions in standard deviations, and the optical depth per extinction
/// through a voxel's middle.
static ALWAYS_INLINE void set_rays(const ewa_volume_view *view, const ewa_volume_tile *tile, uint32_t row,
                                   uint32_t column, wf ray[3], wf *peak) {
    const wf steps_x = wf_repeat4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f});
    const wf steps_y = wf_spread4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f});
    const wf left = wf_set((float)(tile->x_px + 4 * (int32_t)column) - view->cx_px);
    const wf top = wf_set((float)(tile->y_px + 4 * (int32_t)row) - view->cy_px);
    const wf x = wf_div(wf_add(left, steps_x), wf_set(view->fx_px));
    const wf y = wf_div(wf_add(top, steps_y), wf_set(view->fy_px)), one = wf_set(1);
    for (int c = 0; c < 3; c++) ray[c] = row_dot(&view->to_deviations[0][c], 3, x, y, one);
    const wf length = wf_sqrt(wf_fma(x, x, wf_fma(y, y, one))), stretched = wf_sqrt(dot3(ray, ray));
    for (int c = 0; c < 3; c++) ray[c] = wf_div(ray[c], stretched);
    *peak = wf_mul(wf_set(view->splat_peak), wf_div(length, stretched));
}

static void draw_near(const ewa_volume_view *view, ewa_volume_tile *tile, const ewa_near_voxel *voxels,
                      uint32_t count) {
    const wf zero = wf_set(0), exponent = wf_set(-0.721347520f); // -log2(e) / 2
    for (uint32_t row = 0; row < EWA_VOLUME_ROW_BLOCKS; row++)
        for (uint32_t column = 0; column < EWA_VOLUME_ROW_BLOCKS; column++) {
            const uint32_t cell = ewa_sums_cell(row, column);
            if (tile->hidden[cell]) continue;
            const size_t block = (size_t)row * EWA_VOLUME_ROW_BLOCKS + column;
            float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
            wf ray[3], peak;
            set_rays(view, tile, row, column, ray, &peak);
            for (const ewa_near_voxel *at = voxels; at < voxels + count; at++) {
                const wf t =
                    wf_fma(ray[0], wf_set(at->offset[0]),
                           wf_fma(ray[1], wf_set(at->offset[1]), wf_mul(ray[2], wf_set(at->offset[2]))));
                const wf m2 = wf_max(wf_fnma(t, t, wf_set(at->square)), zero);
                const wm inside = wm_and(wf_lt(m2, wf_set(view->cutoff2)), wf_lt(wf_set(-view->cutoff), t));
                if (!wm_bits(inside)) continue;
                const wf ahead = share_below(t);
                const wf whole = wf_mul(wf_set(at->extinction), wf_mul(peak, wf_exp2(wf_mul(exponent, m2))));
                const wf z = wf_set(at->z > 0 ? at->z : 0);
                wf depth = wf_keep(inside, wf_min(wf_mul(whole, ahead), wf_set(1e12f)));
                if (view->with_surface)
                    depth = wf_mul(depth, share_in_front(view, tile, block, wf_set(at->z)));
                const wf color[3] = {wf_set(at->color[0]), wf_set(at->color[1]), wf_set(at->color[2])};
                absorb(view, pixels, wf_mul(wf_load(pixels + 48), absorbed(depth)), color, z);
                hide_saturated(view, tile, cell, pixels);
                if (tile->hidden[cell]) break;
            }
        }
}

#endif
