// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: surfels to records, records to classes.
//
// Based on: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004, section 4,
// in the sheared form of math.md section 3, which single precision needs.
#ifndef EWA_SRC_KERNELS_ROAD_PROJECT_H
#define EWA_SRC_KERNELS_ROAD_PROJECT_H

#include "kernels/road_camera.h"

#include <string.h>

/// Unit normals from their octahedral form.
static inline void decode_normals(const ewa_packet *packet, wf n[3]) {
    const wf unit = wf_set(1.0f / 32767.0f);
    const wf u = wf_mul(wf_from_i(wi_load_i16(packet->oct_x)), unit);
    const wf v = wf_mul(wf_from_i(wi_load_i16(packet->oct_y)), unit);
    const wf z = wf_sub(wf_sub(wf_set(1), wf_abs(u)), wf_abs(v));
    const wf fold = wf_max(wf_negate(z), wf_set(0));
    const wf x = wf_sub(u, wf_select(wf_lt(u, wf_set(0)), wf_negate(fold), fold));
    const wf y = wf_sub(v, wf_select(wf_lt(v, wf_set(0)), wf_negate(fold), fold));
    const wf length2 = wf_fma(x, x, wf_fma(y, y, wf_mul(z, z)));
    const wf inverse = wf_inverse_root(length2);
    n[0] = wf_mul(x, inverse), n[1] = wf_mul(y, inverse), n[2] = wf_mul(z, inverse);
}

/// Unit major axes: the frame of ewa_packet_frame() turned by the diamond angle.
static inline void decode_axes(const ewa_packet *packet, const wf n[3], wf axis[3]) {
    const wf t = wf_mul(wf_from_i(wi_load_u16(packet->angle)), wf_set(1.0f / 32768.0f));
    wf c = wf_sub(wf_set(1), t);
    wf s = wf_sub(wf_set(1), wf_abs(c));
    const wf inverse = wf_inverse_root(wf_fma(c, c, wf_mul(s, s)));
    c = wf_mul(c, inverse), s = wf_mul(s, inverse);
    const wf sign = wf_select(wf_lt(n[2], wf_set(0)), wf_set(-1), wf_set(1));
    const wf a = wf_div(wf_set(-1), wf_add(sign, n[2]));
    const wf b = wf_mul(wf_mul(n[0], n[1]), a);
    // First frame vector (1 + sign nx^2 a, sign b, -sign nx), second (b, sign + ny^2 a, -ny).
    const wf ux = wf_fma(wf_mul(sign, n[0]), wf_mul(n[0], a), wf_set(1)), uy = wf_mul(sign, b);
    const wf uz = wf_negate(wf_mul(sign, n[0])), vy = wf_fma(wf_mul(n[1], n[1]), a, sign);
    axis[0] = wf_fma(c, ux, wf_mul(s, b));
    axis[1] = wf_fma(c, uy, wf_mul(s, vy));
    axis[2] = wf_fnma(s, n[1], wf_mul(c, uz));
}

static inline wf decode_color(const ewa_view *view, const uint16_t *values, int channel) {
    return wf_fma(wf_from_i(wi_load_u16(values)), wf_set(view->color_scale[channel]),
                  wf_set(view->color_offset[channel]));
}

static inline wi select_int(wm m, int32_t a, wi b) {
    return wi_of_bits(wf_select(m, wf_of_bits(wi_set(a)), wf_of_bits(b)));
}

/// Class of a splat: rows within columns, so that a class's neighbours share their unrolled column count.
static inline wi box_classes(wi columns, wi rows, wm steep, wm wide) {
    const wi row_class = wi_sub(wi_min(rows, wi_set(EWA_ROW_CLASSES)), wi_set(1));
    const wi column = wi_sub(columns, wi_set(1));
    const wi plain =
        wi_add(wi_add(wi_shl(column, 2), column), row_class); // column EWA_ROW_CLASSES + row_class
    return select_int(wide, EWA_WIDE_CLASS, wi_add(plain, select_int(steep, EWA_STEEP_CLASS, wi_set(0))));
}

/// Sixteen surfels between the steps of the setup. The steps are short loops over a few packets, so that the
/// processor overlaps one packet's long chains of divisions and roots with the next one's.
typedef struct stage {
    wm alive;
    wf p[3], n[3];
    wf sigma, minor, range;       ///< camera space: major and minor axis, depth half range R
    wf inverse_z, x0, y0, facing; ///< 1/pz, slopes of the centre, n.p / pz (orthographic: 1, 0, 0, nz)
    wf s11, s12, s22, s13, s23;   ///< sheared covariance
    wf root_k;                    ///< 1 / sqrt(pz^2 - R^2)
    wf c1, c2;                    ///< ellipse's centre minus the projected centre, slopes
    wf xx, xy, yy, peak;
    wf half_x, half_y;
    wf key_x, key_y;
} stage;

/// Makes a point of a surfel: what stage_place() gives a disc parallel to the picture, of the same size on
/// the screen wherever it lies.
static ALWAYS_INLINE void place_point(const ewa_view *view, stage *t) {
    const wf zero = wf_set(0), depth = view->orthographic ? wf_set(1) : t->p[2];
    const wf x = wf_mul(depth, wf_set(view->point_sigma_px / view->fx_px));
    const wf y = wf_mul(depth, wf_set(view->point_sigma_px / view->fy_px));
    t->sigma = wf_max(x, y), t->minor = wf_min(x, y);
    t->s11 = wf_mul(x, x), t->s22 = wf_mul(y, y);
    t->s12 = t->s13 = t->s23 = zero;
    t->n[0] = t->n[1] = zero, t->n[2] = wf_set(-1);
    t->facing = wf_set(-1);
    t->range = zero;
    t->alive = wm_and(t->alive, wf_lt(zero, t->p[2]));
    t->inverse_z = wf_div(wf_set(1), depth);
    t->x0 = view->orthographic ? zero : wf_mul(t->p[0], t->inverse_z);
    t->y0 = view->orthographic ? zero : wf_mul(t->p[1], t->inverse_z);
    t->root_k = view->orthographic ? wf_set(1) : t->inverse_z;
}

/// First step: into camera space, near surfels aside, covariance.
static ALWAYS_INLINE void stage_place(const ewa_view *view, const ewa_packet *packet, uint32_t id,
                                      bool ellipses, stage *t, ewa_run *run) {
    const wf one = wf_set(1), zero = wf_set(0);
    wf n_world[3], axis[3] = {zero, zero, zero};
    to_camera(view, wf_load(packet->x), wf_load(packet->y), wf_load(packet->z), t->p);
    t->sigma = wf_mul(wf_load(packet->sigma), wf_set(view->scale));
    t->alive = wf_lt(zero, t->sigma);
    if (view->point_sigma_px > 0) {
        place_point(view, t);
        return;
    }
    decode_normals(packet, n_world);
    rotate(view->rotation, n_world[0], n_world[1], n_world[2], t->n);
    const wf *n = t->n, *p = t->p;

    // Sigma = minor^2 (I - n'n) + extra axis'axis.
    wf minor2 = wf_mul(t->sigma, t->sigma), extra = zero;
    t->minor = t->sigma;
    if (ellipses) {
        wf axis_world[3];
        decode_axes(packet, n_world, axis_world);
        rotate(view->rotation, axis_world[0], axis_world[1], axis_world[2], axis);
        t->minor = wf_mul(t->sigma, wf_mul(wf_from_i(wi_load_u16(packet->ratio)), wf_set(1.0f / 65535.0f)));
        const wf major2 = minor2;
        minor2 = wf_mul(t->minor, t->minor);
        extra = wf_sub(major2, minor2);
    }
    wf sigma33 = wf_mul(minor2, wf_fma(n[0], n[0], wf_mul(n[1], n[1])));
    if (ellipses) sigma33 = wf_fma(extra, wf_mul(axis[2], axis[2]), sigma33);
    const wf range2 = wf_mul(wf_set(view->cutoff2), sigma33);
    t->range = wf_sqrt(range2);
    if (view->orthographic) {
        t->alive = wm_and(t->alive, wf_lt(zero, p[2]));
        t->inverse_z = one, t->x0 = zero, t->y0 = zero, t->facing = n[2];
    } else {
        t->alive = wm_and(t->alive, wf_lt(wf_negate(t->range), p[2]));
        const wm near = wm_and(t->alive, wf_le(p[2], wf_mul(t->range, wf_set((float)EWA_NEAR_RATIO))));
        t->alive = wm_and(t->alive, wm_not(near));
        for (uint32_t bits = wm_bits(near), lane = 0; bits; bits >>= 1, lane++)
            if (bits & 1) run->near_surfels[run->near_count++] = id * EWA_PACKET_LANES + lane;
        t->inverse_z = wf_div(one, p[2]);
        t->x0 = wf_mul(p[0], t->inverse_z), t->y0 = wf_mul(p[1], t->inverse_z);
        t->facing = wf_fma(n[0], t->x0, wf_fma(n[1], t->y0, n[2]));
    }
    if (view->cull_back) t->alive = wm_and(t->alive, wf_lt(t->facing, zero));
    t->root_k = view->orthographic ? one : wf_inverse_root(wf_sub(wf_mul(p[2], p[2]), range2));

    // G Sigma G' (math.md section 3), with m = n_xy - x0 nz and b = axis_xy - x0 axis_z.
    const wf m1 = wf_fnma(t->x0, n[2], n[0]), m2 = wf_fnma(t->y0, n[2], n[1]);
    t->s11 = wf_mul(minor2, wf_fnma(m1, m1, wf_fma(t->x0, t->x0, one)));
    t->s22 = wf_mul(minor2, wf_fnma(m2, m2, wf_fma(t->y0, t->y0, one)));
    t->s12 = wf_mul(minor2, wf_fnma(m1, m2, wf_mul(t->x0, t->y0)));
    t->s13 = wf_mul(wf_negate(minor2), wf_fma(m1, n[2], t->x0));
    t->s23 = wf_mul(wf_negate(minor2), wf_fma(m2, n[2], t->y0));
    if (ellipses) {
        const wf b1 = wf_fnma(t->x0, axis[2], axis[0]), b2 = wf_fnma(t->y0, axis[2], axis[1]);
        const wf e1 = wf_mul(extra, b1), e2 = wf_mul(extra, b2);
        t->s11 = wf_fma(e1, b1, t->s11), t->s12 = wf_fma(e1, b2, t->s12), t->s22 = wf_fma(e2, b2, t->s22);
        t->s13 = wf_fma(e1, axis[2], t->s13), t->s23 = wf_fma(e2, axis[2], t->s23);
    }
}

/// The conic of the source kernel (SS equation 8), pulled back: u = x A, A = J^-1, W = I + h^2 A'A, r^2 = x A
/// W^-1 A' x'. In standard deviations the kernel is round, so that any frame of the surfel's plane serves:
/// here that in which J is symmetric, the root of V = J'J.
static ALWAYS_INLINE void source_shape(const ewa_view *view, wf v11, wf v12, wf v22, wf root_det, stage *t) {
    const wf one = wf_set(1), h2 = wf_set(view->prefilter2_px2);
    const wf least = wf_mul(wf_set((float)EWA_FLAT), wf_mul(v11, v22));
    const wm invertible =
        wm_and(wf_le(least, wf_mul(root_det, root_det)), wf_le(wf_set((float)EWA_LEAST_AREA), root_det));
    t->alive = wm_and(t->alive, invertible);
    root_det = wf_select(invertible, root_det, one);
    // J = (V + |J| I) / g, its adjugate likewise; g^2 = V11 + V22 + 2 |J|.
    const wf trace = wf_add(wf_add(v11, v22), wf_add(root_det, root_det));
    const wf inverse_det = wf_reciprocal(root_det), scale = wf_mul(wf_inverse_root(trace), inverse_det);
    const wf a11 = wf_mul(wf_add(v22, root_det), scale), a22 = wf_mul(wf_add(v11, root_det), scale);
    const wf a12 = wf_negate(wf_mul(v12, scale));
    const wf along_x = wf_fma(a11, a11, wf_mul(a12, a12)), along_y = wf_fma(a22, a22, wf_mul(a12, a12));
    const wf cross = wf_mul(a12, wf_add(a11, a22));
    // |W| = 1 + h^2 (|a|^2 + |b|^2) + h^4 |A|^2. A adj(W) A' = A A' + h^2 |A|^2 I.
    const wf filter = wf_mul(h2, wf_mul(inverse_det, inverse_det));
    const wf determinant = wf_fma(h2, wf_add(wf_add(along_x, along_y), filter), one);
    const wf inverse_root = wf_inverse_root(determinant);
    const wf scaled = wf_mul(wf_mul(inverse_root, inverse_root), wf_set(view->exponent_scale));
    t->peak = wf_mul(inverse_root, wf_set((float)EWA_INVERSE_TWO_PI));
    t->xx = wf_mul(wf_add(along_x, filter), scaled);
    t->xy = wf_mul(wf_mul(cross, wf_set(2)), scaled);
    t->yy = wf_mul(wf_add(along_y, filter), scaled);
}

/// The circle around the filtered ellipse (w11, w12, w22): its larger eigenvalue for a variance.
static ALWAYS_INLINE void circular_shape(const ewa_view *view, wf w11, wf w12, wf w22, wf root_det,
                                         stage *t) {
    const wf mean = wf_mul(wf_set(0.5f), wf_add(w11, w22)), difference = wf_sub(mean, w22);
    const wf variance = wf_add(mean, wf_sqrt(wf_fma(difference, difference, wf_mul(w12, w12))));
    const wf inverse = wf_div(wf_set(1), variance);
    t->peak = wf_mul(wf_mul(root_det, inverse), wf_set((float)EWA_INVERSE_TWO_PI));
    t->xx = t->yy = wf_mul(inverse, wf_set(view->exponent_scale));
    t->xy = wf_set(0);
    t->half_x = t->half_y = wf_mul(wf_set(view->cutoff), wf_sqrt(variance));
}

/// V itself, for ray_evaluate(), and a box around all that it may make of it (w is largest where the disc is
/// nearest).
static ALWAYS_INLINE void raycast_shape(const ewa_view *view, wf v11, wf v12, wf v22, wf root_det, stage *t) {
    const wf h2 = wf_set(view->prefilter2_px2);
    const wf most = wf_mul(wf_mul(t->p[2], wf_add(t->p[2], t->range)), wf_mul(t->root_k, t->root_k));
    const wf most2 = wf_mul(most, most);
    t->xx = v11, t->xy = v12, t->yy = v22;
    t->peak = wf_mul(root_det, wf_set((float)EWA_INVERSE_TWO_PI));
    t->half_x = wf_mul(wf_set(view->cutoff), wf_sqrt(wf_fma(most2, v11, h2)));
    t->half_y = wf_mul(wf_set(view->cutoff), wf_sqrt(wf_fma(most2, v22, h2)));
}

/// Second step: the filtered ellipse (math.md sections 3 and 4) and the slope of the key.
static ALWAYS_INLINE void stage_shape(const ewa_view *view, stage *t) {
    const wf one = wf_set(1), zero = wf_set(0);
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px);
    const wf root_k = view->affine && !view->orthographic ? t->inverse_z : t->root_k;
    const wf k = wf_mul(root_k, root_k);
    t->c1 = zero, t->c2 = zero;
    if (!view->affine && !view->orthographic) {
        const wf f2k = wf_mul(wf_set(-view->cutoff2), k);
        t->c1 = wf_mul(f2k, t->s13), t->c2 = wf_mul(f2k, t->s23);
    }
    const wf c1f = wf_mul(t->c1, wf_set(1 / view->cutoff)), c2f = wf_mul(t->c2, wf_set(1 / view->cutoff));
    const wf v11 = wf_mul(wf_mul(fx, fx), wf_fma(c1f, c1f, wf_mul(t->s11, k)));
    const wf v22 = wf_mul(wf_mul(fy, fy), wf_fma(c2f, c2f, wf_mul(t->s22, k)));
    const wf v12 = wf_mul(wf_mul(fx, fy), wf_fma(c1f, c2f, wf_mul(t->s12, k)));
    // |V| in closed form: |D| is -(F^2 minor major n.p)^2, so nothing cancels for edge-on surfels.
    const wf plane = view->orthographic ? t->facing : wf_mul(t->facing, t->p[2]);
    const wf area = wf_mul(wf_mul(wf_mul(t->minor, t->sigma), wf_mul(fx, fy)), plane);
    const wf root_det = wf_mul(wf_abs(area), wf_mul(k, root_k));
    const wf h2 = wf_set(view->prefilter2_px2);
    const wf w11 = wf_add(v11, h2), w22 = wf_add(v22, h2);
    const wf det_filtered = wf_fma(h2, wf_add(wf_add(v11, v22), h2), wf_mul(root_det, root_det));
    // Without a prefilter an edge-on splat is a line of no area: it covers no pixel.
    t->alive = wm_and(t->alive, wf_lt(wf_mul(wf_set((float)EWA_FLAT), wf_mul(w11, w22)), det_filtered));
    const wf inverse_root_det = wf_inverse_root(det_filtered);
    const wf scaled = wf_mul(wf_mul(inverse_root_det, inverse_root_det), wf_set(view->exponent_scale));
    t->peak = wf_mul(wf_mul(root_det, inverse_root_det), wf_set((float)EWA_INVERSE_TWO_PI));
    t->xx = wf_mul(w22, scaled);
    t->xy = wf_mul(wf_mul(v12, wf_set(-2)), scaled);
    t->yy = wf_mul(w11, scaled);
    t->half_x = wf_mul(wf_set(view->cutoff), wf_sqrt(w11));
    t->half_y = wf_mul(wf_set(view->cutoff), wf_sqrt(w22));

    // The key's plane: n_xy / n.p, with |n.p| raised where the surfel is seen edge-on.
    const wf lowest2 = wf_set((float)(EWA_EDGE_ON * EWA_EDGE_ON));
    const wf ray2 = wf_fma(t->x0, t->x0, wf_fma(t->y0, t->y0, one)); // |p|^2 / pz^2; orthographic 1
    if (view->source)
        source_shape(view, v11, v12, v22, root_det, t);
    else if (view->circular)
        circular_shape(view, w11, v12, w22, root_det, t);
    else if (view->raycast)
        raycast_shape(view, v11, v12, v22, root_det, t);
    if (view->raycast)
        t->alive = wm_and(t->alive, wf_le(wf_mul(lowest2, ray2), wf_mul(t->facing, t->facing)));
    const wf raised2 = wf_max(wf_mul(t->facing, t->facing), wf_mul(lowest2, ray2));
    const wf tilt = wf_mul(wf_inverse_root(raised2), t->inverse_z);
    const wf signed_tilt = wf_select(wf_lt(t->facing, zero), wf_negate(tilt), tilt);
    t->key_x = wf_mul(wf_mul(t->n[0], signed_tilt), wf_set(1 / view->fx_px));
    t->key_y = wf_mul(wf_mul(t->n[1], signed_tilt), wf_set(1 / view->fy_px));
}

/// Appends the records of the lanes in `alive_bits`. May write EWA_PACKET_LANES entries whatever they are.
static ALWAYS_INLINE void emit(ewa_run *run, uint32_t alive_bits, const wf records[16], const float loads[64],
                               const float opacities[16], const uint8_t *materials,
                               const uint8_t classes[16]) {
    uint32_t at = run->count;
    for (uint32_t lane = 0, to = at; run->materials && lane < 16; lane++) {
        run->materials[to] = materials[lane];
        to += alive_bits >> lane & 1;
    }
    if (alive_bits == 0xffff) { // most packets lie within one tile
        for (uint32_t lane = 0; lane < 16; lane++)
            wf_store((float *)(void *)&run->records[at + lane], records[lane]);
        memcpy(&run->loads[at], loads, 16 * sizeof run->loads[at]);
        memcpy(&run->classes[at], classes, 16);
        if (run->opacities) memcpy(&run->opacities[at], opacities, 16 * sizeof *opacities);
        run->count = at + 16;
        return;
    }
    for (uint32_t lane = 0; lane < 16; lane++) {
        wf_store((float *)(void *)&run->records[at], records[lane]);
        memcpy(&run->loads[at], &loads[4 * lane], sizeof run->loads[at]);
        run->classes[at] = classes[lane];
        if (run->opacities) run->opacities[at] = opacities[lane];
        at += alive_bits >> lane & 1;
    }
    run->count = at;
}

/// Notes the records that the next emit() makes of clipped lanes.
static void list_clipped(ewa_run *run, uint32_t clipped_bits, uint32_t alive_bits, uint32_t id,
                         const stage *t) {
    float center[3][16], normal[3][16];
    for (int k = 0; k < 3; k++) wf_store(center[k], t->p[k]), wf_store(normal[k], t->n[k]);
    for (; clipped_bits; clipped_bits &= clipped_bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(clipped_bits);
        const uint32_t before = (uint32_t)__builtin_popcount(alive_bits & ((1u << lane) - 1));
        run->clipped[run->clipped_count++] =
            (ewa_clipped){run->count + before,
                          id * EWA_PACKET_LANES + lane,
                          {center[0][lane], center[1][lane], center[2][lane]},
                          {normal[0][lane], normal[1][lane], normal[2][lane]}};
    }
}

/// A tangent replaces the key of z + eps where the key changes by less than this part of it: it is then too
/// near by at most eps / TANGENT_PARTS^2.
enum { TANGENT_PARTS = 16 };

/// Third step: tolerance, box in the tile, and the records of the lanes that are in it.
static ALWAYS_INLINE void stage_emit(const ewa_view *view, const ewa_packet *packet, uint32_t id, wm clipped,
                                     const uint16_t *opacities_u16, const uint8_t *materials,
                                     const ewa_tile *tile, stage *t, ewa_run *run, wf *least) {
    const wf one = wf_set(1), zero = wf_set(0), half = wf_set(0.5f);
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px);
    const wf *p = t->p;
    const wf c1_px = wf_mul(t->c1, fx), c2_px = wf_mul(t->c2, fy);
    const wf slope = wf_sqrt(wf_fma(t->key_x, t->key_x, wf_mul(t->key_y, t->key_y)));
    // The depth that the prefilter reaches across, the most that goes into the tolerance, and how far the
    // plane may be used beyond the disc's range; the latter in units of the key.
    const wf support = wf_mul(wf_set(view->cutoff), t->sigma), reach = wf_mul(wf_set(view->reach_px), slope);
    wf key, key_low, key_high, reach_depth = reach;
    wf limit =
        wf_min(wf_mul(wf_set((float)EWA_FREE_RADII), support), wf_mul(wf_set((float)EWA_FREE_DEPTH), p[2]));
    if (view->orthographic) {
        key = wf_negate(p[2]);
        key_low = wf_negate(wf_add(p[2], t->range)), key_high = wf_sub(t->range, p[2]);
    } else {
        const wf k = wf_mul(t->root_k, t->root_k), inverse_z2 = wf_mul(t->inverse_z, t->inverse_z);
        key = wf_fma(t->key_x, c1_px, wf_fma(t->key_y, c2_px, t->inverse_z));
        key_low = wf_mul(wf_sub(p[2], t->range), k), key_high = wf_mul(wf_add(p[2], t->range), k);
        reach_depth = wf_mul(reach, wf_mul(p[2], p[2]));
        limit = wf_mul(limit, inverse_z2);
    }
    wf margin = wf_max(wf_sub(limit, reach), zero);
    if (view->circular) {
        const wf most = wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support);
        const wf most_key = view->orthographic ? most : wf_mul(most, wf_mul(t->inverse_z, t->inverse_z));
        margin = wf_add(margin, wf_min(wf_mul(t->half_x, slope), most_key));
    }
    const wf grazing = wf_min(wf_mul(wf_set(view->grazing), reach_depth),
                              wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support));
    const wf tolerance = wf_fma(wf_set(view->tolerance), t->sigma, grazing);
    const wf px = view->orthographic ? p[0] : t->x0, py = view->orthographic ? p[1] : t->y0;
    const wf cx = wf_add(wf_fma(px, fx, wf_set(view->cx_px - (float)tile->x_px)), c1_px);
    const wf cy = wf_add(wf_fma(py, fy, wf_set(view->cy_px - (float)tile->y_px)), c2_px);
    const wf first_x = wf_max(wf_add(wf_floor(wf_sub(wf_sub(cx, t->half_x), half)), one), zero);
    const wf first_y = wf_max(wf_add(wf_floor(wf_sub(wf_sub(cy, t->half_y), half)), one), zero);
    const wf last_x =
        wf_min(wf_floor(wf_sub(wf_add(cx, t->half_x), half)), wf_set((float)(tile->width_px - 1)));
    const wf last_y =
        wf_min(wf_floor(wf_sub(wf_add(cy, t->half_y), half)), wf_set((float)(tile->height_px - 1)));
    const wm alive = wm_and(t->alive, wm_and(wf_le(first_x, last_x), wf_le(first_y, last_y)));
    const uint32_t alive_bits = wm_bits(alive);
    if (!alive_bits) return;
    const wi column = wi_sar(wi_from_f(wf_keep(alive, first_x)), 2);
    const wi row = wi_sar(wi_from_f(wf_keep(alive, first_y)), 2);
    const wi columns = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_x)), 2), column), wi_set(1));
    const wi rows = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_y)), 2), row), wi_set(1));
    // Wide splats are wide also where only a narrow part of them is in the tile: its pixels are far from the
    // centre.
    const wf half_end_px = wf_set(EWA_COLUMN_CLASSES * EWA_BLOCK_PX / 2);
    wm wide = wm_or(wf_lt(half_end_px, wf_max(t->half_x, t->half_y)),
                    wf_lt(wf_set(EWA_COLUMN_CLASSES), wf_from_i(columns)));
    // The key of z + eps has a tangent that serves where the key hardly changes.
    const wf least_key = wf_fnma(wf_abs(t->key_x), t->half_x, wf_fnma(wf_abs(t->key_y), t->half_y, key));
    wf lowest = wf_sub(key_low, margin);
    if (view->circular && !view->orthographic)
        lowest = wf_max(lowest, wf_mul(wf_set((float)EWA_LEAST_KEY), t->inverse_z));
    if (!view->orthographic) {
        const wf tangent_key = wf_mul(wf_set(1 - 1 / (float)TANGENT_PARTS), key);
        wide = wm_or(wide, wf_lt(wf_max(least_key, lowest), tangent_key));
    }
    if (view->circular) wide = wm_of_bits(0xffff);
    // Affine ellipses reach beyond what discs cover, so that their planes may end anywhere.
    const wm steep = wm_or(wide, view->affine ? wm_of_bits(0xffff) : wf_lt(margin, reach));
    const wi steep_bit = wi_of_bits(wf_keep(steep, wf_of_bits(wi_set(EWA_STEEP_BIT))));
    const wi box =
        wi_or(wi_or(wi_or(column, steep_bit), wi_shl(row, 8)), wi_or(wi_shl(columns, 16), wi_shl(rows, 24)));

    // The key of z + eps; perspective: the tangent at the centre of 1 / (1 / key + eps).
    wf bound_scale = one, bound_offset = wf_negate(tolerance);
    if (!view->orthographic) {
        const wf share = wf_div(p[2], wf_add(p[2], tolerance)), share2 = wf_mul(share, share);
        bound_scale = wf_select(wide, zero, share2);
        bound_offset = wf_select(wide, tolerance, wf_mul(wf_sub(share, share2), t->inverse_z));
    }
    const wf low = wf_select(steep, lowest, least_key);
    *least = wf_min(wf_select(alive, low, wf_set(__builtin_inff())), *least);

    const wm turned = wf_lt(zero, t->facing); // normals are turned towards the viewer
    wf opacity = t->peak;                     // times the peak
    if (opacities_u16)
        opacity = wf_mul(t->peak, wf_mul(wf_from_i(wi_load_u16(opacities_u16)), wf_set(1.0f / 65535.0f)));
    wf lanes[16] = {
        wf_sub(wf_from_i(wi_shl(column, 2)), cx),
        wf_sub(wf_from_i(wi_shl(row, 2)), cy),
        t->xx,
        t->xy,
        t->yy,
        key,
        t->key_x,
        t->key_y,
        wf_select(steep, bound_scale, wf_fma(bound_scale, key, bound_offset)),
        wf_select(steep, bound_offset, wf_mul(bound_scale, t->key_x)),
        wf_select(steep, wf_add(key_high, margin), wf_mul(bound_scale, t->key_y)),
        low,
        wf_mul(opacity, decode_color(view, packet->red, 0)),
        wf_mul(opacity, decode_color(view, packet->green, 1)),
        wf_mul(opacity, decode_color(view, packet->blue, 2)),
        wf_of_bits(wi_or(box, wi_or(select_int(clipped, EWA_CLIP_BIT, wi_set(0)),
                                    select_int(turned, EWA_TURNED_BIT, wi_set(0))))),
    };
    w_transpose(lanes);
    const wf facing_peak = wf_select(turned, wf_negate(t->peak), t->peak);
    float loads[64];
    w_store4(loads, wf_mul(facing_peak, t->n[0]), wf_mul(facing_peak, t->n[1]), wf_mul(facing_peak, t->n[2]),
             t->peak);
    uint8_t classes[16];
    wi_store_u8(classes, select_int(clipped, EWA_CLIP_CLASS, box_classes(columns, rows, steep, wide)));
    if (wm_bits(wm_and(alive, clipped)))
        list_clipped(run, wm_bits(wm_and(alive, clipped)), alive_bits, id, t);
    float opacities[16];
    wf_store(opacities, opacity);
    emit(run, alive_bits, lanes, loads, opacities, materials, classes);
}

static ALWAYS_INLINE void setup_run(const ewa_view *view, const ewa_packet_source *source,
                                    const uint32_t *packet_ids, uint32_t count, uint32_t announced,
                                    bool ellipses, const ewa_tile *tile, ewa_run *run) {
    enum { TOGETHER = 4, AHEAD = 12, LINE_BYTES = 64 };
    const ewa_packet *packets = source->packets;
    stage stages[TOGETHER];
    run->count = 0;
    run->near_count = run->clipped_count = 0;
    wf least = wf_set(__builtin_inff());
    for (uint32_t first = 0; first < count; first += TOGETHER) {
        const uint32_t here = count - first < TOGETHER ? count - first : TOGETHER;
        const uint32_t *ids = packet_ids + first;
        for (uint32_t i = 0; i < here; i++) {
            if (first + i + AHEAD < announced) {
                const char *later = (const char *)&packets[ids[i + AHEAD]];
                for (size_t line = 0; line < sizeof(ewa_packet) + LINE_BYTES - 1; line += LINE_BYTES)
                    __builtin_prefetch(later + line);
            }
            stage_place(view, &packets[ids[i]], ids[i], ellipses, &stages[i], run);
        }
        for (uint32_t i = 0; i < here; i++) stage_shape(view, &stages[i]);
        for (uint32_t i = 0; i < here; i++)
            if (wm_bits(stages[i].alive))
                stage_emit(view, &packets[ids[i]], ids[i],
                           wm_of_bits(source->clip_masks ? source->clip_masks[ids[i]] : 0),
                           source->opacities ? source->opacities + (size_t)ids[i] * EWA_PACKET_LANES : NULL,
                           source->materials ? source->materials + (size_t)ids[i] * EWA_PACKET_LANES : NULL,
                           tile, &stages[i], run, &least);
    }
    run->least_key = -largest_lane(wf_negate(least));
}

static void setup(const ewa_view *view, const ewa_packet_source *packets, const uint32_t *packet_ids,
                  uint32_t count, uint32_t announced, const ewa_tile *tile, ewa_run *run) {
    if (view->ellipses)
        setup_run(view, packets, packet_ids, count, announced, true, tile, run);
    else
        setup_run(view, packets, packet_ids, count, announced, false, tile, run);
}

#endif
