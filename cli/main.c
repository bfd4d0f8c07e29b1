// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The program: finds the command, parses its options, runs it.
#include "cli/base/commands.h"
#include "cli/base/help.h"
#include "cli/base/json.h"
#include "ewa/io.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_COMMANDS = 32 };

static int unknown_command(const char *word) {
    struct stat facts;
    if (stat(word, &facts) == 0 && S_ISREG(facts.st_mode)) {
        fprintf(stderr,
                "ewa: '%s': a file, no command; to look at it: ewa view '%s'; to draw it: ewa render '%s' -o "
                "picture.png\n",
                word, word, word);
        return EXIT_USAGE;
    }
    if (stat(word, &facts) == 0 && S_ISDIR(facts.st_mode)) {
        fprintf(stderr, "ewa: '%s': a folder, no command; to draw the files in it: ewa render '%s'/* -o picture.png\n", word, word);
        return EXIT_USAGE;
    }
    const char *names[MAX_COMMANDS + 2];
    size_t count = 0;
    for (; count < all_commands_count && count < MAX_COMMANDS; count++)
        names[count] = all_commands[count]->name;
    names[count++] = "--help";
    names[count++] = "--version";
    const char *nearest = options_nearest(word, count, names);
    fprintf(stderr, "ewa: '%s': no such %s", word, word[0] == '-' ? "option" : "command");
    if (nearest)
        fprintf(stderr, "; did you mean '%s'?\n", nearest);
    else
        fputs("; see 'ewa --help'\n", stderr);
    return EXIT_USAGE;
}

/// Does what the first word says.
static int run(size_t count, const char *const *words) {
    if (count == 0) {
        help_print_program(stderr, all_commands_count, all_commands);
        return EXIT_USAGE;
    }
    const char *word = words[0];
    const bool help = strcmp(word, "help") == 0 || strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
    if (help && count > 1) {
        const cli_command *command = command_find(words[1]);
        if (!command) return unknown_command(words[1]);
        help_print_command(stdout, command);
    } else if (help) {
        help_print_program(stdout, all_commands_count, all_commands);
    } else if (strcmp(word, "--version") == 0) {
        const char *parts = ewa_parts();
        printf("ewa %s\nwith %s\n", ewa_version(), *parts ? parts : "none of the parts that can be left out");
    } else if (strcmp(word, "--help-json") == 0) {
        help_print_json(stdout);
    } else if (strcmp(word, "--help-markdown") == 0) {
        help_print_markdown(stdout, all_commands_count, all_commands);
    } else if (strcmp(word, "--help-man") == 0 && count > 1) {
        const cli_command *command = command_find(words[1]);
        if (!command) return unknown_command(words[1]);
        manual_print_command(stdout, command);
    } else if (strcmp(word, "--help-man") == 0) {
        manual_print_program(stdout, all_commands_count, all_commands);
    } else if (strcmp(word, "--completion") == 0) {
        const char *shell = count > 1 ? words[1] : "";
        if (!completion_print(stdout, shell, all_commands_count, all_commands)) {
            fprintf(stderr, "ewa: --completion: '%s' is not one of bash, zsh and fish\n", shell);
            return EXIT_USAGE;
        }
    } else {
        const cli_command *command = command_find(word);
        return command ? command_run(command, NULL, count - 1, words + 1) : unknown_command(word);
    }
    return EXIT_DONE;
}

int main(int argc, char **argv) {
    process_start();
    const int exit_status = run(argc > 0 ? (size_t)argc - 1 : 0, (const char *const *)argv + 1);
    cli_session session = {.quiet = false};
    return output_flush(&session, exit_status);
}
