// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The commands of the program.
#include "cli/base/commands.h"
#include "cli/base/help.h"
#include "cli/base/outputs.h"
#include "cli/base/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const cli_command *const all_commands[] = {
    &render_command,   &view_command,   &info_command,     &convert_command, &surfels_command,
    &features_command, &sample_command, &csg_command,      &photos_command,  &profile_command, &compare_command,
    &texture_command,  &warp_command,   &volume_command,   &lod_command,     &page_command,    &serve_command,
    &generate_command, &bench_command};
const size_t all_commands_count = sizeof all_commands / sizeof all_commands[0];

const cli_command *command_find(const char *name) {
    for (size_t i = 0; i < all_commands_count; i++)
        if (strcmp(all_commands[i]->name, name) == 0) return all_commands[i];
    return NULL;
}

int command_run(const cli_command *command, const cli_process_group *group, size_t count,
                const char *const *words) {
    void *arguments = malloc(command->arguments_bytes);
    const char **operands = calloc(count + 1, sizeof *operands);
    char message[OPTION_ERROR_BYTES];
    int exit_status = EXIT_USAGE;
    if (!arguments || !operands) {
        fputs("ewa: out of memory\n", stderr);
        exit_status = EXIT_FAILED;
    } else {
        options_default(command, arguments);
        ((common_arguments *)arguments)->group = group;
        const bool leads = process_group_leads(group); // all are told the same
        if (!options_parse(command, count, words, operands, arguments, message)) {
            if (leads) fprintf(stderr, "ewa: %s\n", message);
        } else if (((const common_arguments *)arguments)->help) {
            if (leads) help_print_command(stdout, command);
            exit_status = EXIT_DONE;
        } else if (!outputs_check(command, arguments, message)) {
            if (leads) fprintf(stderr, "ewa: %s\n", message);
        } else {
            exit_status = command->run(arguments);
        }
    }
    free(operands);
    free(arguments);
    return exit_status;
}
