// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of gaussian_body.h: a tile's splats onto its pixels (docs/math.md section 12).
//
// By centres a block of 4x4 pixels takes its splats as they come, and composites each at once. By rays they come by
// the smallest depth that any pixel of the picture sees them at, and wait until no splat to come can be in front of
// them (gaussian_order.h).
#ifndef EWA_SRC_VOLUME_GAUSSIAN_DRAW_H
#define EWA_SRC_VOLUME_GAUSSIAN_DRAW_H

#include "volume/gaussian_order.h"
#include "volume/gaussian_view.h"
#include "volume/kernels_planes.h"

/// Numbers of sixteen splats, some of their records' from `first` on.
static ALWAYS_INLINE void load_numbers(const ewa_gaussian_tile *tile, uint32_t first, const int *fields,
                                       int count, wf numbers[]) {
    float lanes[8][16];
    for (uint32_t lane = 0; lane < 16; lane++) {
        const uint32_t at = first + lane < tile->count ? first + lane : first;
        const float *record = tile->records[tile->ids[at]];
        for (int i = 0; i < count; i++) lanes[i][lane] = record[fields[i]];
    }
    for (int i = 0; i < count; i++) numbers[i] = wf_load(lanes[i]);
}

/// Of the rows of pixels' centres from `top` to `bottom`: how far the ellipse reaches to the right of its
/// centre; to the left for a mirrored one. `root` is 1 / AX, `lean` -AY / AX.
static ALWAYS_INLINE wf side_of(wf top, wf bottom, wf touch, wf lean, wf by, wf limit, wf root) {
    const wf v = wf_min(wf_max(touch, top), bottom), down = wf_mul(by, v);
    return wf_fma(lean, v, wf_mul(root, wf_sqrt(wf_max(wf_fnma(down, down, limit), wf_set(0)))));
}

static void mark(ewa_gaussian_tile *tile) {
    static const int fields[8] = {RECORD_X,  RECORD_Y,     RECORD_AX,    RECORD_AY,
                                  RECORD_BY, RECORD_LIMIT, RECORD_REACH, RECORD_TOUCH};
    const wf zero = wf_set(0), quarter = wf_set(0.25f), beyond = wf_set(EWA_GAUSSIAN_ROW_BLOCKS);
    for (uint32_t first = 0; first < tile->count; first += 16) {
        wf s[8];
        load_numbers(tile, first, fields, 8, s);
        const wf root = wf_div(wf_set(1), s[2]), lean = wf_mul(wf_sub(zero, s[3]), root);
        const wf x = wf_sub(s[0], wf_set((float)tile->x_px)), touch = s[7];
        for (uint32_t row = 0; row < EWA_GAUSSIAN_ROW_BLOCKS; row++) {
            const wf top = wf_sub(wf_set((float)(tile->y_px + 4 * row) + 0.5f), s[1]);
            const wf bottom = wf_add(top, wf_set(3));
            const wm meets = wm_and(wf_le(top, s[6]), wf_le(wf_sub(zero, s[6]), bottom));
            const wf v_low = wf_max(top, wf_sub(zero, s[6])), v_high = wf_min(bottom, s[6]);
            const wf right = wf_add(x, side_of(v_low, v_high, touch, lean, s[4], s[5], root));
            const wf left =
                wf_sub(x, side_of(wf_sub(zero, v_high), wf_sub(zero, v_low), touch, lean, s[4], s[5], root));
            // Blocks whose pixels' centres may lie between; 0.01 px for rounding.
            const wf begin = wf_floor(wf_mul(wf_sub(left, wf_set(3.51f)), quarter));
            const wf end = wf_floor(wf_mul(wf_add(right, wf_set(3.51f)), quarter));
            const wf low = wf_min(wf_max(wf_add(begin, wf_set(1)), zero), beyond);
            const wf high = wf_min(wf_max(end, low), beyond);
            // Bits from low to high - 1, as powers of two.
            const wf bits = wf_sub(wf_of_bits(wi_shl(wi_add(wi_from_f(high), wi_set(127)), 23)),
                                   wf_of_bits(wi_shl(wi_add(wi_from_f(low), wi_set(127)), 23)));
            wi_store_u8(tile->marks + row * tile->room + first, wi_from_f(wf_keep(meets, bits)));
        }
    }
}

/// How rays hit splats; constants of each of the loops over them.
typedef struct hit_mode {
    bool trained, orthographic;
    bool with_depth; ///< of hits; else theirs is 0
    bool with_flat;  ///< some may be trained 2D Gaussians
} hit_mode;

/// How rays pass a splat.
typedef struct closest_point {
    wf distance2; ///< from its centre, in standard deviations
    wf z;         ///< there
    wf variance;  ///< in depth, along the ray
    wm ahead;     ///< of the eye, within the limit
} closest_point;

/// Rays at (u, v) from a splat's middle. Where none is ahead the others say nothing, unless `all`.
static ALWAYS_INLINE closest_point closest_to_splat(const float *s, wf u, wf v, wf limit, bool orthographic, bool all) {
    wf g[3];
    for (int k = 0; k < 3; k++)
        g[k] = wf_fma(u, wf_set(s[RECORD_G + 3 * k]),
                      wf_fma(v, wf_set(s[RECORD_G + 3 * k + 1]), wf_set(s[RECORD_G + 3 * k + 2])));
    const wf length = wf_set(s[RECORD_LENGTH]), one = wf_set(1), lateral2 = wf_fma(g[0], g[0], wf_mul(g[1], g[1]));
    closest_point by = {.distance2 = lateral2, .z = g[2]};
    if (orthographic) {
        by.ahead = wf_lt(lateral2, limit);
        by.variance = wf_div(one, wf_mul(length, length));
    } else {
        const wf square = wf_fma(g[2], g[2], lateral2), far2 = wf_mul(wf_mul(length, length), lateral2);
        by.ahead = wm_and(wf_lt(far2, wf_mul(limit, square)), wf_lt(wf_set(0), g[2]));
        if (!all && !wm_bits(by.ahead)) return by;
        by.variance = wf_div(one, square);
        by.distance2 = wf_mul(far2, by.variance);
        by.z = wf_mul(wf_mul(length, g[2]), by.variance);
    }
    by.z = wf_min(wf_max(by.z, wf_set(s[RECORD_LOW])), wf_set(s[RECORD_HIGH]));
    return by;
}

/// A splat in the pixels of a block.
typedef struct splat_hit {
    wf z, alpha;
    wf deviation; ///< in depth, along the rays
} splat_hit;

/// Alpha of a splat that pixels see at the distance `m2`: of what stands along a ray the share in front of the surface
/// counts. Returns which of those within show it.
static ALWAYS_INLINE uint32_t shade_hit(const ewa_gaussian_view *view, const float *s, wm inside, wf m2,
                                        const closest_point *by, hit_mode mode, const block_state *block,
                                        splat_hit *hit) {
    wf alpha = wf_exp2(wf_fma(m2, wf_set(-0.721347520f), wf_set(s[RECORD_LOG2_ALPHA])));
    if (view->keep) inside = wm_and(inside, wf_le(wf_set(view->minimum_alpha), alpha));
    alpha = wf_min(alpha, wf_set((float)EWA_GAUSSIAN_MAX_ALPHA));
    hit->deviation = wf_max(wf_sqrt(by->variance), wf_set(1e-30f));
    if (mode.with_depth && (view->with_surface || view->with_sections)) {
        wf share = share_ahead(wf_load(block->surface), by->z, hit->deviation);
        if (view->with_sections)
            share = wf_max(wf_sub(share, share_ahead(wf_load(block->enter), by->z, hit->deviation)), wf_set(0));
        alpha = wf_mul(alpha, share);
    }
    hit->alpha = alpha;
    hit->z = wf_add(by->z, wf_set(0)); // of both zeros the one above
    return wm_bits(inside);
}

/// A trained 2D Gaussian: where rays cross it no nearer than the near plane, or its dot, whichever is more.
static ALWAYS_INLINE uint32_t hit_flat(const ewa_gaussian_view *view, const float *s, wf u, wf v, hit_mode mode,
                                       const block_state *block, splat_hit *hit) {
    const wf limit = wf_set(s[RECORD_LIMIT]), infinite = wf_set(__builtin_inff());
    closest_point by = closest_to_splat(s, u, v, limit, mode.orthographic, true);
    const wf x = wf_sub(u, wf_set(s[RECORD_DOT_X])), y = wf_sub(v, wf_set(s[RECORD_DOT_Y]));
    const wf dot2 = wf_mul(wf_set(s[RECORD_DOT]), wf_fma(x, x, wf_mul(y, y)));
    const wf crossed2 = wf_select(wm_and(by.ahead, wf_le(wf_set(view->near), by.z)), by.distance2, infinite);
    const wm crossed = wf_le(crossed2, dot2);
    const wf m2 = wf_min(crossed2, dot2);
    const wm inside = wf_lt(m2, limit);
    if (!wm_bits(inside)) return 0;
    by.z = wf_select(crossed, by.z, wf_set(s[RECORD_DOT_Z]));
    by.z = wf_min(wf_max(by.z, wf_set(s[RECORD_LOW])), wf_set(s[RECORD_HIGH]));
    return shade_hit(view, s, inside, m2, &by, mode, block, hit);
}

/// A splat in the pixels of a block whose centres are (x, y): which of them show it.
static ALWAYS_INLINE uint32_t hit_splat(const ewa_gaussian_view *view, const float *s, wf x, wf y, hit_mode mode,
                                        const block_state *block, splat_hit *hit) {
    const wf u = wf_sub(x, wf_set(s[RECORD_X])), v = wf_sub(y, wf_set(s[RECORD_Y]));
    const wf limit = wf_set(s[RECORD_LIMIT]), zero = wf_set(0);
    if (mode.with_flat && s[RECORD_DOT] > 0) return hit_flat(view, s, u, v, mode, block, hit);
    closest_point by = {.distance2 = zero, .z = zero, .variance = zero};
    if (!mode.trained) {
        by = closest_to_splat(s, u, v, limit, mode.orthographic, false);
        if (!wm_bits(by.ahead)) return 0;
        return shade_hit(view, s, by.ahead, by.distance2, &by, mode, block, hit);
    }
    const wf across = wf_fma(u, wf_set(s[RECORD_AX]), wf_mul(v, wf_set(s[RECORD_AY])));
    const wf down = wf_mul(v, wf_set(s[RECORD_BY])), m2 = wf_fma(across, across, wf_mul(down, down));
    const wm inside = wf_lt(m2, limit);
    if (!wm_bits(inside)) return 0;
    if (mode.with_depth) by = closest_to_splat(s, u, v, limit, mode.orthographic, true);
    return shade_hit(view, s, inside, m2, &by, mode, block, hit);
}

/// The layers of volumes in a block: what of each comes next, and the nearest of these.
typedef struct layer_feed {
    uint32_t next[EWA_MAX_MIXED_VOLUMES];
    uint32_t nearest;
    float z; ///< +infinity: none is left
} layer_feed;

static ALWAYS_INLINE const ewa_volume_layers *layers_of(const ewa_gaussian_tile *tile, uint32_t volume,
                                                        bool everything) {
    return everything ? tile->volumes[volume].all : tile->volumes[volume].ahead;
}

static void find_nearest_layer(const ewa_gaussian_tile *tile, bool everything, layer_feed *feed) {
    feed->z = __builtin_inff();
    for (uint32_t v = 0; v < tile->volume_count; v++) {
        if (feed->next[v] == EWA_NO_LAYER) continue;
        const ewa_volume_layer *layer = &layers_of(tile, v, everything)->layers[feed->next[v]];
        const float z =
            (float)((double)layer->z * tile->volumes[v].unit) + 0.0f; // of both zeros the one above
        if (z < feed->z) feed->z = z, feed->nearest = v;
    }
}

static void start_feed(const ewa_gaussian_tile *tile, uint32_t row, uint32_t column, bool everything,
                       layer_feed *feed) {
    const uint32_t block = (tile->first_row + row) * EWA_VOLUME_ROW_BLOCKS + tile->first_column + column;
    for (uint32_t v = 0; v < tile->volume_count; v++)
        feed->next[v] = layers_of(tile, v, everything)->first[block];
    find_nearest_layer(tile, everything, feed);
}

/// Adds the layers up to a depth to what waits. False: nothing more would show.
static bool add_layers(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, bool everything, float bound,
                       layer_feed *feed, block_state *block) {
    while (feed->z <= bound) {
        if (block->come >= block->at_once) {
            advance(view, tile, feed->z, block);
            if (!block->alive) return false;
        }
        const ewa_volume_layer *layer =
            &layers_of(tile, feed->nearest, everything)->layers[feed->next[feed->nearest]];
        ewa_gaussian_hit *hit = next_hit(tile, block);
        const wf alpha = wf_load(layer->alpha);
        hit->active = block->alive & wm_bits(wf_lt(wf_set(0), alpha));
        if (hit->active) {
            wf_store(hit->z, wf_set(feed->z));
            wf_store(hit->alpha, alpha);
            wf_store(hit->deviation, wf_set(-BEYOND)); // which meets no other
            hit->layer = layer;
            keep_hit(tile, block);
        }
        feed->next[feed->nearest] = layer->next;
        find_nearest_layer(tile, everything, feed);
    }
    return true;
}

/// By rays.
static ALWAYS_INLINE void draw_by_rays(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, uint32_t count, wf x,
                                       wf y, hit_mode mode, bool everything, layer_feed *feed, block_state *block) {
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t id = tile->block_ids[i];
        const float *record = tile->records[id];
        const float bound = record[RECORD_ORDER];
        if (feed->z <= bound && !add_layers(view, tile, everything, bound, feed, block)) return;
        if (block->come >= block->at_once) {
            advance(view, tile, bound, block);
            if (!block->alive) return;
        }
        ewa_gaussian_hit *hit = next_hit(tile, block);
        tile->block_count++;
        splat_hit found;
        hit->active = block->alive & hit_splat(view, record, x, y, mode, block, &found);
        if (!hit->active) continue;
        wf_store(hit->z, found.z);
        wf_store(hit->alpha, found.alpha);
        wf_store(hit->deviation, found.deviation);
        hit->id = id;
        hit->layer = NULL;
        keep_hit(tile, block);
    }
    if (!add_layers(view, tile, everything, __FLT_MAX__, feed, block)) return;
    advance(view, tile, __builtin_inff(), block);
    if (block->alive && tile->volume_count)
        end_rows(view, true, block);
    else if (block->alive)
        end_rows(view, false, block);
}

/// The pixels of a block while splats are composited as they come.
typedef struct block_light {
    wf light[3], linear[4], through, depth;
    wm alive;
} block_light;

/// Takes from the light what a splat or a layer does; returns how much of it shows.
static ALWAYS_INLINE wf take_light(const ewa_gaussian_view *view, wm shows, wf alpha, wf z, wf half, block_light *of) {
    const wf weight = wf_keep(wm_and(of->alive, shows), wf_mul(of->through, alpha)), rest = wf_sub(of->through, weight);
    if (view->with_depth)
        of->depth = view->expected ? wf_fma(weight, z, of->depth) : note_depth(of->depth, half, of->through, rest, z);
    of->through = rest;
    of->alive = wm_and(of->alive, wf_le(wf_set(view->minimum_transmittance), rest));
    return weight;
}

/// Composites the layers up to a depth.
static void composite_layers(const ewa_gaussian_view *view, const ewa_gaussian_tile *tile, bool everything,
                             float bound, wf half, layer_feed *feed, block_light *of) {
    while (feed->z <= bound && wm_bits(of->alive)) {
        const ewa_volume_layer *layer =
            &layers_of(tile, feed->nearest, everything)->layers[feed->next[feed->nearest]];
        const wf alpha = wf_load(layer->alpha);
        const wf weight = take_light(view, wf_lt(wf_set(0), alpha), alpha, wf_set(feed->z), half, of);
        for (int c = 0; c < 3; c++) of->linear[c] = wf_fma(weight, wf_load(layer->color[c]), of->linear[c]);
        of->linear[3] = wf_add(of->linear[3], weight);
        feed->next[feed->nearest] = layer->next;
        find_nearest_layer(tile, everything, feed);
    }
}

/// By centres.
static ALWAYS_INLINE void draw_by_centers(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, uint32_t count, wf x,
                                          wf y, hit_mode mode, bool everything, layer_feed *feed,
                                          block_state *block) {
    const wf zero = wf_set(0), half = wf_load(block->half);
    block_light of = {.light = {zero, zero, zero},
                      .linear = {zero, zero, zero, zero},
                      .through = wf_load(block->pixels + 48),
                      .depth = wf_load(block->pixels + 64),
                      .alive = wm_of_bits(block->alive)};
    uint32_t i = 0;
    for (; i < count && wm_bits(of.alive); i++) {
        const float *record = tile->records[tile->block_ids[i]];
        if (feed->z <= record[RECORD_ORDER])
            composite_layers(view, tile, everything, record[RECORD_ORDER], half, feed, &of);
        splat_hit hit;
        const uint32_t shows = hit_splat(view, record, x, y, mode, block, &hit);
        if (!shows) continue;
        const wf weight = take_light(view, wm_of_bits(shows), hit.alpha, hit.z, half, &of);
        for (int c = 0; c < 3; c++) of.light[c] = wf_fma(weight, wf_set(record[RECORD_COLOR + c]), of.light[c]);
    }
    tile->block_count += i;
    composite_layers(view, tile, everything, __FLT_MAX__, half, feed, &of);
    for (int c = 0; c < 3; c++) wf_store(block->pixels + 16 * c, of.light[c]);
    for (int c = 0; c < 4; c++) wf_store(block->linear + 16 * c, of.linear[c]);
    wf_store(block->pixels + 48, of.through);
    wf_store(block->pixels + 64, of.depth);
}

/// In the frame's order; `trained` and `orthographic` are constants.
static ALWAYS_INLINE void draw_splats(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, uint32_t count,
                                      const block_place *at, bool trained, bool orthographic, bool everything,
                                      layer_feed *feed, block_state *block) {
    const wf steps_x = wf_repeat4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f});
    const wf steps_y = wf_spread4((const float[4]){0.5f, 1.5f, 2.5f, 3.5f});
    const wf x = wf_add(wf_set((float)at->x), steps_x), y = wf_add(wf_set((float)at->y), steps_y);
    const hit_mode bare = {trained, orthographic, false, false}, deep = {trained, orthographic, true, false},
                   any = {trained, orthographic, true, true};
    if (!view->by_center && view->with_flat)
        draw_by_rays(view, tile, count, x, y, any, everything, feed, block);
    else if (!view->by_center)
        draw_by_rays(view, tile, count, x, y, deep, everything, feed, block);
    else if (view->with_flat)
        draw_by_centers(view, tile, count, x, y, any, everything, feed, block);
    else if (view->with_depth || view->with_surface || view->with_sections)
        draw_by_centers(view, tile, count, x, y, deep, everything, feed, block);
    else
        draw_by_centers(view, tile, count, x, y, bare, everything, feed, block);
}

/// Ids of a row of blocks to those of its column.
static uint32_t gather_block(ewa_gaussian_tile *tile, uint32_t count, uint32_t column) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        tile->block_ids[found] = tile->row_ids[i];
        found += tile->row_marks[i] >> column & 1;
    }
    return found;
}

static uint32_t gather_row(ewa_gaussian_tile *tile, uint32_t row) {
    const uint8_t *marks = tile->marks + row * tile->room;
    uint32_t found = 0;
    for (uint32_t i = 0; i < tile->count; i++) {
        tile->row_ids[found] = tile->ids[i];
        tile->row_marks[found] = marks[i];
        found += marks[i] != 0;
    }
    return found;
}

/// Where the rays of a block's pixels end, in units of the splats, at the surfaces unless everything counts or where
/// section planes leave nothing, and where these begin; +infinity outside of the picture.
static ALWAYS_INLINE void set_bounds(const ewa_gaussian_view *view, const ewa_gaussian_tile *tile,
                                     const ewa_volume_target *to, const block_place *at, bool everything,
                                     block_state *block) {
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t x = i % 4, y = i / 4;
        const bool inside = x < at->width && y < at->height;
        double end = __builtin_inf();
        if (inside && view->with_surface && !everything)
            end =
                (double)to->surface.depth[(size_t)(at->y + y) * to->width_px + at->x + x] / view->unit_camera;
        if (view->with_sections) {
            double enter, leave;
            ewa_ray_sections_range(tile->sections, at->x + x + 0.5, at->y + y + 0.5, &enter, &leave);
            block->enter[i] = (float)(enter / view->unit_camera);
            leave /= view->unit_camera;
            end = leave < end ? leave : end;
        }
        block->surface[i] = (float)end;
    }
}

/// Composites a block: what lies in front of the surfaces, or everything. `half`: what is left of the light where
/// depth is noted.
static void composite_block(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, uint32_t count,
                            uint32_t row, uint32_t column, const block_place *at, const ewa_volume_target *to,
                            bool everything, wf half, block_state *block) {
    layer_feed feed;
    start_feed(tile, row, column, everything, &feed);
    clear_block(block->pixels);
    if (view->expected) wf_store(block->pixels + 64, wf_set(0));
    wf_store(block->half, half);
    for (int c = 0; c < 4; c++) wf_store(block->linear + 16 * c, wf_set(0));
    block->alive = 0;
    block->waiting_count = block->free_count = block->made_count = block->come = 0;
    block->at_once = EWA_GAUSSIAN_AT_ONCE;
    if (!view->by_center) start_rows(block);
    for (uint32_t y = 0; y < at->height; y++) block->alive |= ((1u << at->width) - 1) << 4 * y;
    set_bounds(view, tile, to, at, everything, block);
    if (view->orthographic)
        draw_splats(view, tile, count, at, true, true, everything, &feed, block);
    else if (view->trained)
        draw_splats(view, tile, count, at, true, false, everything, &feed, block);
    else
        draw_splats(view, tile, count, at, false, false, everything, &feed, block);
}

/// A block over what is behind it, linear and premultiplied: voxels are mixed with that, then the Gaussians with the
/// display values of the mean. Where nothing is drawn, what is behind stays as it is.
static ALWAYS_INLINE void lay_block_over(const ewa_gaussian_view *view, const ewa_gaussian_tile *tile,
                                         const block_state *block, const wf behind[4], wf out[4]) {
    const wf through = wf_load(block->pixels + 48), one = wf_set(1), layers = wf_load(block->linear + 48);
    if (view->normals) {
        for (int c = 0; c < 3; c++)
            out[c] = wf_fma(through, behind[c], wf_fma(wf_set(0.5f), layers, wf_load(block->pixels + 16 * c)));
        out[3] = wf_fma(through, behind[3], wf_sub(one, through));
        return;
    }
    if (!tile->volume_count) {
        lay_over(block->pixels, behind, wm_bits(wf_lt(through, one)) != 0, out);
        return;
    }
    wf under[4];
    for (int c = 0; c < 4; c++) under[c] = wf_fma(through, behind[c], wf_load(block->linear + 16 * c));
    const wf own = wf_max(wf_sub(wf_sub(one, through), layers), wf_set(0));
    const wm some = wf_lt(wf_set(1e-7f), own); // more than rounding
    for (int c = 0; c < 4; c++) out[c] = under[c];
    if (!wm_bits(some)) return;
    wf mixed[4] = {under[0], under[1], under[2], under[3]};
    premultiplied_to_display(mixed);
    for (int c = 0; c < 4; c++) mixed[c] = wf_add(mixed[c], c < 3 ? wf_load(block->pixels + 16 * c) : own);
    premultiplied_to_linear(mixed);
    for (int c = 0; c < 4; c++) out[c] = wf_select(some, mixed[c], under[c]);
}

/// The mean depth of all that shows in a block, in place of the depth where half of the light is gone: where something takes
/// `opacity` of it.
static ALWAYS_INLINE void store_expected(const ewa_volume_target *to, const block_place *at, wf opacity, wf depth,
                                         double unit_camera) {
    float alphas[16], depths[16];
    wf_store(alphas, opacity), wf_store(depths, depth);
    for (uint32_t i = 0; i < 16 && to->depth; i++)
        if (i % 4 < at->width && i / 4 < at->height && alphas[i] > 0)
            to->depth[(size_t)(at->y + i / 4) * to->width_px + at->x + i % 4] = to_camera_depth(depths[i], unit_camera);
}

/// The mean depth over a pixel that a surface at `surface` (camera space) covers a part of: `sum` and `past` are those of depths
/// before the surface and over the rest, weighted by what shows; `opacity` and `past_opacity` the weights.
static ALWAYS_INLINE wf expect(const ewa_gaussian_view *view, wf cover, wf surface, wf opacity, wf sum, wf past_opacity,
                               wf past) {
    const wf zero = wf_set(0), one = wf_set(1), part = wf_min(cover, one), rest = wf_sub(one, part);
    const wm some = wm_and(wf_lt(zero, cover), wf_lt(surface, wf_set(__builtin_inff())));
    const wf own = wf_mul(wf_select(some, surface, zero), wf_set((float)(1 / view->unit_camera)));
    const wf here = wf_mul(part, wf_fma(wf_sub(one, opacity), own, sum));
    return wf_select(some, wf_div(wf_fma(rest, past, here), wf_fma(rest, past_opacity, part)), wf_div(past, past_opacity));
}

/// Draws a block with a surface in it: the part of a pixel that the surface covers shows what lies in front of it,
/// over its colour, the rest all there is, over the background.
static ALWAYS_INLINE void resolve_with_surface(const ewa_gaussian_view *view, ewa_gaussian_tile *tile,
                                               uint32_t count, uint32_t row, uint32_t column,
                                               const block_place *at, const ewa_volume_target *to,
                                               block_state *block) {
    const wf zero = wf_set(0), one = wf_set(1), half = wf_set(0.5f), infinite = wf_set(__builtin_inff());
    wf surface[4], background[4], past[4], covered[4], out[4];
    load_behind(to, to->surface.rgba, at, surface);
    load_behind(to, NULL, at, background);
    const wf cover = surface[3], inverse = straighten(cover);
    const wm whole = wf_le(one, cover), none = wf_le(cover, zero);
    float depths[16];
    for (uint32_t i = 0; i < 16; i++) {
        const bool inside = i % 4 < at->width && i / 4 < at->height;
        depths[i] = inside ? to->surface.depth[(size_t)(at->y + i / 4) * to->width_px + at->x + i % 4]
                           : __builtin_inff();
    }
    // Where the surface leaves a part of a pixel free, what is behind it counts, too.
    const wm edge = wm_and(wf_lt(cover, one), wf_lt(wf_load(depths), infinite));
    const bool twice = wm_bits(edge) != 0;
    wf past_opacity = zero, past_depth = view->expected ? zero : infinite;
    if (twice) {
        // Behind the surface half of the light is gone where that is gone of what it leaves.
        const wf left = wf_select(whole, infinite, wf_div(half, wf_select(whole, one, wf_sub(one, cover))));
        composite_block(view, tile, count, row, column, at, to, true, left, block);
        lay_block_over(view, tile, block, background, past);
        past_opacity = wf_sub(one, wf_load(block->pixels + 48));
        past_depth = wf_load(block->pixels + 64);
    }
    composite_block(view, tile, count, row, column, at, to, false, half, block);
    wf opacity = wf_sub(one, wf_load(block->pixels + 48)), depth = wf_load(block->pixels + 64);
    if (!twice) {
        lay_block_over(view, tile, block, background, past);
        past_opacity = opacity;
        if (view->expected) past_depth = depth;
    }
    if (view->expected) depth = expect(view, cover, wf_load(depths), opacity, depth, past_opacity, past_depth);
    for (int c = 0; c < 3; c++) surface[c] = wf_mul(surface[c], inverse);
    surface[3] = one;
    lay_block_over(view, tile, block, surface, covered);
    for (int c = 0; c < 4; c++) {
        out[c] = wf_fma(cover, wf_sub(covered[c], past[c]), past[c]);
        out[c] = wf_select(whole, covered[c], wf_select(none, past[c], out[c]));
    }
    opacity = wf_select(whole, opacity, wf_fma(cover, wf_sub(opacity, past_opacity), past_opacity));
    store_colors_of(to, at, out);
    store_geometry(to, at, opacity, view->expected ? infinite : depth, view->expected ? infinite : past_depth, view->unit_camera);
    if (view->expected) store_expected(to, at, opacity, depth, view->unit_camera);
}

static void draw(const ewa_gaussian_view *view, ewa_gaussian_tile *tile, const ewa_volume_target *to) {
    block_state block;
    for (uint32_t row = 0; 4 * row < tile->height_px; row++) {
        const uint32_t row_count = gather_row(tile, row);
        for (uint32_t column = 0; 4 * column < tile->width_px; column++) {
            const block_place at =
                place_block((int32_t)tile->x_px, (int32_t)tile->y_px, (int32_t)tile->width_px,
                            (int32_t)tile->height_px, row, column);
            const uint32_t count = gather_block(tile, row_count, column);
            if (view->with_surface) {
                resolve_with_surface(view, tile, count, row, column, &at, to, &block);
                continue;
            }
            wf behind[4], out[4];
            composite_block(view, tile, count, row, column, &at, to, false, wf_set(0.5f), &block);
            load_behind(to, NULL, &at, behind);
            lay_block_over(view, tile, &block, behind, out);
            store_colors_of(to, &at, out);
            const wf opacity = wf_sub(wf_set(1), wf_load(block.pixels + 48)), infinite = wf_set(__builtin_inff());
            const wf depth = wf_load(block.pixels + 64);
            store_geometry(to, &at, opacity, view->expected ? infinite : depth, infinite, view->unit_camera);
            if (view->expected) store_expected(to, &at, opacity, wf_div(depth, opacity), view->unit_camera);
        }
    }
}

#endif
