// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Where points were seen from: the side that their normals point to.
#ifndef EWA_SRC_ESTIMATE_SIGHT_H
#define EWA_SRC_ESTIMATE_SIGHT_H

#include "ewa/prepare.h"

typedef enum sight_kind {
    SIGHT_NONE, ///< nobody knows
    SIGHT_PLACE,
    SIGHT_UPWARD,
    SIGHT_SCANNERS
} sight_kind;

/// Where each point stands for its cell of a grid of directions, as those of a scanner or a depth camera do: the eye of that.
typedef struct sight_grid {
    bool given;
    double eye[3]; ///< relative to the cloud's origin
} sight_grid;

typedef struct sight {
    sight_kind kind;
    double (*place)[3]; ///< relative to the cloud's origin: one, or that of each scan
    uint32_t place_count;
    ewa_attribute scan; ///< SIGHT_SCANNERS, more than one: which is each point's
} sight;

/// What the options say, or with EWA_ORIENT_AUTO the cloud: the note "scanners" with the attribute "scan",
/// which one scanner needs not; else "return_number". A note that is not three numbers per scan says
/// nothing, with a warning. Errors: EWA_ERROR_MEMORY. Free in any case.
ewa_status ewa_sight_make(const ewa_cloud *cloud, const ewa_estimate_options *options, sight *made);
void ewa_sight_free(ewa_context *context, sight *made);

/// One eye of all points: the scanner's, or the origin of what a depth camera took (the note "file.organised"). Not given where
/// nobody knows of one, or there are several.
sight_grid ewa_sight_grid(const ewa_cloud *cloud, const sight *from);

/// How many spacings beyond the outermost samples a surface of such a normal at `p` ends: so far that in the grid, seen from its eye,
/// that is half a cell, where the surface turns away across its border; 0 without a grid.
float ewa_sight_beyond(const sight_grid *grid, const double p[3], const double normal[3]);

/// Tells whether a point, at `p` relative to the cloud's origin, was seen from the other side of its normal.
/// False where its scanner is not known.
bool ewa_sight_is_behind(const sight *from, uint32_t point, const double p[3], const float normal[3]);

#endif
