// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lists the records of each tile, in any order.

layout(local_size_x = 64) in;

layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
layout(std430, binding = 5) readonly buffer RecordBlock { Record records[]; };
layout(std430, binding = 6) writeonly buffer ListBlock { uvec2 list[]; }; // record; its box

void main() {
    uint index = group_number() * 64u + gl_LocalInvocationID.x;
    if (index >= pair_count * 16u) return;
    uint box = records[index].box;
    if (box == 0u) return;
    uint where = records[index].field;
    uvec2 first, last;
    tiles_of(uvec2(where & 0xffffu, where >> 16), box, first, last);
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++) list[atomicAdd(tiles[y * tiles_per_row + x].next, 1u)] = uvec2(index, box);
}
