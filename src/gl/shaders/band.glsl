// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What all programs see of a band of rows (src/gl/scene.h is the same in C), what they count, and keys as numbers.

layout(std140, binding = 0) uniform BandBlock {
    uvec2 picture_px; // where it ends
    uvec2 band_px;    // size, whole blocks
    uvec2 first_px;   // of the band in the picture
    uint tiles_per_row, tile_count, tile_side_px;
    float exponent_end;
    uint layers;      // surfaces of a pixel, at most
    uint merge_last;  // the last of them is all that is left
    uint with_codes;  // sRGB bytes are wanted, at the start of `result`
    int rgba_at, depth_at, normal_at, coverage_at; // in `result`, or -1
    uint pair_capacity, list_capacity, unit_capacity, request_capacity;
    uint unit_splats; // of a unit of work, at most
    uint group_limit; // groups of a dispatch along x
    uint parts;       // dispatches that passes over splats are done in, so that none takes long
    uint has_host_records; // the host has made what set-up asks it for
};

// All of it 0 when a band begins. Arguments of indirect dispatches: of lists, of units, then of each page's set-up, whose w is how
// many pairs there are up to there.
layout(std430, binding = 13) buffer CountBlock {
    uint pair_count, kept_count, near_count, clip_count, list_count, carry, unit_count, broken_count;
    uint culled_groups, divided_groups, stopped_count, unfinished_count, round_count, pad[3];
    uvec4 arguments[];
};

const uint OF_LISTS = 0u, OF_UNITS = 1u, OF_PAGES = 2u;

// Groups of a dispatch are numbered through.
uvec4 groups_for(uint count, uint rest) {
    uint x = max(min(count, group_limit), 1u);
    return uvec4(count == 0u ? 0u : x, (count + x - 1u) / x, 1u, rest);
}
uint group_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// A tile of work: where the next of its splats goes in `list` (in the end: where they end); how many there are; near
// surfels [first, end) of its field; the surface behind the first that is wanted, 0: none is; the steps of it that are done.
struct Tile { uint next, count, first_near, end_near, open, step; };

bool has(uint flags, uint flag) { return (flags & flag) != 0u; }

// Floats as numbers that keep their order; 0 is below all.
uint order_of(float f) {
    uint bits = floatBitsToUint(f);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float float_of(uint order) {
    return uintBitsToFloat((order & 0x80000000u) != 0u ? order & 0x7fffffffu : ~order);
}
const uint NEVER = 0x007fffffu; // order_of(-INF)
