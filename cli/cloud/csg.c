// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa csg: union, intersection and difference of two solids.
#include "cli/base/commands.h"
#include "cli/convert/cloud_output.h"
#include "cli/input/inputs.h"
#include "cli/input/scene_input.h"

#include <stdio.h>

typedef struct csg_arguments {
    output_arguments output; // first
    ewa_csg_options options;
} csg_arguments;

#define AT(member) offsetof(csg_arguments, member)

static const cli_option option_table[] = {
    {"op", OPTION_OF(ewa_csg_options, AT(options), operation), .value = "OP"},
};

static void set_defaults(void *data) {
    csg_arguments *arguments = data;
    ewa_csg_options_init(&arguments->options, sizeof arguments->options);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const csg_arguments *arguments = data;
    return cloud_output_check(&arguments->output, message);
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const csg_arguments *arguments = data;
    ewa_csg_options options = arguments->options;
    ewa_cloud *operands[2] = {NULL, NULL}, *result = NULL;
    for (int k = 0; k < 2; k++) {
        options.names[k] = arguments->output.common.operands[k];
        operands[k] = scene_input_cloud(session, 1, &options.names[k], options.cutoff);
        if (!operands[k]) break;
    }
    if (operands[0] && operands[1]) {
        session->subject = NULL;
        const double started_s = clock_now_s();
        const ewa_status status = ewa_cloud_csg(operands[0], operands[1], &options, &result);
        if (status != EWA_OK)
            session_failed(session, status);
        else
            session_say(session, "%llu and %llu points combined in %.3f s",
                        (unsigned long long)ewa_cloud_point_count(operands[0]),
                        (unsigned long long)ewa_cloud_point_count(operands[1]), clock_now_s() - started_s);
    }
    for (int k = 0; k < 2; k++) ewa_cloud_destroy(&operands[k]);
    return result;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group csg_options = OPTION_GROUP("Combination", option_table);
const cli_command csg_command = {
    .name = "csg",
    .operands = "A B --op OP -o OUT",
    .summary = "union, intersection or difference of two closed solids, with clip lines where they meet",
    .details =
        "Both files are closed surfaces with normals turned outward; normals and radii that a file lacks are "
        "estimated. Surfels near the intersection are split, and cut by the planes of the other surface; the "
        "clip lines of the operands are kept. An operand that is not closed is refused.",
    .examples = "ewa csg cube.ply ball.ply --op difference -o cut.ply\n"
                "ewa render cut.ply -o cut.png --cull back\n",
    .low_operands = 2,
    .high_operands = 2,
    .groups = (const option_group *const[]){&cloud_output_options, &cloud_input_options, &csg_options, NULL},
    .arguments_bytes = sizeof(csg_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
