// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Points on a mesh that keep their distance.
#ifndef EWA_SRC_PREPARE_MESH_DARTS_H
#define EWA_SRC_PREPARE_MESH_DARTS_H

#include "prepare/mesh_surface.h"

typedef struct mesh_dart {
    float position_world[3];
    uint32_t triangle; ///< of the surface
} mesh_dart;

/// Least distances within one smooth part, in spacings: between points of its inside and any, between points
/// of the rows along its sharp edges. The first one makes the density one point per spacing squared.
#define MESH_INNER_DISTANCE 0.775
#define MESH_ROW_DISTANCE   0.62

/// How far rows are from their edge, in spacings.
#define MESH_ROW_INSET 0.2

/// Estimated points of a sampling: its inside and its rows.
double ewa_mesh_dart_estimate(const mesh_surface *surface, double spacing_world);

/// Throws darts. The caller releases `*darts`, which are `*capacity`, with ewa_release(); `*count` of them
/// are used. The same for any number of threads. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
ewa_status ewa_mesh_throw_darts(const mesh_surface *surface, double spacing_world, uint64_t seed,
                                mesh_dart **darts, uint64_t *capacity, uint64_t *count);

#endif
