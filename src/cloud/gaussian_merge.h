// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One Gaussian for several, and what it takes: axes of ellipsoids, and what each counts for.
#ifndef EWA_SRC_GAUSSIAN_MERGE_H
#define EWA_SRC_GAUSSIAN_MERGE_H

#include "ewa/gaussian.h"

/// The axes of a unit quaternion w x y z, as columns of a row-major matrix.
void ewa_gaussian_axes(const float rotation[4], double axes[9]);

/// Makes the columns of a matrix, whose ellipsoid is the image of the unit sphere, the axes of that. A scale of 0 has its axis across
/// the two others; of a point, or a line, `rotation` stays as it is.
void ewa_gaussian_of_columns(double columns[3][3], float scales[3], float rotation[4]);

/// What a Gaussian counts for when it is merged.
typedef struct ewa_gaussian_mass {
    double mass;          ///< opacity times mean area
    double depth;         ///< optical depth times mean area
    double covariance[6]; ///< xx xy xz yy yz zz
} ewa_gaussian_mass;

/// Fills what Gaussian `i` of a set counts for. Any thread.
void ewa_gaussian_weigh(const ewa_gaussians *set, size_t i, ewa_gaussian_mass *mass);

/// Fills number `to` of `merged`, of the degree and the origin of `set`, with one Gaussian for some of a set, of which none is the
/// same twice, and whose masses are given in their order: their mean, covariance and harmonics, where each counts by its opacity times its mean area as seen from all sides;
/// where `merged` has classes, that of most of it.
/// Its opacity times its area is at most the sum of theirs, and what it lets through at most what they would in its area, one behind
/// the other. Returns the mean square of the distances of the members' centres from its own. Any thread.
double ewa_gaussians_merge(const ewa_gaussians *set, const uint32_t *members, const ewa_gaussian_mass *masses, uint32_t count,
                           ewa_gaussians *merged, size_t to);

#endif
