// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of local_body.h: how much the surface bends at sixteen places (docs/math.md section 5, contours), by the
// normals of their neighbours. The shape operator is the symmetric map S of places in the tangent plane to normals with
// the least squares of n - x S.
//
// Based on: J. Goldfeather, V. Interrante, "A Novel Cubic-Order Algorithm for Approximating Principal Direction
// Vectors", 2004, section 3; J. J. Koenderink, A. J. van Doorn, "Surface Shape and Curvature Scales", 1992 (curvedness).
#ifndef EWA_SRC_ESTIMATE_LOCAL_CURVATURE_BODY_H
#define EWA_SRC_ESTIMATE_LOCAL_CURVATURE_BODY_H

// F ratio of the map's three numbers from which on they count, and twice which they count in full; so many times that
// where the surface is a saddle: it may not bend at all in the direction of the view, and moving splats tears it there.
static const float SIGNIFICANT_RATIO = 30, SADDLE_RATIO = 1.5f;
// The square of what rounding changes of a normal, and the same of what is left where places are on a line.
static const float NORMAL_ROUNDING2 = 1e-10f, LINE_SHARE = 1e-3f;
static const float MIN_SAMPLES = 6; // the place itself among them
static const float SMOOTH_COSINE = 0.5f; // of the angle of normals beyond which there is an edge

/// Sums over a place and its neighbours, places less normals in the tangent plane, less their means.
typedef struct bend_sums {
    wf count, xx, xy, yy; ///< of places
    wf nx, ny, mixed;     ///< n1 x1, n2 x2, and the mean of n1 x2 and n2 x1
    wf normal;            ///< of n n'
    wm smooth;            ///< no neighbour is across an edge
} bend_sums;

static inline bend_sums sum_fans(const local_fans *fans) {
    const wf zero = wf_set(0), one = wf_set(1), half = wf_set(0.5f);
    const vec own = {wf_load(fans->own[0]), wf_load(fans->own[1]), wf_load(fans->own[2])};
    // The frame across a unit vector, as ewa_frame_of().
    const wf sign = wf_select(wf_lt(own.z, zero), wf_set(-1), one);
    const wf a = wf_div(wf_set(-1), wf_add(sign, own.z)), b = wf_mul(wf_mul(own.x, own.y), a);
    const vec u = {wf_add(wf_mul(wf_mul(sign, own.x), wf_mul(own.x, a)), one), wf_mul(sign, b),
                   wf_sub(zero, wf_mul(sign, own.x))};
    const vec v = {b, wf_add(wf_mul(wf_mul(own.y, own.y), a), sign), wf_sub(zero, own.y)};
    bend_sums s = {one, zero, zero, zero, zero, zero, zero, zero, wf_le(zero, one)};
    wf sum_x = zero, sum_y = zero, sum_n1 = zero, sum_n2 = zero;
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        const vec way = {wf_load(fans->way[i][0]), wf_load(fans->way[i][1]), wf_load(fans->way[i][2])};
        const vec other = {wf_load(fans->normal[i][0]), wf_load(fans->normal[i][1]), wf_load(fans->normal[i][2])};
        const wf along = v_dot(other, own);
        const wm there = wf_lt(zero, v_dot(other, other));
        s.smooth = wm_and(s.smooth, wm_or(wm_not(there), wf_le(wf_set(SMOOTH_COSINE), wf_abs(along))));
        const wf turn = wf_select(wf_lt(along, zero), wf_set(-1), one);
        const wf x = v_dot(way, u), y = v_dot(way, v);
        const wf n1 = wf_mul(turn, v_dot(other, u)), n2 = wf_mul(turn, v_dot(other, v));
        s.count = wf_add(s.count, wf_keep(there, one));
        sum_x = wf_add(sum_x, x), sum_y = wf_add(sum_y, y);
        sum_n1 = wf_add(sum_n1, n1), sum_n2 = wf_add(sum_n2, n2);
        s.xx = wf_add(s.xx, wf_mul(x, x)), s.xy = wf_add(s.xy, wf_mul(x, y)), s.yy = wf_add(s.yy, wf_mul(y, y));
        s.nx = wf_add(s.nx, wf_mul(n1, x)), s.ny = wf_add(s.ny, wf_mul(n2, y));
        s.mixed = wf_add(s.mixed, wf_mul(half, wf_add(wf_mul(n1, y), wf_mul(n2, x))));
        s.normal = wf_add(s.normal, wf_add(wf_mul(n1, n1), wf_mul(n2, n2)));
    }
    const wf share = wf_div(one, s.count);
    const wf mean_x = wf_mul(sum_x, share), mean_y = wf_mul(sum_y, share);
    s.xx = wf_sub(s.xx, wf_mul(sum_x, mean_x)), s.xy = wf_sub(s.xy, wf_mul(sum_x, mean_y));
    s.yy = wf_sub(s.yy, wf_mul(sum_y, mean_y));
    s.nx = wf_sub(s.nx, wf_mul(sum_n1, mean_x)), s.ny = wf_sub(s.ny, wf_mul(sum_n2, mean_y));
    s.mixed = wf_sub(s.mixed, wf_mul(half, wf_add(wf_mul(sum_n1, mean_y), wf_mul(sum_n2, mean_x))));
    s.normal = wf_sub(s.normal, wf_mul(share, wf_add(wf_mul(sum_n1, sum_n1), wf_mul(sum_n2, sum_n2))));
    return s;
}

/// Sets the signed curvature of each lane, in units of its fan, and how far that is to be trusted, 0 to 1.
static void fit_curvature(const local_fans *fans, float curvature[EWA_BLOCK_LANES], float trust[EWA_BLOCK_LANES]) {
    const wf zero = wf_set(0), one = wf_set(1), two = wf_set(2);
    const bend_sums s = sum_fans(fans);
    // S is where A S + S A = 2 C with the sums A of places and C of both: (|A| C + adj(A) C adj(A)) / (|A| trace A).
    const wf trace = wf_add(s.xx, s.yy), det = wf_sub(wf_mul(s.xx, s.yy), wf_mul(s.xy, s.xy));
    const wm plane = wf_lt(wf_mul(wf_set(LINE_SHARE), wf_mul(trace, trace)), det);
    wm known = wm_and(wm_and(wf_le(wf_set(MIN_SAMPLES), s.count), plane), s.smooth);
    const wf scale = wf_div(one, wf_select(known, wf_mul(det, trace), one));
    const wf p11 = wf_sub(wf_mul(s.yy, s.nx), wf_mul(s.xy, s.mixed));
    const wf p12 = wf_sub(wf_mul(s.yy, s.mixed), wf_mul(s.xy, s.ny));
    const wf p21 = wf_sub(wf_mul(s.xx, s.mixed), wf_mul(s.xy, s.nx));
    const wf p22 = wf_sub(wf_mul(s.xx, s.ny), wf_mul(s.xy, s.mixed));
    const wf s11 = wf_mul(scale, wf_add(wf_mul(det, s.nx), wf_sub(wf_mul(p11, s.yy), wf_mul(p12, s.xy))));
    const wf s12 = wf_mul(scale, wf_add(wf_mul(det, s.mixed), wf_sub(wf_mul(p12, s.xx), wf_mul(p11, s.xy))));
    const wf s22 = wf_mul(scale, wf_add(wf_mul(det, s.ny), wf_sub(wf_mul(p22, s.xx), wf_mul(p21, s.xy))));
    const wf explained =
        wf_add(wf_add(wf_mul(s11, s.nx), wf_mul(s22, s.ny)), wf_mul(two, wf_mul(s12, s.mixed)));
    const wf freedom = wf_max(wf_sub(wf_mul(two, s.count), wf_set(5)), one); // less three numbers and two means
    const wf rest = wf_max(wf_sub(s.normal, explained), zero);
    const wf unexplained = wf_add(wf_div(rest, freedom), wf_set(NORMAL_ROUNDING2));
    const wm saddle = wf_lt(wf_mul(s11, s22), wf_mul(s12, s12));
    const wf wanted = wf_select(saddle, wf_set(3 * SIGNIFICANT_RATIO * SADDLE_RATIO), wf_set(3 * SIGNIFICANT_RATIO));
    const wf ratio = wf_div(explained, wf_mul(unexplained, wanted));
    // The curvedness with the sign of the trace, not beyond that: nearly 0 where a saddle bends to both sides alike.
    const wf sum = wf_add(s11, s22);
    const wf squares = wf_add(wf_add(wf_mul(s11, s11), wf_mul(s22, s22)), wf_mul(two, wf_mul(s12, s12)));
    const wf size = wf_min(wf_sqrt(wf_mul(wf_set(0.5f), squares)), wf_abs(sum));
    known = wm_and(known, wf_lt(one, ratio));
    wf_store(curvature, wf_keep(known, wf_select(wf_lt(sum, zero), wf_sub(zero, size), size)));
    wf_store(trust, wf_keep(known, wf_min(wf_sub(ratio, one), one)));
}

#endif
