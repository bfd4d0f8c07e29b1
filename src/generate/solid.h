// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Blocks with boxes and round holes taken out, inner side: their shapes, which tests ray-trace.
#ifndef EWA_SRC_GENERATE_SOLID_H
#define EWA_SRC_GENERATE_SOLID_H

#include "ewa/prepare.h"

enum {
    EWA_SOLID_MAX_BREAKS = 6,
    EWA_SOLID_MAX_REMOVED = 2,
    EWA_SOLID_MAX_HOLES = 2,
    EWA_SOLID_MAX_REACH = 4
};

/// Support radius of the surfels' axes in standard deviations: the renderer's default cutoff.
#define EWA_SOLID_CUTOFF 3.0

/// Boxes of the lattice from low to before end.
typedef struct ewa_solid_box {
    int low[3], end[3];
} ewa_solid_box;

/// A cylinder along `axis`; its centre is given along the two axes that follow it in turn.
typedef struct ewa_solid_hole {
    int axis;
    double center[2], radius, low, high;
} ewa_solid_hole;

/// A lattice of boxes without some of them, minus cylinders. Units of size_world.
typedef struct ewa_solid_shape {
    const double *breaks[3]; ///< interval_count + 1 ascending places along each axis
    uint32_t interval_count[3];
    ewa_solid_box removed[EWA_SOLID_MAX_REMOVED];
    uint32_t removed_count;
    ewa_solid_hole holes[EWA_SOLID_MAX_HOLES];
    uint32_t hole_count;
} ewa_solid_shape;

/// The shape of the cube or of the part; NULL for other objects.
const ewa_solid_shape *ewa_solid_shape_of(ewa_object object);

/// Makes the cube or the part with surfels on all edges; options are checked but for those that only matter
/// here. `*made` may be left half filled after a failure.
ewa_status ewa_generate_solid(ewa_context *context, const ewa_generate_options *options, ewa_cloud **made);

#endif
