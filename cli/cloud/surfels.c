// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa surfels: normals, radii or axes for positions.
#include "cli/base/commands.h"
#include "cli/convert/cloud_output.h"
#include "cli/input/inputs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct surfels_arguments {
    output_arguments output; // first
    ewa_estimate_options options;
    option_vector viewpoint;
} surfels_arguments;

#define AT(member)       offsetof(surfels_arguments, member)
#define ESTIMATE(member) OPTION_OF(ewa_estimate_options, AT(options), member)

static const cli_option estimate_table[] = {
    {"neighbours", ESTIMATE(neighbour_count), .aliases = "neighbors"},
    {"orient", ESTIMATE(orientation)},
    {"viewpoint", OPTION_VECTOR, AT(viewpoint), "x,y,z",
     .help = "place that normals point to, such as the scanner's; means --orient viewpoint", .low = 3,
     .high = 3, .absent = "none"},
    {"shape", ESTIMATE(shape)},
    {"radius-scale", ESTIMATE(radius_scale)},
    {"cutoff", ESTIMATE(cutoff)},
    {"keep-normals", ESTIMATE(keep_normals)},
    {"keep-radii", ESTIMATE(keep_radii)},
    {"outliers", ESTIMATE(outlier_factor)},
};

static void set_defaults(void *data) {
    surfels_arguments *arguments = data;
    ewa_estimate_options_init(&arguments->options, sizeof arguments->options);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const surfels_arguments *arguments = data;
    if (!cloud_output_check(&arguments->output, message)) return false;
    const char *problem = NULL;
    if (arguments->options.orientation == EWA_ORIENT_VIEWPOINT && !arguments->viewpoint.count)
        problem = "--orient viewpoint needs --viewpoint x,y,z";
    else if (arguments->options.orientation == EWA_ORIENT_NONE && arguments->viewpoint.count)
        problem = "--viewpoint and --orient none exclude each other";
    return options_fine(problem, message);
}

/// The harmonic that is the same in all directions.
static const double SH_CONSTANT = 0.28209479177387814;

/// Gives the centres of Gaussians that have no colours those that no direction changes. False after reporting.
static bool color_gaussians(cli_session *session, ewa_cloud *cloud) {
    static const char *const names[] = {"f_dc_0", "f_dc_1", "f_dc_2"};
    uint8_t *colors = NULL;
    if (ewa_cloud_find(cloud, EWA_COLOR) || !ewa_cloud_find_gaussians(cloud).dimensions) return true;
    if (!session_passed(session, ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, (void **)&colors))) return false;
    for (int c = 0; c < 3; c++) {
        const ewa_attribute *attribute = ewa_cloud_find(cloud, names[c]);
        for (uint64_t i = 0; i < ewa_cloud_point_count(cloud); i++) {
            float coefficient;
            ewa_attribute_read_f32(attribute, i, 1, &coefficient);
            const double color = 255 * (0.5 + SH_CONSTANT * (double)coefficient);
            colors[3 * i + (uint64_t)c] = (uint8_t)(color > 0 ? fmin(color, 255) + 0.5 : 0);
        }
    }
    return true;
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const surfels_arguments *arguments = data;
    const char *path = arguments->output.common.operands[0];
    ewa_cloud *cloud = input_load(session, path);
    if (!cloud) return NULL;
    if (!color_gaussians(session, cloud)) {
        ewa_cloud_destroy(&cloud);
        return NULL;
    }
    session->subject = path;
    if (arguments->options.keep_normals) ewa_cloud_drop_zero_normals(cloud);
    ewa_estimate_options options = arguments->options;
    if (arguments->viewpoint.count) options.orientation = EWA_ORIENT_VIEWPOINT;
    memcpy(options.viewpoint_world, arguments->viewpoint.values, sizeof options.viewpoint_world);
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
    .groups =
        (const option_group *const[]){&cloud_output_options, &cloud_input_options, &estimate_options, NULL},
    .arguments_bytes = sizeof(surfels_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
