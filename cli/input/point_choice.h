// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which points of a file are taken.
#ifndef EWA_CLI_INPUT_POINT_CHOICE_H
#define EWA_CLI_INPUT_POINT_CHOICE_H

#include "cli/base/session.h"

/// What is chosen among the points of a cloud, in this order. Zero-initialised: all.
typedef struct point_choice {
    const ewa_filter *filter;
    const double *corners_world; ///< of a box, two times three numbers
    const double *sphere_world; ///< its centre and its radius
    const ewa_polygon *polygon;
    const ewa_estimate_options *outliers; ///< what of those far from all others goes; NULL: nothing
    double voxel_world;    ///< size of the voxels that keep one point each; 0: no thinning
    double distance_world; ///< that points keep from each other; 0: no thinning
} point_choice;

/// Replaces a cloud by the points that are chosen, maybe none. False after reporting.
bool choose_points(cli_session *session, const point_choice *choice, ewa_cloud **cloud);

/// Makes the outline that "x,y;x,y;..." says, or else the file of that name; NULL after reporting.
ewa_polygon *choose_outline(cli_session *session, const char *text);

#endif
