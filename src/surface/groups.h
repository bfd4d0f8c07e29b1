// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which surfels one coarser surfel stands for: up to four neighbours of one surface.
#ifndef EWA_SRC_SURFACE_GROUPS_H
#define EWA_SRC_SURFACE_GROUPS_H

#include "surface/packets.h"

enum {
    EWA_GROUP_SURFELS = 4,  ///< at most
    EWA_WINDOW_PACKETS = 4, ///< at most, that are divided together
    EWA_WINDOW_LANES = EWA_WINDOW_PACKETS * EWA_PACKET_LANES,
};

/// Some packets that follow each other, decoded as far as groups need it. Lane l is that of packet first + l /
/// 16. A sigma of 0: no surfel.
typedef struct ewa_window {
    uint32_t first, packet_count;
    float place[3][EWA_WINDOW_LANES]; ///< from the centre of the first packet, in the surfels' unit
    float normal[3][EWA_WINDOW_LANES], sigma[EWA_WINDOW_LANES];
} ewa_window;

void ewa_window_read(const ewa_surfels *surfels, uint32_t first, uint32_t packet_count, ewa_window *window);

/// Divides the surfels of a window into compact groups of as equal sizes as can be, along the widest of the
/// axes of their places and normals, but first of all where there is a gap. Sets `order` to their lanes, those
/// of a group side by side, and a bit of `starts` for the first one of each group. Returns the number of
/// groups. Any thread.
uint32_t ewa_groups_make(const ewa_window *window, double cutoff, uint8_t order[EWA_WINDOW_LANES],
                         uint16_t starts[EWA_WINDOW_PACKETS]);

#endif
