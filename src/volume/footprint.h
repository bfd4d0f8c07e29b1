// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where in a voxel's footprint a pixel of its ellipse is (docs/math.md section 12).
//
// Based on: X. Yuan, M. Nguyen, H. Xu, B. Chen, "Hybrid Forward Resampling and Volume Rendering", 2003,
// section 4.2, with the sine of the half angle where the paper prints its tangent.
#ifndef EWA_SRC_VOLUME_FOOTPRINT_H
#define EWA_SRC_VOLUME_FOOTPRINT_H

#include <math.h>

enum {
    EWA_FOOTPRINT_STEPS = 16,  ///< intervals of i^2 in [0, 1]
    EWA_FOOTPRINT_ANGLES = 16, ///< rows, even in sin^2 alpha from 0 to that of 15 degrees
};

/// sin^2 of 15 degrees, where the table ends.
#define EWA_FOOTPRINT_END 0.066987298107780677

/// d^2, the square of how far the ray passes the centre in radii, for the ray at i radii of the ellipse of a
/// cone of half angle alpha: d = sin(atan(i tan alpha)) / sin alpha without its functions, which cancel.
static inline double ewa_footprint_index2(double i2, double sine2) { return i2 / (1 - (1 - i2) * sine2); }

/// The same as printed in the paper: divided by tan alpha, it ends at cos alpha instead of 1.
static inline double ewa_footprint_index2_printed(double i2, double sine2) {
    return ewa_footprint_index2(i2, sine2) * (1 - sine2);
}

/// HFR's table over (i, alpha), here over i^2 and sin^2 alpha: d^2 - i^2 at the steps' beginnings, and how
/// much it grows within each.
typedef struct ewa_footprint_table {
    float start[EWA_FOOTPRINT_ANGLES][EWA_FOOTPRINT_STEPS], growth[EWA_FOOTPRINT_ANGLES][EWA_FOOTPRINT_STEPS];
} ewa_footprint_table;

void ewa_footprint_table_make(ewa_footprint_table *table);

#endif
