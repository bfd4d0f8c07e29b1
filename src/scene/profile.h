// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The strip beside a line on the map.
#ifndef EWA_SRC_SCENE_PROFILE_H
#define EWA_SRC_SCENE_PROFILE_H

#include "ewa/homogeneous.h"
#include "ewa/profile.h"

/// A straight piece of a line. Directions are unit vectors across the up axis.
typedef struct ewa_strip_piece {
    ewa_vec3 from_world, along_world, right_world;
    double station, length_world; ///< of its first corner; of the piece
} ewa_strip_piece;

typedef struct ewa_strip {
    ewa_context *context;
    uint32_t piece_count, capacity;
    ewa_strip_piece *pieces;
    double half_width_world, length_world, up_world[3];
    double low_world[3], high_world[3]; ///< a box around it, without ends along an up axis of the world
} ewa_strip;

/// Makes the strip of a line; `up_world` is a unit vector. The caller frees it. Errors: EWA_ERROR_ARGUMENT (corners that are
/// not finite, no length), EWA_ERROR_MEMORY.
ewa_status ewa_strip_make(ewa_context *context, const double *corners_world, uint32_t corner_count,
                          const double up_world[3], double width_world, ewa_strip *strip);
void ewa_strip_free(ewa_strip *strip);

/// Finds how far along the strip and to its right a place is; false: it is not in it.
bool ewa_strip_locate(const ewa_strip *strip, const double place_world[3], double *station, double *offset);

#endif
