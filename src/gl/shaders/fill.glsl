// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lists the records of each tile, in any order, and tells those with clip lines where these are.

layout(local_size_x = 64) in;

layout(std430, binding = 5) buffer RecordBlock { Record records[]; };
layout(std430, binding = 6) writeonly buffer ListBlock { uint list[]; };
layout(std430, binding = 7) buffer NextBlock { uint next[]; };              // [tile]: place in the list
layout(std430, binding = 4) readonly buffer ClipBlock { uvec2 clipped[]; }; // [pair]: lanes; place of the first's lines

layout(location = 0) uniform uint first_record;
layout(location = 1) uniform uint record_count;

void main() {
    uint index = first_record + gl_GlobalInvocationID.x;
    if (index >= record_count) return;
    uint box = records[index].box;
    if (box == 0u) return;
    if (has(box, CLIPPED)) {
        uvec2 of_pair = clipped[index / 16u];
        records[index].clip = of_pair.y + uint(bitCount(of_pair.x & ((1u << (index & 15u)) - 1u)));
    }
    uint where = records[index].field;
    uvec2 first, last;
    tiles_of(uvec2(where & 0xffffu, where >> 16), box, first, last);
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++) list[atomicAdd(next[y * tiles_per_row + x], 1u)] = index;
}
