// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Whether the files that a command is asked to write can be written, before any work.
#include "cli/base/outputs.h"
#include "cli/base/path.h"
#include "cli/base/pattern.h"
#include "cli/render/video.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_OUTPUTS = 16 };

/// A file that is to be written, and the option that says so.
typedef struct named_output {
    const char *key;
    char path[PATH_BYTES];
} named_output;

typedef struct output_list {
    named_output *each;
    size_t count;
} output_list;

bool output_check_suffix(const char *key, const char *path, const char *suffixes,
                         char message[OPTION_ERROR_BYTES]) {
    if (path_has_suffix(path, suffixes)) return true;
    char words[128] = "";
    for (const char *suffix = suffixes; *suffix;) {
        const size_t length = strcspn(suffix, "|"), used = strlen(words);
        const char *next = suffix + length + (suffix[length] == '|');
        const bool last = !*next || strcmp(next, "-") == 0;
        if (strncmp(suffix, "-", length) != 0)
            snprintf(words + used, sizeof words - used, "%s%.*s",
                     !used  ? ""
                     : last ? " or "
                            : ", ",
                     (int)length, suffix);
        suffix = next;
    }
    snprintf(message, OPTION_ERROR_BYTES, "--%s: '%.200s' is no %s file", key, path, words);
    return false;
}

/// Adds `length` bytes of `path`, a numbered one as its first frame; false when it is too long or one too
/// many.
static bool add_output(output_list *list, const char *key, const char *path, size_t length,
                       char message[OPTION_ERROR_BYTES]) {
    named_output *output = &list->each[list->count];
    char text[PATH_BYTES];
    if (list->count < MAX_OUTPUTS && length < sizeof text) {
        memcpy(text, path, length);
        text[length] = 0;
        output->key = key;
        if (!pattern_is_numbered(text))
            memcpy(output->path, text, length + 1);
        else if (!pattern_expand(text, 0, sizeof output->path, output->path))
            length = sizeof text;
        list->count += length < sizeof text;
    }
    if (list->count < MAX_OUTPUTS && length < sizeof text) return true;
    snprintf(message, OPTION_ERROR_BYTES, "--%s: '%.200s': the path is too long, or one too many", key, path);
    return false;
}

/// Collects what the options of a command name.
static bool list_outputs(const cli_command *command, const void *arguments, output_list *list,
                         char message[OPTION_ERROR_BYTES]) {
    const cli_option *option;
    for (size_t i = 0; (option = options_at(command, i)); i++) {
        const bool several = option->kind == OPTION_OUTPUTS;
        if (option->kind != OPTION_OUTPUT && !several) continue;
        const char *next = *(const char *const *)((const char *)arguments + option->offset);
        while (next && *next) {
            const size_t length = several ? strcspn(next, ",") : strlen(next);
            const char *equals = several ? memchr(next, '=', length) : NULL;
            const char *path = equals ? equals + 1 : next;
            if (!add_output(list, option->key, path, length - (size_t)(path - next), message)) return false;
            next += length + (next[length] == ',');
        }
    }
    return true;
}

/// Whether a file can be created at a path.
static bool check_place(const named_output *output, char message[OPTION_ERROR_BYTES]) {
    const char *path = output->path;
    struct stat found;
    if (strcmp(path, "-") == 0) return true;
    if (stat(path, &found) == 0 && S_ISDIR(found.st_mode)) {
        snprintf(message, OPTION_ERROR_BYTES, "--%s: %.300s: is a folder", output->key, path);
        return false;
    }
    if (path_is_link(path) && stat(path, &found) != 0) {
        snprintf(message, OPTION_ERROR_BYTES, "--%s: %.300s: is a link to a file that is not there",
                 output->key, path);
        return false;
    }
    char folder[PATH_BYTES] = ".";
    const char *name = path_file_name(path);
    if (name > path) {
        const size_t length = name == path + 1 ? 1 : (size_t)(name - path) - 1;
        memcpy(folder, path, length);
        folder[length] = 0;
    }
    if (path_takes_files(folder)) return true;
    snprintf(message, OPTION_ERROR_BYTES, "--%s: %.180s: cannot create: folder %.180s: %s", output->key, path,
             folder, strerror(errno));
    return false;
}

bool outputs_check(const cli_command *command, const void *arguments, char message[OPTION_ERROR_BYTES]) {
    named_output each[MAX_OUTPUTS];
    output_list list = {each, 0};
    if (!list_outputs(command, arguments, &list, message)) return false;
    for (size_t i = 0; i < list.count; i++) {
        if (!check_place(&each[i], message)) return false;
        if (video_find_format(each[i].path) && ((const common_arguments *)arguments)->untrusted) {
            snprintf(message, OPTION_ERROR_BYTES,
                     "--%s: %.200s: films are written by the program ffmpeg, which --untrusted does not start",
                     each[i].key, each[i].path);
            return false;
        }
        if (video_find_format(each[i].path) && !video_is_possible()) {
            snprintf(message, OPTION_ERROR_BYTES,
                     "--%s: %.200s: films are written by the program ffmpeg, which is not in PATH (Debian: "
                     "apt install ffmpeg); -o NAME_%%04d.png writes pictures without it",
                     each[i].key, each[i].path);
            return false;
        }
        for (size_t k = 0; k < i; k++) {
            if (strcmp(each[i].path, each[k].path) != 0) continue;
            snprintf(message, OPTION_ERROR_BYTES, "--%s: '%.200s' would be written twice", each[i].key,
                     each[i].path);
            return false;
        }
    }
    return true;
}
