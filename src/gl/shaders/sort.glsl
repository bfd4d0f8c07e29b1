// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One pass of a stable radix sort of items, each a key and a value, by eight bits of the key (src/gl/sort.c). Places come from
// counts and their sums, so that they are the same however invocations run. After scan.glsl. STAGE 0: how many items of each block
// have each digit; 1: how many of the blocks before have; 2: items to their places. Items with NO_KEY are left out.

layout(std430, binding = 0) readonly buffer KeyBlock { uint keys[]; };
layout(std430, binding = 1) readonly buffer ValueBlock { uint values[]; };
layout(std430, binding = 2) writeonly buffer SortedKeyBlock { uint sorted_keys[]; };
layout(std430, binding = 3) writeonly buffer SortedValueBlock { uint sorted_values[]; };
layout(std430, binding = 4) buffer TableBlock { uint table[]; }; // [digit][block], then [digit] of all blocks
layout(std430, binding = 5) readonly buffer ItemCountBlock { uint item_counts[]; };

layout(location = 0) uniform uint shift;       // of the digit
layout(location = 1) uniform uint count_at;    // in `item_counts`: how many items there are
layout(location = 2) uniform uint capacity;    // there are no more of them
layout(location = 3) uniform uint block_count; // of `capacity` items
layout(location = 4) uniform uint room;        // for what is sorted

uint digit_of(uint key) { return key >> shift & 255u; }

#if STAGE == 0
shared uint digits[256];

void main() {
    uint thread = gl_LocalInvocationIndex, block = group_number(), count = min(item_counts[count_at], capacity);
    digits[thread] = 0u;
    barrier();
    for (uint item = block * BLOCK + thread; item < min(count, (block + 1u) * BLOCK); item += 256u)
        if (keys[item] != NO_KEY) atomicAdd(digits[digit_of(keys[item])], 1u);
    barrier();
    if (block < block_count) table[thread * block_count + block] = digits[thread];
}
#elif STAGE == 1
// A digit by each group.
void main() {
    uint thread = gl_LocalInvocationIndex, digit = group_number(), before = 0u;
    for (uint first = 0u; first < block_count; first += 256u) {
        uint block = first + thread, own = 0u;
        if (digit < 256u && block < block_count) own = table[digit * block_count + block];
        uint up_to = sum_up_to(own);
        if (digit < 256u && block < block_count) table[digit * block_count + block] = before + up_to - own;
        before += scanned[255];
    }
    if (digit < 256u && thread == 0u) table[256u * block_count + digit] = before;
}
#else
shared uint next[256];      // [digit] place of the next item
shared uint having[8][256]; // [items / 32][digit] which of 256 items have it

void main() {
    uint thread = gl_LocalInvocationIndex, block = group_number(), count = min(item_counts[count_at], capacity);
    bool some = block < block_count;
    uint total = some ? table[256u * block_count + thread] : 0u;
    next[thread] = sum_up_to(total) - total + (some ? table[thread * block_count + block] : 0u);
    for (uint i = 0u; i < 8u; i++) having[i][thread] = 0u;
    for (uint first = block * BLOCK; first < min(count, (block + 1u) * BLOCK); first += 256u) {
        uint item = first + thread, word = thread / 32u, bit = 1u << thread % 32u;
        uint key = item < count ? keys[item] : NO_KEY, digit = digit_of(key);
        barrier();
        if (key != NO_KEY) atomicOr(having[word][digit], bit);
        barrier();
        if (key != NO_KEY) {
            uint to = next[digit] + uint(bitCount(having[word][digit] & (bit - 1u)));
            for (uint i = 0u; i < word; i++) to += uint(bitCount(having[i][digit]));
            if (to < room) {
                sorted_keys[to] = key;
                sorted_values[to] = values[item];
            }
        }
        barrier();
        for (uint i = 0u; i < 8u; i++) {
            next[thread] += uint(bitCount(having[i][thread]));
            having[i][thread] = 0u;
        }
    }
}
#endif
