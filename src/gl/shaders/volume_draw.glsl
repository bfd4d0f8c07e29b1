// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pixels of a volume: a group for 8x8 pixels of a tile, which goes through its units front to back, a pixel by each invocation:
// src/volume/tile.c, kernels_points.h, kernels_splats.h, kernels_near.h and kernels_resolve.h. Points of a unit are summed in the order
// of the blocks and composited once, splats one by one. Nothing more is drawn in a block of 4x4 pixels after whatever saturates the last
// of them. Where that takes long, what there is waits for the next dispatch. After volume_scene.glsl and codes.glsl.

layout(local_size_x = 8, local_size_y = 8) in;

struct NearVoxel {
    float offset[3], square, color[3], extinction, z;
};

layout(std430, binding = 4) readonly buffer RecordBlock { uint records[]; };
layout(std430, binding = 5) readonly buffer RunBlock { uint runs[]; };
layout(std430, binding = 6) readonly buffer BucketBlock { uint buckets[]; };
layout(std430, binding = 7) readonly buffer SortedBlock { uvec2 lists[]; };
layout(std430, binding = 8) readonly buffer UnitBlock {
    uint units[]; // of each: the filter of points; depth of the middle; what ends before is passed; then of each tile the ends of
                  // rays, [block][16], and their beginnings
};
layout(std430, binding = 9) readonly buffer FilterBlock { vec4 filters[]; }; // [filter][phase]: four taps
layout(std430, binding = 11) readonly buffer NearBlock { NearVoxel near_voxels[]; };
layout(std430, binding = 12) writeonly buffer ResultBlock { uint result[]; };
layout(std430, binding = 13) buffer StateBlock { float states[]; };    // [pixel of the tiles of a dispatch]: 5
layout(std430, binding = 14) buffer ProgressBlock { uint progress[]; }; // [group]: 0: it begins; the next unit and 1
layout(location = 0) uniform uint first_tile;
layout(location = 1) uniform uint end_tile;
layout(location = 2) uniform uint is_last;

const uint NO_ITEM = 0xffffffffu, DONE = 0xffffffffu, SPLAT_WORDS = 20u;

shared uint batch_bits[2], run_begins[64], run_ends[64];
shared uint pixel_bits[128], block_bits[8];
shared vec4 point_colors[64];
shared uint point_windows[64];
shared float splats[64 * 20];
shared uint block_open[4], block_last[4];
shared uint block_ahead[4]; // some ray of the block goes on behind what is passed

struct Pixel {
    vec3 light;
    float through, depth;
};

Tile tile;
Pixel pixel;
ivec2 first_px;  // of the group in the tile
uvec2 at_px;     // of the invocation in the group
uint lane, block;
bool hidden;     // the block is
uint turns_taken;
float ray_end, ray_begin; // where section planes let the pixel's ray end and begin

void absorb(float weight, vec3 color, float z) {
    for (int c = 0; c < 3; c++) pixel.light[c] = wf_fma(weight, color[c], pixel.light[c]);
    float rest = wf_sub(pixel.through, weight);
    rest = wf_keep(MIN_POWER < rest, rest);
    if (with_depth != 0u && 0.5 < pixel.through && rest <= 0.5) pixel.depth = z;
    pixel.through = rest;
}

// The share of what lies around a depth that section planes leave.
float share_within(float z) {
    float share = share_below(wf_div(wf_sub(ray_end, z), depth_deviation));
    return wf_max(wf_sub(share, share_below(wf_div(wf_sub(ray_begin, z), depth_deviation))), 0.0);
}

bool is_open() { return minimum_transmittance < pixel.through; }

// Hides blocks whose pixels are all saturated; whether some block is still open.
bool find_open() {
    if (lane < 4u) block_open[lane] = 0u;
    barrier();
    if (!hidden && is_open()) block_open[block] = 1u;
    barrier();
    hidden = hidden || block_open[block] == 0u;
    uint all = block_open[0] | block_open[1] | block_open[2] | block_open[3];
    barrier();
    return all != 0u;
}

// What is composited one by one comes in batches of at most 64 items: splats, or voxels at the eye from `near_base` on.
uint near_base, item_bits[2];
bool of_near;
vec3 ray;        // of the pixel, in standard deviations
float ray_peak;  // optical depth per extinction through a voxel's middle
uint saturated, drawn;

void set_ray() {
    float left = wf_sub(float(tile.x_px + first_px.x + int(at_px.x & 4u)), cx_px);
    float top = wf_sub(float(tile.y_px + first_px.y + int(at_px.y & 4u)), cy_px);
    vec3 along = vec3(wf_div(wf_add(left, float(at_px.x & 3u) + 0.5), fx_px), wf_div(wf_add(top, float(at_px.y & 3u) + 0.5), fy_px), 1.0);
    for (int c = 0; c < 3; c++) ray[c] = row_dot(to_deviations[c], to_deviations[3 + c], to_deviations[6 + c], along);
    float length_ = wf_sqrt(wf_fma(along.x, along.x, wf_fma(along.y, along.y, 1.0))), stretched = wf_sqrt(dot3(ray, ray));
    for (int c = 0; c < 3; c++) ray[c] = wf_div(ray[c], stretched);
    ray_peak = wf_mul(splat_peak, wf_div(length_, stretched));
}

void draw_near(NearVoxel at) {
    float t = wf_fma(ray.x, at.offset[0], wf_fma(ray.y, at.offset[1], wf_mul(ray.z, at.offset[2])));
    float m2 = wf_max(wf_fnma(t, t, at.square), 0.0);
    if (!(m2 < cutoff2 && -cutoff < t)) return;
    float whole = wf_mul(at.extinction, wf_mul(ray_peak, wf_exp2(wf_mul(-0.721347520, m2))));
    float thick = wf_min(wf_mul(whole, share_below(t)), 1e12);
    if (with_sections != 0u) thick = wf_mul(thick, share_within(at.z));
    absorb(wf_mul(pixel.through, absorbed(thick)), vec3(at.color[0], at.color[1], at.color[2]), 0.0 < at.z ? at.z : 0.0);
}

void draw_splat(uint at) {
    float x0 = float(at_px.x & 3u) + 0.5, y0 = float(at_px.y & 3u) + 0.5;
    float dx = wf_add(wf_sub(x0, splats[at]), float(first_px.x + int(at_px.x & 4u)));
    float dy = wf_add(wf_sub(y0, splats[at + 1u]), float(first_px.y + int(at_px.y & 4u)));
    float i2 = wf_fma(dx, wf_fma(splats[at + 2u], dx, wf_mul(splats[at + 3u], dy)), wf_mul(wf_mul(splats[at + 4u], dy), dy));
    if (!(i2 < 1.0)) return;
    float in_x = wf_fma(dx, splats[at + 8u], wf_fma(dy, splats[at + 9u], splats[at + 6u]));
    float rho = wf_fma(dx, in_x, wf_fma(dy, wf_fma(dy, splats[at + 10u], splats[at + 7u]), splats[at + 5u]));
    float d2 = wf_sub(1.0, wf_div(wf_sub(1.0, i2), rho)), exponent = wf_mul(-0.721347520, cutoff2);
    float thick = wf_mul(splats[at + 11u], wf_exp2(wf_mul(exponent, d2)));
    if (with_sections != 0u) thick = wf_mul(thick, share_within(splats[at + 15u]));
    absorb(wf_mul(pixel.through, absorbed(thick)), vec3(splats[at + 12u], splats[at + 13u], splats[at + 14u]), splats[at + 15u]);
}

// Draws the items whose bits are set, up to the last.
void draw_items(uint last) {
    for (uint word = 0u; word < 2u; word++)
        for (uint bits = item_bits[word]; bits != 0u; bits &= bits - 1u) {
            uint item = 32u * word + uint(findLSB(bits));
            if (item > last) return;
            bool was_open = is_open();
            if (of_near) draw_near(near_voxels[near_base + item]);
            else draw_splat(SPLAT_WORDS * item);
            drawn = item;
            if (was_open && !is_open()) saturated = item;
        }
}

// Draws a batch. A block ends with the item that saturates the last of its pixels: where others came after it, once more up to there.
bool draw_batch() {
    Pixel before = pixel;
    bool was_open = is_open();
    saturated = drawn = NO_ITEM;
    if (lane < 4u) block_open[lane] = block_last[lane] = 0u;
    barrier();
    if (!hidden) draw_items(63u);
    if (!hidden && is_open()) block_open[block] = 1u;
    if (!hidden && was_open && !is_open()) atomicMax(block_last[block], saturated);
    barrier();
    uint all = block_open[0] | block_open[1] | block_open[2] | block_open[3];
    if (!hidden && block_open[block] == 0u) {
        uint last = block_last[block];
        hidden = true;
        if (drawn != NO_ITEM && drawn > last) {
            pixel = before;
            draw_items(last);
        }
    }
    barrier();
    return all != 0u;
}

// Voxels at the eye; false: nothing more shows.
bool draw_all_near() {
    of_near = true;
    set_ray();
    for (uint first = tile.first_near; first < tile.end_near; first += 64u) {
        uint count = min(tile.end_near - first, 64u);
        near_base = first;
        item_bits[0] = count >= 32u ? 0xffffffffu : (1u << count) - 1u;
        item_bits[1] = count == 64u ? 0xffffffffu : count > 32u ? (1u << count - 32u) - 1u : 0u;
        if (!draw_batch()) return false;
        turns_taken += count;
    }
    of_near = false;
    return true;
}

// Says which blocks of the group a splat reaches.
uint blocks_of(uint at) {
    float left = uintBitsToFloat(records[at + 16u]), right = uintBitsToFloat(records[at + 17u]);
    float top = uintBitsToFloat(records[at + 18u]), bottom = uintBitsToFloat(records[at + 19u]);
    float last_x = wf_sub(float(tile.width_px), 0.5), last_y = wf_sub(float(tile.height_px), 0.5);
    if (!(right > 0.5) || !(bottom > 0.5) || !(left < last_x) || !(top < last_y)) return 0u;
    ivec2 low = ivec2(left > 0.0 ? int(left) : 0, top > 0.0 ? int(top) : 0) / 4;
    ivec2 high = ivec2(right < last_x ? int(right) : int(last_x), bottom < last_y ? int(bottom) : int(last_y)) / 4;
    uint reached = 0u;
    for (int b = 0; b < 4; b++) {
        ivec2 cell = first_px / 4 + ivec2(b & 1, b >> 1);
        if (all(lessThanEqual(low, cell)) && all(lessThanEqual(cell, high))) reached |= 1u << b;
    }
    return reached;
}

// Splats of a unit; false: nothing more shows.
bool draw_splats(uint begin, uint end) {
    for (uint first = begin; first < end; first += 64u) {
        if (lane < 8u) block_bits[lane] = 0u;
        barrier();
        uint i = first + lane;
        if (i < end) {
            uint at = lists[i].y * record_words, reached = blocks_of(at);
            for (uint b = 0u; b < 4u; b++)
                if ((reached >> b & 1u) != 0u) atomicOr(block_bits[2u * b + lane / 32u], 1u << lane % 32u);
            if (reached != 0u)
                for (uint k = 0u; k < SPLAT_WORDS; k++) splats[SPLAT_WORDS * lane + k] = uintBitsToFloat(records[at + k]);
        }
        barrier();
        item_bits[0] = block_bits[2u * block];
        item_bits[1] = block_bits[2u * block + 1u];
        uint some = 0u;
        for (uint b = 0u; b < 8u; b++) some |= block_bits[b];
        turns_taken += 64u;
        barrier();
        if (some != 0u && !draw_batch()) return false;
    }
    return true;
}

// Adds the points of a block to the pixel's sums.
void sum_run(uint begin, uint end, uint filter_, inout vec4 sums) {
    for (uint first = begin; first < end; first += 64u) {
        pixel_bits[2u * lane] = pixel_bits[2u * lane + 1u] = 0u;
        barrier();
        uint i = first + lane;
        if (i < end) {
            uint at = i * record_words, window = records[at + 4u];
            ivec2 begins = ivec2(window & 127u, window >> 7 & 127u) - 4 - first_px;
            ivec2 low = max(begins, 0), high = min(begins + 3, 7);
            point_windows[lane] = window;
            if (all(lessThanEqual(low, high)))
                point_colors[lane] = vec4(uintBitsToFloat(records[at]), uintBitsToFloat(records[at + 1u]),
                                          uintBitsToFloat(records[at + 2u]), uintBitsToFloat(records[at + 3u]));
            for (int y = low.y; y <= high.y; y++)
                for (int x = low.x; x <= high.x; x++) atomicOr(pixel_bits[2 * (8 * y + x) + int(lane / 32u)], 1u << lane % 32u);
        }
        barrier();
        for (uint word = 0u; word < 2u && !hidden; word++)
            for (uint bits = pixel_bits[2u * lane + word]; bits != 0u; bits &= bits - 1u) {
                uint item = 32u * word + uint(findLSB(bits)), window = point_windows[item];
                ivec2 tap = first_px + ivec2(at_px) + 4 - ivec2(window & 127u, window >> 7 & 127u);
                float across = filters[32u * filter_ + (window >> 14 & 63u)][tap.x];
                float down = filters[32u * filter_ + (window >> 20 & 63u)][tap.y];
                for (int c = 0; c < 4; c++) sums[c] = wf_fma(wf_mul(point_colors[item][c], across), down, sums[c]);
            }
        turns_taken += 24u + min(end - first, 64u);
        barrier();
    }
}

// Composites what was summed of a unit.
void composite(vec4 sums, float z) {
    float thick = sums.w;
    if (with_sections != 0u) thick = wf_mul(thick, share_within(z));
    float weight = wf_mul(pixel.through, absorbed(thick));
    bool some = 1e-30 < sums.w;
    float mean = wf_keep(some, wf_div(1.0, some ? sums.w : 1.0));
    absorb(weight, vec3(wf_mul(sums.x, mean), wf_mul(sums.y, mean), wf_mul(sums.z, mean)), z);
}

// Hides blocks whose rays all end well before a unit.
void hide_passed(int unit) {
    float passed = uintBitsToFloat(units[3 * unit + 2]);
    if (lane < 4u) block_ahead[lane] = 0u;
    barrier();
    if (!(ray_end < passed)) block_ahead[block] = 1u;
    barrier();
    hidden = hidden || block_ahead[block] == 0u;
    barrier();
}

// Points of a unit, of blocks [first_pair, end_pair) that may have some; false: nothing more shows.
bool draw_points(int unit, uint first_pair, uint end_pair) {
    uint filter_ = units[3 * unit];
    vec4 sums = vec4(0.0);
    bool summed = false;
    for (uint first = first_pair; first < end_pair; first += 64u) {
        if (lane < 2u) batch_bits[lane] = 0u;
        barrier();
        uint i = first + lane, begin = 0u, end = 0u;
        if (i < end_pair && unit <= pairs[i].slice_last) {
            uint box = pairs[i].box, run = pairs[i].first_run + uint(unit - pairs[i].slice_first);
            ivec2 low = ivec2(box & 255u, box >> 8 & 255u), high = ivec2(box >> 16 & 255u, box >> 24);
            if (all(lessThanEqual(low, first_px + 7)) && all(lessThanEqual(first_px, high))) begin = runs[run], end = runs[run + 1u];
        }
        if (begin < end) atomicOr(batch_bits[lane / 32u], 1u << lane % 32u);
        barrier();
        uint before = bitCount(batch_bits[lane / 32u] & (1u << lane % 32u) - 1u);
        if (lane >= 32u) before += bitCount(batch_bits[0]);
        if (begin < end) {
            run_begins[before] = begin;
            run_ends[before] = end;
        }
        uint count = bitCount(batch_bits[0]) + bitCount(batch_bits[1]);
        barrier();
        for (uint k = 0u; k < count; k++) sum_run(run_begins[k], run_ends[k], filter_, sums);
        summed = summed || count > 0u;
        turns_taken += 4u + count;
        barrier();
    }
    if (!summed) return true;
    if (!hidden && sums.w != 0.0) composite(sums, uintBitsToFloat(units[3 * unit + 1]));
    return find_open();
}

void write_pixel() {
    ivec2 here = first_px + ivec2(at_px);
    if (here.x >= tile.width_px || here.y >= tile.height_px) return;
    uint at = uint(tile.y_px + here.y) * picture_px[0] + uint(tile.x_px + here.x);
    float opacity = wf_sub(1.0, pixel.through);
    vec4 shown;
    for (int c = 0; c < 4; c++) shown[c] = wf_fma(pixel.through, background[c], c < 3 ? pixel.light[c] : opacity);
    if (rgba8_at >= 0) result[uint(rgba8_at) + at] = color_code(shown);
    if (rgba_at >= 0)
        for (uint c = 0u; c < 4u; c++) result[uint(rgba_at) + 4u * at + c] = floatBitsToUint(shown[c]);
    if (depth_at >= 0) {
        precise double z = double(pixel.depth) * packDouble2x32(uvec2(unit_camera[0], unit_camera[1]));
        result[uint(depth_at) + at] = floatBitsToUint(pixel.depth < INF ? float(z) : pixel.depth);
    }
    if (coverage_at >= 0) result[uint(coverage_at) + at] = floatBitsToUint(opacity);
}

// Whether the driver still lets loops go on; some end all of a program's after so many turns.
bool loops_go_on() {
    uint counted = 0u;
    for (uint i = 0u; i < record_words; i++) counted++;
    return counted == record_words;
}

void main() {
    uint group = group_number(), number = first_tile + group / 64u;
    if (number >= end_tile) return;
    tile = tiles[number];
    lane = gl_LocalInvocationIndex;
    at_px = gl_LocalInvocationID.xy;
    first_px = ivec2(group % 8u, group / 8u % 8u) * 8;
    uint begun = progress[group];
    if (first_px.x >= tile.width_px || first_px.y >= tile.height_px || begun == DONE) return;
    block = at_px.y / 4u * 2u + at_px.x / 4u;
    ivec2 corner = first_px + ivec2(at_px / 4u) * 4;
    bool outside = corner.x >= tile.width_px || corner.y >= tile.height_px;
    hidden = outside;
    of_near = false;
    turns_taken = 0u;
    uint in_tile = uint(corner.y / 4 * 16 + corner.x / 4) * 16u + (at_px.y & 3u) * 4u + (at_px.x & 3u);
    if (with_sections != 0u) {
        ray_end = uintBitsToFloat(units[bounds_at + number * 8192u + in_tile]);
        ray_begin = uintBitsToFloat(units[bounds_at + number * 8192u + 4096u + in_tile]);
    }
    uint state_at = (64u * group + lane) * 5u;
    int unit = tile.first_unit;
    bool goes_on = true;
    pixel = Pixel(vec3(0.0), 1.0, INF);
    if (begun != 0u) {
        pixel = Pixel(vec3(states[state_at], states[state_at + 1u], states[state_at + 2u]), states[state_at + 3u], states[state_at + 4u]);
        unit = int(begun) - 1;
        goes_on = find_open();
    } else if (tile.first_near < tile.end_near) {
        goes_on = draw_all_near();
    }
    uint first = first_pair_at(tile, unit + 1 - int(longest_span)), end = first_pair_at(tile, unit + 1);
    while (goes_on && unit <= tile.last_unit && turns_taken < turns) {
        for (; end < tile.end_pair && pairs[end].slice_first <= unit; end++) turns_taken++;
        for (; first < end && pairs[first].slice_last < unit; first++) turns_taken++;
        turns_taken += 4u;
        if (first == end) {
            if (end == tile.end_pair) break;
            unit = pairs[end].slice_first;
            continue;
        }
        if (with_sections != 0u) hide_passed(unit);
        if (unit < point_slice) {
            uint bucket = tile.first_bucket + uint(unit - tile.first_unit);
            goes_on = draw_splats(buckets[bucket], buckets[bucket + 1u]);
        } else {
            goes_on = draw_points(unit, first, end);
        }
        unit++;
    }
    bool done = !goes_on || unit > tile.last_unit || first == end && end == tile.end_pair;
    barrier();
    if (done) {
        write_pixel();
    } else {
        states[state_at] = pixel.light.x;
        states[state_at + 1u] = pixel.light.y;
        states[state_at + 2u] = pixel.light.z;
        states[state_at + 3u] = pixel.through;
        states[state_at + 4u] = pixel.depth;
    }
    if (lane == 0u) progress[group] = done ? DONE : uint(unit) + 1u;
    if (lane == 0u && (is_last != 0u && !done || !loops_go_on())) atomicAdd(broken_count, 1u);
}
