// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of trained Gaussians: packets of sixteen, in the order of their places.
#ifndef EWA_SRC_VOLUME_SPLATS_H
#define EWA_SRC_VOLUME_SPLATS_H

#include "ewa/gaussian_render.h"

/// The distance from the eye that 3DGS leaves out, in the units of its scenes.
#define EWA_GAUSSIAN_NEAR_WORLD 0.2

enum {
    EWA_SPLAT_LANES = 16,
    EWA_SPLATS_MAX = 1 << 26,
    EWA_SPLAT_MAX_HARMONICS = 3 * ((EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) - 1),
};

/// What a packet has of each splat.
enum {
    EWA_SPLAT_PLACE,                               ///< x y z, units of ewa_splats
    EWA_SPLAT_SCALE = EWA_SPLAT_PLACE + 3,         ///< three
    EWA_SPLAT_ROTATION = EWA_SPLAT_SCALE + 3,      ///< w x y z
    EWA_SPLAT_OPACITY = EWA_SPLAT_ROTATION + 4,    ///< 0: no splat
    EWA_SPLAT_COLOR,                               ///< harmonics of degree 0: red green blue
    EWA_SPLAT_HARMONIC_UNIT = EWA_SPLAT_COLOR + 3, ///< of the integers that stand for the others
    EWA_SPLAT_NUMBERS,
};

typedef float ewa_splat_packet[EWA_SPLAT_NUMBERS][EWA_SPLAT_LANES];

/// A shorter scale is at least that much of the longest one.
#define EWA_SPLAT_MIN_ASPECT 1e-4

struct ewa_splats {
    ewa_context *context;
    uint32_t packet_count, harmonic_count; ///< harmonics beyond degree 0 of three colours
    bool flat;                             ///< 2D Gaussians
    double unit_world;                     ///< a power of two
    double origin_world[3];
    ewa_splat_packet *packets;
    int16_t (*harmonics)[EWA_SPLAT_LANES]; ///< [packet * harmonic_count + 3 (harmonic - 1) + colour]
    ewa_splats_info info;
};

#endif
