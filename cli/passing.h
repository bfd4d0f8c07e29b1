// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points passed through piece by piece, so that they may be larger than memory.
#ifndef EWA_CLI_PASSING_H
#define EWA_CLI_PASSING_H

#include "cloud_output.h"

/// Changes a piece, or replaces it by another; false after reporting. `*piece` has at least one point before;
/// none may be left.
typedef bool passing_change(cli_session *session, const void *arguments, ewa_cloud **piece);

typedef enum passing_result {
    PASSING_DONE,
    PASSING_FAILED,     ///< after reporting
    PASSING_IMPOSSIBLE, ///< no points of a known format, or with faces, or the file cannot be read twice
} passing_result;

/// Writes the points of a file, each piece changed by `change`. `keeps_count`: it leaves no point out.
passing_result passing_run(cli_session *session, const char *path, const output_arguments *output,
                           const void *arguments, passing_change *change, bool keeps_count);

#endif
