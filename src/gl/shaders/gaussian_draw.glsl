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
#if AMONG
layout(std430, binding = 4) readonly buffer SurfaceBlock { float surfaces[]; }; // planes: depth, rgba, coverage
#endif

layout(location = 0) uniform uint first_tile; // of the dispatch

shared vec4 batch[BATCH * 3u];
#if DEEP
shared uint batch_numbers[BATCH];
#endif
shared uint touching[16][BATCH / 32u]; // [block of 4x4 pixels] bits of splats
shared uint ends[2], some_open, shown[16];

#if AMONG
float enter_depth, end_depth; // of the pixel's ray: what lies between counts
#endif

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
// How a pixel's ray passes a splat: its distance in standard deviations squared, its depth there and the variance of that; whether
// it is ahead.
bool closest(uint number, float u, float v, float limit, out float distance2, out float z, out float variance) {
    vec4 p = records[number * RECORD_PARTS + 3u], q = records[number * RECORD_PARTS + 4u], r = records[number * RECORD_PARTS + 5u];
    vec3 g = vec3(wf_fma(u, p.x, wf_fma(v, p.y, p.z)), wf_fma(u, p.w, wf_fma(v, q.x, q.y)), wf_fma(u, q.z, wf_fma(v, q.w, r.x)));
    float length_ = r.y, lateral2 = wf_fma(g.x, g.x, wf_mul(g.y, g.y));
    bool ahead;
    distance2 = lateral2;
    z = g.z;
    if (orthographic != 0u) {
        ahead = lateral2 < limit;
        variance = wf_div(1.0, wf_mul(length_, length_));
    } else {
        float square = wf_fma(g.z, g.z, lateral2), far2 = wf_mul(wf_mul(length_, length_), lateral2);
        ahead = far2 < wf_mul(limit, square) && 0.0 < g.z;
        variance = wf_div(1.0, square);
        distance2 = wf_mul(far2, variance);
        z = wf_mul(wf_mul(length_, g.z), variance);
    }
    z = wf_min(wf_max(z, r.z), r.w);
    return ahead;
}
#endif

#if AMONG
// What of a splat lies between the ends of the pixel's ray.
float share_within(float z, float variance) {
    float deviation = wf_max(wf_sqrt(variance), THINNEST);
    float share = share_below(wf_div(wf_sub(end_depth, z), deviation));
    if (section_count == 0u) return share;
    return wf_max(wf_sub(share, share_below(wf_div(wf_sub(enter_depth, z), deviation))), 0.0);
}
#endif

// Whether a pixel whose centre is (x, y) shows a splat of the batch; sets its alpha and its depth.
bool hit(uint slot, float x, float y, out float alpha, out float z) {
    vec4 a = batch[slot * 3u], b = batch[slot * 3u + 1u];
    float u = wf_sub(x, a.x), v = wf_sub(y, a.y), limit = b.y, m2, variance = 0.0;
    bool inside;
    z = 0.0;
    alpha = 0.0;
#if DEEP
    uint number = batch_numbers[slot];
#endif
#if DOTS
    vec4 spot = records[number * RECORD_PARTS + 6u];
    if (0.0 < spot.x) {
        bool ahead = closest(number, u, v, limit, m2, z, variance);
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
        inside = closest(number, u, v, limit, m2, z, variance);
    } else
#endif
    {
        float across = wf_fma(u, a.z, wf_mul(v, a.w)), down = wf_mul(v, b.x);
        m2 = wf_fma(across, across, wf_mul(down, down));
        inside = m2 < limit;
#if DEEP
        float unused;
        if (inside) closest(number, u, v, limit, unused, z, variance);
#endif
    }
    if (!inside) return false;
    alpha = wf_exp2(wf_fma(m2, HALF_LOG2_E, b.z));
    if (keep != 0u && !(minimum_alpha <= alpha)) return false;
    alpha = wf_min(alpha, MAX_ALPHA);
#if AMONG
    alpha = wf_mul(alpha, share_within(z, variance));
#endif
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

// What a pixel has composited.
struct Light {
    vec3 color;
    float through, depth;
    bool display; // some pixel of its block shows a splat
};

// The light of a pixel over what is behind it.
vec4 lay_over(Light of, vec4 under) {
    vec4 color;
    float through = of.through;
    if (normals != 0u) {
        for (int c = 0; c < 3; c++) color[c] = wf_fma(through, under[c], of.color[c]);
        color.a = wf_fma(through, under.a, wf_sub(1.0, through));
        return color;
    }
    float inverse_ = straighten(under.a);
    for (int c = 0; c < 3 && of.display; c++) under[c] = wf_mul(display_of_linear(wf_mul(under[c], inverse_)), under.a);
    for (int c = 0; c < 3; c++) color[c] = wf_fma(through, under[c], of.color[c]);
    color.a = wf_fma(through, under.a, wf_sub(1.0, through));
    inverse_ = straighten(color.a);
    for (int c = 0; c < 3 && of.display; c++) color[c] = wf_mul(linear_of_display(wf_mul(color[c], inverse_)), color.a);
    return color;
}

float camera_depth(float z) {
    if (!(z < INF)) return z;
    precise double depth = double(z) * unit_camera;
    return float(depth);
}

// Writes what there is of a pixel; `depth` is in camera space.
void write_planes(uint pixel, vec4 color, float depth, float coverage) {
    if (with_codes != 0u) result[pixel] = color_code(color);
    if (rgba_at >= 0)
        for (uint c = 0u; c < 4u; c++) result[uint(rgba_at) + pixel * 4u + c] = floatBitsToUint(color[c]);
    if (depth_at >= 0) result[uint(depth_at) + pixel] = floatBitsToUint(depth);
    if (coverage_at >= 0) result[uint(coverage_at) + pixel] = floatBitsToUint(coverage);
}

#if AMONG
uint pixel_count() { return picture_px.x * picture_px.y; }
float surface_depth(uint pixel) { return with_surface != 0u ? surfaces[pixel] : INF; }
vec4 surface_color(uint pixel) {
    uint at = pixel_count() + 4u * pixel;
    return with_surface != 0u ? vec4(surfaces[at], surfaces[at + 1u], surfaces[at + 2u], surfaces[at + 3u]) : vec4(0.0);
}

// Sets where the pixel's ray begins and ends: set_bounds() of gaussian_draw.h, ewa_ray_sections_range().
void set_bounds(uvec2 at, float depth, bool everything) {
    double end = double(INF), enter = -double(INF), leave = double(INF);
    if (with_surface != 0u && !everything && depth < INF) {
        end = wd_div(double(depth), unit_camera);
    }
    precise double left = double(at.x) + 0.5LF - lens.z, up = double(at.y) + 0.5LF - lens.w;
    double x = wd_div(left, lens.x), y = wd_div(up, lens.y);
    for (uint i = 0u; i < section_count; i++) {
        precise double across = sections[i].x * x, down = sections[i].y * y, lateral = across + down;
        precise double ahead = lateral + sections[i].w, along = lateral + sections[i].z;
        double start = orthographic != 0u ? ahead : sections[i].w, by = orthographic != 0u ? sections[i].z : along;
        double z = wd_div(-start, by);
        if (by > 0.0LF) {
            if (z > enter) enter = z;
        } else if (by < 0.0LF) {
            if (z < leave) leave = z;
        } else if (start < 0.0LF) {
            enter = double(INF);
            leave = -double(INF);
        }
    }
    double last = wd_div(leave, unit_camera);
    if (last < end) end = last;
    enter_depth = float(wd_div(enter, unit_camera));
    end_depth = float(end);
}

// The mean depth over a pixel that a surface covers a part of: expect() of gaussian_draw.h.
float expect(float cover, float surface, float opacity, float sum, float past_opacity, float past) {
    float part = wf_min(cover, 1.0), rest = wf_sub(1.0, part);
    bool some = 0.0 < cover && surface < INF;
    float own = wf_mul(some ? surface : 0.0, float(wd_div(1.0LF, unit_camera))), here = wf_mul(part, wf_fma(wf_sub(1.0, opacity), own, sum));
    return some ? wf_div(wf_fma(rest, past, here), wf_fma(rest, past_opacity, part)) : wf_div(past, past_opacity);
}

// A pixel with a surface in it: resolve_with_surface() and store_geometry(). `ahead`: what lies before the surface; `everything`: where
// that counts, by `twice`.
void write_among(uint pixel, Light ahead, Light everything, bool twice) {
    vec4 surface = surface_color(pixel), covered, color, past = background;
    if (twice) past = lay_over(everything, background);
    else past = lay_over(ahead, background);
    float cover = surface.a, inverse_ = straighten(cover), own = surface_depth(pixel);
    bool whole = 1.0 <= cover, none = cover <= 0.0;
    float opacity = wf_sub(1.0, ahead.through), depth = ahead.depth;
    float past_opacity = twice ? wf_sub(1.0, everything.through) : opacity;
    float past_depth = twice ? everything.depth : expected != 0u ? depth : INF;
    if (expected != 0u) depth = expect(cover, own, opacity, depth, past_opacity, past_depth);
    for (int c = 0; c < 3; c++) surface[c] = wf_mul(surface[c], inverse_);
    surface.a = 1.0;
    covered = lay_over(ahead, surface);
    for (int c = 0; c < 4; c++) {
        color[c] = wf_fma(cover, wf_sub(covered[c], past[c]), past[c]);
        color[c] = whole ? covered[c] : none ? past[c] : color[c];
    }
    opacity = whole ? opacity : wf_fma(cover, wf_sub(opacity, past_opacity), past_opacity);
    float nearest = expected != 0u ? INF : camera_depth(depth), behind = expected != 0u ? INF : camera_depth(past_depth);
    float coverage = with_coverage != 0u ? surfaces[5u * pixel_count() + pixel] : cover;
    if (!(nearest < own)) nearest = own < behind && behind < INF ? behind : own;
    if (coverage < 1.0) {
        precise float rest = 1.0 - coverage, more = opacity * rest;
        coverage = wf_add(coverage, more);
    }
    if (expected != 0u && opacity > 0.0) nearest = camera_depth(depth);
    write_planes(pixel, color, nearest, coverage);
}
#endif

// A pixel without surfaces.
void write_pixel(uint pixel, Light of) {
    float opacity = wf_sub(1.0, of.through), depth = of.depth;
    if (expected != 0u) depth = opacity > 0.0 ? wf_div(depth, opacity) : INF;
    write_planes(pixel, lay_over(of, background), camera_depth(depth), opacity);
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

// Composites the splats [first, end) of a tile's list in a pixel. `half_`: what is left of the light where depth is noted. All of a
// group call it.
Light composite(uvec2 tile_px, uvec2 quarter, uvec2 pixel, bool inside, uint first, uint end, float half_) {
    uint thread = gl_LocalInvocationIndex, block = thread / 16u;
    float x = float(pixel.x) + 0.5, y = float(pixel.y) + 0.5;
    Light of = Light(vec3(0.0), 1.0, expected != 0u ? 0.0 : INF, false);
    bool open = inside;
    barrier();
    if (thread < 128u) touching[thread / 8u][thread % 8u] = 0u;
    if (thread < 16u) shown[thread] = 0u;
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
                float weight = wf_mul(of.through, alpha), rest = wf_sub(of.through, weight);
                if (expected != 0u) of.depth = wf_fma(weight, z, of.depth);
                else if (half_ < of.through && rest <= half_) of.depth = z;
                for (int c = 0; c < 3; c++) of.color[c] = wf_fma(weight, batch[slot * 3u + 2u][c + 1], of.color[c]);
                of.through = rest;
                open = minimum_transmittance <= rest;
            }
        }
        barrier();
        if (thread < 128u) touching[thread / 8u][thread % 8u] = 0u;
    }
    barrier();
    if (of.through < 1.0) atomicOr(shown[block], 1u);
    barrier();
    of.display = shown[block] != 0u;
    return of;
}

#if AMONG
shared uint edges[16]; // [block] whether a surface leaves a part of some pixel free
#endif

void main() {
    uint work = group_number(), tile = first_tile + work / 4u, thread = gl_LocalInvocationIndex;
    // Two blocks of pixels lie next to each other in memory and in what a device runs together.
    uint block = thread / 16u, in_block = thread % 16u;
    uvec2 tile_px = uvec2(tile % tiles_per_row, tile / tiles_per_row) * TILE_SIDE, quarter = uvec2(work % 2u, work / 2u % 2u) * 4u;
    uvec2 pixel = tile_px + 4u * (quarter + uvec2(block % 4u, block / 4u)) + uvec2(in_block % 4u, in_block / 4u);
    bool inside = tile < tile_count && all(lessThan(pixel, picture_px));
    uint pairs = pair_count <= pair_capacity ? pair_count : 0u, place = pixel.y * picture_px.x + pixel.x;
    if (thread < 2u) ends[thread] = first_pair(tile + thread, pairs);
    barrier();
    uint first = ends[0], end = ends[1];
#if AMONG
    float own = inside ? surface_depth(place) : INF, cover = inside ? surface_color(place).a : 0.0;
    if (thread < 16u) edges[thread] = 0u;
    if (thread == 0u) some_open = 0u;
    barrier();
    if (with_surface != 0u && cover < 1.0 && own < INF) {
        edges[block] = 1u;
        some_open = 1u;
    }
    barrier();
    bool twice = edges[block] != 0u, some_twice = some_open != 0u;
    Light everything = Light(vec3(0.0), 1.0, INF, false);
    if (some_twice) {
        set_bounds(pixel, own, true);
        float left = wf_div(0.5, 1.0 <= cover ? 1.0 : wf_sub(1.0, cover));
        everything = composite(tile_px, quarter, pixel, inside, first, end, 1.0 <= cover ? INF : left);
    }
    set_bounds(pixel, own, false);
#endif
    Light of = composite(tile_px, quarter, pixel, inside, first, end, 0.5);
#if AMONG
    if (inside && with_surface != 0u) write_among(place, of, everything, twice);
    else if (inside) write_pixel(place, of);
#else
    if (inside) write_pixel(place, of);
#endif
    if (!loops_go_on()) atomicAdd(stopped_count, 1u);
}
