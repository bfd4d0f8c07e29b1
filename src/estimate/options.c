// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How surfels are estimated, and what stands where nobody says.
#include "base/options.h"
#include "cloud/neighbours.h"
#include "ewa/prepare.h"

#include <math.h>

enum { MIN_NEIGHBOURS = 6 };

#define AT(member) offsetof(ewa_estimate_options, member)

static const ewa_option option_rows[] = {
    {"neighbour_count", EWA_OPTION_U32, AT(neighbour_count), MIN_NEIGHBOURS, EWA_NEIGHBOURS_MAX,
     .initial = 16, .help = "nearest neighbours that a point is judged by"},
    {"orientation", EWA_OPTION_CHOICE, AT(orientation), .initial = EWA_ORIENT_AUTO,
     .words = "propagate|viewpoint|none|auto",
     .help = "side that normals point to: consistent along the surface and outward, towards the viewpoint, "
             "as they come; auto: to the scanners that the cloud knows, else up where points have return "
             "numbers, else consistent"},
    {"viewpoint_world", EWA_OPTION_F64, AT(viewpoint_world), -INFINITY, INFINITY,
     EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3, .help = "place that normals point to, such as the scanner's"},
    {"shape", EWA_OPTION_CHOICE, AT(shape), .words = "disc|ellipse",
     .help = "disc: a radius from the local density; ellipse: two axes from the local anisotropy of the "
             "sampling"},
    {"radius_scale", EWA_OPTION_F64, AT(radius_scale), 0, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW,
     .initial = 1, .help = "support radius in units of the local spacing"},
    {"radius_limit", EWA_OPTION_F64, AT(radius_limit), 1, INFINITY, EWA_OPTION_BELOW,
     .initial = EWA_DEFAULT_RADIUS_LIMIT,
     .help = "largest radius that closes a gap, in median spacings of the places around"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end: axes are the support radius over this"},
    {"keep_normals", EWA_OPTION_BOOL, AT(keep_normals), .initial = true,
     .help = "keep the normals that the file has"},
    {"keep_radii", EWA_OPTION_BOOL, AT(keep_radii), .initial = true,
     .help = "keep the radii or axes that the file has"},
    {"outlier_factor", EWA_OPTION_F64, AT(outlier_factor), 0, INFINITY, EWA_OPTION_BELOW,
     .help = "remove points whose mean distance to their neighbours is over the mean plus so many standard "
             "deviations of all; 0: keep all"},
};

const ewa_option_table ewa_estimate_options_table = EWA_OPTION_TABLE(ewa_estimate_options, option_rows);

void ewa_estimate_options_init(ewa_estimate_options *options, size_t struct_size) {
    ewa_options_init(&ewa_estimate_options_table, options, struct_size);
}
