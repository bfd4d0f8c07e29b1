// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of surfels: packets of sixteen neighbours in Morton order, 30 bytes per surfel, and per
// packet its place, a bounding sphere, a normal cone and the form of its colours, 2 bytes per surfel. What a
// surfel is: docs/math.md section 2; what storing costs: docs/conventions.md, precision.
#ifndef EWA_SRC_SURFACE_PACKET_H
#define EWA_SRC_SURFACE_PACKET_H

#include <stdint.h>

enum {
    EWA_PACKET_LANES = 16,
    EWA_CONE_BITS = 11,      ///< of each octahedral coordinate of a cone's axis
    EWA_CONE_AXIS = 1023,    ///< code of 1, to which 1023 is added
    EWA_CONE_SINE = 1022,    ///< code of 1; the next one stands for cones of 90 degrees and more
    EWA_BILLBOARD = -32768,  ///< code of oct_x: a circle parallel to the picture, without a normal
    EWA_RADIUS_SHIFT = 15,   ///< a radius is the float of its code shifted by so many bits
    EWA_COLOR_SIGN = 1 << 15 ///< see ewa_packet_bounds.colors
};

/// Sixteen surfels. Positions are relative to the packet's centre; a sigma of 0 marks an empty lane.
///
/// The normal is octahedral (each coordinate times 32767). `ratio` is the fourth root of the minor sigma over
/// the major one, times 65535: as exact for needles as for circles. `angle` turns the major kernel axis
/// within the tangent plane: diamond angle over [0, 2), 32768 steps per unit, from the frame of
/// packet_frame() (packets.c). Of the three colours' codes ewa_packet_bounds tells the form.
typedef struct ewa_packet {
    float x[16], y[16], z[16];
    float sigma[16];
    int16_t oct_x[16], oct_y[16];
    uint16_t angle[16], ratio[16];
    uint16_t red[16], green[16], blue[16];
} ewa_packet;

/// What is known of whole packets, one entry each.
///
/// Centres are in double precision and relative to the surfels' origin: the camera meets packets there, and
/// surfels relative to their packets. The sphere around the supports has the same centre.
///
/// The form of colours: bits 0 to 7 are 128 + e, bits 8 to 11 are k, EWA_COLOR_SIGN says that the upper bit
/// of every code is a sign. With n the code, or the lower 15 bits of it:
/// - unsigned, k = 0: n 2^e / 65535;
/// - else 2^e (m - 1), m the float whose bits are those of 1 plus n shifted by 7 + k (signed ones: by 8 + k).
///   So k is the number of exponent bits, and the value has a relative precision where it is above 2^e.
typedef struct ewa_packet_bounds {
    double *center_x, *center_y, *center_z;
    uint16_t *radius; ///< upper bits of the float; 0: the packet is empty
    uint16_t *colors; ///< their form
    uint32_t *cone;   ///< of the normals: octahedral axis, x below y, then the sine of its half angle
} ewa_packet_bounds;

#endif
