// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of points streamed piece by piece, so that they may be larger than memory.
#ifndef EWA_CLI_CONVERT_STREAMING_H
#define EWA_CLI_CONVERT_STREAMING_H

#include "cli/convert/cloud_output.h"

/// Changes a piece, or replaces it by another; false after reporting. `*piece` has at least one point before;
/// none may be left.
typedef bool streaming_change(cli_session *session, const void *arguments, ewa_cloud **piece);

typedef enum streaming_result {
    STREAMING_DONE,
    STREAMING_FAILED,     ///< after reporting
    STREAMING_IMPOSSIBLE, ///< no points of a known format, or with faces, or the file cannot be read twice
} streaming_result;

/// Writes the points of a file, each piece changed by `change`. `keeps_count`: it leaves no point out.
streaming_result streaming_run(cli_session *session, const char *path, const output_arguments *output,
                               const void *arguments, streaming_change *change, bool keeps_count);

#endif
