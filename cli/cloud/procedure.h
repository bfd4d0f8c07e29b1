// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Solid textures: the options of commands that colour what they make.
#ifndef EWA_CLI_CLOUD_PROCEDURE_H
#define EWA_CLI_CLOUD_PROCEDURE_H

#include "cli/convert/cloud_output.h"

/// What the arguments of such a command begin with.
typedef struct procedure_arguments {
    output_arguments output;       // first
    int procedure;                 ///< 0: off; else 1 + ewa_procedure
    ewa_procedure_options options; ///< but for the procedure and its colours
    double frequency;              ///< 0: not given
    option_vector colors[2];       ///< linear
} procedure_arguments;

/// The options of procedure_arguments but for the output's.
extern const option_group procedure_options;

void procedure_set_defaults(procedure_arguments *arguments);

/// Says in `message` what is wrong with the options together, the output's too; see command.check.
bool procedure_check(const procedure_arguments *arguments, char message[OPTION_ERROR_BYTES]);

/// Colours a cloud as the options say; `cutoff` as for the surfels. Returns false after reporting.
bool procedure_apply(cli_session *session, const procedure_arguments *arguments, double cutoff,
                     ewa_cloud *cloud);

#endif
