// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: what a splat adds to the sums of a pixel (docs/math.md section 6).
#ifndef EWA_SRC_SURFACE_PIPELINE_PAYLOAD_H
#define EWA_SRC_SURFACE_PIPELINE_PAYLOAD_H

#include "surface/pipeline_side_sums.h"

/// Which channels a pass adds, and what is particular to it.
enum {
    ADD_NORMAL = 1,
    ADD_DEPTH = 2,
    ADD_OPACITY = 4,
    ORTHOGRAPHIC = 8, ///< depths are -key
    ADD_FINE = 128,   ///< what the units of sums leave
    BEYOND = 32,      ///< only beyond tile->passed; the depth, if there is one, is not added
    ADD_MATERIAL = 64,
};

/// Where the material's channels begin.
enum { MATERIAL_AT = 8 };

/// The channels of a tile but for the depth.
static ALWAYS_INLINE int channels_of(const ewa_tile *tile) {
    return (tile->with_normals ? ADD_NORMAL : 0) | (tile->with_opacity ? ADD_OPACITY : 0) |
           (tile->with_materials ? ADD_MATERIAL : 0) | (tile->with_fine ? ADD_FINE : 0);
}

/// What a record adds where its kernel is at its peak, in units; odd or 0.
typedef struct payload {
    wf peak, color[3], normal[3], opacity, material[EWA_MATERIAL_CHANNELS];
} payload;

/// Of splat `index` of a list.
static ALWAYS_INLINE payload payload_load(const ewa_view *view, const ewa_record *r, const ewa_load *load,
                                          const float *opacities, const uint8_t *materials, uint32_t index,
                                          int what) {
    payload p = {.peak = wf_set(load->peak), .color = {wf_set(r->red), wf_set(r->green), wf_set(r->blue)}};
    if (what & ADD_NORMAL)
        for (int i = 0; i < 3; i++) p.normal[i] = wf_set(load->normal[i]);
    if (what & ADD_OPACITY) p.opacity = wf_set(opacities[index]);
    if (what & ADD_MATERIAL)
        for (int i = 0; i < EWA_MATERIAL_CHANNELS; i++)
            p.material[i] = wf_odd(wf_set(view->materials[materials[index]][i] * load->peak));
    return p;
}

/// A payload whose peak is larger pixel by pixel.
static ALWAYS_INLINE payload payload_times(const payload *p, wf gain, int what) {
    payload made = {.peak = wf_odd_product(p->peak, gain)};
    for (int i = 0; i < 3; i++) made.color[i] = wf_odd_product(p->color[i], gain);
    for (int i = 0; i < 3 && what & ADD_NORMAL; i++) made.normal[i] = wf_odd_product(p->normal[i], gain);
    if (what & ADD_OPACITY) made.opacity = wf_odd_product(p->opacity, gain);
    for (int i = 0; i < EWA_MATERIAL_CHANNELS && what & ADD_MATERIAL; i++)
        made.material[i] = wf_odd_product(p->material[i], gain);
    return made;
}

/// A depth as its sums have it, within [-1, 1]: over the largest that counts at the pixel, whose key is
/// `nearest`; orthographic: over the scene's.
static ALWAYS_INLINE wf depth_share(const ewa_view *view, wf key, wf nearest, int what) {
    const wf share = what & ORTHOGRAPHIC ? wf_mul(key, wf_set(-view->depth_scale)) : wf_div(nearest, key);
    return wf_odd(wf_min(wf_max(share, wf_set(-1)), wf_set(0x1.fffffep-1f)));
}

static ALWAYS_INLINE void add_channel(float *sums, uint32_t channel, const ewa_sums *of, wf weight, wf peak,
                                      int what) {
    float *plane = sums + (size_t)channel * EWA_BLOCK_LANES;
    if (what & ADD_FINE)
        add_product_finely(plane, of->fine, weight, peak);
    else
        add_product(plane, weight, peak);
}

/// Adds to a block's `sums`, which have room; to depths, and the weights that they are divided by, finely.
/// `weight` is relative to the kernel's peak, `depth` that of depth_share(); the opacity is the last of
/// `channels`.
static ALWAYS_INLINE void add_channels(float *sums, const ewa_sums *of, uint32_t channels, wf weight,
                                       const payload *p, wf depth, int what) {
    const int with_depth = what & ADD_DEPTH ? what | ADD_FINE : what;
    add_channel(sums, 0, of, weight, p->peak, with_depth);
    for (uint32_t i = 0; i < 3; i++) add_channel(sums, 1 + i, of, weight, p->color[i], what);
    if (what & ADD_NORMAL)
        for (uint32_t i = 0; i < 3; i++) add_channel(sums, 4 + i, of, weight, p->normal[i], what);
    if (what & ADD_DEPTH)
        add_channel(sums, what & ADD_NORMAL ? 7 : 4, of, wf_mul(weight, p->peak), depth, with_depth);
    if (what & ADD_MATERIAL)
        for (uint32_t i = 0; i < EWA_MATERIAL_CHANNELS; i++)
            add_channel(sums, MATERIAL_AT + i, of, weight, p->material[i], what);
    if (what & ADD_OPACITY) add_channel(sums, channels - 1, of, weight, p->opacity, what);
}

/// The sums in which a splat is gathered.
static ALWAYS_INLINE const ewa_sums *sums_for(const ewa_tile *tile, bool is_back) {
    return is_back ? &tile->side.is_back : &tile->sums;
}

#endif
