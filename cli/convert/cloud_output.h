// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What all commands that write a cloud have in common: where it goes, and how.
#ifndef EWA_CLI_CONVERT_CLOUD_OUTPUT_H
#define EWA_CLI_CONVERT_CLOUD_OUTPUT_H

#include "cli/base/session.h"

/// What the arguments of a command that writes a cloud begin with.
typedef struct output_arguments {
    common_arguments common; // first
    const char *path;
    bool ascii, big_endian;
    bool gaussians; ///< files of Gaussians may be written too
} output_arguments;

/// The options of output_arguments.
extern const option_group cloud_output_options;

/// Says in `message` what is wrong with the output options together; returns false then.
bool cloud_output_check(const output_arguments *output, char message[OPTION_ERROR_BYTES]);

/// How a cloud is written, as the arguments say.
void cloud_output_options_fill(const output_arguments *output, ewa_cloud_save_options *options);

/// Whether the file that is written can hold faces.
bool cloud_output_has_faces(const output_arguments *output);

/// Writes a cloud, and elements with it (may be NULL); returns false after reporting.
bool cloud_output_save(cli_session *session, const output_arguments *output, const ewa_cloud *cloud,
                       const ewa_elements *elements);

/// Runs such a command: `make` gets its arguments and returns a new cloud, which is written, or NULL after
/// reporting. Returns the exit status.
int cloud_output_run(const void *arguments, ewa_cloud *(*make)(cli_session *session, const void *arguments));

#endif
