// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: packets to tiles, and packets that nothing can be seen of (docs/math.md sections 2
// and 3).
#ifndef EWA_SRC_SURFACE_PIPELINE_CULL_H
#define EWA_SRC_SURFACE_PIPELINE_CULL_H

#include "surface/pipeline_section.h"

static inline float tile_count(uint32_t side_px, uint32_t tile_px) {
    return (float)((side_px + tile_px - 1) / tile_px);
}

/// The tiles between two pixel coordinates along one axis, as floats within [0, tile_count].
static inline void tile_range(wf low_px, wf high_px, float tile_px, float tiles, wf *first, wf *end) {
    const wf per_px = wf_set(1.0f / tile_px);
    *first = wf_clamp(wf_floor(wf_mul(low_px, per_px)), 0, tiles);
    *end = wf_clamp(wf_add(wf_floor(wf_mul(high_px, per_px)), wf_set(1)), 0, tiles);
}

/// How far an affine ellipse of size z * `reach` extends from its centre, for centres within `half` of
/// `middle`; pixels.
static inline wf affine_reach(wf middle, wf half, wf reach, float f_px, float c_px) {
    const wf slope_px = wf_add(wf_abs(wf_sub(middle, wf_set(c_px))), half);
    return wf_mul(reach, wf_add(wf_set(f_px), slope_px));
}

/// Sixteen packets on the screen: the boxes around their spheres' outlines, in pixels.
typedef struct packet_outline {
    wf center[3], radius; ///< camera space
    wf slope[2];          ///< x / z, y / z; orthographic: x, y
    wf x, y, half_x, half_y;
    wm near; ///< touches the eye plane: no box
} packet_outline;

/// What half sizes of boxes lose by rounding where the principal point or the box is far from the picture.
static inline wf widened(wf half, wf middle, float c_px) {
    return wf_fma(wf_add(wf_abs(middle), wf_set(c_px < 0 ? -c_px : c_px)), wf_set(0x1p-20f), half);
}

/// Sets what follows from centre and radius.
static ALWAYS_INLINE void outline_packets(const ewa_view *view, packet_outline *o) {
    const wf *c = o->center, r = o->radius;
    if (view->orthographic) {
        o->near = wm_of_bits(0);
        o->slope[0] = c[0], o->slope[1] = c[1];
        o->x = wf_fma(c[0], wf_set(view->fx_px), wf_set(view->cx_px));
        o->y = wf_fma(c[1], wf_set(view->fy_px), wf_set(view->cy_px));
        const float larger_px = view->fx_px > view->fy_px ? view->fx_px : view->fy_px;
        o->half_x = wf_mul(r, wf_set(view->circular ? larger_px : view->fx_px));
        o->half_y = wf_mul(r, wf_set(view->circular ? larger_px : view->fy_px));
    } else {
        o->near = wf_le(c[2], wf_mul(r, wf_set((float)EWA_NEAR_RATIO)));
        // The tight box of a sphere's outline: D = r^2 I - c'c (docs/math.md section 3), over z^2.
        const wf one = wf_set(1), inverse_z = wf_div(one, c[2]), q = wf_mul(r, inverse_z);
        const wf sx = wf_mul(c[0], inverse_z), sy = wf_mul(c[1], inverse_z), rest = wf_fnma(q, q, one);
        const wf inverse = wf_div(one, rest), half = wf_mul(q, inverse);
        const wf rx = wf_sqrt(wf_max(wf_fma(sx, sx, rest), wf_set(0)));
        const wf ry = wf_sqrt(wf_max(wf_fma(sy, sy, rest), wf_set(0)));
        o->slope[0] = sx, o->slope[1] = sy;
        o->x = wf_fma(wf_mul(sx, inverse), wf_set(view->fx_px), wf_set(view->cx_px));
        o->y = wf_fma(wf_mul(sy, inverse), wf_set(view->fy_px), wf_set(view->cy_px));
        o->half_x = wf_mul(wf_mul(rx, half), wf_set(view->fx_px));
        o->half_y = wf_mul(wf_mul(ry, half), wf_set(view->fy_px));
        if (view->affine) {
            // Affine ellipses may leave the sphere's outline: |J t| <= (1 + |slope|) |t| / z around a
            // centre in it.
            const wf reach = wf_div(q, wf_sub(one, q));
            const wf reach_x = affine_reach(o->x, o->half_x, reach, view->fx_px, view->cx_px);
            const wf reach_y = affine_reach(o->y, o->half_y, reach, view->fy_px, view->cy_px);
            o->half_x = wf_add(o->half_x, view->circular ? wf_add(reach_x, reach_y) : reach_x);
            o->half_y = wf_add(o->half_y, view->circular ? wf_add(reach_x, reach_y) : reach_y);
        }
    }
    const wf margin_px = wf_set(view->margin_px);
    o->half_x = widened(wf_add(o->half_x, margin_px), o->x, view->cx_px);
    o->half_y = widened(wf_add(o->half_y, margin_px), o->y, view->cy_px);
}

/// Which packets are not wholly behind the eye plane and lie within the view volume's sides. The planes bound
/// exact outlines, not affine ellipses.
static ALWAYS_INLINE wm within_sides(const ewa_view *view, const packet_outline *o) {
    const wf *c = o->center;
    wm within = wf_lt(wf_negate(o->radius), c[2]);
    if (view->orthographic || view->affine) return within;
    // A distance from a side has the rounding errors of that from the eye.
    const wf size = wf_add(wf_add(wf_abs(c[0]), wf_abs(c[1])), wf_abs(c[2]));
    const wf outward = wf_negate(wf_fma(size, wf_set(0x1p-20f), o->radius));
    for (int k = 0; k < 4; k++) {
        const float *n = view->side_planes[k];
        const wf d = wf_fma(wf_set(n[0]), c[0], wf_fma(wf_set(n[1]), c[1], wf_mul(wf_set(n[2]), c[2])));
        within = wm_and(within, wf_lt(outward, d));
    }
    return within;
}

/// Which packets' surfels all face away.
static ALWAYS_INLINE wm back_facing(const ewa_view *view, const ewa_packet_bounds *bounds, uint32_t first,
                                    const packet_outline *o) {
    const wf *c = o->center;
    const wi code = wi_load((const int32_t *)(const void *)(bounds->cone + first));
    const wi axis_mask = wi_set((1 << EWA_CONE_BITS) - 1), offset = wi_set(EWA_CONE_AXIS);
    const wf u = wf_mul(wf_from_i(wi_sub(wi_and(code, axis_mask), offset)), wf_set(1.0f / EWA_CONE_AXIS));
    const wf v = wf_mul(wf_from_i(wi_sub(wi_and(wi_sar(code, EWA_CONE_BITS), axis_mask), offset)),
                        wf_set(1.0f / EWA_CONE_AXIS));
    const wi sine_code = wi_and(wi_sar(code, 2 * EWA_CONE_BITS), wi_set((1 << (32 - 2 * EWA_CONE_BITS)) - 1));
    const wf sine = wf_mul(wf_from_i(sine_code), wf_set(1.0f / EWA_CONE_SINE));
    const wm wide = wf_lt(wf_set(EWA_CONE_SINE), wf_from_i(sine_code));
    wf world[3], axis[3];
    unfold(u, v, world);
    rotate(view->rotation, world[0], world[1], world[2], axis);
    if (view->orthographic) return wm_and(wm_not(wide), wf_lt(sine, axis[2]));
    const wf along = wf_fma(axis[0], c[0], wf_fma(axis[1], c[1], wf_mul(axis[2], c[2])));
    const wf length2 = wf_fma(c[0], c[0], wf_fma(c[1], c[1], wf_mul(c[2], c[2])));
    const wm away = wf_lt(wf_fma(wf_sqrt(length2), sine, o->radius), along);
    return wm_and(wm_and(wm_not(wide), wf_lt(wf_set(0x1p-120f), length2)), away);
}

/// The radii of packets [first, first + 16), camera space; 0: empty.
static inline wf packet_radii(const ewa_view *view, const uint16_t *codes) {
    return wf_mul(wf_of_bits(wi_shl(wi_load_u16(codes), EWA_RADIUS_SHIFT)), wf_set(view->scale));
}

/// Takes the centres of packets [first, first + 16) to camera space.
static inline void place_centers(const ewa_view *view, const ewa_packet_bounds *bounds, uint32_t first,
                                 wd center[3]) {
    const double *m = view->linear;
    const wd x = wd_sub(wd_load(bounds->center_x + first), wd_set(view->anchor[0]));
    const wd y = wd_sub(wd_load(bounds->center_y + first), wd_set(view->anchor[1]));
    const wd z = wd_sub(wd_load(bounds->center_z + first), wd_set(view->anchor[2]));
    for (int i = 0; i < 3; i++)
        center[i] =
            wd_fma(wd_set(m[3 * i]), x,
                   wd_fma(wd_set(m[3 * i + 1]), y, wd_fma(wd_set(m[3 * i + 2]), z, wd_set(view->offset[i]))));
}

static inline void store_places(const ewa_view *view, const wd center[3], const packet_outline *o,
                                const ewa_packet_places *places, uint32_t first) {
    float *const slopes[2] = {places->slope_x, places->slope_y}, *const rests[2] = {places->rest_x,
                                                                                    places->rest_y};
    wf_store(places->depth + first, o->center[2]);
    for (int i = 0; i < 2; i++) {
        const wf slope = wf_select(o->near, wf_set(0), o->slope[i]);
        const wd steep = wd_from_f(slope);
        const wd rest = view->orthographic ? wd_sub(center[i], steep) : wd_fnma(steep, center[2], center[i]);
        wf_store(slopes[i] + first, slope);
        wf_store(rests[i] + first, wf_from_d(rest));
    }
}

/// Corners of rectangles in the form of ewa_bin_items.
static inline wi tile_corners(wm alive, wf x, wf y) {
    return wi_or(wi_from_f(wf_keep(alive, x)), wi_shl(wi_from_f(wf_keep(alive, y)), 16));
}

static uint32_t cull(const ewa_view *view, const ewa_packet *packets, const ewa_packet_bounds *bounds,
                     uint32_t first, uint32_t count, const ewa_packet_places *places,
                     const ewa_bin_items *kept) {
    const float tile_px = (float)view->tile_px;
    const float tiles_x = tile_count(view->width_px, view->tile_px),
                tiles_y = tile_count(view->height_px, view->tile_px);
    const wi lanes = wi_load((const int32_t[16]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
    uint32_t next = first;
    for (uint32_t p = first; p < first + count; p += 16) {
        packet_outline o = {.radius = packet_radii(view, bounds->radius + p)};
        wd center[3];
        place_centers(view, bounds, p, center);
        for (int k = 0; k < 3; k++) o.center[k] = wf_from_d(center[k]);
        wm alive = wm_and(within_sides(view, &o), wf_lt(wf_set(0), o.radius));
        const uint32_t left = first + count - p;
        if (left < 16) alive = wm_and(alive, wm_of_bits((1u << left) - 1));
        if (!wm_bits(alive)) continue;
        if (view->section_count) alive = keep_sections(view, packets, bounds, p, alive, places);
        if (!wm_bits(alive)) continue;
        if (view->cull_back) alive = wm_and(alive, wm_not(back_facing(view, bounds, p, &o)));
        if (!wm_bits(alive)) continue;
        outline_packets(view, &o);
        wf x0, x1, y0, y1;
        tile_range(wf_sub(o.x, o.half_x), wf_add(o.x, o.half_x), tile_px, tiles_x, &x0, &x1);
        tile_range(wf_sub(o.y, o.half_y), wf_add(o.y, o.half_y), tile_px, tiles_y, &y0, &y1);
        x0 = wf_select(o.near, wf_set(0), x0), x1 = wf_select(o.near, wf_set(tiles_x), x1);
        y0 = wf_select(o.near, wf_set(0), y0), y1 = wf_select(o.near, wf_set(tiles_y), y1);
        alive = wm_and(alive, wm_and(wf_lt(x0, x1), wf_lt(y0, y1)));
        if (!wm_bits(alive)) continue;
        store_places(view, center, &o, places, p);
        wi_pack(kept->ids + next, alive, wi_add(wi_set((int32_t)p), lanes));
        wi_pack(kept->first + next, alive, tile_corners(alive, x0, y0));
        wi_pack(kept->end + next, alive, tile_corners(alive, x1, y1));
        next += (uint32_t)__builtin_popcount(wm_bits(alive));
    }
    return next - first;
}

static void set_cells(const ewa_tile *tile, float *cells) {
    const uint32_t columns = tile->blocks_per_row, rows = tile->block_rows;
    for (uint32_t top = 0; top < rows; top += EWA_CELL_BLOCKS)
        for (uint32_t left = 0; left < columns; left += EWA_CELL_BLOCKS) {
            const uint32_t bottom = top + EWA_CELL_BLOCKS < rows ? top + EWA_CELL_BLOCKS : rows;
            const uint32_t right = left + EWA_CELL_BLOCKS < columns ? left + EWA_CELL_BLOCKS : columns;
            wf minimum = wf_set(__builtin_inff());
            for (uint32_t row = top; row < bottom; row++)
                for (uint32_t column = left; column < right; column++)
                    minimum = wf_min(
                        wf_load(tile->nearest + (size_t)(row * columns + column) * EWA_BLOCK_LANES), minimum);
            cells[top / EWA_CELL_BLOCKS * EWA_TILE_CELLS + left / EWA_CELL_BLOCKS] =
                -largest_lane(wf_negate(minimum));
        }
}

/// The smallest key of cells [left, right] x [top, bottom].
static ALWAYS_INLINE float min_key(const float *cells, int32_t left, int32_t top, int32_t right,
                                   int32_t bottom) {
    // Most packets touch no more than two cells along a side: their corners.
    const float *upper = cells + top * EWA_TILE_CELLS, *lower = cells + bottom * EWA_TILE_CELLS;
    const float a = upper[left] < upper[right] ? upper[left] : upper[right];
    const float b = lower[left] < lower[right] ? lower[left] : lower[right];
    float minimum = a < b ? a : b;
    if (right - left < 2 && bottom - top < 2) return minimum;
    for (int32_t row = top; row <= bottom; row++)
        for (int32_t column = left; column <= right; column++) {
            const float cell = cells[row * EWA_TILE_CELLS + column];
            minimum = cell < minimum ? cell : minimum;
        }
    return minimum;
}

/// Centres and radii of packets by their numbers.
static ALWAYS_INLINE void load_spheres(const ewa_view *view, const ewa_packet_bounds *bounds,
                                       const ewa_packet_places *places, const uint32_t *ids, uint32_t count,
                                       packet_outline *o) {
    const float *const from[5] = {places->slope_x, places->slope_y, places->rest_x, places->rest_y,
                                  places->depth};
    wf to[5];
    if (count == 16 && ids[15] - ids[0] == 15) { // neighbours in the order of the packets
        for (int i = 0; i < 5; i++) to[i] = wf_load(from[i] + ids[0]);
        o->radius = packet_radii(view, bounds->radius + ids[0]);
    } else {
        uint16_t codes[16];
        for (uint32_t k = 0; k < 16; k++) codes[k] = bounds->radius[ids[k < count ? k : 0]];
        for (int i = 0; i < 5; i++) {
            float lanes[16];
            for (uint32_t k = 0; k < 16; k++) lanes[k] = from[i][ids[k < count ? k : 0]];
            to[i] = wf_load(lanes);
        }
        o->radius = packet_radii(view, codes);
    }
    const wf z = o->center[2] = to[4];
    o->center[0] = view->orthographic ? wf_add(to[0], to[2]) : wf_fma(to[0], z, to[2]);
    o->center[1] = view->orthographic ? wf_add(to[1], to[3]) : wf_fma(to[1], z, to[3]);
}

static void depths(const ewa_view *view, const ewa_packet_bounds *bounds, const ewa_packet_places *places,
                   const uint32_t *ids, uint32_t count, float *depths) {
    for (uint32_t first = 0; first < count; first += 16) {
        packet_outline o;
        load_spheres(view, bounds, places, ids + first, count - first < 16 ? count - first : 16, &o);
        wf_store(depths + first, wf_sub(o.center[2], o.radius));
    }
}

static uint32_t hide(const ewa_view *view, const ewa_packet_bounds *bounds, const ewa_packet_places *places,
                     const ewa_tile *tile, const float *cells, const uint32_t *ids, uint32_t count,
                     uint32_t *shown, uint32_t *hidden) {
    const float last_column = (float)((tile->blocks_per_row - 1) / EWA_CELL_BLOCKS);
    const float last_row = (float)((tile->block_rows - 1) / EWA_CELL_BLOCKS);
    const wf per_px = wf_set(1.0f / (EWA_CELL_BLOCKS * EWA_BLOCK_PX));
    const wf left = wf_set((float)tile->x_px), top = wf_set((float)tile->y_px);
    uint32_t shown_count = 0, hidden_count = 0;
    for (uint32_t first = 0; first < count; first += 16) {
        const uint32_t here = count - first < 16 ? count - first : 16;
        packet_outline o;
        load_spheres(view, bounds, places, ids + first, here, &o);
        outline_packets(view, &o);
        // No key is beyond this: a disc's range, and how far its plane may go beyond (semantics.h), which is
        // EWA_FREE_RADII support radii for affine ellipses, half of that for others, more for circles.
        const float free_radii = (float)EWA_FREE_RADII * (view->affine ? 1.0f : 0.5f) +
                                 (view->circular ? (float)EWA_GRAZING_TOLERANCE : 0);
        const wf beyond = wf_mul(wf_set(free_radii), o.radius);
        wf key;
        if (view->orthographic) {
            key = wf_add(beyond, wf_sub(o.radius, o.center[2]));
        } else {
            const wf inverse = wf_div(wf_set(1), wf_sub(o.center[2], o.radius));
            key = wf_fma(wf_mul(beyond, inverse), inverse, inverse);
        }
        key = wf_select(o.near, wf_set(__builtin_inff()), key);
        const wf x = wf_sub(o.x, left), y = wf_sub(o.y, top);
        int32_t corners[4][16];
        float keys[16];
        wf_store(keys, key);
        wi_store(corners[0], wi_from_f(wf_clamp(wf_mul(wf_sub(x, o.half_x), per_px), 0, last_column)));
        wi_store(corners[1], wi_from_f(wf_clamp(wf_mul(wf_sub(y, o.half_y), per_px), 0, last_row)));
        wi_store(corners[2], wi_from_f(wf_clamp(wf_mul(wf_add(x, o.half_x), per_px), 0, last_column)));
        wi_store(corners[3], wi_from_f(wf_clamp(wf_mul(wf_add(y, o.half_y), per_px), 0, last_row)));
        for (uint32_t k = 0; k < here; k++) {
            const bool behind =
                keys[k] < min_key(cells, corners[0][k], corners[1][k], corners[2][k], corners[3][k]);
            const uint32_t id = ids[first + k];
            hidden[hidden_count] = id;
            shown[shown_count] = id;
            hidden_count += behind;
            shown_count += !behind;
        }
    }
    return shown_count;
}

#endif
