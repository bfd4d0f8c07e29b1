// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether the files that a command is asked to write can be written, before any work.
#ifndef EWA_CLI_BASE_OUTPUTS_H
#define EWA_CLI_BASE_OUTPUTS_H

#include "cli/base/options.h"

/// Checks every output that the options name: its folder exists and may be written, no folder is in the way,
/// none is named twice, and a film finds ffmpeg. Numbered files are judged by their first frame. Returns
/// false with what is wrong, without the program's name, in `message`.
bool outputs_check(const cli_command *command, const void *arguments, char message[OPTION_ERROR_BYTES]);

/// Returns path_has_suffix(); otherwise says in `message` what the option's file is not.
bool output_check_suffix(const char *key, const char *path, const char *suffixes,
                         char message[OPTION_ERROR_BYTES]);

#endif
