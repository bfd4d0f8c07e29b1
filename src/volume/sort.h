// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Sorting by keys.
#ifndef EWA_SRC_VOLUME_SORT_H
#define EWA_SRC_VOLUME_SORT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// Sorts `count` numbers by keys, ties as they come; returns the list in which they end up. `room` numbers
/// after its beginning, each list is followed by as much room.
uint32_t *ewa_sort_by_keys(uint32_t *numbers, uint32_t *keys, uint32_t count, size_t room);

/// The key of a distance >= 0: such floats sort as their bits do.
static inline uint32_t ewa_sort_key(float distance) {
    uint32_t bits;
    memcpy(&bits, &distance, sizeof bits);
    return bits;
}

#endif
