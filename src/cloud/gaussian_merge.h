// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One Gaussian for several, and what it takes: axes of ellipsoids.
#ifndef EWA_SRC_GAUSSIAN_MERGE_H
#define EWA_SRC_GAUSSIAN_MERGE_H

#include "ewa/gaussian.h"

/// The axes of a unit quaternion w x y z, as columns of a row-major matrix.
void ewa_gaussian_axes(const float rotation[4], double axes[9]);

/// Makes the columns of a matrix, whose ellipsoid is the image of the unit sphere, the axes of that. A scale of 0 has its axis across
/// the two others; of a point, or a line, `rotation` stays as it is.
void ewa_gaussian_of_columns(double columns[3][3], float scales[3], float rotation[4]);

/// Fills number `to` of `merged`, of the degree and the origin of `set`, with one Gaussian for some of a set, of which none is the
/// same twice: their mean, covariance and harmonics, where each counts by its opacity times its mean area as seen from all sides.
/// Its opacity times its area is at most the sum of theirs, and what it lets through at most what they would in its area, one behind
/// the other. Returns the mean square of the distances of the members' centres from its own. Any thread.
double ewa_gaussians_merge(const ewa_gaussians *set, const uint32_t *members, uint32_t count, ewa_gaussians *merged, size_t to);

#endif
