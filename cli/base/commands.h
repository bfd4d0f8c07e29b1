// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The commands of the program.
#ifndef EWA_CLI_BASE_COMMANDS_H
#define EWA_CLI_BASE_COMMANDS_H

#include "cli/base/options.h"

extern const cli_command render_command, view_command, info_command, convert_command, surfels_command,
    features_command, sample_command, csg_command, photos_command, profile_command, compare_command, texture_command, warp_command, volume_command,
    lod_command, page_command, serve_command, generate_command, bench_command;

/// All commands, in the order of the help.
extern const cli_command *const all_commands[];
extern const size_t all_commands_count;

/// Finds a command by its name; NULL when there is none.
const cli_command *command_find(const char *name);

/// Parses the words after a command's name and runs it, or prints its help or what is wrong; `group` may be
/// NULL. Returns the exit status.
int command_run(const cli_command *command, const cli_process_group *group, size_t count,
                const char *const *words);

#endif
