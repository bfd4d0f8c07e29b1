// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of pipeline_body.h: from a block's sums to the straight colours of its surface, by its filtered
// normal, colour and material (docs/math.md section 7; semantics.h, shading).
//
// Based on: Zwicker, Pfister, van Baar, Gross, "Surface Splatting", 2001, section 4 (deferred shading of
// filtered attributes); L. Williams, "Pyramidal Parametrics", 1983 (the filtered lookup).
#ifndef EWA_SRC_SURFACE_PIPELINE_SHADE_H
#define EWA_SRC_SURFACE_PIPELINE_SHADE_H

#include "surface/pipeline_raster.h"
#include "wide/shine.h"

enum { EWA_SHADE_FLOATS = 3 * EWA_BLOCK_LANES };

static inline void scale3(wf v[3], wf by) {
    for (int i = 0; i < 3; i++) v[i] = wf_mul(v[i], by);
}

/// From the surface to the eye along the rays of a block's pixels: not of unit length in perspective.
static ALWAYS_INLINE void toward_eye(const ewa_resolve *to, uint32_t x, uint32_t y, wf out[3]) {
    if (to->orthographic) {
        out[0] = out[1] = wf_set(0);
    } else {
        const wf px = wf_add(lanes_x(), wf_set((float)x)), py = wf_add(lanes_y(), wf_set((float)y));
        out[0] = wf_fma(px, wf_set(-to->ray_x[0]), wf_set(-to->ray_x[1]));
        out[1] = wf_fma(py, wf_set(-to->ray_y[0]), wf_set(-to->ray_y[1]));
    }
    out[2] = wf_set(-1);
}

/// The square of what sums of weighted normals are divided by for shading.
static ALWAYS_INLINE wf shaded_length2(const wf normal[3], wf weight) {
    const wf minimum = wf_mul(weight, wf_set((float)EWA_SHADED_NORMAL));
    return wf_max(dot3(normal, normal), wf_mul(minimum, minimum));
}

/// The share of light that a pixel with weighted normals' sum `normal` returns: ambient + diffuse
/// max(0, N.L).
static ALWAYS_INLINE wf lambert(const ewa_resolve *to, const wf normal[3], wf weight, uint32_t x,
                                uint32_t y) {
    const ewa_kernel_light *from = &to->lights[0];
    wf light[3], length2 = shaded_length2(normal, weight);
    const wm defined = wf_lt(wf_set(0), length2);
    if (from->headlight && !to->orthographic) {
        toward_eye(to, x, y, light);
        length2 = wf_mul(length2, dot3(light, light));
    } else {
        for (int i = 0; i < 3; i++) light[i] = wf_set(from->toward[i]);
    }
    const wf inverse = wf_keep(defined, wf_inverse_root(length2));
    const wf facing = wf_max(wf_mul(dot3(normal, light), inverse), wf_set(0));
    return wf_fma(wf_set(to->material[1]), facing, wf_set(to->material[0]));
}

/// 1 / weight, 0 where there is none.
static ALWAYS_INLINE wf inverse_weight(wf weight) {
    const wm covered = wf_lt(wf_set(0), weight);
    return wf_keep(covered, wf_div(wf_set(1), wf_select(covered, weight, wf_set(1))));
}

/// The channel that colours are divided by: colours are weighted by opacity where surfels have one.
static ALWAYS_INLINE uint32_t color_weight(const ewa_tile *tile) {
    return tile->with_opacity ? tile->channel_count - 1 : 0;
}

/// Whether a block's colours are their weighted sums times one factor.
static ALWAYS_INLINE bool shades_by_factor(const ewa_resolve *to) {
    return to->shading <= EWA_PIPELINE_LAMBERT;
}

/// Where reflections look into the environment, lane by lane.
typedef struct lookup {
    float u[EWA_BLOCK_LANES], v[EWA_BLOCK_LANES]; ///< in [0, 1]
    float level[EWA_BLOCK_LANES];
} lookup;

/// The squared footprints of directions: the longer of their distances to the two neighbours in each 2x2
/// pixels, as far as those are among `bits`.
static wf footprints2(const wf direction[3], uint32_t bits) {
    float lanes[3][EWA_BLOCK_LANES], largest[EWA_BLOCK_LANES];
    for (int c = 0; c < 3; c++) wf_store(lanes[c], direction[c]);
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) {
        largest[i] = 0;
        const uint32_t neighbours[2] = {i ^ 1, i ^ EWA_BLOCK_PX};
        for (int k = 0; k < 2; k++) {
            if (!(bits >> neighbours[k] & 1)) continue;
            const float x = lanes[0][i] - lanes[0][neighbours[k]], y = lanes[1][i] - lanes[1][neighbours[k]],
                        z = lanes[2][i] - lanes[2][neighbours[k]];
            const float distance2 = x * x + y * y + z * z;
            largest[i] = distance2 > largest[i] ? distance2 : largest[i];
        }
    }
    return wf_load(largest);
}

static void find_lookups(const ewa_resolve *to, const wf normal[3], const wf view[3], uint32_t bits,
                         lookup *at) {
    const wf twice = wf_mul(dot3(normal, view), wf_set(2));
    wf mirrored[3], d[3];
    for (int i = 0; i < 3; i++) mirrored[i] = wf_fma(twice, normal[i], wf_negate(view[i]));
    rotate(to->environment_from_camera, mirrored[0], mirrored[1], mirrored[2], d);
    const wf half = wf_set(0.5f), horizontal = wf_sqrt(wf_fma(d[0], d[0], wf_mul(d[2], d[2])));
    const wf longitude = wf_atan2(d[0], d[2]), latitude = wf_atan2(d[1], horizontal);
    wf_store(at->u, wf_clamp(wf_fma(longitude, wf_set(-0.159154943f), half), 0, 1));
    wf_store(at->v, wf_clamp(wf_fma(latitude, wf_set(-0.318309886f), half), 0, 1));
    // Half the logarithm of the squared footprint in texels of level 0.
    const float texels = (float)to->environment->levels[0].height * 0.318309886f;
    const wf footprint2 = wf_mul(footprints2(d, bits), wf_set(texels * texels));
    const wf level = wf_mul(half, wf_log2(wf_max(footprint2, wf_set(1))));
    wf_store(at->level, wf_min(level, wf_set((float)(to->environment->level_count - 1))));
}

/// Adds a level's light at (u, v), between its four nearest texels, times `weight`.
static void add_level(const ewa_environment_level *level, float u, float v, float weight, float light[3]) {
    const float x = u * (float)level->width - 0.5f, y = v * (float)level->height - 0.5f;
    const float x_floor = __builtin_floorf(x), y_floor = __builtin_floorf(y);
    const float share_x = x - x_floor, share_y = y - y_floor;
    for (int row = 0; row < 2; row++) {
        int64_t texel_y = (int64_t)y_floor + row, turn = 0;
        if (texel_y < 0 || texel_y >= level->height) {
            texel_y = texel_y < 0 ? 0 : level->height - 1;
            turn = level->width / 2; // over the pole
        }
        for (int column = 0; column < 2; column++) {
            int64_t texel_x = (int64_t)x_floor + column + turn; // in [-1, 2 width)
            if (texel_x < 0) texel_x += level->width;
            if (texel_x >= level->width) texel_x -= level->width;
            const float *texel = level->texels + 3 * ((size_t)texel_y * level->width + (size_t)texel_x);
            const float share = weight * (row ? share_y : 1 - share_y) * (column ? share_x : 1 - share_x);
            for (int c = 0; c < 3; c++) light[c] += share * texel[c];
        }
    }
}

/// What the environment mirrors to the pixels `bits` of a block; 0 elsewhere.
static void reflect(const ewa_resolve *to, const wf normal[3], const wf view[3], uint32_t bits, wf out[3]) {
    lookup at;
    find_lookups(to, normal, view, bits, &at);
    float planes[3][EWA_BLOCK_LANES] = {{0}};
    for (; bits; bits &= bits - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(bits), fine = (uint32_t)at.level[i];
        const float share = at.level[i] - (float)fine;
        float light[3] = {0, 0, 0};
        add_level(&to->environment->levels[fine], at.u[i], at.v[i], 1 - share, light);
        if (share > 0) add_level(&to->environment->levels[fine + 1], at.u[i], at.v[i], share, light);
        for (int c = 0; c < 3; c++) planes[c][i] = light[c];
    }
    for (int c = 0; c < 3; c++) out[c] = wf_load(planes[c]);
}

/// Shades with any lights, highlights and the environment; straight colours.
static void shade_surface(const ewa_tile *tile, const ewa_resolve *to, const block_sums *sums, uint32_t x,
                          uint32_t y, float *shade) {
    enum { LANES = EWA_BLOCK_LANES };
    const wf weight = sum_of(sums, 0), zero = wf_set(0);
    const uint32_t bits = wm_bits(wf_lt(zero, weight));
    if (!bits) {
        for (int i = 0; i < 3; i++) wf_store(shade + i * LANES, zero);
        return;
    }
    const wf inverse = inverse_weight(weight);
    const wf inverse_color = wf_mul(inverse_weight(sum_of(sums, color_weight(tile))), wf_set(to->color_unit));
    wf normal[3], view[3], material[EWA_MATERIAL_CHANNELS];
    for (int i = 0; i < 3; i++) normal[i] = sum_of(sums, 4 + (uint32_t)i);
    const wf length2 = shaded_length2(normal, weight);
    scale3(normal, wf_keep(wf_lt(zero, length2), wf_inverse_root(length2)));
    toward_eye(to, x, y, view);
    if (!to->orthographic) scale3(view, wf_inverse_root(dot3(view, view)));
    for (int i = 0; i < EWA_MATERIAL_CHANNELS; i++)
        material[i] = tile->with_materials ? wf_mul(wf_mul(sum_of(sums, MATERIAL_AT + (uint32_t)i), inverse),
                                                    wf_set(to->material_units[i]))
                                           : wf_set(to->material[i]);
    lane_light light;
    gather_light_each(to->lights, to->light_count, to->shading == EWA_PIPELINE_PHONG, &normal, &view,
                      material[3], &light, 1);
    wf mirrored[3] = {zero, zero, zero};
    const bool mirrors =
        to->shading == EWA_PIPELINE_PHONG && to->environment && wm_bits(wf_lt(zero, material[4])) & bits;
    if (mirrors) reflect(to, normal, view, bits, mirrored);
    for (int i = 0; i < 3; i++) {
        const wf color = wf_mul(sum_of(sums, 1 + (uint32_t)i), inverse_color);
        wf seen = wf_mul(color, wf_fma(material[1], light.diffuse[i], material[0]));
        if (to->shading == EWA_PIPELINE_PHONG) seen = wf_fma(material[2], light.specular[i], seen);
        if (mirrors) seen = wf_fma(material[4], mirrored[i], seen);
        wf_store(shade + i * LANES, seen);
    }
}

/// Shades the surface that `sums` hold of the block at (x, y): writes what its weighted colours are to be
/// multiplied by, one number per pixel, or straight colours, three planes; see shades_by_factor().
static ALWAYS_INLINE void shade_block(const ewa_tile *tile, const ewa_resolve *to, const block_sums *sums,
                                      uint32_t x, uint32_t y, float *shade) {
    if (!shades_by_factor(to)) {
        shade_surface(tile, to, sums, x, y, shade);
        return;
    }
    wf factor = wf_mul(inverse_weight(sum_of(sums, color_weight(tile))), wf_set(to->color_unit));
    if (to->shading == EWA_PIPELINE_LAMBERT) {
        wf normal[3];
        for (int i = 0; i < 3; i++) normal[i] = sum_of(sums, 4 + (uint32_t)i);
        factor = wf_mul(factor, lambert(to, normal, sum_of(sums, 0), x, y));
    }
    wf_store(shade, factor);
}

#endif
