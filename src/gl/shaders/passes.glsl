// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The two passes over some splats of one tile, a pixel by each invocation (src/surface/pipeline_passes.h, pipeline_payload.h,
// pipeline_sums.h, pipeline_side_sums.h). PASS is 1 for visibility, 2 for the sums, over units of work; 4 has both,
// for what lies behind the first surface (edges.glsl).

layout(local_size_x = TILE_PX, local_size_y = TILE_PX) in;

layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
layout(std430, binding = 5) readonly buffer RecordBlock { Record records[]; };
layout(std430, binding = 6) readonly buffer ListBlock { uvec2 list[]; }; // record; its box
#if PASS != 4
layout(std430, binding = 1) buffer NearestBlock { uint nearest[]; };
layout(std430, binding = 7) readonly buffer UnitBlock { uvec4 units[]; }; // tile; first, end of the list or of near ones; near
#endif
#if PASS == 2
#define ADD(to, what) atomicAdd(to, uint(what))
#else
#define ADD(to, what) to += uint(what)
#endif
layout(location = 0) uniform uint part;

// Parts take units or tiles in turns.
uint work_number() { return group_number() * parts + part; }

#if WITH_CLIPS && PASS == 4
shared uint cut_blocks[TILE_PX / 4 * TILE_PX / 4];
#endif

#if PASS != 1
int low[CHANNELS];
#if WITH_FINE
int low_fine[CHANNELS];
#endif

const float BIAS = 12582912.0;
const int BIAS_BITS = 0x4b400000;

int units_of(float weight, float factor) { return floatBitsToInt(wf_fma(weight, factor, BIAS)) - BIAS_BITS; }

// What that leaves, in units of its own.
int fine_units(float weight, float factor) {
    float after = wf_fma(weight, factor, BIAS);
    float left = wf_odd(wf_fma(weight, factor, wf_sub(BIAS, after)));
    return units_of(FINE_SCALE, left);
}

void add_word(uint channel, uint word, int value, bool is_back_facing) {
    if (value == 0) return;
    uint at = (channel * WORDS + word) * pixel_count + pixel;
    if (is_back_facing) {
        ADD(is_back[at], value & 0xffff);
        ADD(is_back[at + pixel_count], value >> 16);
    } else {
        ADD(sums[at], value & 0xffff);
        ADD(sums[at + pixel_count], value >> 16);
    }
}

void add_channel(uint channel, float weight, float factor, bool is_back_facing, bool fine) {
    int value = units_of(weight, factor);
    if (is_back_facing)
        add_word(channel, 0u, value, true);
    else
        low[channel] += value;
#if WITH_FINE || WITH_DEPTH || WITH_CLIPS
    if (!fine) return;
    int rest = fine_units(weight, factor);
#if WITH_FINE
    if (!is_back_facing) {
        low_fine[channel] += rest;
        return;
    }
#endif
    add_word(channel, 2u, rest, is_back_facing);
#endif
}

#if WITH_CLIPS
void add_cut(Clip clip, Sample s, float whole_weight) {
    float off = wf_mul(wf_sub(1.0, s.share), PER_CUT);
    float cut_weight = wf_mul(wf_min(off, 1.0), whole_weight);
    if (!(0.0 < cut_weight)) return;
    float decides[2];
    for (int i = 0; i < 2; i++) decides[i] = clip.either != 0u ? s.line[i] : wf_sub(1.0, s.line[i]);
    float sum = wf_add(decides[0], decides[1]);
    float x = wf_fma(decides[0], clip.line[0].x_inward, wf_mul(decides[1], clip.line[1].x_inward));
    float y = wf_fma(decides[0], clip.line[0].y_inward, wf_mul(decides[1], clip.line[1].y_inward));
    if (clip.count > 2u && clip.either != 0u) {
        float off_first = wf_sub(1.0, s.first), share = wf_div(off_first, 0.0 < sum ? sum : 1.0);
        x = wf_mul(x, share);
        y = wf_mul(y, share);
        sum = off_first;
    }
    for (uint i = 2u; i < clip.count; i++) {
        float decides_too = wf_sub(1.0, s.line[i]);
        x = wf_fma(decides_too, clip.line[i].x_inward, x);
        y = wf_fma(decides_too, clip.line[i].y_inward, y);
        sum = wf_add(sum, decides_too);
    }
    float scaled = wf_div(1.0, 0.0 < sum ? sum : 1.0);
    float parts[4] = float[4](s.share, 1.0, wf_mul(scaled, x), wf_mul(scaled, y));
    for (uint c = 0u; c < 4u; c++) {
        int value = units_of(1.0, wf_odd_product(cut_weight, parts[c]));
        uint at = c * 2u * pixel_count + pixel;
        ADD(cut[at], value & 0xffff);
        ADD(cut[at + pixel_count], value >> 16);
    }
#if PASS == 2
    uvec2 block = uvec2(pixel % band_px.x, pixel / band_px.x) / 4u;
    cut[8u * pixel_count + block.y * ((band_px.x + 3u) / 4u) + block.x] = 1u;
#else
    uvec2 block = gl_LocalInvocationID.xy / 4u;
    cut_blocks[block.y * uint(TILE_PX / 4) + block.x] = 1u;
#endif
}
#endif

float depth_share(View view, float key, float bound) {
    float share = has(view.flags, ORTHOGRAPHIC) ? wf_mul(key, -view.depth_scale) : wf_div(bound, key);
    return wf_odd(wf_min(wf_max(share, -1.0), ALMOST_ONE));
}

// What a splat adds (payload): peak, colour, normal, opacity, material.
struct Payload {
    float peak;
    vec3 color, normal;
    float opacity, material[5];
};

void add_splat(Payload p, View view, Sample s, float bound, bool is_back_facing, bool fine) {
    float weight = exponential(s.exponent, view.doublings);
#if WITH_CLIPS
    weight = wf_mul(weight, s.share);
#endif
    bool depth_too = WITH_DEPTH != 0 && PASS == 2;
    add_channel(0u, weight, p.peak, is_back_facing, fine || depth_too);
    for (uint i = 0u; i < 3u; i++) add_channel(1u + i, weight, p.color[i], is_back_facing, fine);
#if WITH_NORMAL
    for (uint i = 0u; i < 3u; i++) add_channel(4u + i, weight, p.normal[i], is_back_facing, fine);
#endif
#if WITH_DEPTH
    if (depth_too)
        add_channel(DEPTH_CHANNEL, wf_mul(weight, p.peak), depth_share(view, s.key, bound), is_back_facing, true);
#endif
#if WITH_MATERIAL
    for (uint i = 0u; i < 5u; i++) add_channel(8u + i, weight, p.material[i], is_back_facing, fine);
#endif
#if WITH_OPACITY
    add_channel(CHANNELS - 1u, weight, p.opacity, is_back_facing, fine);
#endif
}
#endif

// A record of the list at a pixel; it counts before `beyond` and within its clip lines.
Sample sample_listed(Record r, vec2 at, View view, float beyond) {
    Sample s = sample_record(r, at, view);
#if PASS == 4
    s.counts = s.counts && s.key < beyond && !has(r.box, CONCAVE);
#endif
#if WITH_CLIPS
    if (s.counts && has(r.box, CLIPPED)) clip_at(clips[r.clip], at, s);
#endif
    return s;
}

#if PASS != 2
// Raises `largest` to the keys of z + eps of those that count before `beyond`: records of the list, or near surfels.
void find_nearest(uint first, uint end, bool near, uvec2 in_field, float beyond, inout float largest) {
    vec2 at = vec2(float(in_field.x) - 63.5, float(in_field.y) - 63.5);
    uvec2 block = in_field / 4u;
    // Each pixel goes on to the next splat that may reach it, so that those of a group that work do so together.
    for (uint i = first; WITH_NEARS == 0 || !near; i++) {
        while (i < end && !in_box(list[i].y, block)) i++;
        if (i >= end) break;
        Record r = records[list[i].x];
        View view = views[r.extra >> 8];
        if (!has(view.flags, HIDES)) continue;
        Sample s = sample_listed(r, at, view, beyond);
        if (s.counts) largest = wf_max(s.bound, largest);
    }
#if WITH_NEARS
    for (uint i = first; near && i < end; i++) {
        View view = views[nears[i].source];
        if (!has(view.flags, HIDES)) continue;
        Sample s = sample_near(nears[i], at, view);
#if PASS == 4
        s.counts = s.counts && s.key < beyond;
#endif
        if (s.counts) largest = wf_max(s.bound, largest);
    }
#endif
}
#endif

#if PASS != 1
// Adds those whose keys reach `bound`, likewise, to the sums of the pixel.
void add_splats(uint first, uint end, bool near, uvec2 in_field, float beyond, float bound) {
    vec2 at = vec2(float(in_field.x) - 63.5, float(in_field.y) - 63.5);
    uvec2 block = in_field / 4u;
    for (int i = 0; i < CHANNELS; i++) low[i] = 0;
#if WITH_FINE
    for (int i = 0; i < CHANNELS; i++) low_fine[i] = 0;
#endif
    for (uint i = first; WITH_NEARS == 0 || !near; i++) {
        while (i < end && !in_box(list[i].y, block)) i++;
        if (i >= end) break;
        Record r = records[list[i].x];
        View view = views[r.extra >> 8];
        Sample s = sample_listed(r, at, view, beyond);
        if (!(s.counts && bound <= s.key)) continue;
        Payload p;
        p.peak = r.peak;
        p.color = vec3(r.red, r.green, r.blue);
        p.normal = vec3(r.nx, r.ny, r.nz);
        p.opacity = r.opacity;
#if WITH_MATERIAL
        for (uint k = 0u; k < 5u; k++) p.material[k] = wf_odd(wf_mul(to.materials[(r.extra & 255u) * 5u + k], r.peak));
#endif
#if RAYS
        p.peak = wf_odd_product(p.peak, s.gain);
        for (int k = 0; k < 3; k++) {
            p.color[k] = wf_odd_product(p.color[k], s.gain);
            p.normal[k] = wf_odd_product(p.normal[k], s.gain);
        }
        p.opacity = wf_odd_product(p.opacity, s.gain);
#if WITH_MATERIAL
        for (int k = 0; k < 5; k++) p.material[k] = wf_odd_product(p.material[k], s.gain);
#endif
#endif
        bool fine = WITH_FINE != 0;
#if WITH_CLIPS
        if (has(r.box, CLIPPED)) {
            add_cut(clips[r.clip], s, wf_mul(exponential(s.exponent, view.doublings), p.peak));
            fine = true;
        }
#endif
        add_splat(p, view, s, bound, has(r.box, BACK_FACING), fine);
    }
#if WITH_NEARS
    for (uint i = first; near && i < end; i++) {
        Near r = nears[i];
        View view = views[r.source];
        Sample s = sample_near(r, at, view);
#if PASS == 4
        s.counts = s.counts && s.key < beyond;
#endif
        if (!(s.counts && bound <= s.key)) continue;
        float peak = wf_mul(s.gain, view.sum_scale);
        Payload p;
        p.peak = wf_odd(peak);
        for (int k = 0; k < 3; k++) {
            p.color[k] = wf_odd_product(peak, r.color[k]);
            p.normal[k] = wf_odd_product(peak, r.normal[k]);
        }
        p.opacity = wf_odd_product(peak, r.opacity);
        for (int k = 0; k < 5; k++) p.material[k] = wf_odd_product(peak, r.material[k]);
        bool fine = WITH_FINE != 0;
#if WITH_CLIPS
        if (has(r.flags, CLIPPED)) {
            add_cut(r.clip, s, wf_mul(exponential(s.exponent, view.doublings), peak));
            fine = true;
        }
#endif
        add_splat(p, view, s, bound, has(r.flags, BACK_FACING), fine);
    }
#endif
    for (uint i = 0u; i < uint(CHANNELS); i++) add_word(i, 0u, low[i], false);
#if WITH_FINE
    for (uint i = 0u; i < uint(CHANNELS); i++) add_word(i, 2u, low_fine[i], false);
#endif
}
#endif

#if PASS != 4
void main() {
    if (work_number() >= unit_count) return;
    uvec4 unit = units[work_number()];
    uvec2 in_band = uvec2(unit.x % tiles_per_row, unit.x / tiles_per_row) * uint(TILE_PX) + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(in_band, band_px))) return;
    uvec2 in_field = (first_px + in_band) & 127u;
    uint here = in_band.y * band_px.x + in_band.x;
#if PASS == 1
    float largest = -INF;
    find_nearest(unit.y, unit.z, unit.w != 0u, in_field, INF, largest);
    if (largest > -INF) atomicMax(nearest[here], order_of(largest));
#else
    pixel = here;
    pixel_count = band_px.x * band_px.y;
    float bound = float_of(nearest[here]);
    if (bound > -INF) add_splats(unit.y, unit.z, unit.w != 0u, in_field, INF, bound);
#endif
}
#endif
