// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scripts by which bash, zsh and fish complete commands, options and their values, from the option tables.
#include "cli/base/help.h"

#include <string.h>

enum { MEANING_COLUMNS = 60 };

// A quote within single quotes.
static const char ZSH_QUOTE[] = "'\\''", FISH_QUOTE[] = "\\'";

/// What a shell can offer for the value of an option.
typedef enum option_value {
    VALUE_NONE, ///< there is no value
    VALUE_FREE, ///< numbers and text: nothing
    VALUE_WORD, ///< one of some words
    VALUE_FILE, ///< files and folders
} option_value;

/// Says what the value of an option is; its words, divided by '|', are in `words`.
static option_value value_of(const cli_option *option, char words[EWA_OPTION_TEXT_BYTES]) {
    static const char *const of_files[] = {"FILE", "DIR", "FOLDER", "PATH", "IMAGE", "PROGRAM"};
    const ewa_option *of = options_library(option);
    char name[EWA_OPTION_TEXT_BYTES];
    options_name_value(option, name);
    if (!name[0]) return VALUE_NONE;
    if (option->kind == OPTION_CHOICE || option->kind == OPTION_SET) {
        snprintf(words, EWA_OPTION_TEXT_BYTES, "%s", option->range);
        return VALUE_WORD;
    }
    if (option->kind == OPTION_ON_OFF || (of && (of->words || of->type == EWA_OPTION_BOOL))) {
        if (of)
            ewa_option_range(of, words);
        else
            snprintf(words, EWA_OPTION_TEXT_BYTES, "on|off");
        return VALUE_WORD;
    }
    for (size_t i = 0; i < sizeof of_files / sizeof of_files[0]; i++)
        if (strstr(name, of_files[i])) return VALUE_FILE;
    return VALUE_FREE;
}

/// Prints text that stands between single quotes of a shell: `quote` in place of a quote, a backslash before each of the characters
/// `marked`.
static void print_quoted(FILE *file, size_t length, const char *text, const char *marked, const char *quote) {
    for (size_t i = 0; i < length; i++)
        if (text[i] == '\'')
            fputs(quote, file);
        else
            fprintf(file, "%s%c", strchr(marked, text[i]) ? "\\" : "", text[i]);
}

/// Prints the beginning of what an option means, up to the first stop or MEANING_COLUMNS, between quotes.
static void print_meaning(FILE *file, const cli_option *option, const char *marked, const char *quote) {
    const ewa_option *of = options_library(option);
    const char *text = option->help ? option->help : of->help;
    size_t length = strcspn(text, ";:(");
    if (length > MEANING_COLUMNS)
        for (length = MEANING_COLUMNS; length && text[length] != ' '; length--) {}
    while (length && strchr(" ,", text[length - 1])) length--;
    print_quoted(file, length, text, marked, quote);
}

/// Prints words that '|' divides with another character between them.
static void print_words(FILE *file, const char *words, char between) {
    for (const char *c = words; *c; c++) fputc(*c == '|' ? between : *c, file);
}

/// Prints the names of an option, with `between` after each but the last.
static void print_keys(FILE *file, const cli_option *option, char between) {
    if (option->letter) fprintf(file, "-%c%c", option->letter, between);
    fprintf(file, "--%s", option->key);
    if (option->kind == OPTION_TOGGLE) fprintf(file, "%c--no-%s", between, option->key);
}

/// Prints the keys of the program's own options, and the words that stand in place of a command.
static void print_program_words(FILE *file, size_t count, const cli_command *const *commands) {
    for (size_t i = 0; i < count; i++) fprintf(file, "%s ", commands[i]->name);
    fputs("help", file);
    for (const help_option *option = help_program_options; option->names; option++)
        fprintf(file, " %.*s", (int)strcspn(strstr(option->names, "--"), " "), strstr(option->names, "--"));
}

static void print_command_names(FILE *file, size_t count, const cli_command *const *commands) {
    for (size_t i = 0; i < count; i++) fprintf(file, "%s%s", i ? " " : "", commands[i]->name);
}

static void print_bash_command(FILE *file, const cli_command *command) {
    const cli_option *option;
    char words[EWA_OPTION_TEXT_BYTES];
    fprintf(file, "    %s)\n        case $before in\n", command->name);
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        const option_value value = value_of(option, words);
        if (value == VALUE_NONE) continue;
        fputs("        ", file);
        print_keys(file, option, '|');
        fputs(value == VALUE_FILE ? ") ;;\n" : ") words='", file);
        if (value == VALUE_FILE) continue;
        if (value == VALUE_WORD) print_words(file, words, ' ');
        fputs("' files= ;;\n", file);
    }
    fputs("        *) options='", file);
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        if (i) fputc(' ', file);
        print_keys(file, option, ' ');
    }
    fputs("' ;;\n        esac ;;\n", file);
}

static void print_bash(FILE *file, size_t count, const cli_command *const *commands) {
    // Bash takes --key=value apart at the equals sign, unless it is told not to.
    fputs("# Made by `ewa --completion bash`.\n"
          "_ewa() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words= options= files=1\n"
          "    if [ \"$word\" = = ]; then\n"
          "        word=\n"
          "    elif [ \"$before\" = = ]; then\n"
          "        before=${COMP_WORDS[COMP_CWORD-2]}\n"
          "    fi\n"
          "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
          "        files= words='",
          file);
    print_program_words(file, count, commands);
    fputs("'\n"
          "    else\n"
          "    case ${COMP_WORDS[1]} in\n"
          "    --completion) files= words='bash zsh fish' ;;\n"
          "    help|--help-man) files= words='",
          file);
    print_command_names(file, count, commands);
    fputs("' ;;\n", file);
    for (size_t i = 0; i < count; i++) print_bash_command(file, commands[i]);
    fputs("    *) files= ;;\n"
          "    esac\n"
          "    fi\n"
          "    case $word in -*) [ -z \"$options\" ] || files= words=$options ;; esac\n"
          "    if [ -n \"$files\" ]; then\n"
          "        compopt -o filenames 2>/dev/null\n"
          "        mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
          "    else\n"
          "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
          "    fi\n"
          "}\n"
          "complete -F _ewa ewa\n",
          file);
}

static void print_zsh_command(FILE *file, const cli_command *command) {
    const cli_option *option;
    char words[EWA_OPTION_TEXT_BYTES], name[EWA_OPTION_TEXT_BYTES];
    fprintf(file, "    %s)\n        specs=(\n", command->name);
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        const option_value value = value_of(option, words);
        const bool many = option->kind == OPTION_VECTORS || option->kind == OPTION_FILTER || option->kind == OPTION_FRAMES;
        const bool two = option->letter || option->kind == OPTION_TOGGLE;
        fputs("            ", file);
        if (two) {
            fputs("'(", file);
            print_keys(file, option, ' ');
            fputs(")'{", file);
            print_keys(file, option, ',');
            fputs("}'", file);
        } else {
            fprintf(file, "'%s--%s", many ? "*" : "", option->key);
        }
        fputc('[', file);
        print_meaning(file, option, "[]\\", ZSH_QUOTE);
        fputc(']', file);
        if (value != VALUE_NONE) {
            options_name_value(option, name);
            fprintf(file, ":%s:", value == VALUE_WORD ? option->key : name);
            if (value == VALUE_FILE) fputs("_files", file);
            if (value == VALUE_WORD) {
                fputc('(', file);
                print_words(file, words, ' ');
                fputc(')', file);
            }
        }
        fputs("'\n", file);
    }
    fputs("        ) ;;\n", file);
}

static void print_zsh(FILE *file, size_t count, const cli_command *const *commands) {
    fputs("#compdef ewa\n"
          "# Made by `ewa --completion zsh`.\n"
          "_ewa() {\n"
          "    local -a names specs\n"
          "    names=(\n",
          file);
    for (size_t i = 0; i < count; i++) {
        fprintf(file, "        '%s:", commands[i]->name);
        print_quoted(file, strlen(commands[i]->summary), commands[i]->summary, "\\", ZSH_QUOTE);
        fputs("'\n", file);
    }
    fputs("    )\n"
          "    if (( CURRENT == 2 )); then\n"
          "        if [[ $words[2] == -* ]]; then\n"
          "            compadd -- ",
          file);
    for (const help_option *option = help_program_options; option->names; option++)
        fprintf(file, "%.*s ", (int)strcspn(strstr(option->names, "--"), " "), strstr(option->names, "--"));
    fputs("\n"
          "        else\n"
          "            _describe command names\n"
          "        fi\n"
          "        return\n"
          "    fi\n"
          "    case $words[2] in\n"
          "    --completion) compadd bash zsh fish; return ;;\n"
          "    help|--help-man) _describe command names; return ;;\n",
          file);
    for (size_t i = 0; i < count; i++) print_zsh_command(file, commands[i]);
    fputs("    *) return 1 ;;\n"
          "    esac\n"
          "    shift words\n"
          "    (( CURRENT-- ))\n"
          "    _arguments -S $specs '*:file:_files'\n"
          "}\n"
          "compdef _ewa ewa\n",
          file);
}

static void print_fish_command(FILE *file, const cli_command *command) {
    const cli_option *option;
    char words[EWA_OPTION_TEXT_BYTES];
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        const option_value value = value_of(option, words);
        for (int no = 0; no <= (option->kind == OPTION_TOGGLE); no++) {
            fprintf(file, "complete -c ewa -n '__ewa_command_is %s' -l %s%s", command->name, no ? "no-" : "", option->key);
            if (option->letter) fprintf(file, " -s %c", option->letter);
            if (value == VALUE_FREE) fputs(" -x", file);
            if (value == VALUE_FILE) fputs(" -r -F", file);
            if (value == VALUE_WORD) {
                fputs(" -x -a '", file);
                print_words(file, words, ' ');
                fputc('\'', file);
            }
            fputs(" -d '", file);
            print_meaning(file, option, "\\", FISH_QUOTE);
            fputs("'\n", file);
        }
    }
}

static void print_fish(FILE *file, size_t count, const cli_command *const *commands) {
    fputs("# Made by `ewa --completion fish`.\n"
          "function __ewa_command_is\n"
          "    set -l words (commandline -opc)\n"
          "    test (count $words) -gt 1; and contains -- $words[2] $argv\n"
          "end\n"
          "complete -c ewa -n 'test (count (commandline -opc)) = 1' -f -a help\n",
          file);
    for (const help_option *option = help_program_options; option->names; option++)
        fprintf(file, "complete -c ewa -n 'test (count (commandline -opc)) = 1' -f -a %.*s\n",
                (int)strcspn(strstr(option->names, "--"), " "), strstr(option->names, "--"));
    fputs("complete -c ewa -n '__ewa_command_is --completion' -f -a 'bash zsh fish'\n"
          "complete -c ewa -n '__ewa_command_is help --help-man' -f -a '",
          file);
    print_command_names(file, count, commands);
    fputs("'\n", file);
    for (size_t i = 0; i < count; i++) {
        fprintf(file, "complete -c ewa -n 'test (count (commandline -opc)) = 1' -f -a %s -d '", commands[i]->name);
        print_quoted(file, strlen(commands[i]->summary), commands[i]->summary, "\\", FISH_QUOTE);
        fputs("'\n", file);
        print_fish_command(file, commands[i]);
    }
}

bool completion_print(FILE *file, const char *shell, size_t count, const cli_command *const *commands) {
    if (strcmp(shell, "bash") == 0)
        print_bash(file, count, commands);
    else if (strcmp(shell, "zsh") == 0)
        print_zsh(file, count, commands);
    else if (strcmp(shell, "fish") == 0)
        print_fish(file, count, commands);
    else
        return false;
    return true;
}
