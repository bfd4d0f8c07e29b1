// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Composites a tile's splats, front to back: src/volume/gaussian_draw.h by the order of centres. A quarter of a tile by each group,
// a pixel by each invocation. First an invocation is a splat: it finds the blocks of 4x4 pixels that this touches, as
// gaussian_draw.h marks them. Then it is a pixel, and goes through those of its block. After gaussian_frame.glsl and codes.glsl.

const uint TILE_SIDE = 32u, BATCH = 256u;

layout(std430, binding = 0) readonly buffer TileBlock { uint tiles[]; };     // [pair], in order
layout(std430, binding = 1) readonly buffer RecordNumberBlock { uint numbers[]; }; // [pair]
layout(std430, binding = 2) readonly buffer RecordBlock { vec4 records[]; };
layout(std430, binding = 3) writeonly buffer ResultBlock { uint result[]; };

layout(location = 0) uniform uint first_tile; // of the dispatch

shared vec4 batch[BATCH * 3u];
#if DEEP
shared uint batch_numbers[BATCH];
#endif
shared uint touching[16][BATCH / 32u]; // [block of 4x4 pixels] bits of splats
shared uint ends[2], some_open, shown[16];

// How far an ellipse reaches to the right within rows; gaussian_draw.h.
float side_of(float top, float bottom, float touch, float lean, float by, float limit, float root) {
    float v = wf_min(wf_max(touch, top), bottom), down = wf_mul(by, v);
    return wf_fma(lean, v, wf_mul(root, wf_sqrt(wf_max(wf_fnma(down, down, limit), 0.0))));
}

// Marks the blocks that splat `slot` of the batch may touch, of the quarter at `quarter` in blocks of a tile at `tile_px`.
void mark(uint slot, uvec2 tile_px, uvec2 quarter) {
    vec4 a = batch[slot * 3u], b = batch[slot * 3u + 1u];
    float touch = batch[slot * 3u + 2u].x, by = b.x, limit = b.y, reach = b.w;
    float root = wf_div(1.0, a.z), lean = wf_mul(wf_sub(0.0, a.w), root), x = wf_sub(a.x, float(tile_px.x));
    for (uint row = 0u; row < 4u; row++) {
        float top = wf_sub(float(tile_px.y + 4u * (quarter.y + row)) + 0.5, a.y), bottom = wf_add(top, 3.0);
        if (!(top <= reach && wf_sub(0.0, reach) <= bottom)) continue;
        float v_low = wf_max(top, wf_sub(0.0, reach)), v_high = wf_min(bottom, reach);
        float right = wf_add(x, side_of(v_low, v_high, touch, lean, by, limit, root));
        float left = wf_sub(x, side_of(wf_sub(0.0, v_high), wf_sub(0.0, v_low), touch, lean, by, limit, root));
        float begin = floor(wf_mul(wf_sub(left, MARK_SLACK), 0.25)), end = floor(wf_mul(wf_add(right, MARK_SLACK), 0.25));
        float low = wf_min(wf_max(wf_add(begin, 1.0), 0.0), 8.0), high = wf_min(wf_max(end, low), 8.0);
        for (uint column = 0u; column < 4u; column++) {
            float at = float(quarter.x + column);
            if (low <= at && at < high) atomicOr(touching[4u * row + column][slot / 32u], 1u << slot % 32u);
        }
    }
}

#if DEEP
// How a pixel's ray passes a splat: its distance in standard deviations squared, its depth there; whether that is ahead.
bool closest(uint number, float u, float v, float limit, out float distance2, out float z) {
    vec4 p = records[number * RECORD_PARTS + 3u], q = records[number * RECORD_PARTS + 4u], r = records[number * RECORD_PARTS + 5u];
    vec3 g = vec3(wf_fma(u, p.x, wf_fma(v, p.y, p.z)), wf_fma(u, p.w, wf_fma(v, q.x, q.y)), wf_fma(u, q.z, wf_fma(v, q.w, r.x)));
    float length_ = r.y, lateral2 = wf_fma(g.x, g.x, wf_mul(g.y, g.y));
    bool ahead;
    distance2 = lateral2;
    z = g.z;
    if (orthographic != 0u) {
        ahead = lateral2 < limit;
    } else {
        float square = wf_fma(g.z, g.z, lateral2), far2 = wf_mul(wf_mul(length_, length_), lateral2);
        ahead = far2 < wf_mul(limit, square) && 0.0 < g.z;
        float variance = wf_div(1.0, square);
        distance2 = wf_mul(far2, variance);
        z = wf_mul(wf_mul(length_, g.z), variance);
    }
    z = wf_min(wf_max(z, r.z), r.w);
    return ahead;
}
#endif

// Whether a pixel whose centre is (x, y) shows a splat of the batch; sets its alpha and its depth.
bool hit(uint slot, float x, float y, out float alpha, out float z) {
    vec4 a = batch[slot * 3u], b = batch[slot * 3u + 1u];
    float u = wf_sub(x, a.x), v = wf_sub(y, a.y), limit = b.y, m2;
    bool inside;
    z = 0.0;
    alpha = 0.0;
#if DEEP
    uint number = batch_numbers[slot];
#endif
#if DOTS
    vec4 spot = records[number * RECORD_PARTS + 6u];
    if (0.0 < spot.x) {
        bool ahead = closest(number, u, v, limit, m2, z);
        float dot_x = wf_sub(u, spot.y), dot_y = wf_sub(v, spot.z), dot2 = wf_mul(spot.x, wf_fma(dot_x, dot_x, wf_mul(dot_y, dot_y)));
        float crossed2 = ahead && near_depth <= z ? m2 : INF;
        bool crossed = crossed2 <= dot2;
        m2 = wf_min(crossed2, dot2);
        inside = m2 < limit;
        vec2 depths = records[number * RECORD_PARTS + 5u].zw;
        z = wf_min(wf_max(crossed ? z : spot.w, depths.x), depths.y);
    } else
#endif
#if DEEP
    if (trained == 0u) {
        inside = closest(number, u, v, limit, m2, z);
    } else
#endif
    {
        float across = wf_fma(u, a.z, wf_mul(v, a.w)), down = wf_mul(v, b.x);
        m2 = wf_fma(across, across, wf_mul(down, down));
        inside = m2 < limit;
#if DEEP
        float unused;
        if (inside) closest(number, u, v, limit, unused, z);
#endif
    }
    if (!inside) return false;
    alpha = wf_exp2(wf_fma(m2, HALF_LOG2_E, b.z));
    if (keep != 0u && !(minimum_alpha <= alpha)) return false;
    alpha = wf_min(alpha, MAX_ALPHA);
    z = wf_add(z, 0.0);
    return true;
}

// Display values: src/volume/kernels_display.h.
float curve_power(float x, float exponent) {
    return wf_exp2(wf_mul(exponent, wf_log2(wf_min(wf_max(x, CURVE_LOWEST), CURVE_HIGHEST))));
}
float display_of_linear(float x) {
    float curve = wf_fma(1.055, curve_power(x, CURVE_ENCODE), -0.055);
    return x <= 0.0031308 ? wf_mul(x, 12.92) : curve;
}
float linear_of_display(float x) {
    float curve = curve_power(wf_fma(x, CURVE_UNSCALE, CURVE_UNSHIFT), 2.4);
    return x <= 0.04045 ? wf_mul(x, CURVE_UNSLOPE) : curve;
}
float straighten(float alpha) { return wf_keep(0.0 < alpha, wf_div(1.0, 0.0 < alpha ? alpha : 1.0)); }

// The light of a pixel over what is behind it. `display`: some pixel of its block shows a splat.
vec4 lay_over(vec3 light, float through, bool display) {
    vec4 under = background, color;
    if (normals != 0u) {
        for (int c = 0; c < 3; c++) color[c] = wf_fma(through, under[c], light[c]);
        color.a = wf_fma(through, under.a, wf_sub(1.0, through));
        return color;
    }
    float inverse_ = straighten(under.a);
    for (int c = 0; c < 3 && display; c++) under[c] = wf_mul(display_of_linear(wf_mul(under[c], inverse_)), under.a);
    for (int c = 0; c < 3; c++) color[c] = wf_fma(through, under[c], light[c]);
    color.a = wf_fma(through, under.a, wf_sub(1.0, through));
    inverse_ = straighten(color.a);
    for (int c = 0; c < 3 && display; c++) color[c] = wf_mul(linear_of_display(wf_mul(color[c], inverse_)), color.a);
    return color;
}

float camera_depth(float z) {
    if (!(z < INF)) return z;
    precise double depth = double(z) * unit_camera;
    return float(depth);
}

void write_pixel(uint pixel, vec4 color, float through, float depth) {
    float opacity = wf_sub(1.0, through);
    if (with_codes != 0u) result[pixel] = color_code(color);
    if (rgba_at >= 0)
        for (uint c = 0u; c < 4u; c++) result[uint(rgba_at) + pixel * 4u + c] = floatBitsToUint(color[c]);
    if (expected != 0u) depth = opacity > 0.0 ? wf_div(depth, opacity) : INF;
    if (depth_at >= 0) result[uint(depth_at) + pixel] = floatBitsToUint(camera_depth(depth));
    if (coverage_at >= 0) result[uint(coverage_at) + pixel] = floatBitsToUint(opacity);
}

// The first pair of a tile or of those behind it.
uint first_pair(uint tile, uint pairs) {
    uint low = 0u, high = pairs;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (tiles[middle] < tile) low = middle + 1u;
        else high = middle;
    }
    return low;
}

// Whether the driver still lets loops run: see edges.glsl.
bool loops_go_on() {
    uint turns = 0u, wanted = 2u + min(tile_count, 2u); // more than one, and not known to a compiler
    for (uint i = 0u; i < wanted; i++) turns++;
    return turns == wanted;
}

void main() {
    uint work = group_number(), tile = first_tile + work / 4u, thread = gl_LocalInvocationIndex;
    // Two blocks of pixels lie next to each other in memory and in what a device runs together.
    uint block = thread / 16u, in_block = thread % 16u;
    uvec2 tile_px = uvec2(tile % tiles_per_row, tile / tiles_per_row) * TILE_SIDE, quarter = uvec2(work % 2u, work / 2u % 2u) * 4u;
    uvec2 pixel = tile_px + 4u * (quarter + uvec2(block % 4u, block / 4u)) + uvec2(in_block % 4u, in_block / 4u);
    bool inside = tile < tile_count && all(lessThan(pixel, picture_px)), open = inside;
    uint pairs = pair_count <= pair_capacity ? pair_count : 0u;
    if (thread < 2u) ends[thread] = first_pair(tile + thread, pairs);
    if (thread < 128u) touching[thread / 8u][thread % 8u] = 0u;
    if (thread < 16u) shown[thread] = 0u;
    barrier();
    uint first = ends[0], end = ends[1];
    float x = float(pixel.x) + 0.5, y = float(pixel.y) + 0.5, through = 1.0, depth = expected != 0u ? 0.0 : INF;
    vec3 light = vec3(0.0);
    for (uint at = first; at < end; at += BATCH) {
        if (thread == 0u) some_open = 0u;
        barrier();
        if (open) some_open = 1u;
        if (at + thread < end) {
            uint number = numbers[at + thread];
            for (uint i = 0u; i < 3u; i++) batch[thread * 3u + i] = records[number * RECORD_PARTS + i];
#if DEEP
            batch_numbers[thread] = number;
#endif
            mark(thread, tile_px, quarter);
        }
        barrier();
        if (some_open == 0u) break;
        for (uint word = 0u; word < BATCH / 32u && open; word++) {
            uint bits = touching[block][word];
            while (bits != 0u && open) {
                uint slot = word * 32u + uint(findLSB(bits));
                bits &= bits - 1u;
                float alpha, z;
                if (!hit(slot, x, y, alpha, z)) continue;
                float weight = wf_mul(through, alpha), rest = wf_sub(through, weight);
                if (expected != 0u) depth = wf_fma(weight, z, depth);
                else if (0.5 < through && rest <= 0.5) depth = z;
                for (int c = 0; c < 3; c++) light[c] = wf_fma(weight, batch[slot * 3u + 2u][c + 1], light[c]);
                through = rest;
                open = minimum_transmittance <= rest;
            }
        }
        barrier();
        if (thread < 128u) touching[thread / 8u][thread % 8u] = 0u;
    }
    if (through < 1.0) atomicOr(shown[block], 1u);
    barrier();
    if (inside) write_pixel(pixel.y * picture_px.x + pixel.x, lay_over(light, through, shown[block] != 0u), through, depth);
    if (!loops_go_on()) atomicAdd(stopped_count, 1u);
}
