// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sorting by keys: few by insertion, many digit by digit.
#include "volume/sort.h"

enum { RADIX_BITS = 11, RADIX = 1 << RADIX_BITS, FEW = 24 };

uint32_t *ewa_sort_by_keys(uint32_t *numbers, uint32_t *keys, uint32_t count, size_t room) {
    if (count <= FEW) {
        for (uint32_t i = 1; i < count; i++) {
            const uint32_t key = keys[i], number = numbers[i];
            uint32_t to = i;
            for (; to > 0 && keys[to - 1] > key; to--) keys[to] = keys[to - 1], numbers[to] = numbers[to - 1];
            keys[to] = key, numbers[to] = number;
        }
        return numbers;
    }
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        low = keys[i] < low ? keys[i] : low;
        high = keys[i] > high ? keys[i] : high;
    }
    uint32_t *other_numbers = numbers + room, *other_keys = keys + room;
    for (uint32_t shift = 0; shift < 32 && (high - low) >> shift; shift += RADIX_BITS) {
        uint32_t starts[RADIX + 1] = {0};
        for (uint32_t i = 0; i < count; i++) starts[((keys[i] - low) >> shift & (RADIX - 1)) + 1]++;
        for (uint32_t i = 0; i < RADIX; i++) starts[i + 1] += starts[i];
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t to = starts[(keys[i] - low) >> shift & (RADIX - 1)]++;
            other_keys[to] = keys[i];
            other_numbers[to] = numbers[i];
        }
        uint32_t *swap = numbers;
        numbers = other_numbers, other_numbers = swap;
        swap = keys;
        keys = other_keys, other_keys = swap;
    }
    return numbers;
}
