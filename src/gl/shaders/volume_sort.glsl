// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sorts the splats of a unit in a tile by their distances, those of one distance as they come: a group for each unit of each tile,
// digit by digit. Places come from counts, so that the order is the processor's (src/volume/sort.c). After volume_scene.glsl.

layout(local_size_x = 64) in;

layout(std430, binding = 4) readonly buffer RecordBlock { uint records[]; };
layout(std430, binding = 5) readonly buffer RunBlock { uint runs[]; };
layout(std430, binding = 6) readonly buffer BucketBlock { uint buckets[]; };
layout(std430, binding = 7) coherent buffer SortedBlock { uvec2 lists[]; }; // key, record: twice as many as there are records
layout(location = 0) uniform uint first_tile;
layout(location = 1) uniform uint record_room;

shared uint low_key, high_key, digit_begins[16], masks[32];

// Lists the unit's splats as they come.
void gather(Tile tile, int unit, uint begin) {
    uint end = first_pair_at(tile, unit + 1), to = begin, lane = gl_LocalInvocationIndex;
    for (uint i = first_pair_at(tile, unit + 1 - int(longest_span)); i < end; i++) {
        if (pairs[i].slice_last < unit) continue;
        uint at = pairs[i].first_run + uint(unit - pairs[i].slice_first), first = runs[at], count = runs[at + 1u] - first;
        for (uint k = lane; k < count; k += 64u) {
            uint key = records[(first + k) * record_words + 20u];
            lists[to + k] = uvec2(key, first + k);
            atomicMin(low_key, key);
            atomicMax(high_key, key);
        }
        to += count;
    }
}

// Puts [from, from + count) into the order of a digit, from `to` on.
void sort_digit(uint from, uint to, uint count, uint low, uint shift) {
    uint lane = gl_LocalInvocationIndex, word = lane / 32u, bit = 1u << lane % 32u;
    if (lane < 16u) digit_begins[lane] = 0u;
    barrier();
    for (uint i = lane; i < count; i += 64u) atomicAdd(digit_begins[lists[from + i].x - low >> shift & 15u], 1u);
    barrier();
    if (lane == 0u) {
        uint sum = to;
        for (uint d = 0u; d < 16u; d++) {
            uint here = digit_begins[d];
            digit_begins[d] = sum;
            sum += here;
        }
    }
    for (uint first = 0u; first < count; first += 64u) {
        if (lane < 32u) masks[lane] = 0u;
        barrier();
        uint i = first + lane;
        uvec2 item = lists[from + min(i, count - 1u)];
        uint digit = item.x - low >> shift & 15u;
        if (i < count) atomicOr(masks[2u * digit + word], bit);
        barrier();
        if (i < count) {
            uint before = bitCount(masks[2u * digit + word] & bit - 1u);
            if (word == 1u) before += bitCount(masks[2u * digit]);
            lists[digit_begins[digit] + before] = item;
        }
        barrier();
        if (lane < 16u) digit_begins[lane] += bitCount(masks[2u * lane]) + bitCount(masks[2u * lane + 1u]);
        barrier();
    }
    memoryBarrierBuffer();
    barrier();
}

void main() {
    Tile tile = tiles[first_tile + gl_WorkGroupID.y];
    int unit = tile.first_unit + int(gl_WorkGroupID.x);
    if (unit >= point_slice || unit > tile.last_unit) return;
    uint bucket = tile.first_bucket + gl_WorkGroupID.x, begin = buckets[bucket], count = buckets[bucket + 1u] - begin;
    if (count == 0u) return;
    if (gl_LocalInvocationIndex == 0u) {
        low_key = 0xffffffffu;
        high_key = 0u;
    }
    barrier();
    gather(tile, unit, begin);
    memoryBarrierBuffer();
    barrier();
    uint low = low_key, range = high_key - low, passes = 0u;
    while (passes < 8u && range >> 4u * passes != 0u) passes++;
    // There and back.
    for (uint pass = 0u; pass < passes; pass += 2u) {
        sort_digit(begin, begin + record_room, count, low, 4u * pass);
        sort_digit(begin + record_room, begin, count, low, min(4u * pass + 4u, 28u));
    }
}
