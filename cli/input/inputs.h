// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds from the files of the command line.
#ifndef EWA_CLI_INPUT_INPUTS_H
#define EWA_CLI_INPUT_INPUTS_H

#include "cli/base/session.h"

/// How files of points are read, in common_arguments; for every command that reads some.
extern const option_group cloud_input_options;

/// Loads the points of one file that the session's filter takes, at least one; of a mesh, after a note, its
/// vertices. NULL after reporting.
ewa_cloud *input_load(cli_session *session, const char *path);

/// Loads all points of one file, with everything else that a PLY file holds, so that its faces are kept; `*elements`, which the
/// caller frees, are NULL for other formats.
ewa_cloud *input_load_elements(cli_session *session, const char *path, ewa_elements **elements);

/// Loads the operands and makes one cloud of them (ewa_cloud_merge()); files without colours get `srgb`, in
/// [0, 1], beside others that have some, which a note says. NULL after reporting.
ewa_cloud *inputs_merge(cli_session *session, const common_arguments *common, const double srgb[3]);

#endif
