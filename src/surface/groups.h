// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the kernels that find which surfels one coarser surfel stands for, up to four neighbours of one surface, and
// what it is like. All versions give the same bytes.
#ifndef EWA_SRC_SURFACE_GROUPS_H
#define EWA_SRC_SURFACE_GROUPS_H

#include "surface/packet.h"
#include "wide/isa.h"

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

/// What else becomes a mean of surfels, of each lane of a window.
typedef struct ewa_window_means {
    float aspect[EWA_WINDOW_LANES]; ///< minor sigma over major one
    float color[3][EWA_WINDOW_LANES], opacity[EWA_WINDOW_LANES], curvature[EWA_WINDOW_LANES];
    float clipped[EWA_WINDOW_LANES]; ///< 1: has clip lines; 0
} ewa_window_means;

/// Groups of a window, one to a lane. Lanes behind `count` are like the first.
typedef struct ewa_groups {
    int32_t lanes[EWA_GROUP_SURFELS][EWA_PACKET_LANES]; ///< their members; of those that are missing the first
    float sizes[EWA_PACKET_LANES];                      ///< members
    uint32_t count;
} ewa_groups;

/// What stands for groups, one to a lane; lengths in the surfels' unit.
typedef struct ewa_representatives {
    float place[3][EWA_PACKET_LANES]; ///< from the centre of the window's first packet
    float moved[3][EWA_PACKET_LANES]; ///< from the place of the member that was picked
    float normal[3][EWA_PACKET_LANES], sigma[EWA_PACKET_LANES], color[3][EWA_PACKET_LANES];
    float opacity[EWA_PACKET_LANES], curvature[EWA_PACKET_LANES];
    int32_t pick[EWA_PACKET_LANES]; ///< the member's lane of the window, whose material and shape it has
} ewa_representatives;

typedef struct ewa_group_kernels {
    /// Decodes the packets [first, first + packet_count), of 1 to EWA_WINDOW_PACKETS, of all `packets`.
    void (*read)(const ewa_packet *packets, const ewa_packet_bounds *bounds, uint32_t first, uint32_t packet_count,
                 ewa_window *window);

    /// Divides the surfels of a window into compact groups of as equal sizes as can be, along the widest of the
    /// axes of their places and normals, but first of all where there is a gap. `cutoff` is the radius of supports in
    /// sigmas. Sets `order` to their lanes, those of a group side by side, and a bit of `starts` for the first one of
    /// each group. Returns the number of groups.
    uint32_t (*divide)(const ewa_window *window, float cutoff, uint8_t order[EWA_WINDOW_LANES],
                       uint16_t starts[EWA_WINDOW_PACKETS]);

    /// Makes what stands for groups: in their middles, where these are on their surface, else at the nearest members. Sigmas
    /// grow by `growth` beside what keeps the area.
    void (*represent)(const ewa_window *window, const ewa_window_means *means, const ewa_groups *groups, float cutoff,
                      float growth, ewa_representatives *made);
} ewa_group_kernels;

EWA_DECLARE_VERSIONS(const ewa_group_kernels, ewa_group_kernels);

#endif
