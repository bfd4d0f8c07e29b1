// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where a sample is among the packets.
#ifndef EWA_SRC_WARP_PLACE_H
#define EWA_SRC_WARP_PLACE_H

#include "warp/warp.h"

/// Packet of the sample at column x, row y of a source.
static inline uint64_t ewa_warp_packet(const ewa_warp_source *source, uint32_t x, uint32_t y) {
    const uint64_t cell = (uint64_t)(y / EWA_WARP_CELL_PX) * source->cells_x + x / EWA_WARP_CELL_PX;
    const uint32_t row = y % EWA_WARP_CELL_PX / EWA_WARP_BLOCK_PX,
                   column = x % EWA_WARP_CELL_PX / EWA_WARP_BLOCK_PX;
    return (source->first_group + cell) * EWA_GRID_GROUP + row * EWA_WARP_BLOCK_PX + column;
}

/// Lane of it there.
static inline uint32_t ewa_warp_lane(uint32_t x, uint32_t y) {
    return y % EWA_WARP_BLOCK_PX * EWA_WARP_BLOCK_PX + x % EWA_WARP_BLOCK_PX;
}

#endif
