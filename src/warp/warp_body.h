// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels over the wide type.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3 (splat sizes from
// neighbours of the same surface, normals; docs/math.md section 11).
#include "warp/warp_sample.h"
#include "wide/wide.h"

#include <string.h>

/// A second difference that is not known.
static const float UNKNOWN = 1e30f;

/// Keys closer than so many times the noise are averaged.
static const float CLOSE = 2.5f;

/// Size of the last sample before a farther surface: half a pixel of it is that surface's, and what it is
/// drawn out to is no longer seen.
static const float RIM = 0.7f;

/// How many times straighter one side of a crease is than the crease.
static const float STRAIGHTER = 4;

static void smooth(float noise, const float *keys, size_t stride, uint32_t count, float *smoothed) {
    const wf maximum = wf_set(CLOSE * noise), one = wf_set(1);
    for (uint32_t x = 0; x < count; x += 16) {
        const wf key = wf_load(keys + x);
        wf sum = wf_set(0), weight = sum;
        const float *row = keys + x - EWA_WARP_REACH * stride - EWA_WARP_REACH;
        for (int i = 0; i <= 2 * EWA_WARP_REACH; i++, row += stride) {
            for (int k = 0; k <= 2 * EWA_WARP_REACH; k++) {
                const wf difference = wf_sub(wf_load(row + k), key);
                const wm close = wf_le(wf_abs(difference), maximum);
                sum = wf_add(sum, wf_keep(close, difference));
                weight = wf_add(weight, wf_keep(close, one));
            }
        }
        wf_store(smoothed + x, wf_add(key, wf_div(sum, weight))); // NaN stays
    }
}

/// Whether a neighbour is on the same surface: it is near, or it continues the differences on one side.
static ALWAYS_INLINE wm same_surface(const ewa_warp_lens *lens, wf key, wf neighbour, wf difference,
                                     wf inner_bend, wf outer_bend) {
    const wf larger = wf_max(neighbour, key); // NaN gives the key
    const wf size = wf_abs(difference), max_bend = wf_mul(wf_set(lens->bend), larger);
    const wm near = wf_le(size, wf_mul(wf_set(lens->jump), larger));
    const wm straight = wm_or(wf_le(inner_bend, max_bend), wf_le(outer_bend, max_bend));
    return wm_or(near, wm_and(straight, wf_le(size, wf_mul(wf_set(lens->steep), larger))));
}

/// What is on one side of a sample.
typedef struct side {
    wf rate; ///< of the key per pixel, outward
    wf distance;
    wf bend; ///< of the rate farther out; UNKNOWN there is none
    wf neighbour, difference;
} side;

/// Looks at a neighbour, or past it where it has no depth: sensors leave single pixels out.
static ALWAYS_INLINE side look(wf key, wf next, wf beyond) {
    const wf half = wf_set(0.5f), one = wf_set(1);
    const wm is_next = wf_le(wf_set(0), next);
    side s = {.neighbour = wf_select(is_next, next, beyond)};
    s.difference = wf_sub(s.neighbour, key);
    s.rate = wf_select(is_next, s.difference, wf_mul(s.difference, half));
    s.distance = wf_select(is_next, one, wf_set(2));
    s.bend = wf_min(wf_abs(wf_sub(wf_sub(beyond, next), s.rate)), wf_set(UNKNOWN)); // NaN gives that
    return s;
}

/// The slope of the key along one direction from five keys, and the distance to the neighbours; adds to
/// `flying` what hangs between these.
static ALWAYS_INLINE wf slope_along(const ewa_warp_lens *lens, float crease, const wf key[5], wf *distance,
                                    wm *flying) {
    const wf zero = wf_set(0), half = wf_set(0.5f);
    const side left = look(key[2], key[1], key[0]), right = look(key[2], key[3], key[4]);
    const wf bend = wf_abs(wf_add(right.rate, left.rate));
    const wm has_left = same_surface(lens, key[2], left.neighbour, left.difference, bend, left.bend);
    const wm has_right = same_surface(lens, key[2], right.neighbour, right.difference, bend, right.bend);
    // On a crease the straighter side has the sample.
    const wf minimum = wf_min(left.bend, right.bend);
    const wm creased =
        wm_and(wf_lt(wf_mul(wf_set(crease), key[2]), bend), wf_lt(wf_mul(wf_set(STRAIGHTER), minimum), bend));
    const wm takes_left = wf_lt(left.bend, right.bend), has_both = wm_and(has_left, has_right);
    const wf from_left = wf_sub(zero, left.rate);
    const wf one_side = wf_select(takes_left, from_left, right.rate);
    const wf middle = wf_mul(wf_add(from_left, right.rate), half);
    const wf single = wf_select(has_left, from_left, wf_keep(has_right, right.rate));
    const wf rim = wf_set(RIM), one = wf_set(1);
    const wf left_reach = wf_select(wf_lt(right.neighbour, key[2]), rim, one);
    const wf right_reach = wf_select(wf_lt(left.neighbour, key[2]), rim, one);
    const wf single_distance = wf_select(has_left, wf_mul(left.distance, left_reach),
                                         wf_select(has_right, wf_mul(right.distance, right_reach), one));
    *distance = wf_select(has_both, wf_max(left.distance, right.distance), single_distance);
    const wm torn = wm_not(wm_or(has_left, has_right));
    *flying = wm_or(*flying, wm_and(torn, wf_lt(wf_mul(left.rate, right.rate), zero)));
    return wf_select(has_both, wf_select(creased, one_side, middle), single);
}

static uint32_t slopes(const ewa_warp_lens *lens, const float *keys, size_t stride, uint32_t count,
                       const ewa_warp_rows *rows, size_t at) {
    uint32_t dropped = 0;
    const wm drop = wf_lt(wf_set(0), wf_set(lens->drop_flying));
    for (uint32_t x = 0; x < count; x += 16) {
        wf along[5], down[5], distance_x, distance_y;
        for (int i = 0; i < 5; i++) {
            along[i] = wf_load(keys + x + i - EWA_WARP_REACH);
            down[i] = i == EWA_WARP_REACH  ? along[i]
                      : i < EWA_WARP_REACH ? wf_load(keys + x - (size_t)(EWA_WARP_REACH - i) * stride)
                                           : wf_load(keys + x + (size_t)(i - EWA_WARP_REACH) * stride);
        }
        wm flying = wm_of_bits(0);
        wf_store(rows->slope_x + at + x, slope_along(lens, lens->crease_x, along, &distance_x, &flying));
        wf_store(rows->slope_y + at + x, slope_along(lens, lens->crease_y, down, &distance_y, &flying));
        wf_store(rows->distance_x + at + x, distance_x);
        wf_store(rows->distance_y + at + x, distance_y);
        flying = wm_and(flying, drop);
        dropped += (uint32_t)__builtin_popcount(wm_bits(flying));
        wf_store(rows->keys + at + x, wf_select(flying, wf_set(__builtin_nanf("")), along[EWA_WARP_REACH]));
    }
    return dropped;
}

static ALWAYS_INLINE void store_rotated(const float m[9], const wf v[3], float out[3][16]) {
    for (int i = 0; i < 3; i++)
        wf_store(out[i], wf_fma(wf_set(m[3 * i]), v[0],
                                wf_fma(wf_set(m[3 * i + 1]), v[1], wf_mul(wf_set(m[3 * i + 2]), v[2]))));
}

static uint32_t block(const ewa_warp_lens *lens, uint32_t x, uint32_t y, const ewa_warp_rows *samples,
                      size_t at, ewa_packet *packet, float normal[3][16], float axis_u[3][16],
                      float axis_v[3][16]) {
    static const float columns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
                       rows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    const wf zero = wf_set(0), one = wf_set(1);
    const size_t stride = samples->stride;
    wf key = wf_load_rows(samples->keys + at, stride);
    const wm exists = wf_lt(zero, key);
    const uint32_t mask = wm_bits(exists);
    if (!mask) return 0;
    key = wf_select(exists, key, one);
    const wf gx = wf_keep(exists, wf_load_rows(samples->slope_x + at, stride));
    const wf gy = wf_keep(exists, wf_load_rows(samples->slope_y + at, stride));
    const wf ray_x =
        wf_fma(wf_set(lens->ray_x[0]), wf_add(wf_load(columns), wf_set((float)x)), wf_set(lens->ray_x[1]));
    const wf ray_y =
        wf_fma(wf_set(lens->ray_y[0]), wf_add(wf_load(rows), wf_set((float)y)), wf_set(lens->ray_y[1]));
    const wf z = wf_div(one, key);
    // p = z d with the ray d = (X, Y, 1): dp/dx = z (dd/dx - r d), r = (dkey/dx) / key, likewise along y.
    const wf r = wf_mul(gx, z), q = wf_mul(gy, z), size = wf_mul(z, wf_set(lens->sigma));
    const wf size_x = wf_mul(size, wf_load_rows(samples->distance_x + at, stride));
    const wf size_y = wf_mul(size, wf_load_rows(samples->distance_y + at, stride));
    const wf u[3] = {wf_mul(size_x, wf_fnma(r, ray_x, wf_set(lens->ray_x[0]))),
                     wf_mul(size_x, wf_fnma(r, ray_y, zero)), wf_mul(size_x, wf_sub(zero, r))};
    const wf v[3] = {wf_mul(size_y, wf_fnma(q, ray_x, zero)),
                     wf_mul(size_y, wf_fnma(q, ray_y, wf_set(lens->ray_y[0]))),
                     wf_mul(size_y, wf_sub(zero, q))};
    // -(u x v) over its length along the ray: it looks at the eye whatever the slopes.
    const wf rf = wf_mul(r, wf_set(1 / lens->ray_x[0])), qf = wf_mul(q, wf_set(1 / lens->ray_y[0]));
    const wf n[3] = {wf_sub(zero, rf), wf_sub(zero, qf), wf_fma(rf, ray_x, wf_fma(qf, ray_y, wf_set(-1)))};
    const wf p[3] = {wf_mul(z, ray_x), wf_mul(z, ray_y), z};
    float position[3][16];
    store_rotated(lens->from_camera, p, position);
    memcpy(packet->x, position[0], sizeof packet->x);
    memcpy(packet->y, position[1], sizeof packet->y);
    memcpy(packet->z, position[2], sizeof packet->z);
    store_rotated(lens->from_camera, n, normal);
    store_rotated(lens->from_camera, u, axis_u);
    store_rotated(lens->from_camera, v, axis_v);
    return mask;
}

const ewa_warp_kernels EWA_VERSION(ewa_warp_kernels) = {smooth, slopes, block};
