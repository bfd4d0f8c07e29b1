// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which surfels of a packet one coarser surfel stands for: up to four neighbours of one surface.
#ifndef EWA_SRC_SURFACE_GROUPS_H
#define EWA_SRC_SURFACE_GROUPS_H

#include "surface/packet.h"

#include <stdint.h>

enum { EWA_GROUP_SURFELS = 4 }; ///< at most

/// The lanes of each group of a packet: bit per lane.
typedef struct ewa_packet_groups {
    uint32_t count;
    uint16_t lanes[EWA_PACKET_LANES];
} ewa_packet_groups;

/// The unit normals of a packet, one array per coordinate.
void ewa_packet_normals(const ewa_packet *packet, float normal[3][EWA_PACKET_LANES]);

/// Divides a packet's surfels, all with a sigma above zero, into compact groups of as equal sizes as can be,
/// along the widest of the axes of their places and normals, but first of all where there is a gap. Groups
/// come in the order of their first lanes. `normal` is ewa_packet_normals(); `cutoff` is F. Any thread.
void ewa_groups_make(const ewa_packet *packet, const float normal[3][EWA_PACKET_LANES], double cutoff,
                     ewa_packet_groups *groups);

#endif
