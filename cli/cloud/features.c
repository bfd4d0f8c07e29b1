// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa features: clip lines at the sharp edges and corners of a scan.
#include "cli/base/commands.h"
#include "cli/convert/cloud_output.h"
#include "cli/input/inputs.h"

#include <stdio.h>
#include <string.h>

typedef struct features_arguments {
    output_arguments output; // first
    ewa_feature_options options;
    ewa_estimate_options estimate;
    option_vector viewpoint;
} features_arguments;

#define AT(member)       offsetof(features_arguments, member)
#define FEATURE(member)  OPTION_OF(ewa_feature_options, AT(options), member)
#define ESTIMATE(member) OPTION_OF(ewa_estimate_options, AT(estimate), member)

static const cli_option detection_table[] = {
    {"angle", FEATURE(angle_deg)},
    {"neighbours", FEATURE(neighbour_count), .aliases = "neighbors"},
    {"noise", FEATURE(noise)},
    {"project", FEATURE(project)},
};

static const cli_option surfel_table[] = {
    {"keep-normals", ESTIMATE(keep_normals),
     .help = "start from the normals that the file has; else, and where it has none, they are estimated"},
    {"keep-radii", ESTIMATE(keep_radii),
     .help =
         "start from the radii or axes that the file has; else, and where it has none, they are estimated"},
    {"viewpoint", OPTION_VECTOR, AT(viewpoint), "x,y,z",
     .help = "place that estimated normals point to, such as the scanner's; none: outward", .low = 3,
     .high = 3, .absent = "none"},
    {"radius-scale", ESTIMATE(radius_scale),
     .help = "estimated support radius in units of the local spacing"},
    {"cutoff", ESTIMATE(cutoff)},
};

static void set_defaults(void *data) {
    features_arguments *arguments = data;
    ewa_feature_options_init(&arguments->options, sizeof arguments->options);
    ewa_estimate_options_init(&arguments->estimate, sizeof arguments->estimate);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const features_arguments *arguments = data;
    return cloud_output_check(&arguments->output, message);
}

static ewa_status detect(cli_session *session, const features_arguments *arguments, ewa_cloud **cloud) {
    ewa_estimate_options estimate = arguments->estimate;
    if (arguments->viewpoint.count) estimate.orientation = EWA_ORIENT_VIEWPOINT;
    memcpy(estimate.viewpoint_world, arguments->viewpoint.values, sizeof estimate.viewpoint_world);
    ewa_feature_options options = arguments->options;
    options.cutoff = estimate.cutoff;
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
    session->subject = arguments->output.common.operands[0];
    if (cloud && arguments->estimate.keep_normals) ewa_cloud_drop_zero_normals(cloud);
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
    .groups = (const option_group *const[]){&cloud_output_options, &cloud_input_options, &detection_options,
                                            &surfel_options, NULL},
    .arguments_bytes = sizeof(features_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
