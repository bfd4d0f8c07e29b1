// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: from the voxels of a block to records in the buckets of a tile
// (docs/math.md sections 3 and 12).
#ifndef EWA_SRC_VOLUME_KERNELS_APPEND_H
#define EWA_SRC_VOLUME_KERNELS_APPEND_H

#include "volume/kernels.h"
#include "wide/shine.h"

#include <string.h>

/// Sixteen voxels in camera space.
typedef struct voxel_lanes {
    wf steps[3]; ///< along i, j, k within the block
    wf place[3];
    wf x, y, z; ///< perspective: x and y are slopes
    wf ahead;   ///< the third number that goes with these slopes: 1
    wf length;  ///< perspective: of (x, y, ahead)
    wf inverse; ///< 1 / z
    wf unit;    ///< depth unit, whole: the slice, before it is clamped
} voxel_lanes;

static ALWAYS_INLINE wf row_dot(const float *m, int stride, wf x, wf y, wf z) {
    return wf_fma(wf_set(m[0]), x, wf_fma(wf_set(m[stride]), y, wf_mul(wf_set(m[2 * stride]), z)));
}

static ALWAYS_INLINE voxel_lanes place_voxels(const ewa_volume_view *view, const ewa_volume_source *source,
                                              uint32_t first) {
    const wi place = wi_load_u16(source->places + first);
    const wf i = wf_from_i(wi_and(place, wi_set(7)));
    const wf j = wf_from_i(wi_and(wi_sar(place, 3), wi_set(7))), k = wf_from_i(wi_sar(place, 6));
    wf p[3];
    for (int c = 0; c < 3; c++)
        p[c] = wf_fma(i, wf_set(view->axes[0][c]),
                      wf_fma(j, wf_set(view->axes[1][c]),
                             wf_fma(k, wf_set(view->axes[2][c]), wf_set(source->origin[c]))));
    const wf one = wf_set(1);
    voxel_lanes v = {{i, j, k}, {p[0], p[1], p[2]}, p[0], p[1], p[2], one, one, one, one};
    v.unit = wf_floor(wf_fma(v.z, wf_set(view->unit_inverse), wf_set(view->unit_offset)));
    if (!view->orthographic) {
        v.inverse = wf_div(wf_set(1), p[2]);
        v.x = wf_mul(p[0], v.inverse);
        v.y = wf_mul(p[1], v.inverse);
        v.length = wf_sqrt(wf_fma(v.x, v.x, wf_fma(v.y, v.y, wf_set(1))));
    }
    return v;
}

/// Shades colours by the gradients, which are seen from both sides.
static ALWAYS_INLINE void shade_voxels(const ewa_volume_view *view, const ewa_volume_source *source,
                                       uint32_t first, const voxel_lanes *v, wf color[3]) {
    const wi packed = wi_load(source->normals + first);
    const wf scale = wf_set(1.0f / 511), zero = wf_set(0);
    wf normal[3], toward[3];
    for (int c = 0; c < 3; c++) normal[c] = wf_mul(wf_from_i(wi_sar(wi_shl(packed, 22 - 10 * c), 22)), scale);
    if (view->orthographic) {
        for (int c = 0; c < 3; c++) toward[c] = wf_set(view->toward_viewer[c]);
    } else {
        const wf shrink = wf_div(wf_set(-1), v->length);
        for (int c = 0; c < 3; c++)
            toward[c] = wf_mul(shrink, row_dot(view->to_world + 3 * c, 1, v->x, v->y, v->ahead));
    }
    const wf side = dot3(normal, toward);
    const wm behind = wf_lt(side, zero);
    for (int c = 0; c < 3; c++) normal[c] = wf_select(behind, wf_sub(zero, normal[c]), normal[c]);
    const lane_light light = gather_light(view->lights, view->light_count, view->highlights, normal, toward,
                                          wf_set(view->shininess));
    // Where nothing changes there is no surface: ambient and diffuse light from everywhere.
    const wm flat = wf_le(dot3(normal, normal), wf_set(0.25f));
    for (int c = 0; c < 3; c++) {
        const wf share = wf_fma(wf_set(view->diffuse), light.diffuse[c], wf_set(view->ambient));
        const wf lit = wf_fma(color[c], share, wf_mul(wf_set(view->specular), light.specular[c]));
        color[c] = wf_select(flat, wf_mul(color[c], wf_set(view->ambient + view->diffuse)), lit);
    }
}

static ALWAYS_INLINE void color_voxels(const ewa_volume_view *view, const ewa_volume_source *source,
                                       uint32_t first, const voxel_lanes *v, wf color[3]) {
    for (int c = 0; c < 3; c++)
        color[c] = wf_mul(wf_from_i(wi_load_u16(source->colors[c] + first)), wf_set(view->color_scale));
    if (view->lit) shade_voxels(view, source, first, v, color);
}

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

/// The windows of points (ewa_volume_page), and which of them touch the tile.
static ALWAYS_INLINE wi point_windows(const ewa_volume_tile *tile, wf x, wf y, wm *touches) {
    const wf half = wf_set(0.5f), limit = wf_set(1e6f);
    const wf u = wf_max(wf_min(wf_sub(x, half), limit), wf_set(-1e6f));
    const wf v = wf_max(wf_min(wf_sub(y, half), limit), wf_set(-1e6f));
    const wf whole_u = wf_floor(u), whole_v = wf_floor(v), phases = wf_set(EWA_FILTER_PHASES);
    const wi phase_u = wi_from_f(wf_mul(wf_sub(u, whole_u), phases));
    const wi phase_v = wi_from_f(wf_mul(wf_sub(v, whole_v), phases));
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

/// Room for one more record in a bucket: its number, EWA_PAGE_RECORDS to a page.
static ALWAYS_INLINE uint32_t next_record(ewa_volume_pages *pages, ewa_volume_bucket *bucket) {
    const uint32_t slot = bucket->count++ % EWA_PAGE_RECORDS;
    if (slot == 0) {
        const uint32_t page = pages->free[--pages->free_count];
        if (bucket->count == 1)
            bucket->first_page = page;
        else
            pages->next[bucket->last_page] = page;
        bucket->last_page = page;
    }
    return bucket->last_page * EWA_PAGE_RECORDS + slot;
}

static uint32_t append(const ewa_volume_view *frame_view, const ewa_volume_source *block,
                       ewa_volume_tile *tile) {
    // Records that are written cannot change these.
    const ewa_volume_view view_here = *frame_view, *view = &view_here;
    const ewa_volume_source source_here = *block, *source = &source_here;
    const wf tile_x = wf_set(view->cx_px - (float)tile->x_px),
             tile_y = wf_set(view->cy_px - (float)tile->y_px);
    const wf width = wf_set((float)tile->width_px), height = wf_set((float)tile->height_px), zero = wf_set(0);
    const bool has_splats = source->slice_first < view->point_slice;
    uint32_t added = 0;
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
        wf factor = mass, last = mass;
        if (has_splats) {
            const wm points = wf_le(wf_set((float)view->point_slice), wf_from_i(slice));
            const wf reach = splat_reach(view, &v);
            const wm near_x = wm_and(wf_lt(wf_sub(zero, reach), x), wf_lt(wf_sub(x, reach), width));
            const wm near_y = wm_and(wf_lt(wf_sub(zero, reach), y), wf_lt(wf_sub(y, reach), height));
            touches = wm_or(wm_and(points, touches), wm_and(wm_not(points), wm_and(near_x, near_y)));
            factor = wf_select(points, mass, wf_set(1));
            last = wf_select(points, mass, wf_min(density, wf_set(1e18f)));
        }
        touches = wm_and(touches, wf_lt(zero, last));
        if (view->has_near) touches = wm_and(touches, wf_le(zero, v.unit));
        uint32_t bits = wm_bits(touches) & (left < 16 ? (1u << left) - 1 : 0xffff);
        if (!bits) continue;
        wf color[3];
        color_voxels(view, source, first, &v, color);
        float colors[64], places[64];
        int32_t slices[16], windows[16];
        w_store4(colors, wf_mul(color[0], factor), wf_mul(color[1], factor), wf_mul(color[2], factor), last);
        wi_store(slices, slice);
        wi_store(windows, window);
        if (has_splats) {
            const wf distance = view->orthographic
                                    ? wf_fma(wf_fma(v.x, v.x, wf_mul(v.y, v.y)), wf_set(view->bend), v.z)
                                    : wf_mul(v.z, v.length);
            w_store4(places, x, y, v.z, distance);
        }
        added += (uint32_t)__builtin_popcount(bits);
        for (; bits; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            const uint32_t number =
                next_record(&tile->pages, &tile->ring[(uint32_t)slices[lane] & tile->ring_mask]);
            ewa_volume_page *page = &tile->pages.pages[number / EWA_PAGE_RECORDS];
            const uint32_t slot = number % EWA_PAGE_RECORDS;
            memcpy(page->colors[slot], &colors[4 * lane], 16);
            if (has_splats && slices[lane] < view->point_slice)
                memcpy(&page->splats[slot], &places[4 * lane], 16);
            else
                page->windows[slot] = windows[lane];
        }
    }
    return added;
}

#endif
