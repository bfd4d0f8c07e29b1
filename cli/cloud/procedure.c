// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid textures onto clouds.
#include "cli/cloud/procedure.h"

#include <stdio.h>

#define AT(member)        offsetof(procedure_arguments, member)
#define PROCEDURE(member) OPTION_OF(ewa_procedure_options, AT(options), member)

static const cli_option procedure_table[] = {
    {"procedure", OPTION_CHOICE, AT(procedure), NULL, "off|checker|marble|wood|noise",
     .help = "colour the points by a solid texture, filtered by each surfel's own kernel"},
    {"frequency", OPTION_NUMBER, AT(frequency), "F", "(0, 1e9]",
     .help = "features per world unit: cubes, veins, rings, waves", .absent = "auto: 8 over the longest side",
     .needs = "procedure"},
    {"prefilter-scale", PROCEDURE(prefilter), .needs = "procedure"},
    {"procedure-seed", PROCEDURE(seed), .needs = "procedure"},
    {"first-color", OPTION_VECTOR, AT(colors[0]), "r,g,b",
     .help = "linear colour in [0, 1] of one kind of cubes, the stone, early wood, the low", .low = 3,
     .high = 3, .absent = "auto: by --procedure", .needs = "procedure"},
    {"second-color", OPTION_VECTOR, AT(colors[1]), "r,g,b",
     .help = "linear colour in [0, 1] of the other cubes, the veins, late wood, the high", .low = 3,
     .high = 3, .absent = "auto: by --procedure", .needs = "procedure"},
};

const option_group procedure_options = OPTION_GROUP("Solid texture", procedure_table);

void procedure_set_defaults(procedure_arguments *arguments) {
    ewa_procedure_options_init(&arguments->options, EWA_PROCEDURE_CHECKER, sizeof arguments->options);
}

bool procedure_check(const procedure_arguments *arguments, char message[OPTION_ERROR_BYTES]) {
    const char *problem = NULL;
    for (int i = 0; i < 2; i++) {
        const option_vector *color = &arguments->colors[i];
        for (uint32_t c = 0; c < color->count; c++)
            if (color->values[c] < 0 || color->values[c] > 1)
                problem = i ? "--second-color: numbers must be in [0, 1]"
                            : "--first-color: numbers must be in [0, 1]";
    }
    return options_fine(problem, message) && cloud_output_check(&arguments->output, message);
}

/// Eight features along the longest side of the cloud's box.
static double fitting_frequency(const ewa_cloud *cloud) {
    ewa_bounds bounds;
    double longest = 0;
    if (ewa_cloud_measure(cloud, &bounds) == EWA_OK && bounds.finite_count)
        for (int c = 0; c < 3; c++)
            if (bounds.high_world[c] - bounds.low_world[c] > longest)
                longest = bounds.high_world[c] - bounds.low_world[c];
    const double frequency = longest > 0 ? 8 / longest : 8;
    return frequency < 1e9 ? frequency : 1e9;
}

bool procedure_apply(cli_session *session, const procedure_arguments *arguments, double cutoff,
                     ewa_cloud *cloud) {
    if (!arguments->procedure) return true;
    ewa_procedure_options options;
    ewa_procedure_options_init(&options, (ewa_procedure)(arguments->procedure - 1), sizeof options);
    options.frequency = arguments->frequency > 0 ? arguments->frequency : fitting_frequency(cloud);
    options.prefilter = arguments->options.prefilter;
    options.cutoff = cutoff;
    options.seed = arguments->options.seed;
    for (int i = 0; i < 2; i++)
        for (uint32_t c = 0; c < arguments->colors[i].count; c++)
            options.colors[i][c] = (float)arguments->colors[i].values[c];
    return session_passed(session, ewa_cloud_color_by_procedure(cloud, &options));
}
