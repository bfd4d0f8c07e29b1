// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: from the voxels of a block to records in the buckets of a tile
// (docs/math.md sections 3 and 12).
//
// Voxels wait in a queue, so that those beside the tile and those behind saturated pixels are not shaded, and
// so that light is found for several sixteens at a time, for the steps for one wait for each other.
#ifndef EWA_SRC_VOLUME_KERNELS_APPEND_H
#define EWA_SRC_VOLUME_KERNELS_APPEND_H

#include "volume/kernels_shade.h"

#include <string.h>

/// How far from its centre the ellipse of a splat may reach, px: a cone around the largest axis' sphere.
static ALWAYS_INLINE wf splat_reach(const ewa_volume_view *view, const voxel_lanes *v) {
    const float focal_px = view->fx_px > view->fy_px ? view->fx_px : view->fy_px;
    const wf margin = wf_set(view->cutoff * __builtin_sqrtf(view->prefilter2_px2) + 1), one = wf_set(1);
    if (view->orthographic) return wf_add(wf_set(focal_px * view->reach), margin);
    const wf length2 = wf_mul(v->length, v->length);
    const wf sine = wf_div(wf_mul(wf_set(view->reach), v->inverse), v->length);
    const wf cosine = wf_sqrt(wf_max(wf_fnma(sine, sine, one), wf_set(0)));
    const wf slope = wf_sqrt(wf_max(wf_sub(length2, one), wf_set(0)));
    const wf room = wf_fnma(slope, sine, cosine);
    const wf reach = wf_div(wf_mul(sine, length2), wf_max(room, wf_set(1e-6f)));
    return wf_fma(wf_min(reach, wf_set(1e6f)), wf_set(focal_px), margin);
}

/// The windows of points (ewa_volume_pages), and which of them touch the tile.
static ALWAYS_INLINE wi point_windows(const ewa_volume_tile *tile, wf x, wf y, wm *touches) {
    const wf half = wf_set(0.5f), limit = wf_set(1e6f);
    const wf u = wf_max(wf_min(wf_sub(x, half), limit), wf_set(-1e6f));
    const wf v = wf_max(wf_min(wf_sub(y, half), limit), wf_set(-1e6f));
    const wf whole_u = wf_floor(u), whole_v = wf_floor(v), phases = wf_set(EWA_FILTER_PHASES);
    // The rest of what is just below a whole number is rounded to 1.
    const wf last = wf_set(EWA_FILTER_PHASES - 1);
    const wi phase_u = wi_from_f(wf_min(wf_mul(wf_sub(u, whole_u), phases), last));
    const wi phase_v = wi_from_f(wf_min(wf_mul(wf_sub(v, whole_v), phases), last));
    // The window begins one pixel before; the margin is four wide.
    const wf left = wf_sub(whole_u, wf_set(1)), top = wf_sub(whole_v, wf_set(1));
    *touches = wm_and(wm_and(wf_le(wf_set(-3), left), wf_lt(left, wf_set((float)tile->width_px))),
                      wm_and(wf_le(wf_set(-3), top), wf_lt(top, wf_set((float)tile->height_px))));
    const wi column = wi_add(wi_from_f(left), wi_set(EWA_SUMS_MARGIN_PX));
    const wi row = wi_add(wi_from_f(top), wi_set(EWA_SUMS_MARGIN_PX));
    const wi strip = wi_sar(column, 2), one = wi_set(1);
    // Rows of strips: strip * EWA_SUMS_SIDE_PX = strip * (64 + 8). Taps: phase * 12 + 4, from up to 3 before.
    const wi begin = wi_add(wi_add(wi_shl(strip, 6), wi_shl(strip, 3)), row);
    const wi middle_u = wi_add(wi_shl(phase_u, 3), wi_shl(wi_add(phase_u, one), 2));
    const wi across = wi_sub(middle_u, wi_and(column, wi_set(3)));
    const wi down = wi_add(wi_shl(phase_v, 3), wi_shl(wi_add(phase_v, one), 2));
    return wi_or(across, wi_or(wi_shl(down, 9), wi_shl(begin, 18)));
}

/// Takes a page for a bucket whose last one is full.
static ALWAYS_INLINE void take_page(ewa_volume_pages *pages, ewa_volume_bucket *bucket) {
    const uint32_t page = pages->free[--pages->free_count];
    if (bucket->page_count++ == 0)
        bucket->first_page = page;
    else
        pages->next[(bucket->next - 1) / EWA_PAGE_RECORDS] = page;
    bucket->next = page * EWA_PAGE_RECORDS;
}

/// Adds the first `count` voxels of the queue to their buckets.
static ALWAYS_INLINE void hand_over(ewa_volume_tile *tile, const float colors[][4], const float places[][4],
                                    int32_t point_slice, uint32_t count, bool has_splats) {
    const ewa_volume_queue *queue = tile->queue;
    ewa_volume_bucket *ring = tile->ring;
    const ewa_volume_pages pages = tile->pages;
    const uint32_t ring_mask = tile->ring_mask;
    for (uint32_t lane = 0; lane < count; lane++) {
        int32_t slice;
        memcpy(&slice, &queue->fields[QUEUE_SLICE][lane], sizeof slice);
        ewa_volume_bucket *bucket = &ring[(uint32_t)slice & ring_mask];
        if (bucket->next % EWA_PAGE_RECORDS == 0) take_page(&tile->pages, bucket);
        const uint32_t number = bucket->next++;
        memcpy(pages.colors[number], colors[lane], 16);
        if (has_splats && slice < point_slice)
            memcpy(&pages.splats[number], places[lane], 16);
        else
            memcpy(&pages.windows[number], &queue->fields[QUEUE_WINDOW][lane], 4);
    }
}

/// Shades sixteens of the queue, and adds its first `count` voxels to their buckets.
static ALWAYS_INLINE void empty_queue(const ewa_volume_view *view, ewa_volume_tile *tile, uint32_t count) {
    enum { SIXTEENS = EWA_QUEUE_VOXELS / 16 };
    float(*fields)[EWA_QUEUE_ROOM] = tile->queue->fields;
    float colors[EWA_QUEUE_VOXELS][4], places[EWA_QUEUE_VOXELS][4];
    lit_lanes v[SIXTEENS];
    for (int n = 0; n < SIXTEENS; n++) {
        v[n].normal = wi_of_bits(wf_load(fields[QUEUE_NORMAL] + 16 * n));
        v[n].x = wf_load(fields[QUEUE_SLOPE] + 16 * n), v[n].y = wf_load(fields[QUEUE_SLOPE + 1] + 16 * n);
        v[n].ahead = wf_set(1), v[n].length = wf_load(fields[QUEUE_LENGTH] + 16 * n);
        for (int c = 0; c < 3; c++) v[n].color[c] = wf_load(fields[QUEUE_COLOR + c] + 16 * n);
    }
    for (int n = 0; view->lit && n < SIXTEENS; n += WIDE_TOGETHER) shade_each(view, v + n, WIDE_TOGETHER);
    for (int n = 0; n < SIXTEENS; n++) {
        const wf factor = wf_load(fields[QUEUE_FACTOR] + 16 * n);
        w_store4(colors[16 * n], wf_mul(v[n].color[0], factor), wf_mul(v[n].color[1], factor),
                 wf_mul(v[n].color[2], factor), wf_load(fields[QUEUE_LAST] + 16 * n));
    }
    if (!tile->pages.splats) {
        hand_over(tile, colors, places, 0, count, false);
        return;
    }
    for (int n = 0; n < SIXTEENS; n++)
        w_store4(places[16 * n], wf_load(fields[QUEUE_PLACE] + 16 * n),
                 wf_load(fields[QUEUE_PLACE + 1] + 16 * n), wf_load(fields[QUEUE_PLACE + 2] + 16 * n),
                 wf_load(fields[QUEUE_PLACE + 3] + 16 * n));
    hand_over(tile, colors, places, view->point_slice, count, true);
}

static void flush(const ewa_volume_view *view, ewa_volume_tile *tile) {
    if (tile->queue->count) empty_queue(view, tile, tile->queue->count);
    tile->queue->count = 0;
}

/// Shades a full queue; what is more than full comes first next time.
static void empty_full_queue(const ewa_volume_view *view, ewa_volume_tile *tile) {
    ewa_volume_queue *queue = tile->queue;
    empty_queue(view, tile, EWA_QUEUE_VOXELS);
    queue->count -= EWA_QUEUE_VOXELS;
    if (queue->count == 0) return;
    for (int field = 0; field < QUEUE_FIELDS; field++)
        wf_store(queue->fields[field], wf_load(queue->fields[field] + EWA_QUEUE_VOXELS));
}

/// Whether all four cells that a window may touch, from the upper left one on, are hidden.
static ALWAYS_INLINE bool is_window_hidden(const uint8_t *hidden) {
    uint16_t left, right;
    memcpy(&left, hidden, sizeof left);
    memcpy(&right, hidden + EWA_SUMS_ROW_BLOCKS, sizeof right);
    return (left & right) == 0x0101;
}

/// The row or column of cells that holds a place in the tile, or the nearest one.
static ALWAYS_INLINE uint32_t cell_at(float px) {
    return px > 0 ? (uint32_t)(px < EWA_VOLUME_TILE_PX - 1 ? px : EWA_VOLUME_TILE_PX - 1) / 4 : 0;
}

/// Whether all cells that a splat may touch are hidden.
static inline bool is_splat_hidden(const uint8_t *hidden, float x_px, float y_px, float reach_px) {
    const uint32_t top = cell_at(y_px - reach_px), bottom = cell_at(y_px + reach_px);
    const uint32_t right = cell_at(x_px + reach_px);
    for (uint32_t column = cell_at(x_px - reach_px); column <= right; column++)
        if (memchr(&hidden[ewa_sums_cell(top, column)], 0, bottom - top + 1)) return false;
    return true;
}

/// Which of those voxels whose bits are set would show.
static uint32_t find_open(const ewa_volume_tile *tile, uint32_t bits, wi window, uint32_t splats, wf x, wf y,
                          wf reach) {
    int32_t windows[16];
    float xs[16], ys[16], reaches[16];
    wi_store(windows, window);
    wf_store(xs, x), wf_store(ys, y), wf_store(reaches, reach);
    uint32_t open = bits;
    for (uint32_t rest = bits; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const bool hidden = splats >> lane & 1
                                ? is_splat_hidden(tile->hidden, xs[lane], ys[lane], reaches[lane])
                                : is_window_hidden(tile->hidden + ((uint32_t)windows[lane] >> 20));
        open &= ~((uint32_t)hidden << lane);
    }
    return open;
}

/// Adds the lanes of the queue's fields whose bits are set.
static ALWAYS_INLINE void queue_lanes(ewa_volume_queue *queue, const wf *values, uint32_t bits,
                                      int field_count) {
    if (bits == 0xffff) {
        for (int field = 0; field < field_count; field++)
            wf_store(queue->fields[field] + queue->count, values[field]);
    } else {
        const wi numbers = wi_load((const int32_t[16]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
        int32_t order[16] = {0};
        wi_pack(order, wm_of_bits(bits), numbers);
        for (int field = 0; field < field_count; field++) {
            float lanes[16];
            wf_store(lanes, values[field]);
            wf_store(queue->fields[field] + queue->count, wf_lookup(lanes, wi_load(order)));
        }
    }
}

/// Voxels of which some are drawn.
typedef struct found_voxels {
    wf x_px, y_px; ///< in the tile
    wf factor, last;
    wi slice, window;
    uint32_t bits, splats; ///< lanes that are drawn; those that are splats
} found_voxels;

/// Puts those that are drawn of 16 voxels into the queue.
static void queue_found(const ewa_volume_view *view, const ewa_volume_source *source, uint32_t first, const voxel_lanes *v,
                        const found_voxels *found, bool has_splats, ewa_volume_queue *queue) {
    wf values[QUEUE_FIELDS] = {[QUEUE_SLICE] = wf_of_bits(found->slice),
                               [QUEUE_WINDOW] = wf_of_bits(found->window),
                               [QUEUE_NORMAL] = wf_of_bits(wi_load(source->normals + first)),
                               [QUEUE_FACTOR] = found->factor,
                               [QUEUE_LAST] = found->last,
                               [QUEUE_SLOPE] = v->x,
                               [QUEUE_SLOPE + 1] = v->y,
                               [QUEUE_LENGTH] = v->length};
    load_colors(view, source, first, values + QUEUE_COLOR);
    if (has_splats) {
        if (view->mark_splats) mark_colors(view, wm_of_bits(found->splats), values + QUEUE_COLOR);
        values[QUEUE_PLACE] = found->x_px, values[QUEUE_PLACE + 1] = found->y_px, values[QUEUE_PLACE + 2] = v->z;
        values[QUEUE_PLACE + 3] =
            view->orthographic ? wf_fma(wf_fma(v->x, v->x, wf_mul(v->y, v->y)), wf_set(view->bend), v->z)
                               : wf_mul(v->z, v->length);
        queue_lanes(queue, values, found->bits, QUEUE_FIELDS);
    } else {
        queue_lanes(queue, values, found->bits, QUEUE_PLACE);
    }
    queue->count += (uint32_t)__builtin_popcount(found->bits);
}

static uint32_t append(const ewa_volume_view *frame_view, const ewa_volume_source *block,
                       ewa_volume_tile *tile) {
    // Records that are written cannot change these.
    const ewa_volume_view view_here = *frame_view, *view = &view_here;
    const ewa_volume_source source_here = *block, *source = &source_here;
    ewa_volume_queue *queue = tile->queue;
    const wf tile_x = wf_set(view->cx_px - (float)tile->x_px),
             tile_y = wf_set(view->cy_px - (float)tile->y_px);
    const wf width = wf_set((float)tile->width_px), height = wf_set((float)tile->height_px), zero = wf_set(0);
    const bool has_splats = source->slice_first < view->point_slice;
    uint32_t hidden = 0;
    for (uint32_t first = 0; first < source->count; first += 16) {
        const uint32_t left = source->count - first;
        const voxel_lanes v = place_voxels(view, source, first);
        const wf x = wf_fma(v.x, wf_set(view->fx_px), tile_x), y = wf_fma(v.y, wf_set(view->fy_px), tile_y);
        const wi slice = wi_max(wi_min(wi_from_f(wf_max(wf_min(v.unit, wf_set(1e9f)), wf_set(-1e9f))),
                                       wi_set(source->slice_last)),
                                wi_set(source->slice_first));
        wm touches;
        const wi window = point_windows(tile, x, y, &touches);
        const wf density = wf_mul(wf_load(source->extinctions + first), wf_set(view->density));
        // Mass on the screen: Jacobian of the projection, |p| / z^3.
        wf mass = wf_mul(density, wf_set(view->point_mass));
        if (!view->orthographic) mass = wf_mul(mass, wf_mul(v.length, wf_mul(v.inverse, v.inverse)));
        mass = wf_min(mass, wf_set(1e12f));
        wf factor = mass, last = mass, reach = zero;
        uint32_t splats = 0;
        if (has_splats) {
            const wm points = wf_le(wf_set((float)view->point_slice), wf_from_i(slice));
            reach = splat_reach(view, &v);
            const wm near_x = wm_and(wf_lt(wf_sub(zero, reach), x), wf_lt(wf_sub(x, reach), width));
            const wm near_y = wm_and(wf_lt(wf_sub(zero, reach), y), wf_lt(wf_sub(y, reach), height));
            touches = wm_or(wm_and(points, touches), wm_and(wm_not(points), wm_and(near_x, near_y)));
            factor = wf_select(points, mass, wf_set(1));
            last = wf_select(points, mass, wf_min(density, wf_set(1e18f)));
            splats = wm_bits(wm_not(points));
        }
        touches = wm_and(touches, wf_lt(zero, last));
        if (view->has_near) touches = wm_and(touches, wf_le(zero, v.unit));
        uint32_t bits = wm_bits(touches) & (left < 16 ? (1u << left) - 1 : 0xffff);
        if (source->some_hidden && bits) {
            const uint32_t open = find_open(tile, bits, window, splats, x, y, reach);
            hidden += (uint32_t)__builtin_popcount(bits & ~open);
            bits = open;
        }
        if (!bits) continue;
        const found_voxels found = {x, y, factor, last, slice, window, bits, splats};
        queue_found(view, source, first, &v, &found, has_splats, queue);
        if (queue->count >= EWA_QUEUE_VOXELS) empty_full_queue(view, tile);
    }
    return hidden;
}

#endif
