// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of kernels_body.h: where voxels of a block are, and their colours under light (docs/math.md sections 3
// and 12).
#ifndef EWA_SRC_VOLUME_KERNELS_SHADE_H
#define EWA_SRC_VOLUME_KERNELS_SHADE_H

#include "volume/kernels.h"
#include "wide/shine.h"

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

static ALWAYS_INLINE void load_colors(const ewa_volume_view *view, const ewa_volume_source *source,
                                      uint32_t first, wf color[3]) {
    for (int c = 0; c < 3; c++)
        color[c] = wf_mul(wf_from_i(wi_load_u16(source->colors[c] + first)), wf_set(view->color_scale));
}

/// Gives marked splats their colour.
static ALWAYS_INLINE void mark_colors(const ewa_volume_view *view, wm splats, wf color[3]) {
    for (int c = 0; c < 3; c++) color[c] = wf_select(splats, wf_set(view->marked_color[c]), color[c]);
}

/// What the light on sixteen voxels depends on.
typedef struct lit_lanes {
    wi normal;           ///< packed
    wf x, y, ahead;      ///< perspective: the voxel's direction from the eye
    wf length, color[3]; ///< of (x, y, ahead)
} lit_lanes;

/// Shades colours by the gradients, which are seen from both sides.
static ALWAYS_INLINE void shade_each(const ewa_volume_view *view, lit_lanes *v, const int count) {
    const wf scale = wf_set(1.0f / 511), zero = wf_set(0);
    wf normal[WIDE_TOGETHER][3], toward[WIDE_TOGETHER][3];
    for (int n = 0; n < count; n++) {
        for (int c = 0; c < 3; c++)
            normal[n][c] = wf_mul(wf_from_i(wi_sar(wi_shl(v[n].normal, 22 - 10 * c), 22)), scale);
        if (view->orthographic) {
            for (int c = 0; c < 3; c++) toward[n][c] = wf_set(view->toward_viewer[c]);
        } else {
            const wf shrink = wf_div(wf_set(-1), v[n].length);
            for (int c = 0; c < 3; c++)
                toward[n][c] = wf_mul(shrink, row_dot(view->to_world + 3 * c, 1, v[n].x, v[n].y, v[n].ahead));
        }
        const wf side = dot3(normal[n], toward[n]);
        const wm behind = wf_lt(side, zero);
        for (int c = 0; c < 3; c++)
            normal[n][c] = wf_select(behind, wf_sub(zero, normal[n][c]), normal[n][c]);
    }
    lane_light light[WIDE_TOGETHER];
    gather_light_each(view->lights, view->light_count, view->highlights, normal, toward,
                      wf_set(view->shininess), light, count);
    for (int n = 0; n < count; n++) {
        // Where nothing changes there is no surface: ambient and diffuse light from everywhere.
        const wm flat = wf_le(dot3(normal[n], normal[n]), wf_set(0.25f));
        for (int c = 0; c < 3; c++) {
            const wf color = v[n].color[c];
            const wf share = wf_fma(wf_set(view->diffuse), light[n].diffuse[c], wf_set(view->ambient));
            const wf lit = wf_fma(color, share, wf_mul(wf_set(view->specular), light[n].specular[c]));
            v[n].color[c] = wf_select(flat, wf_mul(color, wf_set(view->ambient + view->diffuse)), lit);
        }
    }
}

#endif
