// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: surfels to records, records to classes (docs/math.md sections 2 to 6, 9).
//
// Based on: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004, section 4,
// in the sheared form of docs/math.md section 3, which single precision needs.
#ifndef EWA_SRC_SURFACE_PIPELINE_PROJECT_H
#define EWA_SRC_SURFACE_PIPELINE_PROJECT_H

#include "surface/pipeline_packet.h"
#include "wide/wide_ellipse.h"

#include <string.h>

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

/// Class of a splat whose box is of few pixels.
static inline wi small_classes(wm small, wf first_x, wf first_y, wf last_x, wf last_y) {
    const wf columns = wf_sub(last_x, first_x), rows = wf_sub(last_y, first_y); // but for one
    const wf place = wf_fma(columns, wf_set(EWA_SMALL_PX), rows);
    return wi_add(wi_from_f(wf_keep(small, place)), wi_set(EWA_SMALL_CLASS));
}

/// Sixteen surfels between the steps of the setup. The steps are short loops over a few packets, so that the
/// processor overlaps one packet's long chains of divisions and roots with the next one's.
///
/// Perspective: sizes on the screen are over the depth of the surfel, slopes, so that no power of a depth is
/// needed; orthographic ones are in camera space. Both are times the view's zoom, which makes them near
/// pixels: squares neither overflow nor vanish.
typedef struct stage {
    wm alive;
    wf z, n[3], axis[3], ratio;   ///< the last two of ellipses
    float base_x, base_y;         ///< of the packet's centre, from the middle of the field
    wf dx, dy;                    ///< from there to the projected centre, slopes (orthographic: camera space)
    wf sigma, range;              ///< camera space: major axis, depth half range R
    wf major, minor;              ///< axes on the screen, zoomed
    wf part;                      ///< R / pz
    wf inverse_z, x0, y0, facing; ///< 1/pz, slopes of the centre, n.p / pz (orthographic: 1, 0, 0, nz)
    wf s11, s12, s22, s13, s23;   ///< sheared covariance, on the screen, zoomed
    wf root_k;                    ///< 1 / sqrt(1 - (R / pz)^2)
    wf c1, c2;                    ///< ellipse's centre minus the projected centre, zoomed
    wf xx, xy, yy, peak;
    wf half_x, half_y;
    wf key_x, key_y;
} stage;

/// Projects centres relative to their packet's (ewa_packet_places).
static ALWAYS_INLINE void place_surfels(const ewa_view *view, const ewa_packet_source *source, uint32_t id,
                                        const ewa_tile *tile, stage *t) {
    const ewa_packet *packet = &source->packets[id];
    const ewa_packet_places *places = &source->places;
    const float slope_x = places->slope_x[id], slope_y = places->slope_y[id];
    const wf scale = wf_set(view->scale), one = wf_set(1), zero = wf_set(0);
    wf offset[3];
    rotate(view->rotation, wf_load(packet->x), wf_load(packet->y), wf_load(packet->z), offset);
    t->base_x = (float)((double)slope_x * view->focal_px[0] +
                        (view->principal_px[0] - ((double)tile->x_px - (double)tile->field_x_px)));
    t->base_y = (float)((double)slope_y * view->focal_px[1] +
                        (view->principal_px[1] - ((double)tile->y_px - (double)tile->field_y_px)));
    t->z = wf_fma(scale, offset[2], wf_set(places->depth[id]));
    if (view->orthographic) {
        t->inverse_z = one, t->x0 = zero, t->y0 = zero;
        t->dx = wf_fma(scale, offset[0], wf_set(places->rest_x[id]));
        t->dy = wf_fma(scale, offset[1], wf_set(places->rest_y[id]));
        return;
    }
    // x / z - s = (x - s z) / z, of which the packet's centre leaves `rest`.
    t->inverse_z = wf_div(one, t->z);
    const wf sx = wf_set(slope_x), sy = wf_set(slope_y);
    t->dx =
        wf_mul(wf_fma(scale, wf_fnma(sx, offset[2], offset[0]), wf_set(places->rest_x[id])), t->inverse_z);
    t->dy =
        wf_mul(wf_fma(scale, wf_fnma(sy, offset[2], offset[1]), wf_set(places->rest_y[id])), t->inverse_z);
    t->x0 = wf_add(sx, t->dx), t->y0 = wf_add(sy, t->dy);
}

/// Makes a point of a surfel: what stage_place() gives a disc parallel to the picture, of the same size on
/// the screen wherever it lies.
static ALWAYS_INLINE void place_point(const ewa_view *view, stage *t) {
    const wf zero = wf_set(0), one = wf_set(1);
    const float x = view->point_sigma_px / view->fx_zoomed, y = view->point_sigma_px / view->fy_zoomed;
    const float major = x < y ? y : x;
    t->major = wf_set(major), t->minor = wf_set(x < y ? x : y);
    t->sigma = wf_mul(wf_set(major / view->zoom), view->orthographic ? one : t->z);
    t->s11 = wf_set(x * x), t->s22 = wf_set(y * y);
    t->s12 = t->s13 = t->s23 = zero;
    t->n[0] = t->n[1] = zero, t->n[2] = wf_set(-1);
    t->facing = wf_set(-1);
    t->range = t->part = zero, t->root_k = one;
    t->alive = wm_and(t->alive, wf_lt(zero, t->z));
}

/// First step: into camera space.
static ALWAYS_INLINE void stage_place(const ewa_view *view, const ewa_packet_source *source, uint32_t id,
                                      const ewa_tile *tile, stage *t) {
    const ewa_packet *packet = &source->packets[id];
    place_surfels(view, source, id, tile, t);
    t->sigma = wf_mul(wf_load(packet->sigma), wf_set(view->scale));
    t->alive = wf_lt(wf_set(0), t->sigma);
    if (source->places.lanes) t->alive = wm_and(t->alive, wm_of_bits(source->places.lanes[id]));
    if (view->point_sigma_px > 0)
        place_point(view, t);
    else
        decode_normals(packet, t->n);
}

/// Second step: normals and axes.
static ALWAYS_INLINE void stage_turn(const ewa_view *view, const ewa_packet_source *source, uint32_t id,
                                     bool ellipses, stage *t) {
    wf n_world[3] = {t->n[0], t->n[1], t->n[2]};
    make_unit(n_world);
    rotate(view->rotation, n_world[0], n_world[1], n_world[2], t->n);
    if (source->billboards) {
        const wm billboards = find_billboards(&source->packets[id]);
        for (int c = 0; c < 3; c++) t->n[c] = wf_select(billboards, wf_set(c == 2 ? -1 : 0), t->n[c]);
    }
    if (!ellipses) return;
    wf axis_world[3];
    decode_axes(&source->packets[id], n_world, axis_world);
    rotate(view->rotation, axis_world[0], axis_world[1], axis_world[2], t->axis);
    t->ratio = decode_ratios(&source->packets[id]);
}

/// Third step: the range of depths, but of near and broad surfels.
static ALWAYS_INLINE void stage_range(const ewa_view *view, uint32_t id, bool ellipses, stage *t,
                                      ewa_run *run) {
    const wf one = wf_set(1), zero = wf_set(0);
    const wf *n = t->n;
    // Sigma = minor^2 (I - n'n) + extra axis'axis; first in units of the major axis.
    wf part33 = wf_fma(n[0], n[0], wf_mul(n[1], n[1])); // of Sigma33
    if (ellipses) {
        const wf ratio2 = wf_mul(t->ratio, t->ratio);
        part33 = wf_fma(wf_sub(one, ratio2), wf_mul(t->axis[2], t->axis[2]), wf_mul(ratio2, part33));
    }
    t->range = wf_mul(t->sigma, wf_sqrt(wf_mul(wf_set(view->cutoff2), part33)));
    wm by_rays;
    if (view->orthographic) {
        t->alive = wm_and(t->alive, wf_lt(zero, t->z));
        t->facing = n[2];
        by_rays = wf_lt(wf_set(view->broad), t->sigma);
    } else {
        t->alive = wm_and(t->alive, wf_lt(wf_negate(t->range), t->z));
        t->facing = wf_fma(n[0], t->x0, wf_fma(n[1], t->y0, n[2]));
        by_rays = wf_le(t->z, wf_max(wf_mul(t->range, wf_set((float)EWA_NEAR_RATIO)),
                                     wf_mul(t->sigma, wf_set(view->broad))));
    }
    by_rays = wm_and(t->alive, by_rays);
    t->alive = wm_and(t->alive, wm_not(by_rays));
    for (uint32_t bits = wm_bits(by_rays), lane = 0; bits; bits >>= 1, lane++)
        if (bits & 1) run->near_surfels[run->near_count++] = id * EWA_PACKET_LANES + lane;
    if (view->cull_back) t->alive = wm_and(t->alive, wf_lt(t->facing, zero));
    t->part = view->orthographic ? zero : wf_mul(t->range, t->inverse_z);
    t->root_k = view->orthographic ? one : wf_inverse_root(wf_fnma(t->part, t->part, one));
}

/// Fourth step: the covariance, G Sigma G' (docs/math.md section 3), with m = n_xy - x0 nz and b = axis_xy -
/// x0 axis_z.
static ALWAYS_INLINE void stage_covariance(const ewa_view *view, bool ellipses, stage *t) {
    const wf one = wf_set(1);
    const wf *n = t->n, *axis = t->axis;
    t->major = wf_mul(wf_mul(t->sigma, t->inverse_z), wf_set(view->zoom));
    t->minor = ellipses ? wf_mul(t->major, t->ratio) : t->major;
    const wf minor2 = wf_mul(t->minor, t->minor);
    const wf m1 = wf_fnma(t->x0, n[2], n[0]), m2 = wf_fnma(t->y0, n[2], n[1]);
    t->s11 = wf_mul(minor2, wf_fnma(m1, m1, wf_fma(t->x0, t->x0, one)));
    t->s22 = wf_mul(minor2, wf_fnma(m2, m2, wf_fma(t->y0, t->y0, one)));
    t->s12 = wf_mul(minor2, wf_fnma(m1, m2, wf_mul(t->x0, t->y0)));
    t->s13 = wf_mul(wf_negate(minor2), wf_fma(m1, n[2], t->x0));
    t->s23 = wf_mul(wf_negate(minor2), wf_fma(m2, n[2], t->y0));
    if (ellipses) {
        const wf ratio2 = wf_mul(t->ratio, t->ratio);
        const wf extra = wf_mul(wf_mul(t->major, t->major), wf_sub(one, ratio2));
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
    const wf minimum = wf_mul(wf_set((float)EWA_SINGULAR), wf_mul(v11, v22));
    const wm invertible =
        wm_and(wf_le(minimum, wf_mul(root_det, root_det)), wf_le(wf_set((float)EWA_MIN_AREA), root_det));
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
    const wf maximum = wf_mul(wf_add(wf_set(1), t->part), wf_mul(t->root_k, t->root_k));
    const wf max2 = wf_mul(maximum, maximum);
    t->xx = v11, t->xy = v12, t->yy = v22;
    t->peak = wf_mul(root_det, wf_set((float)EWA_INVERSE_TWO_PI));
    t->half_x = wf_mul(wf_set(view->cutoff), wf_sqrt(wf_fma(max2, v11, h2)));
    t->half_y = wf_mul(wf_set(view->cutoff), wf_sqrt(wf_fma(max2, v22, h2)));
}

/// Second step: the filtered ellipse (docs/math.md sections 3 and 4) and the slope of the key.
static ALWAYS_INLINE void stage_shape(const ewa_view *view, stage *t) {
    const wf one = wf_set(1), zero = wf_set(0);
    const wf fx = wf_set(view->fx_zoomed), fy = wf_set(view->fy_zoomed);
    const wf root_k = view->affine ? one : t->root_k;
    const wf k = wf_mul(root_k, root_k);
    t->c1 = zero, t->c2 = zero;
    if (!view->affine && !view->orthographic) {
        const wf f2k = wf_mul(wf_set(-view->cutoff2 / view->zoom), k);
        t->c1 = wf_mul(f2k, t->s13), t->c2 = wf_mul(f2k, t->s23);
    }
    const wf c1f = wf_mul(t->c1, wf_set(1 / view->cutoff)), c2f = wf_mul(t->c2, wf_set(1 / view->cutoff));
    const wf v11 = wf_mul(wf_mul(fx, fx), wf_fma(c1f, c1f, wf_mul(t->s11, k)));
    const wf v22 = wf_mul(wf_mul(fy, fy), wf_fma(c2f, c2f, wf_mul(t->s22, k)));
    const wf v12 = wf_mul(wf_mul(fx, fy), wf_fma(c1f, c2f, wf_mul(t->s12, k)));
    // |V| in closed form: |D| is -(F^2 minor major n.p)^2, so nothing cancels for edge-on surfels.
    const wf area = wf_mul(wf_mul(wf_mul(t->minor, t->major), wf_mul(fx, fy)), t->facing);
    const wf root_det = wf_mul(wf_abs(area), wf_mul(k, root_k));
    const wf h2 = wf_set(view->prefilter2_px2);
    const wf w11 = wf_add(v11, h2), w22 = wf_add(v22, h2);
    const wf det_filtered = wf_fma(h2, wf_add(wf_add(v11, v22), h2), wf_mul(root_det, root_det));
    // Without a prefilter an edge-on splat is a line of no area: it covers no pixel.
    t->alive = wm_and(t->alive, wf_lt(wf_mul(wf_set((float)EWA_FLAT), wf_mul(w11, w22)), det_filtered));
    t->alive = wm_and(t->alive, wf_le(wf_set((float)EWA_MIN_SPLAT), root_det));
    const wf inverse_root_det = wf_inverse_root(det_filtered);
    const wf scaled = wf_mul(wf_mul(inverse_root_det, inverse_root_det), wf_set(view->exponent_scale));
    t->peak = wf_mul(wf_mul(root_det, inverse_root_det), wf_set((float)EWA_INVERSE_TWO_PI));
    wf conic[3];
    wide_conic(w11, v12, w22, scaled, conic);
    t->xx = conic[0], t->xy = conic[1], t->yy = conic[2];
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
static ALWAYS_INLINE void emit(ewa_run *run, uint32_t alive_bits, uint32_t id, const wf records[16],
                               const float loads[64], const float opacities[16], const uint8_t *materials,
                               const uint8_t classes[16], wi boxes, wf key_lows) {
    uint32_t at = run->count;
    for (uint32_t lane = 0, to = at; run->surfels && lane < 16; lane++) {
        run->surfels[to] = id * EWA_PACKET_LANES + lane;
        to += alive_bits >> lane & 1;
    }
    wi_pack(run->boxes + at, wm_of_bits(alive_bits), boxes);
    wf_pack(run->key_lows + at, wm_of_bits(alive_bits), key_lows);
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
static void list_clipped(ewa_run *run, uint32_t clipped_bits, uint32_t alive_bits, uint32_t id) {
    for (; clipped_bits; clipped_bits &= clipped_bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(clipped_bits);
        const uint32_t before = (uint32_t)__builtin_popcount(alive_bits & ((1u << lane) - 1));
        run->clipped[run->clipped_count++] = (ewa_clipped){run->count + before, id * EWA_PACKET_LANES + lane};
    }
}

/// A centre, rounded to a step of 2^-16 pixels or, outside of the field, a coarser one: its distances from
/// pixels of the field have no more digits than a float.
static ALWAYS_INLINE wf whole_place(wf center_px) {
    const wf power = wf_of_bits(wi_and(wi_of_bits(center_px), wi_set(0x7f800000)));
    const wf bias = wf_mul(wf_max(power, wf_set(EWA_FIELD_PX / 4)), wf_set(6));
    return wf_sub(wf_add(center_px, bias), bias);
}

/// A tangent replaces the key of z + eps where the key changes by less than this part of it: it is then too
/// near by at most eps / TANGENT_PARTS^2.
enum { TANGENT_PARTS = 16 };

/// How far splats move away from their contours (semantics.h, section 5): pixels, and what of the key that is.
typedef struct contour_way {
    wf x, y, key;
    wm concave; ///< seen from the side to which the surface turns
} contour_way;

/// Returns whether some move. `slope` is the length of the key's gradient.
static ALWAYS_INLINE bool find_contour_way(const ewa_view *view, const uint16_t *curvatures, const stage *t, wf slope,
                                           wm clipped, contour_way *way) {
    const wf one = wf_set(1), zero = wf_set(0);
    const wf curvature = wf_of_bits(wi_shl(wi_load_u16(curvatures), 16));
    wf bend = wf_mul(wf_max(curvature, zero), wf_set(view->curvature_scale));
    if (!view->orthographic) bend = wf_mul(bend, t->z);
    bend = wf_min(bend, wf_set(1e30f));
    const wf sine2 = wf_mul(t->facing, t->facing);
    const wf size = wf_mul(t->major, wf_set((float)EWA_CONTOUR_WIDTH * view->fx_zoomed));
    const wf across = wf_sqrt(wf_fma(wf_mul(size, size), sine2, wf_set(view->prefilter2_px2)));
    const wf reach =
        wf_min(wf_mul(wf_mul(across, bend), wf_set((float)EWA_CONTOUR_REACH)), wf_set(view->contour_sine2));
    const wm near = wm_and(wm_and(t->alive, wm_not(clipped)), wm_and(wf_lt(sine2, reach), wf_lt(zero, slope)));
    if (!wm_bits(near)) return false;
    const wf share = wf_sub(one, wf_div(sine2, wf_select(near, reach, one)));
    const wf length = wf_mul(wf_mul(across, wf_set(view->contour_shift)), share);
    // Up the gradient where the side that is seen turns away, as on the near half of a sphere.
    const wm turns_away = wf_lt(t->facing, zero);
    const wf along = wf_div(wf_select(turns_away, length, wf_negate(length)), wf_select(near, slope, one));
    way->concave = wm_and(wm_and(near, wm_not(turns_away)), wf_lt(wf_set((float)EWA_CONTOUR_CONCAVE), share));
    way->x = wf_keep(near, wf_mul(t->key_x, along)), way->y = wf_keep(near, wf_mul(t->key_y, along));
    way->key = wf_keep(near, wf_mul(wf_mul(slope, slope), along));
    return true;
}

/// Third step: tolerance, box in the tile, and the records of the lanes that are in it.
static ALWAYS_INLINE void stage_emit(const ewa_view *view, const ewa_packet_source *source, uint32_t id,
                                     const ewa_tile *tile, stage *t, ewa_run *run, wf *minimum) {
    const wf one = wf_set(1), zero = wf_set(0), half = wf_set(0.5f);
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px), z = t->z;
    const ewa_packet *packet = &source->packets[id];
    const size_t first_lane = (size_t)id * EWA_PACKET_LANES;
    const uint16_t *opacities_u16 = source->opacities ? source->opacities + first_lane : NULL;
    uint8_t same[EWA_PACKET_LANES];
    const uint8_t *materials = source->materials ? source->materials + first_lane : same;
    if (run->materials && !source->materials) memset(same, source->material, sizeof same);
    const uint32_t own = source->clip_masks ? source->clip_masks[id] : 0;
    const wm clipped = wm_of_bits(own | (source->places.cuts ? source->places.cuts[id] : 0));
    const wf c1_px = wf_mul(t->c1, wf_set(view->fx_zoomed)), c2_px = wf_mul(t->c2, wf_set(view->fy_zoomed));
    const wf slope = wf_sqrt(wf_fma(t->key_x, t->key_x, wf_mul(t->key_y, t->key_y)));
    // The depth that the prefilter reaches across, the maximum that goes into the tolerance, and how far the
    // plane may be used beyond the disc's range; the latter in units of the key.
    const wf support = wf_mul(wf_set(view->cutoff), t->sigma), reach = wf_mul(wf_set(view->reach_px), slope);
    wf key, key_low, key_high, reach_depth = reach;
    wf limit =
        wf_min(wf_mul(wf_set((float)EWA_FREE_RADII), support), wf_mul(wf_set((float)EWA_FREE_DEPTH), z));
    if (view->orthographic) {
        key = wf_negate(z);
        key_low = wf_negate(wf_add(z, t->range)), key_high = wf_sub(t->range, z);
    } else {
        const wf k = wf_mul(wf_mul(t->root_k, t->root_k), t->inverse_z);
        key = wf_fma(t->key_x, c1_px, wf_fma(t->key_y, c2_px, t->inverse_z));
        key_low = wf_mul(wf_sub(one, t->part), k), key_high = wf_mul(wf_add(one, t->part), k);
        reach_depth = wf_mul(wf_mul(reach, z), z);
        limit = wf_mul(wf_mul(limit, t->inverse_z), t->inverse_z);
    }
    wf place_x = wf_add(wf_fma(t->dx, fx, wf_set(t->base_x)), c1_px);
    wf place_y = wf_add(wf_fma(t->dy, fy, wf_set(t->base_y)), c2_px), beyond = reach;
    contour_way way;
    wm concave = wm_of_bits(0);
    // What moves keeps its plane of keys, whose range beside the disc is that of what the splat may reach.
    if (source->curvatures && find_contour_way(view, source->curvatures + first_lane, t, slope, clipped, &way)) {
        key = wf_add(key, way.key), beyond = wf_add(beyond, wf_abs(way.key));
        place_x = wf_add(place_x, way.x), place_y = wf_add(place_y, way.y);
        if (!view->transparent) concave = way.concave;
    }
    wf margin = wf_max(wf_sub(limit, reach), zero);
    if (view->circular) {
        const wf maximum = wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support);
        const wf max_key = view->orthographic ? maximum : wf_mul(wf_mul(maximum, t->inverse_z), t->inverse_z);
        margin = wf_add(margin, wf_min(wf_mul(t->half_x, slope), max_key));
    }
    const wf grazing = wf_min(wf_mul(wf_set(view->grazing), reach_depth),
                              wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support));
    const wf tolerance = wf_fma(wf_set(view->tolerance), t->sigma, grazing);
    const wf cx = whole_place(place_x), cy = whole_place(place_y);
    const float left = tile->field_x_px, top = tile->field_y_px;
    const wf whole_first_x = wf_add(wf_floor(wf_sub(wf_sub(cx, t->half_x), half)), one);
    const wf whole_last_x = wf_floor(wf_sub(wf_add(cx, t->half_x), half));
    const wf first_x = wf_sub(wf_max(whole_first_x, wf_set(left)), wf_set(left));
    const wf whole_first_y = wf_add(wf_floor(wf_sub(wf_sub(cy, t->half_y), half)), one);
    const wf whole_last_y = wf_floor(wf_sub(wf_add(cy, t->half_y), half));
    const wf first_y = wf_sub(wf_max(whole_first_y, wf_set(top)), wf_set(top));
    const wf last_x = wf_min(wf_sub(whole_last_x, wf_set(left)), wf_set((float)(tile->width_px - 1)));
    const wf last_y = wf_min(wf_sub(whole_last_y, wf_set(top)), wf_set((float)(tile->height_px - 1)));
    // A box that is no number would be as large as the tile without being wide, and of a class that is none.
    const wm is_box = wm_and(wf_le(whole_first_x, whole_last_x), wf_le(whole_first_y, whole_last_y));
    const wm alive = wm_and(wm_and(t->alive, is_box), wm_and(wf_le(first_x, last_x), wf_le(first_y, last_y)));
    const uint32_t alive_bits = wm_bits(alive);
    if (!alive_bits) return;
    const wi pixel_x = wi_from_f(wf_keep(alive, first_x)), column = wi_sar(pixel_x, 2);
    const wi pixel_y = wi_from_f(wf_keep(alive, first_y)), row = wi_sar(pixel_y, 2);
    const wi columns = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_x)), 2), column), wi_set(1));
    const wi rows = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_y)), 2), row), wi_set(1));
    // Wide splats are wide also where only a narrow part of them is in the tile: its pixels are far from the
    // centre, and how the picture is cut into tiles has no say.
    enum { WIDE_PX = EWA_COLUMN_CLASSES * EWA_BLOCK_PX };
    wm wide = wf_lt(wf_set(WIDE_PX / 2), wf_max(t->half_x, t->half_y));
    if (wm_bits(wf_lt(wf_set((WIDE_PX - EWA_BLOCK_PX) / 2), t->half_x))) { // some have a column too many
        const wf per_block = wf_set(1.0f / EWA_BLOCK_PX);
        const wf whole_columns =
            wf_sub(wf_floor(wf_mul(whole_last_x, per_block)), wf_floor(wf_mul(whole_first_x, per_block)));
        wide = wm_or(wide, wf_le(wf_set(EWA_COLUMN_CLASSES), whole_columns));
    }
    // The key of z + eps has a tangent that serves where the key hardly changes.
    const wf min_key = wf_fnma(wf_abs(t->key_x), t->half_x, wf_fnma(wf_abs(t->key_y), t->half_y, key));
    wf lowest = wf_sub(key_low, margin);
    if (view->circular && !view->orthographic)
        lowest = wf_max(lowest, wf_mul(wf_set((float)EWA_MIN_KEY), t->inverse_z));
    if (!view->orthographic) {
        const wf tangent_key = wf_mul(wf_set(1 - 1 / (float)TANGENT_PARTS), key);
        wide = wm_or(wide, wf_lt(wf_max(min_key, lowest), tangent_key));
    }
    if (view->circular) wide = wm_of_bits(0xffff);
    // Affine ellipses reach beyond what discs cover, so that their planes may end anywhere.
    const wm steep = wm_or(wide, view->affine ? wm_of_bits(0xffff) : wf_lt(margin, beyond));
    const wi steep_bit = wi_of_bits(wf_keep(steep, wf_of_bits(wi_set(EWA_STEEP_BIT))));
    const wi in_block = wi_or(wi_shl(wi_and(pixel_x, wi_set(EWA_BLOCK_PX - 1)), EWA_SMALL_X_SHIFT),
                              wi_shl(wi_and(pixel_y, wi_set(EWA_BLOCK_PX - 1)), EWA_SMALL_Y_SHIFT));
    const wi box = wi_or(wi_or(wi_or(column, steep_bit), wi_shl(row, 8)),
                         wi_or(wi_or(wi_shl(columns, 16), wi_shl(rows, 24)), in_block));

    // The key of z + eps; perspective: the tangent at the centre of 1 / (1 / key + eps).
    wf bound_scale = one, bound_offset = wf_negate(tolerance);
    if (!view->orthographic) {
        const wf share = wf_div(z, wf_add(z, tolerance)), share2 = wf_mul(share, share);
        bound_scale = wf_select(wide, zero, share2);
        bound_offset = wf_select(wide, tolerance, wf_mul(wf_sub(share, share2), t->inverse_z));
    }
    const wf low = wf_select(steep, lowest, min_key);
    *minimum = wf_min(wf_select(alive, low, wf_set(__builtin_inff())), *minimum);

    const color_form form = read_color_form(source->colors[id]);
    const wm is_back = wf_lt(zero, t->facing); // normals are turned towards the viewer
    const wf max_px = wf_set(EWA_SMALL_PX - 1);
    wm small = wm_and(wf_le(wf_sub(last_x, first_x), max_px), wf_le(wf_sub(last_y, first_y), max_px));
    small = wm_and(wm_and(alive, small), wm_not(wm_or(is_back, clipped)));
    run->small_count += (uint32_t)__builtin_popcount(wm_bits(small));
    if (!tile->pixels) small = wm_of_bits(0);
    wf opacity = t->peak; // times the peak
    if (opacities_u16)
        opacity = wf_mul(t->peak, wf_mul(wf_from_i(wi_load_u16(opacities_u16)), wf_set(1.0f / 65535.0f)));
    const wf color_units = wf_mul(opacity, wf_set(view->color_scale));
    wf lanes[16] = {
        wf_sub(wf_fma(wf_from_i(column), wf_set(EWA_BLOCK_PX), wf_set(left)), cx),
        wf_sub(wf_fma(wf_from_i(row), wf_set(EWA_BLOCK_PX), wf_set(top)), cy),
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
        wf_odd_product(color_units, decode_color(&form, packet->red)),
        wf_odd_product(color_units, decode_color(&form, packet->green)),
        wf_odd_product(color_units, decode_color(&form, packet->blue)),
        wf_of_bits(wi_or(box, wi_or(select_int(clipped, EWA_CLIP_BIT, wi_set(0)),
                                    wi_or(select_int(concave, EWA_CONCAVE_BIT, wi_set(0)),
                                          select_int(is_back, EWA_BACK_FACING_BIT, wi_set(0)))))),
    };
    const wi boxes = wi_of_bits(lanes[15]);
    w_transpose(lanes);
    const wf peak_units = wf_mul(t->peak, wf_set(view->sum_scale));
    const wf facing_peak = wf_select(is_back, wf_negate(peak_units), peak_units);
    float loads[64];
    w_store4(loads, wf_odd_product(facing_peak, t->n[0]), wf_odd_product(facing_peak, t->n[1]),
             wf_odd_product(facing_peak, t->n[2]), wf_odd(peak_units));
    wi class_of = select_int(clipped, EWA_CLIP_CLASS, box_classes(columns, rows, steep, wide));
    class_of = wi_of_bits(wf_select(small, wf_of_bits(small_classes(small, first_x, first_y, last_x, last_y)),
                                    wf_of_bits(class_of)));
    uint8_t classes[16];
    wi_store_u8(classes, class_of);
    if (wm_bits(wm_and(alive, clipped))) list_clipped(run, wm_bits(wm_and(alive, clipped)), alive_bits, id);
    float opacities[16];
    if (run->opacities) wf_store(opacities, wf_odd_product(opacity, wf_set(view->sum_scale)));
    emit(run, alive_bits, id, lanes, loads, opacities, materials, classes, boxes, low);
}

static ALWAYS_INLINE void setup_run(const ewa_view *view, const ewa_packet_source *source,
                                    const uint32_t *packet_ids, uint32_t count, uint32_t announced,
                                    bool ellipses, const ewa_tile *tile, ewa_run *run) {
    enum { TOGETHER = 4, AHEAD = 12, LINE_BYTES = 64 };
    const ewa_packet *packets = source->packets;
    stage stages[TOGETHER];
    run->count = 0;
    run->near_count = run->clipped_count = run->small_count = 0;
    wf minimum = wf_set(__builtin_inff());
    for (uint32_t first = 0; first < count; first += TOGETHER) {
        const uint32_t here = count - first < TOGETHER ? count - first : TOGETHER;
        const uint32_t *ids = packet_ids + first;
        for (uint32_t i = 0; i < here; i++) {
            if (first + i + AHEAD < announced) {
                const char *later = (const char *)&packets[ids[i + AHEAD]];
                for (size_t line = 0; line < sizeof(ewa_packet) + LINE_BYTES - 1; line += LINE_BYTES)
                    __builtin_prefetch(later + line);
            }
            stage_place(view, source, ids[i], tile, &stages[i]);
        }
        if (!(view->point_sigma_px > 0)) {
            for (uint32_t i = 0; i < here; i++) stage_turn(view, source, ids[i], ellipses, &stages[i]);
            for (uint32_t i = 0; i < here; i++) stage_range(view, ids[i], ellipses, &stages[i], run);
            for (uint32_t i = 0; i < here; i++) stage_covariance(view, ellipses, &stages[i]);
        }
        for (uint32_t i = 0; i < here; i++) stage_shape(view, &stages[i]);
        for (uint32_t i = 0; i < here; i++)
            if (wm_bits(stages[i].alive)) stage_emit(view, source, ids[i], tile, &stages[i], run, &minimum);
    }
    run->min_key = -largest_lane(wf_negate(minimum));
}

static void setup(const ewa_view *view, const ewa_packet_source *packets, const uint32_t *packet_ids,
                  uint32_t count, uint32_t announced, const ewa_tile *tile, ewa_run *run) {
    if (view->ellipses)
        setup_run(view, packets, packet_ids, count, announced, true, tile, run);
    else
        setup_run(view, packets, packet_ids, count, announced, false, tile, run);
}

#endif
