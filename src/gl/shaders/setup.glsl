// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels to records: src/surface/pipeline_project.h, one lane of one packet in one field by each invocation,
// and how many records each tile gets. What pixel rays and clip lines need is asked of the host.

layout(local_size_x = 64) in;

layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
// Of the page, by [packet][lane]: halves of words, and bytes.
layout(std430, binding = 4) readonly buffer OpacityBlock { uint opacities[]; };
layout(std430, binding = 10) readonly buffer CurvatureBlock { uint curvatures[]; };
layout(std430, binding = 14) readonly buffer MaterialBlock { uint materials[]; };
layout(std430, binding = 5) writeonly buffer RecordBlock { Record records[]; };
layout(std430, binding = 11) writeonly buffer RequestBlock { uvec4 requests[]; }; // surfel, source, field; near ones, then those with lines

layout(location = 0) uniform uint page;
layout(location = 1) uniform uint part;

Segment segment;
View view;
uint view_flags;

struct Stage {
    bool alive;
    float z, ratio;
    vec3 n, axis;
    float base_x, base_y, dx, dy;
    float sigma, range, major, minor, part;
    float inverse_z, x0, y0, facing;
    float s11, s12, s22, s13, s23;
    float root_k, c1, c2;
    float xx, xy, yy, peak;
    float half_x, half_y, key_x, key_y;
};

Stage t;

vec3 decode_axis(uint code, vec3 n) {
    float a_code = wf_mul(float(code), UNIT_ANGLE);
    float c = wf_sub(1.0, a_code), s = wf_sub(1.0, wf_abs(c));
    float inverse = wf_inverse_root(wf_fma(c, c, wf_mul(s, s)));
    c = wf_mul(c, inverse);
    s = wf_mul(s, inverse);
    float sgn = n.z < 0.0 ? -1.0 : 1.0;
    float a = wf_div(-1.0, wf_add(sgn, n.z));
    float b = wf_mul(wf_mul(n.x, n.y), a);
    float ux = wf_fma(wf_mul(sgn, n.x), wf_mul(n.x, a), 1.0), uy = wf_mul(sgn, b);
    float uz = wf_negate(wf_mul(sgn, n.x)), vy = wf_fma(wf_mul(n.y, n.y), a, sgn);
    return vec3(wf_fma(c, ux, wf_mul(s, b)), wf_fma(c, uy, wf_mul(s, vy)), wf_fnma(s, n.y, wf_mul(c, uz)));
}

float decode_color(uint form, uint code) {
    bool with_sign = has(form, 0x8000u);
    int octave_bits = int(form >> 8 & 15u);
    uint e = form & 255u;
    if (!with_sign && octave_bits == 0)
        return wf_mul(float(code), uintBitsToFloat(floatBitsToUint(UNIT_U16) + ((e - 128u) << 23)));
    uint digits = with_sign ? 0x7fffu : 0xffffu;
    float unit = uintBitsToFloat((e - 1u) << 23);
    int shift = 7 + octave_bits + (with_sign ? 1 : 0);
    float octaves = uintBitsToFloat(((code & digits) << shift) + 0x3f800000u);
    float size = wf_fma(octaves, unit, wf_negate(unit));
    uint sign_bit = (code & (0xffffu - digits)) << 16;
    return uintBitsToFloat(floatBitsToUint(size) | sign_bit);
}

void place_surfel(uint base, uint lane, uint pair, uvec2 field) {
    float slope_x = pairs[pair].slope_x, slope_y = pairs[pair].slope_y;
    float rest_x = pairs[pair].rest_x, rest_y = pairs[pair].rest_y, depth = pairs[pair].depth;
    vec3 local = vec3(uintBitsToFloat(packets[base + lane]), uintBitsToFloat(packets[base + 16u + lane]),
                      uintBitsToFloat(packets[base + 32u + lane]));
    vec3 offset = rotate(view.rotation, local);
    precise double middle_x = double(field.x * 128u + 64u), middle_y = double(field.y * 128u + 64u);
    precise double along_x = double(slope_x) * view.focal_x, along_y = double(slope_y) * view.focal_y;
    precise double from_x = view.principal_x - middle_x, from_y = view.principal_y - middle_y;
    precise double base_x = along_x + from_x, base_y = along_y + from_y;
    t.base_x = float(base_x);
    t.base_y = float(base_y);
    t.z = wf_fma(view.scale, offset.z, depth);
    if (has(view_flags, ORTHOGRAPHIC)) {
        t.inverse_z = 1.0;
        t.x0 = 0.0;
        t.y0 = 0.0;
        t.dx = wf_fma(view.scale, offset.x, rest_x);
        t.dy = wf_fma(view.scale, offset.y, rest_y);
        return;
    }
    t.inverse_z = wf_div(1.0, t.z);
    t.dx = wf_mul(wf_fma(view.scale, wf_fnma(slope_x, offset.z, offset.x), rest_x), t.inverse_z);
    t.dy = wf_mul(wf_fma(view.scale, wf_fnma(slope_y, offset.z, offset.y), rest_y), t.inverse_z);
    t.x0 = wf_add(slope_x, t.dx);
    t.y0 = wf_add(slope_y, t.dy);
}

void place_point() {
    t.major = view.point_major;
    t.minor = view.point_minor;
    t.sigma = wf_mul(view.point_sigma, has(view_flags, ORTHOGRAPHIC) ? 1.0 : t.z);
    t.s11 = wf_mul(view.point_x, view.point_x);
    t.s22 = wf_mul(view.point_y, view.point_y);
    t.s12 = t.s13 = t.s23 = 0.0;
    t.n = vec3(0.0, 0.0, -1.0);
    t.facing = -1.0;
    t.range = t.part = 0.0;
    t.root_k = 1.0;
    t.alive = t.alive && 0.0 < t.z;
}

void stage_turn(uint base, uint lane) {
    vec3 n_world = make_unit(t.n);
    t.n = rotate(view.rotation, n_world);
    if (!has(view_flags, ELLIPSES)) return;
    t.axis = rotate(view.rotation, decode_axis(half_word(base + 80u, lane), n_world));
    float root = wf_mul(float(half_word(base + 88u, lane)), UNIT_U16), square = wf_mul(root, root);
    t.ratio = wf_mul(square, square);
}

// Returns whether the surfel is drawn by pixel rays.
bool stage_range() {
    bool ellipses = has(view_flags, ELLIPSES), orthographic = has(view_flags, ORTHOGRAPHIC);
    float part33 = wf_fma(t.n.x, t.n.x, wf_mul(t.n.y, t.n.y));
    if (ellipses) {
        float ratio2 = wf_mul(t.ratio, t.ratio);
        part33 = wf_fma(wf_sub(1.0, ratio2), wf_mul(t.axis.z, t.axis.z), wf_mul(ratio2, part33));
    }
    t.range = wf_mul(t.sigma, wf_sqrt(wf_mul(view.cutoff2, part33)));
    bool by_rays;
    if (orthographic) {
        t.alive = t.alive && 0.0 < t.z;
        t.facing = t.n.z;
        by_rays = view.broad < t.sigma;
    } else {
        t.alive = t.alive && wf_negate(t.range) < t.z;
        t.facing = wf_fma(t.n.x, t.x0, wf_fma(t.n.y, t.y0, t.n.z));
        by_rays = t.z <= wf_max(wf_mul(t.range, NEAR_RATIO), wf_mul(t.sigma, view.broad));
    }
    by_rays = t.alive && by_rays;
    t.alive = t.alive && !by_rays;
    if (has(view_flags, CULL_BACK)) t.alive = t.alive && t.facing < 0.0;
    t.part = orthographic ? 0.0 : wf_mul(t.range, t.inverse_z);
    t.root_k = orthographic ? 1.0 : wf_inverse_root(wf_fnma(t.part, t.part, 1.0));
    return by_rays;
}

void stage_covariance() {
    bool ellipses = has(view_flags, ELLIPSES);
    t.major = wf_mul(wf_mul(t.sigma, t.inverse_z), view.zoom);
    t.minor = ellipses ? wf_mul(t.major, t.ratio) : t.major;
    float minor2 = wf_mul(t.minor, t.minor);
    float m1 = wf_fnma(t.x0, t.n.z, t.n.x), m2 = wf_fnma(t.y0, t.n.z, t.n.y);
    t.s11 = wf_mul(minor2, wf_fnma(m1, m1, wf_fma(t.x0, t.x0, 1.0)));
    t.s22 = wf_mul(minor2, wf_fnma(m2, m2, wf_fma(t.y0, t.y0, 1.0)));
    t.s12 = wf_mul(minor2, wf_fnma(m1, m2, wf_mul(t.x0, t.y0)));
    t.s13 = wf_mul(wf_negate(minor2), wf_fma(m1, t.n.z, t.x0));
    t.s23 = wf_mul(wf_negate(minor2), wf_fma(m2, t.n.z, t.y0));
    if (ellipses) {
        float ratio2 = wf_mul(t.ratio, t.ratio);
        float extra = wf_mul(wf_mul(t.major, t.major), wf_sub(1.0, ratio2));
        float b1 = wf_fnma(t.x0, t.axis.z, t.axis.x), b2 = wf_fnma(t.y0, t.axis.z, t.axis.y);
        float e1 = wf_mul(extra, b1), e2 = wf_mul(extra, b2);
        t.s11 = wf_fma(e1, b1, t.s11);
        t.s12 = wf_fma(e1, b2, t.s12);
        t.s22 = wf_fma(e2, b2, t.s22);
        t.s13 = wf_fma(e1, t.axis.z, t.s13);
        t.s23 = wf_fma(e2, t.axis.z, t.s23);
    }
}

void source_shape(float v11, float v12, float v22, float root_det) {
    float h2 = view.prefilter2_px2;
    float minimum = wf_mul(SINGULAR, wf_mul(v11, v22));
    bool invertible = minimum <= wf_mul(root_det, root_det) && MIN_AREA <= root_det;
    t.alive = t.alive && invertible;
    root_det = invertible ? root_det : 1.0;
    float trace = wf_add(wf_add(v11, v22), wf_add(root_det, root_det));
    float inverse_det = wf_reciprocal(root_det), scale = wf_mul(wf_inverse_root(trace), inverse_det);
    float a11 = wf_mul(wf_add(v22, root_det), scale), a22 = wf_mul(wf_add(v11, root_det), scale);
    float a12 = wf_negate(wf_mul(v12, scale));
    float along_x = wf_fma(a11, a11, wf_mul(a12, a12)), along_y = wf_fma(a22, a22, wf_mul(a12, a12));
    float crossed = wf_mul(a12, wf_add(a11, a22));
    float filtered = wf_mul(h2, wf_mul(inverse_det, inverse_det));
    float determinant_ = wf_fma(h2, wf_add(wf_add(along_x, along_y), filtered), 1.0);
    float inverse_root = wf_inverse_root(determinant_);
    float scaled = wf_mul(wf_mul(inverse_root, inverse_root), view.exponent_scale);
    t.peak = wf_mul(inverse_root, INVERSE_TWO_PI);
    t.xx = wf_mul(wf_add(along_x, filtered), scaled);
    t.xy = wf_mul(wf_mul(crossed, 2.0), scaled);
    t.yy = wf_mul(wf_add(along_y, filtered), scaled);
}

void circular_shape(float w11, float w12, float w22, float root_det) {
    float mean = wf_mul(0.5, wf_add(w11, w22)), difference = wf_sub(mean, w22);
    float variance = wf_add(mean, wf_sqrt(wf_fma(difference, difference, wf_mul(w12, w12))));
    float inverse_ = wf_div(1.0, variance);
    t.peak = wf_mul(wf_mul(root_det, inverse_), INVERSE_TWO_PI);
    t.xx = t.yy = wf_mul(inverse_, view.exponent_scale);
    t.xy = 0.0;
    t.half_x = t.half_y = wf_mul(view.cutoff, wf_sqrt(variance));
}

void raycast_shape(float v11, float v12, float v22, float root_det) {
    float h2 = view.prefilter2_px2;
    float maximum = wf_mul(wf_add(1.0, t.part), wf_mul(t.root_k, t.root_k)), max2 = wf_mul(maximum, maximum);
    t.xx = v11;
    t.xy = v12;
    t.yy = v22;
    t.peak = wf_mul(root_det, INVERSE_TWO_PI);
    t.half_x = wf_mul(view.cutoff, wf_sqrt(wf_fma(max2, v11, h2)));
    t.half_y = wf_mul(view.cutoff, wf_sqrt(wf_fma(max2, v22, h2)));
}

void stage_shape() {
    float fx = view.fx_zoomed, fy = view.fy_zoomed;
    bool affine = has(view_flags, AFFINE), orthographic = has(view_flags, ORTHOGRAPHIC);
    float root_k = affine ? 1.0 : t.root_k, k = wf_mul(root_k, root_k);
    t.c1 = t.c2 = 0.0;
    if (!affine && !orthographic) {
        float f2k = wf_mul(view.center_scale, k);
        t.c1 = wf_mul(f2k, t.s13);
        t.c2 = wf_mul(f2k, t.s23);
    }
    float c1f = wf_mul(t.c1, view.inverse_cutoff), c2f = wf_mul(t.c2, view.inverse_cutoff);
    float v11 = wf_mul(wf_mul(fx, fx), wf_fma(c1f, c1f, wf_mul(t.s11, k)));
    float v22 = wf_mul(wf_mul(fy, fy), wf_fma(c2f, c2f, wf_mul(t.s22, k)));
    float v12 = wf_mul(wf_mul(fx, fy), wf_fma(c1f, c2f, wf_mul(t.s12, k)));
    float area = wf_mul(wf_mul(wf_mul(t.minor, t.major), wf_mul(fx, fy)), t.facing);
    float root_det = wf_mul(wf_abs(area), wf_mul(k, root_k));
    float h2 = view.prefilter2_px2;
    float w11 = wf_add(v11, h2), w22 = wf_add(v22, h2);
    float det_filtered = wf_fma(h2, wf_add(wf_add(v11, v22), h2), wf_mul(root_det, root_det));
    t.alive = t.alive && wf_mul(FLAT, wf_mul(w11, w22)) < det_filtered;
    t.alive = t.alive && MIN_SPLAT <= root_det;
    float inverse_root_det = wf_inverse_root(det_filtered);
    float scaled = wf_mul(wf_mul(inverse_root_det, inverse_root_det), view.exponent_scale);
    t.peak = wf_mul(wf_mul(root_det, inverse_root_det), INVERSE_TWO_PI);
    t.xx = wf_mul(w22, scaled);
    t.xy = wf_mul(wf_mul(v12, -2.0), scaled);
    t.yy = wf_mul(w11, scaled);
    t.half_x = wf_mul(view.cutoff, wf_sqrt(w11));
    t.half_y = wf_mul(view.cutoff, wf_sqrt(w22));
    float ray2 = wf_fma(t.x0, t.x0, wf_fma(t.y0, t.y0, 1.0));
    if (has(view_flags, SOURCE))
        source_shape(v11, v12, v22, root_det);
    else if (has(view_flags, CIRCULAR))
        circular_shape(w11, v12, w22, root_det);
    else if (has(view_flags, RAYCAST))
        raycast_shape(v11, v12, v22, root_det);
    float edge_on = wf_mul(EDGE_ON2, ray2), facing2 = wf_mul(t.facing, t.facing);
    if (has(view_flags, RAYCAST)) t.alive = t.alive && edge_on <= facing2;
    float raised2 = wf_max(facing2, edge_on);
    float tilt = wf_mul(wf_inverse_root(raised2), t.inverse_z);
    float signed_tilt = t.facing < 0.0 ? wf_negate(tilt) : tilt;
    t.key_x = wf_mul(wf_mul(t.n.x, signed_tilt), view.inverse_fx);
    t.key_y = wf_mul(wf_mul(t.n.y, signed_tilt), view.inverse_fy);
}

float whole_place(float center_px) {
    float power = uintBitsToFloat(floatBitsToUint(center_px) & 0x7f800000u);
    float bias = wf_mul(wf_max(power, FIELD_PX / 4.0), 6.0);
    return wf_sub(wf_add(center_px, bias), bias);
}

// How far the splat moves away from its contour (semantics.h, section 5): pixels, and what of the key that is.
vec3 contour_way(uint surfel, float slope, bool clipped, out bool concave) {
    concave = false;
    uint word = curvatures[surfel / 2u];
    float curvature = uintBitsToFloat((surfel & 1u) != 0u ? word & 0xffff0000u : word << 16);
    float bend = wf_mul(wf_max(curvature, 0.0), view.curvature_scale);
    if (!has(view_flags, ORTHOGRAPHIC)) bend = wf_mul(bend, t.z);
    bend = wf_min(bend, 1e30);
    float sine2 = wf_mul(t.facing, t.facing), size = wf_mul(t.major, wf_mul(CONTOUR_WIDTH, view.fx_zoomed));
    float across = wf_sqrt(wf_fma(wf_mul(size, size), sine2, view.prefilter2_px2));
    float reach = wf_min(wf_mul(wf_mul(across, bend), CONTOUR_REACH), view.contour_sine2);
    if (clipped || !(sine2 < reach) || !(0.0 < slope)) return vec3(0.0);
    float share = wf_sub(1.0, wf_div(sine2, reach)), way = wf_mul(wf_mul(across, view.contour_shift), share);
    bool turns_away = t.facing < 0.0;
    concave = !turns_away && CONTOUR_CONCAVE < share && !has(view_flags, SEE_THROUGH);
    float along = wf_div(turns_away ? way : wf_negate(way), slope);
    return vec3(wf_mul(t.key_x, along), wf_mul(t.key_y, along), wf_mul(wf_mul(slope, slope), along));
}

void count_tiles(uvec2 field, uint box) {
    uvec2 first, last;
    tiles_of(field, box, first, last);
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++) atomicAdd(tiles[y * tiles_per_row + x].count, 1u);
}

// Asks the host for something of a surfel; returns where it will be.
uint request(uint first, uint number, uint pair, uint lane) {
    if (number < request_capacity)
        requests[first + number] = uvec4((segment.first + pairs[pair].packet - segment.at) * 16u + lane, segment.source, pairs[pair].field, 0u);
    return number;
}

void emit(uint base, uint lane, uint pair, uvec2 field, uint at) {
    bool orthographic = has(view_flags, ORTHOGRAPHIC), circular = has(view_flags, CIRCULAR);
    bool clipped = has(pairs[pair].lanes >> 16, 1u << lane);
    float c1_px = wf_mul(t.c1, view.fx_zoomed), c2_px = wf_mul(t.c2, view.fy_zoomed);
    float slope = wf_sqrt(wf_fma(t.key_x, t.key_x, wf_mul(t.key_y, t.key_y)));
    float support = wf_mul(view.cutoff, t.sigma), reach = wf_mul(view.reach_px, slope);
    float key, key_low, key_high, reach_depth = reach;
    float limit = wf_min(wf_mul(FREE_RADII, support), wf_mul(FREE_DEPTH, t.z));
    if (orthographic) {
        key = wf_negate(t.z);
        key_low = wf_negate(wf_add(t.z, t.range));
        key_high = wf_sub(t.range, t.z);
    } else {
        float k = wf_mul(wf_mul(t.root_k, t.root_k), t.inverse_z);
        key = wf_fma(t.key_x, c1_px, wf_fma(t.key_y, c2_px, t.inverse_z));
        key_low = wf_mul(wf_sub(1.0, t.part), k);
        key_high = wf_mul(wf_add(1.0, t.part), k);
        reach_depth = wf_mul(wf_mul(reach, t.z), t.z);
        limit = wf_mul(wf_mul(limit, t.inverse_z), t.inverse_z);
    }
    float place_x = wf_add(wf_fma(t.dx, view.fx_px, t.base_x), c1_px), beyond = reach;
    float place_y = wf_add(wf_fma(t.dy, view.fy_px, t.base_y), c2_px);
    bool concave = false;
    if (has(segment.streams, CURVATURES)) {
        vec3 way = contour_way(pairs[pair].packet * 16u + lane, slope, clipped, concave);
        key = wf_add(key, way.z);
        beyond = wf_add(beyond, wf_abs(way.z));
        place_x = wf_add(place_x, way.x);
        place_y = wf_add(place_y, way.y);
    }
    float margin = wf_max(wf_sub(limit, reach), 0.0);
    if (circular) {
        float maximum = wf_mul(GRAZING_TOLERANCE, support);
        float max_key = orthographic ? maximum : wf_mul(wf_mul(maximum, t.inverse_z), t.inverse_z);
        margin = wf_add(margin, wf_min(wf_mul(t.half_x, slope), max_key));
    }
    float grazing = wf_min(wf_mul(view.grazing, reach_depth), wf_mul(GRAZING_TOLERANCE, support));
    float tolerance = wf_fma(view.tolerance, t.sigma, grazing);
    float cx = whole_place(place_x), cy = whole_place(place_y);
    const float left = -FIELD_PX / 2.0;
    uvec2 size_px = min(picture_px - field * 128u, uvec2(128u));
    float whole_first_x = wf_add(floor(wf_sub(wf_sub(cx, t.half_x), 0.5)), 1.0);
    float whole_last_x = floor(wf_sub(wf_add(cx, t.half_x), 0.5));
    float first_x = wf_sub(wf_max(whole_first_x, left), left);
    float first_y = wf_sub(wf_max(wf_add(floor(wf_sub(wf_sub(cy, t.half_y), 0.5)), 1.0), left), left);
    float last_x = wf_min(wf_sub(whole_last_x, left), float(size_px.x - 1u));
    float last_y = wf_min(wf_sub(floor(wf_sub(wf_add(cy, t.half_y), 0.5)), left), float(size_px.y - 1u));
    if (!(t.alive && first_x <= last_x && first_y <= last_y)) return;
    uint column = uint(first_x) >> 2, row = uint(first_y) >> 2;
    uint columns = (uint(last_x) >> 2) - column + 1u, rows = (uint(last_y) >> 2) - row + 1u;
    bool wide = 8.0 < wf_max(t.half_x, t.half_y);
    if (6.0 < t.half_x) {
        float whole_columns = wf_sub(floor(wf_mul(whole_last_x, 0.25)), floor(wf_mul(whole_first_x, 0.25)));
        wide = wide || 4.0 <= whole_columns;
    }
    float min_key = wf_fnma(wf_abs(t.key_x), t.half_x, wf_fnma(wf_abs(t.key_y), t.half_y, key));
    float lowest = wf_sub(key_low, margin);
    if (circular && !orthographic) lowest = wf_max(lowest, wf_mul(MIN_KEY, t.inverse_z));
    if (!orthographic) wide = wide || wf_max(min_key, lowest) < wf_mul(TANGENT_KEY, key);
    if (circular) wide = true;
    bool steep = wide || has(view_flags, AFFINE) || margin < beyond;
    float bound_scale = 1.0, bound_offset = wf_negate(tolerance);
    if (!orthographic) {
        float share = wf_div(t.z, wf_add(t.z, tolerance)), share2 = wf_mul(share, share);
        bound_scale = wide ? 0.0 : share2;
        bound_offset = wide ? tolerance : wf_mul(wf_sub(share, share2), t.inverse_z);
    }
    bool is_back = 0.0 < t.facing;
    float opacity = t.peak;
    if (has(segment.streams, OPACITIES)) {
        uint index = pairs[pair].packet * 16u + lane, word = opacities[index / 2u];
        uint code = (index & 1u) != 0u ? word >> 16 : word & 0xffffu;
        opacity = wf_mul(t.peak, wf_mul(float(code), UNIT_U16));
    }
    uint material = pairs[pair].form >> 16 & 0xffu;
    if (has(segment.streams, MATERIALS)) {
        uint index = pairs[pair].packet * 16u + lane;
        material = materials[index / 4u] >> (index & 3u) * 8u & 0xffu;
    }
    float color_units = wf_mul(opacity, view.color_scale);
    uint form = pairs[pair].form & 0xffffu;
    float peak_units = wf_mul(t.peak, view.sum_scale);
    float facing_peak = is_back ? wf_negate(peak_units) : peak_units;
    Record r;
    r.cx = cx;
    r.cy = cy;
    r.xx = t.xx;
    r.xy = t.xy;
    r.yy = t.yy;
    r.key = key;
    r.key_x = t.key_x;
    r.key_y = t.key_y;
    r.bound = steep ? bound_scale : wf_fma(bound_scale, key, bound_offset);
    r.bound_x = steep ? bound_offset : wf_mul(bound_scale, t.key_x);
    r.bound_y = steep ? wf_add(key_high, margin) : wf_mul(bound_scale, t.key_y);
    r.key_low = steep ? lowest : min_key;
    r.red = wf_odd_product(color_units, decode_color(form, half_word(base + 96u, lane)));
    r.green = wf_odd_product(color_units, decode_color(form, half_word(base + 104u, lane)));
    r.blue = wf_odd_product(color_units, decode_color(form, half_word(base + 112u, lane)));
    r.box = column | row << 8 | columns << 16 | rows << 24 | (steep ? STEEP : 0u) | (clipped ? CLIPPED : 0u) |
            (concave ? CONCAVE : 0u) | (is_back ? BACK_FACING : 0u);
    r.nx = wf_odd_product(facing_peak, t.n.x);
    r.ny = wf_odd_product(facing_peak, t.n.y);
    r.nz = wf_odd_product(facing_peak, t.n.z);
    r.peak = wf_odd(peak_units);
    r.opacity = wf_odd_product(opacity, view.sum_scale);
    r.extra = material | segment.source << 8;
    r.field = field.x | field.y << 16;
    r.clip = clipped ? request(request_capacity, atomicAdd(clip_count, 1u), pair, lane) : 0u;
    records[at] = r;
    count_tiles(field, r.box);
}

void main() {
    uint index = (group_number() * parts + part) * 64u + gl_LocalInvocationID.x, lane = index & 15u;
    uint before = page == 0u ? 0u : arguments[OF_PAGES + page - 1u].w, pair = before + index / 16u;
    if (pair >= arguments[OF_PAGES + page].w) return;
    uint at = pair * 16u + lane;
    segment = segments[pairs[pair].segment];
    view = views[segment.source];
    view_flags = view.flags;
    uint base = pairs[pair].packet * uint(PACKET_WORDS);
    uvec2 field = uvec2(pairs[pair].field & 0xffffu, pairs[pair].field >> 16);
    records[at].box = 0u;
    place_surfel(base, lane, pair, field);
    t.sigma = wf_mul(uintBitsToFloat(packets[base + 48u + lane]), view.scale);
    t.alive = 0.0 < t.sigma && has(pairs[pair].lanes, 1u << lane);
    if (has(view_flags, POINTS)) {
        place_point();
    } else {
        t.n = decode_normal(base, lane);
        stage_turn(base, lane);
        if (is_billboard(base, lane)) t.n = vec3(0.0, 0.0, -1.0);
        if (stage_range()) request(0u, atomicAdd(near_count, 1u), pair, lane);
        stage_covariance();
    }
    stage_shape();
    if (t.alive) emit(base, lane, pair, field, at);
}
