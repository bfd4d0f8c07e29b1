// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: splats with the exact perspective ellipse, composited one by one (docs/math.md
// sections 3 and 12).
//
// Based on: X. Yuan, M. Nguyen, H. Xu, B. Chen, "Hybrid Forward Resampling and Volume Rendering", 2003,
// section 4.2 and appendix A.
//
// The footprint's index. Over the offset from the ellipse's centre, both F^2 - m^2 (m: the ray's Mahalanobis
// distance) times the ray's x Sigma^-1 x and 1 - i^2 are quadratic and vanish on the rim, so that
// m^2 = F^2 (1 - (1 - i^2) / rho) with rho = x Sigma^-1 x (p_z^2 - F^2 Sigma33) / (p Sigma^-1 p - F^2): exact
// off the axis too, without a large number that cancels. On the axis of a sphere rho = 1 + i^2 tan^2 alpha,
// which is the paper's formula.
#ifndef EWA_SRC_VOLUME_KERNELS_SPLATS_H
#define EWA_SRC_VOLUME_KERNELS_SPLATS_H

#include "volume/kernels_points.h"
#include "wide/wide_ellipse.h"

/// What a splat's pixels need, lane by lane.
enum {
    SPLAT_X, ///< of the ellipse's centre in the tile
    SPLAT_Y,
    SPLAT_XX, ///< conic: i^2 = XX dx^2 + XY dx dy + YY dy^2
    SPLAT_XY,
    SPLAT_YY,
    SPLAT_RHO,                  ///< rho: 1, dx, dy, dx^2, dx dy, dy^2
    SPLAT_PEAK = SPLAT_RHO + 6, ///< optical depth in the middle
    SPLAT_R,
    SPLAT_G,
    SPLAT_B,
    SPLAT_Z,
    SPLAT_LEFT, ///< box of the ellipse, px in the tile
    SPLAT_RIGHT,
    SPLAT_TOP,
    SPLAT_BOTTOM,
    SPLAT_SINE2, ///< sin^2 alpha
    SPLAT_FIELDS,
};

/// Reads records, whose numbers are given, lane by lane.
static void load_records(const ewa_volume_pages *pages, const uint32_t *order, uint32_t count,
                         float fields[8][16]) {
    for (uint32_t lane = 0; lane < 16; lane++) {
        const uint32_t number = order[lane < count ? lane : 0];
        for (int c = 0; c < 4; c++) fields[c][lane] = pages->colors[number][c];
        fields[4][lane] = pages->splats[number].x_px;
        fields[5][lane] = pages->splats[number].y_px;
        fields[6][lane] = pages->splats[number].z;
    }
}

/// The true ellipse: V over the normalised image plane (orthographic: camera units), and how far its centre
/// lies from the voxel's projection.
static ALWAYS_INLINE void true_ellipse(const ewa_volume_view *view, wf x, wf y, wf z, wf v[3], wf shift[2]) {
    const float *s = view->covariance;
    if (view->orthographic) {
        v[0] = wf_set(s[0]), v[1] = wf_set(s[1]), v[2] = wf_set(s[3]);
        shift[0] = shift[1] = wf_set(0);
        return;
    }
    const wf s33 = wf_set(s[5]);
    const wf s13 = wf_fnma(x, s33, wf_set(s[2])), s23 = wf_fnma(y, s33, wf_set(s[4]));
    const wf s11 = wf_fnma(x, wf_add(s13, wf_set(s[2])), wf_set(s[0]));
    const wf s12 = wf_fnma(x, s23, wf_fnma(y, wf_set(s[2]), wf_set(s[1])));
    const wf s22 = wf_fnma(y, wf_add(s23, wf_set(s[4])), wf_set(s[3]));
    // -1 / D33 > 0
    const wf cutoff2 = wf_set(view->cutoff2);
    const wf inverse = wf_div(wf_set(1), wf_fnma(cutoff2, s33, wf_mul(z, z)));
    wide_project((const wf[5]){s11, s12, s22, s13, s23}, inverse, cutoff2, v, shift);
}

/// Coefficients of rho over offsets in the filtered ellipse; `m` takes these to the true one, normalised.
static ALWAYS_INLINE void set_rho(const ewa_volume_view *view, wf x, wf y, wf z, const wf shift[2],
                                  const wf m[3], wf place2, wf rho[6]) {
    const float *inv = view->inverse;
    const wf xx = wf_set(inv[0]), xy = wf_set(inv[1]), yy = wf_set(inv[3]), two = wf_set(2);
    const wf z2 = wf_mul(z, z);
    const wf k = wf_div(wf_fnma(wf_set(view->cutoff2), wf_set(view->covariance[5]), z2),
                        wf_fnma(wf_set(view->cutoff2), wf_set(1), wf_mul(place2, z2)));
    const wf gx = wf_fma(xx, x, wf_fma(xy, y, wf_set(inv[2])));
    const wf gy = wf_fma(xy, x, wf_fma(yy, y, wf_set(inv[4])));
    const wf ax = wf_fma(xx, shift[0], wf_mul(xy, shift[1])), ay = wf_fma(xy, shift[0], wf_mul(yy, shift[1]));
    const wf along = wf_fma(shift[0], wf_fma(two, gx, ax), wf_mul(shift[1], wf_fma(two, gy, ay)));
    rho[0] = wf_mul(k, wf_add(place2, along));
    const wf ex = wf_mul(wf_mul(two, k), wf_add(gx, ax)), ey = wf_mul(wf_mul(two, k), wf_add(gy, ay));
    rho[1] = wf_fma(ex, m[0], wf_mul(ey, m[1]));
    rho[2] = wf_mul(ey, m[2]);
    const wf bx = wf_fma(xx, m[0], wf_mul(xy, m[1])), by = wf_fma(xy, m[0], wf_mul(yy, m[1]));
    rho[3] = wf_mul(k, wf_fma(bx, m[0], wf_mul(by, m[1])));
    rho[4] = wf_mul(wf_mul(two, k), wf_mul(by, m[2]));
    rho[5] = wf_mul(k, wf_mul(yy, wf_mul(m[2], m[2])));
}

static void set_splats(const ewa_volume_view *view, const ewa_volume_tile *tile, float in[8][16],
                       float out[SPLAT_FIELDS][16]) {
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px), one = wf_set(1), zero = wf_set(0);
    const wf px = wf_load(in[4]), py = wf_load(in[5]), z = wf_load(in[6]), h2 = wf_set(view->prefilter2_px2);
    const wf x = wf_div(wf_sub(px, wf_set(view->cx_px - (float)tile->x_px)), fx);
    const wf y = wf_div(wf_sub(py, wf_set(view->cy_px - (float)tile->y_px)), fy);
    wf v[3], shift[2], m[3], rho[6];
    true_ellipse(view, x, y, z, v, shift);
    const wf v11 = wf_mul(v[0], wf_mul(fx, fx)), v12 = wf_mul(v[1], wf_mul(fx, fy));
    const wf v22 = wf_mul(v[2], wf_mul(fy, fy));
    const wf w11 = wf_add(v11, h2), w22 = wf_add(v22, h2);
    const wf tiny = wf_set(1e-30f);
    const wf area = wf_max(wf_fnma(v12, v12, wf_mul(v11, v22)), tiny);
    const wf filtered = wf_max(wf_fnma(v12, v12, wf_mul(w11, w22)), tiny);
    // Cholesky factors: L of V, M of V'; m = L M^-1, over the focal lengths.
    const wf l0 = wf_sqrt(v11), m0 = wf_sqrt(w11), l2 = wf_sqrt(wf_div(area, v11));
    const wf m2 = wf_sqrt(wf_div(filtered, w11)), l1 = wf_div(v12, l0), m1 = wf_div(v12, m0);
    const wf ratio = wf_div(l2, m2);
    m[0] = wf_div(wf_div(l0, m0), fx);
    m[1] = wf_div(wf_div(wf_fnma(ratio, m1, l1), m0), fy);
    m[2] = wf_div(ratio, fy);
    // place2: p Sigma^-1 p / z^2
    const float *inv = view->inverse;
    wf place2 = wf_set(inv[5]), length = one, sine2 = zero;
    rho[0] = one;
    for (int i = 1; i < 6; i++) rho[i] = zero;
    if (!view->orthographic) {
        const wf gx = wf_fma(wf_set(inv[0]), x, wf_fma(wf_set(inv[1]), y, wf_set(2 * inv[2])));
        const wf gy = wf_fma(wf_set(inv[3]), y, wf_set(2 * inv[4]));
        place2 = wf_fma(gx, x, wf_fma(wf_mul(wf_set(inv[1]), x), y, wf_fma(gy, y, place2)));
        length = wf_sqrt(wf_fma(x, x, wf_fma(y, y, one)));
        sine2 = wf_div(wf_set(view->cutoff2), wf_mul(place2, wf_mul(z, z)));
        set_rho(view, x, y, z, shift, m, place2, rho);
    }
    const wf attenuation = wf_sqrt(wf_div(area, filtered));
    const wf peak = wf_mul(wf_mul(wf_load(in[3]), wf_set(view->splat_peak)),
                           wf_mul(attenuation, wf_div(length, wf_sqrt(place2))));
    const wf cx = wf_fma(shift[0], fx, px), cy = wf_fma(shift[1], fy, py);
    const wf reach_x = wf_mul(wf_set(view->cutoff), m0), reach_y = wf_mul(wf_set(view->cutoff), wf_sqrt(w22));
    wf_store(out[SPLAT_X], cx);
    wf_store(out[SPLAT_Y], cy);
    wf conic[3];
    wide_conic(w11, v12, w22, wf_div(one, wf_mul(filtered, wf_set(view->cutoff2))), conic);
    for (int i = 0; i < 3; i++) wf_store(out[SPLAT_XX + i], conic[i]);
    for (int i = 0; i < 6; i++) wf_store(out[SPLAT_RHO + i], rho[i]);
    wf_store(out[SPLAT_PEAK], wf_min(peak, wf_set(1e12f)));
    for (int c = 0; c < 3; c++) wf_store(out[SPLAT_R + c], wf_load(in[c]));
    wf_store(out[SPLAT_Z], z);
    wf_store(out[SPLAT_SINE2], sine2);
    wf_store(out[SPLAT_LEFT], wf_sub(cx, reach_x));
    wf_store(out[SPLAT_RIGHT], wf_add(cx, reach_x));
    wf_store(out[SPLAT_TOP], wf_sub(cy, reach_y));
    wf_store(out[SPLAT_BOTTOM], wf_add(cy, reach_y));
}

/// The row of the footprint table for a half angle, between two rows.
static void set_index_row(const ewa_volume_view *view, float sine2, float start[16], float growth[16]) {
    const float at = sine2 * (float)((EWA_FOOTPRINT_ANGLES - 1) / EWA_FOOTPRINT_END);
    const int row = at < EWA_FOOTPRINT_ANGLES - 2 ? (int)at : EWA_FOOTPRINT_ANGLES - 2;
    const wf share = wf_set(at - (float)row);
    const ewa_footprint_table *table = view->table;
    const wf start0 = wf_load(table->start[row]), growth0 = wf_load(table->growth[row]);
    wf_store(start, wf_fma(share, wf_sub(wf_load(table->start[row + 1]), start0), start0));
    wf_store(growth, wf_fma(share, wf_sub(wf_load(table->growth[row + 1]), growth0), growth0));
}

/// How d^2 is found.
typedef enum index_kind { INDEX_RAY, INDEX_TABLED, INDEX_FORMULA } index_kind;

static ALWAYS_INLINE void draw_splat(const ewa_volume_view *view, ewa_volume_tile *tile,
                                     float f[SPLAT_FIELDS][16], uint32_t lane, index_kind kind) {
    const wf one = wf_set(1), zero = wf_set(0);
    const float *s = &f[0][lane];
    float start[16], growth[16];
    if (kind == INDEX_TABLED) set_index_row(view, s[SPLAT_SINE2 * 16], start, growth);
    const float right = s[SPLAT_RIGHT * 16], bottom = s[SPLAT_BOTTOM * 16];
    const float last_x = (float)tile->width_px - 0.5f, last_y = (float)tile->height_px - 0.5f;
    if (!(right > 0.5f) || !(bottom > 0.5f) || !(s[SPLAT_LEFT * 16] < last_x) ||
        !(s[SPLAT_TOP * 16] < last_y))
        return;
    const uint32_t left_block = s[SPLAT_LEFT * 16] > 0 ? (uint32_t)s[SPLAT_LEFT * 16] / 4 : 0;
    const uint32_t top_block = s[SPLAT_TOP * 16] > 0 ? (uint32_t)s[SPLAT_TOP * 16] / 4 : 0;
    const uint32_t right_block = (uint32_t)(right < last_x ? right : last_x) / 4;
    const uint32_t bottom_block = (uint32_t)(bottom < last_y ? bottom : last_y) / 4;
    const wf rows = wf_spread4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f});
    const wf dx0 = wf_sub(wf_repeat4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f}), wf_set(s[SPLAT_X * 16]));
    const wf dy0 = wf_sub(rows, wf_set(s[SPLAT_Y * 16]));
    const wf xx = wf_set(s[SPLAT_XX * 16]), xy = wf_set(s[SPLAT_XY * 16]), yy = wf_set(s[SPLAT_YY * 16]);
    const wf peak = wf_set(s[SPLAT_PEAK * 16]), z = wf_set(s[SPLAT_Z * 16]);
    const wf exponent = wf_set(-0.721347520f * view->cutoff2); // log2(e) / 2
    const wf sine2 = wf_set(s[SPLAT_SINE2 * 16]);
    const wf color[3] = {wf_set(s[SPLAT_R * 16]), wf_set(s[SPLAT_G * 16]), wf_set(s[SPLAT_B * 16])};
    for (uint32_t row = top_block; row <= bottom_block; row++)
        for (uint32_t column = left_block; column <= right_block; column++) {
            const uint32_t cell = ewa_sums_cell(row, column);
            if (tile->hidden[cell]) continue;
            const wf dx = wf_add(dx0, wf_set((float)(4 * column))),
                     dy = wf_add(dy0, wf_set((float)(4 * row)));
            const wf i2 = wf_fma(dx, wf_fma(xx, dx, wf_mul(xy, dy)), wf_mul(wf_mul(yy, dy), dy));
            const wm inside = wf_lt(i2, one);
            if (!wm_bits(inside)) continue;
            wf d2;
            if (kind == INDEX_RAY) {
                const float *r = s + SPLAT_RHO * 16;
                const wf in_x = wf_fma(dx, wf_set(r[48]), wf_fma(dy, wf_set(r[64]), wf_set(r[16])));
                const wf rho =
                    wf_fma(dx, in_x, wf_fma(dy, wf_fma(dy, wf_set(r[80]), wf_set(r[32])), wf_set(r[0])));
                d2 = wf_sub(one, wf_div(wf_sub(one, i2), rho));
            } else if (kind == INDEX_TABLED) {
                const wf at = wf_mul(wf_max(i2, zero), wf_set(EWA_FOOTPRINT_STEPS));
                const wi step = wi_from_f(wf_min(at, wf_set(EWA_FOOTPRINT_STEPS - 1)));
                const wf share = wf_sub(at, wf_from_i(step));
                d2 = wf_add(i2, wf_fma(share, wf_lookup(growth, step), wf_lookup(start, step)));
            } else {
                d2 = wf_div(i2, wf_fnma(wf_sub(one, i2), sine2, one));
            }
            const size_t block = (size_t)row * EWA_VOLUME_ROW_BLOCKS + column;
            wf t = wf_keep(inside, wf_mul(peak, wf_exp2(wf_mul(exponent, d2))));
            if (view->with_surface) t = wf_mul(t, share_in_front(view, tile, block, z));
            float *pixels = tile->pixels + block * EWA_VOLUME_CHANNELS * 16;
            absorb(view, pixels, wf_mul(wf_load(pixels + 48), absorbed(t)), color, z);
            hide_saturated(view, tile, cell, pixels);
        }
}

static void draw_splats(const ewa_volume_view *view, ewa_volume_tile *tile, const uint32_t *order,
                        uint32_t count) {
    float records[8][16], splats[SPLAT_FIELDS][16];
    memset(records, 0, sizeof records);
    for (uint32_t first = 0; first < count; first += 16) {
        const uint32_t here = count - first < 16 ? count - first : 16;
        load_records(&tile->pages, order + first, here, records);
        set_splats(view, tile, records, splats);
        for (uint32_t lane = 0; lane < here; lane++) {
            if (view->exact || view->orthographic)
                draw_splat(view, tile, splats, lane, INDEX_RAY);
            else if (splats[SPLAT_SINE2][lane] <= (float)EWA_FOOTPRINT_END)
                draw_splat(view, tile, splats, lane, INDEX_TABLED);
            else
                draw_splat(view, tile, splats, lane, INDEX_FORMULA);
        }
    }
}

#endif
