// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The files that were opened last.
#define _XOPEN_SOURCE 700 // realpath()
#include "recent.h"
#include "kept_text.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const kept_text kept = {"XDG_STATE_HOME", ".local/state", "recent"};

static bool take_line(void *user, const char *line) {
    recent_files *files = user;
    if (!line[0]) return false;
    snprintf(files->paths[files->count++], VIEWER_PATH_BYTES, "%s", line);
    return files->count < RECENT_FILES;
}

void recent_read(recent_files *files) {
    files->count = 0;
    kept_text_read(&kept, take_line, files);
}

static void write_text(const recent_files *files) {
    size_t bytes = 1, used = 0;
    for (uint32_t i = 0; i < files->count; i++) bytes += strlen(files->paths[i]) + 1;
    char *lines = malloc(bytes);
    if (!lines) return;
    for (uint32_t i = 0; i < files->count; i++)
        used += (size_t)snprintf(lines + used, bytes - used, "%s\n", files->paths[i]);
    kept_text_write(&kept, lines);
    free(lines);
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
