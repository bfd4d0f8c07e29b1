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

/// Levels: parts of packets in a row have coarser ones behind all packets of the set, of a quarter of the splats each.
enum {
    EWA_SPLAT_PART_PACKETS = 256,
    EWA_SPLAT_LEVELS = 4,              ///< beside the splats themselves
    EWA_SPLAT_LEVELS_FROM = 1 << 17,   ///< sets of less have none, nor 2D Gaussians
    EWA_SPLAT_MERGED_PACKETS = 64 + 16 + 4 + 1, ///< of a part, all levels
};

/// A part that has levels.
typedef struct ewa_splat_part {
    float center[3], radius;         ///< a ball around the centres of its splats, units
    float spacing[EWA_SPLAT_LEVELS]; ///< RMS distance of its splats from what stands for them, units, level 1 on
} ewa_splat_part;

typedef float ewa_splat_packet[EWA_SPLAT_NUMBERS][EWA_SPLAT_LANES];

/// A shorter scale is at least that much of the longest one.
#define EWA_SPLAT_MIN_ASPECT 1e-4

struct ewa_splats {
    ewa_context *context;
    uint64_t serial;                       ///< of its packets: another for each set, a view has that of what it borrows
    uint32_t packet_count;                 ///< of the splats themselves
    uint32_t part_count;                   ///< of parts that have levels; 0: none has
    uint32_t harmonic_count;               ///< harmonics beyond degree 0 of three colours
    bool flat;                             ///< 2D Gaussians
    double unit_world;                     ///< a power of two
    double origin_world[3];
    ewa_splat_packet *packets;             ///< then EWA_SPLAT_MERGED_PACKETS of each part
    int16_t (*harmonics)[EWA_SPLAT_LANES]; ///< [packet * harmonic_count + 3 (harmonic - 1) + colour]
    ewa_splat_part *parts;
    uint16_t (*classes)[EWA_SPLAT_LANES];  ///< [packet] with those of the levels; NULL: there are none
    uint64_t lanes_serial; ///< of `shown_lanes`
    uint16_t *shown_lanes; ///< [packet] of a view (shown.h), which borrows all before: a bit for each lane; NULL: all are shown
    ewa_splats_info info;
};

/// Packets of a set with those of its levels.
static inline size_t ewa_splats_all_packets(const ewa_splats *splats) {
    return splats->packet_count + (size_t)splats->part_count * EWA_SPLAT_MERGED_PACKETS;
}

enum { EWA_SPLAT_ALL_LANES = (1 << EWA_SPLAT_LANES) - 1 };

/// The lanes of a packet that are shown, a bit for each.
static inline uint32_t ewa_splats_shown(const ewa_splats *splats, size_t packet) {
    return splats->shown_lanes ? splats->shown_lanes[packet] : EWA_SPLAT_ALL_LANES;
}

#endif
