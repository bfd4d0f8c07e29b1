// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Help and the page docs/cli.md, from the option tables.
#include "cli/base/help.h"
#include "cli/base/bytes.h"
#include "cli/base/json.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ewa/ewa.h"

enum { LEFT_COLUMNS = 30, ALL_COLUMNS = 100, TEXT_BYTES = 512 };

const help_option help_program_options[] = {
    {"-h, --help", "print this help; 'ewa COMMAND --help' prints a command's"},
    {"--version", "print the version, and what the library was built with"},
    {"--help-markdown", "print the help of all commands as Markdown"},
    {"--help-json", "print the library's tables of options as JSON"},
    {"--help-man [COMMAND]", "print the manual page of the program or of a command, for man -l"},
    {"--completion SHELL", "print what completes commands and options in bash, zsh or fish"},
    {0},
};

/// Prints words, broken at ALL_COLUMNS; `column` is where the cursor is, later lines start at `indent`.
static void print_wrapped(FILE *file, const char *text, int column, int indent) {
    while (*text) {
        const size_t length = strcspn(text, " \n");
        if (column > indent && column + 1 + (int)length > ALL_COLUMNS) {
            fprintf(file, "\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            fputc(' ', file);
            column++;
        }
        fprintf(file, "%.*s", (int)length, text);
        column += (int)length;
        text += length;
        if (*text == '\n') {
            fprintf(file, "\n%*s", text[1] == '\n' ? 0 : indent, "");
            column = indent;
        }
        if (*text) text++;
    }
    fputc('\n', file);
}

/// Writes word `index` of "first|second|third".
static void format_choice(const char *choices, int index, char text[TEXT_BYTES]) {
    for (; index > 0; index--) choices = strchr(choices, '|') + 1;
    snprintf(text, TEXT_BYTES, "%.*s", (int)strcspn(choices, "|"), choices);
}

/// Writes words, by the bits of a set, of "first|second|third".
static void format_set(const char *choices, uint32_t set, char text[TEXT_BYTES]) {
    for (int i = 0; i < 32; i++) {
        if (!(set >> i & 1)) continue;
        char word[TEXT_BYTES];
        format_choice(choices, i, word);
        const size_t used = strlen(text);
        snprintf(text + used, TEXT_BYTES - used, "%s%.64s", used ? "," : "", word);
    }
}

static void format_numbers(const double *values, uint32_t count, char text[TEXT_BYTES]) {
    for (uint32_t i = 0, used = 0; i < count; i++)
        used += (uint32_t)snprintf(text + used, TEXT_BYTES - used, "%s%g", i ? "," : "", values[i]);
}

static void format_color(const double rgba[4], char text[TEXT_BYTES]) {
    if (rgba[3] == 0)
        snprintf(text, TEXT_BYTES, "transparent");
    else
        format_numbers(rgba, 3, text);
}

/// Writes the default of an option as it would be typed; an empty text when there is none to show.
static void format_default(const cli_option *option, const void *defaults, char text[TEXT_BYTES]) {
    const void *member = (const char *)defaults + option->offset;
    text[0] = 0;
    if (option->absent) {
        snprintf(text, TEXT_BYTES, "%s", option->absent);
        return;
    }
    const ewa_option *of = options_library(option);
    switch (option->kind) {
    case OPTION_LIBRARY:
        if (options_counts_bytes(of))
            bytes_write(*(const uint64_t *)member, text);
        else
            ewa_option_get(of, (const char *)member - of->offset, text);
        break;
    case OPTION_FLAG:
    case OPTION_TOGGLE:
    case OPTION_BOUNDS:
    case OPTION_FRAMES:
    case OPTION_FILTER:
    case OPTION_VECTORS:
        break; // none until they are given
    case OPTION_ON_OFF:
        snprintf(text, TEXT_BYTES, "%s", *(const bool *)member ? "on" : "off");
        break;
    case OPTION_NUMBER:
        snprintf(text, TEXT_BYTES, "%g", *(const double *)member);
        break;
    case OPTION_INTEGER:
        snprintf(text, TEXT_BYTES, "%" PRId64, *(const int64_t *)member);
        break;
    case OPTION_CHOICE:
        format_choice(option->range, *(const int *)member, text);
        break;
    case OPTION_SET:
        format_set(option->range, *(const uint32_t *)member, text);
        break;
    case OPTION_OUTPUT:
    case OPTION_OUTPUTS:
    case OPTION_TEXT: {
        const char *word = *(const char *const *)member;
        if (word) snprintf(text, TEXT_BYTES, "%s", word);
        break;
    }
    case OPTION_VECTOR:
        format_numbers(((const option_vector *)member)->values, ((const option_vector *)member)->count, text);
        break;
    case OPTION_COLOR:
        format_color(((const option_color *)member)->rgba, text);
        break;
    case OPTION_SIZE: {
        const option_size *size = member;
        snprintf(text, TEXT_BYTES, "%" PRIu32 "x%" PRIu32, size->width_px, size->height_px);
        break;
    }
    }
}

void help_write_names(const cli_option *option, char text[HELP_NAMES_BYTES]) {
    char letter[8] = "", value[EWA_OPTION_TEXT_BYTES];
    options_name_value(option, value);
    if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(text, HELP_NAMES_BYTES, "%s--%s%s%s%s", letter, option->key, value[0] ? " " : "", value,
             option->kind == OPTION_TOGGLE ? ", --no-" : "");
    if (option->kind == OPTION_TOGGLE) strncat(text, option->key, HELP_NAMES_BYTES - strlen(text) - 1);
}

/// Appends the keys of a list in the table, with commas.
static void append_keys(const char *lead, const char *keys, char text[HELP_MEANING_BYTES]) {
    for (const char *key = keys; key && *key;) {
        const size_t length = strcspn(key, " "), used = strlen(text);
        snprintf(text + used, HELP_MEANING_BYTES - used, "%s--%.*s", key == keys ? lead : ", ", (int)length, key);
        key += length;
        key += strspn(key, " ");
    }
}

void help_write_meaning(const cli_option *option, const void *defaults, char text[HELP_MEANING_BYTES]) {
    char initial[TEXT_BYTES], range[EWA_OPTION_TEXT_BYTES] = "";
    format_default(option, defaults, initial);
    const ewa_option *of = options_library(option);
    if (of && !of->words && of->type != EWA_OPTION_BOOL && (isfinite(of->minimum) || isfinite(of->maximum)))
        options_write_range(of, range);
    else if (option->range && option->kind != OPTION_CHOICE)
        snprintf(range, sizeof range, "%s", option->range);
    snprintf(text, HELP_MEANING_BYTES, "%s%s%s%s%s%s", option->help ? option->help : of->help,
             range[0] == 0                ? ""
             : option->kind == OPTION_SET ? "; of "
                                          : "; in ",
             range, initial[0] ? " (default: " : "", initial, initial[0] ? ")" : "");
    append_keys("; needs ", option->needs, text);
    append_keys("; not with ", option->excludes, text);
    append_keys("; also ", option->aliases, text);
}

static void print_group(FILE *file, const option_group *group, const void *defaults) {
    fprintf(file, "\n%s:\n", group->title);
    for (size_t i = 0; i < group->count; i++) {
        char names[HELP_NAMES_BYTES], meaning[HELP_MEANING_BYTES];
        help_write_names(&group->options[i], names);
        help_write_meaning(&group->options[i], defaults, meaning);
        int column = fprintf(file, "  %s", names);
        if (column >= LEFT_COLUMNS) {
            fputc('\n', file);
            column = 0;
        }
        fprintf(file, "%*s", LEFT_COLUMNS - column, "");
        print_wrapped(file, meaning, LEFT_COLUMNS, LEFT_COLUMNS);
    }
}

/// A group of a command, those that all have behind its own; NULL: there are no more.
static const option_group *group_of(const cli_command *command, size_t index) {
    size_t count = 0;
    while (command->groups[count]) count++;
    return index < count ? command->groups[index] : index == count ? &common_options : NULL;
}

/// The words of a row.
typedef struct row_words {
    char names[HELP_NAMES_BYTES], meaning[HELP_MEANING_BYTES];
} row_words;

static row_words words_of(const cli_option *option, const void *defaults) {
    row_words words;
    help_write_names(option, words.names);
    help_write_meaning(option, defaults, words.meaning);
    return words;
}

/// Whether a command has a row of these words.
static bool has_row(const cli_command *command, const cli_option *option, const row_words *words) {
    bool same = false;
    void *defaults = help_make_defaults(command);
    const option_group *group;
    for (size_t g = 0; defaults && (group = group_of(command, g)); g++)
        for (size_t i = 0; i < group->count; i++) {
            if (strcmp(group->options[i].key, option->key) != 0) continue;
            const row_words other = words_of(&group->options[i], defaults);
            same = same || (strcmp(other.names, words->names) == 0 && strcmp(other.meaning, words->meaning) == 0);
        }
    free(defaults);
    return same;
}

/// Which of the first `count` commands has a row of these words first; `count`: none.
static size_t find_first_with_row(const cli_command *const *commands, size_t count, const cli_option *option, const row_words *words) {
    for (size_t i = 0; i < count; i++)
        if (has_row(commands[i], option, words)) return i;
    return count;
}

/// Writes a cell of a table.
static void print_cell(FILE *file, const char *text) {
    for (const char *c = text; *c; c++) fprintf(file, *c == '|' ? "\\%c" : "%c", *c);
}

static const char table_head[] = "| option | meaning |\n|---|---|\n";

/// The options of a group that no earlier command has in the same words.
static void print_group_markdown(FILE *file, const option_group *group, const void *defaults, const cli_command *const *commands,
                                 size_t index) {
    bool any = false;
    for (size_t i = 0; i < group->count; i++) {
        const row_words words = words_of(&group->options[i], defaults);
        if (find_first_with_row(commands, index, &group->options[i], &words) != index) continue;
        if (!any) fprintf(file, "\n**%s**\n\n%s", group->title, table_head);
        any = true;
        fputs("| `", file);
        print_cell(file, words.names);
        fputs("` | ", file);
        print_cell(file, words.meaning);
        fputs(" |\n", file);
    }
}

/// The other options of a command, of all groups, in one row for each earlier command that tells them.
static void print_told_before_markdown(FILE *file, const void *defaults, const cli_command *const *commands, size_t index) {
    bool headed = false;
    for (size_t source = 0; source < index; source++) {
        bool any = false;
        const option_group *group;
        for (size_t g = 0; (group = group_of(commands[index], g)); g++)
            for (size_t i = 0; i < group->count; i++) {
                const cli_option *option = &group->options[i];
                const row_words words = words_of(option, defaults);
                if (find_first_with_row(commands, index, option, &words) != source) continue;
                if (!headed) fprintf(file, "\n**As of other commands**\n\n%s", table_head);
                headed = true;
                fprintf(file, "%s--%s", any ? ", " : "| `", option->key);
                if (option->kind == OPTION_TOGGLE) fprintf(file, ", --no-%s", option->key);
                any = true;
            }
        if (any) fprintf(file, "` | as of [`ewa %s`](#ewa-%s) |\n", commands[source]->name, commands[source]->name);
    }
}

static const ewa_option_table *const tables[] = {&ewa_acquire_options_table,
                                                 &ewa_asset_options_table,
                                                 &ewa_cloud_load_options_table,
                                                 &ewa_cloud_save_options_table,
                                                 &ewa_coloring_table,
                                                 &ewa_context_options_table,
                                                 &ewa_csg_options_table,
                                                 &ewa_estimate_options_table,
                                                 &ewa_feature_options_table,
                                                 &ewa_furniture_options_table,
                                                 &ewa_gaussian_options_table,
                                                 &ewa_gaussians_save_options_table,
                                                 &ewa_generate_options_table,
                                                 &ewa_image_save_options_table,
                                                 &ewa_instance_table,
                                                 &ewa_limits_table,
                                                 &ewa_lod_build_options_table,
                                                 &ewa_lod_options_table,
                                                 &ewa_material_table,
                                                 &ewa_mesh_sample_options_table,
                                                 &ewa_panorama_options_table,
                                                 &ewa_photos_options_table,
                                                 &ewa_procedure_options_table,
                                                 &ewa_profile_graph_options_table,
                                                 &ewa_profile_options_table,
                                                 &ewa_refit_options_table,
                                                 &ewa_render_options_table,
                                                 &ewa_scene_options_table,
                                                 &ewa_surfels_options_table,
                                                 &ewa_texture_options_table,
                                                 &ewa_view_options_table,
                                                 &ewa_volume_generate_options_table,
                                                 &ewa_volume_load_options_table,
                                                 &ewa_volume_options_table,
                                                 &ewa_volume_save_options_table,
                                                 &ewa_voxels_options_table,
                                                 &ewa_warp_options_table};

static void print_option_json(json_writer *json, const ewa_option *option) {
    static const char *const types[] = {"bool", "choice", "u32", "u64", "f32", "f64"};
    char range[EWA_OPTION_TEXT_BYTES];
    ewa_option_range(option, range);
    json_object(json, option->name);
    json_text(json, "type", types[option->type]);
    if (option->count) json_count(json, "count", option->count);
    json_text(json, "range", range);
    if (option->initials)
        json_vector(json, "default", option->count, option->initials);
    else
        json_number(json, "default", option->initial);
    if (option->unit) json_text(json, "unit", option->unit);
    json_text(json, "help", option->help);
    json_close(json, '}');
}

void help_print_json(FILE *file) {
    json_writer json;
    json_start(&json, file);
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        json_object(&json, tables[i]->name);
        for (size_t k = 0; k < tables[i]->option_count; k++) print_option_json(&json, &tables[i]->options[k]);
        json_close(&json, '}');
    }
    json_end(&json);
}

void *help_make_defaults(const cli_command *command) {
    void *defaults = malloc(command->arguments_bytes);
    if (defaults) options_default(command, defaults);
    return defaults;
}

void help_print_command(FILE *file, const cli_command *command) {
    void *defaults = help_make_defaults(command);
    if (!defaults) return;
    fprintf(file, "usage: ewa %s %s [options]\n\n", command->name, command->operands);
    fprintf(file, "%c%s.\n", toupper((unsigned char)command->summary[0]), command->summary + 1);
    if (command->details) {
        fputc('\n', file);
        print_wrapped(file, command->details, 0, 0);
    }
    const option_group *group;
    for (size_t g = 0; (group = group_of(command, g)); g++) print_group(file, group, defaults);
    fprintf(file, "\nExamples:\n");
    for (const char *line = command->examples; *line;) {
        const size_t length = strcspn(line, "\n");
        fprintf(file, "  %.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
    free(defaults);
}

void help_print_program(FILE *file, size_t count, const cli_command *const *commands) {
    fputs("usage: ewa COMMAND [operands] [options]\n\n"
          "Draws point clouds as continuous, antialiased surfaces.\n\nCommands:\n",
          file);
    for (size_t i = 0; i < count; i++) {
        const int column = fprintf(file, "  %-10s", commands[i]->name);
        print_wrapped(file, commands[i]->summary, column, column);
    }
    fputs("\nOptions:\n", file);
    for (const help_option *option = help_program_options; option->names; option++)
        fprintf(file, "  %-22s%s\n", option->names, option->meaning);
    fputs("\nExit status: 0 done, 1 the work failed, 2 wrong usage.\n", file);
}

void help_print_markdown(FILE *file, size_t count, const cli_command *const *commands) {
    fputs("<!-- Made by `ewa --help-markdown`; a test holds it to the program. Do not edit. -->\n"
          "# The program `ewa`\n\n"
          "`ewa COMMAND --help` prints the same in a terminal. Values follow as `--key value` or "
          "`--key=value`; `--` ends\n"
          "the options. Exit status: 0 done, 1 the work failed (the message says which file, where in it, "
          "and why),\n"
          "2 wrong usage. Messages go to standard error as `ewa: FILE: what`. Output files appear whole or "
          "not at all.\n"
          "A default that is written out changes nothing; one that is worked out is written as the word before its colon:\n"
          "auto, none or all (files of these names: `./auto`). An option that several commands have is told at the first of them.\n",
          file);
    for (size_t i = 0; i < count; i++) {
        const cli_command *command = commands[i];
        void *defaults = help_make_defaults(command);
        if (!defaults) return;
        fprintf(file, "\n## ewa %s\n\n`ewa %s %s [options]`\n\n%c%s.\n", command->name, command->name,
                command->operands, toupper((unsigned char)command->summary[0]), command->summary + 1);
        if (command->details) fprintf(file, "\n%s\n", command->details);
        fprintf(file, "\n```sh\n%s```\n", command->examples);
        const option_group *group;
        for (size_t g = 0; (group = group_of(command, g)); g++) print_group_markdown(file, group, defaults, commands, i);
        print_told_before_markdown(file, defaults, commands, i);
        free(defaults);
    }
}
