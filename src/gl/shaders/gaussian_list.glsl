// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lists each visible splat in each tile that it touches, front to back. After gaussian_frame.glsl. STAGE 0: tiles of each block of
// splats; 1: of the blocks before, by one group; 2: where the tiles of each splat begin; 3: a splat in a tile by each invocation.

layout(std430, binding = 0) readonly buffer SortedBlock { uint sorted[]; }; // records, front to back
layout(std430, binding = 1) readonly buffer BoxBlock { uvec2 boxes[]; };
layout(std430, binding = 2) buffer SumBlock { uint sums[]; };               // [block of splats] tiles
layout(std430, binding = 3) buffer StartBlock { uint starts[]; };           // [splat]
layout(std430, binding = 4) writeonly buffer TileBlock { uint tiles[]; };   // [pair]
layout(std430, binding = 5) writeonly buffer RecordNumberBlock { uint numbers[]; }; // [pair]

// Splats for which there is room: none where there is too little, for then the frame is drawn again.
uint splats_there() { return visible_count <= visible_capacity ? visible_count : 0u; }

uvec2 corner(uint packed_) { return uvec2(packed_ & 0xffffu, packed_ >> 16); }

uint tiles_of(uint splat) {
    uvec2 box = boxes[sorted[splat]], sides = corner(box.y) - corner(box.x);
    return sides.x * sides.y;
}

#if STAGE == 0
void main() {
    uint block = group_number(), count = splats_there(), own = 0u;
    for (uint splat = block * BLOCK + gl_LocalInvocationIndex; splat < min(count, (block + 1u) * BLOCK); splat += 256u)
        own += tiles_of(splat);
    uint sum = sum_up_to(own);
    if (block < block_count && gl_LocalInvocationIndex == 255u) sums[block] = sum;
}
#elif STAGE == 1
void main() {
    uint before = 0u;
    for (uint first = 0u; first < block_count; first += 256u) {
        uint block = first + gl_LocalInvocationIndex, own = block < block_count ? sums[block] : 0u;
        uint up_to = sum_up_to(own);
        if (block < block_count) sums[block] = before + up_to - own;
        before += scanned[255];
    }
    if (gl_LocalInvocationIndex == 0u) pair_count = before;
}
#elif STAGE == 2
void main() {
    uint block = group_number(), count = splats_there(), before = block < block_count ? sums[block] : 0u;
    for (uint first = block * BLOCK; first < min(count, (block + 1u) * BLOCK); first += 256u) {
        uint splat = first + gl_LocalInvocationIndex, own = splat < count ? tiles_of(splat) : 0u;
        uint up_to = sum_up_to(own);
        if (splat < count) starts[splat] = before + up_to - own;
        before += scanned[255];
    }
}
#else
void main() {
    uint pair = group_number() * 256u + gl_LocalInvocationIndex;
    if (pair >= min(pair_count, pair_capacity)) return;
    uint low = 0u, high = splats_there(); // the last splat whose tiles begin there or before
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (starts[middle] <= pair) low = middle;
        else high = middle;
    }
    uint number = sorted[low], place = pair - starts[low];
    uvec2 first = corner(boxes[number].x), end = corner(boxes[number].y);
    uint width = end.x - first.x;
    tiles[pair] = (first.y + place / width) * tiles_per_row + first.x + place % width;
    numbers[pair] = number;
}
#endif
