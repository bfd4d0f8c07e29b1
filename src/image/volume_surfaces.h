// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How large the surfaces between lower and higher values of a volume are, for every value; and what of a
// volume stands in front of what.
#ifndef EWA_SRC_IMAGE_VOLUME_SURFACES_H
#define EWA_SRC_IMAGE_VOLUME_SURFACES_H

#include "ewa/volume.h"

enum { EWA_SURFACE_BINS = 256 };

/// Facts about thresholds t in [1, EWA_SURFACE_BINS): threshold t is between bin t - 1 and bin t of equal
/// steps from `low` to `high`; what lies beyond these is in the outermost bins. Volumes of many voxels are
/// looked at in a sample of their rows; counts are of the sample.
typedef struct ewa_volume_surfaces {
    double low, high;                 ///< values that hold all but very few of the voxels
    double count, border_count;       ///< voxels, and those on the faces of the box
    double counts[EWA_SURFACE_BINS];  ///< [bin] voxels
    double area[EWA_SURFACE_BINS];    ///< [threshold] pairs of neighbours on either side; [0]: 0
    double above[EWA_SURFACE_BINS];   ///< [threshold] voxels in bin t or higher
    double borders[EWA_SURFACE_BINS]; ///< [threshold] the same of the voxels on the faces of the box
} ewa_volume_surfaces;

/// Measures them. `facts` are those of the volume, which has at least two values.
void ewa_volume_surfaces_measure(const ewa_volume *volume, const ewa_volume_facts *facts,
                                 ewa_volume_surfaces *surfaces);

/// The value at a threshold, whole or not.
double ewa_surfaces_value(const ewa_volume_surfaces *surfaces, double threshold);

/// What a look from the six sides of the box shows of what is `inner` or more.
typedef struct ewa_volume_sight {
    double hit;    ///< lines of sight that meet it
    double hidden; ///< share of these that pass three voxels or more of at least `outer` before
    double passed; ///< voxels of at least `outer` before, the mean of these that pass three or more
    double separated; ///< share of those that meet it and pass something of at least `outer`, then a gap of three voxels
} ewa_volume_sight;

/// Looks at a sample of the columns along each axis, from both ends. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_volume_sight_measure(const ewa_volume *volume, double outer, double inner,
                                    ewa_volume_sight *sight);

#endif
