// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The commands of the program.
#include "commands.h"

#include <string.h>

const cli_command *const all_commands[] = {
    &render_command, &view_command, &info_command,    &convert_command, &surfels_command, &features_command, &sample_command,
    &csg_command,    &texture_command, &warp_command,    &volume_command,  &generate_command, &bench_command};
const size_t all_commands_count = sizeof all_commands / sizeof all_commands[0];

const cli_command *command_find(const char *name) {
    for (size_t i = 0; i < all_commands_count; i++)
        if (strcmp(all_commands[i]->name, name) == 0) return all_commands[i];
    return NULL;
}
