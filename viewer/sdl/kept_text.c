// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Texts that are kept from one session to the next.
#include "kept_text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// Writes the text's path; false: nobody says where it is. `make`: makes the folders.
static bool find(const kept_text *text, char path[VIEWER_PATH_BYTES], bool make) {
    const char *folder = getenv(text->variable), *home = getenv("HOME");
    int used;
    if (folder && folder[0] == '/') // what is relative does not count, says the specification
        used = snprintf(path, VIEWER_PATH_BYTES, "%s/ewa/%s", folder, text->name);
    else if (home && home[0] == '/')
        used = snprintf(path, VIEWER_PATH_BYTES, "%s/%s/ewa/%s", home, text->usual, text->name);
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

void kept_text_read(const kept_text *text, bool (*line)(void *user, const char *line), void *user) {
    char path[VIEWER_PATH_BYTES], read[VIEWER_PATH_BYTES + 1];
    FILE *file = find(text, path, false) ? fopen(path, "r") : NULL;
    while (file && fgets(read, sizeof read, file)) {
        const size_t length = strcspn(read, "\n");
        if (read[length] != '\n') break;
        read[length] = 0;
        if (!line(user, read)) break;
    }
    if (file) fclose(file);
}

void kept_text_write(const kept_text *text, const char *lines) {
    char path[VIEWER_PATH_BYTES], part[VIEWER_PATH_BYTES + 8];
    if (!find(text, path, true)) return;
    snprintf(part, sizeof part, "%s.part", path);
    FILE *file = fopen(part, "w");
    if (!file) return;
    bool done = fputs(lines, file) >= 0;
    done = fclose(file) == 0 && done;
    if (!done || rename(part, path) != 0) unlink(part);
}
