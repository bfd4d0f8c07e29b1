// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Poisson-disc samples of a mesh: points that keep a minimum distance.
#ifndef EWA_SRC_MESH_POISSON_DISC_H
#define EWA_SRC_MESH_POISSON_DISC_H

#include "mesh/surface.h"

/// A place in the box of the surface, in units that make its longest edge 2^32: finer than floats, and even.
typedef struct poisson_sample {
    uint32_t at[3];
    uint32_t triangle; ///< of the surface
} poisson_sample;

/// Length of a unit of sample positions.
static inline double ewa_mesh_poisson_unit(const mesh_surface *surface) {
    const double *extent = surface->extent_world;
    return fmax(extent[0], fmax(extent[1], extent[2])) * 0x1p-32;
}

/// Smallest distances within one smooth part, in spacings: between points of its inside and any, between
/// points of the rows along its sharp edges. The first one makes the density one point per spacing squared.
#define MESH_INNER_DISTANCE 0.775
#define MESH_ROW_DISTANCE   0.62

/// How far rows are from their edge, in spacings.
#define MESH_ROW_INSET 0.2

/// Estimated points of the rows along all edges, times the spacing.
double ewa_mesh_poisson_rows(const mesh_surface *surface);

/// Estimated points of a sampling: its inside and its rows.
double ewa_mesh_poisson_estimate(const mesh_surface *surface, double spacing_world);

/// Samples by dart throwing. The caller releases `*samples`, which are `*capacity`, with ewa_release();
/// `*count` of them are used. The same for any number of threads. Errors: EWA_ERROR_LIMIT, EWA_ERROR_MEMORY,
/// EWA_CANCELLED.
ewa_status ewa_mesh_sample_poisson_disc(const mesh_surface *surface, double spacing_world, uint64_t seed,
                                        poisson_sample **samples, uint64_t *capacity, uint64_t *count);

#endif
