// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where the list of each tile is, and units of work of it: a tile by each invocation. Lists may lie in any order, so that one sum
// for each group of tiles finds them room.

layout(local_size_x = 64) in;

layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
layout(std430, binding = 7) writeonly buffer UnitBlock { uvec4 units[]; }; // tile; first, end of the list or of near ones; near
layout(std430, binding = 9) readonly buffer RangeBlock { uvec2 near_ranges[]; }; // [field]: near surfels

shared uint group_list, group_units, first_of_list, first_of_units;

uint units_for(uint count) { return (count + unit_splats - 1u) / unit_splats; }

void write_units(uint tile, uint at, uint first, uint end, uint near) {
    for (uint from = first; from < end; from += unit_splats, at++)
        if (at < unit_capacity) units[at] = uvec4(tile, from, min(end, from + unit_splats), near);
}

void main() {
    uint tile = group_number() * 64u + gl_LocalInvocationID.x, count = 0u;
    uvec2 near = uvec2(0u);
    if (gl_LocalInvocationIndex == 0u) group_list = group_units = 0u;
    barrier();
    if (tile < tile_count) {
        count = tiles[tile].count;
        uvec2 field = uvec2(tile % tiles_per_row, tile / tiles_per_row) * tile_side_px / 128u;
        if (has_host_records != 0u) near = near_ranges[field.y * ((picture_px.x + 127u) / 128u) + field.x];
    }
    uint unit_number = units_for(count) + units_for(near.y - near.x);
    uint in_list = atomicAdd(group_list, count), in_units = atomicAdd(group_units, unit_number);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        first_of_list = atomicAdd(list_count, group_list);
        if (first_of_list + group_list < first_of_list) atomicAdd(carry, 1u);
        first_of_units = atomicAdd(unit_count, group_units);
    }
    barrier();
    if (tile < tile_count) {
        uint first = first_of_list + in_list, at = first_of_units + in_units;
        tiles[tile].next = first;
        tiles[tile].first_near = near.x;
        tiles[tile].end_near = near.y;
        write_units(tile, at, first, first + count, 0u);
        write_units(tile, at + units_for(count), near.x, near.y, 1u);
    }
    // The last group says how much there is to do; nothing where something has no room, or is the host's to make.
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    if (atomicAdd(divided_groups, 1u) + 1u < gl_NumWorkGroups.x * gl_NumWorkGroups.y) return;
    uint lists = atomicAdd(list_count, 0u), all_units = atomicAdd(unit_count, 0u);
    bool fits = pair_count <= pair_capacity && atomicAdd(carry, 0u) == 0u && lists <= list_capacity &&
                all_units <= unit_capacity && (has_host_records != 0u || near_count + clip_count == 0u);
    arguments[OF_UNITS] = groups_for(fits ? (all_units + parts - 1u) / parts : 0u, 0u);
    if (!fits) arguments[OF_LISTS] = groups_for(0u, 0u);
}
