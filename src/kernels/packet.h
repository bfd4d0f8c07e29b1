// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of surfels: packets of sixteen neighbours in Morton order, 30 bytes per surfel, and per
// packet a bounding sphere with a normal cone, 2 bytes per surfel.
#ifndef EWA_SRC_KERNELS_PACKET_H
#define EWA_SRC_KERNELS_PACKET_H

#include <stdint.h>

enum { EWA_PACKET_LANES = 16 };

/// Sixteen surfels. Positions are relative to the surfels' local origin; a sigma of 0 marks an empty lane.
///
/// The normal is octahedral (each coordinate times 32767). `angle` turns the major kernel axis within the
/// tangent plane: diamond angle over [0, 2), 32768 steps per unit, from the frame of ewa_packet_frame()
/// (packet.c); `ratio` is the minor sigma over the major one, times 65535. Colour is (value - offset) / scale
/// of the whole set, times 65535.
typedef struct ewa_packet {
    float x[16], y[16], z[16];
    float sigma[16];
    int16_t oct_x[16], oct_y[16];
    uint16_t angle[16], ratio[16];
    uint16_t red[16], green[16], blue[16];
} ewa_packet;

/// Bounds of all packets, one entry each: a sphere around the supports, and a cone that holds all normals.
typedef struct ewa_packet_bounds {
    float *center_x, *center_y, *center_z;
    float *radius;                   ///< -infinity: the packet is empty, and outside of every view
    float *axis_x, *axis_y, *axis_z; ///< unit
    float *cone_sine;                ///< sine of the cone's half angle; 2 when it is 90 degrees or more
} ewa_packet_bounds;

#endif
