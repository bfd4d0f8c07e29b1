// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: where splats are in a tile, and how near (docs/math.md sections 3, 5 and 6).
#ifndef EWA_SRC_SURFACE_PIPELINE_PLACE_H
#define EWA_SRC_SURFACE_PIPELINE_PLACE_H

#include "surface/pipeline_packet.h"

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

/// Where splats are and how near: keys of the centres and of their discs' range, and what these may be off by.
typedef struct splat_place {
    wf x_px, y_px; ///< centres, at whole places
    wf key, key_low, key_high;
    wf beyond; ///< by which keys reach beyond the disc's range in what the splat covers
    wf margin; ///< by which they may, units of the key
    wf tolerance;
    wm concave;
} splat_place;

static ALWAYS_INLINE splat_place place_splats(const ewa_view *view, const uint16_t *curvatures, const stage *t, wm clipped) {
    const wf one = wf_set(1), zero = wf_set(0), z = t->z;
    const wf c1_px = wf_mul(t->c1, wf_set(view->fx_zoomed)), c2_px = wf_mul(t->c2, wf_set(view->fy_zoomed));
    const wf slope = wf_sqrt(wf_fma(t->key_x, t->key_x, wf_mul(t->key_y, t->key_y)));
    // The depth that the prefilter reaches across, the maximum that goes into the tolerance, and how far the
    // plane may be used beyond the disc's range; the latter in units of the key.
    const wf support = wf_mul(wf_set(view->cutoff), t->sigma), reach = wf_mul(wf_set(view->reach_px), slope);
    splat_place at = {.beyond = reach, .concave = wm_of_bits(0)};
    wf reach_depth = reach;
    wf limit =
        wf_min(wf_mul(wf_set((float)EWA_FREE_RADII), support), wf_mul(wf_set((float)EWA_FREE_DEPTH), z));
    if (view->orthographic) {
        at.key = wf_negate(z);
        at.key_low = wf_negate(wf_add(z, t->range)), at.key_high = wf_sub(t->range, z);
    } else {
        const wf k = wf_mul(wf_mul(t->root_k, t->root_k), t->inverse_z);
        at.key = wf_fma(t->key_x, c1_px, wf_fma(t->key_y, c2_px, t->inverse_z));
        at.key_low = wf_mul(wf_sub(one, t->part), k), at.key_high = wf_mul(wf_add(one, t->part), k);
        reach_depth = wf_mul(wf_mul(reach, z), z);
        limit = wf_mul(wf_mul(limit, t->inverse_z), t->inverse_z);
    }
    wf x = wf_add(wf_fma(t->dx, wf_set(view->fx_px), wf_set(t->base_x)), c1_px);
    wf y = wf_add(wf_fma(t->dy, wf_set(view->fy_px), wf_set(t->base_y)), c2_px);
    contour_way way;
    // What moves keeps its plane of keys, whose range beside the disc is that of what the splat may reach.
    if (curvatures && find_contour_way(view, curvatures, t, slope, clipped, &way)) {
        at.key = wf_add(at.key, way.key), at.beyond = wf_add(at.beyond, wf_abs(way.key));
        x = wf_add(x, way.x), y = wf_add(y, way.y);
        if (!view->transparent) at.concave = way.concave;
    }
    at.margin = wf_max(wf_sub(limit, reach), zero);
    if (view->circular) {
        const wf maximum = wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support);
        const wf max_key = view->orthographic ? maximum : wf_mul(wf_mul(maximum, t->inverse_z), t->inverse_z);
        at.margin = wf_add(at.margin, wf_min(wf_mul(t->half_x, slope), max_key));
    }
    const wf grazing = wf_min(wf_mul(wf_set(view->grazing), reach_depth),
                              wf_mul(wf_set((float)EWA_GRAZING_TOLERANCE), support));
    at.tolerance = wf_fma(wf_set(view->tolerance), t->sigma, grazing);
    at.x_px = whole_place(x), at.y_px = whole_place(y);
    return at;
}

/// The pixels of splats in a tile, and the blocks of these.
typedef struct splat_box {
    wf first_x, first_y, last_x, last_y;
    wi pixel_x, pixel_y, column, row, columns, rows;
    wm alive, wide;
} splat_box;

/// Returns whether any is in the tile.
static ALWAYS_INLINE bool find_boxes(const ewa_tile *tile, const stage *t, const splat_place *at, splat_box *box) {
    const wf one = wf_set(1), half = wf_set(0.5f);
    const float left = tile->field_x_px, top = tile->field_y_px;
    const wf whole_first_x = wf_add(wf_floor(wf_sub(wf_sub(at->x_px, t->half_x), half)), one);
    const wf whole_last_x = wf_floor(wf_sub(wf_add(at->x_px, t->half_x), half));
    box->first_x = wf_sub(wf_max(whole_first_x, wf_set(left)), wf_set(left));
    const wf whole_first_y = wf_add(wf_floor(wf_sub(wf_sub(at->y_px, t->half_y), half)), one);
    const wf whole_last_y = wf_floor(wf_sub(wf_add(at->y_px, t->half_y), half));
    box->first_y = wf_sub(wf_max(whole_first_y, wf_set(top)), wf_set(top));
    box->last_x = wf_min(wf_sub(whole_last_x, wf_set(left)), wf_set((float)(tile->width_px - 1)));
    box->last_y = wf_min(wf_sub(whole_last_y, wf_set(top)), wf_set((float)(tile->height_px - 1)));
    // A box that is no number would be as large as the tile without being wide, and of a class that is none.
    const wm is_box = wm_and(wf_le(whole_first_x, whole_last_x), wf_le(whole_first_y, whole_last_y));
    const wm alive = box->alive = wm_and(wm_and(t->alive, is_box),
                                         wm_and(wf_le(box->first_x, box->last_x), wf_le(box->first_y, box->last_y)));
    if (!wm_bits(alive)) return false;
    box->pixel_x = wi_from_f(wf_keep(alive, box->first_x)), box->column = wi_sar(box->pixel_x, 2);
    box->pixel_y = wi_from_f(wf_keep(alive, box->first_y)), box->row = wi_sar(box->pixel_y, 2);
    box->columns = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, box->last_x)), 2), box->column), wi_set(1));
    box->rows = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, box->last_y)), 2), box->row), wi_set(1));
    // Wide splats are wide also where only a narrow part of them is in the tile: its pixels are far from the
    // centre, and how the picture is cut into tiles has no say.
    enum { WIDE_PX = EWA_COLUMN_CLASSES * EWA_BLOCK_PX };
    box->wide = wf_lt(wf_set(WIDE_PX / 2), wf_max(t->half_x, t->half_y));
    if (wm_bits(wf_lt(wf_set((WIDE_PX - EWA_BLOCK_PX) / 2), t->half_x))) { // some have a column too many
        const wf per_block = wf_set(1.0f / EWA_BLOCK_PX);
        const wf whole_columns =
            wf_sub(wf_floor(wf_mul(whole_last_x, per_block)), wf_floor(wf_mul(whole_first_x, per_block)));
        box->wide = wm_or(box->wide, wf_le(wf_set(EWA_COLUMN_CLASSES), whole_columns));
    }
    return true;
}

/// Which are alive, and of few pixels.
static ALWAYS_INLINE wm box_is_small(const splat_box *box) {
    const wf max_px = wf_set(EWA_SMALL_PX - 1);
    return wm_and(box->alive,
                  wm_and(wf_le(wf_sub(box->last_x, box->first_x), max_px), wf_le(wf_sub(box->last_y, box->first_y), max_px)));
}

/// The lowest keys of splats, and the bounds that keys are held to: of z + eps, by a line where splats are not steep.
typedef struct splat_bound {
    wf low, scale, offset;
    wm steep, wide;
} splat_bound;

static ALWAYS_INLINE splat_bound bound_splats(const ewa_view *view, const stage *t, const splat_place *at, wm wide) {
    const wf one = wf_set(1), zero = wf_set(0);
    splat_bound by = {.wide = wide};
    // The key of z + eps has a tangent that serves where the key hardly changes.
    const wf min_key = wf_fnma(wf_abs(t->key_x), t->half_x, wf_fnma(wf_abs(t->key_y), t->half_y, at->key));
    wf lowest = wf_sub(at->key_low, at->margin);
    if (view->circular && !view->orthographic)
        lowest = wf_max(lowest, wf_mul(wf_set((float)EWA_MIN_KEY), t->inverse_z));
    if (!view->orthographic) {
        const wf tangent_key = wf_mul(wf_set(1 - 1 / (float)TANGENT_PARTS), at->key);
        by.wide = wm_or(by.wide, wf_lt(wf_max(min_key, lowest), tangent_key));
    }
    if (view->circular) by.wide = wm_of_bits(0xffff);
    // Affine ellipses reach beyond what discs cover, so that their planes may end anywhere.
    by.steep = wm_or(by.wide, view->affine ? wm_of_bits(0xffff) : wf_lt(at->margin, at->beyond));
    by.low = wf_select(by.steep, lowest, min_key);
    // The key of z + eps; perspective: the tangent at the centre of 1 / (1 / key + eps).
    by.scale = one, by.offset = wf_negate(at->tolerance);
    if (!view->orthographic) {
        const wf share = wf_div(t->z, wf_add(t->z, at->tolerance)), share2 = wf_mul(share, share);
        by.scale = wf_select(by.wide, zero, share2);
        by.offset = wf_select(by.wide, at->tolerance, wf_mul(wf_sub(share, share2), t->inverse_z));
    }
    return by;
}

/// Blocks of splats and where in them these begin, as records have them.
static ALWAYS_INLINE wi pack_boxes(const splat_box *box, wm steep) {
    const wi steep_bit = wi_of_bits(wf_keep(steep, wf_of_bits(wi_set(EWA_STEEP_BIT))));
    const wi in_block = wi_or(wi_shl(wi_and(box->pixel_x, wi_set(EWA_BLOCK_PX - 1)), EWA_SMALL_X_SHIFT),
                              wi_shl(wi_and(box->pixel_y, wi_set(EWA_BLOCK_PX - 1)), EWA_SMALL_Y_SHIFT));
    return wi_or(wi_or(wi_or(box->column, steep_bit), wi_shl(box->row, 8)),
                 wi_or(wi_or(wi_shl(box->columns, 16), wi_shl(box->rows, 24)), in_block));
}

#endif
