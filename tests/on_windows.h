// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What tests call of POSIX and Windows has by another name, or not at all; the build includes it before everything there.
#ifndef EWA_TESTS_ON_WINDOWS_H
#define EWA_TESTS_ON_WINDOWS_H

#include <direct.h>
#include <dirent.h>
#include <io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define mkdir(path, mode) _mkdir(path)

static inline int setenv(const char *name, const char *value, int replaces) {
    return replaces || !getenv(name) ? _putenv_s(name, value) : 0;
}

static inline int unsetenv(const char *name) { return _putenv_s(name, ""); }

static inline void *memmem(const void *bytes, size_t size_bytes, const void *part, size_t part_bytes) {
    for (size_t i = 0; i + part_bytes <= size_bytes; i++)
        if (memcmp((const char *)bytes + i, part, part_bytes) == 0) return (char *)bytes + i;
    return NULL;
}

// Links to files, and pipes with names: a case that needs one is skipped.
#define symlink(target, path) (_skip(__FILE__, __LINE__), -1)
#define mkfifo(path, mode)    (_skip(__FILE__, __LINE__), -1)

#define mkdtemp on_windows_mkdtemp
static inline char *mkdtemp(char *path) { return _mktemp(path) && _mkdir(path) == 0 ? path : NULL; }

static inline int alphasort(const struct dirent **a, const struct dirent **b) { return strcmp((*a)->d_name, (*b)->d_name); }

static inline int scandir(const char *path, struct dirent ***entries, int (*filter)(const struct dirent *),
                          int (*compare)(const struct dirent **, const struct dirent **)) {
    DIR *folder = opendir(path);
    if (!folder) return -1;
    int count = 0;
    *entries = NULL;
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (filter && !filter(entry)) continue;
        struct dirent **more = realloc(*entries, (size_t)(count + 1) * sizeof *more), *copy = malloc(sizeof *copy);
        if (!more || !copy) abort();
        *copy = *entry;
        (*entries = more)[count++] = copy;
    }
    closedir(folder);
    qsort(*entries, (size_t)count, sizeof **entries, (int (*)(const void *, const void *))compare);
    return count;
}

#endif
