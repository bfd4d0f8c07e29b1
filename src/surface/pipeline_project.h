// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: surfels to records, records to classes (docs/math.md sections 2 to 6, 9).
//
// Based on: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004, section 4,
// in the sheared form of docs/math.md section 3, which single precision needs.
#ifndef EWA_SRC_SURFACE_PIPELINE_PROJECT_H
#define EWA_SRC_SURFACE_PIPELINE_PROJECT_H

#include "surface/pipeline_place.h"
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
static inline wi small_classes(wm small, const splat_box *box) {
    const wf columns = wf_sub(box->last_x, box->first_x), rows = wf_sub(box->last_y, box->first_y); // but for one
    const wf place = wf_fma(columns, wf_set(EWA_SMALL_PX), rows);
    return wi_add(wi_from_f(wf_keep(small, place)), wi_set(EWA_SMALL_CLASS));
}

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

/// Third step: tolerance, box in the tile, and the records of the lanes that are in it.
static ALWAYS_INLINE void stage_emit(const ewa_view *view, const ewa_packet_source *source, uint32_t id,
                                     const ewa_tile *tile, stage *t, ewa_run *run, wf *minimum) {
    const size_t first_lane = (size_t)id * EWA_PACKET_LANES;
    const uint32_t own = source->clip_masks ? source->clip_masks[id] : 0;
    const wm clipped = wm_of_bits(own | (source->places.cuts ? source->places.cuts[id] : 0));
    const splat_place at = place_splats(view, source->curvatures ? source->curvatures + first_lane : NULL, t, clipped);
    splat_box box;
    if (!find_boxes(tile, t, &at, &box)) return;
    const splat_bound by = bound_splats(view, t, &at, box.wide);
    const wm alive = box.alive, steep = by.steep;
    const uint32_t alive_bits = wm_bits(alive);
    *minimum = wf_min(wf_select(alive, by.low, wf_set(__builtin_inff())), *minimum);

    const ewa_packet *packet = &source->packets[id];
    const color_form form = read_color_form(source->colors[id]);
    const wm is_back = wf_lt(wf_set(0), t->facing); // normals are turned towards the viewer
    wm small = wm_and(box_is_small(&box), wm_not(wm_or(is_back, clipped)));
    run->small_count += (uint32_t)__builtin_popcount(wm_bits(small));
    if (!tile->pixels) small = wm_of_bits(0);
    wf opacity = t->peak; // times the peak
    if (source->opacities)
        opacity = wf_mul(t->peak, wf_mul(wf_from_i(wi_load_u16(source->opacities + first_lane)), wf_set(1.0f / 65535.0f)));
    const wf color_units = wf_mul(opacity, wf_set(view->color_scale));
    wf lanes[16] = {
        wf_sub(wf_fma(wf_from_i(box.column), wf_set(EWA_BLOCK_PX), wf_set(tile->field_x_px)), at.x_px),
        wf_sub(wf_fma(wf_from_i(box.row), wf_set(EWA_BLOCK_PX), wf_set(tile->field_y_px)), at.y_px),
        t->xx,
        t->xy,
        t->yy,
        at.key,
        t->key_x,
        t->key_y,
        wf_select(steep, by.scale, wf_fma(by.scale, at.key, by.offset)),
        wf_select(steep, by.offset, wf_mul(by.scale, t->key_x)),
        wf_select(steep, wf_add(at.key_high, at.margin), wf_mul(by.scale, t->key_y)),
        by.low,
        wf_odd_product(color_units, decode_color(&form, packet->red)),
        wf_odd_product(color_units, decode_color(&form, packet->green)),
        wf_odd_product(color_units, decode_color(&form, packet->blue)),
        wf_of_bits(wi_or(wi_or(pack_boxes(&box, steep), select_int(clipped, EWA_CLIP_BIT, wi_set(0))),
                         wi_or(select_int(at.concave, EWA_CONCAVE_BIT, wi_set(0)),
                               select_int(is_back, EWA_BACK_FACING_BIT, wi_set(0))))),
    };
    const wi boxes = wi_of_bits(lanes[15]);
    w_transpose(lanes);
    const wf peak_units = wf_mul(t->peak, wf_set(view->sum_scale));
    const wf facing_peak = wf_select(is_back, wf_negate(peak_units), peak_units);
    float loads[64];
    w_store4(loads, wf_odd_product(facing_peak, t->n[0]), wf_odd_product(facing_peak, t->n[1]),
             wf_odd_product(facing_peak, t->n[2]), wf_odd(peak_units));
    const wi class_of = select_int(clipped, EWA_CLIP_CLASS, box_classes(box.columns, box.rows, steep, by.wide));
    uint8_t classes[16], same[EWA_PACKET_LANES];
    wi_store_u8(classes, wi_of_bits(wf_select(small, wf_of_bits(small_classes(small, &box)), wf_of_bits(class_of))));
    if (wm_bits(wm_and(alive, clipped))) list_clipped(run, wm_bits(wm_and(alive, clipped)), alive_bits, id);
    float opacities[16];
    if (run->opacities) wf_store(opacities, wf_odd_product(opacity, wf_set(view->sum_scale)));
    const uint8_t *materials = source->materials ? source->materials + first_lane : same;
    if (run->materials && !source->materials) memset(same, source->material, sizeof same);
    emit(run, alive_bits, id, lanes, loads, opacities, materials, classes, boxes, by.low);
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
