// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The contract of the packing kernels: sixteen surfels in double precision to one packet and its bounds. Each
// does the same operations in the same order as the others, so all give the same bytes.
#ifndef EWA_SRC_SPLAT_PACK_H
#define EWA_SRC_SPLAT_PACK_H

#include "kernels/packet.h"

/// Sixteen surfels, one array per number.
typedef struct ewa_lanes {
    double center_world[3][EWA_PACKET_LANES];
    double normal[3][EWA_PACKET_LANES];   ///< of any length whose square is a number
    double sigma_world[EWA_PACKET_LANES]; ///< of the major axis
    double ratio[EWA_PACKET_LANES];       ///< minor over major, [0, 1]
} ewa_lanes;

/// One entry of ewa_packet_bounds.
typedef struct ewa_packet_bound {
    float center[3], radius, axis[3], cone_sine;
} ewa_packet_bound;

/// Sets positions, sigma, ratio and normal codes of all lanes of a packet, and the sphere around the supports
/// of `cutoff` sigmas with the cone around the normals.
typedef void ewa_pack_kernel(const ewa_lanes *lanes, const double origin_world[3], double cutoff,
                             ewa_packet *packet, ewa_packet_bound *bound);

ewa_pack_kernel ewa_pack_portable;
#if defined(__x86_64__)
ewa_pack_kernel ewa_pack_avx2, ewa_pack_avx512;
#endif

#endif
