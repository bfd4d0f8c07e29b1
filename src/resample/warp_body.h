// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sampling kernels over the wide type: the file that includes it defines which one that is, and
// WARP_KERNELS, the name of the table.
//
// Based on: Yuan et al., "Hybrid Forward Resampling and Volume Rendering", 2003, section 3 (splat sizes from
// neighbours of the same surface, normals).
#include "math/wide.h"
#include "resample/warp_sample.h"

/// A second difference that is not known.
static const float UNKNOWN = 1e30f;

/// How many times straighter one side of a crease is than the crease.
static const float STRAIGHTER = 4;

/// Whether a neighbour is on the same surface: it is near, or it continues the differences on one side.
static ALWAYS_INLINE wm same_surface(const ewa_warp_lens *lens, wf key, wf neighbour, wf difference,
                                     wf inner_bend, wf outer_bend) {
    const wf larger = wf_max(neighbour, key); // NaN gives the key
    const wf size = wf_abs(difference), most_bend = wf_mul(wf_set(lens->bend), larger);
    const wm near = wf_le(size, wf_mul(wf_set(lens->jump), larger));
    const wm straight = wm_or(wf_le(inner_bend, most_bend), wf_le(outer_bend, most_bend));
    return wm_or(near, wm_and(straight, wf_le(size, wf_mul(wf_set(lens->steep), larger))));
}

/// The slope of the key along one direction from five keys; adds to `flying` what hangs between its
/// neighbours.
static ALWAYS_INLINE wf slope_along(const ewa_warp_lens *lens, float crease, const wf key[5], wm *flying) {
    const wf zero = wf_set(0), unknown = wf_set(UNKNOWN);
    const wf left = wf_sub(key[2], key[1]), right = wf_sub(key[3], key[2]);
    const wf bend = wf_abs(wf_sub(right, left));
    const wf left_bend = wf_abs(wf_sub(left, wf_sub(key[1], key[0])));
    const wf right_bend = wf_abs(wf_sub(wf_sub(key[4], key[3]), right));
    const wm has_left = same_surface(lens, key[2], key[1], left, bend, left_bend);
    const wm has_right = same_surface(lens, key[2], key[3], right, bend, right_bend);
    // On a crease the straighter side has the sample.
    const wf left_known = wf_min(left_bend, unknown), right_known = wf_min(right_bend, unknown);
    const wf least = wf_min(left_known, right_known);
    const wm creased = wm_and(wf_lt(wf_mul(wf_set(crease), key[2]), bend),
                              wf_lt(wf_mul(wf_set(STRAIGHTER), least), bend));
    const wf one_side = wf_select(wf_lt(left_known, right_known), left, right);
    const wf middle = wf_mul(wf_add(left, right), wf_set(0.5f));
    const wf single = wf_select(has_left, left, wf_keep(has_right, right));
    const wm torn = wm_not(wm_or(has_left, has_right));
    *flying = wm_or(*flying, wm_and(torn, wf_lt(zero, wf_mul(left, right))));
    return wf_select(wm_and(has_left, has_right), wf_select(creased, one_side, middle), single);
}

static uint32_t slopes(const ewa_warp_lens *lens, const float *keys, size_t stride, uint32_t count,
                       float *kept_keys, float *slope_x, float *slope_y) {
    uint32_t dropped = 0;
    const wm drop = wf_lt(wf_set(0), wf_set(lens->drop_flying));
    for (uint32_t x = 0; x < count; x += 16) {
        wf along[5], down[5];
        for (int i = 0; i < 5; i++) {
            along[i] = wf_load(keys + x + i - EWA_WARP_REACH);
            down[i] = i == EWA_WARP_REACH ? along[i]
                      : i < EWA_WARP_REACH
                          ? wf_load(keys + x - (size_t)(EWA_WARP_REACH - i) * stride)
                          : wf_load(keys + x + (size_t)(i - EWA_WARP_REACH) * stride);
        }
        wm flying = wm_of_bits(0);
        wf_store(slope_x + x, slope_along(lens, lens->crease_x, along, &flying));
        wf_store(slope_y + x, slope_along(lens, lens->crease_y, down, &flying));
        flying = wm_and(flying, drop);
        dropped += (uint32_t)__builtin_popcount(wm_bits(flying));
        wf_store(kept_keys + x, wf_select(flying, wf_set(__builtin_nanf("")), along[EWA_WARP_REACH]));
    }
    return dropped;
}

static ALWAYS_INLINE void store_turned(const float m[9], const wf v[3], float out[3][16]) {
    for (int i = 0; i < 3; i++)
        wf_store(out[i], wf_fma(wf_set(m[3 * i]), v[0],
                                wf_fma(wf_set(m[3 * i + 1]), v[1], wf_mul(wf_set(m[3 * i + 2]), v[2]))));
}

static uint32_t block(const ewa_warp_lens *lens, uint32_t x, uint32_t y, const float *keys,
                      const float *slope_x, const float *slope_y, size_t stride, ewa_packet *packet,
                      float normal[3][16], float axis_u[3][16], float axis_v[3][16]) {
    static const float columns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
                       rows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    const wf zero = wf_set(0), one = wf_set(1);
    wf key = wf_load_rows(keys, stride);
    const wm exists = wf_lt(zero, key);
    const uint32_t mask = wm_bits(exists);
    if (!mask) return 0;
    key = wf_select(exists, key, one);
    const wf gx = wf_keep(exists, wf_load_rows(slope_x, stride));
    const wf gy = wf_keep(exists, wf_load_rows(slope_y, stride));
    const wf ray_x = wf_fma(wf_set(lens->ray_x[0]), wf_add(wf_load(columns), wf_set((float)x)),
                            wf_set(lens->ray_x[1]));
    const wf ray_y =
        wf_fma(wf_set(lens->ray_y[0]), wf_add(wf_load(rows), wf_set((float)y)), wf_set(lens->ray_y[1]));
    const wf z = wf_div(one, key);
    // p = z d with the ray d = (X, Y, 1): dp/dx = z (dd/dx - r d), r = (dkey/dx) / key, likewise along y.
    const wf r = wf_mul(gx, z), q = wf_mul(gy, z), size = wf_mul(z, wf_set(lens->sigma));
    const wf u[3] = {wf_mul(size, wf_fnma(r, ray_x, wf_set(lens->ray_x[0]))),
                     wf_mul(size, wf_fnma(r, ray_y, zero)), wf_mul(size, wf_sub(zero, r))};
    const wf v[3] = {wf_mul(size, wf_fnma(q, ray_x, zero)),
                     wf_mul(size, wf_fnma(q, ray_y, wf_set(lens->ray_y[0]))), wf_mul(size, wf_sub(zero, q))};
    // -(u x v) over its length along the ray: it looks at the eye whatever the slopes.
    const wf rf = wf_mul(r, wf_set(1 / lens->ray_x[0])), qf = wf_mul(q, wf_set(1 / lens->ray_y[0]));
    const wf n[3] = {wf_sub(zero, rf), wf_sub(zero, qf), wf_fma(rf, ray_x, wf_fma(qf, ray_y, wf_set(-1)))};
    const wf p[3] = {wf_mul(z, ray_x), wf_mul(z, ray_y), z};
    float position[3][16];
    store_turned(lens->from_camera, p, position);
    store_turned(lens->from_camera, n, normal);
    store_turned(lens->from_camera, u, axis_u);
    store_turned(lens->from_camera, v, axis_v);
    wf_store(packet->x, wf_add(wf_load(position[0]), wf_set(lens->eye[0])));
    wf_store(packet->y, wf_add(wf_load(position[1]), wf_set(lens->eye[1])));
    wf_store(packet->z, wf_add(wf_load(position[2]), wf_set(lens->eye[2])));
    return mask;
}

const ewa_warp_kernels WARP_KERNELS = {slopes, block};
