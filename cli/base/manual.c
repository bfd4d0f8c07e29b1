// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Manual pages as roff, by the macros man(7) that groff and mandoc have, from the option tables.
#include "cli/base/help.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "ewa/ewa.h"

/// Prints characters so that roff shows them as they are: hyphens that can be copied to a shell, quotes, and no requests at the
/// beginning of a line.
static void print_escaped(FILE *file, size_t length, const char *text, bool begins_line) {
    for (size_t i = 0; i < length; i++) {
        if (begins_line && (text[i] == '.' || text[i] == '\'')) fputs("\\&", file);
        begins_line = text[i] == '\n';
        switch (text[i]) {
        case '\\': fputs("\\e", file); break;
        case '-': fputs("\\-", file); break;
        case '\'': fputs("\\(aq", file); break;
        case '`': fputs("\\(ga", file); break;
        case '^': fputs("\\(ha", file); break;
        case '~': fputs("\\(ti", file); break;
        default: fputc(text[i], file);
        }
    }
}

static void print_text(FILE *file, const char *text) { print_escaped(file, strlen(text), text, true); }

/// Prints paragraphs, which empty lines divide in `text`.
static void print_paragraphs(FILE *file, const char *text) {
    while (*text) {
        const char *end = strstr(text, "\n\n");
        const size_t length = end ? (size_t)(end - text) : strlen(text);
        print_escaped(file, length, text, true);
        text += length + strspn(text + length, "\n");
        fputs(*text ? "\n.PP\n" : "\n", file);
    }
}

/// Prints how an option is typed, what is a word of the program in bold and what stands for a value in italics.
static void print_names(FILE *file, const char *names) {
    fputs(".TP\n", file);
    for (const char *word = names; *word;) {
        const size_t all = strcspn(word, " "), comma = word[all - 1] == ',';
        fputs(word[0] == '-' ? "\\fB" : "\\fI", file);
        print_escaped(file, all - comma, word, false);
        fprintf(file, "\\fR%s%s", comma ? "," : "", word[all] ? " " : "\n");
        word += all + (word[all] == ' ');
    }
}

static void print_head(FILE *file, const char *name, const char *summary) {
    fputs(".TH ", file);
    for (const char *c = name; *c; c++) fputc(toupper((unsigned char)*c), file);
    fprintf(file, " 1 \"\" \"ewa %s\" \"Manual of ewa\"\n.SH NAME\n", ewa_version());
    print_text(file, name);
    fputs(" \\- ", file);
    print_text(file, summary);
    fputc('\n', file);
}

static void print_exit_status(FILE *file) {
    fputs(".SH EXIT STATUS\n"
          ".TP\n0\nDone.\n"
          ".TP\n1\nThe work failed; the message on standard error says which file, where in it, and why.\n"
          ".TP\n2\nWrong usage.\n",
          file);
}

static void print_group(FILE *file, const option_group *group, const void *defaults) {
    fputs(".SS ", file);
    print_text(file, group->title);
    fputc('\n', file);
    for (size_t i = 0; i < group->count; i++) {
        char names[HELP_NAMES_BYTES], meaning[HELP_MEANING_BYTES];
        help_write_names(&group->options[i], names);
        help_write_meaning(&group->options[i], defaults, meaning);
        print_names(file, names);
        print_text(file, meaning);
        fputs(".\n", file);
    }
}

void manual_print_command(FILE *file, const cli_command *command) {
    void *defaults = help_make_defaults(command);
    if (!defaults) return;
    char name[HELP_NAMES_BYTES];
    snprintf(name, sizeof name, "ewa-%s", command->name);
    print_head(file, name, command->summary);
    fprintf(file, ".SH SYNOPSIS\n.B ewa %s\n", command->name);
    print_text(file, command->operands);
    fputs("\n.RI [ options ]\n.SH DESCRIPTION\n", file);
    print_paragraphs(file, command->details ? command->details : command->summary);
    fputs(".SH OPTIONS\n", file);
    for (const option_group *const *group = command->groups; *group; group++) print_group(file, *group, defaults);
    print_group(file, &common_options, defaults);
    fputs(".SH EXAMPLES\n.nf\n", file);
    print_text(file, command->examples);
    fputs(".fi\n", file);
    print_exit_status(file);
    fputs(".SH SEE ALSO\n.BR ewa (1)\n", file);
    free(defaults);
}

void manual_print_program(FILE *file, size_t count, const cli_command *const *commands) {
    print_head(file, "ewa", "draw point clouds as continuous, antialiased surfaces");
    fputs(".SH SYNOPSIS\n.B ewa\n.I COMMAND\n.RI [ operands ]\n.RI [ options ]\n.SH COMMANDS\n", file);
    for (size_t i = 0; i < count; i++) {
        fprintf(file, ".TP\n.BR ewa\\-%s (1)\n", commands[i]->name);
        print_text(file, commands[i]->summary);
        fputs(".\n", file);
    }
    fputs(".SH OPTIONS\n", file);
    for (const help_option *option = help_program_options; option->names; option++) {
        print_names(file, option->names);
        print_text(file, option->meaning);
        fputs(".\n", file);
    }
    print_exit_status(file);
    fputs(".SH SEE ALSO\n", file);
    for (size_t i = 0; i < count; i++) fprintf(file, ".BR ewa\\-%s (1)%s\n", commands[i]->name, i + 1 < count ? "," : "");
}
