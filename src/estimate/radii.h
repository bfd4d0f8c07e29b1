// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How large the surfel of a place is: closed where the surface is sampled, limited where it is not, small for
// what is no surface. Constants were chosen with measure/radii.c (docs/quality.md).
#ifndef EWA_SRC_ESTIMATE_RADII_H
#define EWA_SRC_ESTIMATE_RADII_H

#include "estimate/local.h"

/// What is noted about a place that was measured by few neighbours, in one byte.
enum {
    RADIUS_THIN = 1,     ///< to be measured by many: its neighbours are almost on a line
    RADIUS_DOUBTFUL = 2, ///< the same: they do not tell how far its cell reaches
    RADIUS_AGAIN = RADIUS_THIN | RADIUS_DOUBTFUL,
    RADIUS_NOTE_SHIFT = 2, ///< above: to be measured again: scatter; else radius over spacing
    RADIUS_NOTE_MAX = 63,
    RADIUS_NOTE_RATIO = 16, ///< steps per 1 of radius over spacing
};

/// What decides about a radius; lengths in one unit, whichever.
typedef struct radius_place {
    double spacing; ///< 1 / sqrt(samples per area) at the place, not above the median of those around it
    double reach;   ///< of its cell where that is closed
    double limit;   ///< of the radius that closes the cell
    double scatter; ///< 0: part of a surface, to 1: not at all
} radius_place;

/// Returns the support radius: at least `scale` spacings, and for a place of a surface enough for kernels of
/// cutoff `cutoff` to cover its own cell, up to the limit: then irregular sampling leaves no hole.
double ewa_radius(const radius_place *place, double scale, double cutoff);

/// The same for local_kernels.size(), with `limit` in spacings; steps are those of notes. Where `gaps_later` discs
/// of places that lie on a surface cover their cells barely, and what that leaves open is closed afterwards.
local_sizing ewa_radius_sizing(double limit, double scale, double cutoff, bool gaps_later);

/// Returns how little a neighbourhood is a surface, 0 to 1, by the share of its variance along the normal.
double ewa_radius_scatter(double variation);

/// Returns how much a neighbourhood of many points is strewn in space, 0 to 1, likewise.
double ewa_radius_strewn(double variation);

/// Returns how little a place is part of what is around it, 0 to 1, by its spacing and the median around.
double ewa_radius_lone(double spacing, double around);

/// Makes places doubtful whose radius is over `limit` times the low spacings among the places before and
/// after them along the Z-order curve, most of which are near: they may be far from all others. Spacings and
/// notes are by place. Workers share the places.
void ewa_radius_doubt_sparse(ewa_context *context, const float *spacing, uint32_t place_count, double limit,
                             uint8_t *notes);

#endif
