// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa features: clip lines at the sharp edges and corners of a scan.
#include "cloud_output.h"
#include "commands.h"
#include "inputs.h"
#include "screening.h"

#include <stdio.h>
#include <string.h>

typedef struct features_arguments {
    output_arguments output; // first
    bool keep_normals, keep_radii, project;
    int64_t neighbours;
    option_vector viewpoint;
    double angle_deg, noise, radius_scale, cutoff;
} features_arguments;

#define AT(member) offsetof(features_arguments, member)

static const cli_option detection_table[] = {
    {"angle", OPTION_NUMBER, AT(angle_deg), "DEGREES", "[10, 120]",
     .help = "least angle between the normals of two planes that meet in an edge; less is a smooth surface"},
    {"neighbours", OPTION_INTEGER, AT(neighbours), "K", "[0, 64]",
     .help = "nearest neighbours that planes are fitted to, 16 or more; 0: 24 for exact points up to 64 for "
             "noisy ones",
     .aliases = "neighbors"},
    {"noise", OPTION_NUMBER, AT(noise), "SIGMA", "(-inf, 1]",
     .help = "standard deviation of the points from the surface in units of the spacing; negative: measured"},
    {"project", OPTION_ON_OFF, AT(project), .help = "move the points beside an edge onto their plane"},
};

static const cli_option surfel_table[] = {
    {"keep-normals", OPTION_ON_OFF, AT(keep_normals),
     .help = "start from the normals that the file has; else, and where it has none, they are estimated"},
    {"keep-radii", OPTION_ON_OFF, AT(keep_radii),
     .help =
         "start from the radii or axes that the file has; else, and where it has none, they are estimated"},
    {"viewpoint", OPTION_VECTOR, AT(viewpoint), "x,y,z",
     .help = "place that estimated normals point to, such as the scanner's; none: outward", .low = 3,
     .high = 3, .absent = "none"},
    {"radius-scale", OPTION_NUMBER, AT(radius_scale), "S", "(0, inf)",
     .help = "estimated support radius in units of the local spacing"},
    {"cutoff", OPTION_NUMBER, AT(cutoff), "F", "(0, 4]",
     .help = "standard deviations at which kernels end: axes are support radius / F long"},
};

static void set_defaults(void *data) {
    features_arguments *arguments = data;
    ewa_feature_options options;
    ewa_feature_options_init(&options, sizeof options);
    arguments->angle_deg = options.angle_deg;
    arguments->neighbours = options.neighbour_count;
    arguments->noise = options.noise;
    arguments->project = options.project;
    ewa_estimate_options estimate;
    ewa_estimate_options_init(&estimate, sizeof estimate);
    arguments->keep_normals = estimate.keep_normals;
    arguments->keep_radii = estimate.keep_radii;
    arguments->radius_scale = estimate.radius_scale;
    arguments->cutoff = options.cutoff;
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const features_arguments *arguments = data;
    if (!cloud_output_check(&arguments->output, message)) return false;
    const char *problem = NULL;
    if (arguments->neighbours > 0 && arguments->neighbours < 16) problem = "--neighbours is 0 or 16 to 64";
    if (problem) snprintf(message, OPTION_ERROR_BYTES, "%s", problem);
    return !problem;
}

static ewa_status detect(cli_session *session, const features_arguments *arguments, ewa_cloud **cloud) {
    ewa_estimate_options estimate;
    ewa_estimate_options_init(&estimate, sizeof estimate);
    estimate.keep_normals = arguments->keep_normals;
    estimate.keep_radii = arguments->keep_radii;
    estimate.radius_scale = arguments->radius_scale;
    estimate.cutoff = arguments->cutoff;
    if (arguments->viewpoint.count) estimate.orientation = EWA_ORIENT_VIEWPOINT;
    memcpy(estimate.viewpoint_world, arguments->viewpoint.values, sizeof estimate.viewpoint_world);
    ewa_feature_options options;
    ewa_feature_options_init(&options, sizeof options);
    options.angle_deg = arguments->angle_deg;
    options.neighbour_count = (uint32_t)arguments->neighbours;
    options.noise = arguments->noise;
    options.project = arguments->project;
    options.cutoff = arguments->cutoff;
    const double started_s = clock_now_s();
    ewa_status status = ewa_cloud_estimate(cloud, &estimate);
    const double estimated_s = clock_now_s();
    ewa_feature_counts counts;
    if (status == EWA_OK) status = ewa_cloud_detect_features(*cloud, &options, &counts);
    if (status == EWA_OK)
        session_say(session,
                    "%s: %llu surfels with one clip line, %llu with two, %llu snapped of %llu; noise %.3f "
                    "spacings, %u neighbours; %.3f s + %.3f s for missing normals and radii",
                    arguments->output.common.operands[0], (unsigned long long)counts.edge_count,
                    (unsigned long long)counts.corner_count, (unsigned long long)counts.snapped_count,
                    (unsigned long long)ewa_cloud_point_count(*cloud), counts.noise, counts.neighbour_count,
                    clock_now_s() - estimated_s, estimated_s - started_s);
    return status;
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const features_arguments *arguments = data;
    ewa_cloud *cloud = input_load(session, arguments->output.common.operands[0]);
    if (cloud && arguments->keep_normals)
        screening_drop_zero_normals(session, arguments->output.common.operands[0], cloud);
    const ewa_status status = cloud ? detect(session, arguments, &cloud) : EWA_OK;
    if (status != EWA_OK) {
        session_failed(session, status);
        ewa_cloud_destroy(&cloud);
    }
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group detection_options = OPTION_GROUP("Detection", detection_table);
static const option_group surfel_options = OPTION_GROUP("Surfels", surfel_table);
static const option_group *const groups[] = {&cloud_output_options, &detection_options, &surfel_options};

const cli_command features_command = {
    .name = "features",
    .operands = "IN -o OUT",
    .summary = "detect sharp edges and corners, cut surfels there by clip lines",
    .details =
        "Of a mesh the vertices are taken, which a message says; 'ewa sample' finds the edges of its faces.",
    .examples = "ewa features scan.ply -o sharp.ply\n"
                "ewa features scan.ply -o sharp.ply --angle 45 --neighbours 48\n",
    .low_operands = 1,
    .high_operands = 1,
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(features_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
