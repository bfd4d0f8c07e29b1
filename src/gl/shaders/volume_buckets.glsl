// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the splats of each unit begin in a tile's list: a group for each tile, an invocation for each of 64 units at a time. After
// volume_scene.glsl.

layout(local_size_x = 64) in;

layout(std430, binding = 5) readonly buffer RunBlock { uint runs[]; };
layout(std430, binding = 6) writeonly buffer BucketBlock { uint buckets[]; }; // [unit of the tile], then the end
layout(location = 0) uniform uint first_tile;
layout(location = 1) uniform uint end_tile;

shared uint sums[64];

void main() {
    uint number = first_tile + group_number(), lane = gl_LocalInvocationIndex;
    if (number >= end_tile) return;
    Tile tile = tiles[number];
    int end_unit = min(tile.last_unit + 1, point_slice);
    uint begin = tile.first_record;
    for (int first = tile.first_unit; first < end_unit; first += 64) {
        int unit = first + int(lane);
        uint count = 0u;
        if (unit < end_unit) {
            uint end = first_pair_at(tile, unit + 1);
            for (uint i = first_pair_at(tile, unit + 1 - int(longest_span)); i < end; i++) {
                if (pairs[i].slice_last < unit) continue;
                uint at = pairs[i].first_run + uint(unit - pairs[i].slice_first);
                count += runs[at + 1u] - runs[at];
            }
        }
        sums[lane] = count;
        barrier();
        uint before = 0u, all = 0u;
        for (uint i = 0u; i < 64u; i++) {
            before += i < lane ? sums[i] : 0u;
            all += sums[i];
        }
        if (unit < end_unit) buckets[tile.first_bucket + uint(unit - tile.first_unit)] = begin + before;
        begin += all;
        barrier();
    }
    if (lane == 0u && tile.first_unit < end_unit) buckets[tile.first_bucket + uint(end_unit - tile.first_unit)] = begin;
}
