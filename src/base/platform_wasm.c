// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The operating system by WASI, which a WebAssembly module is given in node, in a browser's page or by a runtime of its own:
// files are there where the host grants a folder; processes, permissions, mapping and libraries are not.
#include "base/platform.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { MAX_LINKS = 32 };

// ---- The machine

void *ewa_platform_allocate(size_t size_bytes) {
    const size_t rounded = (size_bytes + 63) & ~(size_t)63;
    return rounded < size_bytes ? NULL : aligned_alloc(64, rounded);
}

// All that 32 bits can address; what the host gives is seen when it is asked for.
uint64_t ewa_platform_memory_bytes(void) { return (uint64_t)1 << 32; }

uint32_t ewa_platform_processor_count(void) { return 1; }

bool ewa_platform_has_library(const char *name) {
    (void)name;
    return false;
}

void *ewa_platform_open_library(const char *name) {
    (void)name;
    return NULL;
}

void *ewa_platform_find_function(void *library, const char *name) {
    (void)library;
    (void)name;
    return NULL;
}

void ewa_platform_describe(int error, char *text, size_t room) {
    if (strerror_r(error, text, room) != 0) snprintf(text, room, "error %d", error);
}

// ---- Names of files

bool ewa_platform_may_write(const char *path) { return access(path, W_OK) == 0; }

/// Appends names to an absolute path without links, one after the other.
static bool append(char resolved[EWA_PATH_BYTES], const char *names, int *links) {
    while (*names) {
        const size_t length = strcspn(names, "/"), before = strlen(resolved);
        const bool here = length == 0 || (length == 1 && names[0] == '.');
        if (length == 2 && names[0] == '.' && names[1] == '.') {
            char *slash = strrchr(resolved, '/');
            if (slash) *slash = 0;
        } else if (!here) {
            if (before + length + 2 > EWA_PATH_BYTES) {
                errno = ENAMETOOLONG;
                return false;
            }
            resolved[before] = '/';
            memcpy(resolved + before + 1, names, length);
            resolved[before + 1 + length] = 0;
            char target[EWA_PATH_BYTES];
            const ssize_t got = readlink(resolved, target, sizeof target - 1);
            if (got >= 0) {
                target[got] = 0;
                resolved[target[0] == '/' ? 0 : before] = 0;
                if (--*links < 0) {
                    errno = ELOOP;
                    return false;
                }
                if (!append(resolved, target, links)) return false;
            }
        }
        names += length + (names[length] == '/');
    }
    return true;
}

bool ewa_platform_resolve(const char *path, char resolved[EWA_PATH_BYTES]) {
    struct stat found;
    int links = MAX_LINKS;
    if (stat(path, &found) != 0) return false;
    resolved[0] = 0;
    if (path[0] != '/') {
        if (!getcwd(resolved, EWA_PATH_BYTES)) return false;
        if (strcmp(resolved, "/") == 0) resolved[0] = 0;
    }
    if (!append(resolved, path, &links)) return false;
    if (!resolved[0]) strcpy(resolved, "/");
    return true;
}

void ewa_platform_unique(int attempt, char words[64]) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(words, 64, "%lld-%09ld-%d", (long long)now.tv_sec, now.tv_nsec, attempt);
}

// ---- Open files

int ewa_platform_create_temporary(const char *folder) {
    char words[64], name[EWA_PATH_BYTES];
    ewa_platform_unique(0, words);
    if (snprintf(name, sizeof name, "%s/.ewa-spool-%s", folder, words) >= (int)sizeof name) {
        errno = ENAMETOOLONG;
        return -1;
    }
    const int descriptor = open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (descriptor >= 0) unlink(name);
    return descriptor;
}

// It cannot be duplicated; closing it does nothing.
int ewa_platform_standard_output(void) { return STDOUT_FILENO; }

bool ewa_platform_flush(int descriptor) { return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP; }

bool ewa_platform_close(int descriptor) { return descriptor <= STDERR_FILENO || close(descriptor) == 0; }
