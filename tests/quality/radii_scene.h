// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Samplings whose estimated radii are judged: pinholes in pictures, and sizes against the spacing around.
#ifndef EWA_TESTS_RADII_SCENE_H
#define EWA_TESTS_RADII_SCENE_H

#include "check.h"

#include <stdbool.h>

typedef enum radii_kind {
    RADII_PLANE,   ///< uniform random points of a square
    RADII_SPHERE,  ///< the same on a sphere
    RADII_TERRAIN, ///< the same, by area of the map, on hills
    RADII_LINES,   ///< scan lines on a plane, `detail` times as far from each other as points along them
    RADII_NOISY,   ///< a random plane with Gaussian noise of `detail` spacings across
    RADII_STEP,    ///< a random plane, on one side `detail` times as far apart
    RADII_LONE,    ///< a random plane, and one point in 5000 far above it
    RADII_CURVE,   ///< a helix: no surface
    RADII_FOG,     ///< random points of a cube: no surface
    RADII_GARDEN,  ///< ever sparser points around a place: a sparse reconstruction
} radii_kind;

/// Fills `count` positions; the plane has edge 2, all else about that size.
void radii_scene_fill(radii_kind kind, double detail, uint32_t count, float *xyz);

/// The nearest places of a set of points, plainly: a k-d tree in double precision, duplicates being one
/// place.
typedef struct radii_tree radii_tree;

radii_tree *radii_tree_make(const double (*place)[3], uint32_t count);
void radii_tree_free(radii_tree *tree);

/// Writes the `wanted` nearest other places of a position, nearest first; returns how many there are.
uint32_t radii_tree_nearest(const radii_tree *tree, const double p[3], uint32_t wanted, uint32_t *found,
                            double *distance);

/// Radii of discs against the spacing around them: the median over the 64 nearest places of
/// d sqrt(pi / 64), d the distance of a place's own 64th neighbour.
typedef struct radii_sizes {
    double median, mean, permille_999, largest; ///< of radius / local median spacing
    double of_diagonal;                         ///< largest radius over the diagonal of the cloud's box
} radii_sizes;

/// Judges at most `sample_count` discs, evenly chosen, and the `sample_count` largest ones.
void radii_measure_sizes(const ewa_cloud *cloud, uint32_t sample_count, radii_sizes *sizes);

/// Pixels of pictures by what is missing in them. A pixel counts as inside when it and its eight neighbours
/// are covered in the picture with 1.5 times the radii. Holes are pixels inside, in a connected set of such
/// pixels that lies wholly inside: a gap that larger discs close, no rim and no gap of the scan.
typedef struct radii_holes {
    uint64_t inside;
    uint64_t empty;       ///< holes without any splat
    uint64_t translucent; ///< holes with alpha < 1/2
    uint64_t thin;        ///< holes with alpha < 0.99
    uint64_t rim;         ///< pixels inside without any splat, holes or not
} radii_holes;

enum { RADII_WHOLE = 1, RADII_NEAR = 2 };

/// Adds up over cameras: from above, at 35 and at 10 degrees over the horizon (RADII_WHOLE), and `near_count`
/// closer ones (RADII_NEAR) at 25 to 90 degrees, 12 pixels per spacing, around points of the cloud.
void radii_measure_holes(ewa_context *context, const ewa_cloud *cloud, int views, uint32_t near_count,
                         radii_holes *holes);

#endif
