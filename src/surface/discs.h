// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Discs straight from a cloud's streams of the types that files have, many times faster than surfel by
// surfel. What is drawable and what the numbers mean is as ewa_surfel_read() says.
#ifndef EWA_SRC_SURFACE_DISCS_H
#define EWA_SRC_SURFACE_DISCS_H

#include "surface/pack.h"
#include "surface/surfel.h"

/// The streams of a cloud of discs: positions of float or double, normals and radii of float, colours absent
/// or 8-bit.
typedef struct ewa_discs {
    const ewa_surfel_reader *reader;
    const ewa_pack_kernels *kernels;
    bool wide_positions; ///< double
    bool packed;         ///< floats side by side, which the kernels can look at
    ewa_safe_range safe;
} ewa_discs;

/// Box of the drawable surfels, from the cloud's origin.
typedef struct ewa_disc_facts {
    uint64_t drawable_count;
    double low[3], high[3];
} ewa_disc_facts;

/// Returns false when the cloud's streams are of other kinds.
bool ewa_discs_open(const ewa_surfel_reader *reader, const ewa_pack_kernels *kernels, ewa_discs *discs);

/// Notes in `drawable` which of the points [first, first + count) can be drawn, and measures those. Any
/// thread.
void ewa_discs_measure(const ewa_discs *discs, uint64_t first, uint64_t count, uint8_t *drawable,
                       ewa_disc_facts *facts);

/// Sets the lanes of a packet but for its colours and normal codes to the drawable discs points[0 .. count),
/// 1 to 16 of them, and the normals that belong to it; the first disc fills the lanes that are left. Lengths
/// are in units of `unit` world units; positions are relative to `first`, which is set to the first disc's.
void ewa_discs_load(const ewa_discs *discs, double unit, const uint32_t *points, uint32_t count,
                    double first[3], ewa_packet *packet, float normal[3][EWA_PACKET_LANES]);

/// Asks for the memory of one disc that will be loaded soon.
void ewa_discs_prefetch(const ewa_discs *discs, uint32_t point);

#endif
