// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A splat at a pixel: src/surface/pipeline_raster.h, pipeline_raycast.h, pipeline_clip.h, pipeline_near.h.
// Pixels are measured from the middle of the field.

// What a splat is at a pixel (block_sample, ray_sample, near_sample).
struct Sample {
    bool counts;
    float exponent, key, bound;
    float gain;  // of raycast splats; weight of near ones
    float share; // what clip lines leave
    float line[4], first;
};

layout(std430, binding = 9) readonly buffer ClipBlock { Clip clips[]; };
#if WITH_NEARS
layout(std430, binding = 10) readonly buffer NearBlock { Near nears[]; };
#endif

float half_plane_share(ClipLine l, float x, float y) {
    float inside = wf_fma(l.x_inward, x, wf_fma(l.y_inward, y, l.offset));
    float left = wf_sub(l.reach, wf_abs(inside)), corner = wf_min(wf_max(left, 0.0), l.narrow);
    float triangle = wf_mul(wf_mul(corner, corner), l.per_narrow);
    float beside = wf_max(wf_sub(left, l.narrow), 0.0);
    float smaller = wf_mul(wf_fma(beside, 2.0, triangle), l.per_widths);
    return 0.0 < inside ? wf_sub(1.0, smaller) : smaller;
}

void clip_at(Clip clip, vec2 at, inout Sample s) {
    for (uint i = 0u; i < clip.count; i++) s.line[i] = half_plane_share(clip.line[i], at.x, at.y);
    s.first = clip.either != 0u ? wf_max(s.line[0], s.line[1]) : wf_min(s.line[0], s.line[1]);
    s.share = s.first;
    for (uint i = 2u; i < clip.count; i++) s.share = wf_min(s.share, s.line[i]);
    s.counts = s.counts && 0.0 < s.share;
}

float bound_of(Record r, float key, bool exact) {
    if (exact) return wf_mul(key, wf_reciprocal(wf_fma(r.bound_x, key, 1.0)));
    return wf_fma(r.bound, key, r.bound_x);
}

Sample sample_splat(Record r, vec2 at, View view) {
    Sample s;
    s.gain = s.share = 1.0;
    float dx = wf_sub(at.x, r.cx), dy = wf_sub(at.y, r.cy);
    float quadratic = wf_mul(wf_mul(r.xx, dx), dx), crossed = wf_mul(r.xy, dx);
    s.exponent = wf_fma(dy, wf_fma(r.yy, dy, crossed), quadratic);
    float key = wf_fma(r.key_y, dy, wf_fma(r.key_x, dx, r.key));
    s.key = key;
    if (has(r.box, STEEP)) {
        s.key = wf_min(wf_max(key, r.key_low), r.bound_y);
        s.bound = bound_of(r, s.key, !has(view.flags, ORTHOGRAPHIC) && !(r.bound > 0.0));
    } else {
        s.bound = wf_fma(r.bound_y, dy, wf_fma(r.bound_x, dx, r.bound));
    }
    s.counts = s.exponent < exponent_end;
    return s;
}

Sample sample_ray(Record r, vec2 at, View view) {
    Sample s;
    s.share = 1.0;
    // ray_start()
    float depth = wf_div(1.0, r.key), x = wf_mul(r.key_x, depth), y = wf_mul(r.key_y, depth);
    float a = wf_mul(wf_mul(x, x), r.xx), b = wf_mul(wf_mul(wf_mul(2.0, x), y), r.xy), c = wf_mul(wf_mul(y, y), r.yy);
    float variance = wf_add(wf_add(a, b), c);
    float slope2 = wf_mul(view.cutoff2, variance > 0.0 ? variance : 0.0);
    float slope = wf_sqrt(slope2 < RAY_LIMIT2 ? slope2 : RAY_LIMIT2);
    float area = wf_div(wf_mul(r.peak, TWO_PI), view.sum_scale), area2 = wf_mul(area, area);
    float min_w = wf_div(1.0, wf_add(1.0, slope)), max_w = wf_div(1.0, wf_sub(1.0, slope));
    // ray_evaluate()
    float dx = wf_sub(at.x, r.cx), dy = wf_sub(at.y, r.cy), h2 = view.prefilter2_px2;
    float plane = wf_fma(r.key_x, dx, wf_fma(r.key_y, dy, r.key));
    float w = wf_clamp(wf_mul(plane, depth), min_w, max_w), w2 = wf_mul(w, w);
    float v11 = wf_fma(w2, r.xx, h2), v22 = wf_fma(w2, r.yy, h2), v12 = wf_mul(w2, r.xy);
    float unfiltered = wf_mul(wf_mul(w2, w2), area2);
    float det = wf_fma(h2, wf_fma(w2, wf_add(r.xx, r.yy), h2), unfiltered);
    float inverse_root = wf_inverse_root(det);
    float across = wf_fma(wf_mul(v22, dx), dx, wf_mul(wf_mul(v11, dy), dy));
    float form = wf_fnma(wf_mul(2.0, v12), wf_mul(dx, dy), across);
    float distance2 = wf_max(wf_mul(wf_mul(form, inverse_root), inverse_root), 0.0);
    s.exponent = wf_mul(distance2, view.exponent_scale);
    s.gain = wf_mul(w2, inverse_root);
    s.key = wf_clamp(plane, r.key_low, r.bound_y);
    s.bound = bound_of(r, s.key, !(r.bound > 0.0));
    s.counts = s.exponent < exponent_end;
    return s;
}

Sample sample_record(Record r, vec2 at, View view) {
#if RAYS
    return sample_ray(r, at, view);
#else
    return sample_splat(r, at, view);
#endif
}

#if WITH_NEARS
float linear(float terms[3], vec2 at) { return wf_fma(terms[1], at.x, wf_fma(terms[2], at.y, terms[0])); }

float key_of_depth(View view, float z) {
    return has(view.flags, ORTHOGRAPHIC) ? wf_negate(z) : wf_div(1.0, z);
}

Sample sample_near(Near r, vec2 at, View view) {
    Sample s;
    s.share = 1.0;
    float h2 = view.prefilter2_px2, inverse_ = wf_div(1.0, linear(r.w, at));
    float u = wf_mul(linear(r.u, at), inverse_), v = wf_mul(linear(r.v, at), inverse_);
    float z = wf_mul(linear(r.z, at), inverse_);
    float ux = wf_mul(wf_fnma(u, r.w[1], r.u[1]), inverse_), uy = wf_mul(wf_fnma(u, r.w[2], r.u[2]), inverse_);
    float vx = wf_mul(wf_fnma(v, r.w[1], r.v[1]), inverse_), vy = wf_mul(wf_fnma(v, r.w[2], r.v[2]), inverse_);
    float w11 = wf_fma(h2, wf_fma(ux, ux, wf_mul(uy, uy)), 1.0);
    float w22 = wf_fma(h2, wf_fma(vx, vx, wf_mul(vy, vy)), 1.0);
    float w12 = wf_mul(h2, wf_fma(ux, vx, wf_mul(uy, vy)));
    float crossed = wf_mul(h2, wf_fnma(uy, vx, wf_mul(ux, vy)));
    float det = wf_fma(crossed, crossed, wf_sub(wf_add(w11, w22), 1.0));
    float u2 = wf_mul(u, u), v2 = wf_mul(v, v);
    float numerator = wf_fma(w22, u2, wf_fma(w11, v2, wf_mul(wf_mul(-2.0, w12), wf_mul(u, v))));
    float r2 = wf_div(numerator, det);
    s.exponent = wf_max(wf_mul(r2, view.exponent_scale), 0.0);
    s.gain = wf_div(INVERSE_TWO_PI, wf_sqrt(det));
    s.counts = s.exponent < view.exponent_end && wf_add(u2, v2) < wf_mul(4.0, view.cutoff2);
    if (!has(view.flags, ORTHOGRAPHIC)) s.counts = s.counts && 0.0 < z;
    float depth = wf_min(wf_max(z, r.depth_low), r.depth_high);
    if (has(r.flags, CLIPPED)) clip_at(r.clip, at, s);
    s.key = key_of_depth(view, depth);
    s.bound = key_of_depth(view, wf_add(depth, r.tolerance));
    return s;
}
#endif
