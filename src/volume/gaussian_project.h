// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of gaussian_body.h: from sixteen splats to records of those that some pixel may show (docs/math.md
// sections 3, 4 and 12).
//
// All about a splat's shape comes from its three axes, never from entries of its covariance, of which flat
// ones leave nothing in single precision.
//
// Based on: Kerbl, Kopanas, Leimkuehler, Drettakis, "3D Gaussian Splatting for Real-Time Radiance Field
// Rendering", 2023 (the trained projection, harmonics); Duff et al., "Building an Orthonormal Basis,
// Revisited", 2017.
#ifndef EWA_SRC_VOLUME_GAUSSIAN_PROJECT_H
#define EWA_SRC_VOLUME_GAUSSIAN_PROJECT_H

#include "volume/gaussian_kernels.h"
#include "volume/gaussian_view.h"
#include "wide/wide_ellipse.h"
#include "wide/wide_functions.h"

/// Sixteen splats in camera space.
typedef struct splat_lanes {
    wf place[3];     ///< of the centre
    wf direction[3]; ///< from the eye, unit, world axes
    wf axes[3][3];   ///< unit
    wf scales[3];
    wf cutoff2;
    wf depth_reach;   ///< F sqrt(Sigma33)
    wf x, y, inverse; ///< perspective: slopes and 1 / z; orthographic: x and y
} splat_lanes;

/// Where dots are that there are not.
static const float NO_DOT_PX = 1e15f;

static ALWAYS_INLINE wf dot(const wf a[3], const wf b[3]) {
    return wf_fma(a[0], b[0], wf_fma(a[1], b[1], wf_mul(a[2], b[2])));
}

/// A row of three numbers times sixteen columns of three.
static ALWAYS_INLINE wf turn_row(const float row[3], const wf v[3]) {
    return wf_fma(wf_set(row[0]), v[0], wf_fma(wf_set(row[1]), v[1], wf_mul(wf_set(row[2]), v[2])));
}

/// Columns of the rotation by a unit quaternion.
static ALWAYS_INLINE void quaternion_axes(const wf q[4], wf axes[3][3]) {
    const wf one = wf_set(1), two = wf_set(2), w = q[0], x = q[1], y = q[2], z = q[3];
    axes[0][0] = wf_fnma(two, wf_fma(y, y, wf_mul(z, z)), one);
    axes[1][1] = wf_fnma(two, wf_fma(x, x, wf_mul(z, z)), one);
    axes[2][2] = wf_fnma(two, wf_fma(x, x, wf_mul(y, y)), one);
    const wf wx = wf_mul(w, x), wy = wf_mul(w, y), wz = wf_mul(w, z);
    axes[0][1] = wf_mul(two, wf_fma(x, y, wz)), axes[1][0] = wf_mul(two, wf_sub(wf_mul(x, y), wz));
    axes[2][0] = wf_mul(two, wf_fma(x, z, wy)), axes[0][2] = wf_mul(two, wf_sub(wf_mul(x, z), wy));
    axes[1][2] = wf_mul(two, wf_fma(y, z, wx)), axes[2][1] = wf_mul(two, wf_sub(wf_mul(y, z), wx));
}

/// Places the splats and says which of them may show by their depth and opacity.
static ALWAYS_INLINE wm place_splats(const ewa_gaussian_view *view, const ewa_splat_packet *packet,
                                     splat_lanes *s) {
    wf center[3], world[3][3], q[4], offset[3];
    const wf opacity = wf_load((*packet)[EWA_SPLAT_OPACITY]);
    const wf unit = wf_set(view->set_unit);
    for (int i = 0; i < 3; i++) center[i] = wf_mul(unit, wf_load((*packet)[EWA_SPLAT_PLACE + i]));
    for (int i = 0; i < 4; i++) q[i] = wf_load((*packet)[EWA_SPLAT_ROTATION + i]);
    for (int i = 0; i < 3; i++) {
        s->place[i] = wf_add(turn_row(view->turn[i], center), wf_set(view->origin[i]));
        s->scales[i] = wf_max(wf_mul(unit, wf_load((*packet)[EWA_SPLAT_SCALE + i])), wf_set(1e-12f));
        offset[i] = wf_sub(center[i], wf_set(view->eye[i]));
    }
    quaternion_axes(q, world);
    wf depth2 = wf_set(0);
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) s->axes[i][c] = turn_row(view->turn[c], world[i]);
        const wf t = wf_mul(s->scales[i], s->axes[i][2]);
        depth2 = wf_fma(t, t, depth2);
    }
    // Where its alpha falls to the lowest one that is drawn.
    const wf seen = wf_sub(wf_log2(wf_max(opacity, wf_set(1e-30f))), wf_set(view->log2_min));
    s->cutoff2 = wf_min(wf_mul(seen, wf_set(1.38629436f)), wf_set(view->cutoff2)); // 2 ln 2
    const wm shows = wf_lt(wf_set(0), s->cutoff2);
    s->cutoff2 = wf_max(s->cutoff2, wf_set(0));
    s->depth_reach = wf_sqrt(wf_mul(s->cutoff2, depth2));
    if (view->orthographic) {
        for (int i = 0; i < 3; i++) s->direction[i] = wf_set(view->forward[i]);
        s->x = s->place[0], s->y = s->place[1], s->inverse = wf_set(1);
        return shows;
    }
    const wf shrink = wf_div(wf_set(1), wf_sqrt(wf_max(dot(offset, offset), wf_set(1e-36f))));
    for (int i = 0; i < 3; i++) s->direction[i] = wf_mul(offset[i], shrink);
    s->inverse = wf_div(wf_set(1), s->place[2]);
    s->x = wf_mul(s->place[0], s->inverse), s->y = wf_mul(s->place[1], s->inverse);
    const wf depth = view->trained || view->flat ? s->place[2] : wf_add(s->place[2], s->depth_reach);
    return wm_and(shows, wf_lt(wf_set(view->near), depth));
}

/// The true ellipse in pixels: V, and how far its centre lies from the projected one. Returns |V|, a sum of
/// squares over pairs of axes, so that it holds for flat splats that are seen from the edge. `dot`: of `view->flat` from
/// there to the middle of the dot, and 1 where there is one.
static ALWAYS_INLINE wf true_ellipse(const ewa_gaussian_view *view, const splat_lanes *s, wf v[3], wf shift[2],
                                     wf dot[3]) {
    const wf zero = wf_set(0);
    wf x = s->x, y = s->y, cutoff2 = s->cutoff2;
    if (view->trained || view->orthographic) {
        x = wf_min(wf_max(x, wf_set(view->slopes[0])), wf_set(view->slopes[1]));
        y = wf_min(wf_max(y, wf_set(view->slopes[2])), wf_set(view->slopes[3]));
        cutoff2 = zero;
    }
    if (view->orthographic) x = y = zero;
    // Sheared axes, which lay the centre onto the camera's axis.
    wf sums[5] = {zero, zero, zero, zero, zero}, depth2 = zero, tx[4], ty[4];
    for (int i = 0; i < 3; i++) {
        const wf tz = wf_mul(s->scales[i], s->axes[i][2]);
        tx[i] = wf_mul(s->scales[i], wf_fnma(x, s->axes[i][2], s->axes[i][0]));
        ty[i] = wf_mul(s->scales[i], wf_fnma(y, s->axes[i][2], s->axes[i][1]));
        sums[0] = wf_fma(tx[i], tx[i], sums[0]);
        sums[1] = wf_fma(tx[i], ty[i], sums[1]);
        sums[2] = wf_fma(ty[i], ty[i], sums[2]);
        sums[3] = wf_fma(tx[i], tz, sums[3]);
        sums[4] = wf_fma(ty[i], tz, sums[4]);
        depth2 = wf_fma(tz, tz, depth2);
    }
    wf k = wf_set(1);
    if (!view->orthographic) k = wf_div(k, wf_fnma(cutoff2, depth2, wf_mul(s->place[2], s->place[2])));
    wide_project(sums, k, cutoff2, v, shift);
    if (view->flat) {
        const wf wide = wf_set(view->orthographic ? 0 : EWA_GAUSSIAN_DOT_CUTOFF * EWA_GAUSSIAN_DOT_CUTOFF);
        const wf left = wf_fnma(wide, depth2, wf_mul(s->place[2], s->place[2]));
        wf unused[3];
        dot[2] = wf_keep(view->orthographic ? wf_le(zero, zero) : wf_lt(zero, left), wf_set(1));
        wide_project(sums, view->orthographic ? k : wf_div(wf_set(1), wf_max(left, wf_set(1e-36f))), wide, unused, dot);
        dot[0] = wf_mul(wf_sub(dot[0], shift[0]), wf_set(view->fx_px));
        dot[1] = wf_mul(wf_sub(dot[1], shift[1]), wf_set(view->fy_px));
    }
    // V / k is the Gram matrix of four: the sheared axes, and F sqrt(k) (Sigma13, Sigma23).
    const wf far = wf_sqrt(wf_max(wf_mul(cutoff2, k), zero));
    tx[3] = wf_mul(far, sums[3]), ty[3] = wf_mul(far, sums[4]);
    wf area = zero;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            const wf minor = wf_fnma(tx[j], ty[i], wf_mul(tx[i], ty[j]));
            area = wf_fma(minor, minor, area);
        }
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px);
    v[0] = wf_mul(v[0], wf_mul(fx, fx)), v[1] = wf_mul(v[1], wf_mul(fx, fy)),
    v[2] = wf_mul(v[2], wf_mul(fy, fy));
    shift[0] = wf_mul(shift[0], fx), shift[1] = wf_mul(shift[1], fy);
    const wf scale = wf_mul(k, wf_mul(fx, fy));
    return wf_mul(area, wf_mul(scale, scale));
}

/// Rays in standard deviations: g(d) = rows[k] d, turned so that the third points to the centre; returns how
/// far that is. Orthographic: the third points along the rays, and a unit of depth is as far.
static ALWAYS_INLINE wf ray_rows(const ewa_gaussian_view *view, const splat_lanes *s, wf rows[3][3]) {
    wf to[3], inverse[3];
    for (int i = 0; i < 3; i++) {
        inverse[i] = wf_div(wf_set(1), s->scales[i]);
        to[i] = wf_mul(inverse[i], view->orthographic ? s->axes[i][2] : dot(s->axes[i], s->place));
    }
    const wf one = wf_set(1), length = wf_max(wf_sqrt(dot(to, to)), wf_set(1e-18f));
    const wf x = wf_div(to[0], length), y = wf_div(to[1], length), z = wf_div(to[2], length);
    const wf sign = wf_select(wf_lt(z, wf_set(0)), wf_set(-1), one);
    const wf a = wf_div(wf_set(-1), wf_add(sign, z)), b = wf_mul(wf_mul(x, y), a);
    const wf basis[3][3] = {
        {wf_fma(wf_mul(sign, x), wf_mul(x, a), one), wf_mul(sign, b), wf_mul(wf_sub(wf_set(0), sign), x)},
        {b, wf_fma(y, wf_mul(y, a), sign), wf_sub(wf_set(0), y)},
        {x, y, z}};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) {
            rows[k][c] = wf_set(0);
            for (int i = 0; i < 3; i++)
                rows[k][c] = wf_fma(wf_mul(basis[k][i], inverse[i]), s->axes[i][c], rows[k][c]);
        }
    return length;
}

/// The variance of what the ellipse is thickened by: that of the filter, or what takes in the dot.
static ALWAYS_INLINE wf thickness(const ewa_gaussian_view *view, const splat_lanes *s, const wf dot[3]) {
    if (!view->flat) return wf_set(view->prefilter_px2);
    const wf away = wf_sqrt(wf_fma(dot[0], dot[0], wf_mul(dot[1], dot[1])));
    const wf cutoff = wf_max(wf_sqrt(s->cutoff2), wf_set(1e-3f));
    const wf reach = wf_fma(dot[2], wf_div(away, cutoff), wf_sqrt(wf_set(view->dot_px2)));
    return wf_mul(reach, reach);
}

/// Sets the ellipse's part of records: lower triangles L of V and M of V', of which `map` becomes L M^-1
/// where pixels look up at the same place of the true ellipse, else 1; V' is V thickened by `h2`. Returns what the filter
/// leaves of the height.
static ALWAYS_INLINE wf set_ellipse(const ewa_gaussian_view *view, const splat_lanes *s, const wf v[3],
                                    wf area, wf h2, wf record[], wf lower[3], wf map[3]) {
    const wf tiny = wf_set(1e-12f), one = wf_set(1);
    const wf w11 = wf_max(wf_add(v[0], h2), tiny), w22 = wf_max(wf_add(v[2], h2), tiny);
    const wf filtered = wf_max(wf_fma(h2, wf_add(wf_add(v[0], v[2]), h2), area), wf_set(1e-24f));
    const wf root = wf_sqrt(wf_div(w22, filtered)), cutoff = wf_sqrt(s->cutoff2);
    record[RECORD_AX] = root;
    record[RECORD_AY] = wf_mul(root, wf_div(wf_sub(wf_set(0), v[1]), w22));
    record[RECORD_BY] = wf_div(one, wf_sqrt(w22));
    record[RECORD_LIMIT] = s->cutoff2;
    record[RECORD_REACH] = wf_mul(cutoff, wf_sqrt(w22));
    lower[0] = wf_sqrt(w11), lower[1] = wf_div(v[1], lower[0]), lower[2] = wf_sqrt(wf_div(filtered, w11));
    record[RECORD_TOUCH] = wf_mul(cutoff, lower[1]);
    const wf fall = wf_div(h2, filtered);
    map[0] = wf_fnma(fall, w22, one), map[2] = wf_fnma(fall, w11, one), map[1] = wf_mul(fall, v[1]);
    if (view->flat) {
        map[0] = map[2] = one, map[1] = wf_set(0);
    } else if (!view->trained) {
        const wf v11 = wf_max(v[0], tiny), l0 = wf_sqrt(v11), l1 = wf_div(v[1], l0),
                 l2 = wf_sqrt(wf_div(area, v11));
        map[2] = wf_div(l2, lower[2]);
        map[0] = wf_div(l0, lower[0]);
        map[1] = wf_div(wf_fnma(map[2], lower[1], l1), lower[0]);
    }
    return view->keep ? wf_sqrt(wf_max(wf_div(area, filtered), wf_set((float)EWA_GAUSSIAN_MIN_KEPT))) : one;
}

/// Sets the rays' part of records: over the offset from the ellipse's centre, which `shift` and `map` take to
/// that from the projected one.
static ALWAYS_INLINE void set_rays(const ewa_gaussian_view *view, const splat_lanes *s, wf rows[3][3],
                                   const wf shift[2], const wf map[3], wf record[]) {
    const wf fx = wf_div(wf_set(1), wf_set(view->fx_px)), fy = wf_div(wf_set(1), wf_set(view->fy_px));
    const wf length = record[RECORD_LENGTH];
    for (int k = 0; k < 3; k++) {
        wf x = wf_mul(rows[k][0], fx), y = wf_mul(rows[k][1], fy), at = wf_set(0);
        if (view->orthographic && k == 2) {
            const wf shrink = wf_div(wf_set(-1), length);
            x = wf_mul(x, shrink), y = wf_mul(y, shrink), at = s->place[2];
        } else if (k == 2) {
            at = wf_mul(length, s->inverse);
        }
        record[RECORD_G + 3 * k] = wf_fma(x, map[0], wf_mul(y, map[1]));
        record[RECORD_G + 3 * k + 1] = wf_fma(y, map[2], view->trained ? wf_mul(x, map[1]) : wf_set(0));
        record[RECORD_G + 3 * k + 2] = wf_fma(x, shift[0], wf_fma(y, shift[1], at));
    }
}

/// How much a linear function of a record varies over the ellipse.
static ALWAYS_INLINE wf vary(const wf record[], int at, const wf lower[3]) {
    const wf x = record[at], y = record[at + 1];
    const wf across = wf_fma(x, lower[0], wf_mul(y, lower[1])), down = wf_mul(y, lower[2]);
    return wf_sqrt(wf_mul(record[RECORD_LIMIT], wf_fma(across, across, wf_mul(down, down))));
}

/// The depths that pixels of the ellipse see a splat at: z = length / (g3 + (g1^2 + g2^2) / g3) over the
/// ranges of its functions, and within the splat's own depth range.
static ALWAYS_INLINE void set_depths(const ewa_gaussian_view *view, const splat_lanes *s, const wf lower[3],
                                     wf record[]) {
    const wf z = s->place[2], low = wf_sub(z, s->depth_reach), high = wf_add(z, s->depth_reach);
    const wf middle = record[RECORD_G + 8], half = vary(record, RECORD_G + 6, lower);
    const wf minimum = wf_sub(middle, half), maximum = wf_add(middle, half), zero = wf_set(0),
             little = wf_set(2e-6f);
    if (view->orthographic) {
        const wf safety = wf_mul(little, wf_add(wf_abs(z), s->depth_reach));
        record[RECORD_LOW] = wf_sub(wf_max(low, minimum), safety);
        record[RECORD_HIGH] = wf_add(wf_min(high, maximum), safety);
        return;
    }
    wf across = zero;
    for (int k = 0; k < 2; k++) {
        const wf reach = wf_add(wf_abs(record[RECORD_G + 3 * k + 2]), vary(record, RECORD_G + 3 * k, lower));
        across = wf_fma(reach, reach, across);
    }
    const wf safe = wf_max(minimum, wf_mul(wf_abs(maximum), wf_set(1e-6f)));
    const wf nearest = wf_div(record[RECORD_LENGTH], wf_add(wf_max(maximum, safe), wf_div(across, safe)));
    const wf farthest = wf_div(record[RECORD_LENGTH], safe);
    record[RECORD_LOW] = wf_max(wf_max(low, zero), wf_fnma(little, nearest, nearest));
    record[RECORD_HIGH] = wf_max(wf_min(high, wf_fma(little, farthest, farthest)), record[RECORD_LOW]);
}

/// Splats at the eye, which have no ellipse: rays over the whole picture, from its principal point on.
static ALWAYS_INLINE void set_near(const ewa_gaussian_view *view, const splat_lanes *s, wm near,
                                   wf rows[3][3], wf record[]) {
    const wf zero = wf_set(0), z = s->place[2];
    wf own[RECORD_FLOATS];
    for (int i = 0; i < RECORD_FLOATS; i++) own[i] = record[i];
    own[RECORD_X] = wf_set(view->cx_px), own[RECORD_Y] = wf_set(view->cy_px);
    own[RECORD_AX] = wf_set(1e-30f), own[RECORD_AY] = own[RECORD_BY] = own[RECORD_TOUCH] = zero;
    own[RECORD_REACH] = wf_set(1e9f);
    own[RECORD_DOT_X] = wf_set(NO_DOT_PX);
    for (int k = 0; k < 3; k++) {
        own[RECORD_G + 3 * k] = wf_div(rows[k][0], wf_set(view->fx_px));
        own[RECORD_G + 3 * k + 1] = wf_div(rows[k][1], wf_set(view->fy_px));
        own[RECORD_G + 3 * k + 2] = rows[k][2];
    }
    own[RECORD_LOW] = wf_max(wf_sub(z, s->depth_reach), zero);
    own[RECORD_HIGH] = wf_add(z, s->depth_reach);
    for (int i = 0; i < RECORD_FLOATS; i++) record[i] = wf_select(near, own[i], record[i]);
}

/// Values of the real spherical harmonics beyond degree 0 (3DGS: order, signs).
static ALWAYS_INLINE void harmonics_of(const wf d[3], uint32_t degree, wf y[24]) {
    const wf x = d[0], v = d[1], z = d[2];
    y[0] = wf_mul(wf_set(-0.48860251f), v);
    y[1] = wf_mul(wf_set(0.48860251f), z);
    y[2] = wf_mul(wf_set(-0.48860251f), x);
    if (degree < 2) return;
    const wf xx = wf_mul(x, x), yy = wf_mul(v, v), zz = wf_mul(z, z), xy = wf_mul(x, v), three = wf_set(3);
    const wf difference = wf_sub(xx, yy), yz = wf_mul(v, z), xz = wf_mul(x, z);
    y[3] = wf_mul(wf_set(1.09254843f), xy);
    y[4] = wf_mul(wf_set(-1.09254843f), yz);
    y[5] = wf_mul(wf_set(0.315391565f), wf_sub(wf_sub(wf_add(zz, zz), xx), yy));
    y[6] = wf_mul(wf_set(-1.09254843f), xz);
    y[7] = wf_mul(wf_set(0.546274215f), difference);
    if (degree < 3) return;
    const wf sky = wf_sub(wf_sub(wf_mul(wf_set(4), zz), xx), yy);
    const wf lobe_y = wf_fma(three, xx, wf_sub(wf_set(0), yy)), lobe_x = wf_fnma(three, yy, xx);
    y[8] = wf_mul(wf_mul(wf_set(-0.590043590f), v), lobe_y);
    y[9] = wf_mul(wf_mul(wf_set(2.89061144f), xy), z);
    y[10] = wf_mul(wf_mul(wf_set(-0.457045799f), v), sky);
    y[11] = wf_mul(wf_mul(wf_set(0.373176333f), z), wf_fnma(three, wf_add(xx, yy), wf_add(zz, zz)));
    y[12] = wf_mul(wf_mul(wf_set(-0.457045799f), x), sky);
    y[13] = wf_mul(wf_mul(wf_set(1.44530572f), z), difference);
    y[14] = wf_mul(wf_mul(wf_set(-0.590043590f), x), lobe_x);
    if (degree < 4) return;
    const wf seven1 = wf_fma(wf_set(7), zz, wf_set(-1)), seven3 = wf_fma(wf_set(7), zz, wf_set(-3));
    y[15] = wf_mul(wf_mul(wf_set(2.50334294f), xy), difference);
    y[16] = wf_mul(wf_mul(wf_set(-1.77013077f), yz), lobe_y);
    y[17] = wf_mul(wf_mul(wf_set(0.946174696f), xy), seven1);
    y[18] = wf_mul(wf_mul(wf_set(-0.669046544f), yz), seven3);
    y[19] = wf_mul(wf_set(0.105785547f), wf_fma(zz, wf_fma(wf_set(35), zz, wf_set(-30)), three));
    y[20] = wf_mul(wf_mul(wf_set(-0.669046544f), xz), seven3);
    y[21] = wf_mul(wf_mul(wf_set(0.473087348f), difference), seven1);
    y[22] = wf_mul(wf_mul(wf_set(-1.77013077f), xz), lobe_x);
    y[23] = wf_mul(wf_set(0.625835735f), wf_fnma(yy, lobe_y, wf_mul(xx, lobe_x)));
}

static ALWAYS_INLINE void set_colors(const ewa_gaussian_view *view, const ewa_splat_packet *packet,
                                     const int16_t (*harmonics)[EWA_SPLAT_LANES], const splat_lanes *s,
                                     wf color[3]) {
    wf y[24], sum[3] = {wf_set(0), wf_set(0), wf_set(0)};
    const uint32_t used = (view->sh_degree + 1) * (view->sh_degree + 1) - 1;
    if (used) harmonics_of(s->direction, view->sh_degree, y);
    for (uint32_t k = 0; k < used; k++)
        for (uint32_t c = 0; c < 3; c++)
            sum[c] = wf_fma(y[k], wf_from_i(wi_load_i16(harmonics[3 * k + c])), sum[c]);
    const wf unit = wf_load((*packet)[EWA_SPLAT_HARMONIC_UNIT]), flat = wf_set(0.282094792f);
    for (int c = 0; c < 3; c++) {
        const wf base = wf_fma(flat, wf_load((*packet)[EWA_SPLAT_COLOR + c]), wf_set(0.5f));
        color[c] = wf_max(wf_fma(unit, sum[c], base), wf_set(0));
    }
}

/// Normals in the world in place of colours: the shortest axes, turned to the eye.
static ALWAYS_INLINE void set_normals(const ewa_splat_packet *packet, const splat_lanes *s, wf color[3]) {
    const wf zero = wf_set(0), half = wf_set(0.5f);
    wf q[4], axes[3][3], shortest = s->scales[2];
    for (int i = 0; i < 4; i++) q[i] = wf_load((*packet)[EWA_SPLAT_ROTATION + i]);
    quaternion_axes(q, axes);
    for (int k = 1; k >= 0; k--) {
        const wm shorter = wf_lt(s->scales[k], shortest);
        shortest = wf_select(shorter, s->scales[k], shortest);
        for (int c = 0; c < 3; c++) axes[2][c] = wf_select(shorter, axes[k][c], axes[2][c]);
    }
    const wm away = wf_lt(zero, dot(axes[2], s->direction));
    for (int c = 0; c < 3; c++)
        color[c] = wf_fma(half, wf_select(away, wf_sub(zero, axes[2][c]), axes[2][c]), half);
}

/// Adds the lanes of `shows` to what was found.
static void add_records(wm shows, const wf record[RECORD_FLOATS], wf tiles[4], ewa_gaussian_found *found) {
    wf first[16], rest[16];
    for (int i = 0; i < 16; i++) first[i] = record[i];
    for (int i = 16; i < 32; i++) rest[i - 16] = i < RECORD_FLOATS ? record[i] : wf_set(0);
    w_transpose(first);
    w_transpose(rest);
    int32_t corner[2][16];
    for (int i = 0; i < 2; i++)
        wi_store(corner[i], wi_or(wi_from_f(tiles[2 * i]), wi_shl(wi_from_f(tiles[2 * i + 1]), 16)));
    for (uint32_t bits = wm_bits(shows); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        float row[32];
        wf_store(row, first[lane]);
        wf_store(row + 16, rest[lane]);
        float *to = found->records[found->count];
        __builtin_memcpy(to, row, sizeof(ewa_gaussian_record));
        int32_t key;
        __builtin_memcpy(&key, &to[RECORD_ORDER], sizeof key);
        // Numbers below zero, of orthographic cameras and of centres behind the eye, sort the other way round.
        found->keys[found->count] = (uint32_t)key ^ (key < 0 ? 0xffffffffu : 0x80000000u);
        found->first[found->count] = corner[0][lane];
        found->end[found->count] = corner[1][lane];
        found->count++;
    }
}

static void project(const ewa_gaussian_view *view, const ewa_splat_packet *packet,
                    const int16_t (*harmonics)[EWA_SPLAT_LANES], ewa_gaussian_found *found) {
    splat_lanes s;
    wm shows = place_splats(view, packet, &s);
    if (!wm_bits(shows)) return;
    const wf zero = wf_set(0);
    wm near = wf_lt(zero, zero);
    if (!view->trained && !view->orthographic) near = wf_le(s.place[2], wf_mul(wf_set((float)EWA_GAUSSIAN_NEAR), s.depth_reach));
    wf record[RECORD_FLOATS], v[3], shift[2], lower[3], map[3], rows[3][3], tiles[4], dot[3] = {zero, zero, zero};
    const wf area = true_ellipse(view, &s, v, shift, dot);
    const wf kept = set_ellipse(view, &s, v, area, thickness(view, &s, dot), record, lower, map);
    record[RECORD_X] = wf_fma(s.x, wf_set(view->fx_px), wf_add(shift[0], wf_set(view->cx_px)));
    record[RECORD_Y] = wf_fma(s.y, wf_set(view->fy_px), wf_add(shift[1], wf_set(view->cy_px)));
    // The box, in pixels from the picture's edge.
    const wf across = wf_mul(wf_sqrt(s.cutoff2), lower[0]), down = record[RECORD_REACH];
    const wf width = wf_set(view->width_px), height = wf_set(view->height_px);
    const wf left = wf_sub(record[RECORD_X], across), right = wf_add(record[RECORD_X], across);
    const wf top = wf_sub(record[RECORD_Y], down), bottom = wf_add(record[RECORD_Y], down);
    const wm within = wm_and(wm_and(wf_lt(left, width), wf_lt(zero, right)),
                             wm_and(wf_lt(top, height), wf_lt(zero, bottom)));
    shows = wm_and(shows, wm_or(near, within));
    if (!wm_bits(shows)) return;
    const wf steps = wf_set(1.0f / EWA_GAUSSIAN_TILE_PX), one = wf_set(1);
    const wf box[4] = {left, top, right, bottom};
    for (int i = 0; i < 4; i++) {
        const float last = i % 2 ? view->last_row : view->last_column;
        tiles[i] = wf_floor(wf_min(wf_max(wf_mul(box[i], steps), zero), wf_set(last)));
        tiles[i] = wf_select(near, i < 2 ? zero : wf_set(last), tiles[i]);
        if (i >= 2) tiles[i] = wf_add(tiles[i], one);
    }
    record[RECORD_LENGTH] = ray_rows(view, &s, rows);
    set_rays(view, &s, rows, shift, map, record);
    set_depths(view, &s, lower, record);
    const wf opacity = wf_max(wf_load((*packet)[EWA_SPLAT_OPACITY]), wf_set(1e-30f));
    wf alpha = wf_mul(opacity, wf_select(near, one, kept));
    shows = wm_and(shows, wf_le(wf_set(view->minimum_alpha), alpha));
    record[RECORD_LOG2_ALPHA] = wf_log2(alpha);
    if (view->normals)
        set_normals(packet, &s, &record[RECORD_COLOR]);
    else
        set_colors(view, packet, harmonics, &s, &record[RECORD_COLOR]);
    record[RECORD_DOT_X] = dot[0], record[RECORD_DOT_Y] = dot[1], record[RECORD_DOT_Z] = s.place[2];
    record[RECORD_DOT] = wf_set(-1);
    if (view->flat) {
        const bool some = view->dot_px2 > 0;
        record[RECORD_DOT] = wf_set(some ? 1 / view->dot_px2 : 1);
        record[RECORD_DOT_X] =
            wf_select(wf_lt(zero, wf_keep(wf_lt(zero, wf_set(view->dot_px2)), dot[2])), dot[0], wf_set(NO_DOT_PX));
    }
    if (wm_bits(near)) set_near(view, &s, near, rows, record);
    const wf first = view->by_nearest ? wf_sub(s.place[2], s.depth_reach) : view->by_center ? s.place[2] : record[RECORD_LOW];
    record[RECORD_ORDER] = wf_add(first, zero); // of both zeros the one above
    found->near_count += (uint32_t)__builtin_popcount(wm_bits(wm_and(near, shows)));
    add_records(shows, record, tiles, found);
}

#endif
