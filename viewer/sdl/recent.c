// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The files that were opened last.
#define _XOPEN_SOURCE 700 // realpath()
#include "recent.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// Writes the name of the text, or of the folder that it is in; false: nobody says where. `make`: makes the folders.
static bool find_text(char path[VIEWER_PATH_BYTES], bool make) {
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    int used;
    if (state && state[0] == '/') // what is relative does not count, says the specification
        used = snprintf(path, VIEWER_PATH_BYTES, "%s/ewa/recent", state);
    else if (home && home[0] == '/')
        used = snprintf(path, VIEWER_PATH_BYTES, "%s/.local/state/ewa/recent", home);
    else
        return false;
    if (used >= VIEWER_PATH_BYTES) return false;
    for (char *slash = path; make && (slash = strchr(slash + 1, '/'));) {
        *slash = 0;
        const bool there = mkdir(path, 0700) == 0 || errno == EEXIST;
        *slash = '/';
        if (!there) return false;
    }
    return true;
}

void recent_read(recent_files *files) {
    char path[VIEWER_PATH_BYTES], line[VIEWER_PATH_BYTES + 1];
    files->count = 0;
    FILE *file = find_text(path, false) ? fopen(path, "r") : NULL;
    while (file && files->count < RECENT_FILES && fgets(line, sizeof line, file)) {
        const size_t length = strcspn(line, "\n");
        if (line[length] != '\n' || !length) break; // no text of ours
        line[length] = 0;
        memcpy(files->paths[files->count++], line, length + 1);
    }
    if (file) fclose(file);
}

static void write_text(const recent_files *files) {
    char path[VIEWER_PATH_BYTES], part[VIEWER_PATH_BYTES + 8];
    if (!find_text(path, true)) return;
    snprintf(part, sizeof part, "%s.part", path);
    FILE *file = fopen(part, "w");
    if (!file) return;
    bool done = true;
    for (uint32_t i = 0; i < files->count; i++) done = fprintf(file, "%s\n", files->paths[i]) > 0 && done;
    done = fclose(file) == 0 && done;
    if (!done || rename(part, path) != 0) unlink(part);
}

void recent_add(recent_files *files, const char *path) {
    char whole[PATH_MAX];
    const bool address = strstr(path, "://") != NULL;
    const char *name = address ? path : realpath(path, whole);
    if (!name || strchr(name, '\n') || strlen(name) >= VIEWER_PATH_BYTES) return;
    uint32_t at = 0;
    while (at < files->count && strcmp(files->paths[at], name) != 0) at++;
    if (at == files->count && files->count < RECENT_FILES) files->count++;
    if (at == RECENT_FILES) at--;
    memmove(files->paths[1], files->paths[0], at * sizeof files->paths[0]);
    snprintf(files->paths[0], sizeof files->paths[0], "%s", name);
    write_text(files);
}
