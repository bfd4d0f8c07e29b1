// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa csg: union, intersection and difference of two solids.
#include "commands.h"
#include "inputs.h"
#include "json.h"

#include <stdio.h>

typedef struct csg_arguments {
    common_arguments common; // first
    const char *output;
    bool ascii;
    int operation;
} csg_arguments;

#define AT(member) offsetof(csg_arguments, member)

static const cli_option option_table[] = {
    {.key = "op",
     .kind = OPTION_CHOICE,
     .offset = AT(operation),
     .value = "OP",
     .range = "union|intersection|difference",
     .help = "what to keep; difference: A without B"},
    {.key = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     .offset = AT(output),
     .value = "FILE",
     .help = "file to write (.ply); -: PLY to standard output"},
    {.key = "ascii",
     .kind = OPTION_FLAG,
     .offset = AT(ascii),
     .help = "write text instead of little-endian binary"},
};

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const csg_arguments *arguments = data;
    if (!arguments->output) snprintf(message, OPTION_ERROR_BYTES, "csg: no output; say -o FILE");
    return arguments->output != NULL;
}

/// Combines the operands; NULL after reporting.
static ewa_cloud *combine(cli_session *session, const csg_arguments *arguments) {
    ewa_cloud *operands[2] = {NULL, NULL}, *result = NULL;
    double estimate_s = 0;
    for (int k = 0; k < 2; k++) {
        operands[k] = input_as_surfels(session, arguments->common.operands[k], &estimate_s);
        if (!operands[k]) break;
    }
    if (operands[0] && operands[1]) {
        ewa_csg_options options;
        ewa_csg_options_init(&options, sizeof options);
        options.operation = (ewa_csg_operation)arguments->operation;
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

static int run(const void *data) {
    const csg_arguments *arguments = data;
    cli_session session;
    if (!session_start(&session, &arguments->common)) return session_end(&session, EXIT_FAILED);
    ewa_cloud *result = output_check(&session, arguments->output) ? combine(&session, arguments) : NULL;
    bool done = result != NULL;
    if (done) {
        ewa_cloud_save_options save;
        ewa_cloud_save_options_init(&save, sizeof save);
        if (arguments->ascii) save.ply_encoding = EWA_PLY_ASCII;
        session.subject = arguments->output;
        const ewa_status status = ewa_cloud_save(result, arguments->output, &save);
        done = status == EWA_OK;
        if (!done)
            session_failed(&session, status);
        else
            session_say(&session, "%s: %llu points written", arguments->output,
                        (unsigned long long)ewa_cloud_point_count(result));
    }
    ewa_cloud_destroy(&result);
    return session_end(&session, done ? EXIT_DONE : EXIT_FAILED);
}

static const option_group csg_options = {"Combination", option_table,
                                         sizeof option_table / sizeof option_table[0]};
static const option_group *const groups[] = {&csg_options};

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
    .groups = groups,
    .group_count = sizeof groups / sizeof groups[0],
    .arguments_bytes = sizeof(csg_arguments),
    .check = check,
    .run = run,
};
