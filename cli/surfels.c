// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa surfels: normals, radii or axes for positions.
#include "cloud_output.h"
#include "commands.h"
#include "inputs.h"
#include "screening.h"

#include <stdio.h>
#include <string.h>

typedef struct surfels_arguments {
    output_arguments output; // first
    bool keep_normals, keep_radii;
    int64_t neighbours;
    int orientation, shape;
    option_vector viewpoint;
    double radius_scale, cutoff, outlier_factor;
} surfels_arguments;

#define AT(member) offsetof(surfels_arguments, member)

static const cli_option estimate_table[] = {
    {"neighbours", OPTION_INTEGER, AT(neighbours), "K", "[6, 64]",
     .help = "nearest neighbours that a point is judged by", .aliases = "neighbors"},
    {"orient", OPTION_CHOICE, AT(orientation), NULL, "propagate|viewpoint|none",
     .help = "side that normals point to: consistent along the surface and outward, towards --viewpoint, or "
             "as they come"},
    {"viewpoint", OPTION_VECTOR, AT(viewpoint), "x,y,z",
     .help = "place that normals point to, such as the scanner's; means --orient viewpoint", .low = 3,
     .high = 3, .absent = "none"},
    {"shape", OPTION_CHOICE, AT(shape), NULL, "disc|ellipse",
     .help = "disc: a radius from the local density; ellipse: two axes from the local anisotropy of the "
             "sampling"},
    {"radius-scale", OPTION_NUMBER, AT(radius_scale), "S", "(0, inf)",
     .help = "support radius in units of the local spacing"},
    {"cutoff", OPTION_NUMBER, AT(cutoff), "F", "(0, 4]",
     .help = "standard deviations at which kernels end: axes are support radius / F long"},
    {"keep-normals", OPTION_ON_OFF, AT(keep_normals), .help = "keep the normals that the file has"},
    {"keep-radii", OPTION_ON_OFF, AT(keep_radii), .help = "keep the radii or axes that the file has"},
    {"outliers", OPTION_NUMBER, AT(outlier_factor), "FACTOR", "[0, inf)",
     .help = "remove points whose mean distance to their neighbours is over the mean + FACTOR standard "
             "deviations of all; 0: keep all"},
};

static void set_defaults(void *data) {
    surfels_arguments *arguments = data;
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    arguments->neighbours = options.neighbour_count;
    arguments->orientation = (int)options.orientation;
    arguments->shape = (int)options.shape;
    arguments->radius_scale = options.radius_scale;
    arguments->cutoff = options.cutoff;
    arguments->keep_normals = options.keep_normals;
    arguments->keep_radii = options.keep_radii;
    arguments->outlier_factor = options.outlier_factor;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const surfels_arguments *arguments = data;
    if (!cloud_output_check(&arguments->output, message)) return false;
    const char *problem = NULL;
    if (arguments->orientation == EWA_ORIENT_VIEWPOINT && !arguments->viewpoint.count)
        problem = "--orient viewpoint needs --viewpoint x,y,z";
    else if (arguments->orientation == EWA_ORIENT_NONE && arguments->viewpoint.count)
        problem = "--viewpoint and --orient none exclude each other";
    if (problem) snprintf(message, OPTION_ERROR_BYTES, "%s", problem);
    return !problem;
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const surfels_arguments *arguments = data;
    const char *path = arguments->output.common.operands[0];
    ewa_cloud *cloud = input_load(session, path);
    if (!cloud) return NULL;
    if (arguments->keep_normals) screening_drop_zero_normals(session, path, cloud);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    options.neighbour_count = (uint32_t)arguments->neighbours;
    options.orientation =
        arguments->viewpoint.count ? EWA_ORIENT_VIEWPOINT : (ewa_orientation)arguments->orientation;
    memcpy(options.viewpoint_world, arguments->viewpoint.values, sizeof options.viewpoint_world);
    options.shape = (ewa_surfel_shape)arguments->shape;
    options.radius_scale = arguments->radius_scale;
    options.cutoff = arguments->cutoff;
    options.keep_normals = arguments->keep_normals;
    options.keep_radii = arguments->keep_radii;
    options.outlier_factor = arguments->outlier_factor;
    const uint64_t before = ewa_cloud_point_count(cloud);
    const double started_s = clock_now_s();
    const ewa_status status = ewa_cloud_estimate(&cloud, &options);
    if (status != EWA_OK) {
        session_failed(session, status);
        ewa_cloud_destroy(&cloud);
        return NULL;
    }
    session_say(session, "%s: surfels from %u neighbours in %.3f s, %llu outliers removed", path,
                options.neighbour_count, clock_now_s() - started_s,
                (unsigned long long)(before - ewa_cloud_point_count(cloud)));
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group estimate_options = OPTION_GROUP("Estimation", estimate_table);
static const option_group *const groups[] = {&cloud_output_options, &estimate_options};

const cli_command surfels_command = {
    .name = "surfels",
    .operands = "IN -o OUT",
    .summary = "estimate normals and radii, or elliptical axes, from positions; remove outliers",
    .details =
        "Of a mesh the vertices are taken, which a message says; 'ewa sample' makes surfels on its faces.",
    .examples = "ewa surfels scan.ply -o surfels.ply\n"
                "ewa surfels scan.ply -o surfels.ply --viewpoint 0,0,1.7 --outliers 3\n"
                "ewa surfels lines.ply -o ellipses.ply --shape ellipse --keep-normals off\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(surfels_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
