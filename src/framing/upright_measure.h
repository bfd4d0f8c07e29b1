// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What is measured of some points to tell how they stand: sheets, range images, bases, faces, halves.
#ifndef EWA_SRC_FRAMING_UPRIGHT_MEASURE_H
#define EWA_SRC_FRAMING_UPRIGHT_MEASURE_H

#include <stdbool.h>
#include <stddef.h>

/// Points as offsets from the middle of their box, and the box that they fill.
typedef struct point_cloud_sample {
    size_t count;
    const double (*offsets)[3];
    const double *middle_world;
    double low[3], high[3], extent[3]; ///< of the offsets
} point_cloud_sample;

/// Sets low, high and extent.
void ewa_measure_extent(point_cloud_sample *points);

/// Share of the places across an axis where one point lies well behind another; 0 for a sheet.
double ewa_measure_layers(const point_cloud_sample *points, int axis);

/// The lowest points along an axis.
typedef struct base_facts {
    double share; ///< of the footprint's convex hull that is theirs
    bool stable;  ///< the middle of all that is seen is above them, and not at their rim
} base_facts;

void ewa_measure_base(const point_cloud_sample *points, int axis, base_facts *facts);

/// Share of the places across an axis whose point that is nearest to its high or low end lies at that end.
double ewa_measure_face(const point_cloud_sample *points, int axis, bool high);

/// Share of the places across an axis that show the inside of a surface, whose normal points away, to who looks at the high
/// or the low end.
double ewa_measure_inside(const point_cloud_sample *points, const float (*normals)[3], int axis, bool high);

/// Share of the places with points that have some in their mirror image across the middle of an axis, too.
double ewa_measure_mirror(const point_cloud_sample *points, int axis);

/// Points as an eye at the origin sees them that looks along +z or -z.
typedef struct range_facts {
    double layered_share;           ///< of the directions, where one point lies well behind another
    size_t column_count, row_count; ///< different x/z and y/z
    double narrowness;              ///< the picture's shorter side over its longer one
} range_facts;

/// Measures along z (`sign` 1) or -z (-1). Returns false when not all points lie before the eye within a
/// slope of the axis, or are too few to tell.
bool ewa_measure_range(const point_cloud_sample *points, double sign, double max_slope, range_facts *facts);

#endif
