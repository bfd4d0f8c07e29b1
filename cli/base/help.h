// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the program says of its commands and options: help, docs/cli.md, manual pages, completion in shells. All of it is made
// from the option tables.
#ifndef EWA_CLI_BASE_HELP_H
#define EWA_CLI_BASE_HELP_H

#include "cli/base/options.h"

enum { HELP_NAMES_BYTES = 512, HELP_MEANING_BYTES = 1024 };

/// An option of the program itself, which stands in place of a command.
typedef struct help_option {
    const char *names; ///< as typed: "--help-man [COMMAND]"
    const char *meaning;
} help_option;

/// Those options, ended by one without names.
extern const help_option help_program_options[];

/// Writes how an option is typed: "-o, --output FILE".
void help_write_names(const cli_option *option, char names[HELP_NAMES_BYTES]);
/// Writes what an option means with what it needs and excludes, its range, default and other names.
void help_write_meaning(const cli_option *option, const void *defaults, char meaning[HELP_MEANING_BYTES]);
/// The defaults of a command, to be freed; NULL when memory is short.
void *help_make_defaults(const cli_command *command);

/// Prints the help of a command.
void help_print_command(FILE *file, const cli_command *command);
/// Prints what the program is and its commands.
void help_print_program(FILE *file, size_t count, const cli_command *const *commands);
/// Prints docs/options.json.
void help_print_json(FILE *file);
/// Prints docs/cli.md.
void help_print_markdown(FILE *file, size_t count, const cli_command *const *commands);

/// Prints the manual page ewa-COMMAND(1), as roff.
void manual_print_command(FILE *file, const cli_command *command);
/// Prints the manual page ewa(1).
void manual_print_program(FILE *file, size_t count, const cli_command *const *commands);

/// Prints the script by which a shell, bash, zsh or fish, completes what is typed; false for another shell.
bool completion_print(FILE *file, const char *shell, size_t count, const cli_command *const *commands);

#endif
