// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outputs that cannot be written are wrong usage, found before any work, in every command alike.
#include <stdio.h>
#include <string.h>

#include "cli/base/commands.h"
#include "cli/base/outputs.h"
#include "run_ewa.h"

static int enter(void **state) { return scratch_enter("cli_outputs"); }

/// A command line that works but for where an option writes; %s: "--option file".
typedef struct writing {
    const char *command, *key, *line, *suffix;
} writing;

/// Every option of every command that names files to write. Inputs do not exist: nothing looks for them.
static const writing writings[] = {
    {"render", "output", "in.ply %s", ".png"},
    {"render", "output", "in.ply --turntable 3 %s", "_%d.exr"},
    {"render", "aov", "in.ply -o a.png %s", ".pfm"},
    {"render", "save-camera", "in.ply -o a.png %s", ".json"},
    {"render", "save-scene", "in.ply -o a.png %s", ".json"},
    {"render", "stats", "in.ply -o a.png %s", ".json"},
    {"convert", "output", "in.ply %s", ".ply"},
    {"surfels", "output", "in.ply %s", ".ply"},
    {"features", "output", "in.ply %s", ".ply"},
    {"sample", "output", "in.obj %s", ".ply"},
    {"csg", "output", "in.ply in.ply --op union %s", ".ply"},
    {"texture", "output", "in.png %s", ".png"},
    {"warp", "output", "in.png in.pfm --intrinsics 1,1,1,1 --shift 1,0,0 %s", ".png"},
    {"warp", "aov", "in.png in.pfm --intrinsics 1,1,1,1 --shift 1,0,0 -o a.png %s", ".exr"},
    {"warp", "hole-mask", "in.png in.pfm --intrinsics 1,1,1,1 --shift 1,0,0 -o a.png %s", ".png"},
    {"warp", "save-camera", "in.png in.pfm --intrinsics 1,1,1,1 --shift 1,0,0 -o a.png %s", ".json"},
    {"volume", "output", "in.nrrd %s", ".png"},
    {"volume", "aov", "in.nrrd -o a.png %s", ".exr"},
    {"volume", "save-camera", "in.nrrd -o a.png %s", ".json"},
    {"volume", "stats", "in.nrrd -o a.png %s", ".json"},
    {"volume", "save-transfer", "in.nrrd -o a.png %s", ".json"},
    {"lod", "output", "in.ply %s", ".copc.laz"},
    {"lod", "stats", "in.ply -o a.copc.laz %s", ".json"},
    {"page", "output", "in.ply %s", ".html"},
    {"profile", "output", "in.ply --line '0,0;1,0' --width 9 %s", ".ply"},
    {"profile", "graph", "in.ply --line '0,0;1,0' --width 9 %s", ".png"},
    {"photos", "output", "in.ply --cameras c.json %s", ".ply"},
    {"photos", "report", "in.ply --cameras c.json -o a.ply %s", ".json"},
    {"compare", "output", "in.ply --cameras c.json %s", ".png"},
    {"compare", "json", "in.ply --cameras c.json %s", ".json"},
    {"generate", "output", "sphere -n 100 %s", ".ply"},
    {"generate", "output", "ball --dims 8 %s", ".nrrd"},
    {"bench", "json", "--scene plane --splats 100 --frames 1 --stages off --workers 1 %s", ".json"},
};

enum { WRITINGS = sizeof writings / sizeof writings[0] };

/// The table above is whole: it has each option that writes, and what help says to write is such an option.
TEST(test_table) {
    for (size_t c = 0; c < all_commands_count; c++) {
        const cli_option *option;
        for (size_t i = 0; (option = options_at(all_commands[c], i)); i++) {
            const bool writes = option->kind == OPTION_OUTPUT || option->kind == OPTION_OUTPUTS;
            bool listed = false;
            for (size_t k = 0; k < WRITINGS; k++)
                listed = listed || (strcmp(writings[k].command, all_commands[c]->name) == 0 &&
                                    strcmp(writings[k].key, option->key) == 0);
            if (writes != listed) print_error("%s --%s\n", all_commands[c]->name, option->key);
            assert_int_equal(writes, listed);
            const bool named =
                option->kind == OPTION_TEXT && option->value && strcmp(option->value, "FILE") == 0;
            assert_false(named && strstr(option->help, "write"));
        }
    }
}

/// Runs a command line of the table that writes to `file`.
static void refuse(const writing *what, const char *file, const char *said) {
    char option[128], line[512], words[256];
    snprintf(option, sizeof option, "--%s %s%s", what->key, strcmp(what->key, "aov") == 0 ? "depth=" : "",
             file);
    const char *place = strstr(what->line, "%s");
    snprintf(line, sizeof line, "%.*s%s%s", (int)(place - what->line), what->line, option, place + 2);
    snprintf(words, sizeof words, "--%s: |%s", what->key, said);
    const int before = scratch_count();
    run_fails(2, words, "ewa %s %s", what->command, line);
    assert_int_equal(scratch_count(), before);
}

TEST(test_no_folder) {
    for (size_t i = 0; i < WRITINGS; i++) {
        char file[64];
        snprintf(file, sizeof file, "nowhere/a%s", writings[i].suffix);
        refuse(&writings[i], file, "nowhere/|cannot create: folder nowhere: No such file");
    }
}

TEST(test_folder_in_the_way) {
    run_done(
        "mkdir taken.png taken.copc.laz taken.pfm taken.json taken.ply taken.exr taken.nrrd taken.html taken_0.exr");
    for (size_t i = 0; i < WRITINGS; i++) {
        char file[64];
        snprintf(file, sizeof file, "taken%s", writings[i].suffix);
        refuse(&writings[i], file, "is a folder");
    }
    run_done("rmdir taken*");
}

TEST(test_written_twice) {
    run_fails(2, "--stats: 'a.png' would be written twice", "ewa render in.ply -o a.png --stats a.png");
    run_fails(2, "--save-transfer: 'a.json' would be written twice",
              "ewa volume in.nrrd -o a.png --save-camera a.json --save-transfer a.json");
    run_fails(2, "--stats: '-' would be written twice", "ewa render in.ply -o - --stats -");
    run_fails(2, "--aov: 'a_0.exr' would be written twice",
              "ewa render in.ply -o a_%%d.exr --turntable 2 --aov depth=a_%%1d.exr");
}

/// What is over all bounds is refused, not cut.
TEST(test_long_names) {
    const cli_command *command = command_find("convert");
    static char arguments[1 << 17];
    char message[OPTION_ERROR_BYTES], path[6000];
    assert_true(command->arguments_bytes <= sizeof arguments);
    memset(path, 'a', sizeof path - 1);
    path[sizeof path - 1] = 0;
    memcpy(path + sizeof path - 5, ".ply", 4);
    const char *words[] = {"in.ply", "-o", path}, *operands[3];
    options_default(command, arguments);
    assert_true(options_parse(command, 3, words, operands, arguments, message));
    assert_false(outputs_check(command, arguments, message));
    assert_non_null(strstr(message, "too long"));
}

int main(void) { return RUN_TESTS(enter, NULL); }
