// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: packets to tiles, and packets that nothing can be seen of.
#ifndef EWA_SRC_KERNELS_ROAD_CULL_H
#define EWA_SRC_KERNELS_ROAD_CULL_H

#include "kernels/road_camera.h"

#include <string.h>

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
    wf x, y, half_x, half_y;
    wm before_eye; ///< not wholly behind the eye plane
    wm near;       ///< touches it: no box
} packet_outline;

static ALWAYS_INLINE packet_outline packet_outlines(const ewa_view *view, wf x, wf y, wf z, wf radius) {
    packet_outline o;
    wf *c = o.center;
    to_camera(view, x, y, z, c);
    const wf r = o.radius = wf_mul(radius, wf_set(view->scale));
    o.before_eye = wf_lt(wf_negate(r), c[2]);
    if (view->orthographic) {
        o.near = wm_of_bits(0);
        o.x = wf_fma(c[0], wf_set(view->fx_px), wf_set(view->cx_px));
        o.y = wf_fma(c[1], wf_set(view->fy_px), wf_set(view->cy_px));
        const float larger_px = view->fx_px > view->fy_px ? view->fx_px : view->fy_px;
        o.half_x = wf_mul(r, wf_set(view->circular ? larger_px : view->fx_px));
        o.half_y = wf_mul(r, wf_set(view->circular ? larger_px : view->fy_px));
    } else {
        o.near = wf_le(c[2], wf_mul(r, wf_set((float)EWA_NEAR_RATIO)));
        // The tight box of a sphere's outline: D = r^2 I - c'c (math.md section 3).
        const wf r2 = wf_mul(r, r), z2 = wf_mul(c[2], c[2]);
        const wf inverse = wf_div(wf_set(1), wf_sub(z2, r2));
        const wf rx = wf_sqrt(wf_max(wf_fma(c[0], c[0], wf_sub(z2, r2)), wf_set(0)));
        const wf ry = wf_sqrt(wf_max(wf_fma(c[1], c[1], wf_sub(z2, r2)), wf_set(0)));
        const wf zi = wf_mul(c[2], inverse), ri = wf_mul(r, inverse);
        o.x = wf_fma(wf_mul(c[0], zi), wf_set(view->fx_px), wf_set(view->cx_px));
        o.y = wf_fma(wf_mul(c[1], zi), wf_set(view->fy_px), wf_set(view->cy_px));
        o.half_x = wf_mul(wf_mul(rx, ri), wf_set(view->fx_px));
        o.half_y = wf_mul(wf_mul(ry, ri), wf_set(view->fy_px));
        if (view->affine) {
            // Affine ellipses may leave the sphere's outline: |J t| <= (1 + |slope|) |t| / z around a
            // centre in it.
            const wf reach = wf_div(r, wf_sub(c[2], r));
            const wf reach_x = affine_reach(o.x, o.half_x, reach, view->fx_px, view->cx_px);
            const wf reach_y = affine_reach(o.y, o.half_y, reach, view->fy_px, view->cy_px);
            o.half_x = wf_add(o.half_x, view->circular ? wf_add(reach_x, reach_y) : reach_x);
            o.half_y = wf_add(o.half_y, view->circular ? wf_add(reach_x, reach_y) : reach_y);
        }
    }
    const wf margin_px = wf_set(view->reach_px + 1);
    o.half_x = wf_add(o.half_x, margin_px), o.half_y = wf_add(o.half_y, margin_px);
    return o;
}

/// Which packets lie within the view volume's sides. The planes bound exact outlines, not affine ellipses.
static ALWAYS_INLINE wm within_sides(const ewa_view *view, const packet_outline *o) {
    wm within = o->before_eye;
    if (view->orthographic || view->affine) return within;
    for (int k = 0; k < 4; k++) {
        const float *n = view->side_planes[k];
        const wf d = wf_fma(wf_set(n[0]), o->center[0],
                            wf_fma(wf_set(n[1]), o->center[1], wf_mul(wf_set(n[2]), o->center[2])));
        within = wm_and(within, wf_lt(wf_negate(o->radius), d));
    }
    return within;
}

/// Which packets' surfels all face away.
static ALWAYS_INLINE wm back_facing(const ewa_view *view, const ewa_packet_bounds *bounds, uint32_t first,
                                    const packet_outline *o) {
    const wf *c = o->center;
    wf axis[3];
    rotate(view->rotation, wf_load(bounds->axis_x + first), wf_load(bounds->axis_y + first),
           wf_load(bounds->axis_z + first), axis);
    const wf sine = wf_load(bounds->cone_sine + first);
    if (view->orthographic) return wf_lt(sine, axis[2]);
    const wf along = wf_fma(axis[0], c[0], wf_fma(axis[1], c[1], wf_mul(axis[2], c[2])));
    const wf length = wf_sqrt(wf_fma(c[0], c[0], wf_fma(c[1], c[1], wf_mul(c[2], c[2]))));
    return wf_lt(wf_fma(length, sine, o->radius), along);
}

static uint32_t cull(const ewa_view *view, const ewa_packet_bounds *bounds, uint32_t first, uint32_t count,
                     ewa_tile_rect *rects) {
    const float tile_px = (float)view->tile_px;
    const float tiles_x = tile_count(view->width_px, view->tile_px),
                tiles_y = tile_count(view->height_px, view->tile_px);
    uint32_t culled = 0;
    for (uint32_t i = 0; i < count; i += 16) {
        const uint32_t p = first + i;
        const packet_outline o =
            packet_outlines(view, wf_load(bounds->center_x + p), wf_load(bounds->center_y + p),
                            wf_load(bounds->center_z + p), wf_load(bounds->radius + p));
        wm alive = within_sides(view, &o);
        if (view->cull_back) alive = wm_and(alive, wm_not(back_facing(view, bounds, p, &o)));
        wf x0, x1, y0, y1;
        tile_range(wf_sub(o.x, o.half_x), wf_add(o.x, o.half_x), tile_px, tiles_x, &x0, &x1);
        tile_range(wf_sub(o.y, o.half_y), wf_add(o.y, o.half_y), tile_px, tiles_y, &y0, &y1);
        x0 = wf_select(o.near, wf_set(0), x0), x1 = wf_select(o.near, wf_set(tiles_x), x1);
        y0 = wf_select(o.near, wf_set(0), y0), y1 = wf_select(o.near, wf_set(tiles_y), y1);
        alive = wm_and(alive, wm_and(wf_lt(x0, x1), wf_lt(y0, y1)));
        const uint32_t here = count - i < 16 ? count - i : 16;
        if (!wm_bits(alive)) {
            memset(rects + p, 0, here * sizeof *rects);
            culled += here;
            continue;
        }
        int32_t corners[4][16];
        wi_store(corners[0], wi_from_f(wf_keep(alive, x0)));
        wi_store(corners[1], wi_from_f(wf_keep(alive, y0)));
        wi_store(corners[2], wi_from_f(wf_keep(alive, x1)));
        wi_store(corners[3], wi_from_f(wf_keep(alive, y1)));
        for (uint32_t k = 0; k < here; k++) {
            rects[p + k] = (ewa_tile_rect){(uint16_t)corners[0][k], (uint16_t)corners[1][k],
                                           (uint16_t)corners[2][k], (uint16_t)corners[3][k]};
            culled += corners[0][k] == corners[2][k];
        }
    }
    return culled;
}

static void set_cells(const ewa_tile *tile, float *cells) {
    const uint32_t columns = tile->blocks_per_row, rows = tile->block_rows;
    for (uint32_t top = 0; top < rows; top += EWA_CELL_BLOCKS)
        for (uint32_t left = 0; left < columns; left += EWA_CELL_BLOCKS) {
            const uint32_t bottom = top + EWA_CELL_BLOCKS < rows ? top + EWA_CELL_BLOCKS : rows;
            const uint32_t right = left + EWA_CELL_BLOCKS < columns ? left + EWA_CELL_BLOCKS : columns;
            wf least = wf_set(__builtin_inff());
            for (uint32_t row = top; row < bottom; row++)
                for (uint32_t column = left; column < right; column++)
                    least = wf_min(
                        wf_load(tile->nearest + (size_t)(row * columns + column) * EWA_BLOCK_LANES), least);
            cells[top / EWA_CELL_BLOCKS * EWA_TILE_CELLS + left / EWA_CELL_BLOCKS] =
                -largest_lane(wf_negate(least));
        }
}

/// The smallest key of cells [left, right] x [top, bottom].
static ALWAYS_INLINE float least_key(const float *cells, int32_t left, int32_t top, int32_t right,
                                     int32_t bottom) {
    // Most packets touch no more than two cells along a side: their corners.
    const float *upper = cells + top * EWA_TILE_CELLS, *lower = cells + bottom * EWA_TILE_CELLS;
    const float a = upper[left] < upper[right] ? upper[left] : upper[right];
    const float b = lower[left] < lower[right] ? lower[left] : lower[right];
    float least = a < b ? a : b;
    if (right - left < 2 && bottom - top < 2) return least;
    for (int32_t row = top; row <= bottom; row++)
        for (int32_t column = left; column <= right; column++) {
            const float cell = cells[row * EWA_TILE_CELLS + column];
            least = cell < least ? cell : least;
        }
    return least;
}

static ALWAYS_INLINE void load_spheres(const ewa_packet_bounds *bounds, const uint32_t *ids, uint32_t count,
                                       wf sphere[4]) {
    const float *const from[4] = {bounds->center_x, bounds->center_y, bounds->center_z, bounds->radius};
    if (count == 16 && ids[15] - ids[0] == 15) { // neighbours in the order of the packets
        for (int i = 0; i < 4; i++) sphere[i] = wf_load(from[i] + ids[0]);
        return;
    }
    for (int i = 0; i < 4; i++) {
        float lanes[16];
        for (uint32_t k = 0; k < 16; k++) lanes[k] = from[i][ids[k < count ? k : 0]];
        sphere[i] = wf_load(lanes);
    }
}

static void depths(const ewa_view *view, const ewa_packet_bounds *bounds, const uint32_t *ids, uint32_t count,
                   float *depths_world) {
    for (uint32_t first = 0; first < count; first += 16) {
        wf sphere[4], center[3];
        load_spheres(bounds, ids + first, count - first < 16 ? count - first : 16, sphere);
        to_camera(view, sphere[0], sphere[1], sphere[2], center);
        wf_store(depths_world + first, wf_fnma(sphere[3], wf_set(view->scale), center[2]));
    }
}

static uint32_t hide(const ewa_view *view, const ewa_packet_bounds *bounds, const ewa_tile *tile,
                     const float *cells, const uint32_t *ids, uint32_t count, uint32_t *shown,
                     uint32_t *hidden) {
    const float last_column = (float)((tile->blocks_per_row - 1) / EWA_CELL_BLOCKS);
    const float last_row = (float)((tile->block_rows - 1) / EWA_CELL_BLOCKS);
    const wf per_px = wf_set(1.0f / (EWA_CELL_BLOCKS * EWA_BLOCK_PX));
    const wf left = wf_set((float)tile->x_px), top = wf_set((float)tile->y_px);
    uint32_t shown_count = 0, hidden_count = 0;
    for (uint32_t first = 0; first < count; first += 16) {
        const uint32_t here = count - first < 16 ? count - first : 16;
        wf sphere[4];
        load_spheres(bounds, ids + first, here, sphere);
        const packet_outline o = packet_outlines(view, sphere[0], sphere[1], sphere[2], sphere[3]);
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
                keys[k] < least_key(cells, corners[0][k], corners[1][k], corners[2][k], corners[3][k]);
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
