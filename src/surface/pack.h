// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the packing kernels: each does the same correctly rounded operations in the same order as
// the others, so all give the same bytes.
#ifndef EWA_SRC_SURFACE_PACK_H
#define EWA_SRC_SURFACE_PACK_H

#include "surface/packet.h"
#include "wide/isa.h"

enum { EWA_BOX_FLOATS = 3 * EWA_PACKET_LANES };

/// Radii of discs that can be drawn for certain.
typedef struct ewa_safe_range {
    float radius_min, radius_max;
} ewa_safe_range;

/// The largest sigma in a packet: of kernels beyond, which are this many times as large as their set, nothing
/// but the middle can be seen.
#define EWA_MAX_SIGMA 1e30

static inline float ewa_packed_sigma(double sigma) {
    return (float)(sigma < EWA_MAX_SIGMA ? sigma : EWA_MAX_SIGMA);
}

typedef struct ewa_pack_kernels {
    /// Looks at `group_count` times sixteen discs whose numbers lie side by side and stops at the first group
    /// that holds a radius out of range, a position that is not finite or a normal that is zero or not. Grows
    /// the box of the groups before that one, of which it returns the number: entry k is of coordinate k % 3.
    uint64_t (*measure_discs)(const ewa_safe_range *range, const float *position, const float *normal,
                       const float *radius, uint64_t group_count, float low[EWA_BOX_FLOATS],
                       float high[EWA_BOX_FLOATS]);

    /// Sets the normal codes of a packet from normals of any length but zero, one array per coordinate.
    void (*code_normals)(const float normal[3][EWA_PACKET_LANES], ewa_packet *packet);

    /// Sets normals, sigmas, ratios and angles of a packet from normals whose largest coordinate is in
    /// [1e-15, 1e15] and from conjugate axes of the kernels, tangent to the surfels and possibly skewed, the
    /// longer one's largest coordinate in [1e-30, 1e30]; one array per coordinate.
    void (*code_ellipses)(const float normal[3][EWA_PACKET_LANES], const float axis_u[3][EWA_PACKET_LANES],
                          const float axis_v[3][EWA_PACKET_LANES], ewa_packet *packet);

    /// Moves the positions of packets from `starts`, which they are relative to, to the middles of their
    /// boxes, rounded, which become their centres, and sets `bounds` [first, first + 16) but for the colours:
    /// spheres around the supports of `cutoff` sigmas, cones around the normals. `packets` are the `count` (1
    /// to 16) packets there; all their lanes count. The entries of packets that do not exist get those of the
    /// first. Returns the mask of packets with a surfel that is `reach` of its sigmas or more from the
    /// centre.
    uint32_t (*bound_packets)(ewa_packet *packets, uint32_t count, const double starts[EWA_PACKET_LANES][3],
                              float cutoff, float reach, const ewa_packet_bounds *bounds, uint64_t first);
} ewa_pack_kernels;

EWA_DECLARE_VERSIONS(const ewa_pack_kernels, ewa_pack_kernels);

#endif
